// A program over double, or lanes, as machine code.
#pragma once

#include <span>

#include "program/machine.hpp"
#include "program/program.hpp"

namespace achilles {

// Code of type void(double* registers) for these instructions, the first of which writes register `first`; may be none.
// Of numbers of eight doubles it is of type void(Eight* registers), by vectors of four or of eight.
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first,
                                                Width of_number, Width of_vector);
inline std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first) {
    return machine_code(instructions, first, Width::one, Width::one);
}

}  // namespace achilles
