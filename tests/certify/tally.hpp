// Statistics over many trials: violated claims, and the ratio of bounds to reference values.
#pragma once

#include <array>
#include <map>
#include <string>
#include <tuple>

#include "certify/truth.hpp"

namespace achilles::test {

struct Tally {
    long certificates = 0, violations = 0, unknown = 0;  // unknown: no reference Zeno point
    // bound/actual for each kind of bound; times are counted from tau_k
    std::array<std::vector<double>, 7> ratios;
    // Two ratios concern Def. 7's own velocity bound w eps_v/c3, which may exceed the certificate's. `excursion` is its
    // ratio to the largest |v - v*| up to the Zeno point. `formula` is its ratio to the same formula with the values at
    // the restart for the maxima: the loss by the neighborhood.
    enum Ratio { latest, position, velocity, excursion, formula, shadowing, uniform };
    // Best estimates of the Zeno time: their number, and the largest error divided by the half-width of the interval.
    // An estimate inside the interval has at most 2, the midpoint at most 1.
    long estimates = 0;
    double worst_estimate = 0.0;

    void add(const Trial& trial, const CertificateCase& certified, const Model& model);
    double median(Ratio ratio) const;  // NaN without data
    double least(Ratio ratio) const;
};

// Key: conditions, reinitialization, and whether the tolerances were met.
using Tallies = std::map<std::tuple<Conditions, Reinitialization, bool>, Tally>;
void add(Tallies& tallies, const Trial& trial, const Model& model);
std::string table_head();
std::string table_rows(const std::string& system, const Tallies& tallies);

}  // namespace achilles::test
