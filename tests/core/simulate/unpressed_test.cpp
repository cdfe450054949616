// Plastic contacts without contact force stay closed, and other contacts complete beside them. A force that appears
// later holds or opens them at its instant (theory-gaps.md 2.7).
#include <gtest/gtest.h>

#include <cmath>

#include "core/systems.hpp"
#include "enclose/enclosure.hpp"
#include "simulate/batch.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles::test {
namespace {

Trajectory to_its_end(const std::shared_ptr<const Model>& model, Method method = Method::taylor) {
    auto run = model->default_run();
    run.options.method = method;
    Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_FALSE(trajectory.rerun_options) << trajectory.rerun_reason;
    return trajectory;
}

// A mass with a plastic impact at a stop. Its coordinate is x; the gap is a factor times its distance from the stop.
std::shared_ptr<const Model> stop(const std::string& force, const std::string& gap, const std::string& more = "",
                                  const std::string& start = "start = 1, rate = -2") {
    return typed(fmt::format(R"toml(
title = "Plastic stop"
coordinate = [{{ name = "x", {3}, force = "{0}" }}]
lagrangian = {{ kinetic = "x'^2/2", potential = "0" }}
constraint = [{{ name = "stop", gap = "{1}", restitution = 0 }}]
{2}
[run]
end_time = 3
)toml",
                             force, gap, more, start));
}

TEST(UnpressedContacts, HoldAMassAtAPlasticStop) {
    const struct {
        const char *force, *gap, *more;
        double at;
    } stops[] = {
        {"-0.2*x'", "x", "", 0.0},
        {"0", "x", "", 0.0},
        {"0", "3*x", "", 0.0},
        {"-0.2*x'", "1e-7*x", "", 0.0},
        {"0.3*x'", "x/3", "", 0.0},
        {"-4*x", "7*x", "", 0.0},              // a spring that is slack at the stop
        {"-4*(x - 0.1)", "x - 0.1", "", 0.1},  // a stop at 1/10
        {"-4*(x - L)*x'", "x - L", "parameter = [{ name = \"L\", value = 0.3 }]", 0.3},
        {"wind", "x", "parameter = [{ name = \"wind\", value = 0 }]", 0.0},
        {"push - pull", "x", "parameter = [{ name = \"push\", value = 0.7 }, { name = \"pull\", value = 0.7 }]", 0.0},
        {"-4*sin(x)", "sin(x)", "", 0.0},
        {"-0.2*(x' - 0.5)", "x - 0.5*t", "", 1.5}};  // a moving stop
    for (const auto& [force, gap, more, at] : stops)
        for (const Method method : both_methods) {
            SCOPED_TRACE(fmt::format("{}, {}, {}", force, gap, to_text(method)));
            const Trajectory trajectory = to_its_end(stop(force, gap, more), method);
            ASSERT_EQ(trajectory.events.size(), 2u);
            EXPECT_EQ(trajectory.events[0].kind, Event::Kind::impact);
            EXPECT_EQ(trajectory.events[1].kind, Event::Kind::zeno);
            EXPECT_EQ(trajectory.events[0].t, trajectory.events[1].t);
            EXPECT_TRUE(is_plastic_landing(trajectory.events[1]));
            EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(0));
            EXPECT_NEAR(trajectory.end.q[0], at, 1e-12);
            ContactForces forces(*trajectory.model, trajectory.run.parameters);
            forces.set(trajectory.end, trajectory.end_mode);
            EXPECT_NEAR(forces.force(0), 0.0, 1e-8);
        }
}

// The force is 0 at the start only: its rate decides. If the rate is 0 as well, the run is undecided.
TEST(UnpressedContacts, DoNotIncludeForcesThatVanishForAnInstant) {
    for (const auto& [force, held] : {std::pair("t", false), {"-t", true}, {"sin(t)*cos(x)", false}}) {
        const Trajectory trajectory = to_its_end(stop(force, "x", "", "start = 0"));
        EXPECT_EQ(trajectory.end_mode.held(), held ? ContactSet::of(0) : ContactSet()) << force;
        EXPECT_EQ(trajectory.end.q[0] > 0.1, !held) << force;
    }
    for (const char* force : {"t^2", "-t^2", "t^3", "1 - cos(t)"}) {
        const auto model = stop(force, "x", "", "start = 0");
        EXPECT_EQ(simulate(model, model->default_run()).outcome.kind, Outcome::Kind::undecided) << force;
    }
    // Far smaller than other forces, but not zero.
    const Trajectory pressed = to_its_end(stop("-1e-9*(2 + cos(t))", "x")), lifted = to_its_end(stop("1e-9", "x"));
    EXPECT_EQ(pressed.end_mode.held(), ContactSet::of(0));
    EXPECT_TRUE(lifted.end_mode.held().empty());
    EXPECT_NEAR(lifted.end.q[0], 0.5e-9 * 2.5 * 2.5, 1e-15);
}

// z begins to move from rest. Its rate presses or lifts x from the start on, with the known rate of the force; z itself
// does so with the second rate, which is not examined.
TEST(UnpressedContacts, DoNotIncludeForcesOfWhatBeginsToMove) {
    const auto pulled_by = [](const std::string& force) {
        return typed(fmt::format(R"toml(
coordinate = [{{ name = "x", start = 0, force = "{}" }}, {{ name = "z", start = 0, force = "1" }}]
lagrangian = {{ kinetic = "(x'^2 + z'^2)/2", potential = "0" }}
constraint = [{{ name = "stop", gap = "x", restitution = 0 }}]
[run]
end_time = 2
)toml",
                                 force));
    };
    const Trajectory lifted = to_its_end(pulled_by("z'")), pressed = to_its_end(pulled_by("-z'"));
    EXPECT_TRUE(lifted.end_mode.held().empty());
    EXPECT_NEAR(lifted.end.q[0], 8.0 / 6.0, 1e-12);
    EXPECT_EQ(pressed.end_mode.held(), ContactSet::of(0));
    const auto later = pulled_by("z");
    EXPECT_EQ(simulate(later, later->default_run()).outcome.kind, Outcome::Kind::undecided);
}

// A ball thrown at a plastic wall bounces on the floor beside it.
std::shared_ptr<const Model> wall_and_floor(const std::string& factor, const std::string& force, double e_wall = 0.0) {
    return typed(fmt::format(R"toml(
title = "Wall and floor"
coordinate = [{{ name = "x", start = 1, rate = -2, force = "{1}" }}, {{ name = "y", start = 5 }}]
lagrangian = {{ kinetic = "(x'^2 + y'^2)/2", potential = "9.81*y" }}
constraint = [{{ name = "wall", gap = "{0}*x", restitution = {2} }}, {{ name = "floor", gap = "{0}*y", restitution = 0.5 }}]
[run]
end_time = 5
)toml",
                             factor, force, e_wall));
}

TEST(UnpressedContacts, OtherContactsCompleteWhileTheyAreHeld) {
    const double zeno = std::sqrt(2.0 * 5.0 / 9.81) * 3.0;
    for (const char* factor : {"1", "3", "1e-8", "1e8"})
        for (const char* force : {"0", "-0.2*x'"})
            for (const Method method : both_methods) {
                SCOPED_TRACE(fmt::format("{} {} {}", factor, force, to_text(method)));
                const Trajectory trajectory = to_its_end(wall_and_floor(factor, force), method);
                EXPECT_EQ(trajectory.end_mode.held(), ContactSet::of(0).with(1));
                EXPECT_EQ(trajectory.ambiguous_impacts, 0);
                const Event& rest = trajectory.events.back();
                ASSERT_EQ(rest.kind, Event::Kind::zeno);
                EXPECT_EQ(rest.contacts, ContactSet::of(1));
                EXPECT_NEAR(rest.t, zeno, 1e-6);
                ASSERT_TRUE(rest.certificate && rest.certificate->certified && rest.certificate->others);
                EXPECT_LE(rest.certificate->zeno_low, zeno + 1e-8);
                EXPECT_GE(rest.certificate->zeno_high, zeno - 1e-8);
                ASSERT_EQ(rest.certificate->others->held.size(), 1u);
                EXPECT_EQ(rest.certificate->others->held[0].least_force, 0.0);
                EXPECT_EQ(trajectory.end.v.norm(), 0.0);
            }
}

// Mass w hits mass z, at rest until then, at t = 1. Then z moves at rate 1 and pulls or presses x, which stopped at t =
// 0.5.
std::shared_ptr<const Model> pulled_later(const std::string& force, const std::string& factor) {
    return typed(fmt::format(R"toml(
title = "A force that begins later"
coordinate = [{{ name = "x", start = 0.5, rate = -1, force = "{}" }}, {{ name = "z", start = 0 }}, {{ name = "w", start = -1, rate = 1 }}]
lagrangian = {{ kinetic = "(x'^2 + z'^2 + w'^2)/2", potential = "0" }}
constraint = [{{ name = "stop", gap = "{}*x", restitution = 0 }}, {{ name = "hit", gap = "z - w", restitution = 1 }}]
[run]
end_time = 3
)toml",
                             force, factor));
}

TEST(UnpressedContacts, AreLiftedOrPressedByAForceThatAppears) {
    for (const char* factor : {"1", "3", "1e-6"})
        for (const Method method : both_methods) {
            SCOPED_TRACE(fmt::format("{} {}", factor, to_text(method)));
            // x'' = 0.6 (t - 1) for t >= 1
            const Trajectory lifted = to_its_end(pulled_later("0.6*z", factor), method);
            EXPECT_TRUE(lifted.end_mode.held().empty());
            EXPECT_NEAR(lifted.end.q[0], 0.1 * 8.0, 1e-8);
            EXPECT_NEAR(lifted.events.back().t, 1.0, 1e-9);
            const Trajectory pressed = to_its_end(pulled_later("-0.6*z - 0.1*x'", factor), method);
            EXPECT_EQ(pressed.end_mode.held(), ContactSet::of(0));
            EXPECT_NEAR(pressed.end.q[0], 0.0, 1e-12);
            ContactForces forces(*pressed.model, pressed.run.parameters);
            forces.set(pressed.end, pressed.end_mode);
            EXPECT_NEAR(forces.force(0) * std::atof(factor), 1.2, 1e-7);
        }
}

TEST(UnpressedContacts, AreTheSameSideBySide) {
    for (const auto& model : {stop("-0.2*x'", "3*x"), wall_and_floor("3", "-0.2*x'")}) {
        const Trajectory alone = to_its_end(model);
        int ends = 0;
        simulate_ends(
            model, 9, [&](std::size_t) { return model->default_run(); },
            [&](std::size_t, RunResult&& attempt) {
                const Trajectory& one = std::get<Trajectory>(attempt);
                EXPECT_EQ(one.outcome.kind, Outcome::Kind::end_time) << one.outcome.message;
                EXPECT_EQ(one.end_mode.held(), alone.end_mode.held());
                EXPECT_LT((one.end.q - alone.end.q).norm() + (one.end.v - alone.end.v).norm(), 1e-9);
                EXPECT_EQ(sequence_of(one).size(), sequence_of(alone).size());
                ++ends;
            },
            1);
        EXPECT_EQ(ends, 9);
    }
}

TEST(UnpressedContacts, StayClosedInProofs) {
    for (const char* gap : {"x", "3*x", "1e-8*x"})
        for (const char* force : {"-0.2*x'", "0", "-4*x"}) {
            const auto model = stop(force, gap);
            const Enclosure proof = prove(model, problem_from_decimals(model->default_run()));
            ASSERT_TRUE(proof.end) << gap << " " << force << ": " << proof.outcome.message;
            ASSERT_EQ(proof.events.size(), 1u);
            EXPECT_TRUE(proof.end->q[0].contains(0.0));
            EXPECT_LT(width(proof.end->q[0]), 1e-12);
        }
    const auto model = wall_and_floor("3", "-0.2*x'");
    const Enclosure proof = prove(model, problem_from_decimals(model->default_run()));
    ASSERT_TRUE(proof.end) << proof.outcome.message;
    EXPECT_EQ(proof.events.back().kind, Event::Kind::zeno);
    EXPECT_TRUE(proof.events.back().t.contains(std::sqrt(2.0 * 5.0 / 9.81) * 3.0));
    EXPECT_EQ(proof.events.back().mode.held(), ContactSet::of(0).with(1));
    // With a contact force that is 0 at the start only, the proof cannot decide whether the contact stays closed.
    const auto instant = stop("t^2", "x", "", "start = 0");
    EXPECT_FALSE(prove(instant, problem_from_decimals(instant->default_run())).end);
}

}  // namespace
}  // namespace achilles::test
