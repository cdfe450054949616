#include "certify/two_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "certify/range.hpp"

namespace achilles {

namespace {

constexpr double room = 1.5;  // factor by which radii are enlarged

// q, s, the two sigma and t.
std::vector<std::uint32_t> variables_of_pair(const Layout& layout) {
    std::vector<std::uint32_t> variables;
    for (std::uint32_t i = 0; i < 2 * layout.dof; ++i) variables.push_back(i);
    variables.insert(variables.end(), {layout.sigma(), layout.second_sigma(), layout.t()});
    return variables;
}

// The bounds for one choice of eta, in interval arithmetic.
class ChatterBound {
 public:
    explicit ChatterBound(const PairAtCollision& pair) : p_(pair) {
        for (std::size_t i = 0; i < 2; ++i) {
            d_[i] = sqrt(p_.W[i][i]);
            rest_[i] = p_.W[i][i] - square(p_.W[0][1]) / p_.W[1 - i][1 - i];  // W_i', while the other contact is held
            a_least_[i] = p_.a[i] - d_[i] * p_.Delta;
            slope_[i] = rest_[i] * p_.lambda[i] - sqrt(rest_[i]) * p_.Delta;
        }
        const Interval one(1.0), two(2.0), e = max(p_.e[0], p_.e[1]);
        // An impact of contact i alone dissipates the fraction 1 - e_i^2 of hdot_i^2/(2 W_ii). An impact of both
        // dissipates at least p' W p/2 (1 - e)/(1 + e), and p' W p >= (1 + e_i)^2 hdot_i^2/W_ii because W p >= (1 + e)
        // |hdot|. For equal restitutions, both fractions are the same.
        for (std::size_t i = 0; i < 2; ++i) taken_[i] = square(one + p_.e[i]) * (one - e) / (one + e);
        L_ = sqrt(square(p_.lambda[0]) * p_.W[0][0] + two * p_.lambda[0] * p_.lambda[1] * p_.W[0][1] +
                  square(p_.lambda[1]) * p_.W[1][1]);
        kd_ = sqrt(two / (one + p_.W[0][1] / (d_[0] * d_[1])));
    }
    bool is_possible() const {
        return certainly_positive(slope_[0]) && certainly_positive(slope_[1]) && certainly_positive(L_ - p_.Delta) &&
               certainly_positive(taken_[0]) && certainly_positive(taken_[1]) &&
               certainly_less(kd_ * p_.omega, Interval(1.0));
    }

    std::optional<PairBound> with(double ratio) const {
        const Interval eta(ratio), one(1.0), two(2.0), four(4.0), c = abs(p_.W[0][1]);
        std::array<Interval, 2> hat, wait{Interval(0.0), Interval(0.0)};
        for (std::size_t i = 0; i < 2; ++i) hat[i] = d_[i] * sqrt((one + p_.omega) * eta / taken_[i]);
        Interval gam(0.0), S(0.0), m(1.0), Ct(0.0);
        bool stands = false;
        for (int round = 0; round < 60 && !stands; ++round) {
            m = one + gam;
            const Interval M = m + p_.omega * S;
            Interval fall(0.0);
            std::array<Interval, 2> next_wait;
            for (std::size_t i = 0; i < 2; ++i) {
                const std::size_t j = 1 - i;
                const Interval low = c * most(i, hat[i], wait[i]).height / p_.W[i][i];
                const Interval root = sqrt(rest_[j] * square(M) + four * slope_[j] * low);
                next_wait[i] = top((sqrt(rest_[j]) * M + root) / slope_[j]);
                fall = max(fall, next_wait[i]);
            }
            Ct = top(two * m / (L_ - p_.Delta) + fall);
            const Interval next_S =
                top((two * kd_ * m + (d_[0] * p_.lambda[0] + d_[1] * p_.lambda[1] + kd_ * p_.Delta) * Ct) /
                    (one - kd_ * p_.omega));
            const Interval next_gam = top(p_.Delta * Ct + two * p_.omega * next_S / (one - p_.omega));
            if (!next_gam.is_defined() || !next_S.is_defined() || next_gam.hi() > 1.0) return std::nullopt;
            stands = next_gam.hi() <= gam.hi() && next_S.hi() <= S.hi();  // the bounds confirm the assumption
            for (std::size_t i = 0; i < 2; ++i) stands = stands && next_wait[i].hi() <= wait[i].hi();
            if (!stands) {
                for (std::size_t i = 0; i < 2; ++i) wait[i] = Interval(next_wait[i].hi() * (1.0 + 1e-9));
                gam = Interval(next_gam.hi() * (1.0 + 1e-9) + 1e-300);
                S = Interval(next_S.hi() * (1.0 + 1e-9));
            }
        }
        const Interval z2 = square(one + gam) - eta;
        if (!stands || !certainly_less(z2, one)) return std::nullopt;
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t j = 1 - i;
            const Excursion weak = most(i, hat[i], wait[i]);
            const Interval strong = rest_[j] * (square(one - gam) - eta - square(weak.speed) / p_.W[i][i] -
                                                two * p_.lambda[i] * weak.height);
            const Interval needed = hat[j] + c * weak.speed / p_.W[i][i];
            if (!(strong.lo() > 0.0) || !(sqrt(strong).lo() >= needed.hi())) return std::nullopt;
        }
        const Interval z = sqrt(max(z2, Interval(0.0)));
        return PairBound{top(Ct * p_.r0 / (one - z)),
                         top(Ct * square(m) * p_.r0 * square(p_.r0) / (two * (one - z * z2))), m};
    }

 private:
    // Maximum speed and height of contact i, in units of r0 and r0^2, while all its impacts are weak (slower than hat)
    // and until the other contact closes, a time `wait` (in r0) later. If the acceleration does not pull contact i back
    // while the other is open (a_i <= 0), it may have risen since its last rebound; otherwise it falls back.
    struct Excursion {
        Interval speed, height;
    };
    Excursion most(std::size_t i, const Interval& hat, const Interval& wait) const {
        const Interval two(2.0), none(0.0), drift = d_[i] * p_.Delta;
        if (certainly_positive(a_least_[i])) return {hat, square(hat) / (two * a_least_[i])};
        const Interval rebound = p_.e[i] * hat, rise = max(drift - p_.a[i], none), fall = max(p_.a[i] + drift, none);
        return {max(rebound + rise * wait, fall * wait), rebound * wait + rise * square(wait) / two};
    }

    const PairAtCollision& p_;
    std::array<Interval, 2> d_, rest_, a_least_, slope_, taken_;
    Interval L_, kd_;
};

}  // namespace

std::optional<PairBound> pair_bound(const PairAtCollision& pair) {
    const ChatterBound chatter(pair);
    if (!chatter.is_possible()) return std::nullopt;
    std::optional<PairBound> best;
    for (double eta = 0.5; eta > 1e-7; eta *= 0.8)
        if (const auto bound = chatter.with(eta); bound && (!best || bound->T.hi() < best->T.hi())) best = bound;
    return best;
}

Interval by_inverse(const PairMatrix& W, const std::array<Interval, 2>& x, const std::array<Interval, 2>& y) {
    const Interval det = W[0][0] * W[1][1] - square(W[0][1]);
    return (W[1][1] * x[0] * y[0] - W[0][1] * (x[0] * y[1] + x[1] * y[0]) + W[0][0] * x[1] * y[1]) / det;
}

// The Frobenius norm, computed from K = W0^-1 (W - W0). The skew part is orthogonal to the symmetric one.
Interval deviation(const PairMatrix& W, const PairMatrix& W0, const Interval& skew) {
    const Interval two(2.0), det = W0[0][0] * W0[1][1] - square(W0[0][1]);
    const Interval d0 = W[0][0] - W0[0][0], d1 = W[0][1] - W0[0][1], d2 = W[1][1] - W0[1][1];
    const Interval k00 = (W0[1][1] * d0 - W0[0][1] * d1) / det, k11 = (W0[0][0] * d2 - W0[0][1] * d1) / det;
    const Interval k01 = (W0[1][1] * d1 - W0[0][1] * d2) / det, k10 = (W0[0][0] * d1 - W0[0][1] * d0) / det;
    return top(sqrt(abs(square(k00) + two * k01 * k10 + square(k11) + two * square(skew) / det)));
}

// ---- the box and the shadow of two contacts ----

TwoContactConditions::TwoContactConditions(const Model& model, const Run& run, const std::array<Interval, 2>& e,
                                           std::size_t first, std::size_t second, Mode closed, ContactSet unpressed,
                                           const FloatEnvironmentGuard& ground)
    : ConditionsBase(model, run, &model.pair(first, second, closed).others, variables_of_pair(model.layout()),
                     unpressed, ground),
      layout_(model.layout()),
      e_(e),
      terms_(model.evaluator<Interval>(model.pair(first, second, closed).terms, run.parameters)),
      point_(model.evaluator(model.pair(first, second, closed).terms, run.parameters)) {
    truncation_.conditions = Conditions::sharp;  // pairs have no other conditions
    truncation_.reinitialization = Reinitialization::kinetic;
}

bool TwoContactConditions::evaluate_terms(const std::vector<Interval>& box) {
    set_box(terms_, box);
    terms_.run();
    return certainly_positive(terms_.W(0, 0)) && certainly_positive(terms_.W(1, 1));
}

bool TwoContactConditions::evaluate_terms_at(const State& tangential) {
    std::vector<Interval> here;
    for (const double q : tangential.q) here.emplace_back(q);
    for (const double s : tangential.v) here.emplace_back(s);
    here.insert(here.end(), {Interval(0.0), Interval(0.0), Interval(tangential.t)});
    return evaluate_terms(here);
}

State TwoContactConditions::tangential_of(const PairCollision& collision) {
    State tangential = collision.before;  // N does not depend on the velocity
    set_state(point_, tangential);
    point_.input(layout_.sigma()) = point_.input(layout_.second_sigma()) = 0.0;
    point_.run();
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(dof_); ++i)
        for (std::size_t k = 0; k < 2; ++k)
            tangential.v[i] -= point_.N(k, static_cast<std::size_t>(i)) * collision.sigma[k];
    set_state(point_, tangential);
    point_.run();
    return tangential;
}

TwoContactConditions::PairBox TwoContactConditions::first_box(const PairCollision& collision, const State& tangential,
                                                              double duration, double growth) {
    PairBox box(dof_);
    box.duration = inflated(duration, room);
    box.growth = growth;
    const double ulp = 0x1p-52 * std::abs(tangential.t);
    box.t0 = Interval(tangential.t) + Interval(-4.0 * ulp, 4.0 * ulp);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(dof_); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double q = tangential.q[i], v = std::abs(collision.before.v[i]) + std::abs(tangential.v[i]);
        box.q0[k] = rounding_interval(q, std::abs(q));
        box.s0[k] = rounding_interval(tangential.v[i], v);
        box.q_radius[k] = inflated(std::abs(tangential.v[i]) * duration, room);
        box.s_radius[k] = inflated(std::abs(point_.A(k)) * duration, room);
    }
    return box;
}

void TwoContactConditions::update(PairBox& box, const std::array<Interval, 2>& size, const Interval& r0) const {
    box.put_into(box.all);
    for (std::size_t k = 0; k < 2; ++k) {
        const double most = (size[k] * Interval(box.growth) * r0).hi();
        box.all[2 * dof_ + k] = {-most, most};
    }
    box.all.back() = box.time();
}

bool TwoContactConditions::contain(PairBox& box, const MotionBounds& bounds) {
    bool inside = fits(bounds.T.hi(), box.duration, room) && bounds.growth.hi() <= box.growth;
    if (!(bounds.growth.hi() <= box.growth)) box.growth = 1.0 + 1.5 * (bounds.growth.hi() - 1.0);
    for (std::size_t i = 0; i < dof_; ++i) {
        Interval rate = box.all[dof_ + i], F = terms_.A(i), shift_q(0.0), shift_s(0.0);
        for (std::size_t k = 0; k < 2; ++k) {
            const Interval &sigma = box.all[2 * dof_ + k], h = bounds.peak / bounds.force[k];
            rate = rate + terms_.N(k, i) * sigma;
            F = F + terms_.B(k, i) * sigma;
            shift_q = shift_q + abs(terms_.N(k, i)) * h;
            shift_s = shift_s + abs(terms_.B(k, i)) * h;
        }
        const Interval &u = box.all[2 * dof_], &w = box.all[2 * dof_ + 1];
        F = F + terms_.D(0, i) * square(u) + terms_.D(1, i) * u * w + terms_.D(2, i) * square(w);
        const double q = (abs(rate) * bounds.T + shift_q).hi(), v = (abs(F) * bounds.T + shift_s).hi();
        inside = fits(q, box.q_radius[i], room) && inside;
        inside = fits(v, box.s_radius[i], room) && inside;
    }
    return inside;
}

void TwoContactConditions::add_shadow(Certificate& c, const PairBox& box, const MotionBounds& bounds) {
    const PairTerms<Evaluator<Interval>>& x = terms_;
    double lipschitz = 1.0, largest = 0.0;
    std::vector<Interval> E_q(dof_), E_s(dof_), uniform(dof_);
    for (std::size_t i = 0; i < dof_; ++i) {
        Interval row(0.0), c_q(0.0);
        Interval c_s = abs(x.D(0, i)) * bounds.products[0] + abs(x.D(1, i)) * bounds.products[1] +
                       abs(x.D(2, i)) * bounds.products[2];
        for (std::size_t k = 0; k < 2; ++k) {
            Interval drift = -x.Bdot(k, i);
            for (std::size_t j = 0; j < dof_; ++j)
                drift = drift + x.dA_dq(i, j) * x.N(k, j) + x.dA_ds(i, j) * x.B(k, j);
            c_q = c_q + abs(x.B(k, i) - x.Ndot(k, i)) * bounds.gap[k];
            c_s = c_s + abs(drift) * bounds.gap[k];
            uniform[i] = uniform[i] + abs(x.N(k, i)) * bounds.peak / bounds.force[k];
        }
        for (std::size_t j = 0; j < dof_; ++j) row = row + abs(x.dA_dq(i, j)) + abs(x.dA_ds(i, j));
        lipschitz = std::max(lipschitz, row.hi());
        E_q[i] = top(c_q);
        E_s[i] = top(c_s);
        largest = std::max({largest, c_q.hi(), c_s.hi()});
    }
    const Interval grown = (exp(Interval(lipschitz) * bounds.T) - Interval(1.0)) * Interval(largest);
    Interval position(0.0), velocity(0.0);
    for (std::size_t i = 0; i < dof_; ++i) {
        E_q[i] = E_q[i] + grown;
        E_s[i] = E_s[i] + grown;
        uniform[i] = uniform[i] + E_q[i];
        position = position + square(Interval(box.q_radius[i]));
        velocity = velocity + square(Interval(box.s_radius[i]));
    }
    c.position_bound = sqrt(position).hi();
    c.velocity_bound = sqrt(velocity).hi();
    c.shadowing_position = norm(E_q).hi();
    c.shadowing_velocity = norm(E_s).hi();
    c.uniform_position = norm(uniform).hi();
}

State TwoContactConditions::restart_of(const PairCollision& collision, const State& tangential) const {
    State restart = tangential;
    for (std::size_t i = 0; i < dof_; ++i)
        for (std::size_t k = 0; k < 2; ++k) {
            restart.q[static_cast<Eigen::Index>(i)] -= point_.N(k, i) * collision.h[k];
            restart.v[static_cast<Eigen::Index>(i)] -= point_.B(k, i) * collision.h[k];
        }
    return restart;
}

bool TwoContactConditions::is_accepted(const Certificate& certificate) {
    for (const Inequality& inequality :
         {certificate.decision->time, certificate.decision->position, certificate.decision->velocity})
        if (!(inequality.left <= inequality.right)) return false;
    return true;
}

// ---- pairs that a force presses (theory-gaps.md 3) ----

// The terms at the collision, with sigma = 0; nullopt if the pair is not pressed.
std::optional<PairAtCollision> PairConditions::at_collision(const PairCollision& collision, const State& tangential) {
    if (!evaluate_terms_at(tangential)) return std::nullopt;
    PairAtCollision pair;
    pair.e = e_;
    for (std::size_t k = 0; k < 2; ++k) {
        pair.a[k] = -terms_.hddot(k);
        for (std::size_t l = 0; l < 2; ++l) pair.W[k][l] = terms_.W(k, l);
    }
    const Interval det = pair.W[0][0] * pair.W[1][1] - square(pair.W[0][1]);
    if (!certainly_positive(det)) return std::nullopt;
    Interval energy(0.0);
    const std::array<Interval, 2> sigma{Interval(collision.sigma[0]), Interval(collision.sigma[1])};
    for (std::size_t k = 0; k < 2; ++k) {
        pair.lambda[k] = (pair.W[1 - k][1 - k] * pair.a[k] - pair.W[0][1] * pair.a[1 - k]) / det;
        if (!certainly_positive(pair.lambda[k])) return std::nullopt;
        energy = energy + Interval(2.0) * pair.lambda[k] * Interval(std::max(0.0, collision.h[k]));
    }
    pair.r0 = top(sqrt(energy + by_inverse(pair.W, sigma, sigma)));
    return pair;
}

TwoContactConditions::MotionBounds PairConditions::motion_bounds(const PairBound& bound, const PairAtCollision& pair) {
    const auto product = [&](std::size_t k, std::size_t l) {
        return Interval(2.0) * sqrt(pair.W[k][k]) * sqrt(pair.W[l][l]) * bound.J;
    };
    return {bound.T,
            bound.m,
            square(bound.m * pair.r0) * Interval(0.5),
            pair.lambda,
            {bound.J / pair.lambda[0], bound.J / pair.lambda[1]},
            {product(0, 0), product(0, 1), product(1, 1)}};
}

Certificate PairConditions::certificate_of(const PairBox& box, const PairBound& bound, const PairAtCollision& pair,
                                           const PairCollision& collision) {
    double wait = 0.0;  // as if each contact bounced alone, with the acceleration when both are held as a substitute
    for (std::size_t k = 0; k < 2; ++k) {
        const double e = mid(e_[k]), h = std::max(0.0, collision.h[k]);
        const double a = mid(pair.a[k]) > 0.0 ? mid(pair.a[k]) : mid(pair.lambda[k] * pair.W[k][k]);
        const double falling = std::sqrt(collision.sigma[k] * collision.sigma[k] + 2.0 * a * h);
        const double landing = h > 0.0 ? (collision.sigma[k] + falling) / a : 0.0;
        wait = std::max(wait, landing + 2.0 * e * falling / (a * (1.0 - e)));
    }
    Certificate c = certificate_at(collision.before.t, {Interval(0.0), bound.T}, wait);
    c.zeno_low = collision.before.t;
    add_shadow(c, box, motion_bounds(bound, pair));
    c.a_min = std::min(pair.a[0].lo(), pair.a[1].lo());
    c.a_max = std::max(pair.a[0].hi(), pair.a[1].hi());
    decide(c, 0.5 * bound.T.hi());
    c.assumptions = {{"growth of the energy", bound.m.hi(), 2.0},
                     {"negated least force at the cut", -std::min(pair.lambda[0].lo(), pair.lambda[1].lo()), 0.0}};
    return c;
}

std::optional<PairCompletion> PairConditions::certify(const PairCollision& collision, bool cut_at_resolution) {
    const FloatEnvironmentGuard ground;
    const State tangential = tangential_of(collision);
    auto pair = at_collision(collision, tangential);
    if (!pair) return std::nullopt;
    const auto first = pair_bound(*pair);
    if (!first || (!cut_at_resolution && 0.5 * first->T.hi() > truncation_.eps_t)) return std::nullopt;
    PairBox box = first_box(collision, tangential, first->T.hi(), 1.0 + 2.0 * (first->m.hi() - 1.0) + 1e-6);
    for (int round = 0; round < 40; ++round) {
        update(box, {sqrt(pair->W[0][0]), sqrt(pair->W[1][1])}, pair->r0);
        if (!evaluate_terms(box.all)) return std::nullopt;
        const std::array<Interval, 2> off{terms_.hddot(0) + pair->a[0], terms_.hddot(1) + pair->a[1]};
        pair->Delta = top(sqrt(abs(by_inverse(pair->W, off, off))));
        const Interval& W_01 = terms_.W(0, 1);
        pair->omega = deviation({{{terms_.W(0, 0), W_01}, {W_01, terms_.W(1, 1)}}}, pair->W);
        const auto bound = pair_bound(*pair);
        if (!bound) return std::nullopt;
        if (!contain(box, motion_bounds(*bound, *pair))) continue;
        std::optional<Certificate::OtherContactBounds> others;
        if (!prove_other_contacts_stay(box.all, others)) return std::nullopt;
        evaluate_terms(box.all);
        PairCompletion result{certificate_of(box, *bound, *pair, collision), restart_of(collision, tangential)};
        result.certificate.others = std::move(others);
        result.certificate.cut_at_resolution = cut_at_resolution;
        if (!cut_at_resolution && !is_accepted(result.certificate)) return std::nullopt;
        return result;
    }
    return std::nullopt;
}

}  // namespace achilles
