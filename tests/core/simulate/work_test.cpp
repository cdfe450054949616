// The work of forces along a run, against quadrature of the power with far more points.
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

// Twice 30 points.
WorkAndSize reference_work(const Trajectory& trajectory, const DenseSegment& piece, double to) {
    const Model& model = *trajectory.model;
    Evaluator<double> power = model.evaluator(model.power(piece.motion()), trajectory.run.parameters);
    WorkAndSize sum;
    for (int part = 0; part < 2; ++part) {
        const double from = piece.start + 0.5 * part * (to - piece.start);
        const auto power_at = [&](double t) {
            set_state(power, state_in(piece, trajectory.coefficients, model.dof(), t));
            power.run();
            return power.output(0);
        };
        using boost::math::quadrature::gauss;
        const double until = from + 0.5 * (to - piece.start);
        sum.work += gauss<double, 30>::integrate(power_at, from, until);
        sum.size += gauss<double, 30>::integrate([&](double t) { return std::abs(power_at(t)); }, from, until);
    }
    return sum;
}

TEST(Work, IsTheIntegralOfThePower) {
    constexpr double accuracy = 1e-13;  // of the largest step's integral of the absolute value; 4e-14 when written
    int systems = 0;
    for (const std::string& name : test::all_systems()) {
        const auto model = test::load(name);
        if (!model->equations().has_power()) continue;
        ++systems;
        for (const auto& [method, tolerance] : {std::pair(Method::taylor, 1e-4), std::pair(Method::taylor, 1e-10),
                                                std::pair(Method::taylor, 1e-15), std::pair(Method::dopri5, 1e-7)}) {
            achilles::Run run = model->default_run();
            run.options.method = method;
            run.options.tolerance = tolerance;
            const Trajectory trajectory = simulate(model, run);
            WorkIntegrator work(*model, run);
            double largest = 0.0;  // a step's
            for (const DenseSegment& piece : trajectory.pieces)
                largest = std::max(largest, reference_work(trajectory, piece, piece.end).size);
            EXPECT_GT(largest, 0.0) << name;
            for (const DenseSegment& piece : trajectory.pieces)
                for (const double part : {0.3, 1.0}) {
                    const double to = piece.start + part * (piece.end - piece.start);
                    const WorkAndSize expected = reference_work(trajectory, piece, to);
                    const double of_time = 0x1p-50 * std::abs(to) / (to - piece.start);  // rounding of time in the step
                    EXPECT_NEAR(work.along(piece, trajectory.coefficients, to).work, expected.work,
                                accuracy * largest + of_time * expected.size)
                        << name << ", " << to_text(method) << ", " << tolerance << ", t = " << to;
                }
        }
    }
    EXPECT_GT(systems, 8);
}

// The mass is at rest on the floor, so a single step covers the run, in which the potential energy oscillates: its
// series does not converge fast enough.
TEST(Work, IncludesAPowerThatVariesFasterThanTheMotion) {
    const auto model = test::typed(R"toml(
title = "At rest in a varying potential"
[[coordinate]]
name = "y"
start = 0.0
[[parameter]]
name = "c"
value = 0.5
[lagrangian]
kinetic = "1/2*y'^2"
potential = "y + c*sin(20*t)"
[[constraint]]
name = "floor"
gap = "y"
restitution = 0.3
[run]
end_time = 1.0
tolerance = 1e-10
)toml");
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_EQ(trajectory.pieces.size(), 1u);
    EXPECT_NEAR(trajectory.work, 0.5 * std::sin(20.0), 1e-12);
    EXPECT_NEAR(Sampler(trajectory).at(0.4).work, 0.5 * std::sin(8.0), 1e-12);
}

}  // namespace
}  // namespace achilles
