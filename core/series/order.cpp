#include "series/order.hpp"

#include <type_traits>

namespace achilles {

namespace {

// Vectors of 2, 4 and 8 lanes: registers of SSE2, AVX2 and AVX-512.
using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));
using Eight = double __attribute__((vector_size(64)));

#define ACHILLES_INLINE [[gnu::always_inline]] inline

template <class Vector>
constexpr std::size_t width = sizeof(Vector) / sizeof(double);

// Rows are aligned as doubles are, not as vectors. (A vector as a result would be passed differently without AVX.)
template <class Vector>
ACHILLES_INLINE void load(Vector& v, const double* x) {
    __builtin_memcpy(&v, x, sizeof v);
}
template <class Vector>
ACHILLES_INLINE void store(const Vector& v, double* x) {
    __builtin_memcpy(x, &v, sizeof v);
}
template <class Vector>
ACHILLES_INLINE void add_product(Vector& sum, const double* x, const double* y) {
    Vector a, b;
    load(a, x);
    load(b, y);
    sum += a * b;
}

// The numbers with these indices.
template <class Vector>
ACHILLES_INLINE void gather(const double* n, const std::uint32_t* i, Vector& v) {
    if constexpr (width<Vector> == 2) {
        v = Vector{n[i[0]], n[i[1]]};
    } else if constexpr (width<Vector> == 4) {
        v = Vector{n[i[0]], n[i[1]], n[i[2]], n[i[3]]};
    } else {
        Four low, high;  // in halves: eight in a row would wait for one another
        gather(n, i, low);
        gather(n, i + 4, high);
        v = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
}

// As many lanes as the compiler shall know of, in vectors; a rest of four lanes is one of four.
template <std::size_t begin, std::size_t end, class Vector, class Part>
ACHILLES_INLINE void in_blocks(const Part& part) {
    constexpr std::size_t w = width<Vector>, vectors = (end - begin) / w, count = vectors < 4 ? vectors : 4;
    if constexpr (count > 0) part.template operator()<Vector, count>(begin);
    constexpr std::size_t next = begin + count * w;
    if constexpr (next < end) in_blocks<next, end, std::conditional_t<(end - next < w), Four, Vector>>(part);
}

// The terms of the inner sums of order k + 1 without row k.
template <class Vector, std::size_t count>
ACHILLES_INLINE void sum_older(const SeriesTables& tables, std::size_t lanes, int k, std::size_t lane) {
    const std::size_t stride = 2 * lanes;
    Vector even[count] = {}, odd[count] = {};
    const double* x = tables.rows + 2 * stride + lane;
    const double* y = tables.rows + static_cast<std::size_t>(k - 1) * stride + lanes + lane;
    int j = 2;
    constexpr std::size_t w = width<Vector>;
    for (; j + 1 < k; j += 2, x += 2 * stride, y -= 2 * stride) {
        for (std::size_t b = 0; b < count; ++b) add_product(even[b], x + b * w, y + b * w);
        for (std::size_t b = 0; b < count; ++b) add_product(odd[b], x + stride + b * w, y - stride + b * w);
    }
    if (j < k)
        for (std::size_t b = 0; b < count; ++b) add_product(even[b], x + b * w, y + b * w);
    for (std::size_t b = 0; b < count; ++b) store<Vector>(even[b] + odd[b], tables.older + lane + b * w);
}

// Order k becomes a row, and the sums get their terms with it.
template <class Vector, std::size_t count>
ACHILLES_INLINE void keep_and_sum(const SeriesTables& tables, std::size_t lanes, int k, std::size_t lane) {
    const double weight = static_cast<double>(k - 1), inverse = 1.0 / static_cast<double>(k + 1);
    const double* const first = tables.rows + 2 * lanes + lane;
    double* const row = tables.rows + 2 * lanes * static_cast<std::size_t>(k) + lane;
    for (std::size_t b = 0; b < count; ++b, lane += width<Vector>) {
        const std::size_t o = b * width<Vector>;
        Vector weighted, x, y;
        load(weighted, tables.weighted + lane);
        gather(tables.now, tables.left + lane, x);
        gather(tables.now, tables.right + lane, y);
        x *= 1.0 + weight * weighted;
        store(x, row + o);
        store(y, row + lanes + o);
        Vector left, sum;
        load(left, first + o);
        sum = left * y;
        if (k > 1) {
            Vector right, older;
            load(right, first + lanes + o);
            load(older, tables.older + lane);
            sum = older + (sum + x * right);
        }
        store<Vector>(sum * (inverse * weighted + (1.0 - weighted)), tables.now + tables.sums + lane);
    }
}

void run_rules(const SeriesTables& tables) {
    double* const n = tables.now;
    if (tables.run_rules != nullptr) return tables.run_rules(n, tables.rules);
    const SeriesRule* const end = tables.rules + tables.rule_count;
    for (const SeriesRule* rule = tables.rules; rule != end; ++rule)
        n[rule->result] = (rule->f[2] * n[rule->w] + rule->f[1] * n[rule->y]) + rule->f[0] * n[rule->x];
}

// Lanes in blocks that the compiler knows; more than these in blocks of eight.
constexpr std::size_t most_known = 32;

template <std::size_t lanes, class Vector, class Part>
ACHILLES_INLINE void for_all(std::size_t count, const Part& part) {
    if constexpr (lanes > 0) {
        in_blocks<0, lanes, Vector>(part);
    } else {
        std::size_t lane = 0;
        for (; lane + 8 <= count; lane += 8) part.template operator()<Vector, 8 / width<Vector>>(lane);
        if (lane < count) part.template operator()<Four, 1>(lane);
    }
}

template <std::size_t lanes, class Vector>
ACHILLES_INLINE void order(const SeriesTables& tables, int k) {
    const std::size_t count = lanes > 0 ? lanes : tables.lanes;
    for_all<lanes, Vector>(
        count, [&]<class V, std::size_t blocks>(std::size_t lane)
                   __attribute__((always_inline)) { sum_older<V, blocks>(tables, count, k, lane); });
    run_rules(tables);
    for_all<lanes, Vector>(
        count, [&]<class V, std::size_t blocks>(std::size_t lane)
                   __attribute__((always_inline)) { keep_and_sum<V, blocks>(tables, count, k, lane); });
}

template <std::size_t lanes>
void portable(const SeriesTables& tables, int k) {
    order<lanes, Two>(tables, k);
}
#if defined(__x86_64__)
template <std::size_t lanes>
__attribute__((target("avx2"))) void avx2(const SeriesTables& tables, int k) {
    order<lanes, Four>(tables, k);
}
template <std::size_t lanes>
__attribute__((target("avx512f,avx512vl"))) void avx512(const SeriesTables& tables, int k) {
    order<lanes, Eight>(tables, k);
}
#endif

enum class Target { portable, avx2, avx512 };

template <std::size_t lanes>
SeriesOrder of_target(Target target) {
#if defined(__x86_64__)
    if (target == Target::avx512) return avx512<lanes>;
    if (target == Target::avx2) return avx2<lanes>;
#endif
    return portable<lanes>;
}

// The one for so many lanes.
template <std::size_t known = most_known>
SeriesOrder for_lanes(Target target, std::size_t lanes) {
    if constexpr (known > 0) {
        return lanes == known ? of_target<known>(target) : for_lanes<known - 4>(target, lanes);
    } else {
        return of_target<0>(target);
    }
}

}  // namespace

SeriesOrderVersions series_order_versions(std::size_t lanes) {
    SeriesOrderVersions versions;
    const auto add = [&](std::string_view name, Target target) {
        versions.version[versions.count++] = {name, for_lanes(target, lanes)};
    };
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) add("avx512", Target::avx512);
    if (__builtin_cpu_supports("avx2")) add("avx2", Target::avx2);
#endif
    add("portable", Target::portable);
    return versions;
}

}  // namespace achilles
