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
    std::array<std::vector<double>, 5> ratios;
    enum Ratio { latest, position, velocity, excursion, shadowing };

    void add(const Trial& trial, const Certified& certified);
    double median(Ratio ratio) const;  // NaN without data
};

// By conditions, re-initialisation, and whether the tolerances were met.
using Tallies = std::map<std::tuple<Conditions, Reinitialization, bool>, Tally>;
void add(Tallies& tallies, const Trial& trial);
std::string table_head();
std::string table_rows(const std::string& system, const Tallies& tallies);

}  // namespace achilles::test
