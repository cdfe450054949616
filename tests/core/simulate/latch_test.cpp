// Latches and forces that depend on contact (theory-modes.md 4, 5) against closed forms, by both methods.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/systems.hpp"
#include "output/output.hpp"
#include "sensitivity/derivatives.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {
namespace {

double closeness(Method method) { return method == Method::taylor ? 1e-12 : 1e-7; }

// A floor y = 0 under a point with the force `force` (mass 1).
std::string on_floor(double y, const std::string& force, const std::string& more = "") {
    return fmt::format(R"toml(coordinate = [{{name = "y", start = {}, force = "{}"}}]
lagrangian = {{kinetic = "1/2*y'^2", potential = "0"}}
[[constraint]]
name = "foot"
gap = "y"
restitution = 0
{}
)toml",
                       y, force, more);
}

// A ball (x, y) that bounces on a floor and feels a drag c x' only while it is held there; `weight` is its own.
std::string rolling(const std::string& weight) {
    return fmt::format(R"toml(coordinate = [
{{name = "x", rate = 1, force = "-c*held(floor)*x'"}}, {{name = "y", start = 0.5, force = "-({})"}}]
parameter = [{{name = "c", value = 1}}]
lagrangian = {{kinetic = "1/2*(x'^2 + y'^2)", potential = "0"}}
constraint = [{{name = "floor", gap = "y", restitution = 0.5}}]
)toml",
                       weight);
}

// Two unit masses that the kinetic energy couples by c, pressed on the two gaps x and y.
std::string coupled(double c, const std::string& latch, double y = 0.5) {
    return fmt::format(R"toml(coordinate = [{{name = "x", start = 0}}, {{name = "y", start = {}}}]
parameter = [{{name = "c", value = {}}}]
lagrangian = {{kinetic = "1/2*(x'^2 + y'^2) + c*x'*y'", potential = "x + y"}}
[[constraint]]
name = "knee"
gap = "x"
restitution = 0
{}
[[constraint]]
name = "foot"
gap = "y"
restitution = 0.5
)toml",
                       y, c, latch);
}

// A knee that reaches its stop at t = 2 - sqrt(2) while a force pulls it away, and a foot that lands at t = 2.
std::string pulled(const std::string& latch, const std::string& more = "") {
    return fmt::format(
        R"toml(coordinate = [{{name = "x", start = 1, rate = -2, force = "a"}}, {{name = "y", start = 1}}]
parameter = [{{name = "a", value = 1}}, {{name = "g", value = 0.5}}]
lagrangian = {{kinetic = "1/2*(x'^2 + y'^2)", potential = "g*y"}}
[[constraint]]
name = "knee"
gap = "x"
restitution = 0
{}
[[constraint]]
name = "foot"
gap = "y"
restitution = 0.5
{}
)toml",
        latch, more);
}

Trajectory run_of(const std::string& text, double end, Method method = Method::taylor) {
    const auto model = typed(text);
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    run.options.method = method;
    run.options.tolerance = method == Method::taylor ? 1e-13 : 1e-11;
    return simulate(model, run);
}

void expect_message(const Trajectory& run, Outcome::Kind kind, const std::string& part) {
    EXPECT_EQ(run.outcome.kind, kind) << run.outcome.message;
    EXPECT_NE(run.outcome.message.find(part), std::string::npos) << run.outcome.message;
}

// Without a latch the contact is released at t = 1.5, where its force falls to 0.
TEST(Latch, HoldsAgainstAForceUntilItsExpressionRises) {
    for (const Method method : both_methods) {
        const std::string force = "3*t - 4.5";
        const Trajectory free = run_of(on_floor(0.0, force), 3.0, method);
        ASSERT_EQ(free.events.size(), 1u);
        EXPECT_NEAR(free.events[0].t, 1.5, closeness(method));
        const Trajectory run = run_of(on_floor(0.0, force, "latch = \"t - 2\""), 3.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        ASSERT_EQ(run.events.size(), 1u);
        EXPECT_TRUE(run.events[0].is_release());
        EXPECT_TRUE(run.events[0].ends_latch);
        EXPECT_NEAR(run.events[0].t, 2.0, closeness(method));
        EXPECT_NEAR(run.end.q[0], 1.25, closeness(method));  // 3/4 + 1/2
        EXPECT_NEAR(run.end.v[0], 3.0, closeness(method));   // 3/2 + 3/2
        EXPECT_EQ(run.start_latched, ContactSet::of(0));
        EXPECT_EQ(run.events[0].latched, ContactSet());
        EXPECT_EQ(run.end_latched, ContactSet());
    }
}

TEST(Latch, ThatEndsUnderAPressingForceLeavesAnOrdinaryContact) {
    const Trajectory run = run_of(on_floor(0.0, "3*t - 4.5", "latch = \"t - 1\""), 3.0);
    ASSERT_EQ(run.events.size(), 1u);
    EXPECT_NEAR(run.events[0].t, 1.5, 1e-12);
    EXPECT_FALSE(run.events[0].ends_latch);
    EXPECT_EQ(run.start_latched, ContactSet::of(0));
}

// It closes although the force would open it, and opens with the impact of the foot.
TEST(Latch, ClosesAgainstTheForceAndEndsWithTheImpactOfAnother) {
    for (const Method method : both_methods) {
        const Trajectory run = run_of(pulled("latch = \"foot\""), 3.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        ASSERT_GE(run.events.size(), 3u);
        EXPECT_NEAR(run.events[0].t, 2.0 - std::sqrt(2.0), closeness(method));
        EXPECT_TRUE(run.events[1].is_zeno());
        EXPECT_EQ(run.events[1].latched, ContactSet::of(0));
        EXPECT_NEAR(run.events[2].t, 2.0, closeness(method));
        EXPECT_EQ(run.events[2].opened, ContactSet::of(0));
        EXPECT_EQ(run.events[2].latched, ContactSet());
        EXPECT_NEAR(run.end.q[0], 0.5, closeness(method));
        EXPECT_NEAR(run.end.q[1], 0.25, closeness(method));  // up again with 1/2
        EXPECT_EQ(run.events.size(), 3u);
        // Without the latch the knee leaves at once.
        const Trajectory without = run_of(pulled(""), 3.0, method);
        EXPECT_NEAR(without.end.q[0], 0.5 * std::pow(1.0 + std::sqrt(2.0), 2), closeness(method));
    }
}

// The impulse at the foot pulls at the knee (kappa = c < 0): without the latch it would open there.
TEST(Latch, TakesImpulsesOfEitherSignAndLeavesTheCertificateOfOthers) {
    for (const Method method : both_methods) {
        const Trajectory without = run_of(coupled(-0.5, ""), 4.0, method);
        ASSERT_FALSE(without.events.empty());
        EXPECT_EQ(without.events[0].opened, ContactSet::of(0));
        const Trajectory run = run_of(coupled(-0.5, "latch = \"t - 100\""), 4.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        const auto zeno =
            std::find_if(run.events.begin(), run.events.end(), [](const Event& event) { return event.is_zeno(); });
        ASSERT_NE(zeno, run.events.end());
        EXPECT_NEAR(zeno->t, 3.0, 1e-6);
        EXPECT_TRUE(zeno->certificate && zeno->certificate->certified);
        EXPECT_LE(zeno->certificate->zeno_low, 3.0 + closeness(method));
        EXPECT_GE(zeno->certificate->zeno_high, 3.0 - closeness(method));
        EXPECT_NEAR(run.events[0].v_after[1], 0.5, closeness(method));
        for (const Event& event : run.events) {
            EXPECT_EQ(event.latched, ContactSet::of(0));
            EXPECT_TRUE(event.opened.empty());
        }
        EXPECT_NEAR(run.end.q[0], 0.0, closeness(method));
        EXPECT_NEAR(run.loss, 0.5, 1e-6);  // all that the fall from 1/2 has gained
    }
}

// Two contacts close at once beside a latched one: the Delassus matrix is the reduced one.
TEST(Latch, IsEliminatedFromSimultaneousImpacts) {
    const std::string text = R"toml(coordinate = [{name = "x"}, {name = "y", start = 0.5}, {name = "z", start = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2 + z'^2) - x'*y'/2 + x'*z'/4", potential = "x + y + z"}
[[constraint]]
name = "knee"
gap = "x"
restitution = 0
latch = "t - 100"
[[constraint]]
name = "left"
gap = "y"
restitution = 0.5
[[constraint]]
name = "right"
gap = "z"
restitution = 0.5
)toml";
    const Trajectory run = run_of(text, 1.5);
    ASSERT_EQ(run.events.size(), 1u) << run.outcome.message;  // y and z are not coupled while x is held
    EXPECT_NEAR(run.events[0].t, 1.0, 1e-12);
    EXPECT_NEAR(run.events[0].v_after[1], 0.5, 1e-12);
    EXPECT_NEAR(run.events[0].v_after[2], 0.5, 1e-12);
    EXPECT_EQ(run.events[0].v_after[0], 0.0);
    ASSERT_TRUE(run.events[0].joint);
    for (const auto& [contact, impulse] : run.events[0].joint->impulses) {
        // p_x = c_y p_y + c_z p_z, with p = 3/2
        const double expected = contact == 0 ? 1.5 * (-0.5 + 0.25) : 1.5;
        EXPECT_NEAR(impulse, expected, 1e-12) << contact;
    }
    EXPECT_EQ(run.events[0].joint->impulses.size(), 3u);
}

// It latches again only after it has been open.
TEST(Latch, CatchesAgainAfterItHasOpened) {
    const std::string text = R"toml(coordinate = [{name = "y", start = 0, force = "a*cos(t) - 1/10"}]
parameter = [{name = "a", value = -1}]
lagrangian = {kinetic = "1/2*y'^2", potential = "0"}
[[constraint]]
name = "foot"
gap = "y"
restitution = 0
latch = "sin(t)"
)toml";
    // The force presses until pi/2, the latch holds until 2 pi (sin rises), where the force presses: an ordinary contact
    // until the force opens it. It flies until the next landing, which latches.
    const Trajectory run = run_of(text, 40.0);
    ASSERT_GE(run.events.size(), 3u) << run.outcome.message;
    EXPECT_TRUE(run.events[0].is_release());
    EXPECT_NEAR(run.events[0].t, 2.0 * std::numbers::pi + std::acos(-0.1), 1e-11);
    EXPECT_FALSE(run.events[0].ends_latch);
    EXPECT_EQ(run.events[0].latched, ContactSet());
    EXPECT_TRUE(run.events[2].is_zeno());
    EXPECT_EQ(run.events[2].latched, ContactSet::of(0));
}

TEST(Latch, StaysThroughAJumpThatLeavesItClosed) {
    const std::string text = pulled("latch = \"t - 2.5\"", R"toml([[jump]]
name = "reset"
on = "1.5 - t"
set = {y = "y + 5"}
)toml");
    const Trajectory run = run_of(text, 3.0);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    ASSERT_EQ(run.events.size(), 4u);
    EXPECT_TRUE(run.events[2].is_jump());
    EXPECT_EQ(run.events[2].latched, ContactSet::of(0));
    EXPECT_TRUE(run.events[3].ends_latch);
    EXPECT_NEAR(run.events[3].t, 2.5, 1e-12);
    EXPECT_NEAR(run.end.q[0], 0.125, 1e-12);
}

// The jump at the same zero does not hide it: afterwards the contact is decided by its force, which pulls.
TEST(Latch, EndsWithAJumpAtTheSameInstant) {
    for (const Method method : both_methods)
        for (const bool ends : {true, false}) {
            const std::string latch = ends ? "latch = \"0.5 - y\"" : "latch = \"t - 100\"";
            const Trajectory run = run_of(pulled(latch, R"toml([[jump]]
name = "reset"
on = "y - 0.5"
set = {y = "3"}
)toml"),
                                          3.0, method);
            EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
            ASSERT_EQ(run.events.size(), 3u);
            EXPECT_TRUE(run.events[2].is_jump());
            EXPECT_NEAR(run.events[2].t, std::sqrt(2.0), closeness(method));
            EXPECT_EQ(run.events[2].latched, ends ? ContactSet() : ContactSet::of(0));
            EXPECT_NEAR(run.end.q[0], ends ? 0.5 * std::pow(3.0 - std::sqrt(2.0), 2) : 0.0, closeness(method));
        }
}

TEST(Latch, StandsInTheJson) {
    const Trajectory run = run_of(on_floor(0.0, "3*t - 4.5", "latch = \"t - 2\""), 3.0);
    const std::string text = to_json(run);
    std::size_t lists = 0, names = 0;  // of the start, the event and the end; the start has the only name
    for (auto at = text.find("\"latched\": ["); at != std::string::npos; at = text.find("\"latched\": [", at + 1)) {
        ++lists;
        if (text.substr(at, text.find(']', at) - at).find("foot") != std::string::npos) ++names;
    }
    EXPECT_EQ(lists, 3u);
    EXPECT_EQ(names, 1u);
    EXPECT_NE(text.find("\"ends_latch\": true"), std::string::npos);
}

// ---- latches beside friction ----

// The same system with a further mass on a brake, which nothing couples with the rest.
std::string with_brake(std::string text) {
    const auto insert = [&](const std::string& before, const std::string& more) {
        text.insert(text.find(before) + before.size(), more);
    };
    insert("coordinate = [", R"({name = "s", rate = 1}, )");
    insert("kinetic = \"1/2*(", "s'^2 + ");
    return "friction = [{name = \"brake\", slip = \"s'\", level = 0.3}]\n" + text;
}

// The engine with friction decides modes and impacts by other code, and the events must be the same.
TEST(LatchBesideFriction, ActsAsWithoutFriction) {
    const std::string jump = R"toml([[jump]]
name = "reset"
on = "1.5 - t"
set = {y = "y + 5"}
)toml";
    for (const Method method : both_methods)
        for (const std::string& text :
             {pulled("latch = \"foot\""), pulled("latch = \"t - 1.3\""), pulled("latch = \"t - 2.5\"", jump),
              coupled(-0.5, "latch = \"foot\"", 0.7), coupled(0.5, "latch = \"t - 100\"", 0.7)}) {
            const Trajectory plain = run_of(text, 1.9, method), braked = run_of(with_brake(text), 1.9, method);
            EXPECT_EQ(plain.outcome.kind, Outcome::Kind::end_time) << plain.outcome.message;
            EXPECT_EQ(braked.outcome.kind, Outcome::Kind::end_time) << braked.outcome.message;
            ASSERT_EQ(plain.events.size(), braked.events.size()) << text;
            for (std::size_t i = 0; i < plain.events.size(); ++i) {
                const Event &one = plain.events[i], &other = braked.events[i];
                EXPECT_EQ(one.kind, other.kind) << text;
                EXPECT_NEAR(one.t, other.t, closeness(method));
                EXPECT_EQ(one.latched, other.latched) << text;
                EXPECT_EQ(one.ends_latch, other.ends_latch) << text;
                EXPECT_EQ(one.opened, other.opened) << text;
                EXPECT_LT((one.v_after - other.v_after.tail(2)).norm(), 10.0 * closeness(method)) << text;
                for (std::size_t k = 0; one.joint && k < one.joint->impulses.size(); ++k)
                    EXPECT_NEAR(one.joint->impulses[k].second, other.joint->impulses.at(k).second, closeness(method));
            }
            EXPECT_LT((plain.end.q - braked.end.q.tail(2)).norm(), 10.0 * closeness(method)) << text;
            EXPECT_EQ(plain.end_latched, braked.end_latched);
            EXPECT_NEAR(braked.end.q[0], 1.9 - 0.15 * 1.9 * 1.9, closeness(method));
        }
}

// A block slides on a foot with friction; its knee, held by a latch, takes part of the friction impulse.
TEST(LatchBesideFriction, TakesItsPartOfTheFrictionImpulse) {
    const std::string text = R"toml(coordinate = [{name = "x", rate = 3}, {name = "y", start = 0.5}, {name = "k"}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2 + k'^2) + x'*k'/2", potential = "y + k"}
constraint = [{name = "foot", gap = "y", slip = "x'", friction = 0.4, restitution = 0},
    {name = "knee", gap = "k", restitution = 0, latch = "t - 10"}]
)toml";
    const Trajectory run = run_of(text, 1.5);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    ASSERT_GE(run.events.size(), 1u);
    // While k is held the mass of x is 1: p = 1 at the foot, -0.4 along it; p_k holds k' = 0, p_k = x'/2 after - before.
    EXPECT_NEAR(run.events[0].v_after[0], 2.6, 1e-12);
    EXPECT_NEAR(run.events[0].v_after[2], 0.0, 1e-15);
    ASSERT_TRUE(run.events[0].joint);
    ASSERT_EQ(run.events[0].joint->impulses.size(), 2u);
    EXPECT_NEAR(run.events[0].joint->impulses[1].second, -0.2, 1e-12);
    EXPECT_NEAR(run.end.v[0], 2.6 - 0.4 * 0.5, 1e-12);
}

// ---- held(NAME) ----

TEST(HeldForces, ActWhileTheContactIsHeld) {
    for (const Method method : both_methods) {
        const std::string text = R"toml(coordinate = [{name = "x", force = "2*held(foot)"}, {name = "y", start = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "y"}
constraint = [{name = "foot", gap = "y", restitution = 0}]
)toml";
        const Trajectory run = run_of(text, 3.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        EXPECT_NEAR(run.end.q[0], 4.0, closeness(method));
        EXPECT_NEAR(run.end.v[0], 4.0, closeness(method));
        EXPECT_NEAR(run.work, 8.0, closeness(method));
    }
}

// The force that holds the contact balances the force with held = 1.
TEST(HeldForces, AreBalancedByTheContactForce) {
    const Trajectory run = run_of(on_floor(0.0, "-1 - 2*held(foot)"), 1.0);
    EXPECT_TRUE(run.end_mode.is_held(0));
    ContactForces forces(*run.model, run.run.parameters);
    forces.set(run.end, run.end_mode);
    EXPECT_DOUBLE_EQ(forces.force(0), 3.0);
}

// The contact is released where the force with held = 1 falls to 0, and leaves with the acceleration without it.
TEST(HeldForces, MayJumpAtARelease) {
    for (const Method method : both_methods) {
        const Trajectory run = run_of(on_floor(0.0, "3*t - 1 - 2*t*held(foot)"), 2.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        ASSERT_EQ(run.events.size(), 1u);
        EXPECT_NEAR(run.events[0].t, 1.0, closeness(method));
        EXPECT_NEAR(run.end.q[0], 1.5, closeness(method));
        EXPECT_NEAR(run.end.v[0], 3.5, closeness(method));
    }
}

TEST(HeldForces, ThatUndoThemselvesAreUndecided) {
    expect_message(run_of(on_floor(0.5, "-1 + 2*held(foot)"), 2.0), Outcome::Kind::undecided,
                   "held(foot) undoes itself: 'foot' closes by the forces without it, and opens by those with it");
    expect_message(run_of(on_floor(0.0, "-1 + t*held(foot)"), 2.0), Outcome::Kind::undecided,
                   "held(foot) undoes itself: 'foot' opens by the forces with it, and closes by those without it");
}

// A ball that rolls against a drag while it is on the floor. Up to the Zeno point at t = 3 it flies, although its bouncing
// is cut before.
TEST(HeldForces, BeginAtTheZenoPointOfTheirContact) {
    for (const Method method : both_methods) {
        const Trajectory run = run_of(rolling("1"), 5.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        const Event& zeno = run.events.back();
        ASSERT_TRUE(zeno.is_zeno());
        EXPECT_NEAR(zeno.t, 3.0, 1e-9);
        EXPECT_LT(zeno.truncation->t, 2.9999);
        EXPECT_NEAR(run.end.q[0], 4.0 - std::exp(-2.0), 1e-9 + closeness(method));
        EXPECT_NEAR(run.end.v[0], std::exp(-2.0), 1e-9 + closeness(method));
        EXPECT_NEAR(run.work, 0.5 * std::exp(-4.0), 1e-9 + closeness(method));  // with the work of the weight, 1/2
        const double before = 0.5 * (zeno.truncation->t + zeno.t);
        EXPECT_NEAR(run(before).state.v[0], 1.0, closeness(method));
        EXPECT_TRUE(run(before).mode.is_held(0));
    }
}

// Without the time that the run may begin the drag too early or too late, the certificate would not cover the speed.
TEST(HeldForces, HaveCertificatesThatCoverTheTimeAtWhichTheyBegin) {
    const auto model = typed(rolling("1 + x/4 + y"));
    achilles::Run tight = model->default_run(), loose = tight;
    tight.options.end_time = loose.options.end_time = 5.0;
    tight.options.tolerance = loose.options.tolerance = 1e-13;
    tight.options.truncation.eps_q = tight.options.truncation.eps_v = tight.options.truncation.eps_t = 1e-10;
    loose.options.truncation.eps_q = loose.options.truncation.eps_v = loose.options.truncation.eps_t = 0.02;
    loose.parameters[0] = tight.parameters[0] = 40.0;
    const Trajectory exact = simulate(model, tight), cut = simulate(model, loose);
    ASSERT_TRUE(exact.events.back().is_zeno());
    ASSERT_TRUE(cut.events.back().is_zeno());
    const Event& zeno = cut.events.back();
    const double t = std::max(exact.events.back().t, zeno.t) + 1e-9;
    const double off = (exact(t).state.v - cut(t).state.v).norm();
    EXPECT_GT(off, 1e-9);
    EXPECT_LE(off, *zeno.certificate->shadowing_velocity);
    EXPECT_GT(*zeno.certificate->shadowing_velocity, 40.0 * (zeno.certificate->zeno_high - zeno.certificate->zeno_low));
}

TEST(HeldForces, ThatUndoThemselvesAfterBouncingAreUndecided) {
    std::string bouncing = on_floor(0.5, "-1 + 2*held(foot)");
    bouncing.replace(bouncing.find("restitution = 0"), 15, "restitution = 0.5");
    const Trajectory run = run_of(bouncing, 4.0);
    expect_message(run, Outcome::Kind::undecided,
                   "held(foot) undoes itself: 'foot' opens by the forces with it, and closes by those without it");
    EXPECT_NEAR(run.end.t, 3.0, 1e-9);
}

TEST(HeldForces, AreNotCutByTheConditionsOfThePaper) {
    const auto model = typed(rolling("1"));
    achilles::Run run = model->default_run();
    run.options.end_time = 4.0;
    run.options.truncation.conditions = Conditions::paper;
    expect_message(simulate(model, run), Outcome::Kind::undecided, "is cut under the sharp conditions only");
}

// A wheel that bounces, slides on from its Zeno point, and is driven only while it stands on the floor.
TEST(HeldForces, BeginAtZenoPointsWithFriction) {
    for (const Method method : both_methods) {
        const Trajectory run = run_of(R"toml(coordinate = [
{name = "x", rate = 10, force = "-held(foot)*x'"}, {name = "y", start = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "y"}
constraint = [{name = "foot", gap = "y", slip = "x'", friction = 0.1, restitution = 0.5}]
)toml",
                                      4.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        ASSERT_TRUE(run.events.back().is_zeno());
        EXPECT_NEAR(run.events.back().t, 3.0, 1e-9);
        // Every impact takes mu (1 + e) w from the slip: 0.1 * 1.5 * 2 in all; then x'' = -x' - 0.1.
        EXPECT_NEAR(run.end.v[0], 9.8 * std::exp(-1.0) - 0.1, 1e-8 + closeness(method));
    }
}

// Another foot that stands: its force changes at the Zeno point, too, and it is released if that falls below 0.
TEST(HeldForces, MayReleaseAnotherContactAtTheZenoPoint) {
    for (const Method method : both_methods) {
        const Trajectory run = run_of(R"toml(coordinate = [
{name = "x", start = 0, force = "-1 + 2*held(foot)"}, {name = "y", start = 0.5, force = "-1"}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "0"}
constraint = [{name = "other", gap = "x", restitution = 0}, {name = "foot", gap = "y", restitution = 0.5}]
)toml",
                                      4.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        const Event& last = run.events.back();
        EXPECT_EQ(last.kind, Event::Kind::release);
        EXPECT_EQ(last.contacts, ContactSet::of(0));
        EXPECT_NEAR(last.t, 3.0, 1e-9);
        EXPECT_NEAR(run.end.q[0], 0.5, 1e-8);
        EXPECT_NE(differentiate(run).broken.find("forces begin to see a contact at its Zeno point"), std::string::npos);
    }
}

// A parameter may have the name, as in files older than the word.
TEST(HeldForces, AreNotMeantByAParameterOfThisName) {
    const Trajectory run = run_of(on_floor(0.5, "-held", "[[parameter]]\nname = \"held\"\nvalue = 1"), 2.0);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    EXPECT_FALSE(run.model->do_forces_see_contact());
    EXPECT_NEAR(run.events.at(0).t, 1.0, 1e-12);
}

// Two feet, each of which pushes the other up while it is held: the decisions of both see the forces of now.
TEST(HeldForces, OfSeveralContactsAreThoseOfTheMode) {
    for (const Method method : both_methods) {
        const std::string text = R"toml(coordinate = [
{name = "x", start = 0, force = "-1 + held(right)*(1/2)"}, {name = "y", start = 0.5, force = "-1 + held(left)*(3/4)"}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "0"}
constraint = [{name = "left", gap = "x", restitution = 0}, {name = "right", gap = "y", restitution = 0}]
)toml";
        const Trajectory run = run_of(text, 5.0, method);
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        ASSERT_EQ(run.events.size(), 2u);
        EXPECT_NEAR(run.events[0].t, 2.0, closeness(method));  // 1/2 = t^2/8
        EXPECT_EQ(run.end_mode.held().count(), 2);
        ContactForces forces(*run.model, run.run.parameters);
        forces.set(run.end, run.end_mode);
        EXPECT_DOUBLE_EQ(forces.force(0), 0.5);
        EXPECT_DOUBLE_EQ(forces.force(1), 0.25);
    }
}

// A block that sticks on its floor is pushed only while it stands there; the friction force takes the push.
TEST(HeldForces, ActOnFriction) {
    const std::string text = R"toml(coordinate = [{name = "x", force = "held(foot)*t"}, {name = "y", start = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "y"}
constraint = [{name = "foot", gap = "y", slip = "x'", friction = 2, restitution = 0}]
)toml";
    const Trajectory run = run_of(text, 3.0);
    EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
    const auto slip = std::find_if(run.events.begin(), run.events.end(),
                                   [](const Event& event) { return event.kind == Event::Kind::slip; });
    ASSERT_NE(slip, run.events.end());
    EXPECT_NEAR(slip->t, 2.0, 1e-12);
    EXPECT_NEAR(run.end.q[0], 1.0 / 6.0, 1e-12);  // x'' = t - 2
}

}  // namespace
}  // namespace achilles::test
