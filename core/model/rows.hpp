// Rows of expressions: vector operations shared by the derivations.
#pragma once

#include "program/terms.hpp"

namespace achilles {

using Row = Expressions;

inline std::vector<std::uint32_t> slots_from(std::uint32_t first, std::size_t count) {
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < count; ++i) slots.push_back(first + static_cast<std::uint32_t>(i));
    return slots;
}

inline Row symbols(const std::vector<std::uint32_t>& slots, Graph& graph) {
    Row all;
    for (const std::uint32_t slot : slots) all.push_back(graph.symbol(slot));
    return all;
}

// Cancels a factor common to dividend and divisor of a quotient. The divisor must never be zero.
Expression cancelled(Expression quotient);

// The same expressions in another graph.
inline Row adopt(Graph& graph, const Row& row) {
    Row result;
    for (const Expression e : row) result.push_back(graph.adopt(e));
    return result;
}

// The derivative of each entry x_i along a direction: the sum of dx_i/d(slots[k]) direction[k].
inline Row along(const Row& x, const std::vector<std::uint32_t>& slots, const Row& direction) {
    Row sums(x.size(), x.front().graph().number(0));
    for (std::size_t k = 0; k < slots.size(); ++k) {
        const Row slope = derivative(x, slots[k]);
        for (std::size_t i = 0; i < x.size(); ++i) sums[i] = sums[i] + slope[i] * direction[k];
    }
    return sums;
}

// The dot product a . b.
inline Expression product(const Row& a, const Row& b) {
    Expression sum = a.front().graph().number(0);
    for (std::size_t i = 0; i < a.size(); ++i) sum = sum + a[i] * b[i];
    return sum;
}

// x with the expressions `velocity` in place of the velocities, whose slots are v.
inline Row at_velocity(const Row& x, const std::vector<std::uint32_t>& v, const Row& velocity) {
    Row result;
    for (const Expression e : x) result.push_back(substitute(e, v, velocity));
    return result;
}

inline Row sum(const Row& a, const Row& b) {
    Row result;
    for (std::size_t i = 0; i < a.size(); ++i) result.push_back(a[i] + b[i]);
    return result;
}

// The Jacobian dx_i/d(slots[k]), stored row by row.
inline Row row_by_row(const Row& x, const std::vector<std::uint32_t>& slots) {
    Row slopes;
    for (const Row& row : jacobian(x, slots)) slopes.insert(slopes.end(), row.begin(), row.end());
    return slopes;
}

}  // namespace achilles
