// The statement that a proof makes: its parts, and its printed form.
#include "core/enclose/truth.hpp"
#include "output/proof.hpp"

namespace achilles::test {

namespace {

std::string refused(const Model& model, const achilles::EnclosureProblem& claim) {
    try {
        check(model, claim);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(EnclosureProblem, DecimalsBecomeIntervals) {
    for (const double exact : {0.0, 1.5, -2.0, 0.375, 1e10}) EXPECT_EQ(width(interval_of_decimal(exact)), 0.0) << exact;
    EXPECT_TRUE(contains(interval_of_decimal(0.1), Real(1) / 10));
    EXPECT_TRUE(contains(interval_of_decimal(-0.1), Real(-1) / 10));
    EXPECT_TRUE(contains(interval_of_decimal(std::numbers::pi / 6), scalar_pi<Real>() / 6));
    EXPECT_LT(width(interval_of_decimal(0.1)), 1e-15);
}

TEST(EnclosureProblem, SaysWhichPartOfItIsImpossible) {
    const auto model = load("ball_on_sine");
    achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    EXPECT_EQ(refused(*model, claim), "");
    claim.parameters.back() = Interval(0.9, 1.1);
    EXPECT_NE(refused(*model, claim).find("in [0.9, 1.1]: the part above 1 is impossible"), std::string::npos);
    claim.parameters.back() = Interval(0.5, 1.0 + 1e-6);  // more than rounding
    EXPECT_NE(refused(*model, claim).find("the part above 1 is impossible"), std::string::npos);
    claim.parameters.back() = Interval(0.5, 1.0 + 1e-15);
    EXPECT_EQ(refused(*model, claim), "");
    claim.parameters.back() = Interval(0.5);
    claim.q[1] = Interval(-0.1, 0.1);
    EXPECT_NE(refused(*model, claim).find("negative in part of the initial box: h <= -0.1 at x = 0, y = -0.1"),
              std::string::npos)
        << refused(*model, claim);
}

TEST(EnclosureProblem, PartsSayWhatTheirBoxSaysAndMore) {
    const auto model = load("ball_on_sine");
    achilles::Run run = model->default_run();
    run.options.end_time = 5.0;
    achilles::EnclosureProblem claim = widened(run, 1e-6);
    claim.times = {2.0, 3.0};
    const Enclosure whole = prove(model, claim), parts = prove_in_parts(model, claim, 2);
    ASSERT_TRUE(whole.end && parts.end);
    EXPECT_FALSE(parts.events_differ);
    std::size_t zeno = 0, of_parts = 0;
    while (whole.events[zeno].kind != Event::Kind::zeno) ++zeno;
    while (of_parts < parts.events.size() && parts.events[of_parts].kind == Event::Kind::impact) ++of_parts;
    for (std::size_t i = 0; i < std::min(zeno, of_parts); ++i) {
        EXPECT_LE(width(parts.events[i].t), 1.0001 * width(whole.events[i].t));
        EXPECT_GT(width(parts.events[i].t), 0.5 * width(whole.events[i].t));
    }
    ASSERT_EQ(parts.samples.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(whole.samples[0].q[i].contains(parts.samples[0].q[i]));
    // A box that cannot be proved as a whole may be proved in parts.
    EXPECT_THROW(prove_in_parts(model, claim, 1000), InputError);
}

// Parts that cut the bouncing after different numbers of impacts still share its Zeno point and the release.
TEST(EnclosureProblem, PartsMeetAtZenoPointsAndReleases) {
    const auto model = load("ball_on_sine");
    achilles::Run run = model->default_run();
    run.options.end_time = 12.0;
    achilles::EnclosureProblem claim = achilles::problem_of(run);
    claim.parameters.back() = Interval(0.499, 0.501);
    const Enclosure parts = prove_in_parts(model, claim, 16);
    ASSERT_TRUE(parts.end) << parts.outcome.message;
    EXPECT_FALSE(parts.events_differ);
    std::vector<const EnclosedEvent*> marks;
    int impacts = 0, before_first = 0;
    for (const EnclosedEvent& event : parts.events) {
        if (event.kind != Event::Kind::impact) marks.push_back(&event);
        before_first = marks.empty() ? ++impacts : before_first;
    }
    ASSERT_EQ(marks.size(), 2u);
    EXPECT_EQ(marks[0]->kind, Event::Kind::zeno);
    EXPECT_EQ(marks[1]->kind, Event::Kind::release);
    EXPECT_EQ(marks[0]->impacts, before_first) << "those that are listed";
    EXPECT_GT(marks[0]->most_impacts, marks[0]->impacts) << "parts cut it differently, which this test is about";
    run.options.tolerance = 1e-13;
    for (const double e : {0.499, 0.4997, 0.5, 0.501}) {
        run.parameters.back() = e;
        const Trajectory one = simulate(model, run);
        const auto enclosed = enclosed_events(one, parts);
        int seen = 0;
        for (std::size_t i = 0; i < enclosed.size(); ++i) {
            if (one.events[i].kind != Event::Kind::impact) {
                ASSERT_NE(enclosed[i], nullptr) << e;
            }
            if (enclosed[i] == nullptr) continue;
            EXPECT_TRUE((enclosed[i]->t + Interval(-1e-7, 1e-7)).contains(one.events[i].t)) << e << " " << i;
            ++seen;
        }
        EXPECT_GE(seen, 10) << e;
    }
}

// If one part proves that an event is absent and another part has it, the events differ, even if the first part stops
// early.
TEST(EnclosureProblem, PartsThatMissWhatOthersHitDiffer) {
    const auto model = typed(R"toml(
title = "A ball flies over a hump, or hits it"
[[coordinate]]
name = "x"
start = -3
rate = 1
[[coordinate]]
name = "y"
start = 1
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "0"
[[constraint]]
gap = "y - exp(-x^2)"
restitution = 0.5
[run]
end_time = 2.9
)toml");
    achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    claim.q[1] = Interval(0.5, 1.5);
    const Enclosure parts = prove_in_parts(model, claim, 20);
    EXPECT_FALSE(parts.end) << "one of them may graze";
    achilles::Run low = model->default_run();
    low.q[1] = 0.5;
    const Trajectory hits = simulate(model, low);
    ASSERT_FALSE(hits.events.empty());
    ASSERT_LT(hits.events[0].t, parts.proved_until) << "an impact before the time until which all is proved";
    EXPECT_TRUE(parts.events.empty());
    EXPECT_TRUE(parts.events_differ) << "else it is said that no member has an impact until then";
}

TEST(EnclosureProblem, MayBeStoppedAndSaysHowFarItIs) {
    const auto model = load("ball_on_sine");
    const achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    std::stop_source source;
    ProofMonitor watch{source.get_token()};
    EXPECT_TRUE(prove(model, claim, &watch).end);
    EXPECT_GT(watch.time, 0.9 * claim.run.options.end_time);
    source.request_stop();
    for (const Enclosure& stopped : {prove(model, claim, &watch), prove_in_parts(model, claim, 2, &watch)}) {
        EXPECT_EQ(stopped.outcome.kind, Enclosure::ProofOutcome::Kind::cancelled);
        EXPECT_FALSE(stopped.end);
    }
}

TEST(EnclosureProblem, OfRestitutionsHoldsAllOfThem) {
    const auto model = load("ball_on_sine");
    achilles::Run run = model->default_run();
    run.options.end_time = 2.65;
    achilles::EnclosureProblem claim = achilles::problem_of(run);
    claim.parameters.back() = Interval(0.4999, 0.5001);
    const Enclosure proved = prove(model, claim);
    ASSERT_GE(proved.events.size(), 3u) << proved.outcome.message;
    run.options.tolerance = 1e-13;
    for (const double e : {0.4999, 0.5, 0.5001}) {
        run.parameters.back() = e;
        const Trajectory one = simulate(model, run);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_TRUE((proved.events[i].t + Interval(-1e-11, 1e-11)).contains(one.events[i].t)) << e << " " << i;
            EXPECT_TRUE((proved.events[i].v_after[1] + Interval(-1e-11, 1e-11)).contains(one.events[i].v_after[1]))
                << e;
        }
    }
}

TEST(EnclosureProblem, IsWrittenWithEndsThatReadBack) {
    const auto model = load("ball_on_sine");
    achilles::Run run = model->default_run();
    run.options.end_time = 4.0;
    achilles::EnclosureProblem claim = widened(run, 1e-9);
    claim.times = {1.0, 3.0};
    const Enclosure proved = prove(model, claim);
    const auto json = nlohmann::json::parse(to_json(*model, claim, proved));
    EXPECT_EQ(json["proved_until"], 4.0);
    ASSERT_EQ(json["events"].size(), proved.events.size());
    EXPECT_EQ(json["events"][0]["t"][0].get<double>(), proved.events[0].t.lo());
    EXPECT_EQ(json["events"][0]["v_after"][1][1].get<double>(), proved.events[0].v_after[1].hi());
    EXPECT_FALSE(json["events"][0].contains("v"));
    EXPECT_EQ(json["end"]["q"][0][1].get<double>(), proved.end->q[0].hi());
    EXPECT_EQ(json["samples"].size(), 2u);
    EXPECT_EQ(json["outcome"]["kind"], "end time");
    EXPECT_EQ(json["claim"]["q"][0][0].get<double>(), claim.q[0].lo());
    const std::string text = proof_text(*model, claim, proved);
    EXPECT_NE(text.find("is proved until t = 4"), std::string::npos) << text;
    claim = widened(run, 1e-3);
    const Enclosure undecided = prove(model, claim);
    EXPECT_TRUE(nlohmann::json::parse(to_json(*model, claim, undecided))["end"].is_null());
    EXPECT_NE(proof_text(*model, claim, undecided).find("Undecided from there: "), std::string::npos);
}

}  // namespace achilles::test
