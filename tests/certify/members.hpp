// Random members of a claim, simulated nearly exactly, beside its enclosure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "enclose/enclosure.hpp"

namespace achilles::test {

struct Membership {
    Enclosure proved;
    long compared = 0, outside = 0;
    std::string first;  // that was outside
    // Of event times that members differ in: enclosed over observed width, the mean.
    double width_over_observed = 0.0;
    int widths = 0;
};

// `count` members of the claim, a quarter of them at corners, by runs at a tolerance of 1e-13.
Membership members_of(const std::shared_ptr<const Model>& model, const achilles::Claim& claim, int count,
                      unsigned seed);

// The default run of a system until `end` at most, every start within `half`, where it is in the air, and every parameter within
// a part of itself. With a seed the start is moved at random before, by a hundredth of itself.
achilles::Claim claim_around(const Model& model, double end, double half, double of_parameters, unsigned seed = 0);

}  // namespace achilles::test
