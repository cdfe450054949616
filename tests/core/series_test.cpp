// Taylor coefficients of every operation, against values of the function itself.
#include "series/series.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "expression/parse.hpp"
#include "series/convolution.hpp"

namespace achilles {
namespace {

// x(t) = 0.3 + 0.7 t - 0.2 t^2, y(t) = 1.2 - 0.5 t + 0.1 t^3; the parameter p.
constexpr double x_series[] = {0.3, 0.7, -0.2, 0.0}, y_series[] = {1.2, -0.5, 0.0, 0.1};
constexpr double p = 1.7, t = 0.05;

double at(const double* series) { return ((series[3] * t + series[2]) * t + series[1]) * t + series[0]; }

void expect_series(const std::string& text) {
    SCOPED_TRACE(text);
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}, {"y", graph.symbol(1)}, {"p", graph.symbol(2)}};
    const Expression expression = parse(text, scope, graph);
    const Program program(std::span(&expression, 1), Slots{3, 2, 3});
    const SeriesProgram series(program, 1);
    SeriesEvaluator terms(series, std::span(&p, 1));
    Evaluator<double> direct(program);
    direct.input(2) = p;
    direct.fix();
    for (int round = 0; round < 2; ++round) {  // nothing may be left of the first
        double inputs[2] = {x_series[0], y_series[0]};
        terms.begin(inputs);
        double sum = terms.start(0), power = 1.0;
        for (int k = 1; k <= 24; ++k) {
            for (int i = 0; i < 2; ++i) inputs[i] = k < 4 ? (i == 0 ? x_series : y_series)[k] : 0.0;
            terms.extend(k, inputs);
            power *= t;
            sum += terms.output(0) * power;
        }
        direct.input(0) = at(x_series);
        direct.input(1) = at(y_series);
        direct.run();
        EXPECT_NEAR(sum, direct.output(0), 4e-15 * (1.0 + std::abs(sum)));
    }
}

TEST(Series, SumTheirTermsToTheFunction) {
    for (const char* text : {"x",
                             "p",
                             "x + y",
                             "x - p*y",
                             "-x",
                             "3*x",
                             "x*p",
                             "x*y",
                             "x/y",
                             "x/p",
                             "p/x",
                             "1/x",
                             "x^2",
                             "y^3",
                             "x^7",
                             "y^-3",
                             "(x - 0.3)^4",
                             "(x - 0.3)^2*y",

                             "y^(1/3)",

                             "sqrt(y)",
                             "exp(x)",
                             "log(y)",
                             "sin(x)",
                             "cos(x)",
                             "sin(x) + cos(x)",
                             "tan(x)",
                             "asin(x)",
                             "acos(x)",
                             "atan(y)",
                             "sinh(x)",
                             "cosh(x)",
                             "tanh(y)",
                             "sin(p*x + y)*cos(p*x + y)",
                             "sin(p)*x",
                             "2^x",
                             "y^pi",
                             "exp(sin(x)/(2 + cos(y)))",
                             "sqrt(x^2 + y^2)",
                             "(p*x + 2*y - 1)*(x - p*y)/(3 + x - y)",
                             "log(1 + x^2)*atan(x*y)",
                             "(x + y)/p - sin(x + y)*(x + y)^2",
                             "x + y + x*y + x^2 + y^2 + sin(x) + cos(y) + exp(x)"})
        expect_series(text);
}

// All that a processor offers give the same bits as a plain loop in the same order.
TEST(Series, InnerSumsAreTheSameInEveryVersion) {
    constexpr int orders = 20;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (const std::size_t lanes : {8u, 16u, 24u, 32u, 40u, 64u}) {
        std::vector<double> rows(2 * lanes * orders);
        for (double& x : rows) x = number(random);
        const InnerSumsVersions versions = inner_sums_versions();
        ASSERT_GE(versions.count, 1u);
        std::vector<std::vector<double>> results(versions.count);
        for (std::size_t v = 0; v < versions.count; ++v) {
            std::vector<double> older(lanes), sums(lanes);
            for (int k = 1; k <= orders; ++k) {
                versions.version[v].function(rows.data(), lanes, k, older.data(), sums.data());
                results[v].insert(results[v].end(), sums.begin(), sums.end());
            }
            EXPECT_EQ(results[v], results[0]) << versions.version[v].name;
        }
        for (int k = 1; k <= orders; ++k) {
            for (std::size_t l = 0; l < lanes; ++l) {
                double sum = 0.0;
                for (int j = 1; j < k; ++j)
                    sum += rows[2 * lanes * static_cast<std::size_t>(j) + l] *
                           rows[2 * lanes * static_cast<std::size_t>(k - j) + lanes + l];
                EXPECT_NEAR(results[0][static_cast<std::size_t>(k - 1) * lanes + l], sum, 1e-14);
            }
        }
    }
}

// A function that is not defined at the start gives no number, at order 0 or at the next.
TEST(Series, OutsideTheDomainIsNotANumber) {
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}};
    for (const char* text : {"log(x)", "sqrt(x)", "x^(1/3)"}) {
        const Expression expression = parse(text, scope, graph);
        const SeriesProgram series(Program(std::span(&expression, 1), Slots{1, 1, 1}), 1);
        SeriesEvaluator terms(series, {});
        for (const double x : {-1.0, 0.0}) {
            terms.begin(&x);
            const double rate = 1.0;
            terms.extend(1, &rate);
            EXPECT_FALSE(std::isfinite(terms.start(0)) && std::isfinite(terms.output(0))) << text << " at " << x;
        }
    }
}

}  // namespace
}  // namespace achilles
