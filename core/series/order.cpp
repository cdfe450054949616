#include "series/order.hpp"

#include <cmath>

namespace achilles {

namespace {

constexpr std::size_t block = 4;  // lanes that are summed together

// The terms of the inner sums of order k + 1 without row k.
void sum_older(const SeriesPlan& plan, const SeriesTables& tables, std::size_t k, std::size_t lane, double* older) {
    const std::size_t stride = plan.row();
    double even[block] = {}, odd[block] = {};
    const double* x = tables.rows + 2 * stride + lane;
    const double* y = tables.rows + (k - 1) * stride + plan.lanes + lane;
    std::size_t j = 2;
    for (; j + 1 < k; j += 2, x += 2 * stride, y -= 2 * stride) {
        for (std::size_t i = 0; i < block; ++i) even[i] += x[i] * y[i];
        for (std::size_t i = 0; i < block; ++i) odd[i] += (x + stride)[i] * (y - stride)[i];
    }
    if (j < k)
        for (std::size_t i = 0; i < block; ++i) even[i] += x[i] * y[i];
    for (std::size_t i = 0; i < block; ++i) older[lane + i] = even[i] + odd[i];
}

double value_of(const SeriesRule& rule, const SeriesFactors& factors, const double* n) {
    const auto term = [&](std::size_t i, std::uint32_t operand) {
        return (rule.known[i] != 0 ? rule.known[i] : factors[i]) * n[operand];
    };
    double value = rule.w != 0 ? term(2, rule.w) : 0.0;
    if (rule.y != 0) value = rule.w != 0 ? value + term(1, rule.y) : term(1, rule.y);
    if (rule.x != 0) value = rule.w != 0 || rule.y != 0 ? value + term(0, rule.x) : term(0, rule.x);
    return value;
}

// Order k becomes a row, and the sum gets its terms with it.
void keep_and_sum(const SeriesPlan& plan, const SeriesTables& tables, std::size_t k, std::size_t lane, double older) {
    const double* const first = tables.rows + plan.row() + lane;
    double* const row = tables.rows + plan.row() * k + lane;
    const bool weighted = lane < plan.weighted;
    const double x = row[0] = tables.now[plan.left[lane]] * (weighted ? static_cast<double>(k) : 1.0);
    const double y = row[plan.lanes] = tables.now[plan.right[lane]];
    double sum = first[0] * y;
    if (k > 1) sum = older + (sum + x * first[plan.lanes]);
    tables.now[plan.series + lane] = sum * (weighted ? 1.0 / static_cast<double>(k + 1) : 1.0);
}

}  // namespace

void make_order(const SeriesPlan& plan, const SeriesTables& tables, int order) {
    const auto k = static_cast<std::size_t>(order);
    double* const older = tables.now + plan.series + plan.lanes;
    for (std::size_t lane = 0; lane < plan.lanes; lane += block) sum_older(plan, tables, k, lane, older);
    for (std::size_t i = 0; i < plan.rules.size(); ++i)
        tables.now[plan.rules[i].result] = value_of(plan.rules[i], tables.factors[i], tables.now);
    for (std::size_t lane = 0; lane < plan.lanes; ++lane) keep_and_sum(plan, tables, k, lane, older[lane]);
}

int make_orders(const SeriesPlan& plan, const SeriesTables& tables, SeriesMotion& motion, int k, int last) {
    const std::size_t n = plan.coordinates(), width = plan.states();
    double* const now = tables.now;
    for (;; ++k) {
        const double* const below = motion.row;
        double* const row = motion.row += width;
        const double inverse = 1.0 / static_cast<double>(k);
        for (std::size_t i = 0; i < n; ++i) {
            now[1 + i] = row[i] = inverse * below[n + i];
            now[1 + n + i] = row[n + i] = inverse * now[plan.outputs[i]];
        }
        make_order(plan, tables, k);
        row[2 * n] = now[plan.outputs[n]];
        motion.largest += width;
        motion.power *= motion.target;
        if (k >= last || !(motion.power * std::abs(*motion.largest) > 1.0)) return k;
    }
}

}  // namespace achilles
