#include "expression/program.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// The same instructions in an order in which runs of one operation are long: as many as are ready, then those of the
// operation of which most are ready. Operands stand before their users.
class Schedule {
 public:
    explicit Schedule(const Graph& graph) : graph_(graph) {}

    std::vector<std::uint32_t> order(const std::vector<std::uint32_t>& ids) {
        std::vector<std::uint32_t> result, left = ids;
        std::set<std::uint32_t> pending(ids.begin(), ids.end());
        while (!left.empty()) {
            std::map<Operation, int> ready;
            for (const std::uint32_t id : left)
                if (is_ready(id, pending)) ++ready[graph_.node(id).operation];
            const auto most = std::max_element(ready.begin(), ready.end(),
                                               [](const auto& x, const auto& y) { return x.second < y.second; });
            // One pass finds those that become ready by others of the same run: operands come first in `left`.
            std::vector<std::uint32_t> later;
            for (const std::uint32_t id : left) {
                if (graph_.node(id).operation == most->first && is_ready(id, pending)) {
                    result.push_back(id);
                    pending.erase(id);
                } else {
                    later.push_back(id);
                }
            }
            left = std::move(later);
        }
        return result;
    }

 private:
    bool is_ready(std::uint32_t id, const std::set<std::uint32_t>& pending) const {
        const Graph::Node& node = graph_.node(id);
        if (is_leaf(node.operation)) return true;
        return !pending.contains(node.a) && !(is_binary(node.operation) && pending.contains(node.b));
    }

    const Graph& graph_;
};

}  // namespace

// Registers: inputs, then constants, then one result an instruction. Instructions that depend on parameters alone come
// first.
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
        const std::size_t begin = instructions_.size();
        for (const std::uint32_t id : Schedule(graph).order(part)) {
            const Graph::Node& node = graph.node(id);
            if (instructions_.size() > begin && instructions_.back().operation != node.operation)
                runs_.push_back(instructions_.size());
            const bool leaf = is_leaf(node.operation);
            instructions_.push_back({node.operation, leaf ? 0 : place[node.a],
                                     is_binary(node.operation) ? place[node.b] : 0, node.exponent});
            place[id] = next++;
        }
        if (instructions_.size() > begin) runs_.push_back(instructions_.size());
        if (&part == &order[0]) fixed_runs_ = runs_.size();
    }
    for (const Expression output : outputs) outputs_.push_back(place[output.id()]);
}

}  // namespace achilles
