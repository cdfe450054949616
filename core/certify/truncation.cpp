#include "certify/truncation.hpp"

#include <algorithm>
#include <cmath>

#include "certify/paper.hpp"
#include "certify/sharp.hpp"

namespace achilles {

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, const Interval& e,
                                                            std::size_t contact, ContactSet held,
                                                            ContactSet unpressed) {
    const Ground ground;
    if (run.options.truncation.conditions == Conditions::paper)
        return std::make_unique<PaperConditions>(model, run, e, contact, held, unpressed, ground);
    return std::make_unique<SharpConditions>(model, run, e, contact, held, unpressed, ground);
}

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run, std::size_t contact,
                                                            ContactSet held, ContactSet unpressed) {
    return truncation_conditions(model, run, model.restitutions(run.parameters)[contact].enclosure, contact, held,
                                 unpressed);
}

Interval instant_of(const Collision& collision, ContactTerms<Evaluator<Interval>>& contact) {
    const State& state = collision.before;
    set_state(contact, state);
    const auto around = [](double x) { return Interval(x) + Interval(-1.0, 1.0) * Interval(0x1p-53 * std::abs(x)); };
    for (Eigen::Index i = 0; i < state.q.size(); ++i) contact.input(static_cast<std::size_t>(i)) = around(state.q[i]);
    contact.clock() = around(state.t);
    contact.run();
    const double ulp = 0x1p-52 * std::abs(state.t);  // and that much at most
    const Interval d = Interval(4.0 * rad(contact.h())) / Interval(collision.speed) + Interval(ulp);
    return Interval(state.t) + Interval(-d.hi(), d.hi());
}

Interval norm(const std::vector<Interval>& x) {
    Interval sum(0.0);
    for (const Interval& entry : x) sum = sum + square(entry);
    return sqrt(sum);
}

Trend trend_at(TrendTerms<Evaluator<double>>& terms, const Collision& collision) {
    set_state(terms, collision.with(collision.tangential));
    terms.run();
    return {-terms.hddot(), -terms.rate(), -terms.by_sigma()};
}

void set_zeno_time(Certificate& certificate, double tau_k, const Wait& wait, double estimated) {
    certificate.zeno_low = (Interval(tau_k) + Interval(wait.earliest.lo())).lo();
    certificate.zeno_high = (Interval(tau_k) + Interval(wait.latest.hi())).hi();
    const double low = std::max(tau_k, certificate.zeno_low), time = tau_k + estimated;
    certificate.zeno_time = std::isfinite(time) ? std::clamp(time, low, std::max(low, certificate.zeno_high))
                                                : 0.5 * (low + certificate.zeno_high);
}

}  // namespace achilles
