// An expression as text that parse() reads back.
#include <fmt/format.h>

#include "expression/function_names.hpp"
#include "expression/graph.hpp"

namespace achilles {

namespace {

using Op = Operation;

// How tightly a printed node holds together: sums 1, products 2, signs 3, powers 4, atoms 5.
struct Printed {
    std::string text;
    int binding = 5;
};

std::string inside(const Printed& part, int least) {
    return part.binding < least ? fmt::format("({})", part.text) : part.text;
}

Printed print_number(const Rational& value) {
    const bool fraction = boost::multiprecision::denominator(value) != 1;
    return {value.str(), value < 0 ? 1 : fraction ? 2 : 5};
}

Printed print_node(Op operation, int exponent, const Printed& a, const Printed& b) {
    switch (operation) {
        case Op::add:
            return {fmt::format("{} + {}", a.text, inside(b, 2)), 1};
        case Op::subtract:
            return {fmt::format("{} - {}", a.text, inside(b, 2)), 1};
        case Op::multiply:
            return {fmt::format("{}*{}", inside(a, 2), inside(b, 3)), 2};
        case Op::divide:
            return {fmt::format("{}/{}", inside(a, 2), inside(b, 4)), 2};
        case Op::negate:
            return {fmt::format("-{}", inside(a, 3)), 1};
        case Op::power:
            return {exponent < 0 ? fmt::format("{}^({})", inside(a, 5), exponent)
                                 : fmt::format("{}^{}", inside(a, 5), exponent),
                    4};
        case Op::real_power:
            return {fmt::format("{}^{}", inside(a, 5), inside(b, 5)), 4};
        default:
            break;
    }
    for (const auto& [name, function] : functions)
        if (function == operation) return {fmt::format("{}({})", name, a.text), 5};
    return {};
}

}  // namespace

std::string to_text(Expression expression, std::span<const std::string> names) {
    const Graph& graph = expression.graph();
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<Printed> printed(needed.size());
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node& node = graph.node(id);
        switch (node.operation) {
            case Op::number:
                printed[id] = print_number(Builder::value({&expression.graph(), id}));
                break;
            case Op::pi:
                printed[id] = {"pi", 5};
                break;
            case Op::symbol:
                printed[id] = {node.a < names.size() ? names[node.a] : "?", 5};
                break;
            default:
                printed[id] = print_node(node.operation, node.exponent, printed[node.a], printed[node.b]);
        }
    }
    return printed[expression.id()].text;
}

}  // namespace achilles
