#include "model/edges.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// The distances of a node from its edge and from where it shows; none where it has none. A power has both.
std::vector<Edge> edges_of(Expression function, const char* place) {
    Graph& graph = function.graph();
    const Graph::Node node = Builder::node(function);  // a copy: what follows makes nodes
    const Expression argument(&graph, node.a), half = graph.number(-1, 2);
    const auto edge = [&](Expression distance) { return Edge{function, argument, distance, place, Edge::Kind::edge}; };
    const auto hiding = [&](Expression u, Expression distance) {
        return Edge{function, u, distance, place, Edge::Kind::hiding};
    };
    switch (node.operation) {
        case Operation::sqrt:
            return {edge(function)};
        case Operation::real_power: {
            const Expression exponent(&graph, node.b);
            const Expression hidden = apply(Operation::exp, half * exponent * apply(Operation::log, argument));
            return {edge(apply(Operation::sqrt, argument)), hiding(exponent, hidden)};
        }
        case Operation::log:
            return {edge(apply(Operation::sqrt, argument))};
        case Operation::asin:
        case Operation::acos:
            return {edge(apply(Operation::sqrt, graph.number(1) - power(argument, 2)))};
        case Operation::exp:
            return {hiding(argument, apply(Operation::exp, half * argument))};
        case Operation::sinh:
        case Operation::cosh:
        case Operation::tanh:
            return {hiding(argument, apply(Operation::cosh, argument))};
        default:
            return {};
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
            for (const Edge& edge : edges_of(function, place)) {
                const auto is_known = [&](const Edge& known) { return known.distance == edge.distance; };
                if (depends_on(edge.argument, moving) && std::none_of(edges.begin(), edges.end(), is_known))
                    edges.push_back(edge);
            }
        }
    }
    return edges;
}

}  // namespace achilles
