#include "sensitivity/completion_error.hpp"

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

// The outputs of a program from index `first` on.
struct OutputSlice {
    const Evaluator<double>* all = nullptr;
    std::size_t first = 0;
    double output(std::size_t i) const { return all->output(first + i); }
};

}  // namespace

AccelerationTrend CompletionError::trend(const TruncationState& cut) {
    const ContactInMode key(cut.others, cut.contact);
    auto known = trends_.find(key);
    if (known == trends_.end()) {
        const auto& program = model_->bouncing(cut.contact, cut.others).trend;
        known = trends_.try_emplace(key, model_->evaluator(program, run_.parameters)).first;
    }
    auto& terms = known->second;
    set_state(terms, cut.restart);
    terms.run();
    return {-terms.hddot(), -terms.rate(), -terms.by_sigma()};
}

State CompletionError::shift(const TruncationState& cut) {
    const double e = surfaces_.restitution(cut.contact).value, u = newton::rate_after(e, -cut.speed);
    if (e == 0.0)  // no flight follows
        return {Vector::Zero(model_->dof()), Vector::Zero(model_->dof()), 0.0};
    const BouncingModel& bouncing = model_->bouncing(cut.contact, cut.others);
    auto known = shadows_.find({cut.others, cut.contact});
    if (known == shadows_.end())
        known =
            shadows_.try_emplace({cut.others, cut.contact}, model_->evaluator(bouncing.shadow, run_.parameters)).first;
    Evaluator<double>& evaluator = known->second;
    set_state(evaluator, cut.restart);
    evaluator.input(model_->layout().sigma()) = 0.0;
    evaluator.run();
    const auto n = static_cast<std::size_t>(model_->dof());
    const ShadowTerms<OutputSlice> terms({&evaluator, bouncing.variables.size()}, n);

    const double a = trend(cut).a, I = 2.0 * u * u * u / (3.0 * a * a * (1.0 - e * e * e)), J = a * I;
    State shift{Vector::Zero(model_->dof()), Vector::Zero(model_->dof()), 0.0};
    for (std::size_t i = 0; i < n; ++i) {
        double drift = -terms.Bdot(i);
        for (std::size_t j = 0; j < n; ++j) drift += terms.dA_dq(i, j) * terms.n(j) + terms.dA_ds(i, j) * terms.B(j);
        const auto k = static_cast<Eigen::Index>(i);
        shift.q[k] = (terms.B(i) - terms.ndot(i)) * I;
        shift.v[k] = drift * I + terms.D(i) * J;
    }
    return shift;
}

CompletionError::AccumulationEstimate CompletionError::accumulation_time(const TruncationState& cut) {
    const double e = surfaces_.restitution(cut.contact).value, u = newton::rate_after(e, -cut.speed);
    if (u == 0.0) return {0.0, 0.0};
    const AccelerationTrend at_cut = trend(cut);
    AccumulationEstimate estimate{estimated_accumulation_time(at_cut, e, cut.speed), 0.0};
    auto flight = flights_.find(cut.others);
    if (flight == flights_.end()) flight = flights_.try_emplace(cut.others, *model_, cut.others, run_.parameters).first;
    MotionSeries& series = flight->second;

    const auto n = static_cast<std::size_t>(model_->dof());
    State state = cut.restart;
    state.v += u * surfaces_.of(cut.contact, cut.others).at(state).impulse_direction;
    constexpr int order = 12;  // so low a flight is nearly a parabola
    series.expand(state, order);
    const std::size_t gap = 2 * n + cut.contact;
    double span = 2.0 * u / at_cut.a;
    for (int round = 0; round < 6; ++round) {  // Newton's method for h/t = u + h_2 t + ...
        double value = 0.0, slope = 0.0;
        for (int k = order; k >= 2; --k) {
            slope = slope * span + value;
            value = value * span + series.coefficient(k, gap);
        }
        slope = slope * span + value;
        span -= (u + value * span) / slope;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        state.q[k] = series.sum(0, order, i, span);
        state.v[k] = series.sum(0, order, n + i, span);
    }
    state.t += span;
    const Contact landed = surfaces_.of(cut.contact, cut.others).at(state);
    state.v = impact(landed, state.v, 0.0);
    const double speed = -landed.hdot, speed_ratio = speed / cut.speed;
    const AccelerationTrend next = trend({cut.contact, cut.others, state, speed});
    const double error = (span + estimated_accumulation_time(next, e, speed) - estimate.formula) /
                         (1.0 - speed_ratio * speed_ratio * speed_ratio);
    if (std::isfinite(error) && speed_ratio < 1.0) estimate.error = error;
    return estimate;
}

}  // namespace achilles
