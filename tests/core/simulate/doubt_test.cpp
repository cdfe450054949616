// Ambiguity: nothing is decided by rounding or integration error alone. Covers releases, starts, dips of the gap and of
// the contact force, and flights shorter than the resolution of time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/systems.hpp"

namespace achilles {
namespace {

using test::PlaneSystem;

Trajectory run_of(const PlaneSystem& plane, double tolerance = 1e-10, Method method = Method::taylor) {
    const auto model = test::model_of(plane);
    auto run = model->default_run();
    run.options.tolerance = tolerance;
    run.options.method = method;
    return simulate(model, run);
}

using test::count;

// ---- the surface at rounding level ----

// V = b F(a) on the floor b = 0: the contact force is F(a), and a' is constant. Here F is (p - a)^3 or its square, and
// a is so large that the doubles next to p differ from it by 1e-7. To a computed state h''' = -F' a' is 0, so it is
// unknown whether the contact is released.
TEST(AmbiguousEvents, AReleaseIsOneOnlyWhereTheForceIsProvedToFall) {
    for (const char* force : {"(1000000001 - a)^3", "(1000000001 - a)^2"}) {
        const Trajectory touch = run_of({.potential = std::string("b*") + force, .a = 1e9, .a_rate = 1.0, .end = 2.0});
        EXPECT_EQ(touch.outcome.kind, Outcome::Kind::undecided) << force << ": " << touch.outcome.message;
        EXPECT_EQ(count(touch, Event::Kind::release), 0u) << force;
        EXPECT_NEAR(touch.end_time, 1.0, 1e-2) << force;
    }
    // The same with a force that decreases at the rate 1.
    const Trajectory release = run_of({.potential = "b*(1000000001 - a)", .a = 1e9, .a_rate = 1.0, .end = 2.0});
    EXPECT_EQ(release.outcome.kind, Outcome::Kind::end_time) << release.outcome.message;
    EXPECT_EQ(count(release, Event::Kind::release), 1u);
}

// The force sin(a) at the two doubles around pi is 1.2e-16 and -3.2e-16: zero within the rounding of a. Its rate
// decides.
constexpr double below_pi = 3.141592653589793, above_pi = 3.1415926535897936;

TEST(AmbiguousEvents, ARoundingOfTheStateDoesNotDecideAStart) {
    for (const double a : {below_pi, above_pi}) {
        for (const Method method : test::both_methods) {
            PlaneSystem plane{.potential = "b*sin(a)", .a = a, .end = 1.0};
            plane.a_rate = 1.0;  // the force decreases: release
            const Trajectory leaves = run_of(plane, 1e-10, method);
            EXPECT_EQ(leaves.outcome.kind, Outcome::Kind::end_time) << leaves.outcome.message;
            ASSERT_EQ(leaves.phases.size(), 1u) << a;
            EXPECT_EQ(leaves.phases[0].kind, Phase::Kind::hybrid) << a;
            plane.a_rate = -1.0;  // the force increases
            const Trajectory stays = run_of(plane, 1e-10, method);
            EXPECT_EQ(stays.outcome.kind, Outcome::Kind::end_time) << stays.outcome.message;
            ASSERT_EQ(stays.phases.size(), 1u) << a;
            EXPECT_EQ(stays.phases[0].kind, Phase::Kind::constrained) << a;
            plane.a_rate = 0.0;
            EXPECT_EQ(run_of(plane, 1e-10, method).outcome.kind, Outcome::Kind::undecided) << a;
        }
    }
}

TEST(AmbiguousEvents, ARoundingOfTheStateDoesNotDecideAPlasticImpact) {
    for (const double a : {below_pi, above_pi}) {
        const Trajectory trajectory = run_of({.potential = "b*sin(a)", .e = "0", .a = a, .b_rate = -1.0, .end = 1.0});
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided) << a;
        EXPECT_NE(trajectory.outcome.message.find("force and its rate are zero"), std::string::npos)
            << trajectory.outcome.message;
        EXPECT_EQ(count(trajectory, Event::Kind::zeno), 0u) << a;
    }
}

// ---- dips ----

// The contact force, or the gap, is 2 (1 - cos(a - p)) + c with a' = 1: a dip to c at t = p. The Taylor series of the
// cosine is infinite, so it has a remainder.
PlaneSystem dip(bool contact, double p, double c, double end) {
    const std::string quantity = fmt::format("(2*(1 - cos(a - {:.17g})) + {:.17g})", p, c);
    PlaneSystem plane{.potential = "0", .gap = "b + " + quantity, .a_rate = 1.0, .end = end};
    if (contact) {
        plane.potential = "b*" + quantity;
        plane.gap = "b";
    }
    return plane;
}

// A dip to +-1e-16 or 0 is below any integration error: the run must be undecided.
TEST(AmbiguousEvents, ADipWithinTheRemainderIsNotDecided) {
    for (const bool contact : {false, true})
        for (const double c : {1e-16, 0.0, -1e-16})
            for (const double tolerance : {1e-6, 1e-10, 1e-14}) {
                const Trajectory trajectory = run_of(dip(contact, 0.7, c, 2.0), tolerance);
                EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided)
                    << contact << ", " << c << ", " << tolerance;
                EXPECT_NEAR(trajectory.end_time, 0.7, 1e-2) << contact << ", " << c << ", " << tolerance;
            }
}

// The same for a step that ends in the dip or close to it. The next step then starts within its remainder and
// increases. At tolerance 1e-14 the gap leaves the remainder's range 1e-7 from p. So p is moved until the first step
// ends within 1e-10 of it, and then by up to 3e-7.
void expect_undecided_where_a_step_ends(bool contact, Method method, double low, double high) {
    const auto past = [&](double p) {  // how far the first step extends beyond p, if no event occurs
        return run_of(dip(contact, p, 1e-9, p + 3.0), 1e-14, method).pieces.at(0).end - p;
    };
    ASSERT_GT(past(low), 0.0);
    ASSERT_LT(past(high), 0.0);
    while (high - low > 1e-13) {
        const double middle = 0.5 * (low + high);
        (past(middle) > 0.0 ? low : high) = middle;
    }
    ASSERT_LT(std::abs(past(low)), 1e-10) << "no step ends there";
    for (const double c : {1e-16, 0.0, -1e-16})
        for (int i = -10; i <= 10; ++i) {
            const double p = low + 3e-8 * i;
            const Trajectory trajectory = run_of(dip(contact, p, c, low + 3.0), 1e-14, method);
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::undecided)
                << c << ", " << i << ": " << trajectory.outcome.message;
            EXPECT_NEAR(trajectory.end_time, p, 1e-5);
        }
}

TEST(AmbiguousEvents, ADipThatHoldsTheEndOfAStepIsNotDecidedByTheNextOne) {
    for (const bool contact : {false, true}) {
        SCOPED_TRACE(contact ? "force" : "gap");
        expect_undecided_where_a_step_ends(contact, Method::taylor, 4.7, 5.3);
        expect_undecided_where_a_step_ends(contact, Method::dopri5, 0.001, 1.0);
    }
}

// The gap starts 0.1 tolerances above zero, falls to 0.9 tolerances below it, then rises far above. An event occurs,
// but a test that looks at the rise alone misses it.
TEST(AmbiguousEvents, ADipThatBeginsInsideTheRemainderIsNotPassedOver) {
    for (const bool contact : {false, true})
        for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
            const PlaneSystem plane = dip(contact, std::sqrt(tolerance), -0.9 * tolerance, 0.5);
            const Trajectory trajectory = run_of(plane, tolerance);
            if (trajectory.outcome.kind == Outcome::Kind::undecided) continue;
            EXPECT_GE(count(trajectory, contact ? Event::Kind::release : Event::Kind::impact), 1u)
                << contact << ", " << tolerance << ": " << trajectory.outcome.message;
        }
}

// A run that ends with the gap within the remainder. h = b - sin(a) is 1e-3 tolerances below zero at the end and
// falling, so there is an impact. With the other sign there is none.
TEST(AmbiguousEvents, AnImpactJustBeforeTheEndIsOne) {
    for (const double tolerance : {1e-6, 1e-8, 1e-10})
        for (const double sign : {1.0, -1.0}) {
            const double end = 1.25, above = sign * 1e-3 * tolerance;  // a = t, b = b0 - t^2/2
            const Trajectory trajectory =
                run_of({.gap = "b - sin(a)", .b = std::sin(end) + 0.5 * end * end + above, .a_rate = 1.0, .end = end},
                       tolerance);
            EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
            EXPECT_EQ(count(trajectory, Event::Kind::impact), sign < 0.0 ? 1u : 0u) << tolerance << ", " << sign;
            EXPECT_GE(trajectory.statistics.least_gap, -1e-15);
        }
}

// ---- errors of earlier steps ----

// A ball bounces once, moves through waves of V, and passes a post of height B. From B* on, known from runs at
// tolerance 1e-14, it touches the post.
Trajectory past_the_post(double height, double tolerance) {
    return run_of({.potential = "b + 0.3*cos(2*a)",
                   .gap = fmt::format("b - {:.17g}*exp(-40*(a - 2.6)^2)", height),
                   .e = "0.9",
                   .b = 0.5,
                   .a_rate = 1.0,
                   .end = 2.4},
                  tolerance);
}

// The error after the bounce is larger than the distance to the boundary, so tighter steps after it cannot decide. Only
// rerunning everything can. No decision is wrong, and none that 1e-14 can make stays open.
TEST(AmbiguousEvents, ErrorOfEarlierStepsDecidesNoEvent) {
    double clear = 0.1, touched = 0.7;
    ASSERT_EQ(past_the_post(clear, 1e-14).statistics.impacts, 1);
    ASSERT_GT(past_the_post(touched, 1e-14).statistics.impacts, 1);
    while (touched - clear > 1e-11) {
        const double middle = 0.5 * (clear + touched);
        (past_the_post(middle, 1e-14).statistics.impacts > 1 ? touched : clear) = middle;
    }
    int made_again = 0;
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
        for (double off = 1e-5; off > 5e-11; off *= 0.3)
            for (const double sign : {-1.0, 1.0}) {
                const Trajectory trajectory = past_the_post(clear + sign * off, tolerance);
                EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time)
                    << tolerance << ", " << sign * off << ": " << trajectory.outcome.message;
                EXPECT_EQ(trajectory.statistics.impacts > 1, sign > 0.0) << tolerance << ", " << sign * off;
                EXPECT_EQ(trajectory.run.options.tolerance, tolerance);
                if (!trajectory.rerun_options) continue;
                ++made_again;
                EXPECT_EQ(trajectory.rerun_options->tolerance, 1e-14);
            }
    EXPECT_GT(made_again, 10);  // the trajectory reports it
}

// ---- the resolution of time ----

// Thrown up at 5e11 with g = 1e6, the ball lands at t = 1e6 and comes to rest at 2e6. There doubles resolve 2.3e-10 s.
// A flight of four times that is 1e-13 high, more than eps_q = 1e-15 allows to cut. The height is a coordinate, which
// rounding does not limit; time is limited.
TEST(AmbiguousEvents, FlightsShorterThanTheResolutionOfTimeEndTheBouncing) {
    for (const Method method : test::both_methods) {
        const auto model = test::drop();
        auto run = model->default_run();
        run.parameters[0] = 1e6;
        run.v[0] = 5e11;
        run.options.method = method;
        run.options.end_time = 2e6 + 1.0;
        run.options.truncation.eps_q = 1e-15;
        const Trajectory trajectory = simulate(model, run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        const auto points = test::events_of(trajectory, Event::Kind::zeno);
        ASSERT_EQ(points.size(), 1u);
        EXPECT_TRUE(points[0].certificate->cut_at_resolution);
        EXPECT_NEAR(points[0].t, 2e6, 1e-7);
        EXPECT_LT(trajectory.statistics.impacts, 60);  // the speed halves: 2^-50 of 5e11 is 4e-4
    }
}

}  // namespace
}  // namespace achilles
