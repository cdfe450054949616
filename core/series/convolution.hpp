// The inner sums of all convolutions of a series program at one order: its inner loop.
#pragma once

#include <cstddef>
#include <string_view>

namespace achilles {

// One lane an inner sum: sums[l] = sum_{0<j<k} X_j[l] Y_{k-j}[l] for the lanes l < lanes, a multiple of 8. Row j starts
// at rows + 2 j lanes and holds X_j[0 .. lanes), Y_j[0 .. lanes). Orders come one after the other from k = 1 on. Of the
// sum for order k only the two terms with row k - 1 are left to add when that row is there: `older` holds the others,
// and receives those of order k + 1, which the processor adds up while it runs the rules. Every lane adds its terms in
// the same order, and no product is fused into a sum, so that all versions give the same bits.
using InnerSums = void (*)(const double* rows, std::size_t lanes, int k, double* older, double* sums);

struct InnerSumsVersion {
    std::string_view name;  // "avx512", "avx2", "portable"
    InnerSums function;
};

// The versions this processor can run, fastest first; the portable one is last.
struct InnerSumsVersions {
    InnerSumsVersion version[3];
    std::size_t count = 0;
};
InnerSumsVersions inner_sums_versions();

// The fastest one.
InnerSums inner_sums();

}  // namespace achilles
