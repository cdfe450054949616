// Impacts closer in time than their errors: decided where their order does not matter, one simultaneous impact where it
// does (theory-gaps.md 2.4).
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"

namespace achilles::test {
namespace {

// A ball falls into the corner of a wall and a floor. It reaches the wall `apart` seconds after the floor; `apart` may
// be negative.
std::shared_ptr<const Model> corner(double height, double apart) {
    const double fall = std::sqrt(2.0 * height / 9.81), x = 1.5 * (fall + apart) * (fall + apart);
    return typed(fmt::format(R"toml(
title = "Corner"
coordinate = [{{ name = "x", start = {:.17g} }}, {{ name = "y", start = {} }}]
lagrangian = {{ kinetic = "(x'^2 + y'^2)/2", potential = "3*x + 9.81*y" }}
constraint = [{{ name = "wall", gap = "x", restitution = 0.5 }}, {{ name = "floor", gap = "y", restitution = 0.5 }}]
[run]
end_time = {}
)toml",
                             x, height, 4.0 * fall));
}

TEST(SimultaneousImpacts, NeedNoOrderInACorner) {
    for (const double height : {0.3, 1.0, 2.7})
        for (const double size : {0.0, 1e-17, 1e-16, 3e-16, 1e-15, 2e-15, 5e-15, 1e-14, 3e-14, 1e-13, 1e-12, 1e-10})
            for (const double apart : {size, -size})
                for (const Method method : both_methods) {
                    SCOPED_TRACE(fmt::format("{} {} {}", height, apart, to_text(method)));
                    const auto model = corner(height, apart);
                    auto run = model->default_run();
                    run.options.method = method;
                    const Trajectory trajectory = simulate(model, run);
                    ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
                    EXPECT_EQ(trajectory.ambiguous_impacts, 0);
                    EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(0).with(1));
                    EXPECT_LT(trajectory.end.q.norm() + trajectory.end.v.norm(), 1e-12);
                    const double fall = std::sqrt(2.0 * height / 9.81);
                    for (std::size_t i = 0; i < 4; ++i) {  // each contact as if it impacted alone
                        const Event& event = trajectory.events[i];
                        if (!event.contacts.has_one()) continue;
                        const double speed = event.contacts.contains(0) ? 3.0 : 9.81;
                        const bool first = event.t < 1.5 * fall;
                        EXPECT_NEAR(event.t, first ? fall : 2.0 * fall, 1e-9);
                        EXPECT_NEAR(event.impact_speed, speed * fall * (first ? 1.0 : 0.5), 1e-8);
                    }
                }
}

// A ball falls on the axis of a V of half angle 0.6, and hits both walls at once. The V and the weight are rotated by
// phi.
TEST(SimultaneousImpacts, AreOneOnTheAxisOfATurnedV) {
    for (int i = 0; i < 80; ++i) {
        const double phi = -0.4 + 0.01 * i;
        SCOPED_TRACE(phi);
        const auto model = typed(fmt::format(R"toml(
title = "V"
coordinate = [{{ name = "x", start = {:.17g} }}, {{ name = "y", start = {:.17g} }}]
parameter = [{{ name = "phi", value = {} }}]
lagrangian = {{ kinetic = "(x'^2 + y'^2)/2", potential = "9.81*(-sin(phi)*x + cos(phi)*y)" }}
constraint = [{{ name = "l", gap = "cos(phi + 0.6)*y - sin(phi + 0.6)*x", restitution = 0.5 }},
              {{ name = "r", gap = "cos(phi - 0.6)*y - sin(phi - 0.6)*x", restitution = 0.5 }}]
[run]
end_time = 2
)toml",
                                             -std::sin(phi), std::cos(phi), phi));
        const Trajectory trajectory = simulate(model, model->default_run());
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(0).with(1));
        EXPECT_GE(trajectory.ambiguous_impacts, 1);
        EXPECT_EQ(trajectory.events[0].contacts.count(), 2);
        EXPECT_EQ(trajectory.events[1].contacts.count(), 2);
        EXPECT_NEAR(trajectory.events[1].t, 3.0 * std::sqrt(2.0 / 9.81) - std::sqrt(2.0 / 9.81), 1e-9);
    }
}

// One wall of the V is moved, so that it would be hit later by some units in the last place of the time. From 16 units
// on the impacts have an order.
TEST(SimultaneousImpacts, AreOneWithinTheResolutionOfTime) {
    const double fall = std::sqrt(2.0 / 9.81), speed = 9.81 * fall * std::cos(0.6);
    for (const double start : {10.0, 1000.0})
        for (const double units : {0.0, 6.0, 12.0, 40.0}) {
            SCOPED_TRACE(fmt::format("{} {}", start, units));
            const double unit = std::nextafter(start + fall, 2.0 * start) - (start + fall);
            const auto model = typed(fmt::format(R"toml(
title = "V"
coordinate = [{{ name = "x", start = 0 }}, {{ name = "y", start = 1 }}]
lagrangian = {{ kinetic = "(x'^2 + y'^2)/2", potential = "9.81*y" }}
constraint = [{{ name = "l", gap = "cos(0.6)*y - sin(0.6)*x", restitution = 0.5 }},
              {{ name = "r", gap = "cos(0.6)*y + sin(0.6)*x + {:.17g}", restitution = 0.5 }}]
[run]
start_time = {}
end_time = {}
)toml",
                                                 units * unit * speed, start, start + 1.5 * fall));
            const Trajectory trajectory = simulate(model, model->default_run());
            ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
            EXPECT_EQ(trajectory.events[0].contacts.count(), units < 16.0 ? 2 : 1);
            EXPECT_EQ(trajectory.rerun_options.has_value(), units >= 16.0);
        }
}

}  // namespace
}  // namespace achilles::test
