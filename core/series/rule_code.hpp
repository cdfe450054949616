// The rules of a series program as machine code.
#pragma once

#include <span>

#include "expression/machine.hpp"
#include "series/order.hpp"

namespace achilles {

// Code of type RunRules for rules with these operands and results, and whatever factors; may be none.
std::shared_ptr<const MachineCode> machine_code(std::span<const SeriesRule> rules);

}  // namespace achilles
