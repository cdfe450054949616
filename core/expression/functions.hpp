// The functions of the language: names, for reading and printing, and values. One table.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "expression/expression.hpp"

namespace achilles {

struct Function {
    std::string_view name;
    Operation operation;
    double (*value)(double);
};

inline constexpr std::array<Function, 12> functions{{
    {"sqrt", Operation::sqrt, std::sqrt},
    {"sin", Operation::sin, std::sin},
    {"cos", Operation::cos, std::cos},
    {"tan", Operation::tan, std::tan},
    {"asin", Operation::asin, std::asin},
    {"acos", Operation::acos, std::acos},
    {"atan", Operation::atan, std::atan},
    {"sinh", Operation::sinh, std::sinh},
    {"cosh", Operation::cosh, std::cosh},
    {"tanh", Operation::tanh, std::tanh},
    {"exp", Operation::exp, std::exp},
    {"log", Operation::log, std::log},
}};

}  // namespace achilles
