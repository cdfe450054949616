// Tests an enclosure: random members of the set of runs are simulated at a tight tolerance and must lie inside.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles::test {

struct Membership {
    Enclosure proved;
    long compared = 0, outside = 0;
    std::string first;  // the first value outside
    // Mean of enclosed width over observed width, for event times that differ between members.
    double width_over_observed = 0.0;
    int widths = 0;
};

// Compares `count` members, a quarter of them at corners of the boxes, with runs at a tolerance of 1e-13.
Membership members_of(const std::shared_ptr<const Model>& model, const achilles::EnclosureProblem& claim, int count,
                      unsigned seed);

// The default run of a system until `end` at most. If it starts in flight, each initial value has the half-width
// `half`. Each parameter has the relative half-width `of_parameters`. With a seed, the start is first changed at random
// by 1 %.
achilles::EnclosureProblem claim_around(const Model& model, double end, double half, double of_parameters,
                                        unsigned seed = 0);

}  // namespace achilles::test
