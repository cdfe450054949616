#include "simulate/flow.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

namespace achilles {

Flow::Flow(const Model& model, const Run& run)
    : stepper_(run.options.method == Method::taylor ? make_taylor(model, run) : make_dopri5(model, run)),
      edges_(model.edges().empty() ? nullptr : std::make_unique<DomainMonitor>(model, run)),
      model_(&model),
      parameters_(run.parameters) {}

void Flow::start(Mode mode, const State& state, std::span<const Gap> gaps, double first_step) {
    mode_ = mode;
    t_ = end_ = state.t;
    span_ = 0.0;
    first_ = first_step;
    to_ = state;
    fetched_ = true;
    gaps_.assign(gaps.begin(), gaps.end());
    moved_ = true;
}

// The shortest step (s), half the resolution of time.
double Flow::least() const { return 1e-16 * std::max(1e-3, std::abs(t_)); }

StepFailure Flow::step(double until) {
    t_ = end_;
    span_ = 0.0;
    const double longest = until - t_;
    const State& start = end();
    if (moved_) stepper_->initialize(mode_, start, gaps_);
    moved_ = false;
    StepFailure failure = stepper_->do_step(t_, longest, first_, least());
    first_ = 0.0;
    if (edges_ && failure == StepFailure::none) {
        const double theta = edges_->safe_part(*stepper_, t_);
        if (theta < 1.0) failure = stepper_->redo_step(theta * stepper_->current_time(), least());
    }
    if (failure != StepFailure::none) return failure;
    span_ = stepper_->current_time();
    // Avoid rounding past `until`: time never decreases.
    end_ = span_ == longest ? until : std::min(t_ + span_, until);
    fetched_ = false;
    return failure;
}

StepFailure Flow::redo_step(double duration) {
    moved_ = false;
    const StepFailure failure = stepper_->redo_step(duration, least());
    if (failure != StepFailure::none) return failure;
    span_ = stepper_->current_time();
    end_ = t_ + span_;
    fetched_ = false;
    return failure;
}

State& Flow::edit_end() {
    end();
    moved_ = true;
    return to_;
}

void Flow::move_gap(std::size_t contact, const Gap& gap) {
    gaps_[contact] = gap;
    moved_ = true;
}

void Flow::shift_end(double dt) {
    auto& motion = model_->lazily(motions_, mode_, parameters_);
    set_state(motion, end());
    motion.run();
    for (Eigen::Index i = 0; i < to_.q.size(); ++i) {
        const double a = motion.acceleration(static_cast<std::size_t>(i));
        to_.q[i] += dt * (to_.v[i] + 0.5 * dt * a);
        to_.v[i] += dt * a;
    }
    span_ += dt;
    to_.t = end_ = t_ + span_;
    moved_ = true;
}

DenseSegment Flow::piece(std::vector<double>& coefficients) const {
    DenseSegment piece;
    piece.start = t_;
    piece.end = end_;
    piece.mode = mode_;
    piece.load_bearing = mode_.held();
    piece.first = coefficients.size();
    piece.degree = stepper_->coefficients(coefficients);
    if (!moved_) return piece;
    // Corrects the polynomial to end at the projected state.
    const State& moved = end();
    const State& reached = stepper_->current_state();
    const Eigen::Index n = moved.q.size();
    double* const linear = coefficients.data() + piece.first + 2 * n;
    for (Eigen::Index i = 0; i < n; ++i) {
        linear[i] += moved.q[i] - reached.q[i];
        linear[n + i] += moved.v[i] - reached.v[i];
    }
    return piece;
}

WorkIntegrator::WorkIntegrator(const Model& model, const Run& run)
    : any_(model.equations().has_power()), dof_(model.dof()), model_(&model), parameters_(run.parameters) {}

double WorkIntegrator::along(const DenseSegment& piece, std::span<const double> coefficients, double from, double to) {
    if (!any_ || !(to > from)) return 0.0;
    Evaluator<double>* const power = power_in(piece.motion());
    if (power == nullptr) return 0.0;
    const auto power_at = [&](double t) {
        set_state(*power, state_in(piece, coefficients, dof_, t));
        power->run();
        return power->output(0);
    };
    using boost::math::quadrature::gauss, boost::math::quadrature::gauss_kronrod;
    if (model_->equations().autonomous)
        return piece.degree <= 7 ? gauss<double, 7>::integrate(power_at, from, to)
                                 : gauss<double, 10>::integrate(power_at, from, to);
    // The error of the rule with 15 points is about the square of this one, that of the 7 points among them.
    constexpr double negligible = 1e-10;
    double error = 0.0, size = 0.0;
    const double work = gauss_kronrod<double, 15>::integrate(power_at, from, to, 0, 0.0, &error, &size);
    return error <= negligible * size ? work : gauss<double, 30>::integrate(power_at, from, to);
}

// The program of the power in a mode; null if the power is always 0.
Evaluator<double>* WorkIntegrator::power_in(Mode mode) {
    auto known = powers_.find(mode);
    if (known == powers_.end()) {
        const Program& program = model_->power(mode);
        const std::vector<bool> moving = program.inputs_of(1);
        known = powers_.emplace(mode, model_->evaluator(program, parameters_)).first;
        if (std::none_of(moving.begin(), moving.end(), [](bool used) { return used; }) &&
            known->second->output(0) == 0.0)
            known->second.reset();
    }
    return known->second ? &*known->second : nullptr;
}

}  // namespace achilles
