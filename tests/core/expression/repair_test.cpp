// Suggestions for expressions in the syntax of other languages.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "expression/parse.hpp"
#include "expression/repair.hpp"

namespace achilles {
namespace {

class SyntaxRepair : public testing::Test {
 protected:
    SyntaxRepair() {
        unsigned slot = 0;
        for (const char* name : {"x", "y", "theta1", "x'", "y'", "theta1'", "m", "g", "k", "om"})
            scope_.allowed.emplace(name, graph_.symbol(slot++));
        scope_.listed.emplace("zeno_time", [this](int) { return graph_.number(1); });
    }
    // The correction that parse() suggests; "" if it accepts the text or has no suggestion.
    std::string suggested(const std::string& text) {
        try {
            parse(text, scope_, graph_);
            return "";
        } catch (const ParseError& error) {
            return error.hint;
        }
    }
    Graph graph_;
    Scope scope_;
};

TEST_F(SyntaxRepair, WritesOtherNotationsInTheLanguage) {
    const std::pair<const char*, const char*> cases[] = {
        {"0.5x\u00b2", "0.5*x^2"},
        {"m x\u207b\u00b9", "m*x^(-1)"},
        {"mgy", "m*g*y"},
        {"2m(x + y)", "2*m*(x + y)"},
        {"(x + 1)(y + 1)", "(x + 1)*(y + 1)"},
        {"m\u00b7g\u00b7y", "m*g*y"},
        {"m.*x.^2", "m*x^2"},
        {"x**2", "x^2"},
        {"m*[x + 1]", "m*(x + 1)"},
        {"9,81*y", "9.81*y"},
        {"m*g*y;", "m*g*y"},
        {"x \u2212 y", "x - y"},
        {"\u03b81 + x", "theta1 + x"},
        {"m\u03b81", "m*theta1"},
        {"xdot^2", "x'^2"},
        {"der(x)^2", "x'^2"},
        {"diff(x, t)", "x'"},
        {"\u1e8b\u00b2", "x'^2"},
        {"\\dot{x}^2 + \\dot y^2", "x'^2 + y'^2"},
        {"\\frac{m}{2} \\dot{\\theta_1}^2", "(m)/(2)*theta_1'^2"},
        {"m g \\sin(x)", "m*g*sin(x)"},
        {"np.sin(x)", "sin(x)"},
        {"math.sqrt(x)", "sqrt(x)"},
        {"Sin(x)", "sin(x)"},
        {"arctan(x)", "atan(x)"},
        {"ln(x)", "log(x)"},
        {"e^(-x)", "exp(-x)"},
        {"pow(x, 2)", "x^2"},
        {"pow(x + 1, 3)", "(x + 1)^3"},
        {"sin x", "sin(x)"},
        {"sin 2x", "sin(2*x)"},
        {"sin^2(x)", "sin(x)^2"},
        {"cos\u00b2(om x)", "cos(om*x)^2"},
        {"y >= sin(x)", "y - sin(x)"},
        {"y \u2265 x - 1", "y - (x - 1)"},
        {"y - x > 0", "y - x"},
        {"x <= y", "y - x"},
        {"y = x", "y - x"},
        {"h(q) = y - x", "y - x"},
        {"V = m*g*y", "m*g*y"},
        {"y(t)", "y"},
        {"zeno_time[1]", "zeno_time(1)"},
        {"zeno_time 1", "zeno_time(1)"},
        {"zeno_time_2", "zeno_time(2)"},
    };
    for (const auto& [text, right] : cases) {
        EXPECT_EQ(repaired(text, scope_), right) << text;
        const bool is_known = std::string(right).find("theta_1") == std::string::npos;
        EXPECT_EQ(suggested(text), is_known ? "write " + std::string(right) : "") << text;
    }
}

// Correct parts of the text stay unchanged, letter by letter. Without a safe guess there is no suggestion.
TEST_F(SyntaxRepair, LeavesTheRestAlone) {
    for (const char* text :
         {"m/2*(x'^2 + y'^2)", "2.*x", "1e-3*x", "zeno_time(1) + 2", "sqrt(x^2 + y^2)", "-x^2", "pi*x"}) {
        EXPECT_EQ(repaired(text, scope_), text);
        EXPECT_EQ(suggested(text), "");
    }
    for (const char* text :
         {"",      "x +",    "z",  "xx",    "yy*2",   "sin",  "x y z", "1 000*x", "(x",  "x)",    "\\frac{x",
          "\\dot", "\\dot{", "_{", "pow(x", "pow(x,", "f(x)", "e^",    "<=",      "= =", "\u207b"})
        EXPECT_EQ(suggested(text), "") << text;
}

}  // namespace
}  // namespace achilles
