#include "simulate/domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expression/graph.hpp"

namespace achilles {

namespace {

using Values = std::vector<Interval>;  // q, v

// What stands in the way of a node being defined: its operand, as in log(x), or the divisor.
std::uint32_t culprit(const Graph::Node& node) { return node.operation == Operation::divide ? node.b : node.a; }

std::string shortened(const std::string& text) {
    constexpr std::size_t most = 60;
    return text.size() <= most ? text : text.substr(0, most) + "...";
}

// The first undefined part of some expressions over a box, named with the value of its operand at the state; or "".
std::string first_undefined(const Model& model, const Run& run, std::span<const Expression> expressions,
                            const State& state, const Values& box, const char* name) {
    Graph& graph = expressions.front().graph();
    const std::vector<bool> needed = reachable(expressions);
    std::vector<Expression> nodes;
    for (std::uint32_t id = 0; id < needed.size(); ++id)
        if (needed[id]) nodes.emplace_back(&graph, id);
    const Program program(nodes, model.layout().slots());
    auto enclosure = model.evaluator<Interval>(program, run.parameters);
    for (std::size_t i = 0; i < box.size(); ++i) enclosure.input(i) = box[i];
    enclosure.run();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (enclosure.output(i).is_defined()) continue;
        const Graph::Node& node = graph.node(nodes[i].id());
        if (is_leaf(node.operation)) return "";  // the state itself is not finite
        const Expression operand(&graph, culprit(node));
        const Program of_operand(std::span(&operand, 1), model.layout().slots());
        auto value = model.evaluator(of_operand, run.parameters);
        put(value, state);
        value.run();
        return fmt::format("{} in {} ceases to be defined, with {} = {:.3g}",
                           shortened(to_text(nodes[i], model.slot_names())), name,
                           shortened(to_text(operand, model.slot_names())), value.output(0));
    }
    return "";
}

// The first pivot of M that is not positive all over the box, with its value at the state; or "".
std::string first_bad_pivot(const Model& model, const Run& run, const State& state, const Values& box) {
    const Program program(model.equations().pivots, model.layout().slots());
    auto enclosure = model.evaluator<Interval>(program, run.parameters);
    auto value = model.evaluator(program, run.parameters);
    for (std::size_t i = 0; i < box.size(); ++i) enclosure.input(i) = box[i];
    enclosure.run();
    put(value, state);
    value.run();
    for (std::size_t i = 0; i < program.output_count(); ++i) {
        const Interval pivot = enclosure.output(i);
        if (!pivot.is_defined() || certainly_positive(pivot)) continue;
        return fmt::format("the mass matrix ceases to be positive definite, with the pivot of '{}' at {:.3g}",
                           model.description().coordinates[i].name, value.output(i));
    }
    return "";
}

// What the user wrote comes first: a derivative of log(x) is 1/x, which is no help.
std::string undefined_in(const Model& model, const Run& run, const State& state, const Values& box) {
    const Equations& e = model.equations();
    const auto look = [&](const std::vector<Expression>& expressions, const char* name) {
        return first_undefined(model, run, expressions, state, box, name);
    };
    std::string found = look({e.kinetic}, "the kinetic energy");
    if (found.empty()) found = look({e.potential}, "the potential");
    if (found.empty()) found = look({e.gap}, "the gap");
    if (found.empty()) found = first_bad_pivot(model, run, state, box);
    if (found.empty()) found = look(e.f, "the equations of motion");
    return found;
}

Values point(const State& state) {
    Values box;
    for (const double q : state.q) box.emplace_back(q);
    for (const double v : state.v) box.emplace_back(v);
    return box;
}

}  // namespace

std::string edge_of_domain(const Model& model, const Run& run, double t, const State& state) {
    const double scale = std::max(1e-3, std::abs(t));
    for (const double reach : {1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9}) {
        Values box = point(state);
        for (Eigen::Index i = 0; i < state.q.size(); ++i) {
            const double ahead = state.q[i] + reach * scale * state.v[i];
            box[static_cast<std::size_t>(i)] = hull(Interval(state.q[i]), Interval(ahead));
        }
        const std::string found = undefined_in(model, run, state, box);
        if (!found.empty()) return found;
    }
    return "";
}

std::string edge_of_contact(const Model& model, const Run& run, const State& state) {
    Values box = point(state);
    const std::string found = undefined_in(model, run, state, box);
    return found.empty() ? "dh = 0 where contact happens: the normal is not defined" : found;
}

}  // namespace achilles
