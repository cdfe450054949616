// The kinds of vectors by which series are differentiated in eight directions at once, as those of lanes (lane_kinds.hpp).
#pragma once

#include <cstddef>

#include "number/eight.hpp"
#include "series/lane_kinds.hpp"
#include "series/slope_plan.hpp"

namespace achilles {

class SlopeOrderCode;

// A number that depends on the parameters alone, and what it rises by.
struct SlopeCoefficient {
    double value = 0.0;
    bool rises = false;
    Eight rise;
};

// What is read and written.
struct SlopeTables {
    const SlopeCoefficient* coefficients = nullptr;
    const double* scales = nullptr;  // by/d_0 and lead/d_0 of each rule
    const double* now = nullptr;     // order k of all series
    const double* knowns = nullptr;  // each factor, order by order
    Eight* risings = nullptr;  // what they rise by: all orders of each factor, `orders` of them, one after the other
    Eight* rise = nullptr;     // what order k of each series does
    Eight* states = nullptr;   // what q, v and the event functions do, order by order
    static constexpr std::size_t orders = 33;
    std::size_t factors = 0;
    double known(std::uint32_t factor, std::size_t order) const { return knowns[order * factors + factor]; }
    Eight* rising(std::uint32_t factor) const { return risings + factor * orders; }
};

template <std::size_t Bytes>
struct SlopeKind {
    // Order k >= 1 of all, and into row k of the states, where order 1 of q and v stands; by code for the rules where there is any.
    static void make_order(const SlopePlan& plan, const SlopeTables& tables, const SlopeOrderCode* code, std::size_t k);
    // Order 0 of what has no register in the program.
    static void make_hidden(const SlopePlan& plan, const SlopeTables& tables);
    // Whether one of these, each times the weight, is larger than its limit.
    static bool any_above(const Eight* slopes, const Eight* limits, std::size_t count, double weight);
    // sum_{first<=k<=last} weight_k row_k
    static void add_up(const Eight* column, std::size_t width, const double* weights, int first, int last,
                       Eight* result);
};

}  // namespace achilles
