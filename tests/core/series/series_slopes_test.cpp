// What Taylor coefficients rise by, against the same recurrences over numbers with their slopes; and by machine code.
#include "series/series_slopes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/machine_code.hpp"
#include "core/systems.hpp"
#include "expression/parse.hpp"
#include "number/jet.hpp"
#include "series/series_over.hpp"

namespace achilles {
namespace {

// x'' is this expression of x, y = x', the parameter p and the time t, and so is an event function.
void expect_slopes(const std::string& text) {
    SCOPED_TRACE(text);
    using Number = Directed<16>;
    constexpr double x = 0.3, y = 1.2, p = 1.7, t = 0.4;
    constexpr std::uint32_t variables[] = {3, 0, 2, 1};  // in whatever order
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}, {"y", graph.symbol(1)}, {"p", graph.symbol(2)}, {"t", graph.symbol(3)}};
    const Expression outputs[] = {parse(text, scope, graph), parse("x - 2*(" + text + ")*y", scope, graph)};
    const Program program(outputs, Slots{4, 2, 3});
    const SeriesProgram series(program, 1, 1);
    const Number numbers[] = {Number::variable(x, 1), Number::variable(y, 3), Number::variable(p, 2),
                              Number::variable(t, 0)};
    SeriesOver<Number> truth(series);
    truth.fix(std::span(numbers + 2, 1));
    truth.begin(numbers, numbers[3]);
    SeriesSlopes slopes(series, std::span(&p, 1), variables);
    ASSERT_EQ(slopes.groups(), 1u);
    constexpr double state[] = {x, y};
    for (int round = 0; round < 2; ++round) slopes.begin(state, t);  // nothing may be left of the first
    for (int k = 1; k <= 14; ++k) {
        truth.extend(k);
        slopes.extend(k);
        for (std::size_t i = 0; i < 3; ++i) {
            if (i == 2 && k < 2) continue;
            const Number& c = truth.coefficient(k, i);
            double size = std::abs(c.value);
            for (std::size_t d = 0; d < 4; ++d) size = std::max(size, std::abs(c.slope[d]));
            EXPECT_NEAR(slopes.value(k, i), c.value, 1e-13 * size) << k << ", " << i;
            for (std::size_t d = 0; d < 8; ++d)
                EXPECT_NEAR(slopes.slope(0, k, i)[d], c.slope[d], 1e-13 * k * size) << k << ", " << i << ", " << d;
        }
    }
}

TEST(SeriesSlopes, AreThoseOfNumbersWithTheirSlopes) {
    for (const char* text : {"x",
                             "p",
                             "t",
                             "x - p*y",
                             "-x*p",
                             "x*y",
                             "(p*x + t)*(x - p*y)",
                             "x/y",
                             "p/x",
                             "1/(x + p)",
                             "x^2",
                             "(p*x + y)^2",
                             "y^-3",
                             "y^(1/3)",
                             "(p*y + x)^1.5",
                             "2^(p*x)",
                             "sqrt(y + p*x)",
                             "exp(p*x)",
                             "log(y + p)",
                             "sin(p*x + y)*cos(p*x + y)",
                             "sin(t)*cos(p*t)",
                             "tan(p*x)",
                             "asin(x)",
                             "acos(x/p)",
                             "atan(p*y)",
                             "sinh(x)*cosh(x)",
                             "tanh(y)",
                             "exp(sin(x)/(2 + cos(y)))",
                             "(p*x + 2*y - 1)*(x - p*y)/(3 + x - y)",
                             "x + y + x*y + x^2 + y^2 + sin(x) + p*cos(y) + exp(x)"})
        expect_slopes(text);
}

// By more directions than one vector has, where the system has as many.
std::vector<Eight> slopes_of(const Model& model, ContactSet held) {
    const Run run = model.default_run();
    const SeriesProgram& program = model.motion(held).series;
    const auto n = static_cast<std::size_t>(model.dof());
    std::vector<std::uint32_t> variables;
    for (std::uint32_t k = 0; k <= 2 * n + run.parameters.size(); ++k) variables.push_back(k);
    SeriesSlopes series(program, run.parameters, variables);
    std::vector<double> state(run.q.begin(), run.q.end());
    state.insert(state.end(), run.v.begin(), run.v.end());
    series.begin(state.data(), 0.25);
    std::vector<Eight> all;
    for (int k = 1; k <= 20; ++k) {
        series.extend(k);
        for (std::size_t group = 0; group < series.groups(); ++group)
            for (std::size_t i = 0; i < 2 * n + model.contacts(); ++i) all.push_back(series.slope(group, k, i));
    }
    return all;
}

TEST(SeriesSlopes, HaveTheSameBitsByMachineCode) {
    if (best_width() != Width::eight) {
        EXPECT_EQ(test::load("ball_on_sine")->motion({}).series.slopes().code, nullptr);
        GTEST_SKIP() << "no AVX-512, or machine code is off: slopes of series have no machine code to compare with";
    }
    const auto expect_same = [](const std::string& name) {
        SCOPED_TRACE(name);
        const auto model = test::load(name);
        for (const ContactSet held : {ContactSet(), ContactSet::of(0)}) {
            const std::vector<Eight> by_code = slopes_of(*model, held);
            const bool has_rules = !model->motion(held).series.slopes().plan.rules.empty();
            EXPECT_EQ(model->motion(held).series.slopes().code != nullptr, has_rules);
            const test::MachineCodeSwitch off("0");
            const auto without = test::load(name);
            const std::vector<Eight> by_loops = slopes_of(*without, held);
            EXPECT_EQ(without->motion(held).series.slopes().code, nullptr);
            ASSERT_EQ(by_code.size(), by_loops.size());
            EXPECT_EQ(std::memcmp(by_code.data(), by_loops.data(), by_code.size() * sizeof(Eight)), 0);
        }
    };
    for (const std::string& name : test::all_systems()) expect_same(name);
    for (const char* name : test::reference_systems) expect_same(name);
}

}  // namespace
}  // namespace achilles
