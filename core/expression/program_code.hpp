// A program over double as machine code.
#pragma once

#include <span>

#include "expression/machine.hpp"
#include "expression/program.hpp"

namespace achilles {

// Code of type void(double* registers) for these instructions, the first of which writes register `first`; may be none.
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first);

}  // namespace achilles
