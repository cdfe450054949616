// libFuzzer: any bytes as an expression. It is refused with ParseError, or it can be printed and read back as the same
// node, differentiated, substituted into, and evaluated so that the enclosure holds.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "expression/parse.hpp"
#include "expression/program.hpp"
#include "number/interval.hpp"
#include "require.hpp"

namespace {

using namespace achilles;
using fuzz::require;

constexpr std::array<double, 3> point{0.3, -1.7, 2.5};  // x, x', z

template <class Scalar>
Scalar value(Expression e) {
    const Program program(std::span(&e, 1), Slots{3, 2, 3});
    Evaluator<Scalar> evaluator(program);
    for (std::size_t i = 0; i < point.size(); ++i) evaluator.input(i) = Scalar(point[i]);
    evaluator.fix();
    evaluator.run();
    return evaluator.output(0);
}

// The double is one of the numbers that rounding can make of the expression, and so lies in the enclosure, but for what
// two ways to multiply out a power may differ.
void require_enclosed(Expression e) {
    const double x = value<double>(e);
    const Interval enclosure = value<Interval>(e);
    const bool overflows = std::isinf(enclosure.lo()) || std::isinf(enclosure.hi());
    if (!enclosure.is_defined() || (std::isnan(x) && overflows)) return;
    const double slack = 1e-9 * std::max(std::abs(enclosure.lo()), std::abs(enclosure.hi()));
    require(enclosure.lo() - slack <= x && x <= enclosure.hi() + slack, "the enclosure holds the value");
}

void require_readable(Expression e, const Scope& scope) {
    const std::array<std::string, 3> names{"x", "x'", "z"};
    const std::string printed = to_text(e, names);
    try {
        require(parse(printed, scope, e.graph()) == e, "what is printed reads back");
    } catch (const ParseError& error) {  // parentheses and fractions may be more than what was typed
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
    scope.forbidden = {{"gap", "'gap' may stand in a [[view]] only"}};
    try {
        const Expression e = parse(text, scope, graph);
        require_readable(e, scope);
        require_enclosed(e);
        const std::array<std::uint32_t, 1> slot{0};
        const std::array<Expression, 1> third{graph.number(1, 3)};
        require_enclosed(derivative(e, 0));
        require(!depends_on(substitute(e, slot, third), slot), "a replaced symbol is gone");
    } catch (const ParseError& error) {
        require(error.offset <= size && error.what()[0] != '\0', "an error says what and where");
    } catch (const std::domain_error&) {  // by substitution: 1/(3*x - 1)
    }
    return 0;
}
