#include "certify/truncation.hpp"

#include <algorithm>
#include <cmath>

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

Trend trend_at(Evaluator<double>& program, const Collision& collision) {
    set_state(program, State{collision.before.q, collision.tangential});
    program.run();
    return {-program.output(0), -program.output(1), -program.output(2)};
}

void set_zeno_time(Certificate& certificate, double tau_k, const Wait& wait, double estimated) {
    certificate.zeno_low = (Interval(tau_k) + Interval(wait.earliest.lo())).lo();
    certificate.zeno_high = (Interval(tau_k) + Interval(wait.latest.hi())).hi();
    const double low = std::max(tau_k, certificate.zeno_low), time = tau_k + estimated;
    certificate.zeno_time = std::isfinite(time) ? std::clamp(time, low, std::max(low, certificate.zeno_high))
                                                : 0.5 * (low + certificate.zeno_high);
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
