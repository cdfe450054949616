#include "certify/sharp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

constexpr double doubt = 1.5;  // what a guess may be wrong by

// A number computed from terms of this size stands for every number that rounding could have made it from; the
// certificate holds for all of them. The size is that of the terms: s = v - n hdot may cancel.
Interval rounded(double x, double size) {
    const double radius = 0x1p-50 * size;
    return Interval(x) + Interval(-radius, radius);
}

Interval widened(const Interval& x, double radius) { return x + Interval(-radius, radius); }

// A radius that holds what was needed, with room: a fifth, and something where nothing was needed.
double inflated(double need) { return 1.2 * need + std::numeric_limits<double>::min(); }

// max |x| times a nonnegative factor, rounded up.
double times(const Interval& x, const Interval& factor) { return (Interval(mag(x)) * factor).hi(); }

double largest(const std::vector<Interval>& x) {
    double most = 0.0;
    for (const Interval& entry : x) most = std::max(most, entry.hi());
    return most;
}

}  // namespace

// X: a box in (q, s), and sigma. The radii are those beyond the rounding box of the collision.
struct SharpConditions::Box {
    std::vector<Interval> q0, s0;  // what the computed state stands for
    std::vector<double> q_radius, s_radius;
    std::vector<Interval> d;  // v* - s where the restart is v*
    Interval w, sigma;
};

// Over X: bounds of -hddot, and the longest time to the Zeno point.
struct SharpConditions::Time {
    Interval a_min, a_max, r;
    Wait wait;
};

struct SharpConditions::Shadow {
    std::vector<Interval> E_q, E_s;
};

SharpConditions::SharpConditions(const Model& model, const Run& run, const Ground& ground)
    : TruncationConditions(ground),
      n_(static_cast<std::size_t>(model.n())),
      sigma_(model.layout().sigma()),
      truncation_(run.options.truncation),
      e_(model.evaluator<Interval>(model.restitution(), run.parameters).output(0)),
      hddot_(model.evaluator<Interval>(model.bouncing().hddot, run.parameters),
             model.evaluator<Interval>(model.bouncing().gradient, run.parameters), bouncing_slots(model.layout())),
      motion_(model.evaluator<Interval>(model.bouncing().motion, run.parameters)),
      shadow_(model.evaluator<Interval>(model.bouncing().shadow, run.parameters)),
      surface_(model.evaluator<Interval>(model.surface(), run.parameters)),
      trend_(model.evaluator(model.bouncing().trend, run.parameters)),
      variables_(2 * n_ + 1),
      need_q_(n_),
      need_s_(n_) {}

void SharpConditions::set(Evaluator<Interval>& program, const Box& box) const {
    for (std::size_t i = 0; i < n_; ++i) {
        program.input(i) = widened(box.q0[i], box.q_radius[i]);
        program.input(n_ + i) = widened(box.s0[i], box.s_radius[i]);
    }
    program.input(sigma_) = box.sigma;
    program.run();
}

// A guess of what a proof would find, in double. Where even that is too much, trying is put off to the next impact. It
// never replaces a proof. The bounds fall with the cube of w at most, so what the last proof or guess found tells.
bool SharpConditions::hopeless_at(double speed) {
    if (speed > last_speed_) too_wide_ = 0.0;  // another bouncing
    last_speed_ = speed;
    const double slower = speed / wide_speed_;
    return slower < 1.0 && too_wide_ * slower * slower * slower > doubt;
}

// Else, to first order, how far -hddot varies over the least X there can be.
bool SharpConditions::hopeless(const Collision& collision) {
    if (hopeless_at(collision.speed)) return true;
    for (std::size_t i = 0; i < n_; ++i) {
        trend_.input(i) = collision.before.q[static_cast<Eigen::Index>(i)];
        trend_.input(n_ + i) = collision.tangential[static_cast<Eigen::Index>(i)];
    }
    trend_.run();
    const double a = -trend_.output(0), e = mid(e_), w = collision.speed;
    if (!(a > 0.0) || (collision.restart - collision.tangential).norm() > truncation_.eps_v) return true;
    const double T = 2.0 * e * w / (a * (1.0 - e));
    double variation = std::abs(trend_.output(1 + 2 * n_)) * w;
    for (std::size_t i = 1; i <= 2 * n_; ++i) variation += std::abs(trend_.output(i)) * T;
    // Half of the time bound's width, with a_min and a_max = a (1 -+ x): to first order in x, then as it is.
    const double x = variation / a, scaled = x * (1.0 + e * e) / (1.0 - e * e);
    const double first = 2.0 * e * w * scaled / (a * (1.0 - e)), allowed = doubt * truncation_.eps_t;
    if (scaled < 1.0 && first <= allowed * (1.0 - scaled * scaled)) return false;
    if (x < 0.5) remember(w, first / truncation_.eps_t);  // the next impacts lie where a is about the same
    return true;
}

void SharpConditions::remember(double speed, double too_wide) {
    wide_speed_ = speed;
    too_wide_ = too_wide;
}

// The attained bound of section 4, if X allows it.
std::optional<SharpConditions::Time> SharpConditions::time_over(const Box& box) {
    for (std::size_t i = 0; i < n_; ++i) {
        variables_[i] = widened(box.q0[i], box.q_radius[i]);
        variables_[n_ + i] = widened(box.s0[i], box.s_radius[i]);
    }
    variables_[2 * n_] = box.sigma;
    const Interval a = -hddot_.over(variables_);
    if (!certainly_positive(a)) return std::nullopt;
    const Interval a_min(a.lo()), a_max(a.hi()), r = a_max / a_min, one(1.0);
    if (!certainly_less(square(e_) * r, one)) return std::nullopt;
    return Time{a_min, a_max, r, wait_for_zeno(e_, a_min, a_max, box.w)};
}

// Is the motion until tau_inf proved to stay inside X? If not, X grows to what it asked for, and a fifth more.
bool SharpConditions::contain_motion(Box& box, const Time& time) {
    set(motion_, box);
    const Interval T(time.wait.latest.hi());
    bool inside = true;
    for (std::size_t i = 0; i < n_; ++i) {
        need_q_[i] = times(motion_.output(i), T);
        need_s_[i] = times(motion_.output(n_ + i), T);
        inside = inside && need_q_[i] < box.q_radius[i] && need_s_[i] < box.s_radius[i];
    }
    if (inside) return true;
    for (std::size_t i = 0; i < n_; ++i) {
        box.q_radius[i] = std::max(box.q_radius[i], inflated(need_q_[i]));
        box.s_radius[i] = std::max(box.s_radius[i], inflated(need_s_[i]));
    }
    return false;
}

// The same for the shifted variables of section 5, and for the comparison motion where it starts from v*.
bool SharpConditions::contain_shadow(Box& box, const Time& time) {
    set(shadow_, box);
    const Interval h = square(e_ * box.w) / (Interval(2.0) * time.a_min), T(time.wait.latest.hi());
    bool inside = true;
    for (std::size_t i = 0; i < n_; ++i) {
        const double q = need_q_[i] + times(shadow_.output(n_ + i), h);
        const double shifted = need_s_[i] + times(shadow_.output(2 * n_ + i), h);
        const double s = std::max(shifted, mag(box.d[i]) + times(shadow_.output(i), T));
        inside = inside && q < box.q_radius[i] && s < box.s_radius[i];
        if (!std::isfinite(q) || !std::isfinite(s)) continue;
        box.q_radius[i] = std::max(box.q_radius[i], q < box.q_radius[i] ? 0.0 : inflated(q));
        box.s_radius[i] = std::max(box.s_radius[i], s < box.s_radius[i] ? 0.0 : inflated(s));
    }
    return inside;
}

// (E_q, E_s) from the enclosures that contain_shadow has just evaluated. Enclosures are multiplied, not expressions:
// the mean value theorem takes dA at another point than n and B.
SharpConditions::Shadow SharpConditions::shadow_over(const Box& box, const Time& time) const {
    const Interval e3 = e_ * square(e_), e2 = e_ * sqrt(time.r), one(1.0);
    const Interval gap_integral =
        Interval(2.0) * e3 * box.w * square(box.w) / (Interval(3.0) * square(time.a_min) * (one - e2 * square(e2)));
    const auto n = [&](std::size_t i) { return shadow_.output(n_ + i); };
    const auto B = [&](std::size_t i) { return shadow_.output(2 * n_ + i); };
    const auto D = [&](std::size_t i) { return shadow_.output(3 * n_ + i); };
    const auto ndot = [&](std::size_t i) { return shadow_.output(4 * n_ + i); };
    const auto Bdot = [&](std::size_t i) { return shadow_.output(5 * n_ + i); };
    const auto dA_dq = [&](std::size_t i, std::size_t j) { return shadow_.output(6 * n_ + i * n_ + j); };
    const auto dA_ds = [&](std::size_t i, std::size_t j) { return shadow_.output(6 * n_ + n_ * n_ + i * n_ + j); };

    std::vector<Interval> c_q, c_s;
    double lipschitz = 1.0;
    for (std::size_t i = 0; i < n_; ++i) {
        Interval drift = -Bdot(i), row(0.0);
        for (std::size_t j = 0; j < n_; ++j) {
            drift = drift + dA_dq(i, j) * n(j) + dA_ds(i, j) * B(j);
            row = row + abs(dA_dq(i, j)) + abs(dA_ds(i, j));
        }
        lipschitz = std::max(lipschitz, row.hi());
        c_q.push_back(abs(B(i) - ndot(i)) * gap_integral);
        c_s.push_back(abs(drift) * gap_integral + time.a_max * abs(D(i)) * gap_integral);
    }
    const Interval K = exp(Interval(lipschitz) * Interval(time.wait.latest.hi())) - one;
    const Interval grown = K * Interval(std::max(largest(c_q), largest(c_s)));
    std::vector<Interval> d;
    for (const Interval& entry : box.d) d.emplace_back(mag(entry));
    const Interval moved = K * Interval(largest(d));
    Shadow shadow;
    for (std::size_t i = 0; i < n_; ++i) {
        shadow.E_q.push_back(Interval(c_q[i].hi()) + grown + moved);
        shadow.E_s.push_back(Interval(c_s[i].hi()) + grown + moved + d[i]);
    }
    return shadow;
}

std::optional<Certificate> SharpConditions::prove(const Collision& collision) {
    put(surface_, collision.before);
    surface_.run();
    Box box;
    box.w = abs(surface_.output(1));
    box.sigma = Interval(-box.w.hi(), box.w.hi());
    std::vector<Interval> g;
    for (std::size_t i = 0; i < n_; ++i) g.push_back(surface_.output(2 + n_ + i));
    for (std::size_t i = 0; i < n_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double v = std::abs(collision.before.v[k]);
        box.q0.push_back(rounded(collision.before.q[k], std::abs(collision.before.q[k])));
        box.s0.push_back(rounded(collision.tangential[k], v + (abs(surface_.output(2 + i)) * box.w).hi()));
        const bool euclidean = truncation_.reinitialization == Reinitialization::euclidean;
        box.d.push_back(euclidean ? box.w * abs(surface_.output(2 + i) - g[i] / square(norm(g))) : Interval(0.0));
    }
    box.q_radius.assign(n_, 0.0);
    box.s_radius.assign(n_, 0.0);
    for (int round = 0; round < 25; ++round) {
        const auto time = time_over(box);
        if (!time) return std::nullopt;
        if (!contain_motion(box, *time) || !contain_shadow(box, *time)) continue;
        return certificate_of(collision, box, *time, shadow_over(box, *time));
    }
    return std::nullopt;
}

Certificate SharpConditions::certificate_of(const Collision& collision, const Box& box, const Time& time,
                                            const Shadow& shadow) const {
    Certificate c;
    c.certified = true;
    c.conditions = Conditions::sharp;
    c.reinitialization = truncation_.reinitialization;
    set_zeno_time(c, collision.t, time.wait);
    std::vector<Interval> q, v;
    for (std::size_t i = 0; i < n_; ++i) {
        q.emplace_back(need_q_[i]);
        v.push_back(Interval(need_s_[i]) + Interval(mag(box.d[i])));
    }
    c.position_bound = norm(q).hi();
    c.velocity_bound = norm(v).hi();
    c.shadowing_position = norm(shadow.E_q).hi();
    c.shadowing_velocity = norm(shadow.E_s).hi();
    c.a_min = time.a_min.lo();
    c.a_max = time.a_max.hi();
    const double half_width =
        (Interval(0.5) * (Interval(time.wait.latest.hi()) - Interval(time.wait.earliest.lo()))).hi();
    c.inequalities = {{"time bound", half_width, truncation_.eps_t},
                      {"position bound", *c.shadowing_position, truncation_.eps_q},
                      {"velocity bound", *c.shadowing_velocity, truncation_.eps_v},
                      {"e^2 a_max/a_min", (square(e_) * time.r).hi(), 1.0},
                      {"normal acceleration", -c.a_min, 0.0}};
    name_decisive(c);
    return c;
}

std::optional<Certificate> SharpConditions::certify(const Collision& collision) {
    auto certificate = prove(collision);
    if (!certificate) return std::nullopt;
    double widest = 0.0;  // against its tolerance
    for (std::size_t i = 0; i < 3; ++i)
        widest = std::max(widest, certificate->inequalities[i].left / certificate->inequalities[i].right);
    if (widest <= 1.0) return certificate;
    remember(collision.speed, widest);
    return std::nullopt;
}

std::optional<Certificate> SharpConditions::certify_widest(const Collision& collision) {
    auto certificate = prove(collision);
    if (certificate) certificate->below_rounding = true;
    return certificate;
}

}  // namespace achilles
