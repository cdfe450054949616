#include "enclose/completion.hpp"

#include <algorithm>
#include <cmath>

#include "certify/truncation.hpp"
#include "number/jet.hpp"

namespace achilles {

namespace {

// A program with the intervals of the parameters, or with their midpoints.
template <class Scalar>
Evaluator<Scalar> with_parameters(const Program& program, const Layout& layout, const Intervals& parameters) {
    Evaluator<Scalar> result(program);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        if constexpr (std::is_same_v<Scalar, double>)
            result.input(layout.parameter(i)) = mid(parameters[i]);
        else
            result.input(layout.parameter(i)) = parameters[i];
    }
    result.fix();
    return result;
}

}  // namespace

// The box X in q, s and t, and sigma in [-w, w].
struct Completion::Box {
    Intervals q0, s0;
    std::vector<double> q_radius, s_radius;
    Interval t0, w;
    double duration = 0.0;
    Interval a_min, a_max, r, T;
    AccelerationTrend trend;
};

Completion::Completion(const Model& model, const Coordinates& coordinates, std::size_t contact, Mode mode,
                       ContactSet unpressed)
    : z_(coordinates), layout_(model.layout()), unpressed_(unpressed), u_(coordinates.u(contact)) {
    const BouncingModel& bouncing = model.bouncing(contact, mode);
    hddot_ = {Range(with_parameters<Interval>(bouncing.hddot, layout_, z_.parameters),
                    with_parameters<Interval>(bouncing.shadow, layout_, z_.parameters), bouncing.variables),
              z_.dof};
    trend_ = {with_parameters<double>(bouncing.trend, layout_, z_.parameters), z_.dof};
    rates_ = {with_parameters<double>(bouncing.rates, layout_, z_.parameters), z_.dof};
    if (model.contacts() == 1) return;
    other_contact_terms_ = &model.other_contact_terms(contact, mode);
    other_contact_program_ = with_parameters<Interval>(other_contact_terms_->program, layout_, z_.parameters);
    other_contact_variables_ = bouncing.variables;
}

// Evaluates other_contact_program_ over a box of the variables of BouncingModel.
void Completion::evaluate_other_contacts(const Intervals& box) {
    for (std::size_t i = 0; i < box.size(); ++i) other_contact_program_.input(other_contact_variables_[i]) = box[i];
    other_contact_program_.run();
}

// A kappa that is 0 only within rounding is not accepted as a proof.
bool Completion::other_contacts_stay(const Intervals& box) {
    if (other_contact_terms_ == nullptr) return true;
    evaluate_other_contacts(box);
    const auto others = bounds_on_other_contacts(*other_contact_terms_, other_contact_program_, unpressed_);
    return others && !others->rounded_zero;
}

std::map<std::size_t, Interval> Completion::passed_on(const Doubleton& set) {
    Intervals box;
    for (std::size_t i = 0; i < 2 * z_.dof; ++i) box.push_back(set.hull(z_.q(i)));
    const double w = mag(set.hull(u_));
    box.emplace_back(-w, w);
    if (!z_.autonomous) box.push_back(set.hull(Coordinates::t()));
    evaluate_other_contacts(box);
    std::map<std::size_t, Interval> result;
    for (std::size_t i = 0; i < other_contact_terms_->held.size(); ++i)
        result[other_contact_terms_->held[i]] = transmission(*other_contact_terms_, other_contact_program_, i);
    return result;
}

Intervals Completion::variables(const Box& box) const {
    Intervals result;
    for (std::size_t i = 0; i < z_.dof; ++i) result.push_back(widened(box.q0[i], box.q_radius[i]));
    for (std::size_t i = 0; i < z_.dof; ++i) result.push_back(widened(box.s0[i], box.s_radius[i]));
    result.emplace_back(-box.w.hi(), box.w.hi());
    if (!z_.autonomous) result.emplace_back(box.t0.lo(), (Interval(box.t0.hi()) + Interval(box.duration)).hi());
    return result;
}

// Whether all motions are proved to stay inside X until T. If not, X grows to the required size.
bool Completion::contain(Box& box, const Interval& e) {
    const Intervals all = variables(box);
    const Interval sigma = all[2 * z_.dof], h = square(e * Interval(box.w.hi())) / (Interval(2.0) * box.a_min);
    bool inside = z_.autonomous || box.T.hi() < box.duration;
    if (!inside) box.duration = inflated(box.T.hi());
    for (std::size_t i = 0; i < z_.dof; ++i) {
        const Interval &A = hddot_.A(i), &n = hddot_.n(i), &B = hddot_.B(i), &D = hddot_.D(i);
        const double q = (abs(all[z_.dof + i] + n * sigma) * box.T + abs(n) * h).hi();
        const double s = (abs(A + B * sigma + D * square(sigma)) * box.T + abs(B) * h).hi();
        if (!std::isfinite(q) || !std::isfinite(s)) {
            inside = false;
            box.q_radius[i] = rounding::infinity;
            continue;
        }
        const double comparison = std::max(s, (abs(A) * box.T).hi());
        if (!(q < box.q_radius[i])) inside = false, box.q_radius[i] = inflated(q);
        if (!(comparison < box.s_radius[i])) inside = false, box.s_radius[i] = inflated(comparison);
    }
    return inside;
}

// The accumulation time as a function of the state at the collision: by the attained bounds A w, and to third order.
void Completion::bound_time(CompletionProof& proof, const Box& box, const Doubleton& set, const Interval& e) {
    const Interval one(1.0), two(2.0), c_w = -Interval(set.center(u_));
    const AccumulationTime per_speed = accumulation_time_bounds(e, box.a_min, box.a_max, one);
    const Interval A(per_speed.earliest.lo(), per_speed.latest.hi()), middle(mid(A));
    Intervals row(z_.size());
    row[Coordinates::t()] = one;
    const auto time_of = [&](const Interval& at_center, const Interval& by_u) {
        row[u_] = by_u;
        return Interval(set.center(Coordinates::t())) + at_center + set.along(row.data());
    };
    proof.by_u = -middle;
    proof.at_center = middle * c_w + (A - middle) * box.w;
    proof.half = rad((A - middle) * Interval(box.w.hi()));
    proof.time = time_of(proof.at_center, proof.by_u);
    proof.own = rad(time_of(Interval(0.0), proof.by_u));
    proof.accumulation_time = A * box.w;

    Intervals start = box.q0;
    start.insert(start.end(), box.s0.begin(), box.s0.end());
    start.emplace_back(0.0);
    if (!z_.autonomous) start.push_back(box.t0);
    const AccelerationBounds drift{-hddot_.over_part(start), -hddot_.slope(2 * z_.dof), -hddot_.P(), -hddot_.Phi(),
                                   -hddot_.Xi()};
    const Interval off =
        third_order_error(box.trend, drift, e, box.a_min, box.a_max, Interval(box.w.hi()), Interval(box.T.hi()));
    const Interval C1 = two * e / (Interval(box.trend.a) * (one - e));
    const Interval C2 =
        -square(C1) * (two * Interval(box.trend.b) / Interval(box.trend.a) + Interval(box.trend.c)) / Interval(6.0);
    if (!off.is_defined() || !C2.is_defined() || !std::isfinite(off.hi())) return;
    const Interval m1(mid(C1)), m2(mid(C2));
    const Interval open = (C1 - m1) * box.w + (C2 - m2) * square(box.w) + Interval(-off.hi(), off.hi());
    const Interval at_center = m1 * c_w + m2 * square(c_w) + open, by_u = -(m1 + two * m2 * box.w);
    const Interval time = time_of(at_center, by_u);
    if (width(time) < width(proof.time)) {
        proof.at_center = at_center;
        proof.by_u = by_u;
        proof.half = std::min(proof.half, rad(open));
    }
    proof.time = {std::max(proof.time.lo(), time.lo()), std::min(proof.time.hi(), time.hi())};
    const Interval accumulation_time = C1 * box.w + C2 * square(box.w) + Interval(-off.hi(), off.hi());
    proof.accumulation_time = {std::max(proof.accumulation_time.lo(), accumulation_time.lo()),
                               std::min(proof.accumulation_time.hi(), accumulation_time.hi())};
}

// (E_q, E_s): the two-sided bounds on the integrals of h and of hdot^2, times their coefficients.
void Completion::bound_error(CompletionProof& proof, const Box& box, const Interval& e) {
    const Interval one(1.0), two(2.0), e3 = e * square(e), root = sqrt(box.r), r3 = box.r * root;
    const auto integral = [&](const Interval& w, const Interval& a, const Interval& ratio) {
        return two * e3 * w * square(w) / (Interval(3.0) * square(a) * (one - ratio));
    };
    const Interval I(integral(Interval(box.w.lo()), box.a_max, e3 / r3).lo(),
                     integral(Interval(box.w.hi()), box.a_min, e3 * r3).hi());
    const Interval J((box.a_min * Interval(I.lo())).lo(), (box.a_max * Interval(I.hi())).hi());
    const std::size_t n = z_.dof;
    proof.error.assign(2 * n, Interval(0.0));
    double lipschitz = 1.0, largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const Interval drift = hddot_.drift(i);
        lipschitz = std::max(lipschitz, hddot_.steepness(i).hi());
        const Interval turning = hddot_.B(i) - hddot_.ndot(i), most(I.hi());
        proof.error[i] = turning * I;
        proof.error[n + i] = drift * I + hddot_.D(i) * J;
        largest = std::max(
            {largest, (abs(turning) * most).hi(), (abs(drift) * most + box.a_max * abs(hddot_.D(i)) * most).hi()});
    }
    const Interval k = (exp(Interval(lipschitz) * box.T) - one) * Interval(largest);
    for (Interval& entry : proof.error) entry = widened(entry, k.hi());
}

std::optional<Completion::CompletionProof> Completion::prove(const Doubleton& set, const Interval& e) {
    const std::size_t n = z_.dof;
    Box box;
    for (std::size_t i = 0; i < n; ++i) {
        box.q0.push_back(set.hull(z_.q(i)));
        box.s0.push_back(set.hull(z_.v(i)));
        trend_.input(layout_.q(i)) = rates_.input(layout_.q(i)) = set.center(z_.q(i));
        trend_.input(layout_.v(i)) = rates_.input(layout_.v(i)) = set.center(z_.v(i));
    }
    box.t0 = set.hull(Coordinates::t());
    box.w = -set.hull(u_);
    trend_.clock() = rates_.clock() = set.center(Coordinates::t());
    trend_.run();
    box.trend = {-trend_.hddot(), -trend_.rate(), -trend_.by_sigma()};
    const double w = box.w.hi(), e_mid = mid(e);
    if (!(box.trend.a > 0.0) || !(e.hi() < 1.0) || !(box.w.lo() > 0.0)) return std::nullopt;
    const double T0 = 2.0 * e_mid * w / (box.trend.a * (1.0 - e_mid));
    rates_.input(layout_.sigma()) = w;
    rates_.run();
    for (std::size_t i = 0; i < n; ++i) {
        box.q_radius.push_back(inflated(1.2 * std::abs(rates_.rate(i)) * T0));
        box.s_radius.push_back(inflated(1.2 * std::abs(rates_.s_rate(i)) * T0));
    }
    box.duration = inflated(1.2 * T0);
    for (int round = 0; round < 25; ++round) {
        const Interval a = -hddot_.over(variables(box));
        if (!certainly_positive(a) || !std::isfinite(a.hi())) return std::nullopt;
        box.a_min = Interval(a.lo());
        box.a_max = Interval(a.hi());
        box.r = box.a_max / box.a_min;
        const Interval one(1.0), ratio = e * square(e) * box.r * sqrt(box.r);
        if (!certainly_less(square(e) * box.r, one) || !certainly_less(ratio, one)) return std::nullopt;
        const Interval longest(accumulation_time_bounds(e, box.a_min, box.a_max, Interval(w)).latest.hi());
        box.T = Interval((longest * Interval(1.0 + 0x1p-40)).hi());
        if (!contain(box, e)) continue;
        const Intervals all = variables(box);
        if (!other_contacts_stay(all)) return std::nullopt;
        CompletionProof proof;
        bound_time(proof, box, set, e);
        bound_error(proof, box, e);
        proof.window = longest.hi() * (1.0 + 0x1p-41);
        for (std::size_t i = 0; i < n; ++i) {
            proof.position.push_back(all[i]);
            proof.velocity.push_back(all[n + i] + hddot_.n(i) * all[2 * n]);
            if (!std::isfinite(width(proof.error[i])) || !std::isfinite(width(proof.error[n + i]))) return std::nullopt;
        }
        return proof;
    }
    return std::nullopt;
}

}  // namespace achilles
