#include "certify/truncation.hpp"

#include "certify/paper.hpp"
#include "certify/sharp.hpp"

namespace achilles {

std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run) {
    if (run.options.truncation.conditions == Conditions::paper) return std::make_unique<PaperConditions>(model, run);
    return std::make_unique<SharpConditions>(model, run);
}

Interval norm(const std::vector<Interval>& x) {
    Interval sum(0.0);
    for (const Interval& entry : x) sum = sum + square(entry);
    return sqrt(sum);
}

}  // namespace achilles
