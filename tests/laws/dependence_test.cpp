// Laws that the derivatives of every run obey (theory-derivatives.md 3 and 4), tested on every gallery file.
#include <Eigen/LU>
#include <Eigen/SVD>

#include "certify/execution.hpp"
#include "core/systems.hpp"
#include "laws/laws.hpp"
#include "sensitivity/derivatives.hpp"
#include "sensitivity/gradient.hpp"

namespace achilles::test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Run exact_run(const Model& model, double end_time = 0.0) {
    Run run = model.default_run();
    run.options.tolerance = 1e-14;
    for (double* each : {&run.options.truncation.eps_q, &run.options.truncation.eps_v, &run.options.truncation.eps_t})
        *each = 1e-9;
    if (end_time > 0.0) run.options.end_time = end_time;
    return run;
}

// Derivatives of (q, v) at the end time by the initial values, 2n x 2n.
MatrixXd by_starts(const achilles::Derivatives& d) {
    const Index n = d.end->q.rows();
    MatrixXd result(2 * n, 2 * n);
    result << d.end->q.leftCols(2 * n), d.end->v.leftCols(2 * n);
    return result;
}

double det_of_mass(const Model& model, const Run& run, const State& state) {
    auto motion = model.evaluator(model.motion({}).program, run.parameters);
    set_state(motion, state);
    motion.run();
    double product = 1.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.dof()); ++i) product *= motion.pivot(i);
    return product;
}

bool has_damping(const SystemDescription& system) {
    if (!system.dissipation.text.empty()) return true;
    return std::any_of(system.coordinates.begin(), system.coordinates.end(),
                       [](const auto& one) { return one.force.text.find('\'') != std::string::npos; });
}

class Dependence : public testing::TestWithParam<std::string> {
 protected:
    std::shared_ptr<const Model> model_ = model_of(GetParam());
};

// Without completion det dx(t)/dx0 = e^(2N) det M(q0)/det M(q(t)) after N impacts. Tested up to the last impact before
// the first cut.
TEST_P(Dependence, KeepsPhaseVolumeBetweenImpacts) {
    if (has_damping(model_->description())) return;
    const Trajectory whole = simulate(model_, exact_run(*model_));
    if (!whole.phases.front().mode.held().empty()) return;
    double until = whole.end_time;
    for (const Event& event : whole.events)
        if (event.truncation || event.kind == Event::Kind::release || !event.mode.held().empty()) {
            until = event.truncation ? event.truncation->t : event.t;
            break;
        }
    double end = 0.0;  // far from impacts: at 0.7 of the flight before an impact
    for (std::size_t i = 0; i < whole.events.size() && i < 8; ++i) {
        const double before = i == 0 ? whole.run.options.start_time : whole.events[i - 1].t;
        if (whole.events[i].t < until && whole.events[i].t > before) end = before + 0.7 * (whole.events[i].t - before);
    }
    if (!(end > whole.run.options.start_time)) return;
    const achilles::Run run = exact_run(*model_, end);
    const Trajectory trajectory = simulate(model_, run);
    const auto d = differentiate(trajectory);
    const bool starts_at_rest =
        std::any_of(d.refused.begin(), d.refused.end(), [](const std::string& reason) { return !reason.empty(); });
    if (!d.end || starts_at_rest) return;
    double expected = det_of_mass(*model_, run, run.start()) / det_of_mass(*model_, run, trajectory.end);
    for (const Event& event : trajectory.events)
        expected *= std::pow(model_->restitution(run.parameters, event.contacts.only()), 2);
    // Relative to the size of the terms that cancel in the determinant.
    const MatrixXd by = by_starts(d);
    const double size = std::pow(by.norm(), static_cast<double>(by.rows()));
    EXPECT_NEAR(by.determinant(), expected, 1e-11 * std::abs(expected) + 1e-15 * size) << trajectory.events.size();
}

// In contact all derivatives are tangent to h = 0, hdot = 0. A Zeno point forgets two dimensions of the initial values.
TEST_P(Dependence, IsTangentInContact) {
    const Trajectory trajectory = simulate(model_, exact_run(*model_));
    const auto d = differentiate(trajectory);
    const std::size_t n = static_cast<std::size_t>(model_->dof()), P = trajectory.run.parameters.size();
    const TangentLayout tangent{n, model_->contacts(), P};
    const Index K = static_cast<Index>(d.refused.size());
    const auto expect_tangent = [&](const State& state, ContactSet held, const MatrixXd& q, const MatrixXd& v,
                                    const VectorXd& t, const std::string& where) {
        MatrixXd Z = MatrixXd::Zero(tangent.size(), K);
        Z.middleRows(tangent.q(0), static_cast<Index>(n)) = q;
        Z.middleRows(tangent.v(0), static_cast<Index>(n)) = v;
        Z.row(TangentLayout::t()) = t.transpose();
        for (std::size_t k = 0; k < P; ++k) Z(tangent.p(k), static_cast<Index>(2 * n + k)) = 1.0;
        for (std::size_t i = 0; i < model_->contacts(); ++i) {
            if (!held.contains(i)) continue;
            ContactGradient contact(*model_, model_->programs_of(i).contact_terms, tangent, trajectory.run.parameters);
            contact.at(state);
            for (Index k = 0; k < K; ++k) {
                if (!d.refused[static_cast<std::size_t>(k)].empty()) continue;
                // A component far below the others is rounding error.
                const double least = 1e-2 * std::max(1.0, Z.cwiseAbs().maxCoeff());
                const double size = least + contact.h_row().cwiseAbs() * Z.col(k).cwiseAbs();
                const double rate = least + contact.hdot_row().cwiseAbs() * Z.col(k).cwiseAbs();
                EXPECT_LE(std::abs(contact.h_row() * Z.col(k)), 1e-12 * size) << where << ", direction " << k;
                EXPECT_LE(std::abs(contact.hdot_row() * Z.col(k)), 1e-12 * rate) << where << ", direction " << k;
            }
        }
    };
    for (std::size_t j = 0; j < d.events.size(); ++j) {
        const Event& event = trajectory.events[j];
        if (event.kind == Event::Kind::impact) continue;
        const ContactSet held =
            event.kind == Event::Kind::release ? event.mode.held().with(event.contacts) : event.mode.held();
        expect_tangent({event.q, event.v_after, event.t}, held, d.events[j].q, d.events[j].v_after, d.events[j].t,
                       fmt::format("event {}", j));
    }
    if (!d.end) return;
    expect_tangent(trajectory.end, trajectory.end_mode.held(), d.end->q, d.end->v, VectorXd::Zero(K), "the end");
    const std::size_t zeno = count(trajectory, Event::Kind::zeno);
    const bool all = std::all_of(d.refused.begin(), d.refused.end(), [](const auto& reason) { return reason.empty(); });
    if (zeno == 0 || !all) return;
    const VectorXd singular = Eigen::JacobiSVD<MatrixXd>(by_starts(d)).singularValues();
    EXPECT_LE(singular[singular.size() - 2], 1e-12 * singular[0]);
    EXPECT_LE(singular[singular.size() - 1], 1e-12 * singular[0]);
}

// If velocities change by a factor and gravity by its square, every event time changes by the inverse factor. So
// sum v dt/dv + 2 g dt/dg = -t for every event, if g is the only parameter whose unit contains seconds.
TEST_P(Dependence, KnowsTheUnitOfTime) {
    const SystemDescription& system = model_->description();
    if (!model_->equations().autonomous || has_damping(system)) return;
    std::optional<std::size_t> g;
    for (std::size_t k = 0; k < system.parameters.size(); ++k) {
        const auto& parameter = system.parameters[k];
        if (parameter.name == "g")
            g = k;
        else if (parameter.unit.find('s') != std::string::npos || parameter.unit.find('N') != std::string::npos)
            return;
    }
    if (!g) return;
    const Trajectory trajectory = simulate(model_, exact_run(*model_));
    const auto d = differentiate(trajectory);
    const Index n = model_->dof();
    for (const std::string& reason : d.refused)
        if (!reason.empty()) return;
    for (std::size_t j = 0; j < d.events.size(); ++j) {
        const VectorXd& t = d.events[j].t;
        double sum = 2.0 * trajectory.run.parameters[*g] * t[2 * n + static_cast<Index>(*g)], size = std::abs(sum);
        for (Index i = 0; i < n; ++i) {
            sum += trajectory.run.v[i] * t[n + i];
            size += std::abs(trajectory.run.v[i] * t[n + i]);
        }
        const double time = trajectory.events[j].t;
        EXPECT_NEAR(sum, -time, 1e-10 * (size + time)) << j << " at " << time;
    }
}

// Multiplying all masses by a factor changes no event time: sum m dt/dm = 0.
TEST_P(Dependence, KnowsTheUnitOfMass) {
    const SystemDescription& system = model_->description();
    for (const auto& coordinate : system.coordinates)
        if (!coordinate.force.text.empty()) return;
    if (!system.dissipation.text.empty()) return;
    for (const auto& parameter : system.parameters)
        if (parameter.unit.find('N') != std::string::npos || parameter.unit == "kg m^2") return;
    const Trajectory trajectory = simulate(model_, exact_run(*model_));
    const auto d = differentiate(trajectory);
    const Index n = model_->dof();
    for (std::size_t j = 0; j < d.events.size(); ++j) {
        double total = 0.0, size = 1.0;
        for (std::size_t k = 0; k < system.parameters.size(); ++k) {
            if (system.parameters[k].unit != "kg") continue;
            const double term = trajectory.run.parameters[k] * d.events[j].t[2 * n + static_cast<Index>(k)];
            total += term;
            size += std::abs(term);
        }
        EXPECT_NEAR(total, 0.0, 1e-11 * size) << j;
    }
}

// Derivative of a quantity of the reference run (34 digits) by one direction, by dual numbers. It is compared with
// fourth-order differences of reference runs, which share no code with the derivatives.
class TrueSlopes {
 public:
    using Runs = TrueRunsOf<Dual>;

    TrueSlopes(const Model& model, const achilles::Run& run, Index direction) {
        const Index n = model.dof();
        PointOf<Dual> start;
        for (Index i = 0; i < n; ++i) start.q.emplace_back(Real(run.q[i]), i == direction ? 1 : 0);
        for (Index i = 0; i < n; ++i) start.v.emplace_back(Real(run.v[i]), n + i == direction ? 1 : 0);
        start.t = run.options.start_time;
        List<Dual> parameters(run.parameters.begin(), run.parameters.end());
        if (direction >= 2 * n) parameters[static_cast<std::size_t>(direction - 2 * n)].slope = 1;
        by_duals_ = Runs(model, parameters).run(start, run.options.end_time);
        for (const int steps : {-2, -1, 1, 2}) {
            achilles::Run other = run;
            double& varied = direction < n       ? other.q[direction]
                             : direction < 2 * n ? other.v[direction - n]
                                                 : other.parameters[static_cast<std::size_t>(direction - 2 * n)];
            varied += steps * distance;
            beside_.push_back(TrueRuns(model, other).run(point_of(other.start()), run.options.end_time));
        }
    }
    // The derivative of the quantity that `take` reads from an execution of any number type.
    template <class Take>
    Real of(const Take& take) const {
        const Real slope = take(by_duals_).slope;
        const Real difference =
            (take(beside_[0]) - 8 * take(beside_[1]) + 8 * take(beside_[2]) - take(beside_[3])) / (12 * Real(distance));
        EXPECT_LE(static_cast<double>(abs(slope - difference)), 1e-18 * (1.0 + std::abs(static_cast<double>(slope))));
        return slope;
    }

 private:
    static constexpr double distance = 0x1p-23;  // its fourth power, the order of the error, is 2e-28
    TrueExecutionOf<Dual> by_duals_;
    std::vector<TrueExecution> beside_;
};

// Derivatives against those of the reference: times of the first Zeno point and release, and the final state, by one
// initial value and by e.
TEST_P(Dependence, IsWhatManyDigitsSay) {
    static const std::vector<std::string> some{"ball_on_sine",           "double_pendulum",
                                               "driven_double_pendulum", "ball_on_vibrating_table",
                                               "ball_in_gusts",          "triple_pendulum"};
    if (std::find(some.begin(), some.end(), GetParam()) == some.end()) return;
    achilles::Run run = exact_run(*model_);
    const Trajectory first = simulate(model_, run);
    for (const Event& event : first.events)  // past its first Zeno point and release
        if (event.kind == Event::Kind::release) {
            run.options.end_time = event.t + 0.3;
            break;
        }
    run.options.end_time = std::min(run.options.end_time, run.options.start_time + 8.0);
    const Trajectory trajectory = simulate(model_, run);
    const auto d = differentiate(trajectory);
    ASSERT_TRUE(d.end.has_value()) << d.broken;
    const Index n = model_->dof();
    const auto e = [&]() -> Index {
        for (std::size_t k = 0; k < run.parameters.size(); ++k)
            if (model_->description().parameters[k].name == "e") return 2 * n + static_cast<Index>(k);
        return 2 * n;
    }();
    const auto expect_near = [](double found, const Real& true_slope, const std::string& where) {
        const double expected = static_cast<double>(true_slope);
        EXPECT_NEAR(found, expected, 1e-9 * (1.0 + std::abs(expected))) << where;
    };
    for (const Index direction : {Index{0}, e}) {
        const TrueSlopes truth(*model_, run, direction);
        for (const Event::Kind kind :
             {Event::Kind::zeno, Event::Kind::release}) {  // impacts are not compared: the reference has more
            for (std::size_t j = 0; j < trajectory.events.size(); ++j) {
                if (trajectory.events[j].kind != kind) continue;
                const Real slope = truth.of([&](const auto& execution) {
                    for (const auto& event : execution.events)
                        if (event.kind == kind) return event.t;
                    throw std::runtime_error("no such event");
                });
                expect_near(d.events[j].t[direction], slope, fmt::format("{} {}", names_of(kind).word, direction));
                break;
            }
        }
        for (Index i = 0; i < n; ++i) {
            const auto at = static_cast<std::size_t>(i);
            expect_near(d.end->q(i, direction), truth.of([&](const auto& execution) { return execution.end.q[at]; }),
                        fmt::format("q {} {}", i, direction));
            expect_near(d.end->v(i, direction), truth.of([&](const auto& execution) { return execution.end.v[at]; }),
                        fmt::format("v {} {}", i, direction));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Systems, Dependence, testing::ValuesIn(systems_without_friction()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace achilles::test
