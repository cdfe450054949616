// Jumps of the state and contacts that count only sometimes (theory-modes.md 1 to 3) against closed forms, by both
// methods.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/systems.hpp"
#include "simulate/batch.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {
namespace {

using std::numbers::pi;

double known_to(Method method) { return method == Method::taylor ? 1e-12 : 1e-7; }

// A point with the coordinate x. `potential` may contain x and t, `more` are further tables.
std::string point(double x, double v, const std::string& potential, const std::string& more) {
    return fmt::format(R"toml(coordinate = [{{name = "x", start = {}, rate = {}}}]
parameter = [{{name = "k", value = 0.5}}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "{}"
{}
)toml",
                       x, v, potential, more);
}

Trajectory run_until(const std::string& text, double end, Method method = Method::taylor, double tolerance = 1e-13) {
    const auto model = typed(text);
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    run.options.method = method;
    run.options.tolerance = method == Method::taylor ? tolerance : 1e-11;
    return simulate(model, run);
}

std::string words_of(const Trajectory& run) {
    std::string words;
    for (const Event& event : run.events)
        words += fmt::format("{}{}", words.empty() ? "" : " ", names_of(event.kind).word);
    return words;
}

void expect_end(const Trajectory& run, Outcome::Kind kind, const std::string& part) {
    EXPECT_EQ(run.outcome.kind, kind) << run.outcome.message;
    EXPECT_NE(run.outcome.message.find(part), std::string::npos) << run.outcome.message;
}

double energy_at(const Model& model, const Run& run, const State& state) {
    auto energy = model.evaluator(model.energy(), run.parameters);
    set_state(energy, state);
    energy.run();
    return energy.total();
}

TEST(Jump, HappensWhereItsFunctionFallsThroughZero) {
    for (const Method method : both_methods) {
        const auto run =
            run_until(point(0.5, 0.0, "x", R"toml(jump = [{name = "bounce", on = "(x)", set = {"x'" = "-k*x'"}}])toml"),
                      2.7, method);
        EXPECT_EQ(words_of(run), "jump jump jump");
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        EXPECT_NEAR(run.events[0].t, 1.0, known_to(method));
        EXPECT_NEAR(run.events[1].t, 2.0, known_to(method));
        EXPECT_NEAR(run.events[2].t, 2.5, known_to(method));
        EXPECT_NEAR(run.events[1].v_before[0], -0.5, known_to(method));
        EXPECT_NEAR(run.events[1].v_after[0], 0.25, known_to(method));
        EXPECT_EQ(run.phases.size(), 4u);
        EXPECT_NEAR(run.loss, 0.5 * (1.0 - 0.25 + 0.25 - 0.0625 + 0.0625 - 0.015625), known_to(method));
    }
}

// The function starts below zero and rises after many steps of a fast oscillation: only its fall is a jump.
TEST(Jump, IsArmedByARiseManyStepsLater) {
    for (const Method method : both_methods) {
        const auto run =
            run_until(point(1.0, 0.0, "1250*x^2",
                            R"toml(jump = [{name = "kick", on = "sin(0.3*t) - 0.5", set = {"x'" = "0"}}])toml"),
                      12.0, method);
        EXPECT_EQ(words_of(run), "jump");
        EXPECT_NEAR(run.events.at(0).t, pi / 0.36, known_to(method));
    }
}

TEST(Jump, BooksItsEnergyAsLossAndMayGain) {
    const auto run = run_until(
        point(0.5, 0.0, "x", R"toml(jump = [{name = "kick", on = "(x)", set = {x = "x + 1", "x'" = "1 + t"}}])toml"),
        3.0);
    ASSERT_EQ(words_of(run), "jump");
    EXPECT_NEAR(run.events[0].q_before()[0], 0.0, 1e-12);
    EXPECT_NEAR(run.events[0].q[0], 1.0, 1e-12);
    EXPECT_NEAR(run.loss, 0.5 - (2.0 + 1.0), 1e-11);
    const double before = energy_at(*run.model, run.run, run.run.start()),
                 after = energy_at(*run.model, run.run, run.end);
    EXPECT_NEAR(after - before, run.work - run.loss, 1e-11);
    const auto& event = run.events[0];
    Sampler sampler(run);
    EXPECT_NEAR(sampler.at(event.t).state.q[0], 1.0, 1e-12);
    EXPECT_NEAR(sampler.at(event.t - 1e-6).state.q[0], 1e-6, 1e-9);
}

TEST(Jump, FollowsOthersInTheOrderOfTheFile) {
    for (const Method method : both_methods) {
        const auto run = run_until(point(1.0, -1.0, "0", R"toml(
jump = [{name = "first", on = "(x)", set = {"x'" = "3 - x'"}}, {name = "second", on = "2*x", set = {"x'" = "2*x'"}},
    {name = "never", on = "3*x", when = "x' - 1", set = {x = "100"}}])toml"),
                                   2.0, method);
        ASSERT_EQ(words_of(run), "jump jump");  // `when` is taken before both
        EXPECT_EQ(run.events[0].jump->number, 0u);
        EXPECT_EQ(run.events[1].jump->number, 1u);
        EXPECT_EQ(run.events[0].t, run.events[1].t);
        EXPECT_NEAR(run.events[1].v_before[0], 4.0, known_to(method));
        EXPECT_NEAR(run.end.v[0], 8.0, known_to(method));
        EXPECT_EQ(run.phases.size(), 2u);
    }
}

TEST(Jump, DoesNotFollowAChangeOfSignByAnImpact) {
    for (const Method method : both_methods) {
        // -x' rises through zero at each top, and jumps from above to below zero at each impact.
        const auto tops = [&](const std::string& on) {
            return run_until(point(0.5, 0.0, "x",
                                   fmt::format(R"toml(
constraint = [{{name = "floor", gap = "x", restitution = 1}}]
jump = [{{name = "j", on = "{}", set = {{x = "x"}}}}])toml",
                                               on)),
                             4.5, method);
        };
        EXPECT_EQ(words_of(tops("-x'")), "impact impact");
        const auto run = tops("0 + x'");
        ASSERT_EQ(words_of(run), "impact jump impact jump");
        EXPECT_NEAR(run.events[1].t, 2.0, known_to(method));
        EXPECT_NEAR(run.events[3].t, 4.0, known_to(method));
    }
}

// An impact at t = 1 takes a positive function to 0, from where it falls or rises: it does not fall through zero.
TEST(Jump, DoesNotFollowAnImpactThatTakesItsFunctionToZero) {
    for (const auto& [e, on] : {std::pair("0", "1 - t - x'"),
                                {"0", "t - 1 - x'"},
                                {"1/2", "1/2 - x'"},
                                {"1/2", "5/2 - x' - 2*t"},
                                {"1", "3 - x' - 2*t"}})
        for (const Method method : both_methods) {
            SCOPED_TRACE(fmt::format("{} {} {}", e, on, to_text(method)));
            const auto run = run_until(point(0.5, 0.0, "x",
                                             fmt::format(R"toml(
constraint = [{{name = "floor", gap = "x", restitution = "{}"}}]
jump = [{{name = "j", on = "{}", set = {{x = "x + 1"}}}}])toml",
                                                         e, on)),
                                       1.25, method);
            EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
            EXPECT_TRUE(events_of(run, Event::Kind::jump).empty());
            EXPECT_LT(run.end.q[0], 0.5);
        }
}

TEST(Jump, AtAStartOnItsZeroIsNoEvent) {
    for (const Method method : both_methods)
        for (const double speed : {-1.0, 0.0, 1.0}) {
            const auto run =
                run_until(point(0.0, speed, "x", R"toml(jump = [{name = "j", on = "(x)", set = {"x'" = "0"}}])toml"),
                          3.0, method);
            EXPECT_EQ(words_of(run), speed > 0.0 ? "jump" : "") << speed;  // a thrown point comes back
            if (speed > 0.0) {
                EXPECT_NEAR(run.events[0].t, 2.0, known_to(method));
            }
        }
}

TEST(Jump, ComesAfterTheImpactsOfItsContact) {
    for (const Method method : both_methods) {
        const auto run = run_until(point(0.5, 0.0, "x", R"toml(
constraint = [{name = "floor", gap = "x", restitution = "k"}]
jump = [{name = "turn", on = "floor", when = "-0.9 - x'", set = {x = "x + 1", "x'" = "3*x'"}}])toml"),
                                   1.5, method);
        ASSERT_EQ(words_of(run), "impact jump");
        EXPECT_NEAR(run.events[0].v_after[0], 0.5, known_to(method));
        EXPECT_NEAR(run.events[1].v_after[0], 1.5, known_to(method));
        EXPECT_EQ(run.events[1].contacts, ContactSet::of(0));
        EXPECT_NEAR(run.end.q[0], 1.0 + 1.5 * 0.5 - 0.125, known_to(method));
    }
}

TEST(Jump, DecidesTheContactsAnew) {
    for (const Method method : both_methods) {
        // From the floor onto the floor: held before and after. The second jump lifts it off.
        const auto run = run_until(point(0.0, 0.0, "x", R"toml(
constraint = [{name = "floor", gap = "x", restitution = 0}]
jump = [{name = "stay", on = "1 - t", set = {x = "x"}}, {name = "lift", on = "2 - t", set = {"x'" = "1"}},
    {name = "hit", on = "3 - t", set = {x = "0", "x'" = "-1"}}])toml"),
                                   4.5, method);
        EXPECT_EQ(words_of(run), "jump jump jump impact zeno");
        EXPECT_TRUE(run.events[0].mode.is_held(0));
        EXPECT_FALSE(run.events[1].mode.is_held(0));
        EXPECT_EQ(run.events[2].t, run.events[3].t);
        EXPECT_TRUE(run.end_mode.is_held(0));
        EXPECT_NEAR(run.events[1].t, 2.0, known_to(method));
    }
}

TEST(Jump, IsNeverCut) {
    const std::string jump = R"toml(jump = [{name = "j", on = "floor", when = "-1", set = {x = "5"}}])toml",
                      floor = R"toml(constraint = [{name = "floor", gap = "x", restitution = "k"}])toml";
    EXPECT_NE(words_of(run_until(point(0.5, 0.0, "x", floor), 5.0)).find("zeno"), std::string::npos);
    const auto run = run_until(point(0.5, 0.0, "x", floor + "\n" + jump), 5.0);
    EXPECT_EQ(words_of(run).find("zeno"), std::string::npos);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::undecided) << run.outcome.message;
}

TEST(Jump, IsExcludedByCertificates) {
    const auto with = [](const std::string& on) {
        return point(0.5, 0.0, "x",
                     fmt::format(R"toml(constraint = [{{name = "floor", gap = "x", restitution = "k"}}]
jump = [{{name = "j", on = "{}", set = {{"x'" = "x'"}}}}])toml",
                                 on));
    };
    EXPECT_NE(words_of(run_until(with("5 - t"), 4.0)).find("zeno"), std::string::npos);
    const auto run = run_until(with("2.99999999 - t"), 4.0);  // just before the Zeno time
    const auto jump = std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.is_jump(); });
    ASSERT_NE(jump, run.events.end());
    EXPECT_NEAR(jump->t, 2.99999999, 1e-12);
    for (const Event& event : run.events)
        if (event.truncation) {
            EXPECT_GT(event.truncation->t, jump->t);
        }
}

TEST(Jump, WithoutEndHasAnOutcome) {
    const auto floor = R"toml(constraint = [{name = "floor", gap = "x", restitution = 0}])toml";
    expect_end(run_until(point(1.0, 0.0, "x", fmt::format("{}\n{}", floor, R"toml(
jump = [{name = "again", on = "floor", set = {x = "0", "x'" = "-1"}}])toml")),
                         4.0),
               Outcome::Kind::too_many_events, "they do not end");
    expect_end(
        run_until(point(0.5, 0.0, "x", R"toml(jump = [{name = "bounce", on = "(x)", set = {"x'" = "-k*x'"}}])toml"),
                  4.0),
        Outcome::Kind::too_many_events, "they do not end");
}

TEST(Jump, MayNotLeaveTheDomain) {
    const auto run = run_until(point(1.0, 0.0, "x", R"toml(
constraint = [{name = "floor", gap = "x", restitution = 0}]
jump = [{name = "sink", on = "0.5 - t", set = {x = "-0.25"}}])toml"),
                               4.0);
    expect_end(run, Outcome::Kind::left_the_domain, "after the jump 'sink' the gap of 'floor' is negative: h = -0.25");
    EXPECT_NEAR(run.end_time, 0.5, 1e-12);
    expect_end(
        run_until(point(1.0, 0.0, "x", R"toml(jump = [{name = "pole", on = "0.5 - t", set = {x = "log(x - 5)"}}])toml"),
                  4.0),
        Outcome::Kind::left_the_domain, "the jump 'pole' has no finite value");
}

TEST(Jump, IsUndecidedWhereItsConditionVanishes) {
    expect_end(run_until(point(1.0, -1.0, "0",
                               R"toml(jump = [{name = "j", on = "(x)", when = "t - 1", set = {x = "5"}}])toml"),
                         4.0),
               Outcome::Kind::undecided, "'when' of the jump 'j' is zero to within rounding");
}

// x = cos(t): the gap closes at pi/2, which does not count, rises at 3 pi/2 and closes at 5 pi/2, which counts.
const std::string gate = R"toml(constraint = [{name = "gate", gap = "x", restitution = 1, when = "t - 2"}])toml";

TEST(When, LetsAGapPassAndCountAgain) {
    for (const Method method : both_methods) {
        const auto run = run_until(point(1.0, 0.0, "x^2/2", gate), 8.5, method);
        ASSERT_EQ(words_of(run), "pass impact");
        EXPECT_NEAR(run.events[0].t, pi / 2, known_to(method));
        EXPECT_NEAR(run.events[1].t, 5 * pi / 2, known_to(method));
        EXPECT_EQ(run.events[0].inactive, ContactSet::of(0));
        EXPECT_TRUE(run.events[1].inactive.empty());
        EXPECT_TRUE(run.start_inactive.empty());
        EXPECT_TRUE(run.end_inactive.empty());
        EXPECT_EQ(run.phases.size(), 1u);
        Sampler sampler(run);
        EXPECT_EQ(sampler.at(4.6).inactive, ContactSet::of(0));
        EXPECT_TRUE(sampler.at(4.8).inactive.empty());
        EXPECT_GE(least_gap(run), -known_to(method));
        EXPECT_NEAR(run.end.q[0], std::cos(8.5 - 2 * pi) < 0 ? -std::cos(8.5) : std::cos(8.5), known_to(method));
    }
}

TEST(When, LetsARunStartBelowTheSurface) {
    for (const Method method : both_methods) {
        const auto run = run_until(point(-1.0, 0.0, "x^2/2", gate), 5.0, method);  // x = -cos(t)
        ASSERT_EQ(words_of(run), "impact");
        EXPECT_EQ(run.start_inactive, ContactSet::of(0));
        EXPECT_NEAR(run.events[0].t, 3 * pi / 2, known_to(method));
    }
}

TEST(When, DecidesAStartOnTheSurface) {
    const auto with = [](const std::string& when) {
        return fmt::format(R"toml(constraint = [{{name = "floor", gap = "x", restitution = 0, when = "{}"}}])toml",
                           when);
    };
    for (const Method method : both_methods) {
        EXPECT_TRUE(run_until(point(0.0, 0.0, "x", with("1")), 1.0, method).end_mode.is_held(0));
        const auto falls = run_until(point(0.0, 0.0, "x", with("-1")), 1.0, method);
        EXPECT_EQ(words_of(falls), "");
        EXPECT_EQ(falls.start_inactive, ContactSet::of(0));
        EXPECT_NEAR(falls.end.q[0], -0.5, known_to(method));
        const auto rises = run_until(point(0.0, 0.0, "-x", with("-1")), 1.0, method);
        EXPECT_TRUE(rises.start_inactive.empty());
        EXPECT_NEAR(rises.end.q[0], 0.5, known_to(method));
        const auto passes = run_until(point(0.0, -1.0, "x", with("-1")), 1.0, method);
        EXPECT_EQ(words_of(passes), "pass");
        EXPECT_EQ(passes.events[0].t, 0.0);
        EXPECT_EQ(words_of(run_until(point(0.0, -1.0, "x", with("1")), 1.0, method)), "impact zeno");
    }
    expect_end(run_until(point(0.0, 0.0, "0", with("k - 0.5")), 1.0), Outcome::Kind::undecided,
               "'when' of 'floor' is zero");
}

TEST(When, MustHoldOverACut) {
    const auto floor = [](const std::string& when) {
        return point(
            0.5, 0.0, "x",
            fmt::format(R"toml(constraint = [{{name = "floor", gap = "x", restitution = "k", when = "{}"}}])toml",
                        when));
    };
    EXPECT_NE(words_of(run_until(floor("5 - t"), 4.0)).find("zeno"), std::string::npos);
    const auto run = run_until(floor("2.99999999 - t"), 4.0);  // it stops counting just before the Zeno time
    EXPECT_EQ(words_of(run).find("zeno"), std::string::npos) << words_of(run);
    EXPECT_NE(words_of(run).find("pass"), std::string::npos) << words_of(run);
    EXPECT_LT(run.end.q[0], -0.1);
}

TEST(Jump, RunsAreTheSameInABatch) {
    const auto model =
        typed(point(0.5, 0.0, "x", R"toml(jump = [{name = "bounce", on = "(x)", set = {"x'" = "-k*x'"}}])toml"));
    const auto run_of = [&](std::size_t i) {
        achilles::Run run = model->default_run();
        run.options.end_time = 2.3;
        run.parameters[0] = 0.1 * static_cast<double>(i + 1);
        return run;
    };
    simulate_ends(model, 9, run_of, [&](std::size_t i, RunResult&& result) {
        const Trajectory alone = simulate(model, run_of(i));
        const auto& there = std::get<Trajectory>(result);
        EXPECT_EQ(there.end.q, alone.end.q);
        EXPECT_EQ(sequence_of(there), sequence_of(alone));
        EXPECT_TRUE(std::isnan(there.loss));  // without energies it is not known
    });
}

}  // namespace
}  // namespace achilles::test
