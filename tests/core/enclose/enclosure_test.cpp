// Enclosures of whole runs against 34-digit references.
#include "core/enclose/truth.hpp"

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "number/float_environment.hpp"

namespace achilles::test {

namespace {

Real real(const nlohmann::json& text) { return Real(text.get<std::string>()); }

Reals reals(const nlohmann::json& texts, std::size_t first, std::size_t count) {
    Reals result;
    for (std::size_t i = first; i < first + count; ++i) result.push_back(real(texts[i]));
    return result;
}

// Numbers of fig4.json that have an enclosure: their count, and how many are inside.
struct ComparisonCount {
    int all = 0, inside = 0;
    void add(bool is_inside) {
        ++all;
        inside += is_inside ? 1 : 0;
    }
};

ComparisonCount with_reference(const Enclosure& enclosure, const std::string& key) {
    const nlohmann::json expected = reference("fig4")["problems"][key];
    ComparisonCount compared;
    std::size_t zeno = 0, release = 0, impact = 0;
    for (const EnclosedEvent& event : enclosure.events) {
        if (event.kind == Event::Kind::impact) {
            const auto& listed = expected["impacts"][zeno];
            if (impact >= listed.size()) continue;
            const auto& state = listed[impact]["state"];
            compared.add(contains(event.t, real(listed[impact]["t"])));
            compared.add(contains(event.q, reals(state, 0, 2)));
            compared.add(contains(event.v_before, reals(state, 2, 2)));
            ++impact;
        } else if (event.kind == Event::Kind::zeno) {
            const auto& state = expected["zeno_states"][zeno];
            compared.add(contains(event.t, real(expected["zeno_times"][zeno])));
            compared.add(contains(event.q, reals(state, 0, 2)) && contains(event.v_before, reals(state, 2, 2)));
            ++zeno;
            impact = 0;
        } else {
            const auto& state = expected["detach_states"][release];
            compared.add(contains(event.t, real(expected["detach_times"][release])));
            compared.add(contains(event.q, reals(state, 0, 2)) && contains(event.v_before, reals(state, 2, 2)));
            ++release;
        }
    }
    if (enclosure.end) {
        const auto& state = expected["end_state"];
        compared.add(contains(enclosure.end->q, reals(state, 0, 2)) && contains(enclosure.end->v, reals(state, 2, 2)));
    }
    EXPECT_EQ(zeno, expected["zeno_times"].size());
    EXPECT_EQ(release, expected["detach_times"].size());
    return compared;
}

}  // namespace

// The widths agree with the table of the theory within a factor of 3.
TEST(Enclosure, HoldsAllDigitsOfThePapersTwoProblems) {
    const std::vector<double> zeno_widths[] = {{3.5e-12, 2.8e-11}, {9.6e-11, 3.1e-10, 1.2e-9}};
    const double end_widths[] = {1.9e-11, 7.2e-10};
    for (std::size_t i = 0; i < 2; ++i) {
        SCOPED_TRACE(problems[i].key);
        const auto model = load(problems[i].asset);
        const Enclosure proved = prove(model, problem_of(problems[i], *model));
        ASSERT_TRUE(proved.end) << proved.outcome.message;
        EXPECT_EQ(proved.proved_until, 20.0);
        const ComparisonCount compared = with_reference(proved, problems[i].key);
        EXPECT_EQ(compared.inside, compared.all);
        EXPECT_GT(compared.all, 50);
        std::size_t zeno = 0;
        for (const EnclosedEvent& event : proved.events)
            if (event.kind == Event::Kind::zeno) {
                EXPECT_LT(width(event.t), 3.0 * zeno_widths[i].at(zeno++));
            }
        EXPECT_LT(widest(proved.end->q), 3.0 * end_widths[i]);
        EXPECT_LT(widest(proved.end->v), 3.0 * end_widths[i]);
    }
}

// With an early cut, the error of the completion dominates the width. Without its nonzero center half of this fails.
TEST(Enclosure, HoldsThemWhereverTheBouncingIsCut) {
    for (const double eps_t : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
        for (const Problem& problem : problems) {
            SCOPED_TRACE(fmt::format("{} {}", problem.key, eps_t));
            const auto model = load(problem.asset);
            achilles::EnclosureProblem claim = problem_of(problem, *model);
            claim.eps_t = eps_t;
            claim.cut_early = true;
            const Enclosure proved = prove(model, claim);
            ASSERT_TRUE(proved.end) << proved.outcome.message;
            const ComparisonCount compared = with_reference(proved, problem.key);
            EXPECT_EQ(compared.inside, compared.all);
        }
}

// Restitutions of past regressions, and the ends of the range.
TEST(Enclosure, RunsTheBallAtAnyRestitution) {
    const auto model = load("ball_on_sine");
    const nlohmann::json expected = reference("ball_restitution");
    for (const auto& [e, times] : expected.items()) {
        if (e == "about") continue;
        achilles::EnclosureProblem claim = problem_of(problems[0], *model);
        claim.parameters.back() = Interval(std::stod(e));
        const Enclosure proved = prove(model, claim);
        ASSERT_TRUE(proved.end) << e << ": " << proved.outcome.message;
        std::size_t at = 0;
        for (const EnclosedEvent& event : proved.events)
            if (event.kind != Event::Kind::impact && at < times.size()) {
                EXPECT_NEAR(mid(event.t), times[at++].get<double>(), 1.5e-6);
            }
        EXPECT_EQ(at, 3u) << e;
    }
    for (const double e : {0.0, 0.9, 0.99, 1.0}) {
        achilles::EnclosureProblem claim = problem_of(problems[0], *model);
        claim.parameters.back() = Interval(e);
        EXPECT_TRUE(prove(model, claim).end) << e;
    }
}

// The default run of every system with one gap against 34 digits, except where the reference has no Taylor series.
TEST(Enclosure, HoldsTheTruthOfEveryGallerySystemOfOneGap) {
    int proved_ones = 0;
    for (const std::string& name : systems_of_one_gap()) {
        SCOPED_TRACE(name);
        const auto model = load(name);
        achilles::Run run = model->default_run();
        run.options.end_time = std::min(run.options.end_time, name == "triple_pendulum" ? 0.8 : 4.0);
        const Enclosure proved = prove(model, achilles::problem_of(run));
        EXPECT_TRUE(proved.end) << proved.outcome.message;
        if (!proved.end) continue;
        ++proved_ones;
        const State start = run.start();
        try {
            auto gap = model->evaluator(model->contact_terms(), run.parameters);
            set_state(gap, start);
            gap.run();
            const bool is_open = std::abs(gap.h()) > 1e-12;
            if (!is_open && std::abs(gap.hdot()) > 1e-12) continue;  // takes off: no reference
            TrueRuns runs(*model, run);
            const TrueExecution truth = is_open ? runs.run(point_of(start), run.options.end_time, 1e-10)
                                                : runs.run_from_contact(point_of(start), run.options.end_time, 1e-10);
            std::size_t at = 0;
            for (const EnclosedEvent& event : proved.events) {
                while (at < truth.events.size() && event.kind == Event::Kind::zeno &&
                       truth.events[at].kind == Event::Kind::impact)
                    ++at;
                if (at == truth.events.size()) break;
                if (event.kind == Event::Kind::impact && truth.events[at].kind == Event::Kind::zeno) continue;
                ASSERT_EQ(event.kind, truth.events[at].kind) << mid(event.t);
                EXPECT_TRUE(contains(event.t, truth.events[at].t)) << mid(event.t);
                if (event.kind == Event::Kind::impact) {
                    EXPECT_TRUE(contains(event.q, truth.events[at].point.q)) << mid(event.t);
                    EXPECT_TRUE(contains(event.v_before, truth.events[at].point.v)) << mid(event.t);
                }
                ++at;
            }
            EXPECT_TRUE(contains(proved.end->q, truth.end.q));
            EXPECT_TRUE(contains(proved.end->v, truth.end.v));
        } catch (const std::invalid_argument&) {  // a function without a series in the reference
        } catch (const std::runtime_error&) {     // bouncing that the reference does not follow to the end
        }
    }
    EXPECT_GE(proved_ones, 15);
}

// In flight, at times between the start and the first impact: the enclosure comes from steps alone.
TEST(Enclosure, HoldsFreeFlightAtFixedTimes) {
    const auto model = load("double_pendulum");
    achilles::Run run = model->default_run();
    run.options.end_time = 1.0;
    achilles::EnclosureProblem claim = achilles::problem_of(run);
    claim.times = {0.0, 0.1, 0.25, 0.5, 0.75};
    const Enclosure proved = prove(model, claim);
    ASSERT_TRUE(proved.end);
    ASSERT_EQ(proved.samples.size(), claim.times.size());
    TrueMotion motion(*model, run);
    Reals times(claim.times.begin(), claim.times.end());
    times.emplace_back(1.0);
    const auto truth = motion.flight_at(point_of(run.start()), times, 1e-28);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const EnclosedState& there = i < proved.samples.size() ? proved.samples[i] : *proved.end;
        EXPECT_TRUE(contains(there.q, truth[i].q) && contains(there.v, truth[i].v)) << there.t;
        EXPECT_LT(widest(there.q) + widest(there.v), 1e-12) << there.t;
    }
}

// At an impact the box contains both sides, and within a completion the whole interval. After an early stop there is no
// box.
TEST(Enclosure, AtTheTimeOfAnEventHoldsBothSides) {
    const auto model = load("ball_on_sine");
    achilles::EnclosureProblem claim = problem_of(problems[0], *model);
    claim.run.options.end_time = 4.0;
    const double impact = number(reference("fig4")["problems"]["ball"]["impacts"][0][0]["t"]);
    const double zeno = number(reference("fig4")["problems"]["ball"]["zeno_times"][0]);
    claim.times = {impact, zeno};
    for (const double eps_t : {0.0, 1e-3}) {
        claim.eps_t = eps_t;
        claim.cut_early = eps_t > 0.0;
        const Enclosure proved = prove(model, claim);
        ASSERT_EQ(proved.samples.size(), 2u);
        const EnclosedEvent& event = proved.events.front();
        ASSERT_EQ(event.kind, Event::Kind::impact);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_LE(proved.samples[0].v[i].lo(), std::min(event.v_before[i].hi(), event.v_after[i].hi()));
            EXPECT_GE(proved.samples[0].v[i].hi(), std::max(event.v_before[i].lo(), event.v_after[i].lo()));
        }
        const auto state = reference("fig4")["problems"]["ball"]["zeno_states"][0];
        EXPECT_TRUE(contains(proved.samples[1].q, reals(state, 0, 2)));
        EXPECT_TRUE(contains(proved.samples[1].v, reals(state, 2, 2)));
    }
}

TEST(Enclosure, PrintsNoStateAfterAnEarlyStop) {
    const auto model = load("ball_on_sine");
    achilles::EnclosureProblem claim = widened(model->default_run(), 1e-3);
    claim.run.options.end_time = 20.0;
    for (int i = 1; i < 200; ++i) claim.times.push_back(0.1 * i);
    const Enclosure proved = prove(model, claim);
    EXPECT_EQ(proved.outcome.kind, Enclosure::ProofOutcome::Kind::undecided);
    EXPECT_FALSE(proved.end);
    EXPECT_LT(proved.proved_until, 20.0);
    ASSERT_FALSE(proved.samples.empty());
    for (const EnclosedState& sample : proved.samples) EXPECT_LE(sample.t, proved.proved_until);
    for (const EnclosedEvent& event : proved.events) EXPECT_LE(event.t.lo(), proved.proved_until);
}

// The ball touches a crest at v_x = 5.64340560783886...; the pendulum's contact force touches zero at sqrt 5.
TEST(Enclosure, IsUndecidedWhereAMemberGrazesOrTouches) {
    const auto model = load("ball_on_sine");
    achilles::Run run = model->default_run();
    for (const double half : {1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4}) {
        achilles::EnclosureProblem claim = achilles::problem_of(run);
        claim.v[0] = Interval(5.64340560783886) + Interval(-half, half);
        EXPECT_EQ(prove(model, claim).outcome.kind, Enclosure::ProofOutcome::Kind::undecided) << half;
        for (const double side : {-30.0, 30.0}) {
            if (half < 1e-13) continue;
            claim.v[0] = Interval(5.64340560783886 + side * half) + Interval(-half, half);
            claim.run.options.end_time = 3.2;
            EXPECT_TRUE(prove(model, claim).end) << half << " " << side << prove(model, claim).outcome.message;
        }
    }
}

// In contact from the trough. With rate sqrt 5 the contact force touches zero on the way up.
TEST(Enclosure, IsUndecidedWhereTheContactForceOfAMemberTouchesZero) {
    const auto model = load("ball_on_sine");
    achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    claim.q = {-Interval::pi() / Interval(2.0), Interval(-1.0)};
    claim.run.options.end_time = 3.0;
    for (const double half : {1e-10, 1e-8, 1e-6}) {
        const auto with = [&](double shift) {
            claim.v = {sqrt(Interval(5.0)) + Interval(shift - half, shift + half), Interval(0.0)};
            return prove(model, claim);
        };
        const Enclosure on = with(0.0), below = with(-40.0 * half), above = with(40.0 * half);
        EXPECT_FALSE(on.end) << half;
        EXPECT_TRUE(below.end) << half << below.outcome.message;
        EXPECT_TRUE(below.events.empty());
        ASSERT_FALSE(above.events.empty()) << half << above.outcome.message;
        EXPECT_EQ(above.events.front().kind, Event::Kind::release);
    }
}

// Another rounding mode and denormals as zero on the calling thread do not change the enclosure.
TEST(Enclosure, StandsOnItsOwnGround) {
    const auto model = load("ball_on_floor");
    const achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    const Enclosure plain = prove(model, claim);
    const int rounding = std::fegetround();
    std::fesetround(FE_UPWARD);
    const Enclosure upward = prove(model, claim);
    std::fesetround(rounding);
#if defined(__SSE2__)
    const unsigned control = _mm_getcsr();
    _mm_setcsr(control | 0x8040u);  // denormals are zero
    const Enclosure flushed = prove(model, claim);
    EXPECT_EQ(_mm_getcsr() & 0x8040u, 0x8040u);
    _mm_setcsr(control);
    ASSERT_TRUE(flushed.end);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(plain.end->q[i].hi(), flushed.end->q[i].hi());
#endif
    ASSERT_TRUE(plain.end && upward.end);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(plain.end->q[i].lo(), upward.end->q[i].lo());
        EXPECT_EQ(plain.end->v[i].hi(), upward.end->v[i].hi());
    }
    EXPECT_NE(plain.assumptions.find("rounded to nearest"), std::string::npos);
}

TEST(Enclosure, RefusesWhatItDoesNotCover) {
    const auto model = load("ball_on_sine");
    achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    claim.parameters.back() = Interval(0.9, 1.1);
    EXPECT_THROW(prove(model, claim), InputError);
}

}  // namespace achilles::test
