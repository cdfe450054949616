#include "certify/others.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/delassus.hpp"

namespace achilles {

std::optional<Certificate::Others> others_proved(const Neighbours& neighbours, const Evaluator<Interval>& program,
                                                 ContactSet unpressed) {
    Certificate::Others others;
    const std::size_t bouncing = neighbours.bouncing.size();
    std::size_t next = bouncing;
    for (const std::size_t contact : neighbours.held) {
        const Interval hddot = program.output(next), W = program.output(next + 1);
        next += 2;
        const bool is_unpressed = unpressed.contains(contact);
        if (!(is_unpressed || certainly_negative(hddot)) || !certainly_positive(W)) return std::nullopt;
        Certificate::Others::Held held{contact, 0.0, 0.0, is_unpressed ? 0.0 : (-hddot / W).lo()};
        for (std::size_t k = 0; k < bouncing; ++k) {
            const Interval kappa = program.output(next++);
            if (!(kappa.lo() >= 0.0)) {
                if (!counts_as_zero(kappa, std::sqrt(mid(program.output(k)) / mid(W)))) return std::nullopt;
                others.rounded_zero = true;
            }
            held.transmission_low = k == 0 ? kappa.lo() : std::min(held.transmission_low, kappa.lo());
            held.transmission_high = k == 0 ? kappa.hi() : std::max(held.transmission_high, kappa.hi());
        }
        others.held.push_back(held);
    }
    for (std::size_t i = 0; i < neighbours.open.size(); ++i) {
        const Interval gap = program.output(next++);
        if (!certainly_positive(gap)) return std::nullopt;
        others.least_gap = std::min(others.least_gap.value_or(std::numeric_limits<double>::infinity()), gap.lo());
    }
    return others;
}

Interval transmission(const Neighbours& neighbours, const Evaluator<Interval>& program, std::size_t i) {
    const std::size_t bouncing = neighbours.bouncing.size();
    return program.output(bouncing + i * (2 + bouncing) + 2);
}

OthersStay::OthersStay(const Model& model, const Run& run, std::size_t contact, ContactSet held, ContactSet unpressed)
    : unpressed_(unpressed) {
    if (model.contacts() == 1) return;
    neighbours_ = &model.neighbours(contact, held);
    variables_ = model.bouncing(contact, held).variables;
    program_ = model.evaluator<Interval>(neighbours_->program, run.parameters);
}

std::optional<Certificate::Others> OthersStay::prove(const std::vector<Interval>& box) {
    for (std::size_t i = 0; i < variables_.size(); ++i) program_.input(variables_[i]) = box[i];
    program_.run();
    return others_proved(*neighbours_, program_, unpressed_);
}

}  // namespace achilles
