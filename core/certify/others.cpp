#include "certify/others.hpp"

#include <algorithm>
#include <limits>

namespace achilles {

namespace {

// Intervals cannot decide kappa = 0: what contains it and is narrower than 64 ulp counts as 0 (theory-gaps.md 8).
bool is_not_negative(const Interval& kappa) {
    constexpr double narrow = 64 * 0x1p-52;
    return kappa.lo() >= 0.0 || (kappa.hi() >= 0.0 && width(kappa) <= narrow);
}

}  // namespace

std::optional<Certificate::Others> others_proved(const Evaluator<Interval>& program,
                                                 const std::vector<std::size_t>& held, std::size_t open,
                                                 std::size_t bouncing) {
    Certificate::Others others;
    std::size_t next = 0;
    for (const std::size_t contact : held) {
        const Interval hddot = program.output(next), W = program.output(next + 1);
        Interval kappa = program.output(next + 2);
        for (std::size_t k = 1; k < bouncing; ++k) kappa = hull(kappa, program.output(next + 2 + k));
        next += 2 + bouncing;
        if (!certainly_negative(hddot) || !certainly_positive(W) || !is_not_negative(kappa)) return std::nullopt;
        others.held.push_back({contact, kappa.lo(), kappa.hi(), (-hddot / W).lo()});
    }
    for (std::size_t i = 0; i < open; ++i) {
        const Interval gap = program.output(next++);
        if (!certainly_positive(gap)) return std::nullopt;
        others.least_gap = std::min(others.least_gap.value_or(std::numeric_limits<double>::infinity()), gap.lo());
    }
    return others;
}

OthersStay::OthersStay(const Model& model, const Run& run, std::size_t contact, ContactSet held) {
    if (model.contacts() == 1) return;
    neighbours_ = &model.neighbours(contact, held);
    variables_ = model.bouncing(contact, held).variables;
    program_ = model.evaluator<Interval>(neighbours_->program, run.parameters);
}

std::optional<Certificate::Others> OthersStay::prove(const std::vector<Interval>& box) {
    for (std::size_t i = 0; i < variables_.size(); ++i) program_.input(variables_[i]) = box[i];
    program_.run();
    return others_proved(program_, neighbours_->held, neighbours_->open.size(), 1);
}

}  // namespace achilles
