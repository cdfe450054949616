#include "certify/sharp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

// max |x| times a nonnegative factor, rounded up; infinity if there is no bound.
double times(const Interval& x, const Interval& factor) {
    const double product = (Interval(mag(x)) * factor).hi();
    return product <= std::numeric_limits<double>::max() ? product : std::numeric_limits<double>::infinity();
}

// Whether all inequalities that decide the truncation hold. The decision must be known.
bool holds(const Certificate& certificate) {
    const Certificate::Decision& decision = *certificate.decision;
    return decision.time.ratio() <= 1.0 && decision.position.ratio() <= 1.0 && decision.velocity.ratio() <= 1.0;
}

}  // namespace

// Bounds over X: of -hddot, of the height of flights (h_m), and of the accumulation time.
struct SharpConditions::Time {
    Interval a_min, a_max, r, height;
    Interval longest;                    // T, by the attained bounds
    AccumulationTime accumulation_time;  // as certified
    double half_width() const {
        return (Interval(0.5) * (Interval(accumulation_time.latest.hi()) - Interval(accumulation_time.earliest.lo())))
            .hi();
    }
};

SharpConditions::SharpConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key,
                                 ContactSet unpressed, const FloatEnvironmentGuard& ground)
    : TruncationConditions(model, run, e, key, unpressed, ground),
      hddot_(
          Range(model.evaluator<Interval>(model.bouncing(key).hddot, run.parameters),
                model.evaluator<Interval>(model.bouncing(key).shadow, run.parameters), model.bouncing(key).variables),
          dof_),
      guess_(model.evaluator(model.bouncing(key).rates, run.parameters)),
      box_(dof_),
      shadow_{std::vector<Interval>(dof_), std::vector<Interval>(dof_), std::vector<Interval>(dof_), {}},
      variables_(model.bouncing(key).variables.size()),
      need_q_(dof_),
      need_s_(dof_),
      rising_(2 * dof_) {}

// Predicts, in double, whether a proof would fail, and skips it if so; the next impact is then tried. If the earlier
// proofs and guesses do not decide, it estimates the maximum distance from the constrained motion in the next flight, to
// leading order.
bool SharpConditions::fails_at_point(const Collision& collision) {
    if (fails_by_speed(collision.speed)) return true;
    const AccelerationTrend trend = trend_at(collision);
    const double e = mid(e_), w = collision.speed;
    if (!(trend.a > 0.0) || !(e < 1.0)) return true;
    if ((collision.restart - collision.tangential).norm() > truncation_.eps_v) return true;
    const double n = (collision.before.v - collision.tangential).norm() / w;
    const double uniform = n * e * w * e * w / (2.0 * trend.a) / truncation_.eps_q;
    if (uniform <= 1.0) return false;
    const double T = 2.0 * e * w / (trend.a * (1.0 - e)), varying = std::abs(trend.b) * T + std::abs(trend.c) * w;
    if (varying < 0.25 * trend.a)
        earlier_.remember(w, uniform, 2);  // a varies little, so the guess holds at the next impacts
    return true;
}

// The attained bounds of theory.md 4; nullopt if X is too large for them.
std::optional<SharpConditions::Time> SharpConditions::time_over_box() {
    box_.put_into(variables_);
    variables_[2 * dof_] = box_.sigma;
    if (!autonomous_) variables_.back() = box_.time();
    const Interval a = -hddot_.over(variables_);
    if (!certainly_positive(a)) return std::nullopt;
    const Interval a_min(a.lo()), a_max(a.hi()), r = a_max / a_min, one(1.0);
    if (!certainly_less(square(e_) * r, one)) return std::nullopt;
    const AccumulationTime accumulation_time = accumulation_time_bounds(e_, a_min, a_max, box_.w);
    return Time{a_min,
                a_max,
                r,
                square(e_ * box_.w) / (Interval(2.0) * a_min),
                Interval(accumulation_time.latest.hi()),
                accumulation_time};
}

// Intersects the enclosure of the accumulation time with the one of third order in the impact speed w (truncation.hpp).
// Call time_over_box() first: it evaluates the derivatives of hddot over the box X that are used here. hddot itself is
// enclosed at the collision with sigma = 0.
void SharpConditions::sharpen(Time& time, const AccelerationTrend& trend) {
    for (std::size_t i = 0; i < dof_; ++i) {
        variables_[i] = box_.q0[i];
        variables_[dof_ + i] = box_.s0[i];
    }
    variables_[2 * dof_] = Interval(0.0);
    if (!autonomous_) variables_.back() = box_.t0;
    const AccelerationBounds drift{-hddot_.over_part(variables_), -hddot_.slope(2 * dof_), -hddot_.P(), -hddot_.Phi(),
                                   -hddot_.Xi()};
    const Interval third =
        third_order_accumulation_time(trend, drift, e_, time.a_min, time.a_max, box_.w, time.longest);
    if (!third.is_defined()) return;
    // Only the lower end of `earliest` and the upper end of `latest` are used.
    if (third.lo() > time.accumulation_time.earliest.lo()) time.accumulation_time.earliest = third;
    if (third.hi() < time.accumulation_time.latest.hi()) time.accumulation_time.latest = third;
}

// Whether X is proved to contain the motion until tau_inf, the shifted variables of theory.md 5.2, and the comparison
// motion if it starts from v*. If not, X grows to the required size and a fifth more.
bool SharpConditions::contain(const Time& time) {
    const Interval &h = time.height, &T = time.longest;
    find_change(variables_);
    bool inside = autonomous_ || T.hi() < box_.duration;
    if (!inside) box_.duration = inflated(T.hi());
    for (std::size_t i = 0; i < dof_; ++i) {
        const Interval &A = hddot_.A(i), &n = hddot_.n(i), &B = hddot_.B(i), &D = hddot_.D(i);
        need_q_[i] = times(variables_[dof_ + i] + n * box_.sigma, T);
        need_s_[i] = times(A + B * box_.sigma + D * square(box_.sigma), T);
        const double q = need_q_[i] + times(n, h);
        const double s = std::max(need_s_[i] + times(B, h), mag(box_.d[i]) + times(A, T)) + times(change_[i], T);
        inside = fits(q, box_.q_radius[i]) && inside;
        inside = fits(s, box_.s_radius[i]) && inside;
    }
    return inside;
}

// (E_q, E_s) from the enclosures over X. The factors are enclosed separately and then multiplied, because the mean
// value theorem takes dA at another point than n and B.
void SharpConditions::find_shadow(const Time& time) {
    const Interval e3 = e_ * square(e_), e2 = e_ * sqrt(time.r), one(1.0);
    const Interval gap_integral =
        Interval(2.0) * e3 * box_.w * square(box_.w) / (Interval(3.0) * square(time.a_min) * (one - e2 * square(e2)));
    const ShadowTerms<Range>& x = hddot_;
    double lipschitz = 1.0, largest_c = 0.0, largest_d = 0.0;
    for (std::size_t i = 0; i < dof_; ++i) {
        lipschitz = std::max(lipschitz, x.steepness(i).hi());
        const Interval c_q = abs(x.B(i) - x.ndot(i)) * gap_integral;
        const Interval c_s = (abs(x.drift(i)) + time.a_max * abs(x.D(i))) * gap_integral;
        shadow_.E_q[i] = Interval(c_q.hi());
        shadow_.E_s[i] = Interval(c_s.hi());
        largest_c = std::max({largest_c, c_q.hi(), c_s.hi()});
        largest_d = std::max(largest_d, mag(box_.d[i]));
    }
    shadow_.growth = exp(Interval(lipschitz) * time.longest);
    const Interval K = shadow_.growth - one;
    const Interval grown = K * (Interval(largest_c) + Interval(largest_d));
    for (std::size_t i = 0; i < dof_; ++i) {
        shadow_.E_q[i] = shadow_.E_q[i] + grown;
        shadow_.E_s[i] = shadow_.E_s[i] + grown + Interval(mag(box_.d[i]));
        shadow_.uniform[i] = shadow_.E_q[i] + abs(x.n(i)) * time.height;
    }
}

// Sets up X at the collision, without radii: the rounding of the computed state.
void SharpConditions::begin_box(const Collision& collision) {
    if (!autonomous_) box_.t0 = instant_of(collision, contact_);
    set_state(contact_, collision.before);
    if (!autonomous_) contact_.clock() = box_.t0;
    contact_.run();
    box_.w = abs(contact_.hdot());
    box_.sigma = Interval(-box_.w.hi(), box_.w.hi());
    const bool euclidean = truncation_.reinitialization == Reinitialization::euclidean;
    Interval g2(0.0);
    for (std::size_t i = 0; i < dof_; ++i) g2 = g2 + square(contact_.gradient(i));
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double v = std::abs(collision.before.v[k]);
        const Interval &n = contact_.impulse_direction(i), &g = contact_.gradient(i);
        // With friction s differs from v- by n_sigma w, and by the error of the slip in it.
        constexpr double few = 4.0;
        const double moved = slip_sign(state_) == 0
                                 ? (abs(n) * box_.w).hi()
                                 : few * (v + std::abs(collision.before.v[k] - collision.tangential[k]));
        box_.q0[i] = rounding_interval(collision.before.q[k], std::abs(collision.before.q[k]));
        box_.s0[i] = rounding_interval(collision.tangential[k], v + moved);
        box_.d[i] = euclidean ? box_.w * abs(n - g / g2) : Interval(0.0);
    }
}

// Predicts in double the radii that the inclusion test will require, so that the first box usually succeeds. Any radii
// may be tried.
void SharpConditions::predict_radii(const Collision& collision, const AccelerationTrend& trend) {
    const double e = mid(e_), w = collision.speed;
    const double T = 2.0 * e * w / (trend.a * (1.0 - e)), h = e * w * e * w / (2.0 * trend.a);
    box_.duration = inflated(T);
    set_state(guess_, collision.with(collision.tangential));
    for (const double sigma : {w, -w}) {
        guess_.input(sigma_) = sigma;
        guess_.run();
        for (std::size_t i = 0; sigma > 0.0 && i < 2 * dof_; ++i) rising_[i] = guess_.rate(i);
    }
    const auto need = [&](std::size_t i) {  // max |rate| T, and the shift by h
        const double falling = guess_.rate(i);
        return std::max(std::abs(rising_[i]), std::abs(falling)) * T + std::abs(rising_[i] - falling) / (2.0 * w) * h;
    };
    for (std::size_t i = 0; i < dof_; ++i) {
        box_.q_radius[i] = inflated(need(i));
        box_.s_radius[i] = inflated(mag(box_.d[i]) + need(dof_ + i));
    }
}

// The certificate of the collision, whatever the tolerances; nullopt if nothing can be proved. The enclosure of third
// order is left out if the decision does not need it. It is made around the estimate of the Zeno time, so it does not
// change that.
std::optional<Certificate> SharpConditions::prove(const Collision& collision, CertificateScope scope) {
    const AccelerationTrend trend = trend_at(collision);
    if (!(trend.a > 0.0) || !(mid(e_) < 1.0)) return std::nullopt;
    begin_box(collision);
    predict_radii(collision, trend);
    for (int round = 0; round < 25; ++round) {
        auto time = time_over_box();
        if (!time) return std::nullopt;
        if (!contain(*time)) continue;
        std::optional<Certificate::OtherContactBounds> others;
        if (!prove_other_contacts_stay(variables_, others, e_)) return std::nullopt;
        find_shadow(*time);
        std::optional<Certificate> certificate;
        if (scope == CertificateScope::decision && time->half_width() <= truncation_.eps_t)
            certificate = certificate_of(collision, *time, trend);
        if (!certificate || !holds(*certificate)) {
            sharpen(*time, trend);
            certificate = certificate_of(collision, *time, trend);
        }
        certificate->others = std::move(others);
        return certificate;
    }
    return std::nullopt;
}

Certificate SharpConditions::certificate_of(const Collision& collision, const Time& time,
                                            const AccelerationTrend& trend) const {
    Certificate c = certificate_at(collision.before.t, time.accumulation_time,
                                   estimated_accumulation_time(trend, mid(e_), collision.speed));
    Interval q(0.0), v(0.0);
    for (std::size_t i = 0; i < dof_; ++i) {
        q = q + square(Interval(need_q_[i]));
        v = v + square(Interval(need_s_[i]) + Interval(mag(box_.d[i])));
    }
    c.position_bound = sqrt(q).hi();
    c.velocity_bound = sqrt(v).hi();
    const auto distance = [&](const std::vector<Interval>& sizes, const Interval& factor) {
        Interval sum(0.0);
        for (std::size_t i = 0; i < dof_; ++i)
            sum = sum + square(sizes[i] + late_change(i, c, shadow_.growth) * factor);
        return sqrt(sum);
    };
    const Interval position = distance(shadow_.E_q, time.longest), velocity = distance(shadow_.E_s, Interval(1.0)),
                   uniform = distance(shadow_.uniform, time.longest);
    // If a derivative is undefined somewhere in X, one of the norms is undefined, although the maximum of several
    // values may have dropped it. No shadowing bound is then certified.
    const bool shadowed = position.is_defined() && velocity.is_defined() && uniform.is_defined();
    if (shadowed) {
        c.shadowing_position = position.hi();
        c.shadowing_velocity = velocity.hi();
        c.uniform_position = uniform.hi();
    }
    c.a_min = time.a_min.lo();
    c.a_max = time.a_max.hi();
    if (slip_sign(state_) != 0) c.tail = Certificate::Tail::slip;
    decide(c, time.half_width());
    c.assumptions = {{"e^2 a_max/a_min", (square(e_) * time.r).hi(), 1.0}, {"normal acceleration", -c.a_min, 0.0}};
    return c;
}

std::optional<Certificate> SharpConditions::do_certify(const Collision& collision, CertificateScope scope) {
    auto certificate = prove(collision, scope);
    if (!certificate || !certificate->uniform_position) return std::nullopt;
    if (holds(*certificate)) return certificate;
    const Certificate::Decision& decision = *certificate->decision;
    const double position = decision.position.ratio();
    const double cubic = std::max(decision.time.ratio(), decision.velocity.ratio());
    if (position > cubic) {
        earlier_.remember(collision.speed, position, 2);
    } else {
        earlier_.remember(collision.speed, cubic, 3);
    }
    return std::nullopt;
}

}  // namespace achilles
