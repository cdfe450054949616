#include "expression/program.hpp"

#include <algorithm>

#include "expression/graph.hpp"

namespace achilles {

// Registers: inputs, then constants, then one result an instruction. Instructions that depend on parameters alone come
// first. Within each part ids keep their order, so operands stand before their users.
Program::Program(std::span<const Expression> outputs, Slots slots) : slots_(slots) {
    if (outputs.empty()) return;
    const Graph& graph = outputs.front().graph();
    const std::vector<bool> needed = reachable(outputs);
    const auto count = static_cast<std::uint32_t>(needed.size());
    std::vector<bool> moving(count, false);
    std::vector<std::uint32_t> place(count, 0), order[2];
    for (std::uint32_t id = 0; id < count; ++id) {
        if (!needed[id]) continue;
        const Graph::Node& node = graph.node(id);
        if (node.operation == Operation::symbol) {
            place[id] = node.a;
            moving[id] = node.a < slots.fixed_begin || node.a >= slots.fixed_end;
        } else if (node.operation == Operation::number) {
            place[id] = slots.count + static_cast<std::uint32_t>(constants_.size());
            constants_.push_back(graph.constant(id));
        } else {
            const bool leaf = is_leaf(node.operation);
            moving[id] = !leaf && (moving[node.a] || (is_binary(node.operation) && moving[node.b]));
            order[moving[id] ? 1 : 0].push_back(id);
        }
    }
    fixed_ = order[0].size();
    std::uint32_t next = slots.count + static_cast<std::uint32_t>(constants_.size());
    for (const std::vector<std::uint32_t>& part : order) {
        for (const std::uint32_t id : part) {
            const Graph::Node& node = graph.node(id);
            const bool leaf = is_leaf(node.operation);
            instructions_.push_back({node.operation, leaf ? 0 : place[node.a],
                                     is_binary(node.operation) ? place[node.b] : 0, node.exponent});
            place[id] = next++;
        }
    }
    for (const Expression output : outputs) outputs_.push_back(place[output.id()]);
}

}  // namespace achilles
