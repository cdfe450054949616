// One order of all series of a program: the inner loop of the Taylor method.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace achilles {

// Order k of series `result` is (f[2] w_k + f[1] y_k) + f[0] x_k: what is known last comes last. An operand is a series
// or an inner sum.
struct SeriesRule {
    std::uint32_t result = 0, x = 0, y = 0, w = 0;
    double f[3] = {};
};

// Runs rules one after the other on the numbers in `now`.
using RunRules = void (*)(double* now, const SeriesRule* rules);

// What the loop reads and writes. There are `lanes` inner sums, a multiple of 4; those of no use sum zeros.
struct SeriesTables {
    const SeriesRule* rules = nullptr;
    std::size_t rule_count = 0;
    RunRules run_rules = nullptr;  // the rules as machine code, if there is some
    double* now = nullptr;         // order k: the series, and from `sums` on the inner sums
    std::size_t sums = 0;
    std::size_t lanes = 0;
    const std::uint32_t* left = nullptr;  // of each lane: the series of its left factor, and of its right one
    const std::uint32_t* right = nullptr;
    const double* weighted = nullptr;  // of each lane: 1 where the sum is weighted, else 0
    double* rows = nullptr;            // row j >= 1 starts at 2 j lanes: the left factors of all sums, the right ones
    double* older = nullptr;           // a place for `lanes` numbers
};

// Makes order k >= 1 of all series, where order k of the inputs and the inner sums of order k stand in `now`, and then
// the inner sums of order k + 1: sum_{0<j<=k} x_j y_{k+1-j}, or of j x_j y_{k+1-j}/(k+1) where it is weighted. All but
// the two terms with row k are added up before the rules, so that the processor can do both at once. Every lane adds
// its terms in the same order, and no product is fused into a sum, so that all versions give the same bits.
using SeriesOrder = void (*)(const SeriesTables& tables, int k);

struct SeriesOrderVersion {
    std::string_view name;  // "avx512", "avx2", "portable"
    SeriesOrder function;
};

// The versions for so many lanes that this processor can run, fastest first; the portable one is last.
struct SeriesOrderVersions {
    SeriesOrderVersion version[3];
    std::size_t count = 0;
};
SeriesOrderVersions series_order_versions(std::size_t lanes);

}  // namespace achilles
