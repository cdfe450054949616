// One order of what series rise by in eight directions (slope_plan.hpp), in vectors of so many bytes; all give the same bits.
#pragma once

#include <span>

#include "number/lanes.hpp"
#include "series/lane_kinds.hpp"
#include "series/slope_plan.hpp"

namespace achilles {

// A number times slopes: not made lanes before, which costs a sum and the sign of a zero.
template <std::size_t Bytes>
[[gnu::always_inline]] inline Lanes<Bytes> times(double x, const Lanes<Bytes>& b) {
    Lanes<Bytes> result;
    for (std::size_t p = 0; p < sizeof(Eight) / Bytes; ++p) result.part[p] = x * b.part[p];
    return result;
}
// a += x b'
template <std::size_t Bytes>
[[gnu::always_inline]] inline void add_product(Lanes<Bytes>& a, double x, const Lanes<Bytes>& b) {
    for (std::size_t p = 0; p < sizeof(Eight) / Bytes; ++p) a.part[p] += x * b.part[p];
}

// r = a^b, b a number:  a r. = b r a.  by orders, differentiated:
//     k a_0 r'_k = sum_j (b j - (k-j)) r_{k-j} a'_j + sum_{j<k} (b (k-j) - j) a_{k-j} r'_j
template <std::size_t Bytes>
Lanes<Bytes> power_slope(const SlopePlan::Rule& rule, const SlopeTables& tables, std::size_t k) {
    using Slopes = Lanes<Bytes>;
    const auto r = [&](std::size_t j) { return tables.known(rule.own, j); };
    const auto a = [&](std::size_t j) { return tables.known(rule.divisor, j); };
    const Eight *const r_slope = tables.rising(rule.own), *const a_slope = tables.rising(rule.divisor);
    const double b = tables.known(rule.leading, 0);
    Slopes sum = 0.0;
    for (std::size_t j = 0; j <= k; ++j) {
        const double from_start = static_cast<double>(j), to_end = static_cast<double>(k - j);
        add_product(sum, (b * from_start - to_end) * r(k - j), Slopes(a_slope[j]));
        if (j < k) add_product(sum, (b * to_end - from_start) * a(k - j), Slopes(r_slope[j]));
    }
    return times(1.0 / (static_cast<double>(k) * a(0)), sum);
}

// The terms of lower orders come first, product by product, then those with order k.
template <std::size_t Bytes>
[[gnu::always_inline]] inline Lanes<Bytes> slope_of(const SlopePlan::Rule& rule, const double* scales,
                                                    const SlopeTables& tables, std::size_t k) {
    using Slopes = Lanes<Bytes>;
    Slopes sum = 0.0;
    const std::span products(rule.products.data(), rule.count);
    for (std::size_t j = 1; j <= k; ++j)
        for (const auto& [u, x] : products) add_product(sum, tables.known(u, j), Slopes(tables.rising(x)[k - j]));
    for (const auto& [u, x] : products)
        if (x != rule.own) add_product(sum, tables.known(u, 0), Slopes(tables.rising(x)[k]));
    if (rule.divides || rule.by != 1.0) sum = times(scales[0], sum);
    if (rule.lead != 0.0) add_product(sum, scales[1], Slopes(tables.rising(rule.leading)[k]));
    return sum;
}

// coefficient * series: what order k rises by.
template <std::size_t Bytes>
[[gnu::always_inline]] inline Lanes<Bytes> multiple_of(std::uint32_t coefficient, std::uint32_t series,
                                                       const SlopeTables& tables) {
    using Slopes = Lanes<Bytes>;
    const Slopes rise(tables.rise[series]);
    if (coefficient == 0) return rise;
    const SlopeCoefficient& c = tables.coefficients[coefficient];
    return times(c.value, rise) + times(tables.now[series], Slopes(c.rise));
}
template <std::size_t Bytes>
[[gnu::always_inline]] inline Lanes<Bytes> sum_of(const SlopePlan::Rule& rule, const SlopeTables& tables) {
    const auto term = [&](std::size_t i) { return multiple_of<Bytes>(rule.coefficient[i], rule.series[i], tables); };
    std::size_t i = 0;
    while (i < 3 && rule.series[i] == 0) ++i;
    if (i == 3) return 0.0;
    Lanes<Bytes> sum = term(i);
    while (++i < 3)
        if (rule.series[i] != 0) sum += term(i);
    return sum;
}

// What order k of a series rises by, and of the factors that are made of it.
template <std::size_t Bytes>
[[gnu::always_inline]] inline void give(const SlopePlan& plan, const SlopeTables& tables, std::size_t k,
                                        std::uint32_t series, const Lanes<Bytes>& rise) {
    tables.rise[series] = rise;
    for (std::uint32_t i = plan.first_factor[series]; i < plan.first_factor[series + 1]; ++i)
        tables.rising(i)[k] = multiple_of<Bytes>(plan.factors[i].scale, series, tables);
}

template <std::size_t Bytes>
void make_rules(const SlopePlan& plan, const SlopeTables& tables, std::size_t k) {
    using Kind = SlopePlan::Rule::Kind;
    for (std::size_t i = 0; i < plan.rules.size(); ++i) {
        const SlopePlan::Rule& rule = plan.rules[i];
        Lanes<Bytes> rise;
        switch (rule.kind) {
            case Kind::sum:
                rise = sum_of<Bytes>(rule, tables);
                break;
            case Kind::product:
                rise = slope_of<Bytes>(rule, tables.scales + 2 * i, tables, k);
                break;
            case Kind::power:
                rise = power_slope<Bytes>(rule, tables, k);
                break;
        }
        give<Bytes>(plan, tables, k, rule.result, rise);
    }
}

template <std::size_t Bytes>
void SlopeKind<Bytes>::make_order(const SlopePlan& plan, const SlopeTables& tables, const SlopeOrderCode* code,
                                  std::size_t k) {
    if (code != nullptr) return code->make_order(tables, k);
    using Slopes = Lanes<Bytes>;
    const std::size_t n = plan.coordinates();
    Eight* const row = tables.states + k * plan.states();
    const Eight* const below = row - plan.states();
    const double inverse = 1.0 / static_cast<double>(k);
    for (std::size_t i = 0; k > 1 && i < n; ++i) {
        row[i] = times(inverse, Slopes(below[n + i]));
        row[n + i] = times(inverse, Slopes(tables.rise[plan.outputs[i]]));
    }
    for (std::size_t i = 0; i < 2 * n; ++i)
        give<Bytes>(plan, tables, k, static_cast<std::uint32_t>(1 + i), Slopes(row[i]));
    make_rules<Bytes>(plan, tables, k);
    for (std::size_t i = 0; i < plan.events; ++i) row[2 * n + i] = Slopes(tables.rise[plan.outputs[n + i]]);
}

template <std::size_t Bytes>
void SlopeKind<Bytes>::make_hidden(const SlopePlan& plan, const SlopeTables& tables) {
    for (std::size_t i = 0; i < plan.rules.size(); ++i)
        if (const SlopePlan::Rule& rule = plan.rules[i]; rule.hidden)
            tables.rising(rule.own)[0] = slope_of<Bytes>(rule, tables.scales + 2 * i, tables, 0);
}

template <std::size_t Bytes>
bool SlopeKind<Bytes>::any_above(const Eight* slopes, const Eight* limits, std::size_t count, double weight) {
    using Slopes = Lanes<Bytes>;
    Mask<Bytes> above(false);
    for (std::size_t i = 0; i < count; ++i) above = above | (times(weight, abs(Slopes(slopes[i]))) > Slopes(limits[i]));
    return any(above);
}

template <std::size_t Bytes>
void SlopeKind<Bytes>::add_up(const Eight* column, std::size_t width, const double* weights, int first, int last,
                              Eight* result) {
    using Slopes = Lanes<Bytes>;
    Slopes even = 0.0, odd = 0.0;
    const auto row = [&](int k) { return Slopes(column[static_cast<std::size_t>(k) * width]); };
    int k = first;
    for (; k < last; k += 2) {
        add_product(even, weights[k], row(k));
        add_product(odd, weights[k + 1], row(k + 1));
    }
    if (k == last) add_product(even, weights[k], row(k));
    *result = even + odd;
}

}  // namespace achilles
