#include "sensitivity/completion_error.hpp"

#include <algorithm>
#include <cmath>

#include "contacts/impact_law.hpp"

namespace achilles {

// ---- programs ----

AccelerationTrend CompletionError::trend(const TruncationState& cut) {
    auto known = trends_.find(cut.key);
    if (known == trends_.end())
        known = trends_.try_emplace(cut.key, model_->evaluator(model_->bouncing(cut.key).trend, run_.parameters)).first;
    auto& terms = known->second;
    set_state(terms, cut.tangential);
    terms.run();
    return {-terms.hddot(), -terms.rate(), -terms.by_sigma()};
}

ShadowTerms<OutputSlice> CompletionError::shadow_terms(const BouncingKey& key, const State& state) {
    const BouncingModel& bouncing = model_->bouncing(key);
    auto known = shadows_.find(key);
    if (known == shadows_.end())
        known = shadows_.try_emplace(key, model_->evaluator(bouncing.shadow, run_.parameters)).first;
    Evaluator<double>& evaluator = known->second;
    set_state(evaluator, state);
    evaluator.input(model_->layout().sigma()) = 0.0;
    evaluator.run();
    return {{&evaluator, bouncing.variables.size()}, static_cast<std::size_t>(model_->dof())};
}

PairTerms<Evaluator<double>>& CompletionError::sticking_terms(const BouncingKey& key, const State& state) {
    auto known = stickings_.find(key);
    if (known == stickings_.end())
        known = stickings_.try_emplace(key, model_->evaluator(model_->bouncing(key).sticking, run_.parameters)).first;
    auto& terms = known->second;
    set_state(terms, state);
    terms.input(model_->layout().sigma()) = terms.input(model_->layout().second_sigma()) = 0.0;
    terms.run();
    return terms;
}

// The direction n, n_sigma or n_N in which hdot is part of v, at (q, s).
Vector CompletionError::direction(const BouncingKey& key, const State& state) {
    Vector n(model_->dof());
    if (sticks_at_impacts(*model_, key)) {
        const auto& terms = sticking_terms(key, state);
        for (Eigen::Index i = 0; i < n.size(); ++i) n[i] = terms.N(0, static_cast<std::size_t>(i));
    } else if (slip_sign(key.state) != 0) {
        const auto terms = shadow_terms(key, state);
        for (Eigen::Index i = 0; i < n.size(); ++i) n[i] = terms.n(static_cast<std::size_t>(i));
    } else {
        return surfaces_.of(key.contact, key.mode).at(state).impulse_direction;
    }
    return n;
}

// v := s. If friction depends on the slip, n_sigma is that at s, which is found by fixed-point iteration.
void CompletionError::take_out_rates(const BouncingKey& key, State& state) {
    const Contact at = surfaces_.of(key.contact, key.mode).at(state);
    if (sticks_at_impacts(*model_, key)) {
        const double u = slip_at(key.contact, state);
        const auto& terms = sticking_terms(key, state);
        for (Eigen::Index i = 0; i < state.v.size(); ++i) {
            const auto k = static_cast<std::size_t>(i);
            state.v[i] -= terms.N(0, k) * at.hdot + terms.N(1, k) * u;
        }
    } else if (slip_sign(key.state) != 0) {
        const Vector v = state.v;
        for (int round = 0; round < 5; ++round) state.v = v - at.hdot * direction(key, state);
    } else {
        state.v = impact(at, state.v, 0.0);
    }
}

double CompletionError::slip_at(std::size_t contact, const State& state) { return surfaces_.slip(contact, state).u; }

// ---- bouncing after the cut ----

CompletionError::Bounce CompletionError::bounce(const TruncationState& cut) {
    const std::size_t contact = cut.key.contact;
    const double u = newton::rate_after(surfaces_.restitution(contact).value, -cut.speed);
    auto flight = flights_.find(cut.key.mode);
    if (flight == flights_.end())
        flight = flights_.try_emplace(cut.key.mode, *model_, cut.key.mode, run_.parameters).first;
    MotionSeries& series = flight->second;

    const auto n = static_cast<std::size_t>(model_->dof());
    State state = cut.tangential;
    state.v += u * direction(cut.key, state);
    constexpr int order = 12;  // so low a flight is nearly a parabola
    series.expand(state, order);
    const std::size_t gap = 2 * n + contact;
    double span = 2.0 * u / trend(cut).a;
    for (int round = 0; round < 6; ++round) {  // Newton's method for h/t = u + h_2 t + ...
        double value = 0.0, slope = 0.0;
        for (int k = order; k >= 2; --k) {
            slope = slope * span + value;
            value = value * span + series.coefficient(k, gap);
        }
        slope = slope * span + value;
        span -= (u + value * span) / slope;
    }
    const auto after = [&](double time) {
        State at{Vector(model_->dof()), Vector(model_->dof()), cut.tangential.t + time};
        for (std::size_t i = 0; i < n; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            at.q[k] = series.sum(0, order, i, time);
            at.v[k] = series.sum(0, order, n + i, time);
        }
        return at;
    };
    double slip_integral = 0.0;
    if (sticks_at_impacts(*model_, cut.key)) {  // by Gauss's rule of degree 5
        const double middle = 0.5 * span, off = std::sqrt(0.6) * middle;
        slip_integral = span / 18.0 *
                        (5.0 * (slip_at(contact, after(middle - off)) + slip_at(contact, after(middle + off))) +
                         8.0 * slip_at(contact, after(middle)));
    }
    state = after(span);
    const double speed = -surfaces_.of(contact, cut.key.mode).at(state).hdot;
    take_out_rates(cut.key, state);
    return {span, slip_integral, {cut.key, std::move(state), speed}};
}

// The estimates of the accumulation time and, if the contact sticks, of the integral of its slip.
double CompletionError::time_after(const TruncationState& cut) {
    const double e = surfaces_.restitution(cut.key.contact).value;
    const AccelerationTrend at = trend(cut);
    const double time = estimated_accumulation_time(at, e, cut.speed);
    if (!sticks_at_impacts(*model_, cut.key)) return time;
    const double alpha = sticking_terms(cut.key, cut.tangential).hddot(1), c_u = -trends_.at(cut.key).by_slip();
    return time + estimated_delay_by_slip(at.a, alpha, c_u, e, cut.speed);
}

double CompletionError::slip_after(const TruncationState& cut) {
    const auto& terms = sticking_terms(cut.key, cut.tangential);
    return estimated_slip_integral(-terms.hddot(0), terms.hddot(1), surfaces_.restitution(cut.key.contact).value,
                                   cut.speed);
}

// ---- errors ----

State CompletionError::shift(const TruncationState& cut) {
    const double e = surfaces_.restitution(cut.key.contact).value, u = newton::rate_after(e, -cut.speed);
    State shift{Vector::Zero(model_->dof()), Vector::Zero(model_->dof()), 0.0};
    if (e == 0.0) return shift;  // no flight follows
    if (sticks_at_impacts(*model_, cut.key)) return shift_of_sticking(cut);
    const ShadowTerms<OutputSlice> terms = shadow_terms(cut.key, cut.tangential);
    const auto n = static_cast<std::size_t>(model_->dof());
    const double a = trend(cut).a, I = 2.0 * u * u * u / (3.0 * a * a * (1.0 - e * e * e)), J = a * I;
    for (std::size_t i = 0; i < n; ++i) {
        double drift = -terms.Bdot(i);
        for (std::size_t j = 0; j < n; ++j) drift += terms.dA_dq(i, j) * terms.n(j) + terms.dA_ds(i, j) * terms.B(j);
        const auto k = static_cast<Eigen::Index>(i);
        shift.q[k] = (terms.B(i) - terms.ndot(i)) * I;
        shift.v[k] = drift * I + terms.D(i) * J;
    }
    return shift;
}

// The same for a contact that sticks (theory-friction.md 4.2). Its impacts start flights of the lengths T, e T, ...,
// along which u = alpha t. I is the integral of h and J that of the slip that is still to come:
//     J = alpha T^3 ((1/(1 - e^2) - 1/(1 - e^3))/(2 (1 - e)) + 1/(3 (1 - e^3)))
//     int hdot^2 = a I,   int hdot u = -alpha I,   int u^2 = 4 alpha^2 I/a
// The error of I_u follows from one more bounce, as that of the accumulation time does.
State CompletionError::shift_of_sticking(const TruncationState& cut) {
    const Bounce flight = bounce(cut);
    const double ratio = flight.next.speed / cut.speed;
    const double left_out =
        (flight.slip_integral + slip_after(flight.next) - slip_after(cut)) / (1.0 - ratio * ratio * ratio);
    const auto& terms = sticking_terms(cut.key, cut.tangential);
    const double e = surfaces_.restitution(cut.key.contact).value, u = newton::rate_after(e, -cut.speed),
                 e3 = 1.0 - e * e * e;
    const double a = -terms.hddot(0), alpha = terms.hddot(1), T = 2.0 * u / a;
    const double I = 2.0 * u * u * u / (3.0 * a * a * e3),
                 J = alpha * T * T * T * ((1.0 / (1.0 - e * e) - 1.0 / e3) / (2.0 * (1.0 - e)) + 1.0 / (3.0 * e3));
    const auto n = static_cast<std::size_t>(model_->dof());
    State shift{Vector::Zero(model_->dof()), Vector::Zero(model_->dof()), 0.0};
    for (std::size_t i = 0; i < n; ++i) {
        double drift_N = -terms.Bdot(0, i), drift_T = -terms.Bdot(1, i);
        for (std::size_t j = 0; j < n; ++j) {
            drift_N += terms.dA_dq(i, j) * terms.N(0, j) + terms.dA_ds(i, j) * terms.B(0, j);
            drift_T += terms.dA_dq(i, j) * terms.N(1, j) + terms.dA_ds(i, j) * terms.B(1, j);
        }
        const auto k = static_cast<Eigen::Index>(i);
        shift.q[k] =
            terms.N(1, i) * left_out + (terms.B(0, i) - terms.Ndot(0, i)) * I - (terms.B(1, i) - terms.Ndot(1, i)) * J;
        shift.v[k] = terms.B(1, i) * left_out + drift_N * I - drift_T * J +
                     (terms.D(0, i) * a - terms.D(1, i) * alpha + terms.D(2, i) * 4.0 * alpha * alpha / a) * I;
    }
    return shift;
}

CompletionError::AccumulationEstimate CompletionError::accumulation_time(const TruncationState& cut) {
    if (surfaces_.restitution(cut.key.contact).value * cut.speed == 0.0) return {0.0, 0.0};
    AccumulationEstimate estimate{time_after(cut), 0.0};
    const Bounce flight = bounce(cut);
    const double ratio = flight.next.speed / cut.speed;
    const double error = (flight.span + time_after(flight.next) - estimate.formula) / (1.0 - ratio * ratio * ratio);
    if (std::isfinite(error) && ratio < 1.0) estimate.error = error;
    return estimate;
}

}  // namespace achilles
