#include "model/domain_boundaries.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// A factor of a divisor, with its exponent.
struct Divisor {
    Expression factor;
    int power = 1;
};

// The factors of a divisor that may be 0. Roots and real powers are edges of their own; exponentials and cosh are never
// 0.
std::vector<Divisor> factors_of(Expression divisor, int power) {
    const Graph::Node& node = Builder::node(divisor);
    Graph& graph = divisor.graph();
    switch (node.operation) {
        case Operation::multiply: {
            std::vector<Divisor> factors = factors_of({&graph, node.a}, power);
            const std::vector<Divisor> others = factors_of({&graph, node.b}, power);
            factors.insert(factors.end(), others.begin(), others.end());
            return factors;
        }
        case Operation::power:
            if (node.exponent > 0) return factors_of({&graph, node.a}, power * node.exponent);
            return {};
        case Operation::negate:
            return factors_of({&graph, node.a}, power);
        case Operation::number:
        case Operation::pi:
        case Operation::sqrt:
        case Operation::real_power:
        case Operation::exp:
        case Operation::cosh:
            return {};
        default:
            return {{divisor, power}};
    }
}

// Whether the quotient stays finite where a divisor that is linear in a variable vanishes, as in sin(x)/x and
// (1 - cos(x))/x^2. True only if the numerator is seen to have a zero of at least the same order.
bool is_removable(Expression numerator, const Divisor& divisor, std::span<const std::uint32_t> moving) {
    Graph& graph = numerator.graph();
    for (const std::uint32_t slot : moving) {
        const Expression slope = derivative(divisor.factor, slot), nothing = graph.number(0);
        if (slope.is_zero() || !is_constant(slope)) continue;
        const Expression zero = -substitute(divisor.factor, {&slot, 1}, {&nothing, 1}) / slope;
        Expression rest = numerator;
        for (int k = 0; k < divisor.power; ++k, rest = derivative(rest, slot))
            if (!substitute(rest, {&slot, 1}, {&zero, 1}).is_zero()) return false;
        return true;
    }
    return false;
}

// The poles of a quotient. Their distance is the square of the divisor. A numerator below the tolerance, as in
// 1e-10/(1 - t)^2, hides a pole from the series of the motion, and a step would jump over it.
std::vector<DomainBoundary> poles_of(Expression function, const char* place, std::span<const std::uint32_t> moving) {
    Graph& graph = function.graph();
    const Graph::Node node = Builder::node(function);  // a copy, because nodes are created below
    Expression numerator = graph.number(1), divisor = numerator;
    if (node.operation == Operation::divide) {
        numerator = {&graph, node.a};
        divisor = {&graph, node.b};
    } else if (node.operation == Operation::power && node.exponent < 0) {
        divisor = power({&graph, node.a}, -node.exponent);
    } else if (node.operation == Operation::tan) {
        divisor = apply(Operation::cos, {&graph, node.a});
    }
    std::vector<DomainBoundary> poles;
    for (const Divisor& each : factors_of(divisor, 1))
        if (!is_removable(numerator, each, moving))
            poles.push_back({each.factor, each.factor, power(each.factor, 2), place, DomainBoundary::Kind::edge});
    return poles;
}

// The edges of one node; most nodes have none. A power has an edge and an exponential growth.
std::vector<DomainBoundary> edges_of(Expression function, const char* place) {
    Graph& graph = function.graph();
    const Graph::Node node = Builder::node(function);  // a copy, because nodes are created below
    const Expression argument(&graph, node.a);
    const auto edge = [&](Expression d) {
        return DomainBoundary{function, argument, d, place, DomainBoundary::Kind::edge};
    };
    switch (node.operation) {
        case Operation::sqrt:
            return {edge(function)};
        case Operation::real_power: {
            const Expression exponent(&graph, node.b), u = exponent * apply(Operation::log, argument);
            return {edge(apply(Operation::sqrt, argument)),
                    {function, exponent, u, place, DomainBoundary::Kind::exponential}};
        }
        case Operation::log:
            return {edge(apply(Operation::sqrt, argument))};
        case Operation::asin:
        case Operation::acos:
            return {edge(apply(Operation::sqrt, graph.number(1) - power(argument, 2)))};
        case Operation::exp:
            return {{function, argument, argument, place, DomainBoundary::Kind::exponential}};
        case Operation::sinh:
        case Operation::cosh:
        case Operation::tanh:
            return {{function, argument, argument, place, DomainBoundary::Kind::hyperbolic}};
        default:
            return {};
    }
}

}  // namespace

std::vector<DomainBoundary> edges_of(const Equations& equations, const Layout& layout) {
    std::vector<std::uint32_t> moving;
    for (std::uint32_t slot = 0; slot < 2 * layout.dof; ++slot) moving.push_back(slot);
    moving.push_back(layout.t());
    std::vector<std::pair<Expression, const char*>> written{{equations.given.kinetic, "the kinetic energy"},
                                                            {equations.given.potential, "the potential"}};
    for (const Expression gap : equations.gaps) written.emplace_back(gap, "the gap");
    for (const Expression force : equations.given.Q) written.emplace_back(force, "the forces");
    for (const auto& [which, law] : equations.friction) {
        written.emplace_back(law.slip, "the slip");
        written.emplace_back(law.level, "the friction");
        written.emplace_back(law.static_level, "the static friction");
    }
    std::vector<DomainBoundary> edges;
    for (const auto& [whole, place] : written) {
        const std::vector<bool> needed = reachable(std::span(&whole, 1));
        for (std::uint32_t id = 0; id < needed.size(); ++id) {
            if (!needed[id]) continue;
            const Expression function(&whole.graph(), id);
            if (is_leaf(Builder::node(function).operation)) continue;
            std::vector<DomainBoundary> found = edges_of(function, place);
            const std::vector<DomainBoundary> poles = poles_of(function, place, moving);
            found.insert(found.end(), poles.begin(), poles.end());
            for (const DomainBoundary& edge : found) {
                const auto is_known = [&](const DomainBoundary& known) {
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
