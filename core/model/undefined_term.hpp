// Finds the part of an expression that has no value.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace achilles {

// An undefined part, and the operand that causes it: the argument (as in log(x)) or the divisor.
struct UndefinedTerm {
    std::string part, operand;  // as text, cut after 60 characters
    double value;               // of the operand, at the state
};

// The first part of the expressions that is undefined somewhere in a box of q, v and t: a function outside its domain,
// or a division by zero. nullopt if there is none.
std::optional<UndefinedTerm> first_undefined(const Model& model, std::span<const double> parameters,
                                             std::span<const Expression> expressions, const State& state,
                                             const std::vector<Interval>& box);

// The mistake that expressions have no value at the start of a run: "WHAT is not defined at the start: log(x - 2), with
// x - 2 = -1" if the undefined part is found. If there is no such part, a value is too large.
Mistake no_value(const Model& model, const Run& run, Location at, const std::string& what,
                 std::span<const Expression> expressions);

// An expression for a message: at most 60 characters and "...".
std::string shortened(const Model& model, Expression expression);
// The value of an expression at a state.
double value_at(const Model& model, std::span<const double> parameters, Expression expression, const State& state);

// A state as a box of q, v and t.
std::vector<Interval> box_of(const State& state);
void set_box(Evaluator<Interval>& enclosure, const std::vector<Interval>& box);

}  // namespace achilles
