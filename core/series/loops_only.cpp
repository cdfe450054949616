// Replaces the machine code generators where there is none: on other processors or systems, or in a build with
// ACHILLES_MACHINE_CODE off.
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
