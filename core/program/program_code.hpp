// A program over double, or lanes, as machine code.
#pragma once

#include <span>

#include "program/machine.hpp"
#include "program/program.hpp"

namespace achilles {

// Code of type void(double* registers) for these instructions, the first of which writes register `first`; may be none.
// With a width of eight it is of type void(Eight* registers).
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first,
                                                Width width);

}  // namespace achilles
