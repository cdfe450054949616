#include "model/edges.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// What is watched of a node; nothing of most. A power has an edge and may hide.
std::vector<Edge> edges_of(Expression function, const char* place) {
    Graph& graph = function.graph();
    const Graph::Node node = Builder::node(function);  // a copy: what follows makes nodes
    const Expression argument(&graph, node.a);
    const auto edge = [&](Expression d) { return Edge{function, argument, d, place, Edge::Kind::edge}; };
    switch (node.operation) {
        case Operation::sqrt:
            return {edge(function)};
        case Operation::real_power: {
            const Expression exponent(&graph, node.b), u = exponent * apply(Operation::log, argument);
            return {edge(apply(Operation::sqrt, argument)), {function, exponent, u, place, Edge::Kind::exponential}};
        }
        case Operation::log:
            return {edge(apply(Operation::sqrt, argument))};
        case Operation::asin:
        case Operation::acos:
            return {edge(apply(Operation::sqrt, graph.number(1) - power(argument, 2)))};
        case Operation::exp:
            return {{function, argument, argument, place, Edge::Kind::exponential}};
        case Operation::sinh:
        case Operation::cosh:
        case Operation::tanh:
            return {{function, argument, argument, place, Edge::Kind::hyperbolic}};
        default:
            return {};
    }
}

}  // namespace

std::vector<Edge> edges_of(const Equations& equations, const Layout& layout) {
    std::vector<std::uint32_t> moving;
    for (std::uint32_t slot = 0; slot < 2 * layout.dof; ++slot) moving.push_back(slot);
    moving.push_back(layout.t());
    std::vector<std::pair<Expression, const char*>> written{{equations.kinetic, "the kinetic energy"},
                                                            {equations.potential, "the potential"}};
    for (const Expression gap : equations.gaps) written.emplace_back(gap, "the gap");
    for (const Expression force : equations.Q) written.emplace_back(force, "the forces");
    std::vector<Edge> edges;
    for (const auto& [whole, place] : written) {
        const std::vector<bool> needed = reachable(std::span(&whole, 1));
        for (std::uint32_t id = 0; id < needed.size(); ++id) {
            if (!needed[id]) continue;
            const Expression function(&whole.graph(), id);
            if (is_leaf(Builder::node(function).operation)) continue;
            for (const Edge& edge : edges_of(function, place)) {
                const auto is_known = [&](const Edge& known) {
                    return known.event_function == edge.event_function && known.kind == edge.kind;
                };
                if (depends_on(edge.argument, moving) && std::none_of(edges.begin(), edges.end(), is_known))
                    edges.push_back(edge);
            }
        }
    }
    return edges;
}

}  // namespace achilles
