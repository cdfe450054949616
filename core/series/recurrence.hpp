// The series of a program over any number type: their start, and one order after the other.
#pragma once

#include <cmath>
#include <limits>

#include "number/angle.hpp"
#include "number/inner_loops.hpp"
#include "series/order.hpp"
#include "series/series.hpp"

namespace achilles {

// Start of a series program: order 0, and the factors of its rules.

template <class Scalar>
Scalar function_value(Operation function, const Scalar& a) {
    using std::acos, std::asin, std::atan, std::log;
    switch (function) {
        case Operation::log:
            return log(a);
        case Operation::asin:
            return asin(a);
        case Operation::acos:
            return acos(a);
        case Operation::atan:
            return atan(a);
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

template <class Scalar>
Scalar combined(Operation operation, const Scalar& a, const Scalar& b) {
    switch (operation) {
        case Operation::add:
            return a + b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::negate:
            return -a;
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

// Evaluates what depends on parameters only.
template <class Scalar>
void SeriesProgram::fix(const Scalar* registers, Scalar* coefficients, std::array<Scalar, 3>* factors) const {
    coefficients[0] = 1.0;
    for (std::size_t i = 1; i < coefficients_.size(); ++i) {
        const Coefficient& c = coefficients_[i];
        coefficients[i] = c.operation == Operation::number
                              ? registers[c.a]
                              : combined<Scalar>(c.operation, coefficients[c.a], coefficients[c.b]);
    }
    for (const Combination& c : combinations_)
        for (std::size_t i = 0; i < 3; ++i) factors[c.rule][i] = coefficients[c.coefficient[i]];
}

// The program has computed order 0 of its own registers z. This adds the hidden registers and the factors of the rules.
template <class Scalar>
void SeriesProgram::start(Scalar* z, const Scalar* coefficients, std::array<Scalar, 3>* factors) const {
    using std::cosh, std::exp, std::pow, std::sinh, std::sqrt, std::tan, std::tanh;
    for (const Seed& seed : seeds_) {
        const Scalar a = z[seed.a.value], b = z[seed.b.value];
        const Scalar by_a = coefficients[seed.a.scale], by_b = coefficients[seed.b.scale];
        const double sign = seed.sign;
        std::array<Scalar, 3>* const rule = factors + seed.rule;
        Scalar& r = z[seed.result.value];
        const bool hidden = seed.result.value >= hidden_;
        switch (seed.kind) {
            case Kind::multiply:
                if (hidden) r = a * b;
                rule[0] = {a * by_b, b * by_a, by_a * by_b};
                break;
            case Kind::square:
                if (hidden) r = a * a;
                rule[0] = {2.0 * a * by_a, 0.0, by_a * by_a};
                break;
            case Kind::unit_and_square:
                if (hidden) r = 1.0 + sign * (a * a);
                rule[0] = {sign * 2.0 * a * by_a, 0.0, sign * by_a * by_a};
                break;
            case Kind::divide: {
                if (hidden) r = sign < 0.0 ? 1.0 / b : a / b;
                const Scalar inverse = 1.0 / b;
                rule[0] = {by_a * inverse, -(r * by_b * inverse), -(by_b * inverse)};
                break;
            }
            case Kind::sqrt: {
                if (hidden) r = sqrt(a);
                const Scalar inverse = 0.5 / r;
                rule[0] = {by_a * inverse, 0.0, -inverse};
                break;
            }
            case Kind::exp:
                if (hidden) r = exp(a);
                rule[0] = {by_a * r, 0.0, by_a};
                break;
            case Kind::sin_cos: {
                Scalar& c = z[seed.partner.value];
                if (sign < 0.0) {
                    if (hidden || seed.partner.value >= hidden_) sine_and_cosine(a, r, c);
                } else {
                    if (hidden) r = sinh(a);
                    if (seed.partner.value >= hidden_) c = cosh(a);
                }
                rule[0] = {by_a * c, 0.0, by_a};
                rule[1] = {sign * by_a * r, 0.0, sign * by_a};
                break;
            }
            case Kind::tangent: {
                if (hidden) r = sign > 0.0 ? tan(a) : tanh(a);
                const Scalar w = z[seed.partner.value] = 1.0 + sign * (r * r);
                rule[0] = {by_a * w, 0.0, by_a};
                rule[1] = {sign * 2.0 * r, 0.0, sign};
                break;
            }
            case Kind::integral_of_ratio: {
                if (hidden) r = function_value(seed.function, a);
                const Scalar inverse = 1.0 / b;
                rule[0] = {sign * by_a * inverse, 0.0, -(by_b * inverse)};
                break;
            }
            case Kind::power: {
                // a p' = e a' p:  a_0 p_k = e (a_k p_0 + sum j a_j p_{k-j}/k) - sum j p_j a_{k-j}/k
                if (hidden) r = pow(a, b);
                const Scalar inverse = by_a / a;
                rule[0] = {b * r * inverse, b * inverse, -inverse};
                break;
            }
        }
    }
}

// This part computes one order of all series of a program, over any number type. All machine code must give the same
// results to the last bit.
//
// On entry, `now` holds order k >= 1 of the inputs and the inner sums of order k. Computes order k of all series, then
// the inner sums of order k + 1: sum_{0<j<=k} x_j y_{k+1-j}, or the sum of j x_j y_{k+1-j}/(k+1) for a weighted one. No
// product is fused into a sum.

// Storage and order of summation of the inner sums. Row j >= 1 of the stored numbers has row() entries; entry i is
// order j of a series, times j if it is weighted. Sum i multiplies two entries. add_up() sums product(j) = x_j
// y_{k+1-j} for 0 < j <= k. The terms with row k come last, because they are available last.
//
// For eight runs a number fills a vector by itself, so a factor of several sums is stored once. The terms with row k -
// 1 come late, too.
template <class Number>
struct InnerSums {
    LanePlan plan;

    // The first `inner_sums` lanes of the plan are used.
    explicit InnerSums(LanePlan lanes) : plan(std::move(lanes)) {}
    InnerSums(const SeriesPlan& series, std::size_t inner_sums) : plan(series, inner_sums) {}
    std::size_t count() const { return plan.sums.size(); }
    std::size_t row() const { return plan.stored.size(); }
    LanePlan::StoredSums stored(std::size_t i) const { return plan.stored[i]; }
    std::size_t left(std::size_t i) const { return plan.sums[i].left; }
    std::size_t right(std::size_t i) const { return plan.sums[i].right; }

    template <class Value, class Product>
    [[gnu::always_inline]] static Value add_up(std::size_t k, const Product& product) {
        Value sum = 0.0;
        for (std::size_t j = 3; j + 1 < k; ++j) sum += product(j);
        if (k >= 3) sum += product(2);
        if (k >= 4) sum += product(k - 1);
        if (k >= 2) sum += product(k);
        sum += product(1);
        return sum;
    }
};

// For one run, each sum has its own factors, contiguous with those of other sums, so that several sums form one vector.
// Even and odd terms are summed separately.
template <>
struct InnerSums<double> {
    const SeriesPlan& plan;

    explicit InnerSums(const SeriesPlan& series, std::size_t = 0) : plan(series) {}
    std::size_t count() const { return plan.lanes; }
    std::size_t row() const { return plan.row(); }
    // The series whose coefficients are entry i of the stored rows: the left factors of all sums, then the right ones.
    LanePlan::StoredSums stored(std::size_t i) const {
        if (i < plan.lanes) return {plan.left[i], i < plan.weighted, false};
        return {plan.right[i - plan.lanes], false, false};
    }
    std::size_t left(std::size_t i) const { return i; }
    std::size_t right(std::size_t i) const { return plan.lanes + i; }

    template <class Value, class Product>
    [[gnu::always_inline]] static Value add_up(std::size_t k, const Product& product) {
        if (k == 1) return product(1);
        Value even{}, odd{};
        std::size_t j = 2;
        for (; j + 1 < k; j += 2) {
            even += product(j);
            odd += product(j + 1);
        }
        if (j < k) even += product(j);
        return (even + odd) + (product(1) + product(k));
    }
};

// (f[2] w + f[1] y) + f[0] x, without the absent operands (see SeriesRule).
template <class Number>
[[gnu::always_inline]] inline Number value_of(const SeriesRule& rule, const std::array<Number, 3>& factors,
                                              const Number* now) {
    const auto term = [&](std::size_t i, std::uint32_t operand) -> Number {
        if (rule.known[i] == 0) return factors[i] * now[operand];
        return rule.known[i] > 0 ? now[operand] : -now[operand];
    };
    Number value = rule.w != 0 ? term(2, rule.w) : Number(0.0);
    if (rule.y != 0) value = rule.w != 0 ? value + term(1, rule.y) : term(1, rule.y);
    if (rule.x != 0) value = rule.w != 0 || rule.y != 0 ? value + term(0, rule.x) : term(0, rule.x);
    return value;
}

template <class Number>
void make_order(const SeriesPlan& plan, const InnerSums<Number>& sums, const SeriesTablesOver<Number>& tables,
                std::size_t k) {
    using Pack4 = Pack<Number, 4>;
    Number* const now = tables.now;
    for (std::size_t i = 0; i < plan.rules.size(); ++i)
        now[plan.rules[i].result] = value_of(plan.rules[i], tables.factors[i], now);
    const std::size_t width = sums.row();
    for (std::size_t i = 0; i < width; ++i) {
        const LanePlan::StoredSums stored = sums.stored(i);
        Number& place = tables.rows[width * k + i];
        place = now[stored.series];
        if (stored.weighted) place = place * static_cast<double>(k);
    }
    Number* const totals = now + plan.series;
    for (std::size_t i = 0; i < sums.count(); i += Pack4::count) {
        const Number* const x = tables.rows + sums.left(i);
        const Number* const y = tables.rows + sums.right(i);
        const auto product = [&](std::size_t j) ->
            typename Pack4::Value { return Pack4::load(x + j * width) * Pack4::load(y + (k + 1 - j) * width); };
        Pack4::store(sums.template add_up<typename Pack4::Value>(k, product), totals + i);
    }
    const Number inverse = Number(1.0) / Number(static_cast<double>(k + 1));
    for (std::size_t i = 0; i < plan.weighted; ++i) totals[i] = totals[i] * inverse;
}

// Order k >= 1 of q, v and the event functions of a motion, into `row`; order k - 1 precedes it in memory: q_k =
// v_{k-1}/k, v_k = v'_{k-1}/k. For k = 1, q and v in the row are given.
template <class Number>
void make_motion_order(const SeriesPlan& plan, const InnerSums<Number>& sums, const SeriesTablesOver<Number>& tables,
                       Number* row, std::size_t k) {
    const std::size_t n = plan.coordinates();
    Number* const now = tables.now;
    if (k > 1) {
        const Number* const below = row - plan.states();
        const Number inverse = Number(1.0) / Number(static_cast<double>(k));
        for (std::size_t i = 0; i < n; ++i) {
            row[i] = inverse * below[n + i];
            row[n + i] = inverse * now[plan.outputs[i]];
        }
    }
    for (std::size_t i = 0; i < 2 * n; ++i) now[1 + i] = row[i];
    make_order(plan, sums, tables, k);
    for (std::size_t i = 0; i < plan.events; ++i) row[2 * n + i] = now[plan.event(i)];
}

}  // namespace achilles
