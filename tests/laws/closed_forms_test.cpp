// Gallery systems whose motion is known in closed form; agreement to 1e-10.
#include <fmt/format.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <numbers>

#include "core/systems.hpp"
#include "laws/laws.hpp"

namespace achilles::test {
namespace {

using std::acos, std::asin, std::cos, std::sin, std::sqrt;
constexpr double pi = std::numbers::pi;
constexpr double within = 1e-10;

class ClosedForm : public testing::TestWithParam<Method> {
 protected:
    // Simulates the system with these settings, at a tight tolerance, so that the integration error does not count.
    Trajectory simulated(const std::string& system, const std::vector<std::string>& settings, double end_time) {
        const auto model = model_of(system);
        auto run = model->default_run();
        for (const std::string& setting : settings) assign(run, model->description(), setting);
        run.options.method = GetParam();
        run.options.end_time = end_time;
        run.options.tolerance = 1e-13;
        run.options.truncation.eps_t = 1e-10;
        description_ = &model->description();
        run_ = run;
        Trajectory trajectory = simulate(model, run);
        EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
        return trajectory;
    }
    // A parameter's value in the last simulated system.
    double value(const std::string& parameter) const {
        auto run = run_;
        const double* const found = find_value(*description_, run, parameter);
        return found != nullptr ? *found : throw std::logic_error("no parameter " + parameter);
    }

 private:
    const SystemDescription* description_ = nullptr;
    achilles::Run run_;
};

Event only(const Trajectory& trajectory, Event::Kind kind) {
    const std::vector<Event> events = events_of(trajectory, kind);
    EXPECT_EQ(events.size(), 1u);
    return events.empty() ? Event{} : events.front();
}

std::string set(const std::string& name, double value) { return fmt::format("{}={}", name, value); }

// tau_inf = t1 + 2 e v1/(g (1 - e)), with the time t1 and the speed v1 of the first impact.
TEST_P(ClosedForm, FlatFloor) {
    for (const double e : {0.0, 0.3, 0.7, 0.9}) {
        SCOPED_TRACE(e);
        const double end_time = 12.0;
        const Trajectory trajectory = simulated("ball_on_floor", {set("e", e), "y'=1"}, end_time);
        const double g = value("g"), height = 1.0 - value("r");
        const double v1 = sqrt(1.0 + 2.0 * g * height), t1 = (1.0 + v1) / g;
        const Event zeno = only(trajectory, Event::Kind::zeno);
        EXPECT_NEAR(zeno.t, t1 + 2.0 * e * v1 / (g * (1.0 - e)), within);
        EXPECT_NEAR(zeno.q[0], 0.5 * zeno.t, within);
        double t = t1, speed = v1;
        for (const Event& impact : events_of(trajectory, Event::Kind::impact)) {
            EXPECT_NEAR(impact.t, t, within);
            EXPECT_NEAR(impact.impact_speed, speed, within);
            speed *= e;
            t += 2.0 * speed / g;
        }
        EXPECT_NEAR(trajectory.end.q[0], 0.5 * end_time, within);
        EXPECT_NEAR(trajectory.end.q[1], value("r"), within);
    }
}

// Gravity is g cos(alpha) normal to the plane. Along it the ball accelerates with g sin(alpha), independent of impacts.
TEST_P(ClosedForm, Incline) {
    for (const double alpha : {0.1, 0.4, 1.0}) {
        SCOPED_TRACE(alpha);
        const double end_time = 4.0;
        const Trajectory trajectory = simulated("ball_on_incline", {set("alpha", alpha)}, end_time);
        const double g = value("g"), e = value("e"), across = g * cos(alpha), along = g * sin(alpha);
        const double h = 0.6 * cos(alpha) - value("r"), v1 = sqrt(2.0 * across * h);
        EXPECT_NEAR(only(trajectory, Event::Kind::zeno).t, v1 / across + 2.0 * e * v1 / (across * (1.0 - e)), within);
        const double traveled = along * end_time * end_time / 2.0, speed = along * end_time;
        const Vector &q = trajectory.end.q, &v = trajectory.end.v;
        EXPECT_NEAR(q[0] * cos(alpha) - (q[1] - 0.6) * sin(alpha), traveled, within * traveled);
        EXPECT_NEAR(v[0] * cos(alpha) - v[1] * sin(alpha), speed, within * speed);
    }
}

// Start at the top with speed v. Release at cos(phi) = 2/3 + v^2/(3 g R); phi'^2 = (v/R)^2 + 4 (g/R) sin^2(phi/2)
// before.
TEST_P(ClosedForm, ReleaseFromTheCylinder) {
    for (const double v : {1e-5, 0.05, 0.2, 1.0, 2.0}) {
        SCOPED_TRACE(v);
        const Trajectory trajectory =
            simulated("ball_on_cylinder", {"x=0", "y=1", set("x'", v), "y'=0"}, v < 0.01 ? 5.0 : 2.0);
        ASSERT_EQ(trajectory.phases.front().kind, Phase::Kind::constrained);
        const double g = value("g"), R = value("R");
        const Event release = only(trajectory, Event::Kind::release);
        const double phi = acos(2.0 / 3.0 + v * v / (3.0 * g * R));
        EXPECT_NEAR(release.q[1] / R, cos(phi), within);
        EXPECT_NEAR(release.v_after.norm(), sqrt(g * R * cos(phi)), within);
        if (v < 0.01) continue;  // at a slow start rounding shifts the time of the fall
        // t = 2/w F(phi/2 | -m) with w = v/R, m = 4 g/(R w^2).
        const double w = v / R, m = 4.0 * g / (R * w * w), k = sqrt(m / (1.0 + m));
        // F(a | -m) = (K(k) - F(pi/2 - a, k))/sqrt(1 + m)
        const double t =
            2.0 / (w * sqrt(1.0 + m)) * (boost::math::ellint_1(k) - boost::math::ellint_1(k, pi / 2.0 - phi / 2.0));
        EXPECT_NEAR(release.t, t, within);
    }
}

// After a Zeno point at phi0 with speed v: release at 3 cos(phi) = 2 cos(phi0) + v^2/(g R).
TEST_P(ClosedForm, ReleaseFromTheCylinderAfterBouncing) {
    const Trajectory trajectory = simulated("ball_on_cylinder", {}, 1.4);
    const Event zeno = only(trajectory, Event::Kind::zeno), release = only(trajectory, Event::Kind::release);
    const double gR = value("g") * value("R");
    EXPECT_NEAR(3.0 * release.q[1] / value("R"), 2.0 * zeno.q[1] / value("R") + zeno.v_after.squaredNorm() / gR,
                within);
}

// With the knee locked, the system is a single pendulum. From rest at theta1 = -a, the knee is released at the
// vertical, after a quarter of the period 4 sqrt(I/(M g l)) K(sin(a/2)).
TEST_P(ClosedForm, LockedPendulum) {
    for (const double a : {0.1, 0.7, 1.5}) {
        SCOPED_TRACE(a);
        const Trajectory trajectory =
            simulated("double_pendulum", {set("theta1", -a), "theta2=0", "m1=2", "L2=0.7"}, 3.0);
        ASSERT_EQ(trajectory.phases.front().kind, Phase::Kind::constrained);
        const double m1 = value("m1"), m2 = value("m2"), L1 = value("L1"), L2 = value("L2"), g = value("g");
        const double inertia = m1 * L1 * L1 / 3.0 + m2 * (L1 * L1 + L1 * L2 + L2 * L2 / 3.0);
        const double moment = g * (m1 * L1 / 2.0 + m2 * (L1 + L2 / 2.0)), k = sin(a / 2.0);
        const std::vector<Event> releases = events_of(trajectory, Event::Kind::release);
        ASSERT_FALSE(releases.empty());
        EXPECT_NEAR(releases.front().t, sqrt(inertia / moment) * boost::math::ellint_1(k), within);
        EXPECT_NEAR(releases.front().q[0], 0.0, within);
        EXPECT_NEAR(releases.front().v_after[0], 2.0 * k * sqrt(moment / inertia), within);
    }
}

// Sliding in y = c x^2 with amplitude A: (1 + 4 c^2 x^2) x'^2 = 2 g c (A^2 - x^2), so the period is
// 4 sqrt((1 + p)/(2 g c)) E(k) with p = 4 c^2 A^2, k^2 = p/(1 + p).
TEST_P(ClosedForm, SlidingInTheBowl) {
    const double A = 1.0, c = 0.5, g = 9.81, p = 4.0 * c * c * A * A;
    const double period = 4.0 * sqrt((1.0 + p) / (2.0 * g * c)) * boost::math::ellint_2(sqrt(p / (1.0 + p)));
    const Trajectory quarter = simulated("ball_in_bowl", {"x=-1", "y=0.5"}, period / 4.0);
    EXPECT_NEAR(quarter.end.q[0], 0.0, within);
    EXPECT_NEAR(quarter.end.v[0], A * sqrt(2.0 * g * c), within);
    const Trajectory whole = simulated("ball_in_bowl", {"x=-1", "y=0.5"}, period);
    EXPECT_NEAR(whole.end.q[0], -1.0, within);
    EXPECT_NEAR(whole.end.v[0], 0.0, within * g);
    EXPECT_EQ(whole.phases.size(), 1u);
}

// Start at the bottom with v^2 in (2 g R, 5 g R): release at cos(phi) = -(v^2 - 2 g R)/(3 g R).
TEST_P(ClosedForm, ReleaseInsideTheRing) {
    for (const double rate : {6.5, 7.0, 8.0, 9.5}) {
        SCOPED_TRACE(rate);
        const Trajectory trajectory = simulated("bead_in_ring", {set("phi'", rate)}, 0.6);
        const double g = value("g"), R = value("R"), v2 = R * R * rate * rate;
        const std::vector<Event> releases = events_of(trajectory, Event::Kind::release);
        ASSERT_FALSE(releases.empty());
        const double phi = acos(-(v2 - 2.0 * g * R) / (3.0 * g * R)), k = sqrt(4.0 * g / (R * rate * rate));
        EXPECT_NEAR(releases.front().q[1], phi, within);
        // phi'^2 = rate^2 - 4 (g/R) sin^2(phi/2), so t = 2/rate F(k, phi/2); for k > 1 by the reciprocal modulus.
        const double t = k <= 1.0 ? 2.0 / rate * boost::math::ellint_1(k, phi / 2.0)
                                  : 2.0 / (rate * k) * boost::math::ellint_1(1.0 / k, asin(k * sin(phi / 2.0)));
        EXPECT_NEAR(releases.front().t, t, within);
    }
}

// With the pendulum on its stop, cart and pendulum move as one mass. From rest at x = -A, release is at
// x = g tan(alpha) (M + m)/k.
TEST_P(ClosedForm, CartAndPendulum) {
    const double A = 0.3, alpha = 10.0 * pi / 180.0;
    const Trajectory trajectory = simulated("cart_pendulum", {"x=-0.3", set("theta", alpha), set("alpha", alpha)}, 1.0);
    const double mass = value("M") + value("m"), w = sqrt(value("k") / mass);
    const double x = value("g") * std::tan(alpha) / (w * w);
    const std::vector<Event> releases = events_of(trajectory, Event::Kind::release);
    ASSERT_FALSE(releases.empty());
    EXPECT_NEAR(releases.front().t, acos(-x / A) / w, within);
    EXPECT_NEAR(releases.front().q[0], x, within);
    EXPECT_NEAR(releases.front().v_after[0], w * sqrt(A * A - x * x), within);
}

// The mass stays on the stop until the spring of the shaker is relaxed, at cos(om t) = 0. Then it starts from rest.
TEST_P(ClosedForm, ImpactOscillator) {
    const double end = 0.5;
    const Trajectory trajectory = simulated("impact_oscillator", {"x=0"}, end);
    const double om = value("om"), w = sqrt(value("k") / value("m")), a = value("a");
    const Event release = only(trajectory, Event::Kind::release);
    EXPECT_NEAR(release.t, pi / 2.0 / om, within);
    // x'' + w^2 x = w^2 a sin(om s), s = t - pi/(2 om), with x = x' = 0 at s = 0.
    const double s = end - release.t, b = a * w * w / (w * w - om * om);
    EXPECT_NEAR(trajectory.end.q[0], b * (sin(om * s) - om / w * sin(w * s)), within);
    EXPECT_NEAR(trajectory.end.v[0], b * om * (cos(om * s) - cos(w * s)), within);
}

// With the shaker at rest, a flight of take-off speed u is x = u/w sin(w t) - d (1 - cos(w t)) and lasts
// 2/w atan(u/(w d)).
TEST_P(ClosedForm, ImpactOscillatorThatNothingShakes) {
    const double d = 0.1, e = 0.6;
    const Trajectory trajectory = simulated("impact_oscillator", {"x=0.02", "om=1e-9"}, 0.2);
    const double w = sqrt(value("k") / value("m"));
    double t = acos(d / (d + 0.02)) / w, speed = w * sqrt((d + 0.02) * (d + 0.02) - d * d);
    for (int k = 0; k < 100; ++k) {
        speed *= e;
        t += 2.0 / w * std::atan(speed / (w * d));
    }
    EXPECT_NEAR(only(trajectory, Event::Kind::zeno).t, t, within);
}

// Without drive and damper, ball and table oscillate as one mass about y = -m g/K. The ball is released where the
// acceleration of the table alone is that of free fall, at y = M g/K.
TEST_P(ClosedForm, SprungTable) {
    const Trajectory trajectory = simulated("ball_on_table", {"z=-0.2", "y=-0.2", "F=0", "d=0"}, 0.4);
    const double w = sqrt(value("K") / (value("M") + value("m")));
    const double rest = -value("m") * value("g") / value("K"), off = value("M") * value("g") / value("K");
    const Event release = only(trajectory, Event::Kind::release);
    EXPECT_NEAR(release.t, acos((off - rest) / (-0.2 - rest)) / w, within);
    EXPECT_NEAR(release.q[1], off, within);
    EXPECT_NEAR(release.v_after[0], w * sqrt((0.2 + rest) * (0.2 + rest) - (off - rest) * (off - rest)), within);
}

// The vibrating table of amplitude a releases the ball where a om^2 sin(om t) = g.
TEST_P(ClosedForm, ThrownByAVibratingTable) {
    const Trajectory trajectory = simulated("ball_on_vibrating_table", {"y=0", "y'=1"}, 0.15);
    const double a = value("a"), om = value("om"), g = value("g");
    const Event release = only(trajectory, Event::Kind::release);
    EXPECT_NEAR(release.t, asin(g / (a * om * om)) / om, within);
    EXPECT_NEAR(release.v_after[0], a * om * cos(om * release.t), within);
}

INSTANTIATE_TEST_SUITE_P(Gallery, ClosedForm, testing::ValuesIn(all_methods()),
                         [](const auto& one) { return std::string(to_text(one.param)); });

}  // namespace
}  // namespace achilles::test
