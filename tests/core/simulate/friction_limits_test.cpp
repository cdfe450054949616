// What ends runs with dry friction, and friction whose coefficient is a parameter that is 0.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using Ending = Outcome::Kind;

Trajectory simulate_text(const std::string& text, double end, void (*choose)(Options&) = nullptr) {
    const auto model = derive(parse_system(text));
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    run.options.tolerance = 1e-14;
    if (choose != nullptr) choose(run.options);
    return simulate(model, run);
}

void expect_outcome(const Trajectory& run, Ending kind, const std::string& part) {
    EXPECT_EQ(run.outcome.kind, kind) << run.outcome.message;
    EXPECT_NE(run.outcome.message.find(part), std::string::npos) << run.outcome.message;
}

// A block on a floor. `keys` are further keys of the contact.
std::string sliding_block(double speed, const std::string& keys) {
    return fmt::format(R"(coordinate = [{{name = "x", rate = {}}}, {{name = "y"}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{{name = "foot", gap = "y", restitution = 0, slip = "x'", {}}}]
)",
                       speed, keys);
}

// The load on a block that lies on two corners falls to 0 at t = 1. Friction shares it unequally, so both forces vanish
// there at once, and the block flies off: x = 6 - 5 mu/6 and y = 1/6 at t = 2.
TEST(FrictionRelease, OfTwoCornersAtOnceFollowsTheClosedForm) {
    for (const bool is_exact : {true, false}) {
        const auto run = simulate_text(
            R"(coordinate = [{name = "x", rate = 3}, {name = "y", force = "t - 1"}, {name = "phi"}]
body = [{name = "block", mass = 1, box = [2, 1], at = ["x", "y + 1/2"], angle = "phi"}]
ground = [{name = "floor", line = [[-1, 0], [1, 0]]}]
constraint = [{name = "left", between = ["block.lower_left", "floor"], friction = 0.2, restitution = 0},
              {name = "right", between = ["block.lower_right", "floor"], friction = 0.2, restitution = 0}]
)",
            2.0, is_exact ? nullptr : +[](Options& options) { options.tolerance = 1e-10; });
        ASSERT_EQ(run.outcome.kind, Ending::end_time) << run.outcome.message;
        EXPECT_FALSE(run.rerun_options) << run.rerun_reason;  // both gaps start with zeros of order 3
        ASSERT_EQ(run.events.size(), 1u);
        EXPECT_TRUE(run.events[0].is_release());
        EXPECT_EQ(run.events[0].contacts.count(), 2);
        EXPECT_NEAR(run.events[0].t, 1.0, 1e-7);  // the forces touch zero with the error of the state
        EXPECT_NEAR(run.end.q[0], 6.0 - 0.2 * 5.0 / 6.0, 1e-12);
        EXPECT_NEAR(run.end.q[1], 1.0 / 6.0, 1e-12);
        EXPECT_NEAR(run.end.q[2], 0.0, 1e-12);
    }
}

// A lift of t takes the load 1 - t off a block that sticks, and the force c (1 - t) along the floor goes with it, typed
// in another way. So the contact force and both limits of friction vanish at once, in an order that rounding decides:
// the block flies off, and at t = 2 it is at x = -c/6 and y = 1/6.
TEST(FrictionRelease, OfABlockWhoseLimitsVanishWithItsForce) {
    for (const double mu : {0.1, 0.3, 0.7, 1.3}) {
        for (const double part : {-0.9, -1.0 / 3.0, 0.0, 0.1, 0.97}) {
            const double c = part * mu;
            SCOPED_TRACE(fmt::format("mu = {}, c = {}", mu, c));
            const std::string text = fmt::format(
                R"-(coordinate = [{{name = "x", force = "{}*(1 - t^2)/(1 + t)"}}, {{name = "y", force = "t"}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{{name = "foot", gap = "y", restitution = 0, slip = "x'", friction = {}}}]
)-",
                c, mu);
            for (const bool taylor : {true, false}) {
                const auto run = simulate_text(
                    text, 2.0, taylor ? nullptr : +[](Options& options) {
                        options.method = Method::dopri5;
                        options.tolerance = 1e-10;
                    });
                ASSERT_EQ(run.outcome.kind, Ending::end_time) << run.outcome.message;
                ASSERT_EQ(run.events.size(), 1u);
                EXPECT_TRUE(run.events[0].is_release());
                EXPECT_NEAR(run.events[0].t, 1.0, 1e-14);
                EXPECT_NEAR(run.end.q[0], -c / 6.0, taylor ? 1e-12 : 1e-8);
                EXPECT_NEAR(run.end.q[1], 1.0 / 6.0, taylor ? 1e-12 : 1e-8);
            }
        }
    }
}

// Forces of x = 1 that change by 20 with the last bit of x: whether the foot is pressed and whether the joint holds is
// true of the numbers, but not of all states within rounding.
TEST(FrictionDecision, HoldsForAllStatesWithinRounding) {
    const char* const foot = R"-(coordinate = [{name = "x", start = 1}, {name = "y"}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y*(1 + 1e17*(x - 1))"
friction = [{name = "joint", slip = "x'", level = 1}]
constraint = [{name = "foot", gap = "y", restitution = 0}]
)-";
    const char* const joint = R"-(coordinate = [{name = "x", start = 1, force = "0.5 + 1e17*(x - 1)"}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "0"
friction = [{name = "joint", slip = "x'", level = 1}]
)-";
    for (const char* const text : {foot, joint})
        expect_outcome(simulate_text(text, 1.0), Ending::undecided, "cannot decide whether");
}

// The slider of a crank lies on two corners, is pulled off, and lands on the other side, five times. With friction 0 the
// run is that without friction.
TEST(FrictionRelease, OfASliderWithClearanceGoesOnToItsEnd) {
    std::ifstream file(ACHILLES_SOURCE_DIR "/tests/reference/mechanisms/slider_crank_clearance.toml");
    std::string smooth{std::istreambuf_iterator<char>(file), {}};
    const auto replace = [](std::string text, const std::string& from, const std::string& to) {
        for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
            text.replace(at, from.size(), to);
        return text;
    };
    smooth = replace(smooth, "restitution = \"e\"", "restitution = 0");
    const auto rough = [&](const std::string& mu) {
        return replace(replace(smooth, "{name = \"e\"", "{name = \"mu\", value = " + mu + "}, {name = \"e\""),
                       "restitution = 0", "restitution = 0, friction = \"mu\"");
    };
    const Trajectory reference = simulate_text(smooth, 0.0838), zero = simulate_text(rough("0"), 0.0838),
                     some = simulate_text(rough("0.01"), 0.0838);
    for (const Trajectory* run : {&reference, &zero, &some}) {
        EXPECT_EQ(run->outcome.kind, Ending::end_time) << run->outcome.message;
        EXPECT_EQ(std::count_if(run->events.begin(), run->events.end(),
                                [](const Event& event) { return event.is_release(); }),
                  5);
    }
    EXPECT_LT((reference.end.q - zero.end.q).norm(), 1e-9);
    EXPECT_NEAR(reference.end.q[0], 7.588340739596945, 1e-9);  // e = 0.4: its impacts collapse to plastic ones
    EXPECT_GT((reference.end.q - some.end.q).norm(), 1e-3);
    EXPECT_GT(some.heat, 0.0);
}

TEST(FrictionDomain, EndsWhereACoefficientIsNegative) {
    const auto run = simulate_text(sliding_block(3.0, R"(friction = "0.5 - x/4")"), 10.0);
    expect_outcome(run, Ending::left_the_domain, "the friction of 'foot' falls below 0");
    EXPECT_NEAR(run.end.q[0], 2.0, 1e-12);
    expect_outcome(simulate_text(R"(coordinate = [{name = "x", rate = 1}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "0"
friction = [{name = "guide", slip = "x'", level = "0.1 - t/10"}]
)",
                                 8.0),
                   Ending::left_the_domain, "the level of 'guide' falls below 0");
}

TEST(FrictionDomain, EndsWhereTheStaticCoefficientIsBelowTheKineticOne) {
    const auto run = simulate_text(sliding_block(1.0, R"(friction = 0.3, static_friction = "0.5 - t/10")"), 10.0);
    expect_outcome(run, Ending::left_the_domain,
                   "the static friction of 'foot' falls below its friction at slip 0, 0.3");
    EXPECT_NEAR(run.end.t, 2.0, 1e-12);
}

// Where the coefficient comes back to 0 at rest, as that of viscous friction, nothing is wrong.
TEST(FrictionDomain, ContainsCoefficientsThatAreZero) {
    const auto run = simulate_text(R"(coordinate = [{name = "x", rate = 1}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{name = "guide", slip = "x'", level = "slip/2"}]
)",
                                   10.0);
    EXPECT_EQ(run.outcome.kind, Ending::end_time) << run.outcome.message;
    const double w = std::sqrt(15.0 / 16.0);  // x'' + x'/2 + x = 0
    EXPECT_NEAR(run.end.q[0], std::exp(-2.5) * std::sin(10.0 * w) / w, 1e-12);
}

TEST(FrictionEvents, AreLimited) {
    const std::string belt = R"(coordinate = [{name = "x", rate = 0.2}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{name = "belt", slip = "x' - 0.2", level = 0.4, static_level = 1}]
)";
    const auto run = simulate_text(belt, 100.0, [](Options& options) { options.max_events = 3; });
    expect_outcome(run, Ending::too_many_events, "3 sticks, slips and reversals");
    EXPECT_EQ(run.events.size(), 3u);
    EXPECT_EQ(to_text(run.outcome.kind), "too many events");
    EXPECT_EQ(run.outcome.message.find("try a larger"), std::string::npos) << "said once, by the summary";
    EXPECT_EQ(simulate_text(belt, 100.0).outcome.kind, Ending::end_time);
}

// A slip typed along the normal: pressing and sticking are one force.
TEST(FrictionLimits, ASlipAlongTheNormalIsNamed) {
    const std::string text = R"(coordinate = [{name = "x", rate = 1}, {name = "y"}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{name = "floor", gap = "y", slip = "2*y'", restitution = 0, friction = 0.3}]
)";
    expect_outcome(simulate_text(text, 1.0), Ending::redundant_contacts,
                   "the slip of 'floor' is a multiple of its gap rate");
}

// Two bearings of one shaft: how they share the friction is not determined, and nothing depends on it.
TEST(FrictionLimits, JointsThatStickWithOneSlipAreNamed) {
    const std::string text = R"(coordinate = [{name = "x", rate = 1}, {name = "y", rate = 9}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "0"
friction = [{name = "left", slip = "x'", level = 1}, {name = "rail", slip = "y'", level = 1},
            {name = "right", slip = "2*x'", level = 1}]
)";
    const auto run = simulate_text(text, 5.0);
    expect_outcome(run, Ending::redundant_contacts,
                   "'left' and 'right' stick with one slip, and only the sum of their friction forces is determined; "
                   "write one [[friction]] for both");
    EXPECT_NEAR(run.end_time, 1.0 / 3.0, 1e-12);
    EXPECT_EQ(advice(run), "Remove a redundant contact or the friction of one.");
    Trajectory smooth = simulate_text(R"(coordinate = [{name = "y", start = 1}]
lagrangian.kinetic = "y'^2/2"
lagrangian.potential = "y"
constraint = [{gap = "y", restitution = 0}]
)",
                                      0.1);
    smooth.outcome.kind = Ending::redundant_contacts;
    EXPECT_EQ(advice(smooth), "Remove a redundant contact.");
}

// Kane's paradox: T rises from 0.5 to 0.6328125 (theory-friction.md 3).
std::string skew_body(const std::string& coordinates, const std::string& keys) {
    return fmt::format(R"(coordinate = [{}]
lagrangian.kinetic = "(x'^2 - 1.2*x'*y' + y'^2)/1.28"
lagrangian.potential = "0"
constraint = [{{name = "tip", gap = "y", slip = "x'", {}}}]
)",
                       coordinates, keys);
}

TEST(EnergyGain, IsCappedOrStopsTheRun) {
    const std::string text = skew_body(R"({name = "x", rate = -0.6}, {name = "y", start = 1, rate = -1})",
                                       "restitution = 0.9, friction = 1");
    const auto capped = simulate_text(text, 1.5);
    EXPECT_EQ(capped.outcome.kind, Ending::end_time) << capped.outcome.message;
    ASSERT_EQ(capped.events.size(), 1u);
    EXPECT_NEAR(capped.events[0].v_after[0], 0.0, 1e-15);
    EXPECT_NEAR(capped.events[0].v_after[1], 0.8, 1e-12);
    ASSERT_TRUE(capped.events[0].friction->energy_cap);
    EXPECT_NEAR(*capped.events[0].friction->energy_cap, 0.8 / 0.9, 1e-12);
    EXPECT_NEAR(capped.loss + capped.heat, 0.0, 1e-12);
    const auto stopped =
        simulate_text(text, 1.5, [](Options& options) { options.energy_gain = achilles::EnergyGain::stop; });
    expect_outcome(stopped, Ending::energy_gain, "the impact of 'tip' would change the energy by 0.132812");
    EXPECT_NEAR(stopped.end.t, 1.0, 1e-12);
    EXPECT_EQ(to_text(stopped.outcome.kind), "energy gain");
}

// A foot that never slides, of a skew body: the friction force pushes, as the contact force vanishes at t = 1.
TEST(NeverSlidingFoot, IsReleasedOrWouldHaveToPull) {
    const auto push = [](double along, double start) {
        return skew_body(fmt::format(R"({{name = "x", force = {}}}, {{name = "y", force = "t - {}"}})", along, start),
                         R"(restitution = 0, friction = "inf")");
    };
    const auto leaves = simulate_text(push(1.0, 1.0), 1.5);
    EXPECT_EQ(leaves.outcome.kind, Ending::end_time) << leaves.outcome.message;
    ASSERT_EQ(leaves.events.size(), 1u);
    EXPECT_TRUE(leaves.events[0].is_release());
    EXPECT_NEAR(leaves.events[0].t, 1.0, 1e-12);
    // hddot = 0.6 + (t - 1)
    EXPECT_NEAR(leaves.end.q[1], 0.3 * 0.25 + 0.125 / 6.0, 1e-12);
    const auto penetrates = simulate_text(push(-1.0, 1.0), 1.5);
    expect_outcome(penetrates, Ending::painleve,
                   "with the acceleration -0.6: a foot that never slides would have to pull");
    EXPECT_NEAR(penetrates.end.t, 1.0, 1e-12);
    expect_outcome(simulate_text(push(-1.0, -0.2), 1.5), Ending::painleve,
                   "no motion from here: a foot that never slides would have to pull");
}

// ---- a coefficient that is 0 ----

TEST(FrictionOfZero, IsNoneWhereItIsANumber) {
    EXPECT_FALSE(derive(parse_system(sliding_block(1.0, "friction = 0")))->has_friction());
}

// Events of contacts; those of friction cannot happen.
void expect_same_events(const std::string& text, double end) {
    const auto with_friction = [&](const std::string& value) {
        std::string filled = text;
        for (std::size_t at = 0; (at = filled.find("MU", at)) != std::string::npos;) filled.replace(at, 2, value);
        return simulate_text("parameter = [{name = \"mu\", value = 0}]\n" + filled, end);
    };
    const Trajectory smooth = with_friction("0"), rough = with_friction("\"mu\"");
    EXPECT_FALSE(smooth.model->has_friction());
    EXPECT_TRUE(rough.model->has_friction());
    EXPECT_EQ(rough.outcome.kind, smooth.outcome.kind) << rough.outcome.message;
    ASSERT_EQ(rough.events.size(), smooth.events.size());
    for (std::size_t i = 0; i < smooth.events.size(); ++i) {
        EXPECT_EQ(rough.events[i].kind, smooth.events[i].kind) << i;
        EXPECT_EQ(rough.events[i].contacts, smooth.events[i].contacts) << i;
        EXPECT_NEAR(rough.events[i].t, smooth.events[i].t, 1e-12) << i;
        EXPECT_LT((rough.events[i].v_after - smooth.events[i].v_after).cwiseAbs().maxCoeff(), 1e-12) << i;
    }
    EXPECT_LT((rough.end.q - smooth.end.q).cwiseAbs().maxCoeff(), 1e-11);  // after up to 20 s
    EXPECT_EQ(rough.end_mode.held(), smooth.end_mode.held());
    EXPECT_EQ(rough.heat, 0.0);
    EXPECT_NEAR(rough.loss, smooth.loss, 1e-12);
}

TEST(FrictionOfZero, ChangesNoEvent) {
    const auto ball = [](double speed, double e, const std::string& gap, const std::string& slip) {
        return fmt::format(R"-(coordinate = [{{name = "x", rate = {}}}, {{name = "y", start = 1.5}}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{{gap = "{}", restitution = {}, slip = "{}", friction = MU}}]
)-",
                           speed, gap, e, slip);
    };
    expect_same_events(ball(0.0, 0.0, "y", "x'"), 5.0);  // the slip is 0 throughout
    expect_same_events(ball(0.0, 0.5, "y", "x'"), 3.0);
    expect_same_events(ball(1.0, 0.0, "y - sin(x)", "x' + cos(x)*y'"), 20.0);  // turns in a valley, and is not stopped
    expect_same_events(ball(1.0, 0.7, "y - sin(x)", "x' + cos(x)*y'"), 2.0);
    expect_same_events(R"-(coordinate = [{name = "x", start = 1, rate = 2, force = "-x"}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "0"
constraint = [{gap = "x + 1", restitution = 0.5}]
friction = [{name = "guide", slip = "x'", level = MU}]
)-",
                       3.0);
}

// Two corners of a block that rocks (e = 0): both closed at each impact.
TEST(FrictionOfZero, ChangesNoImpactOfTwoContacts) {
    expect_same_events(R"-(coordinate = [{name = "x"}, {name = "y", start = "2*cos(0.15) + sin(0.15)/2"},
              {name = "phi", start = 0.15}]
lagrangian.kinetic = "(x'^2 + y'^2 + 17/12*phi'^2)/2"
lagrangian.potential = "10*y"
[[constraint]]
name = "left"
gap = "y - sin(phi)/2 - 2*cos(phi)"
restitution = 0
slip = "x' + (sin(phi)/2 + 2*cos(phi))*phi'"
friction = MU
[[constraint]]
name = "right"
gap = "y + sin(phi)/2 - 2*cos(phi)"
restitution = 0
slip = "x' - (sin(phi)/2 - 2*cos(phi))*phi'"
friction = MU
)-",
                       1.5);
}

}  // namespace
}  // namespace achilles
