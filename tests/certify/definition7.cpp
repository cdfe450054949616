#include "certify/definition7.hpp"

#include <cmath>

namespace achilles::test {

namespace {

double mag(double x) { return std::abs(x); }

// Norm of a vector with n entries; for intervals, its upper end.
template <class Entry>
double norm(std::size_t n, const Entry& entry) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += std::pow(mag(entry(i)), 2);
    return std::sqrt(sum);
}

// eta = |n| and zeta = |f| at the current input of `terms`.
template <class Terms>
std::pair<double, double> eta_and_zeta(const Terms& terms, std::size_t n) {
    return {norm(n, [&](std::size_t i) { return terms.impulse_direction(i); }),
            norm(n, [&](std::size_t i) { return terms.acceleration(i); })};
}

}  // namespace

Definition7::Definition7(const Model& model, const Run& run, std::size_t contact, Mode mode)
    : dof_(static_cast<std::size_t>(model.dof())),
      kinetic_(run.options.truncation.reinitialization == Reinitialization::kinetic),
      e_(model.evaluator(model.restitution(contact), run.parameters).output(0)),
      hddot_(model.evaluator<Interval>(model.bouncing(contact, mode).hddot, run.parameters),
             model.evaluator<Interval>(model.bouncing(contact, mode).gradient, run.parameters),
             model.bouncing(contact, mode).variables),
      box_(model.evaluator<Interval>(model.programs_of(contact, mode).definition7_terms, run.parameters)),
      point_(model.evaluator(model.programs_of(contact, mode).definition7_terms, run.parameters)),
      surface_(model.evaluator(model.programs_of(contact, mode).contact_terms, run.parameters)) {}

Definition7::Factors Definition7::factors(const Collision& collision, const Maxima& m) {
    set_state(surface_, collision.before);
    surface_.run();
    const double e1 = e_ * m.a_max / m.a_min, e2 = e_ * std::sqrt(m.a_max / m.a_min);
    const double time = 2 * e_ / (m.a_min * (1 - e1));
    const double velocity = kinetic_ ? (e_ + e2) * m.eta / (1 - e2) + m.zeta * time
                                     : (1 + e_) * m.eta / (1 - e2) + m.zeta * time +
                                           1 / norm(dof_, [&](std::size_t i) { return surface_.gradient(i); });
    return {time, m.beta * time, velocity};
}

std::optional<Definition7::Factors> Definition7::over(const Collision& collision, double eps_q, double eps_v) {
    std::vector<Interval> box;
    for (const double q : collision.before.q) box.emplace_back(q - eps_q, q + eps_q);
    for (std::size_t i = 0; i < dof_; ++i) {
        const double v = collision.restart[static_cast<Eigen::Index>(i)];
        const double before = collision.before.v[static_cast<Eigen::Index>(i)];
        box.emplace_back(std::min(v - eps_v, before), std::max(v + eps_v, before));
    }
    for (std::size_t i = 0; i < 2 * dof_; ++i) box_.input(i) = box[i];
    box_.run();
    box.emplace_back(0.0);
    const Interval a = -hddot_.over(box);
    if (!a.is_defined() || !(a.lo() > 0.0) || !(e_ * a.hi() / a.lo() < 1.0)) return std::nullopt;
    const auto [eta, zeta] = eta_and_zeta(box_, dof_);
    return factors(collision, {a.lo(), a.hi(), collision.restart.norm() + eps_v, eta, zeta});
}

Definition7::Factors Definition7::at(const Collision& collision) {
    set_state(point_, collision.with(collision.restart));
    point_.run();
    const double a = -point_.hddot();
    const auto [eta, zeta] = eta_and_zeta(point_, dof_);
    return factors(collision, {a, a, collision.restart.norm(), eta, zeta});
}

}  // namespace achilles::test
