#include "certify/sticking.hpp"

#include <algorithm>
#include <cmath>

namespace achilles {

// Bounds over X, in the notation of the header.
struct StickingConditions::Bounds {
    Interval a, alpha, a_min, a_max, r;
    AccumulationTime accumulation_time;
    Interval T, height;  // the accumulation time at most, h_m
    Interval S_2, U_m, I_u;
    Interval x;
    double half_width() const {
        return (Interval(0.5) * (Interval(accumulation_time.latest.hi()) - Interval(accumulation_time.earliest.lo())))
            .hi();
    }
};

StickingConditions::StickingConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key,
                                       ContactSet unpressed, const FloatEnvironmentGuard& ground)
    : TruncationConditions(model, run, e, key, unpressed, ground),
      never_slides_(model.equations().friction.at(key.contact).never_slides),
      holds_others_(!key.mode.is_free()),
      beside_slip_(!key.mode.slipping().within(key.mode.held()).empty()),
      second_sigma_(model.layout().second_sigma()),
      speed_(model.layout().sliding_speed()),
      terms_(model.evaluator<Interval>(model.bouncing(key).sticking, run.parameters)),
      point_(model.evaluator(model.bouncing(key).sticking, run.parameters)),
      slip_(model.evaluator<Interval>(model.slip_terms(key.contact, key.mode), run.parameters)),
      box_(dof_),
      variables_(model.bouncing(key).variables.size()),
      need_q_(dof_),
      need_s_(dof_) {
    truncation_.conditions = Conditions::sharp;
    truncation_.reinitialization = Reinitialization::kinetic;
}

// The terms in double at the collision, with hdot = u = 0.
void StickingConditions::evaluate_point(const Collision& collision) {
    set_state(point_, collision.with(collision.tangential));
    point_.input(sigma_) = point_.input(second_sigma_) = 0.0;
    point_.run();
}

// The restitution of the impacts to leading order, after evaluate_point().
double StickingConditions::restitution_at_point(const Collision& collision) const {
    if (!collision.is_capped) return mid(e_);
    const double x = -2.0 * point_.hddot(1) / point_.hddot(0);
    const double squared = 1.0 + x * (2.0 * point_.W(0, 1) + point_.W(0, 0) * x) / point_.W(1, 1);
    return squared > 0.0 ? std::min(std::sqrt(squared), mid(e_)) : 0.0;
}

// I_u to leading order, after evaluate_point().
double StickingConditions::slip_integral(const Collision& collision) const {
    return estimated_slip_integral(-point_.hddot(0), point_.hddot(1), restitution_at_point(collision), collision.speed);
}

// The energy that an impact with u = x w loses, times 2 det/w^2, after terms_ has run.
Interval StickingConditions::energy_loss(const Interval& x) const {
    const Interval one(1.0), W_NN = terms_.W(0, 0), W_NT = terms_.W(0, 1), W_TT = terms_.W(1, 1), W_TN = terms_.W_10();
    if (!beside_slip_) return (one - square(e_)) * W_TT + Interval(2.0) * x * W_NT + square(x) * W_NN;
    return (one - square(e_)) * W_TT + x * ((one - e_) * W_NT + (one + e_) * W_TN) + square(x) * W_NN;
}

// The restitution with which it loses none; undefined if it is not proved to gain energy with e.
Interval StickingConditions::capped_restitution(const Interval& x) const {
    if (beside_slip_ || !certainly_negative(energy_loss(x))) return Interval::undefined();
    const Interval squared = Interval(1.0) + x * (Interval(2.0) * terms_.W(0, 1) + terms_.W(0, 0) * x) / terms_.W(1, 1);
    return certainly_positive(squared) ? sqrt(squared) : Interval::undefined();
}

State StickingConditions::restart_at(const Collision& collision) {
    evaluate_point(collision);
    const double I_u = slip_integral(collision);
    State state = collision.with(collision.tangential);
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        state.q[k] += point_.N(1, i) * I_u;
        state.v[k] += point_.B(1, i) * I_u;
    }
    return state;
}

// Predicts, in double, whether a proof would fail: by the height and the drift of the next flights, to leading order.
bool StickingConditions::fails_at_point(const Collision& collision) {
    if (fails_by_speed(collision.speed)) return true;
    evaluate_point(collision);
    const double a = -point_.hddot(0), e = restitution_at_point(collision), w = collision.speed;
    if (!(a > 0.0) || !(e < 1.0)) return true;
    const double drift = std::abs(slip_integral(collision)), height = e * w * e * w / (2.0 * a);
    double uniform = 0.0;
    for (std::size_t i = 0; i < dof_; ++i) {
        const double off = std::abs(point_.N(0, i)) * height + std::abs(point_.N(1, i)) * drift;
        uniform += off * off;
    }
    return std::sqrt(uniform) > truncation_.eps_q;
}

// The collision as intervals. False if its slip is not enclosed.
bool StickingConditions::begin_box(const Collision& collision) {
    constexpr double few = 4.0;
    if (!autonomous_) box_.t0 = instant_of(collision, contact_);
    set_state(contact_, collision.before);
    if (!autonomous_) contact_.clock() = box_.t0;
    contact_.run();
    box_.w = abs(contact_.hdot());
    set_state(slip_, collision.before);
    if (!autonomous_) slip_.clock() = box_.t0;
    slip_.input(speed_) = Interval(0.0);
    slip_.run();
    box_.u = slip_.u();
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double v = std::abs(collision.before.v[k]), s = collision.tangential[k];
        box_.q0[i] = rounding_interval(collision.before.q[k], std::abs(collision.before.q[k]));
        box_.s0[i] = rounding_interval(s, few * (v + std::abs(s)));
        variables_[i] = box_.q0[i];
        variables_[dof_ + i] = box_.s0[i];
        box_.d_q[i] = mag(Interval(collision.position[k]) - box_.q0[i]);
        box_.d_s[i] = mag(Interval(collision.restart[k]) - box_.s0[i]);
    }
    variables_[2 * dof_] = variables_[2 * dof_ + 1] = Interval(0.0);
    if (!autonomous_) variables_.back() = box_.t0;
    set_box(terms_, variables_);
    terms_.run();
    for (std::size_t i = 0; i < dof_; ++i) {
        box_.n_T[i] = terms_.N(1, i);
        box_.C[i] = terms_.B(1, i);
    }
    // Radii near those that contain() will require; any may be tried.
    const Interval a = -terms_.hddot(0), alpha = terms_.hddot(1);
    if (!certainly_positive(a) || !certainly_less(e_, Interval(1.0))) return false;
    const Interval two(2.0), one(1.0), e = collision.is_capped ? Interval(restitution_at_point(collision)) : e_,
                                       T = two * e * box_.w / (a * (one - e));
    box_.duration = inflated(T.hi());
    box_.slip = inflated((abs(alpha) * two * e * box_.w / a).hi());
    for (std::size_t i = 0; i < dof_; ++i) {
        const Interval slip(box_.slip);
        box_.q_radius[i] = inflated(
            ((abs(box_.s0[i]) + abs(terms_.N(0, i)) * box_.w + abs(box_.n_T[i]) * slip) * T).hi() + box_.d_q[i]);
        box_.s_radius[i] = inflated(
            ((abs(terms_.A(i)) + abs(terms_.B(0, i)) * box_.w + abs(box_.C[i]) * slip) * T).hi() + box_.d_s[i]);
    }
    return box_.u.is_defined();
}

std::optional<StickingConditions::Bounds> StickingConditions::bounds_over_box(const Collision& collision) {
    box_.put_into(variables_);
    variables_[2 * dof_] = Interval(-box_.w.hi(), box_.w.hi());
    variables_[2 * dof_ + 1] = Interval(-box_.slip, box_.slip);
    if (!autonomous_) variables_.back() = box_.time();
    set_box(terms_, variables_);
    terms_.run();
    const Interval one(1.0), two(2.0), half(0.5), four(4.0);
    Bounds b;
    b.a = -terms_.hddot(0);
    b.alpha = terms_.hddot(1);
    if (!certainly_positive(b.a) || !b.alpha.is_defined()) return std::nullopt;
    b.a_min = Interval(b.a.lo());
    b.a_max = Interval(b.a.hi());
    b.r = b.a_max / b.a_min;
    b.x = b.alpha * Interval((two / b.a_max).lo(), (two / b.a_min).hi());
    const Interval e = box_.e = collision.is_capped ? capped_restitution(hull(b.x, box_.u / box_.w)) : e_,
                   e2 = square(e);
    if (!certainly_less(e2 * b.r, one)) return std::nullopt;
    b.accumulation_time = accumulation_time_bounds(e, b.a_min, b.a_max, box_.w);
    b.T = Interval(b.accumulation_time.latest.hi());
    const Interval u2 = square(e * box_.w);
    b.height = u2 / (two * b.a_min);
    const Interval least = four * u2 / (square(b.a_max) * (one - e2 / b.r)),
                   most = four * u2 / (square(b.a_min) * (one - e2 * b.r));
    b.S_2 = Interval(least.lo(), most.hi());
    b.U_m = half * abs(b.alpha) * Interval(most.hi());
    b.I_u = half * b.alpha * b.S_2;
    return b;
}

// Whether X is proved to contain the motion until tau_inf, the shifted variables and the motion in contact.
bool StickingConditions::contain(const Bounds& b) {
    bool inside = autonomous_ || b.T.hi() < box_.duration;
    if (!inside) box_.duration = inflated(b.T.hi());
    inside = fits((abs(b.alpha) * Interval(2.0) * box_.e * box_.w / b.a_min).hi(), box_.slip) && inside;
    const Interval &sigma = variables_[2 * dof_], &u = variables_[2 * dof_ + 1];
    find_change(variables_);
    for (std::size_t i = 0; i < dof_; ++i) {
        const Interval rate = variables_[dof_ + i] + terms_.N(0, i) * sigma + terms_.N(1, i) * u;
        const Interval F = terms_.A(i) + terms_.B(0, i) * sigma + terms_.B(1, i) * u + terms_.D(0, i) * square(sigma) +
                           terms_.D(1, i) * sigma * u + terms_.D(2, i) * square(u);
        need_q_[i] = (abs(rate) * b.T).hi();
        need_s_[i] = (abs(F) * b.T).hi();
        const double shift_q = (abs(terms_.N(0, i)) * b.height + abs(terms_.N(1, i)) * b.U_m).hi(),
                     shift_s = (abs(terms_.B(0, i)) * b.height + abs(terms_.B(1, i)) * b.U_m).hi();
        inside = fits(need_q_[i] + std::max(shift_q, box_.d_q[i]), box_.q_radius[i]) && inside;
        const double change = (change_[i] * b.T).hi();
        inside = fits(need_s_[i] + std::max(shift_s, box_.d_s[i]) + change, box_.s_radius[i]) && inside;
    }
    return inside;
}

// What is proved: the impact at the cut and all later ones stick without a gain of energy, and the contact at rest
// sticks or slides.
Certificate::Tail StickingConditions::tail_over_box(const Collision& collision, const Bounds& b) {
    const Interval one(1.0), e = box_.e, W_NN = terms_.W(0, 0), W_NT = terms_.W(0, 1), W_TT = terms_.W(1, 1),
                             W_TN = terms_.W_10();
    if (!certainly_positive(W_NN) ||
        !certainly_positive(beside_slip_ ? W_NN * W_TT - W_NT * W_TN : W_NN * W_TT - square(W_NT)))
        return Certificate::Tail::none;
    for (std::size_t i = 0; i < 2 * dof_; ++i) slip_.input(i) = variables_[i];
    if (!autonomous_) slip_.clock() = variables_.back();
    // Whether an impact at these rates sticks: the impulses times det are inside the cone.
    const auto sticks = [&](const Interval& w, const Interval& u) {
        slip_.input(speed_) = Interval(0.0, (e * abs(u) / (one + e)).hi());
        slip_.run();
        const Interval p = (one + e) * w * W_TT + u * W_NT, p_T = (one + e) * w * W_TN + u * W_NN;
        return certainly_positive(never_slides_ ? p : slip_.coefficient() * p - abs(p_T));
    };
    if (!sticks(box_.w, box_.u)) return Certificate::Tail::none;
    // Later impacts: u = x w' with w' <= w. The cone scales with w', the speed in mu is at most that of w.
    if (!sticks(Interval(box_.w.hi()), b.x * Interval(box_.w.hi()))) return Certificate::Tail::none;
    if (!collision.is_capped && !(energy_loss(b.x).lo() >= 0.0)) return Certificate::Tail::none;
    const Interval lambda = W_NT * b.alpha + W_TT * b.a, tau = W_TN * b.a + W_NN * b.alpha;  // times det
    if (!certainly_positive(lambda)) return Certificate::Tail::none;
    const Interval room = slip_.static_coefficient() * lambda - abs(tau);
    if (never_slides_ || certainly_positive(room)) return Certificate::Tail::stick;
    return certainly_negative(room) ? Certificate::Tail::stick_then_slip : Certificate::Tail::none;
}

bool StickingConditions::prove_others_stay(const Bounds& b, std::optional<Certificate::OtherContactBounds>& others) {
    if (!holds_others_) return prove_other_contacts_stay(variables_, others);
    const Interval x = hull(b.x, box_.u / box_.w), once = Interval(1.0) + box_.e;
    const Interval ratio =
        -((once * terms_.W_10() + x * terms_.W(0, 0)) / (once * terms_.W(1, 1) + x * terms_.W(0, 1)));
    Interval& slip = variables_[2 * dof_ + 1];
    slip = hull(slip, box_.u);
    return prove_other_contacts_stay(variables_, others, box_.e, ratio);
}

std::optional<Certificate> StickingConditions::prove(const Collision& collision) {
    obstacle_.reset();
    if (!begin_box(collision)) return std::nullopt;
    for (int round = 0; round < 25; ++round) {
        const auto bounds = bounds_over_box(collision);
        if (!bounds) return std::nullopt;
        if (!contain(*bounds)) continue;
        std::optional<Certificate::OtherContactBounds> others;
        const Certificate::Tail tail = tail_over_box(collision, *bounds);
        if (tail == Certificate::Tail::none || !prove_others_stay(*bounds, others)) return std::nullopt;
        auto certificate = certificate_of(collision, *bounds);
        if (!certificate) return std::nullopt;
        certificate->tail = tail;
        certificate->others = std::move(others);
        return certificate;
    }
    return std::nullopt;
}

std::optional<Certificate> StickingConditions::certificate_of(const Collision& collision, const Bounds& b) {
    const PairTerms<Evaluator<Interval>>& x = terms_;
    const Interval one(1.0), two(2.0), three(3.0), w = box_.w, e_k = box_.e, e2 = e_k * sqrt(b.r),
                                                   e3 = one - e2 * square(e2);
    const Interval I_h = two * e_k * square(e_k) * w * square(w) / (three * square(b.a_min) * e3);
    const Interval first = two * e_k * w / b.a_min;  // the first flight at most
    const Interval speeds = b.a_max * I_h;           // the integrals of hdot^2, u^2 and |hdot u|
    const Interval slips = square(abs(b.alpha)) / three * first * square(first) / e3;
    const Interval products = sqrt(max(speeds * slips, Interval(0.0)));
    double lipschitz = 1.0, largest = 0.0;
    std::vector<Interval> E_q(dof_), E_s(dof_), uniform(dof_);
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        Interval row(0.0), drift_N = -x.Bdot(0, i), drift_T = -x.Bdot(1, i);
        for (std::size_t j = 0; j < dof_; ++j) {
            drift_N = drift_N + x.dA_dq(i, j) * x.N(0, j) + x.dA_ds(i, j) * x.B(0, j);
            drift_T = drift_T + x.dA_dq(i, j) * x.N(1, j) + x.dA_ds(i, j) * x.B(1, j);
            row = row + abs(x.dA_dq(i, j)) + abs(x.dA_ds(i, j));
        }
        const Interval c_q = abs(x.B(0, i) - x.Ndot(0, i)) * I_h + abs(x.B(1, i) - x.Ndot(1, i)) * b.U_m * b.T +
                             abs(box_.q0[i] + box_.n_T[i] * b.I_u - Interval(collision.position[k]));
        const Interval c_s = abs(drift_N) * I_h + abs(drift_T) * b.U_m * b.T + abs(x.D(0, i)) * speeds +
                             abs(x.D(1, i)) * products + abs(x.D(2, i)) * slips +
                             abs(box_.s0[i] + box_.C[i] * b.I_u - Interval(collision.restart[k]));
        lipschitz = std::max(lipschitz, row.hi());
        largest = std::max({largest, c_q.hi(), c_s.hi()});
        E_q[i] = Interval(c_q.hi());
        E_s[i] = Interval(c_s.hi());
        if (!row.is_defined() || !c_q.is_defined() || !c_s.is_defined()) return std::nullopt;
    }
    const AccelerationTrend trend = trend_at(collision);
    const double e = restitution_at_point(collision);
    Certificate c =
        certificate_at(collision.before.t, b.accumulation_time,
                       estimated_accumulation_time(trend, e, collision.speed) +
                           estimated_delay_by_slip(trend.a, point_.hddot(1), -trend_.by_slip(), e, collision.speed));
    const Interval growth = exp(Interval(lipschitz) * b.T), grown = (growth - one) * Interval(largest);
    Interval position(0.0), velocity(0.0);
    for (std::size_t i = 0; i < dof_; ++i) {
        const Interval late = late_change(i, c, growth);
        E_q[i] = E_q[i] + grown + late * b.T;
        E_s[i] = E_s[i] + grown + late;
        uniform[i] = E_q[i] + abs(x.N(0, i)) * b.height + abs(x.N(1, i)) * b.U_m;
        position = position + square(Interval(need_q_[i]) + Interval(box_.d_q[i]));
        velocity = velocity + square(Interval(need_s_[i]) + Interval(box_.d_s[i]));
    }
    c.position_bound = sqrt(position).hi();
    c.velocity_bound = sqrt(velocity).hi();
    c.shadowing_position = norm(E_q).hi();
    c.shadowing_velocity = norm(E_s).hi();
    c.uniform_position = norm(uniform).hi();
    c.a_min = b.a_min.lo();
    c.a_max = b.a_max.hi();
    decide(c, b.half_width());
    c.assumptions = {{"e^2 a_max/a_min", (square(e_k) * b.r).hi(), 1.0}, {"normal acceleration", -c.a_min, 0.0}};
    return c;
}

std::optional<Certificate> StickingConditions::do_certify(const Collision& collision, CertificateScope) {
    auto certificate = prove(collision);
    if (!certificate) return std::nullopt;
    const Certificate::Decision& decision = *certificate->decision;
    // The width of the time interval and the uniform bound fall with the square of the speed.
    const double square = std::max(decision.position.ratio(), decision.time.ratio()), cubic = decision.velocity.ratio();
    if (square <= 1.0 && cubic <= 1.0) return certificate;
    earlier_.remember(collision.speed, std::max(square, cubic), square > cubic ? 2 : 3);
    return std::nullopt;
}

}  // namespace achilles
