#include "certify/truncation.hpp"

#include <algorithm>

#include "certify/paper.hpp"
#include "certify/sharp.hpp"

namespace achilles {

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run) {
    const Ground ground;
    if (run.options.truncation.conditions == Conditions::paper)
        return std::make_unique<PaperConditions>(model, run, ground);
    return std::make_unique<SharpConditions>(model, run, ground);
}

Interval norm(const std::vector<Interval>& x) {
    Interval sum(0.0);
    for (const Interval& entry : x) sum = sum + square(entry);
    return sqrt(sum);
}

Wait wait_for_zeno(const Interval& e, const Interval& a_min, const Interval& a_max, const Interval& w) {
    const Interval one(1.0), r = a_max / a_min, rebound = Interval(2.0) * e * (one + e) * w;
    return {rebound / (a_max * (one - square(e) / r)), rebound / (a_min * (one - square(e) * r))};
}

void set_zeno_time(Certificate& certificate, double tau_k, const Wait& wait) {
    certificate.zeno_low = (Interval(tau_k) + Interval(wait.earliest.lo())).lo();
    certificate.zeno_high = (Interval(tau_k) + Interval(wait.latest.hi())).hi();
}

void name_decisive(Certificate& certificate) {
    double closest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double share = certificate.inequalities[i].left / certificate.inequalities[i].right;
        if (share > closest) certificate.decisive = certificate.inequalities[i].name;
        closest = std::max(closest, share);
    }
}

}  // namespace achilles
