// JSON, CSV and the summary: formats that scripts depend on.
#include "output/output.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/systems.hpp"

namespace achilles {
namespace {

class Outputs : public testing::Test {
 protected:
    Outputs() : model(test::load("ball_on_sine")), trajectory(simulate(model, with(Conditions::paper))) {}
    achilles::Run with(Conditions conditions) const {
        auto run = model->default_run();
        run.options.truncation.conditions = conditions;
        return run;
    }
    std::shared_ptr<const Model> model;
    Trajectory trajectory;
};

std::vector<std::string> split(const std::string& line, char by) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, by);) parts.push_back(part);
    return parts;
}

TEST_F(Outputs, JsonHasTheKeysOfTheContract) {
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_EQ(json["achilles"], version());
    EXPECT_EQ(json["system"]["coordinates"], (nlohmann::json{"x", "y"}));
    EXPECT_EQ(json["system"]["parameters"]["g"], 1.0);
    for (const char* key : {"method", "tolerance", "conditions", "reinitialization", "eps_q", "eps_v", "eps_t"})
        EXPECT_TRUE(json["options"].contains(key)) << key;
    ASSERT_EQ(json["phases"].size(), 4u);
    EXPECT_EQ(json["phases"][0]["kind"], "hybrid");
    EXPECT_EQ(json["phases"][1]["kind"], "constrained");
    EXPECT_EQ(json["phases"][0]["end"], json["phases"][1]["start"]);
    std::size_t impacts = 0;
    for (const auto& event : json["events"]) {
        if (event["kind"] == "impact") {
            ++impacts;
            EXPECT_EQ(event["v_before"].size(), 2u);
            EXPECT_GT(event["impact_speed"].get<double>(), 0.0);
        } else if (event["kind"] == "zeno") {
            EXPECT_LT(event["truncation"]["t"].get<double>(), event["t"].get<double>());
            for (const char* key : {"t", "q", "v", "v_before", "impact_speed"})
                EXPECT_TRUE(event["truncation"].contains(key)) << key;
            const auto& c = event["certificate"];
            EXPECT_EQ(c["certified"], true);
            EXPECT_LT(c["zeno_time"][0].get<double>(), event["t"].get<double>());
            EXPECT_GT(c["zeno_time"][1].get<double>(), event["t"].get<double>());
            EXPECT_TRUE(c["shadowing_position"].is_null());
            EXPECT_TRUE(c["uniform_position"].is_null());
            for (const char* key : {"position_bound", "velocity_bound", "a_min", "a_max", "decisive", "e1", "e2",
                                    "beta", "eta", "zeta", "c1", "c2", "c3"})
                EXPECT_TRUE(c.contains(key)) << key;
        }
    }
    EXPECT_EQ(json["statistics"]["impacts"], impacts);
    EXPECT_EQ(json["end"]["t"], 20.0);
    EXPECT_EQ(json["end"]["phase"], "constrained");
    EXPECT_EQ(json["outcome"]["kind"], "end time");
    EXPECT_EQ(json["end"]["q"][0].get<double>(), trajectory.end.q[0]);  // the same double
}

TEST_F(Outputs, JsonHasTheNumbersOfEveryEvent) {
    const auto json = nlohmann::json::parse(to_json(trajectory));
    const auto numbers = [](const Vector& x) { return std::vector<double>(x.begin(), x.end()); };
    ASSERT_EQ(json["events"].size(), trajectory.events.size());
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        const auto& written = json["events"][i];
        const bool impact = event.kind == Event::Kind::impact;
        EXPECT_EQ(written["t"], event.t);
        EXPECT_EQ(written["q"], numbers(event.q));
        EXPECT_EQ(written[impact ? "v_after" : "v"], numbers(event.v_after));
        if (impact) {
            EXPECT_EQ(written["v_before"], numbers(event.v_before));
        }
        if (event.truncation) {
            EXPECT_EQ(written["truncation"]["v_before"], numbers(event.truncation->v_before));
            EXPECT_EQ(written["truncation"]["v"], numbers(event.truncation->v));
        }
    }
}

TEST_F(Outputs, SharpCertificatesBoundTheRestartedMotion) {
    const Trajectory sharp = simulate(model, with(Conditions::sharp));
    const auto json = nlohmann::json::parse(to_json(sharp));
    for (const auto& event : json["events"]) {
        if (event["kind"] != "zeno") continue;
        const auto& c = event["certificate"];
        EXPECT_EQ(c["conditions"], "sharp");
        EXPECT_LE(c["shadowing_position"].get<double>(), 1e-6);
        EXPECT_LE(c["shadowing_velocity"].get<double>(), 1e-6);
        EXPECT_LE(c["uniform_position"].get<double>(), 1e-6);
        EXPECT_GT(c["uniform_position"].get<double>(), c["shadowing_position"].get<double>());
        EXPECT_EQ(c["decisive"], "uniform position");
        EXPECT_FALSE(c.contains("e1"));
        EXPECT_EQ(c["inequalities"].size(), 5u);
    }
    const std::string text = summary(sharp);
    // Each number has one name, in the sentence, in the decisive bound, and in the JSON keys.
    EXPECT_NE(text.find(": uniform position;\n"), std::string::npos) << text;
    EXPECT_NE(text.find(": shadowing position and velocity;\n            tightest of the bounds: uniform position"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("m of the exact one (the omitted bounces are no higher)"), std::string::npos) << text;
}

TEST_F(Outputs, WhatIsNotFiniteIsNull) {
    trajectory.end.q[0] = std::numeric_limits<double>::quiet_NaN();
    trajectory.statistics.energy_drift = std::numeric_limits<double>::infinity();
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_TRUE(json["end"]["q"][0].is_null());
    EXPECT_TRUE(json["statistics"]["energy_drift"].is_null());
}

TEST_F(Outputs, CsvHasTwoRowsAtAnImpactTheSecondWithALargerJ) {
    const std::vector<std::string> lines = split(to_csv(trajectory), '\n');
    EXPECT_EQ(lines[0], "t,phase,x,y,x',y',gap,gap rate,lambda,energy,j");
    std::size_t pairs = 0, cuts = 0;
    for (std::size_t i = 2; i < lines.size(); ++i) {
        const auto before = split(lines[i - 1], ','), after = split(lines[i], ',');
        ASSERT_EQ(after.size(), 11u);
        EXPECT_GE(std::stod(after[6]), -1e-12);
        if (before[0] != after[0] || before[10] == after[10]) continue;
        ++pairs;
        EXPECT_EQ(std::stoi(after[10]), std::stoi(before[10]) + 1);
        const auto j = static_cast<std::size_t>(std::stoi(after[10]));
        if (j < trajectory.events.size() && trajectory.events[j].kind == Event::Kind::zeno) {
            // The last impact before a Zeno point: the row holds the state after the restart.
            EXPECT_EQ(std::stod(after[2 + 2]), trajectory.events[j].truncation->v[0]);
            EXPECT_NEAR(std::stod(after[7]), 0.0, 1e-15);
            ++cuts;
        } else if (after[1] == "hybrid" && before[1] == "hybrid") {
            EXPECT_NEAR(std::stod(after[7]), -0.5 * std::stod(before[7]), 1e-9 + 1e-6 * std::abs(std::stod(before[7])));
        }
    }
    EXPECT_EQ(pairs, trajectory.events.size());
    EXPECT_EQ(cuts, 2u);
    EXPECT_EQ(lines[1].substr(0, 13), "0,hybrid,0,2,");
}

TEST_F(Outputs, JsonSaysStartAndUnits) {
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_EQ(json["start"], (nlohmann::json{{"t", 0.0}, {"q", {0.0, 2.0}}, {"v", {1.5, 0.0}}}));
    EXPECT_EQ(json["units"],
              (nlohmann::json{
                  {"t", "s"}, {"x", "m"}, {"x'", "m/s"}, {"y", "m"}, {"y'", "m/s"}, {"m", "kg"}, {"g", "m/s^2"}}));
    EXPECT_FALSE(json.contains("samples"));
}

TEST(Sampling, EquidistantInstantsHaveBothEnds) {
    EXPECT_EQ(equidistant(2, 0.0, 0.3), (std::vector{0.0, 0.3}));
    EXPECT_EQ(equidistant(5, 1.0, 2.0), (std::vector{1.0, 1.25, 1.5, 1.75, 2.0}));
    EXPECT_EQ(equidistant(1000, 0.0, 0.7).back(), 0.7);
}

TEST_F(Outputs, ChosenInstantsAreTheOnlyRows) {
    // An impact, a Zeno point, a release: the state after each, in the requested order.
    std::vector<double> times{20.0, 0.0};
    for (const Event& event : trajectory.events) times.push_back(event.t);
    const std::vector<std::string> lines = split(to_csv(trajectory, {times, false, false}), '\n');
    ASSERT_EQ(lines.size(), times.size() + 1);
    const auto json = nlohmann::json::parse(to_json(trajectory, times));
    ASSERT_EQ(json["samples"].size(), times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
        const auto cells = split(lines[i + 1], ',');
        const auto& sample = json["samples"][i];
        EXPECT_EQ(std::stod(cells[0]), times[i]);
        EXPECT_EQ(sample["t"], times[i]);
        EXPECT_EQ(sample["phase"], cells[1]);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_EQ(sample["q"][k].get<double>(), std::stod(cells[2 + k]));
            EXPECT_EQ(sample["v"][k].get<double>(), std::stod(cells[4 + k]));
        }
        EXPECT_EQ(sample["j"], std::stoi(cells[10]));
        if (i < 2) continue;
        const Event& event = trajectory.events[i - 2];
        EXPECT_EQ(sample["j"], i - 1);
        const bool is_cut = event.kind == Event::Kind::impact && trajectory.events[i - 1].truncation;
        const Vector& after = is_cut ? trajectory.events[i - 1].truncation->v : event.v_after;
        EXPECT_NEAR(sample["v"][0].get<double>(), after[0], 1e-12);
        EXPECT_NEAR(sample["v"][1].get<double>(), after[1], 1e-12);
        EXPECT_EQ(sample["phase"], event.kind == Event::Kind::zeno ? "constrained" : "hybrid");
    }
}

TEST_F(Outputs, RowsAtChosenInstantsTellTheEventsSinceTheRowBefore) {
    const std::vector<double> times{0.0, 1.0, 2.0, 3.0, 4.0, 20.0, 5.0};
    const std::vector<std::string> lines = split(to_csv(trajectory, {times, false, false}), '\n');
    const std::vector<std::string> told{"event", "", "", "impact", "impact+zeno", "release", "impact+zeno", ""};
    for (std::size_t i = 0; i < told.size(); ++i)
        EXPECT_EQ(lines[i].substr(lines[i].rfind(',') + 1), told[i]) << lines[i];
    // At an event the sample is the state after it. Without requested times the rows are steps and events.
    const auto at = split(to_csv(trajectory, {std::vector{trajectory.events[0].t}, false, false}), '\n');
    EXPECT_EQ(at[1].substr(at[1].rfind(',') + 1), "impact");
    EXPECT_EQ(to_csv(trajectory).find("event"), std::string::npos);
}

TEST_F(Outputs, WhatTheRunDidNotReachHasNoSample) {
    auto run = with(Conditions::sharp);
    run.options.max_impacts = 3;
    const Trajectory stopped = simulate(model, run);
    ASSERT_LT(stopped.end_time, 20.0);
    EXPECT_EQ(samples_at(stopped, {0.0, stopped.end_time, std::nextafter(stopped.end_time, 20.0), 20.0}).size(), 2u);
}

std::string instants_told(const std::string& text) {
    try {
        read_instants(text, "t.txt", 0.0, 20.0);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Sampling, InstantsAreReadFromAFile) {
    EXPECT_EQ(read_instants("# seconds\n0\r\n\n 1/4 # a quarter\n20\n3", "t.txt", 0.0, 20.0),
              (std::vector{0.0, 0.25, 20.0, 3.0}));
    EXPECT_EQ(instants_told("0\n  20.5\n"),
              "t.txt:2:3: 20.5 is outside the run, 0 to 20; leave it out, or change --end\n      20.5\n      ^");
    EXPECT_EQ(instants_told("-1"),
              "t.txt:1:1: -1 is outside the run, 0 to 20; leave it out, or change --end\n    -1\n    ^");
    EXPECT_EQ(instants_told("0,4"),
              "t.txt:1:1: '0,4' is not a finite number: write a decimal point, 0.4\n    0,4\n    ^");
    EXPECT_EQ(instants_told("# none\n\n"), "t.txt: the file contains no time\nwrite one time per line");
}

TEST_F(Outputs, CsvCanBeHeadedForPythonAndWithUnits) {
    CsvStyle style;
    style.plain_names = style.units = true;
    const std::vector<std::string> lines = split(to_csv(trajectory, style), '\n');
    EXPECT_EQ(lines[0], "t,phase,x,y,x_rate,y_rate,gap,gap_rate,lambda_,energy,j");
    EXPECT_EQ(lines[1], "s,,m,m,m/s,m/s,m,m/s,N,J,");
    EXPECT_EQ(lines[2].substr(0, 13), "0,hybrid,0,2,");
    // Python keywords, and a name that is in use.
    const auto odd = test::typed(
        "title = \"odd\"\n[[coordinate]]\nname = \"is\"\nstart = 1\n[[coordinate]]\nname = \"is_rate\"\n"
        "[lagrangian]\nkinetic = \"is'^2 + is_rate'^2\"\npotential = \"is\"\n[[constraint]]\ngap = \"is\"\n"
        "restitution = 0.5\n[run]\nend_time = 0.1\n");
    EXPECT_EQ(split(to_csv(simulate(odd, odd->default_run()), {{}, true, false}), '\n')[0],
              "t,phase,is_,is_rate,is_rate_,is_rate_rate,gap,gap_rate,lambda_,energy,j");
}

TEST_F(Outputs, TheSummarySpeaksOfEveryZenoPointAndOfWhatIsNotCovered) {
    const std::string text = summary(trajectory);
    EXPECT_NE(text.find("zeno      t = 2.725142173"), std::string::npos) << text;
    EXPECT_NE(text.find("release   t = 3.73182"), std::string::npos) << text;
    EXPECT_NE(text.find("tau_inf in [2.725142172"), std::string::npos) << text;
    EXPECT_NE(text.find("tightest of the conditions: c3: velocity"), std::string::npos) << text;
    EXPECT_NE(text.find("do not cover"), std::string::npos) << text;
    EXPECT_NE(text.find("outcome: end time"), std::string::npos) << text;
}

TEST_F(Outputs, TheSummarySaysUnitsAndInWordsWhatIsBounded) {
    const std::string text = summary(simulate(model, with(Conditions::sharp)));
    for (const char* words : {"in flight, t = 0 to 2.72514216 s", "x = 4.6088", " m, y = -0.99",
                              "from the computed state at the cut: Zeno time tau_inf in [", "the Zeno point is within ",
                              " of the position at the cut, and its velocity within ",
                              "from the cut to tau_inf the computed position is within ", "gap speed 0.456469",
                              "x' = ", " m/s, y' = ", "Gap speed is |hdot|"})
        EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

TEST(Summary, APlasticLandingIsCalledSo) {
    const auto floor = test::load("ball_on_floor");
    auto run = floor->default_run();
    assign(run, floor->description(), "e=0");
    const Trajectory trajectory = simulate(floor, run);
    const std::string text = summary(trajectory);
    EXPECT_NE(text.find("  landing   t = 0.437768"), std::string::npos) << text;
    EXPECT_NE(text.find("contact begins: plastic impact"), std::string::npos);
    EXPECT_EQ(text.find("zeno "), std::string::npos);
    EXPECT_NE(text.find("restitution 0: no impact sequence is truncated\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("exact"), std::string::npos) << "its time is as exact as the integration: " << text;
    EXPECT_EQ(text.find("ertificates"), std::string::npos) << "there is none: " << text;
    EXPECT_TRUE(is_plastic_landing(test::events_of(trajectory, Event::Kind::zeno)[0]));
    const Trajectory bouncing = simulate(floor, floor->default_run());
    EXPECT_FALSE(is_plastic_landing(test::events_of(bouncing, Event::Kind::zeno)[0]));
}

// At a release of the pendulum theta1 = 0 except for rounding. The summary prints 0, JSON prints the computed number.
TEST(Summary, RoundingNoiseIsZeroForPeople) {
    const auto pendulum = test::load("double_pendulum");
    const Trajectory trajectory = simulate(pendulum, pendulum->default_run());
    const Event release = test::events_of(trajectory, Event::Kind::release)[0];
    ASSERT_NE(release.q[0], 0.0);
    ASSERT_LT(std::abs(release.q[0]), 1e-20);
    EXPECT_NE(summary(trajectory).find("theta1 = 0 rad, theta2 = 0 rad"), std::string::npos) << summary(trajectory);
    EXPECT_NE(to_json(trajectory).find(fmt::format("{}", release.q[0])), std::string::npos);
    EXPECT_EQ(flush_noise_to_zero(-5.6e-16, 12.0), 0.0);
    EXPECT_EQ(flush_noise_to_zero(1e-20, 1e-20), 1e-20);
    EXPECT_EQ(flush_noise_to_zero(2e-14, 1.0), 2e-14);
    const State scale = scale_of(trajectory);
    EXPECT_GT(scale.q[0], 0.5);
    EXPECT_GT(scale.v[0], 0.5);
}

TEST(Summary, EnergyThatDriftsByRoundingAloneIsNotExact) {
    EXPECT_EQ(drift_text(0.0), "below 1e-14");
    EXPECT_EQ(drift_text(9e-15), "below 1e-14");
    EXPECT_EQ(drift_text(1.234e-14), "1.2e-14");
}

TEST_F(Outputs, SayThatTheRunStarted) {
    // At the start of a run the gap may have its minimum.
    const auto hills = test::load("ball_on_hills");
    auto run = hills->default_run();
    run.options.end_time = 0.3;
    const Trajectory rising = simulate(hills, run);
    EXPECT_NE(summary(rising).find("least gap 0\n"), std::string::npos) << summary(rising);
    EXPECT_LT(std::abs(nlohmann::json::parse(to_json(rising))["statistics"]["least_gap"].get<double>()), 1e-14);
}

TEST_F(Outputs, LeastGapTextDistinguishesZeroRoundingAndPenetration) {
    EXPECT_EQ(least_gap_text(0.0, 1.0), "0");
    EXPECT_EQ(least_gap_text(-2.2e-16, 1.0), "0 to rounding");
    EXPECT_EQ(least_gap_text(-2.2e-16, 1e-3), "-2.2e-16");
    EXPECT_EQ(least_gap_text(-1e-3, 1.0), "-0.001");
}

TEST_F(Outputs, SayByWhichTolerancesAnUndecidedRunWasMadeAgain) {
    EXPECT_TRUE(nlohmann::json::parse(to_json(trajectory))["outcome"]["made_again_by"].is_null());
    EXPECT_TRUE(remarks(trajectory).empty());
    trajectory.rerun_options = trajectory.run.options;
    trajectory.rerun_options->tolerance = 1e-14;
    trajectory.rerun_options->truncation.eps_q = 1e-12;
    const auto again = nlohmann::json::parse(to_json(trajectory))["outcome"]["made_again_by"];
    EXPECT_EQ(again, (nlohmann::json{{"tolerance", 1e-14}, {"eps_q", 1e-12}, {"eps_v", 1e-6}, {"eps_t", 1e-6}}));
    const std::string told =
        "undecided at tolerance 1e-10: the whole run was repeated with tolerance 1e-14, eps_q 1e-12";
    EXPECT_EQ(remarks(trajectory).at(0).sentence, told);
    EXPECT_NE(summary(trajectory).find("\n  " + told + "\n\n"), std::string::npos) << summary(trajectory);
}

// Samples from the cut to the Zeno point belong to the hybrid phase, as the format requires, and name the held
// contacts.
TEST_F(Outputs, SamplesOfTheRestartedMotionAreMarked) {
    const Event zeno = test::events_of(trajectory, Event::Kind::zeno)[0];
    const double between = 0.5 * (zeno.truncation->t + zeno.t);
    const std::vector<double> times{0.1, between, zeno.t};
    const auto samples = nlohmann::json::parse(to_json(trajectory, times))["samples"];
    EXPECT_EQ(samples[0]["held"], nlohmann::json::array());
    EXPECT_EQ(samples[1]["held"], nlohmann::json{"contact"});
    EXPECT_EQ(samples[1]["phase"], "hybrid");
    EXPECT_EQ(samples[2]["held"], nlohmann::json{"contact"});
    const auto rows = split(to_csv(trajectory, {times, false, false}), '\n');
    EXPECT_EQ(split(rows[1], ',')[8], "0");
    EXPECT_GT(std::stod(split(rows[2], ',')[8]), 0.1) << "the force that holds it there";
}

TEST_F(Outputs, TextIsForGoldens) {
    const std::string text = to_text(trajectory);
    EXPECT_EQ(text.substr(0, 62), "phase hybrid [0, 2.72514217] impacts 23\nphase constrained [2.7");
}

}  // namespace
}  // namespace achilles
