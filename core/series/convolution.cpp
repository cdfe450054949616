#include "series/convolution.hpp"

namespace achilles {

namespace {

// Eight lanes: one AVX-512 register, two of AVX2, four of SSE2. The compiler splits it as the target needs.
// Rows are aligned as doubles are. GCC keeps that with the alias, clang only with a typedef.
#if defined(__clang__)
typedef double Lanes __attribute__((vector_size(64), aligned(8)));  // NOLINT(modernize-use-using)
#else
using Lanes = double __attribute__((vector_size(64), aligned(8)));
#endif

template <std::size_t blocks>
[[gnu::always_inline]] inline void sum_blocks(const double* rows, std::size_t lanes, int k, double* older,
                                              double* sums) {
    const auto add = [&](int j, int order, Lanes* sum) __attribute__((always_inline)) {
        const auto* const x = reinterpret_cast<const Lanes*>(rows + 2 * lanes * static_cast<std::size_t>(j));
        const auto* const y =
            reinterpret_cast<const Lanes*>(rows + 2 * lanes * static_cast<std::size_t>(order - j) + lanes);
        for (std::size_t b = 0; b < blocks; ++b) sum[b] += x[b] * y[b];
    };
    Lanes total[blocks] = {}, even[blocks] = {}, odd[blocks] = {};
    if (k > 3)
        for (std::size_t b = 0; b < blocks; ++b) total[b] = reinterpret_cast<const Lanes*>(older)[b];
    if (k > 1) add(1, k, total);
    if (k > 2) add(k - 1, k, total);
    for (std::size_t b = 0; b < blocks; ++b) reinterpret_cast<Lanes*>(sums)[b] = total[b];

    int j = 2;
    for (; j + 1 < k; j += 2) {
        add(j, k + 1, even);
        add(j + 1, k + 1, odd);
    }
    if (j < k) add(j, k + 1, even);
    for (std::size_t b = 0; b < blocks; ++b) reinterpret_cast<Lanes*>(older)[b] = even[b] + odd[b];
}

[[gnu::always_inline]] inline void sum_all(const double* rows, std::size_t lanes, int k, double* older, double* sums) {
    std::size_t lane = 0;
    // Offsets in lanes move rows and sums together: the row length stays.
    for (; lane + 24 <= lanes; lane += 24) sum_blocks<3>(rows + lane, lanes, k, older + lane, sums + lane);
    if (lane + 16 == lanes) sum_blocks<2>(rows + lane, lanes, k, older + lane, sums + lane);
    if (lane + 8 == lanes) sum_blocks<1>(rows + lane, lanes, k, older + lane, sums + lane);
}

void portable(const double* rows, std::size_t lanes, int k, double* older, double* sums) {
    sum_all(rows, lanes, k, older, sums);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void avx2(const double* rows, std::size_t lanes, int k, double* older, double* sums) {
    sum_all(rows, lanes, k, older, sums);
}
__attribute__((target("avx512f"))) void avx512(const double* rows, std::size_t lanes, int k, double* older,
                                               double* sums) {
    sum_all(rows, lanes, k, older, sums);
}
#endif

}  // namespace

InnerSumsVersions inner_sums_versions() {
    InnerSumsVersions versions;
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f")) versions.version[versions.count++] = {"avx512", avx512};
    if (__builtin_cpu_supports("avx2")) versions.version[versions.count++] = {"avx2", avx2};
#endif
    versions.version[versions.count++] = {"portable", portable};
    return versions;
}

InnerSums inner_sums() {
    static const InnerSums fastest = inner_sums_versions().version[0].function;
    return fastest;
}

}  // namespace achilles
