// Output for forces, time and several contacts: JSON, CSV, summary, text.
#include "output/contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/multi_contact.hpp"
#include "output/output.hpp"

namespace achilles {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;

std::vector<std::string> parts_of(const std::string& line, char by) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, by);) parts.push_back(part);
    if (!line.empty() && line.back() == by) parts.emplace_back();
    return parts;
}

// Columns of a CSV by name, with cells as text.
struct Table {
    explicit Table(const std::string& csv) : lines(parts_of(csv, '\n')), names(parts_of(lines[0], ',')) {
        if (lines.back().empty()) lines.pop_back();
    }
    std::string text(std::size_t row, const std::string& name) const {
        const auto column = std::find(names.begin(), names.end(), name);
        return column == names.end() ? "no " + name
                                     : parts_of(lines[row + 1], ',')[static_cast<std::size_t>(column - names.begin())];
    }
    double number(std::size_t row, const std::string& name) const { return std::stod(text(row, name)); }
    std::size_t rows() const { return lines.size() - 1; }
    std::vector<std::string> lines, names;
};

// ---- JSON ----

TEST(SeveralContacts, AnImpactThatOpensAnotherIsToldInJson) {
    const Trajectory trajectory = test::run_gaps("pendulum_two_stops");
    const Json json = Json::parse(to_json(trajectory));
    EXPECT_EQ(json["system"]["contacts"], (Names{"knee", "wall"}));
    const Json& wall = json["events"][test::event_near(trajectory, 6.648636034206552)];
    EXPECT_EQ(wall["kind"], "impact");
    EXPECT_EQ(wall["contact"], "wall");
    EXPECT_EQ(wall["opened"], Names{"knee"});
    EXPECT_EQ(wall["held"], Names());
    EXPECT_EQ(wall["impulses"]["knee"], 0.0);
    // M (v+ - v-) = p_knee (0, 1) + p_wall (-1, 0)
    const double cosine = std::cos(wall["q"][1].get<double>()), m12 = cosine / 2 + 1.0 / 3;
    const auto jump = [&](std::size_t i) {
        return wall["v_after"][i].get<double>() - wall["v_before"][i].get<double>();
    };
    EXPECT_NEAR((5.0 / 3 + cosine) * jump(0) + m12 * jump(1), -wall["impulses"]["wall"].get<double>(), 1e-12);
    EXPECT_NEAR(m12 * jump(0) + jump(1) / 3, 0.0, 1e-12);
    const Json& zeno = json["events"][test::event_near(trajectory, 10.476602100186066)];
    EXPECT_EQ(zeno["kind"], "zeno");
    EXPECT_EQ(zeno["contact"], "knee");
    EXPECT_EQ(zeno["held"], Names{"knee"});
    EXPECT_GT(zeno["certificate"]["least_other_gap"].get<double>(), 0.0);
    EXPECT_EQ(zeno["certificate"]["transmission"], Json::object());
    const Json& release = json["events"][test::event_near(trajectory, 12.670936299916242)];
    EXPECT_EQ(release["kind"], "release");
    EXPECT_EQ(release["contact"], "knee");
    EXPECT_EQ(release["held"], Names());
    std::vector<Names> held;
    for (const Json& phase : json["phases"]) {
        held.push_back(phase["held"]);
        EXPECT_EQ(phase["kind"], held.back().empty() ? "hybrid" : "constrained");
    }
    EXPECT_EQ(held, (std::vector<Names>{{}, {"knee"}, {}, {"knee"}, {}}));
    EXPECT_EQ(json["end"]["held"], Names());
    EXPECT_EQ(json["end"]["by_convention"], 0);
    EXPECT_EQ(json["end"]["work"], trajectory.work);
    EXPECT_EQ(json["end"]["loss"], trajectory.loss);
}

// Both corners bounce together, so that there is no third contact: the certificate says so.
TEST(SeveralContacts, ACertificateOfAPairHasTheBoundsOnTheOthers) {
    const auto model = test::load("box_dropped_flat");
    const Json json = Json::parse(to_json(simulate(model, model->default_run())));
    int pairs = 0;
    for (const Json& event : json["events"]) {
        if (event["kind"] != "zeno") continue;
        ++pairs;
        EXPECT_EQ(event["certificate"]["transmission"], Json::object());
        EXPECT_EQ(event["certificate"]["least_force"], Json::object());
        ASSERT_TRUE(event["certificate"].contains("least_other_gap"));
    }
    EXPECT_EQ(pairs, 1);
}

TEST(SeveralContacts, WhatIsPassedOnToHeldOnesIsToldInJson) {
    const Trajectory trajectory = test::run_gaps("bowl_and_post");
    const Json json = Json::parse(to_json(trajectory));
    const Json& zeno = json["events"][test::event_near(trajectory, 7.832904658628080)];
    EXPECT_EQ(zeno["contact"], "post");
    EXPECT_EQ(zeno["held"], (Names{"bowl", "post"}));
    const Json& c = zeno["certificate"];
    ASSERT_TRUE(c["transmission"].contains("bowl"));
    // kappa = -W_12/W_11 = r/(1 + r^2) at the post, g_bowl = (-r, 0, 1), g_post = (1, 0.3 sin(phi), 0)
    const double r = zeno["q"][0].get<double>(), kappa = r / (1.0 + r * r);
    EXPECT_LE(c["transmission"]["bowl"][0].get<double>(), kappa);
    EXPECT_GE(c["transmission"]["bowl"][1].get<double>(), kappa);
    EXPECT_GT(c["least_force"]["bowl"].get<double>(), 0.0);
    EXPECT_TRUE(c["least_other_gap"].is_null());
    int with_held = 0;
    for (const Json& event : json["events"]) {
        if (event["kind"] != "impact") continue;
        const auto number = [&](const char* key, std::size_t i) { return event[key][i].get<double>(); };
        const auto jump = [&](std::size_t i) { return number("v_after", i) - number("v_before", i); };
        const double R = number("q", 0), slope = 0.3 * std::sin(number("q", 1));
        const double bowl = event["impulses"].value("bowl", 0.0), post = event["impulses"].value("post", 0.0);
        EXPECT_NEAR(jump(0), post - R * bowl, 1e-12);
        EXPECT_NEAR(R * R * jump(1), slope * post, 1e-12);
        EXPECT_NEAR(jump(2), bowl, 1e-12);
        with_held += event["held"] == Names{"bowl"} ? 1 : 0;
    }
    EXPECT_GT(with_held, 5);
}

// The coupling is 0 exactly, but not in floating point. With masses 1e12 apart, zero is relative to their ratio.
TEST(SeveralContacts, WhatIsZeroWithinItsRoundingIsFlagged) {
    const auto model = test::typed(R"(
title = "A bead beside a block"
[[coordinate]]
name = "x"
start = 0.0
[[coordinate]]
name = "y"
start = 1.0
[[parameter]]
name = "a"
value = 0.7
[lagrangian]
kinetic = "(1e6*x'^2 + 1e-6*y'^2)/2 + (sin(a)^2 + cos(a)^2 - 1)*x'*y'"
potential = "9.81e6*x + 9.81e-6*y"
[[constraint]]
name = "block"
gap = "x"
restitution = 0.5
[[constraint]]
name = "bead"
gap = "y"
restitution = 0.5
[run]
end_time = 4.0
)");
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    const Json json = Json::parse(to_json(trajectory));
    EXPECT_EQ(json["end"]["held"], (Names{"block", "bead"}));
    const Json& certificate = json["events"].back()["certificate"];
    EXPECT_EQ(certificate["rounded_zero"], true);
    EXPECT_FALSE(certificate.contains("given"));
}

// A ball hits the first of two touching balls. The impact presses the contact of these two, which is held without a
// contact force.
TEST(SeveralContacts, HaveTheImpulseOfAnImpactThatPushesThem) {
    const auto balls = test::typed(
        "title = \"balls\"\n[[coordinate]]\nname = \"a\"\nstart = -1\nrate = 1\n[[coordinate]]\nname = \"b\"\n"
        "[[coordinate]]\nname = \"c\"\n[lagrangian]\nkinetic = \"(a'^2 + b'^2 + c'^2)/2\"\npotential = \"0\"\n"
        "[[constraint]]\nname = \"ab\"\ngap = \"b - a\"\nrestitution = 0.5\n"
        "[[constraint]]\nname = \"bc\"\ngap = \"c - b\"\nrestitution = 0.5\n[run]\nend_time = 1.5\n");
    const Json first = Json::parse(to_json(simulate(balls, balls->default_run())))["events"][0];
    EXPECT_EQ(first["contact"], "ab");
    EXPECT_EQ(first["held"], Names{"bc"}) << first;
    EXPECT_GT(first["impulses"]["bc"].get<double>(), 0.0);
}

TEST(SeveralContacts, LandingsWhoseOrderMattersHaveAlternatives) {
    const auto rod = test::flat_rod();
    auto long_enough = rod->default_run();
    long_enough.options.end_time = 6.0;  // long enough to come to rest
    const Trajectory trajectory = simulate(rod, long_enough);
    const Json json = Json::parse(to_json(trajectory));
    const Json& first = json["events"][0];
    EXPECT_EQ(first["contacts"], (Names{"left", "right"}));
    EXPECT_FALSE(first.contains("contact"));
    EXPECT_EQ(first["order_matters"], true);
    EXPECT_EQ(first["not_unique"], false);
    EXPECT_NEAR(first["impulses"]["left"].get<double>(), first["impulses"]["right"].get<double>(), 1e-14);
    const double speed = first["impact_speed"];
    const Json& alternatives = first["alternatives"];
    ASSERT_EQ(alternatives.size(), 3u);
    const auto expect = [&](std::size_t i, const Json& name, double left, double right) {
        EXPECT_EQ(alternatives[i]["first"], name);
        EXPECT_NEAR(alternatives[i]["rates_after"]["left"].get<double>(), left * speed, 1e-12);
        EXPECT_NEAR(alternatives[i]["rates_after"]["right"].get<double>(), right * speed, 1e-12);
    };
    expect(0, nullptr, 0.5, 0.5);
    expect(1, "left", 0.40625, 0.265625);
    expect(2, "right", 0.265625, 0.40625);
    EXPECT_GE(json["end"]["by_convention"].get<int>(), 1);
    EXPECT_NE(summary(trajectory).find("of left, right, order-dependent outcome"), std::string::npos)
        << summary(trajectory);
    EXPECT_NE(summary(trajectory).find("resolved together by Moreau's law"), std::string::npos);
    const auto& events = json["events"];
    const auto zeno = std::find_if(events.begin(), events.end(), [](const Json& e) { return e["kind"] == "zeno"; });
    ASSERT_NE(zeno, events.end());
    EXPECT_EQ((*zeno)["certificate"]["given"].get<std::string>().find("Moreau's law at event 1, t = "), 0u);
    auto strict = rod->default_run();
    strict.options.simultaneous = Simultaneous::stop;
    EXPECT_EQ(Json::parse(to_json(simulate(rod, strict)))["outcome"]["kind"], "simultaneous impacts");
    EXPECT_EQ(to_text(Outcome::Kind::redundant_contacts), "redundant contacts");
}

TEST(SeveralContacts, OneGapGainsFieldsOnly) {
    const auto ball = test::load("ball_on_sine");
    const Trajectory trajectory = simulate(ball, ball->default_run());
    const Json json = Json::parse(to_json(trajectory));
    EXPECT_EQ(json["system"]["contacts"], Names{"contact"});
    EXPECT_EQ(json["end"]["work"], 0.0);
    for (const Json& event : json["events"]) {
        EXPECT_EQ(event["contact"], "contact");
        EXPECT_FALSE(event.contains("order_matters"));
        EXPECT_FALSE(event.value("certificate", Json::object()).contains("transmission"));
        if (event["kind"] != "impact") continue;
        // n p/W with M the identity: v+ - v- = p (-cos x, 1)
        EXPECT_NEAR(event["v_after"][1].get<double>() - event["v_before"][1].get<double>(),
                    event["impulses"]["contact"].get<double>(), 1e-12);
    }
    EXPECT_EQ(summary(trajectory).find(" of contact"), std::string::npos);
    EXPECT_EQ(to_text(trajectory).find("held"), std::string::npos);
}

// ---- CSV ----

TEST(SeveralContacts, CsvHasColumnsOfEachContact) {
    const Trajectory trajectory = test::run_gaps("bowl_and_post");
    const Table table(to_csv(trajectory));
    EXPECT_EQ(table.lines[0],
              "t,phase,r,phi,z,r',phi',z',gap_bowl,rate_bowl,lambda_bowl,gap_post,rate_post,lambda_post,energy,j,held,"
              "work,loss");
    std::map<std::string, int> seen;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const std::string held = table.text(i, "held");
        ++seen[held];
        for (const std::string name : {"bowl", "post"}) {
            const bool is_held = held.find(name) != std::string::npos;
            EXPECT_GE(table.number(i, "gap_" + name), -1e-12);
            if (is_held) {
                EXPECT_NEAR(table.number(i, "rate_" + name), 0.0, 1e-12);
                EXPECT_GT(table.number(i, "lambda_" + name), -1e-9);
            } else {
                EXPECT_EQ(table.number(i, "lambda_" + name), 0.0);
            }
        }
        EXPECT_NEAR(table.number(i, "energy") - table.number(0, "energy"),
                    table.number(i, "work") - table.number(i, "loss"), 1e-8);
    }
    for (const char* held : {"", "bowl", "bowl+post"}) EXPECT_GT(seen[held], 10) << held;
    EXPECT_EQ(seen.size(), 3u);
    CsvStyle style;
    style.plain_names = style.units = true;
    const Table plain(to_csv(trajectory, style));
    EXPECT_EQ(plain.lines[0],
              "t,phase,r,phi,z,r_rate,phi_rate,z_rate,gap_bowl,rate_bowl,lambda_bowl,gap_post,rate_post,lambda_post,"
              "energy,j,held,work,loss");
    EXPECT_EQ(plain.lines[1], "s,,,rad,,,rad/s,,,,,,,,,,,,");
}

TEST(SeveralContacts, WhatIsHeldBelongsToItsSideOfAnImpact) {
    const Trajectory trajectory = test::run_gaps("ball_in_box");
    const std::size_t opening = test::event_near(trajectory, 5.907376894447645);
    const Table table(to_csv(trajectory));
    for (std::size_t i = 0; i + 1 < table.rows(); ++i) {
        if (table.number(i, "t") != trajectory.events[opening].t) continue;
        EXPECT_EQ(table.text(i, "held"), "floor");
        EXPECT_EQ(table.text(i, "phase"), "constrained");
        EXPECT_EQ(table.text(i + 1, "held"), "");
        EXPECT_EQ(table.text(i + 1, "phase"), "hybrid");
        EXPECT_EQ(table.number(i + 1, "j"), table.number(i, "j") + 1);
        return;
    }
    FAIL();
}

TEST(SeveralContacts, OneGapWithAForceHasWorkAndLoss) {
    const Trajectory trajectory = test::run_gaps("vibrating_table");
    const Table table(to_csv(trajectory));
    EXPECT_EQ(table.lines[0], "t,phase,y,y',gap,gap rate,lambda,energy,j,work,loss");
    EXPECT_EQ(table.number(table.rows() - 1, "work"), trajectory.work);
    EXPECT_EQ(table.number(table.rows() - 1, "loss"), trajectory.loss);
}

// ---- the summary and the text ----

TEST(SeveralContacts, TheSummaryNamesThem) {
    const std::string text = summary(test::run_gaps("pendulum_two_stops"));
    for (const char* words :
         {"in contact with knee, t = 4.85041", "  impact    t = 6.648636034", " of wall, opens knee\n",
          "  zeno      t = 10.4766021       of knee, th1 = ", "  release   t = 12.6709363       of knee, ",
          "until then other gaps stay above 0.", "energy drift (work subtracted) ", "\nwork ",
          " by forces, dissipation and moving surfaces, loss "})
        EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
    const std::string post = summary(test::run_gaps("bowl_and_post"));
    for (const char* words : {"in contact with bowl, post, t = 7.83",
                              "until then bowl stays held: its force is at least ", ", and the fraction [0.48",
                              "] of every impulse is transmitted to it", "end at t = 20 s, in contact with bowl, post"})
        EXPECT_NE(post.find(words), std::string::npos) << words << "\n" << post;
}

TEST(SeveralContacts, TheTextForGoldensNamesThem) {
    const std::string text = to_text(test::run_gaps("ball_in_box"));
    EXPECT_NE(text.find("phase constrained held floor ["), std::string::npos) << text;
    EXPECT_NE(text.find("impact of left opens floor t 5.9073"), std::string::npos) << text;
    EXPECT_NE(text.find("zeno of floor held floor t 7.8116"), std::string::npos) << text;
}

// In a wide V one contact comes to rest and the other's impact opens it, again and again.
TEST(SeveralContacts, ManyOpenedAndCompletedAreOneLine) {
    const auto model = test::typed(R"toml(
title = "Ball in a wide V"
[[coordinate]]
name = "x"
start = 0.3
[[coordinate]]
name = "y"
start = 1
[lagrangian]
kinetic = "x'^2/2 + y'^2/2"
potential = "y"
[[constraint]]
name = "left"
gap = "y + x/2"
restitution = 0.5
[[constraint]]
name = "right"
gap = "y - x/2"
restitution = 0.5
[run]
end_time = 20
)toml");
    const Trajectory trajectory = simulate(model, model->default_run());
    const std::vector<ChatterPhases> chatters = chatters_of(trajectory);
    ASSERT_EQ(chatters.size(), 1u) << to_text(trajectory);
    const ChatterPhases& chatter = chatters[0];
    ASSERT_GT(chatter.last, chatter.first + 8);
    for (std::size_t i = chatter.first_event; i < chatter.last_event; ++i)
        EXPECT_NE(trajectory.events[i].kind, Event::Kind::release);
    EXPECT_EQ(trajectory.events[chatter.last_event - 1].t, trajectory.phases[chatter.last - 1].end);
    const std::string text = summary(trajectory);
    EXPECT_NE(text.find(fmt::format("{} consecutive phases, t = ", chatter.last - chatter.first)), std::string::npos)
        << text;
    EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 60) << text;
}

}  // namespace
}  // namespace achilles
