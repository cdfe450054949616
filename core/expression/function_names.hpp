// The functions of the language, and their names: one table for reading and printing.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "expression/expression.hpp"

namespace achilles {

inline constexpr std::array<std::pair<std::string_view, Operation>, 12> functions{{{"sqrt", Operation::sqrt},
                                                                                   {"sin", Operation::sin},
                                                                                   {"cos", Operation::cos},
                                                                                   {"tan", Operation::tan},
                                                                                   {"asin", Operation::asin},
                                                                                   {"acos", Operation::acos},
                                                                                   {"atan", Operation::atan},
                                                                                   {"sinh", Operation::sinh},
                                                                                   {"cosh", Operation::cosh},
                                                                                   {"tanh", Operation::tanh},
                                                                                   {"exp", Operation::exp},
                                                                                   {"log", Operation::log}}};

}  // namespace achilles
