// Fuzz target: any bytes as an expression. It is rejected with ParseError. Otherwise it can be printed and read back as
// the same node, differentiated, substituted into, and evaluated so that every enclosure holds.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "expression/parse.hpp"
#include "number/interval.hpp"
#include "program/program.hpp"
#include "require.hpp"

namespace {

using namespace achilles;
using fuzz::require;

constexpr std::array<double, 3> point{0.3, -1.7, 2.5};  // x, x', z

template <class Scalar>
Evaluator<Scalar> evaluated(const Program& program) {
    Evaluator<Scalar> evaluator(program);
    for (std::size_t i = 0; i < point.size(); ++i) evaluator.input(i) = Scalar(point[i]);
    evaluator.fix();
    evaluator.run();
    return evaluator;
}

// Requires that the double value of every node lies in its enclosure, up to the difference of two ways to multiply out
// a power. NaN is allowed only if an operand is undefined or overflows.
void require_enclosed(Graph& graph) {
    std::vector<Expression> nodes;
    for (std::uint32_t id = 0; id < graph.size(); ++id) nodes.push_back({&graph, id});
    const Program program(nodes, Slots{3, 2, 3});
    const auto values = evaluated<double>(program);
    const auto enclosures = evaluated<Interval>(program);
    bool overflows = false;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double x = values.output(i);
        const Interval& enclosure = enclosures.output(i);
        if (!enclosure.is_defined()) continue;
        overflows = overflows || std::isinf(enclosure.lo()) || std::isinf(enclosure.hi());
        if (std::isnan(x) && overflows) continue;
        const double slack = 1e-9 * std::max(std::abs(enclosure.lo()), std::abs(enclosure.hi()));
        require(enclosure.lo() - slack <= x && x <= enclosure.hi() + slack, "the enclosure holds the value");
    }
}

void require_readable(Expression e, const Scope& scope) {
    const std::array<std::string, 3> names{"x", "x'", "z"};
    const std::string printed = to_text(e, names);
    try {
        // Sums and factors may be in another order, but both enclosures contain the value.
        const Expression again = parse(printed, scope, e.graph());
        const std::array<Expression, 2> both{e, again};
        const Program program(both, Slots{3, 2, 3});
        const auto enclosures = evaluated<Interval>(program);
        const Interval &x = enclosures.output(0), &y = enclosures.output(1);
        require(again == e || !x.is_defined() || !y.is_defined() || (x.lo() <= y.hi() && y.lo() <= x.hi()),
                "what is printed reads back");
    } catch (const ParseError& error) {  // the printed text may have more parentheses and fractions than the input
        const std::string_view why = error.what();
        require(why.find("levels deep") != why.npos || why.find("out of range") != why.npos ||
                    why.find("too large") != why.npos,
                "what is printed can be read");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}, {"x'", graph.symbol(1)}, {"z", graph.symbol(2)}};
    scope.forbidden = {{"gap", "'gap' is allowed only in a [[view]]"}};
    try {
        const Expression e = parse(text, scope, graph);
        require_readable(e, scope);
        const std::array<std::uint32_t, 1> slot{0};
        const std::array<Expression, 1> third{graph.number(1, 3)};
        (void)derivative(e, 0);
        require_enclosed(graph);
        require(!depends_on(substitute(e, slot, third), slot), "a replaced symbol is gone");
    } catch (const ParseError& error) {
        require(error.offset <= size && error.what()[0] != '\0', "an error says what and where");
    } catch (const std::domain_error&) {  // after substitution, as in 1/(3*x - 1)
    }
    return 0;
}
