// Derivatives and substitution, each in one pass over the nodes below an expression, by ascending id.
#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "expression/expression.hpp"
#include "expression/graph.hpp"
#include "expression/scalar.hpp"

namespace achilles {

namespace {

using Op = Operation;

// d f(u)/du for a function node e = f(u).
Expression outer_derivative(Expression e) {
    Graph& graph = e.graph();
    const Expression u = Builder::first(e), one = graph.number(1), two = graph.number(2);
    switch (Builder::node(e).operation) {
        case Op::sqrt:
            return one / (two * e);
        case Op::sin:
            return apply(Op::cos, u);
        case Op::cos:
            return -apply(Op::sin, u);
        case Op::tan:
            return one + power(e, 2);
        case Op::asin:
            return one / apply(Op::sqrt, one - power(u, 2));
        case Op::acos:
            return -(one / apply(Op::sqrt, one - power(u, 2)));
        case Op::atan:
            return one / (one + power(u, 2));
        case Op::sinh:
            return apply(Op::cosh, u);
        case Op::cosh:
            return apply(Op::sinh, u);
        case Op::tanh:
            return one - power(e, 2);
        case Op::exp:
            return e;
        case Op::log:
            return one / u;
        default:
            throw std::logic_error("not a function");
    }
}

// d(e) from the derivatives da, db of its operands.
Expression derivative_of(Expression e, Expression da, Expression db) {
    Graph& graph = e.graph();
    const Graph::Node node = Builder::node(e);
    if (is_leaf(node.operation)) return graph.number(0);
    const Expression a{&graph, node.a}, b{&graph, node.b};
    switch (node.operation) {
        case Op::add:
            return da + db;
        case Op::subtract:
            return da - db;
        case Op::multiply:
            return da * b + a * db;
        case Op::divide:
            return (da - e * db) / b;
        case Op::negate:
            return -da;
        case Op::power:
            return graph.number(node.exponent) * power(a, node.exponent - 1) * da;
        case Op::real_power:
            if (db.is_zero()) return b * real_power(a, b - graph.number(1)) * da;
            return e * (db * apply(Op::log, a) + b * da / a);
        case Op::midpoint:
            return graph.number(0);
        default:
            return da.is_zero() ? da : outer_derivative(e) * da;
    }
}

// The node e with its operands replaced.
Expression rebuild(Expression e, Expression a, Expression b) {
    const Graph::Node node = Builder::node(e);
    switch (node.operation) {
        case Op::add:
            return a + b;
        case Op::subtract:
            return a - b;
        case Op::multiply:
            return a * b;
        case Op::divide:
            return a / b;
        case Op::negate:
            return -a;
        case Op::power:
            return power(a, node.exponent);
        case Op::real_power:
            return real_power(a, b);
        default:
            return apply(node.operation, a);
    }
}

}  // namespace

std::vector<Expression> derivative_along(std::span<const Expression> expressions, std::span<const std::uint32_t> slots,
                                         std::span<const Expression> direction) {
    if (expressions.empty()) return {};
    Graph& graph = expressions.front().graph();
    const std::vector<bool> needed = reachable(expressions);
    const Expression zero = graph.number(0);
    std::vector<Expression> d(needed.size(), zero);
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph.node(id);  // a copy: the table grows below
        if (node.operation == Op::symbol) {
            for (std::size_t i = 0; i < slots.size(); ++i)
                if (slots[i] == node.a) d[id] = direction[i];
        } else if (!is_leaf(node.operation)) {
            const Expression db = is_binary(node.operation) ? d[node.b] : zero;
            if (!d[node.a].is_zero() || !db.is_zero()) d[id] = derivative_of({&graph, id}, d[node.a], db);
        }
    }
    std::vector<Expression> result;
    for (const Expression expression : expressions) result.push_back(d[expression.id()]);
    return result;
}

std::vector<Expression> derivative(std::span<const Expression> expressions, std::uint32_t slot) {
    if (expressions.empty()) return {};
    const Expression one = expressions.front().graph().number(1);
    return derivative_along(expressions, {&slot, 1}, {&one, 1});
}

Expression derivative(Expression expression, std::uint32_t slot) {
    return derivative(std::span(&expression, 1), slot).front();
}

std::vector<std::vector<Expression>> jacobian(std::span<const Expression> expressions,
                                              std::span<const std::uint32_t> slots) {
    std::vector<std::vector<Expression>> rows(expressions.size());
    for (const std::uint32_t slot : slots) {
        const std::vector<Expression> column = derivative(expressions, slot);
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(column[i]);
    }
    return rows;
}

std::vector<Expression> gradient(Expression expression, std::span<const std::uint32_t> slots) {
    return jacobian(std::span(&expression, 1), slots).front();
}

std::vector<Expression> substitute(std::span<const Expression> expressions, std::span<const std::uint32_t> slots,
                                   std::span<const Expression> values) {
    if (expressions.empty()) return {};
    Graph& graph = expressions.front().graph();
    const std::vector<bool> needed = reachable(expressions);
    std::vector<Expression> image(needed.size());
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph.node(id);
        image[id] = Expression(&graph, id);
        if (node.operation == Op::symbol) {
            for (std::size_t i = 0; i < slots.size(); ++i)
                if (slots[i] == node.a) image[id] = values[i];
        } else if (!is_leaf(node.operation)) {
            const Expression b = is_binary(node.operation) ? image[node.b] : Expression();
            const bool same = image[node.a].id() == node.a && (!is_binary(node.operation) || b.id() == node.b);
            if (!same) image[id] = rebuild({&graph, id}, image[node.a], b);
        }
    }
    std::vector<Expression> result;
    for (const Expression expression : expressions) result.push_back(image[expression.id()]);
    return result;
}

Expression substitute(Expression expression, std::span<const std::uint32_t> slots, std::span<const Expression> values) {
    return substitute(std::span(&expression, 1), slots, values).front();
}

bool depends_on(Expression expression, std::span<const std::uint32_t> slots) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        const Graph::Node& node = expression.graph().node(id);
        if (needed[id] && node.operation == Op::symbol)
            for (const std::uint32_t slot : slots)
                if (slot == node.a) return true;
    }
    return false;
}

bool is_constant(Expression expression) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    for (std::uint32_t id = 0; id < needed.size(); ++id)
        if (needed[id] && expression.graph().node(id).operation == Op::symbol) return false;
    return true;
}

double value_of_constant(Expression expression) { return value_of(expression, {}); }

double value_of(Expression expression, std::span<const double> symbols) {
    const Graph& graph = expression.graph();
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<double> values(needed.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node& node = graph.node(id);
        const double a = is_leaf(node.operation) ? 0.0 : values[node.a];
        const double b = is_binary(node.operation) ? values[node.b] : 0.0;
        switch (node.operation) {
            case Op::number:
                values[id] = graph.constant(id).nearest;
                break;
            case Op::pi:
                values[id] = std::numbers::pi;
                break;
            case Op::symbol:
                if (node.a < symbols.size()) values[id] = symbols[node.a];
                break;
            case Op::add:
                values[id] = a + b;
                break;
            case Op::subtract:
                values[id] = a - b;
                break;
            case Op::multiply:
                values[id] = a * b;
                break;
            case Op::divide:
                values[id] = a / b;
                break;
            case Op::negate:
                values[id] = -a;
                break;
            case Op::power:
                values[id] = integer_power(a, node.exponent);
                break;
            case Op::real_power:
                values[id] = std::pow(a, b);
                break;
            case Op::midpoint:
                values[id] = a;
                break;
            default:
                values[id] = std::find_if(functions.begin(), functions.end(), [&](const Function& f) {
                                 return f.operation == node.operation;
                             })->value(a);
        }
    }
    return values.back();
}

}  // namespace achilles
