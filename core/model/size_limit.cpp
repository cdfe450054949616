#include "model/size_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// Number of operations, each common subexpression counted once.
std::size_t size_of(Expression expression) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::size_t count = 0;
    for (std::uint32_t id = 0; id < needed.size(); ++id)
        if (needed[id] && !is_leaf(expression.graph().node(id).operation)) ++count;
    return count;
}

struct SizedExpression {
    std::string name;
    Location at;
    std::size_t size = 0;
};

}  // namespace

Mistake too_large(const SystemDescription& system, const Equations& equations, const std::string& what,
                  const ExpressionTooLarge& problem) {
    SizedExpression largest{"the kinetic energy", system.kinetic.at};
    const auto look = [&](const std::string& name, const Text& text, Expression expression) {
        const std::size_t size = size_of(expression);
        if (size > largest.size) largest = {name, text.at, size};
    };
    look("the kinetic energy", system.kinetic, equations.given.kinetic);
    look("the potential", system.potential, equations.given.potential);
    for (std::size_t i = 0; i < equations.given.Q.size(); ++i) {
        const CoordinateDescription& coordinate = system.coordinates[i];
        look("the force on " + coordinate.name, coordinate.force.text.empty() ? system.dissipation : coordinate.force,
             equations.given.Q[i]);
    }
    for (std::size_t i = 0; i < equations.gaps.size(); ++i) {
        const ConstraintDescription& constraint = system.constraints[i];
        look(constraint.name.empty() ? "the gap" : "the gap of " + constraint.name, constraint.gap, equations.gaps[i]);
    }
    return {largest.at,
            fmt::format("{} are too large: {}; the largest expression of the file is {}, with {} operations", what,
                        problem.what(), largest.name, largest.size),
            {}};
}

}  // namespace achilles
