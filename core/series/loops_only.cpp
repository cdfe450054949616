// In place of all that makes machine code, where there is none: another processor or system, or ACHILLES_MACHINE_CODE
// off when it was built.
#include "program/machine.hpp"
#include "program/program.hpp"
#include "series/order.hpp"

namespace achilles {

std::optional<Width> best_width() { return std::nullopt; }
void ask_environment_for_code() {}
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction>, std::uint32_t, Width, Width) {
    return nullptr;
}
std::shared_ptr<const OrderCode> OrderCode::of(const SeriesPlan&, Width) { return nullptr; }
std::shared_ptr<const LaneOrderCode> LaneOrderCode::of(const SeriesPlan&, const LanePlan&, Width) { return nullptr; }

}  // namespace achilles
