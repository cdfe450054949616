// Enclosures compared with multiprecision references.
#pragma once

#include <gtest/gtest.h>

#include "certify/execution.hpp"
#include "core/systems.hpp"
#include "enclose/enclosure.hpp"

namespace achilles::test {

inline bool contains(const Interval& x, const Real& y) { return Real(x.lo()) <= y && y <= Real(x.hi()); }
inline bool contains(const Intervals& box, const Reals& point) {
    bool inside = box.size() == point.size();
    for (std::size_t i = 0; inside && i < box.size(); ++i) inside = contains(box[i], point[i]);
    return inside;
}
inline double widest(const Intervals& box) {
    double result = 0.0;
    for (const Interval& entry : box) result = std::max(result, width(entry));
    return result;
}

// The paper's problem as in fig4.json: the pendulum's angles are not doubles.
inline achilles::EnclosureProblem problem_of(const Problem& problem, const Model& model) {
    achilles::EnclosureProblem claim = achilles::problem_of(model.default_run());
    claim.run.options.end_time = 20.0;
    if (problem.key == "double_pendulum")
        claim.q = {Interval::pi() / Interval(6.0), Interval::pi() * Interval(25.0) / Interval(180.0)};
    return claim;
}

// The run's numbers, each with an interval of this half-width around it.
inline achilles::EnclosureProblem widened(const Run& run, double half) {
    achilles::EnclosureProblem claim = achilles::problem_of(run);
    inflate(claim, half);
    return claim;
}

}  // namespace achilles::test
