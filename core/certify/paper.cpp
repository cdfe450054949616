#include "certify/paper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/impact_law.hpp"

namespace achilles {

namespace {

// Euclidean norm of a vector with n entries.
template <class Entry>
double norm(std::size_t n, const Entry& entry) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += entry(i) * entry(i);
    return std::sqrt(sum);
}

Interval around(double center, double radius) { return Interval(center) + Interval(-radius, radius); }

}  // namespace

// Enclosures over the neighborhood: the quantities of Def. 7, and its bounds on time, position and velocity.
struct PaperConditions::Bounds {
    Interval a_min, a_max, eta, zeta, beta, w, e1, e2;
    Interval time, position, velocity;  // per unit of w
    std::vector<Interval> box, n;       // V, and the impulse directions over it
};

PaperConditions::PaperConditions(const Model& model, const Run& run, const Interval& e, const BouncingKey& key,
                                 ContactSet unpressed, const FloatEnvironmentGuard& ground)
    : TruncationConditions(model, run, e, key, unpressed, ground),
      point_(model.evaluator(model.programs_of(key.contact, key.mode).definition7_terms, run.parameters)),
      hddot_(model.evaluator<Interval>(model.bouncing(key).hddot, run.parameters),
             model.evaluator<Interval>(model.bouncing(key).gradient, run.parameters), model.bouncing(key).variables),
      box_(model.evaluator<Interval>(model.programs_of(key.contact, key.mode).definition7_terms, run.parameters)),
      rates_(model.evaluator<Interval>(model.bouncing(key).rates, run.parameters)) {}

// Evaluates the conditions with the values at the restart in place of the maxima. These are never stricter than the
// real conditions, so a collision that fails here (with a margin for rounding) cannot be certified.
bool PaperConditions::fails_at_point(const Collision& collision) {
    set_state(point_, collision.with(collision.restart));
    point_.run();
    const double e = mid(e_), w = collision.speed, a = -point_.hddot();
    if (!(a > 0.0) || !(e < 1.0)) return true;
    const double time = 2.0 * e * w / (a * (1.0 - e));
    const double eta = norm(dof_, [&](std::size_t i) { return point_.impulse_direction(i); });
    const double zeta = norm(dof_, [&](std::size_t i) { return point_.acceleration(i); });
    const double velocity = 2.0 * e * eta / (1.0 - e) * w + zeta * time;
    constexpr double margin = 1.0 - 1e-9;
    return margin * time > truncation_.eps_t || margin * time * collision.restart.norm() > truncation_.eps_q ||
           margin * velocity > truncation_.eps_v;
}

std::optional<PaperConditions::Bounds> PaperConditions::bounds_over(const Collision& collision, double eps_q,
                                                                    double eps_v, double eps_t) {
    std::vector<Interval> box, n, f, g, v;
    for (std::size_t i = 0; i < dof_; ++i)
        box.push_back(around(collision.before.q[static_cast<Eigen::Index>(i)], eps_q));
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        box.push_back(hull(around(collision.restart[k], eps_v), Interval(collision.before.v[k])));
        v.emplace_back(collision.restart[k]);
    }
    for (std::size_t i = 0; i < 2 * dof_; ++i) box_.input(i) = box[i];
    const Interval start = autonomous_ ? Interval(collision.before.t) : instant_of(collision, contact_);
    const Interval while_bouncing(start.lo(), (Interval(start.hi()) + Interval(eps_t)).hi());
    box_.clock() = while_bouncing;
    box_.run();
    set_state(contact_, collision.before);
    contact_.clock() = start;
    contact_.run();
    for (std::size_t i = 0; i < dof_; ++i) {
        n.push_back(box_.impulse_direction(i));
        f.push_back(box_.acceleration(i));
        g.push_back(contact_.gradient(i));
    }
    box.emplace_back(0.0);  // sigma is 0, because the box contains the velocities themselves
    if (!autonomous_) box.push_back(while_bouncing);
    const Interval a = -hddot_.over(box), eta = norm(n), zeta = norm(f), one(1.0), two(2.0);
    if (!certainly_positive(a) || !eta.is_defined() || !zeta.is_defined()) return std::nullopt;
    Bounds b{Interval(a.lo()),
             Interval(a.hi()),
             Interval(eta.hi()),
             Interval(zeta.hi()),
             norm(v) + Interval(eps_v),
             abs(contact_.hdot()),
             {},
             {},
             {},
             {},
             {},
             box,
             n};
    const Interval r = b.a_max / b.a_min;
    b.e1 = e_ * r;
    b.e2 = e_ * sqrt(r);
    if (!certainly_less(b.e1, one)) return std::nullopt;
    const bool kinetic = truncation_.reinitialization == Reinitialization::kinetic;
    const Interval jumps = (kinetic ? e_ + b.e2 : one + e_) * b.eta / (one - b.e2);
    b.time = two * e_ / (b.a_min * (one - b.e1));
    b.position = b.beta * b.time;
    b.velocity = jumps + b.zeta * b.time + (kinetic ? Interval(0.0) : one / norm(g));
    return b;
}

// Finds the smallest neighborhood that satisfies its own conditions, from below; see the header.
std::optional<Certificate> PaperConditions::prove(const Collision& collision, const Truncation& tolerances) {
    double q = 0.0, v = 0.0, t = 0.0;
    for (int round = 0; round < 40; ++round) {
        const auto bounds = bounds_over(collision, q, v, t);
        if (!bounds) return std::nullopt;  // then it fails for larger ones, too
        const double needed_q = (bounds->position * bounds->w).hi(), needed_v = (bounds->velocity * bounds->w).hi();
        const double needed_t = (bounds->time * bounds->w).hi();
        if (!(needed_t < tolerances.eps_t) || !(needed_q < tolerances.eps_q) || !(needed_v < tolerances.eps_v))
            return std::nullopt;
        if (needed_q < q && needed_v < v && (autonomous_ || needed_t < t)) {
            std::optional<Certificate::OtherContactBounds> others;
            if (!prove_other_contacts_stay(bounds->box, others)) return std::nullopt;
            Certificate certificate = certificate_of(collision, *bounds);
            certificate.others = std::move(others);
            return certificate;
        }
        // Slightly more than required, so that the iteration ends.
        const auto more = [](double needed, double eps) {
            return std::min(eps, 1.02 * needed + std::numeric_limits<double>::min());
        };
        q = std::max(q, more(needed_q, tolerances.eps_q));
        v = std::max(v, more(needed_v, tolerances.eps_v));
        t = std::max(t, more(needed_t, tolerances.eps_t));
    }
    return std::nullopt;
}

// |s_k - v*| + T max |s'| over V; see the header. contact_ must be evaluated at this collision.
Interval PaperConditions::tangential_bound(const Collision& collision, const Bounds& b,
                                           const Interval& accumulation_time) {
    const Interval speeds(-b.w.hi(), b.w.hi());
    for (std::size_t i = 0; i < dof_; ++i) {
        rates_.input(i) = b.box[i];
        rates_.input(dof_ + i) = b.box[dof_ + i] - b.n[i] * speeds;
    }
    rates_.input(sigma_) = speeds;
    if (!autonomous_) rates_.clock() = b.box.back();
    rates_.run();
    std::vector<Interval> s(collision.before.v.begin(), collision.before.v.end()), distance;
    newton::move_along(
        s.data(), dof_, [&](std::size_t i) { return contact_.impulse_direction(i); }, contact_.hdot());
    for (std::size_t i = 0; i < dof_; ++i)
        distance.push_back(abs(s[i] - Interval(collision.restart[static_cast<Eigen::Index>(i)])) +
                           Interval(mag(rates_.s_rate(i))) * Interval(accumulation_time.hi()));
    return norm(distance);
}

Certificate PaperConditions::certificate_of(const Collision& collision, const Bounds& b) {
    // The tighter interval for tau_inf (theory.md 4) is valid, because -hddot stays in [a_min, a_max].
    const AccumulationTime accumulation_time = accumulation_time_bounds(e_, b.a_min, b.a_max, b.w);
    Certificate certificate =
        certificate_at(collision.before.t, accumulation_time,
                       estimated_accumulation_time(trend_at(collision), mid(e_), collision.speed));
    // The c_i use the tolerances of the run: the bounds over V are smaller than the radii of V, which are smaller than
    // the tolerances.
    const auto condition = [&](const char* name, const Interval& factor, double eps) -> Inequality {
        const bool none = !(factor.hi() > 0.0);
        return {name, b.w.hi(),
                none ? std::numeric_limits<double>::infinity() : (Interval(eps) / Interval(factor.hi())).lo()};
    };
    const Certificate::Decision decision{condition("c1: time", b.time, truncation_.eps_t),
                                         condition("c2: position", b.position, truncation_.eps_q),
                                         condition("c3: velocity", b.velocity, truncation_.eps_v)};
    certificate.decision = decision;
    certificate.tightest_bound = decision.closest().name;
    certificate.assumptions = {{"e a_max/a_min", b.e1.hi(), 1.0}, {"normal acceleration", -b.a_min.lo(), 0.0}};
    certificate.position_bound = (b.position * b.w).hi();
    certificate.a_min = b.a_min.lo();
    certificate.a_max = b.a_max.hi();
    const Interval closer = tangential_bound(collision, b, accumulation_time.latest), added = b.velocity * b.w;
    certificate.velocity_bound = closer.is_defined() ? std::min(closer.hi(), added.hi()) : added.hi();
    certificate.paper = Certificate::Paper{b.e1.hi(),
                                           b.e2.hi(),
                                           b.beta.hi(),
                                           b.eta.hi(),
                                           b.zeta.hi(),
                                           decision.time.right,
                                           decision.position.right,
                                           decision.velocity.right};
    return certificate;
}

std::optional<Certificate> PaperConditions::do_certify(const Collision& collision, CertificateScope) {
    return prove(collision, truncation_);
}

std::optional<Certificate> PaperConditions::do_prove_any(const Collision& collision) {
    constexpr double any = 1e6;
    return prove(collision, {any, any, any, Conditions::paper, truncation_.reinitialization});
}

}  // namespace achilles
