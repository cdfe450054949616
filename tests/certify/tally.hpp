// Counts over many trials: violated claims, and how far the bounds are from the truth.
#pragma once

#include <array>
#include <map>
#include <string>
#include <tuple>

#include "certify/truth.hpp"

namespace achilles::test {

struct Tally {
    long certificates = 0, violations = 0, unknown = 0;  // unknown: no truth to compare with
    // bound/actual by what it is about; the time from tau_k on
    std::array<std::vector<double>, 7> ratios;
    // Of Def. 7's own velocity bound, w eps_v/c3, which the certificate's may undercut: excursion, over the largest
    // |v - v*| on the way; formula, over what it would be with the values at the restart for its maxima, so what the
    // neighbourhood costs.
    enum Ratio { latest, position, velocity, excursion, formula, shadowing, uniform };
    // Of the best estimate of the Zeno time: how many there were, and the largest error over the half width of the
    // interval. Inside the interval it is at most 2; as the middle of it, 1.
    long estimates = 0;
    double worst_estimate = 0.0;

    void add(const Trial& trial, const Certified& certified, const Model& model);
    double median(Ratio ratio) const;  // NaN without data
    double least(Ratio ratio) const;
};

// By conditions, reinitialization, and whether the tolerances were met.
using Tallies = std::map<std::tuple<Conditions, Reinitialization, bool>, Tally>;
void add(Tallies& tallies, const Trial& trial, const Model& model);
std::string table_head();
std::string table_rows(const std::string& system, const Tallies& tallies);

}  // namespace achilles::test
