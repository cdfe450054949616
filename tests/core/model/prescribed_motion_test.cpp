// A kinetic energy with t and terms of degree 1 and 0 in the rates, against equations derived by hand and typed as
// forces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "check/check.hpp"
#include "core/systems.hpp"
#include "enclose/enclosure.hpp"
#include "sensitivity/derivatives.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

using Runs = std::shared_ptr<const Model>;

// A pendulum whose pivot moves along y = a cos(om t), with a stop at theta = 0.2. T and the force on theta vary.
std::string kapitza(const std::string& kinetic, const std::string& force) {
    return R"toml(title = "Kapitza's pendulum"
coordinate = [{name = "theta", start = 0.7, rate = -0.4, unit = "rad", force = ")toml" +
           force + R"toml("}]
parameter = [{name = "m", value = 1.3}, {name = "L", value = 0.5}, {name = "a", value = 0.05},
             {name = "om", value = 9.0}, {name = "g", value = 9.81}]
lagrangian.kinetic = ")toml" +
           kinetic + R"toml("
lagrangian.potential = "-m*g*L*cos(theta)"
constraint = [{gap = "theta - 0.2", restitution = 0.6}]
run = {end_time = 3.0, tolerance = 1e-14}
)toml";
}

Runs kapitza_by_energy() {
    return test::typed(kapitza("m/2*((L*theta'*cos(theta))^2 + (L*theta'*sin(theta) - a*om*sin(om*t))^2)", "0"));
}

Runs kapitza_by_hand() { return test::typed(kapitza("m*L^2/2*theta'^2", "m*a*om^2*cos(om*t)*L*sin(theta)")); }

// A bead on a hoop of radius R that turns about its vertical diameter at the rate om.
std::string hoop(const std::string& kinetic, const std::string& force) {
    return R"toml(title = "Bead on a rotating hoop"
coordinate = [{name = "theta", start = 0.4, rate = 0.2, unit = "rad", force = ")toml" +
           force + R"toml("}]
parameter = [{name = "m", value = 0.7}, {name = "R", value = 0.4}, {name = "om", value = 6.0},
             {name = "g", value = 9.81}]
lagrangian.kinetic = ")toml" +
           kinetic + R"toml("
lagrangian.potential = "-m*g*R*cos(theta)"
constraint = [{gap = "0.6 - theta", restitution = 0.5}]
run = {end_time = 3.0, tolerance = 1e-14}
)toml";
}

const std::string hoop_in_its_plane = "m/2*R^2*(theta'^2 + om^2*sin(theta)^2)";
const std::string hoop_in_space =
    "m/2*((R*theta'*cos(theta)*cos(om*t) - R*om*sin(theta)*sin(om*t))^2 + (R*theta'*cos(theta)*sin(om*t) + "
    "R*om*sin(theta)*cos(om*t))^2 + (R*theta'*sin(theta))^2)";

Runs hoop_by_hand() { return test::typed(hoop("m/2*R^2*theta'^2", "m*R^2*om^2*sin(theta)*cos(theta)")); }

// A mass in a frame that turns at the rate w = b + d t, with springs and a wall that turn as well. The bodies' velocity
// has the components x' - w y and y' + w x.
std::string turntable(const std::string& kinetic, const std::string& on_x, const std::string& on_y) {
    return R"toml(title = "Mass on a turntable"
coordinate = [{name = "x", start = 0.5, rate = 0.3, force = ")toml" +
           on_x + R"toml("}, {name = "y", start = 0.6, rate = -0.4, force = ")toml" + on_y + R"toml("}]
parameter = [{name = "m", value = 1.5}, {name = "b", value = 0.8}, {name = "d", value = 0.3},
             {name = "k", value = 20.0}]
lagrangian.kinetic = ")toml" +
           kinetic + R"toml("
lagrangian.potential = "k/2*(x^2 + y^2)"
constraint = [{gap = "y + x/4 - 0.1", restitution = 0.5}]
run = {end_time = 3.0, tolerance = 1e-14}
)toml";
}

Runs turntable_by_energy() {
    return test::typed(turntable("m/2*((x' - (b + d*t)*y)^2 + (y' + (b + d*t)*x)^2)", "0", "0"));
}

Runs turntable_by_hand() {
    return test::typed(turntable("m/2*(x'^2 + y'^2)", "2*m*(b + d*t)*y' + m*d*y + m*(b + d*t)^2*x",
                                 "-2*m*(b + d*t)*x' - m*d*x + m*(b + d*t)^2*y"));
}

// The largest difference between the accelerations of two systems at random states, relative to their size.
double difference(const Model& one, const Model& other) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-2.0, 2.0);
    const std::vector<double> parameters = one.default_run().parameters;
    MotionTerms<Evaluator<double>> first = one.evaluator(one.motion({}).program, parameters),
                                   second = other.evaluator(other.motion({}).program, parameters);
    double largest = 0.0;
    for (int k = 0; k < 1000; ++k) {
        State state{Vector(one.dof()), Vector(one.dof()), 2.0 + any(random)};
        for (Eigen::Index i = 0; i < state.q.size(); ++i) {
            state.q[i] = any(random);
            state.v[i] = 2.0 * any(random);
        }
        double size = 1.0, gap = 0.0;
        for (auto* terms : {&first, &second}) {
            set_state(*terms, state);
            terms->run();
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(one.dof()); ++i) {
            size = std::max(size, std::abs(second.acceleration(i)));
            gap = std::max(gap, std::abs(first.acceleration(i) - second.acceleration(i)));
        }
        largest = std::max(largest, gap / size);
    }
    return largest;
}

// The events of two systems agree in kind, and to this distance in time and state. Returns their number.
std::size_t expect_same_run(const Runs& one, const Runs& other, double distance) {
    const Trajectory a = simulate(one, one->default_run()), b = simulate(other, other->default_run());
    EXPECT_EQ(a.outcome.kind, b.outcome.kind);
    EXPECT_EQ(a.events.size(), b.events.size());
    for (std::size_t i = 0; i < std::min(a.events.size(), b.events.size()); ++i) {
        SCOPED_TRACE(i);
        EXPECT_EQ(a.events[i].kind, b.events[i].kind);
        EXPECT_NEAR(a.events[i].t, b.events[i].t, distance);
        EXPECT_NEAR((a.events[i].q - b.events[i].q).norm(), 0.0, distance);
        EXPECT_NEAR((a.events[i].v_after - b.events[i].v_after).norm(), 0.0, 10 * distance);
    }
    EXPECT_NEAR((a.end.q - b.end.q).norm(), 0.0, distance);
    return a.events.size();
}

TEST(PrescribedMotion, MovesKapitzasPendulumAsDerivedByHand) {
    const Runs energy = kapitza_by_energy(), hand = kapitza_by_hand();
    EXPECT_TRUE(energy->equations().has_prescribed_motion());
    EXPECT_FALSE(hand->equations().has_prescribed_motion());
    EXPECT_LE(difference(*energy, *hand), 1e-12);
    EXPECT_GE(expect_same_run(energy, hand, 1e-12), 10u);
}

TEST(PrescribedMotion, MovesTheBeadOnARotatingHoopAsDerivedByHand) {
    const Runs plane = test::typed(hoop(hoop_in_its_plane, "0")), space = test::typed(hoop(hoop_in_space, "0")),
               hand = hoop_by_hand();
    EXPECT_LE(difference(*plane, *hand), 1e-12);
    EXPECT_LE(difference(*space, *hand), 1e-12);
    EXPECT_GE(expect_same_run(plane, hand, 1e-12), 5u);
    expect_same_run(space, hand, 1e-12);
    // In space, sin(om*t)^2 + cos(om*t)^2 appears in M and in T0. Neither depends on t.
    EXPECT_TRUE(space->equations().autonomous);
}

TEST(PrescribedMotion, HasCoriolisAndEulerForces) {
    EXPECT_LE(difference(*turntable_by_energy(), *turntable_by_hand()), 1e-12);
    EXPECT_GE(expect_same_run(turntable_by_energy(), turntable_by_hand(), 1e-12), 3u);
}

// energy = T2 - T0 + V; energy - work + loss is constant.
TEST(PrescribedMotion, KeepsTheBalanceOfEnergy) {
    for (const Runs& model : {kapitza_by_energy(), turntable_by_energy(), test::typed(hoop(hoop_in_space, "0"))}) {
        SCOPED_TRACE(model->description().title);
        const Trajectory run = simulate(model, model->default_run());
        EnergyTerms<Evaluator<double>> energy = model->evaluator(model->energy(), run.run.parameters);
        Sampler sampler(run);
        double first = 0.0, largest = 0.0, work = 0.0;
        for (int k = 0; k <= 200; ++k) {
            const Sample now = sampler.at(run.run.options.end_time * k / 200.0);
            set_state(energy, now.state);
            energy.run();
            const double balance = energy.total() - now.work + now.loss;
            if (k == 0) first = balance;
            largest = std::max(largest, std::abs(balance - first));
            work = std::max(work, std::abs(now.work));
        }
        EXPECT_LE(largest, 1e-11);
        EXPECT_EQ(work > 0.01, !model->equations().autonomous);
    }
    // By hand for the hoop: T2 - T0 + V.
    const Runs model = test::typed(hoop(hoop_in_its_plane, "0"));
    EnergyTerms<Evaluator<double>> energy = model->evaluator(model->energy(), model->default_run().parameters);
    set_state(energy, model->default_run().start());
    energy.run();
    const double s = std::sin(0.4), mRR = 0.7 * 0.4 * 0.4;
    EXPECT_NEAR(energy.total(), mRR / 2 * (0.2 * 0.2 - 36.0 * s * s) - 0.7 * 9.81 * 0.4 * std::cos(0.4), 1e-14);
}

// Terms in t alone move nothing, so they are not in the energy: here m/2 (a om sin(om t))^2.
TEST(PrescribedMotion, LeavesTermsWithoutCoordinatesOutOfTheEnergy) {
    const Runs model = kapitza_by_energy();
    const std::uint32_t t = model->layout().t();
    EXPECT_FALSE(depends_on(model->equations().potential, {&t, 1}));
    EXPECT_TRUE(depends_on(model->equations().given.kinetic, {&t, 1}));
}

TEST(PrescribedMotion, HasCertificatesAndProofs) {
    for (const Runs& model : {kapitza_by_energy(), test::typed(hoop(hoop_in_its_plane, "0"))}) {
        SCOPED_TRACE(model->description().title);
        auto run = model->default_run();
        run.options.tolerance = 1e-12;
        const Trajectory trajectory = simulate(model, run);
        ASSERT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time);
        const auto first = std::find_if(trajectory.events.begin(), trajectory.events.end(),
                                        [](const Event& event) { return event.is_zeno(); });
        ASSERT_NE(first, trajectory.events.end());
        EXPECT_TRUE(first->certificate && first->certificate->certified);
        const double zeno = first->t;
        run.options.end_time = std::min(zeno + 0.1, run.options.end_time);
        EnclosureProblem claim = problem_of(run);
        inflate(claim, 1e-9);
        const Enclosure proof = prove(model, claim);
        EXPECT_EQ(proof.outcome.kind, Enclosure::ProofOutcome::Kind::end_time) << proof.outcome.message;
        bool is_inside = false;
        for (const EnclosedEvent& event : proof.events)
            is_inside = is_inside || (event.is_zeno() && event.t.lo() <= zeno + 1e-6 && event.t.hi() >= zeno - 1e-6);
        EXPECT_TRUE(is_inside);
    }
}

TEST(PrescribedMotion, IsVerifiedByDifferencesOfTheLagrangianAsGiven) {
    for (const Runs& model : {kapitza_by_energy(), test::typed(hoop(hoop_in_space, "0")), turntable_by_energy()}) {
        double disagreement = 1.0;
        const std::string answer = check_answer(*model, model->default_run(), disagreement);
        EXPECT_LE(disagreement, 1e-12);
        EXPECT_NE(answer.find("'energy' is T2 - T0 + V"), std::string::npos) << answer;
    }
    double disagreement = 1.0;
    EXPECT_EQ(check_answer(*kapitza_by_hand(), kapitza_by_hand()->default_run(), disagreement).find("T2"),
              std::string::npos);
}

TEST(PrescribedMotion, MustNotMakeTheMassMatrixDependOnTime) {
    const std::string text = R"toml(coordinate = [{name = "theta", start = 1}]
title = "f"
lagrangian.kinetic = "theta'^2*t^2/2 + t*theta'"
lagrangian.potential = "0"
constraint = [{gap = "theta", restitution = 0}]
)toml";
    const std::string advice =
        "choose a coordinate that moves with the prescribed motion: with s = l(t)*theta instead of theta, "
        "m/2*(l(t)*theta')^2 is m/2*(s' - s*l'(t)/l(t))^2, and the factor of s'^2 does not depend on t";
    EXPECT_EQ(test::told(text),
              "f.toml:3:23: the term theta'^2*t^2/2 of the kinetic energy makes the mass matrix depend on t\n    "
              "lagrangian.kinetic = \"theta'^2*t^2/2 + t*theta'\"\n                          ^\n" +
                  advice);
    std::string length = text;
    const std::string from = "theta'^2*t^2/2 + t*theta'";
    length.replace(length.find(from), from.size(), "(theta' + t)^2 + ((2 + sin(t))*theta' + cos(t))^2");
    EXPECT_EQ(
        test::told(length),
        "f.toml:3:40: the term (2 + sin(t))^2*theta'^2 of the kinetic energy makes the mass matrix depend on t\n  "
        "  lagrangian.kinetic = \"(theta' + t)^2 + ((2 + sin(t))*theta' + cos(t))^2\"\n                       "
        "                    ^\n" +
            advice);
}

}  // namespace
}  // namespace achilles
