// The work of forces and the heat of friction along a run, against quadrature of their rates with far more points.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>

#include "core/systems.hpp"
#include "simulate/flow.hpp"
#include "simulate/sampler.hpp"

namespace achilles {
namespace {

struct WorkAndSize {
    double work = 0.0, size = 0.0;  // integrals of the power and of its absolute value
};

// The work, or with output 1 the heat of friction, by twice 30 points.
WorkAndSize reference_work(const Trajectory& trajectory, const DenseSegment& piece, double to, std::size_t output) {
    const Model& model = *trajectory.model;
    Evaluator<double> power = model.evaluator(model.power(piece.motion()), trajectory.run.parameters);
    WorkAndSize sum;
    for (int part = 0; part < 2; ++part) {
        const double from = piece.start + 0.5 * part * (to - piece.start);
        const auto power_at = [&](double t) {
            set_state(power, state_in(piece, trajectory.coefficients, model.dof(), t));
            power.run();
            return power.output(output);
        };
        using boost::math::quadrature::gauss;
        const double until = from + 0.5 * (to - piece.start);
        sum.work += gauss<double, 30>::integrate(power_at, from, until);
        sum.size += gauss<double, 30>::integrate([&](double t) { return std::abs(power_at(t)); }, from, until);
    }
    return sum;
}

// Without friction the work is accurate to rounding: 1e-13 of the largest step's integral of the absolute value; 4e-14
// when written. With friction work and heat are as accurate as the motion: terms that are left out are below a
// thirtieth of the tolerance.
double accuracy(const Model& model, double tolerance) {
    return model.has_friction() ? std::max(1e-13, tolerance / 30.0) : 1e-13;
}

// Expects that the work, or with output 1 the heat, of every step of a run is the integral. Returns that of the largest
// step.
double expect_integrals(const Trajectory& trajectory, std::size_t output) {
    const Model& model = *trajectory.model;
    const double tolerance = trajectory.run.options.tolerance;
    WorkIntegrator integrator(model, trajectory.run);
    double largest = 0.0;
    for (const DenseSegment& piece : trajectory.pieces)
        largest = std::max(largest, reference_work(trajectory, piece, piece.end, output).size);
    for (const DenseSegment& piece : trajectory.pieces)
        for (const double part : {0.3, 1.0}) {
            const double to = piece.start + part * (piece.end - piece.start);
            const WorkAndSize expected = reference_work(trajectory, piece, to, output);
            const double of_time = 0x1p-50 * std::abs(to) / (to - piece.start);  // rounding of time in the step
            const EnergyFlow found = integrator.along(piece, trajectory.coefficients, to);
            EXPECT_NEAR(output == 0 ? found.work : found.heat, expected.work,
                        accuracy(model, tolerance) * largest + of_time * expected.size)
                << model.description().title << ", output " << output << ", " << to_text(trajectory.run.options.method)
                << ", " << tolerance << ", t = " << to;
        }
    return largest;
}

TEST(Work, IsTheIntegralOfThePower) {
    int systems = 0, heated = 0;
    for (const std::string& name : test::all_systems()) {
        const auto model = test::load(name);
        if (!model->equations().has_power() && !model->has_friction()) continue;
        ++systems;
        for (const auto& [method, tolerance] : {std::pair(Method::taylor, 1e-4), std::pair(Method::taylor, 1e-10),
                                                std::pair(Method::taylor, 1e-15), std::pair(Method::dopri5, 1e-7)}) {
            achilles::Run run = model->default_run();
            run.options.method = method;
            run.options.tolerance = tolerance;
            const Trajectory trajectory = simulate(model, run);
            const double work = expect_integrals(trajectory, 0);
            // The stops of the pair do work at impacts only.
            EXPECT_TRUE(work > 0.0 || !model->equations().has_power() || name == "impact_pair") << name;
            if (model->has_friction() && expect_integrals(trajectory, 1) > 0.0) ++heated;
        }
    }
    EXPECT_GT(systems, 16);
    EXPECT_EQ(heated, 4 * 10);  // the ball between walls and the rocking block slip only at impacts
}

// The mass stays on the floor, so a single step covers the run, in which the potential energy oscillates: its series
// does not converge fast enough.
constexpr const char* varying_potential = R"toml(
title = "On the floor in a varying potential"
coordinate = [{name = "y"}, {name = "x", rate = 3.0}]
parameter = [{name = "c", value = 0.5}]
lagrangian = {kinetic = "1/2*(x'^2 + y'^2)", potential = "y + c*sin(20*t)"}
run = {end_time = 1.0, tolerance = 1e-10}
)toml";

TEST(Work, IncludesAPowerThatVariesFasterThanTheMotion) {
    for (const char* friction : {"", ", slip = \"x'\", friction = 0.1"}) {
        const auto model = test::typed(fmt::format(
            "{}constraint = [{{name = \"floor\", gap = \"y\", restitution = 0.3{}}}]\n", varying_potential, friction));
        const Trajectory trajectory = simulate(model, model->default_run());
        EXPECT_EQ(trajectory.pieces.size(), 1u);
        EXPECT_NEAR(trajectory.work, 0.5 * std::sin(20.0), 1e-12) << friction;
        EXPECT_NEAR(trajectory.heat, model->has_friction() ? 0.1 * 2.95 : 0.0, 1e-12);
        EXPECT_NEAR(Sampler(trajectory).at(0.4).work, 0.5 * std::sin(8.0), 1e-12) << friction;
    }
}

}  // namespace
}  // namespace achilles
