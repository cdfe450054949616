#include "certify/paper.hpp"

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

double norm(const Evaluator<double>& evaluator, std::size_t first, std::size_t n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += evaluator.output(first + i) * evaluator.output(first + i);
    return std::sqrt(sum);
}

Interval around(double centre, double radius) { return Interval(centre) + Interval(-radius, radius); }

}  // namespace

// Proved over the neighbourhood.
struct PaperConditions::Bounds {
    Interval a_min, a_max, eta, zeta;
};

PaperConditions::PaperConditions(const Model& model, const Run& run)
    : n_(static_cast<std::size_t>(model.n())),
      truncation_(run.options.truncation),
      e_(model.evaluator<Interval>(model.restitution(), run.parameters).output(0)),
      point_(model.evaluator(model.bounds(), run.parameters)),
      box_(model.evaluator<Interval>(model.bounds(), run.parameters)),
      surface_(model.evaluator<Interval>(model.surface(), run.parameters)) {}

// The conditions with the maxima replaced by the values at the restart: never harder to meet than the real ones, so a
// collision that fails here (with a margin for rounding) needs no proof to fail.
bool PaperConditions::hopeless(const Collision& collision) {
    put(point_, State{collision.before.q, collision.restart});
    point_.run();
    const double e = mid(e_), w = collision.speed, a = -point_.output(0);
    if (!(a > 0.0) || !(e < 1.0)) return true;
    const double time = 2.0 * e * w / (a * (1.0 - e));
    const double eta = norm(point_, 1, n_), zeta = norm(point_, 1 + n_, n_);
    const double velocity = 2.0 * e * eta / (1.0 - e) * w + zeta * time;
    constexpr double margin = 1.0 - 1e-9;
    return margin * time > truncation_.eps_t || margin * time * collision.restart.norm() > truncation_.eps_q ||
           margin * velocity > truncation_.eps_v;
}

std::optional<PaperConditions::Bounds> PaperConditions::bounds_over(const Collision& collision,
                                                                    const Truncation& neighbourhood) {
    for (std::size_t i = 0; i < n_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        box_.input(i) = around(collision.before.q[k], neighbourhood.eps_q);
        box_.input(n_ + i) = hull(around(collision.restart[k], neighbourhood.eps_v), Interval(collision.before.v[k]));
    }
    box_.run();
    std::vector<Interval> n, f;
    for (std::size_t i = 0; i < n_; ++i) {
        n.push_back(box_.output(1 + i));
        f.push_back(box_.output(1 + n_ + i));
    }
    const Interval a = -box_.output(0), eta = norm(n), zeta = norm(f);
    if (!a.is_defined() || !eta.is_defined() || !zeta.is_defined() || !(a.lo() > 0.0)) return std::nullopt;
    return Bounds{Interval(a.lo()), Interval(a.hi()), Interval(eta.hi()), Interval(zeta.hi())};
}

std::optional<Certificate> PaperConditions::prove(const Collision& collision, const Truncation& neighbourhood) {
    const auto bounds = bounds_over(collision, neighbourhood);
    if (!bounds) return std::nullopt;
    const auto& [a_min, a_max, eta, zeta] = *bounds;
    put(surface_, collision.before);
    surface_.run();
    const Interval w = abs(surface_.output(1)), one(1.0), two(2.0), e = e_;
    std::vector<Interval> g, v;
    for (std::size_t i = 0; i < n_; ++i) {
        g.push_back(surface_.output(2 + n_ + i));
        v.emplace_back(collision.restart[static_cast<Eigen::Index>(i)]);
    }
    const Interval r = a_max / a_min, e1 = e * r, e2 = e * sqrt(r);
    if (!certainly_less(e1, one)) return std::nullopt;
    const Interval beta = norm(v) + Interval(neighbourhood.eps_v);
    const bool kinetic = truncation_.reinitialization == Reinitialization::kinetic;
    // Each bound is (time, position, velocity per unit of w) times w; c_i is the tolerance over the factor.
    const Interval time = two * e / (a_min * (one - e1)), position = beta * time;
    const Interval jumps = (kinetic ? e + e2 : one + e) * eta / (one - e2);
    const Interval velocity = jumps + zeta * time + (kinetic ? Interval(0.0) : one / norm(g));

    Certificate certificate;
    certificate.conditions = Conditions::paper;
    certificate.reinitialization = truncation_.reinitialization;
    const std::array<const char*, 3> names{"c1: time", "c2: position", "c3: velocity"};
    const std::array<Interval, 3> factors{time, position, velocity};
    const std::array<double, 3> tolerances{neighbourhood.eps_t, neighbourhood.eps_q, neighbourhood.eps_v};
    certificate.certified = true;
    double closest = -1.0;
    std::array<double, 3> c{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval bound = factors[i] * w;
        c[i] = factors[i].hi() > 0.0 ? (Interval(tolerances[i]) / Interval(factors[i].hi())).lo()
                                     : std::numeric_limits<double>::infinity();
        if (!(bound.hi() < tolerances[i])) return std::nullopt;
        certificate.inequalities.push_back({names[i], w.hi(), c[i]});
        if (bound.hi() / tolerances[i] > closest) {
            closest = bound.hi() / tolerances[i];
            certificate.decisive = names[i];
        }
    }
    certificate.inequalities.push_back({"e a_max/a_min", e1.hi(), 1.0});
    certificate.inequalities.push_back({"normal acceleration", -a_min.lo(), 0.0});
    certificate.position_bound = (position * w).hi();
    certificate.velocity_bound = (velocity * w).hi();
    certificate.a_min = a_min.lo();
    certificate.a_max = a_max.hi();
    // The sharper interval for tau_inf (THEORY section 4) holds wherever -hddot stays in [a_min, a_max]; here it does.
    const Interval rebound = two * e * (one + e);
    const Interval latest = rebound / (a_min * (one - square(e) * r)) * w;
    const Interval earliest = rebound / (a_max * (one - square(e) / r)) * w;
    certificate.zeno_low = (Interval(collision.t) + Interval(earliest.lo())).lo();
    certificate.zeno_high = (Interval(collision.t) + Interval(latest.hi())).hi();
    certificate.paper = Certificate::Paper{e1.hi(), e2.hi(), beta.hi(), eta.hi(), zeta.hi(), c[0], c[1], c[2]};
    return certificate;
}

std::optional<Certificate> PaperConditions::hold(const Collision& collision) {
    if (hopeless(collision)) return std::nullopt;
    return prove(collision, truncation_);
}

std::optional<Certificate> PaperConditions::widest(const Collision& collision) {
    Truncation neighbourhood = truncation_;
    for (int doubling = 0; doubling < 60; ++doubling) {
        if (auto certificate = prove(collision, neighbourhood)) {
            certificate->below_rounding = true;
            return certificate;
        }
        neighbourhood.eps_q = std::min(1.0, 2.0 * neighbourhood.eps_q);
        neighbourhood.eps_v = std::min(1.0, 2.0 * neighbourhood.eps_v);
        neighbourhood.eps_t = std::min(1.0, 2.0 * neighbourhood.eps_t);
    }
    return std::nullopt;
}

}  // namespace achilles
