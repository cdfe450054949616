#include "series/lane_access.hpp"

#include "program/program_code.hpp"

namespace achilles {

std::shared_ptr<const MachineCode> LaneAccess::machine_code_of(const Program& program, Width vectors) {
    const auto first = program.slots_.count + static_cast<std::uint32_t>(program.constants_.size() + program.fixed_);
    return machine_code(std::span(program.instructions_).subspan(program.fixed_), first, Width::eight, vectors);
}

}  // namespace achilles
