#include "program/program.hpp"

#include <algorithm>
#include <deque>
#include <map>

#include "expression/graph.hpp"
#include "program/machine.hpp"

namespace achilles {

namespace {

// Orders instructions, given by ascending ids, so that equal operations form long runs. Takes all ready instructions of
// the operation with most of them, then repeats. Operands come before their users.
std::vector<std::uint32_t> in_runs(const std::vector<std::uint32_t>& ids, const Graph& graph) {
    const std::uint32_t most = ids.empty() ? 0 : ids.back() + 1;
    std::vector<bool> pending(most, false);
    for (const std::uint32_t id : ids) pending[id] = true;
    std::vector<int> missing(most, 0);  // number of operands not yet in the order
    std::vector<std::vector<std::uint32_t>> users(most);
    std::map<Operation, std::deque<std::uint32_t>> ready;
    for (const std::uint32_t id : ids) {
        const Graph::Node& node = graph.node(id);
        if (!is_leaf(node.operation)) {
            for (const std::uint32_t operand : {node.a, is_binary(node.operation) ? node.b : node.a}) {
                // Skips operands outside this list, and a repeated operand.
                if (!pending[operand] || (operand == node.a && missing[id] > 0)) continue;
                ++missing[id];
                users[operand].push_back(id);
            }
        }
        if (missing[id] == 0) ready[node.operation].push_back(id);
    }
    std::vector<std::uint32_t> order;
    while (order.size() < ids.size()) {
        const auto run = std::max_element(
            ready.begin(), ready.end(), [](const auto& x, const auto& y) { return x.second.size() < y.second.size(); });
        while (!run->second.empty()) {
            const std::uint32_t id = run->second.front();
            run->second.pop_front();
            order.push_back(id);
            for (const std::uint32_t user : users[id])
                if (--missing[user] == 0) ready[graph.node(user).operation].push_back(user);
        }
    }
    return order;
}

}  // namespace

// Registers: inputs, then constants, then one result per instruction. Instructions that depend on parameters only come
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
            moving[id] = node.a < slots.parameters_begin || node.a >= slots.parameters_end;
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
        for (const std::uint32_t id : in_runs(part, graph)) {
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
    const auto first = slots_.count + static_cast<std::uint32_t>(constants_.size() + fixed_);
    code_ = machine_code(std::span(instructions_).subspan(fixed_), first);
    if (code_) run_code_ = code_->as<void(double*)>();
}

// Marks what is needed, from the results back to the inputs.
std::vector<bool> Program::inputs_of(std::size_t outputs) const {
    const std::size_t first = slots_.count + constants_.size();
    std::vector<bool> needed(first + instructions_.size(), false);
    for (std::size_t i = 0; i < outputs; ++i) needed[outputs_[i]] = true;
    for (std::size_t i = instructions_.size(); i-- > 0;) {
        const Instruction& in = instructions_[i];
        if (!needed[first + i] || is_leaf(in.operation)) continue;
        needed[in.a] = true;
        if (is_binary(in.operation)) needed[in.b] = true;
    }
    needed.resize(slots_.count);
    return needed;
}

template void Evaluator<double>::execute(std::size_t, std::size_t);
template void Evaluator<Interval>::execute(std::size_t, std::size_t);

}  // namespace achilles
