#include "model/edges.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// The distance of a node from its edge; nothing where it has none.
std::optional<Expression> distance_of(Expression function) {
    const Graph::Node node = Builder::node(function);  // a copy: what follows makes nodes
    const Expression argument(&function.graph(), node.a);
    switch (node.operation) {
        case Operation::sqrt:
            return function;
        case Operation::real_power:
        case Operation::log:
            return apply(Operation::sqrt, argument);
        case Operation::asin:
        case Operation::acos:
            return apply(Operation::sqrt, function.graph().number(1) - power(argument, 2));
        default:
            return std::nullopt;
    }
}

}  // namespace

std::vector<Edge> edges_of(const Equations& equations, const Layout& layout) {
    std::vector<std::uint32_t> moving;
    for (std::uint32_t slot = 0; slot < 2 * layout.n; ++slot) moving.push_back(slot);
    const std::array<std::pair<Expression, const char*>, 3> written{{{equations.kinetic, "the kinetic energy"},
                                                                     {equations.potential, "the potential"},
                                                                     {equations.gap, "the gap"}}};
    std::vector<Edge> edges;
    for (const auto& [whole, place] : written) {
        const std::vector<bool> needed = reachable(std::span(&whole, 1));
        for (std::uint32_t id = 0; id < needed.size(); ++id) {
            if (!needed[id]) continue;
            const Expression function(&whole.graph(), id);
            if (is_leaf(Builder::node(function).operation)) continue;
            const Expression argument = Builder::first(function);
            if (!depends_on(argument, moving)) continue;
            const auto distance = distance_of(function);
            const auto is_known = [&](const Edge& edge) { return edge.distance == *distance; };
            if (!distance || std::any_of(edges.begin(), edges.end(), is_known)) continue;
            edges.push_back({function, argument, *distance, place});
        }
    }
    return edges;
}

}  // namespace achilles
