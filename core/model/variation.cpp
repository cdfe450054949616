#include "model/variation.hpp"

#include <numeric>

#include "model/rows.hpp"
#include "program/machine.hpp"

namespace achilles {

std::uint32_t VariationLayout::input(std::uint32_t copy, std::uint32_t slot) const {
    const std::uint32_t n = coordinates();
    if (slot < dof) return dof * copy + slot;
    if (slot < 2 * dof) return n + dof * copy + (slot - dof);
    if (slot < 2 * dof + p) return 2 * n + p * copy + (slot - 2 * dof);
    return copy == 0 ? slots().clock() : 2 * n + p * copies() + (copy - 1);
}

Slots VariationLayout::slots() const {
    const std::uint32_t moving = 2 * coordinates(), clock = moving + p * copies() + directions;
    return {clock + 1, moving, clock};
}

MotionVariation make_variation(const ModeDynamics& motion, const Layout& layout, std::uint32_t directions) {
    Graph& graph = motion.f.front().graph();
    const VariationLayout copies{layout.dof, layout.p, directions};
    std::vector<std::uint32_t> inputs(layout.t() + 1), own_inputs;  // the slots of the motion in its program, and here
    std::iota(inputs.begin(), inputs.end(), 0u);
    const auto symbols = [&](std::uint32_t copy) {
        Expressions of_copy;
        for (const std::uint32_t slot : inputs) of_copy.push_back(graph.symbol(copies.input(copy, slot)));
        return of_copy;
    };
    for (const std::uint32_t slot : inputs) own_inputs.push_back(copies.input(0, slot));
    Expressions of_motion = motion.f;
    for (std::size_t i = 0; i < motion.event_functions.size(); ++i)
        of_motion.push_back(motion.mode.is_held(i) ? graph.number(0) : motion.event_functions[i]);
    const Expressions own = substitute(of_motion, inputs, symbols(0));
    Expressions accelerations, gaps;
    for (std::uint32_t copy = 0; copy < copies.copies(); ++copy) {
        const Expressions all = copy == 0 ? own : derivative_along(own, own_inputs, symbols(copy));
        const auto first_gap = all.begin() + static_cast<std::ptrdiff_t>(layout.dof);
        accelerations.insert(accelerations.end(), all.begin(), first_gap);
        gaps.insert(gaps.end(), first_gap, all.end());
    }
    SeriesProgram series(Program(joined({accelerations, gaps}), copies.slots()), copies.coordinates(), gaps.size());
    std::vector<bool> varied(copies.slots().count, false);
    for (std::uint32_t copy = 1; copy < copies.copies(); ++copy)
        for (const std::uint32_t slot : inputs) varied[copies.input(copy, slot)] = true;
    LaneCode code = LaneCode::of(series, best_width(), varied);
    return {copies, std::move(series), std::move(code)};
}

}  // namespace achilles
