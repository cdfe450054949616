#include "model/undefined_term.hpp"

#include <fmt/format.h>

#include "expression/graph.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

std::uint32_t culprit(const Graph::Node& node) { return node.operation == Operation::divide ? node.b : node.a; }

}  // namespace

std::string shortened(const Model& model, Expression expression) {
    constexpr std::size_t most = 60;
    const std::string text = to_text(expression, model.slot_names());
    return text.size() <= most ? text : text.substr(0, most) + "...";
}

double value_at(const Model& model, std::span<const double> parameters, Expression expression, const State& state) {
    const Program program(std::span(&expression, 1), model.layout().slots());
    auto value = model.evaluator(program, parameters);
    set_state(value, state);
    value.run();
    return value.output(0);
}

std::vector<Interval> box_of(const State& state) {
    std::vector<Interval> box;
    for (const double q : state.q) box.emplace_back(q);
    for (const double v : state.v) box.emplace_back(v);
    box.emplace_back(state.t);
    return box;
}

void set_box(Evaluator<Interval>& enclosure, const std::vector<Interval>& box) {
    for (std::size_t i = 0; i + 1 < box.size(); ++i) enclosure.input(i) = box[i];
    enclosure.clock() = box.back();
}

std::optional<UndefinedTerm> first_undefined(const Model& model, std::span<const double> parameters,
                                             std::span<const Expression> expressions, const State& state,
                                             const std::vector<Interval>& box) {
    Graph& graph = expressions.front().graph();
    const std::vector<bool> needed = reachable(expressions);
    std::vector<Expression> nodes;
    for (std::uint32_t id = 0; id < needed.size(); ++id)
        if (needed[id]) nodes.emplace_back(&graph, id);
    const Program program(nodes, model.layout().slots());
    auto enclosure = model.evaluator<Interval>(program, parameters);
    set_box(enclosure, box);
    enclosure.run();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (enclosure.output(i).is_defined()) continue;
        const Graph::Node& node = graph.node(nodes[i].id());
        if (is_leaf(node.operation)) return std::nullopt;  // the state itself is not finite
        const Expression operand(&graph, culprit(node));
        return UndefinedTerm{shortened(model, nodes[i]), shortened(model, operand),
                             value_at(model, parameters, operand, state)};
    }
    return std::nullopt;
}

Mistake no_value(const Model& model, const Run& run, Location at, const std::string& what,
                 std::span<const Expression> expressions) {
    const State state = run.start();
    const auto part = first_undefined(model, run.parameters, expressions, state, box_of(state));
    if (!part) return {at, fmt::format("{} is not finite at the start", what), {}};
    return {at,
            fmt::format("{} is not defined at the start: {}, with {} = {:.3g}", what, part->part, part->operand,
                        part->value),
            {}};
}

}  // namespace achilles
