// Taylor coefficients of every operation, against values of the function itself.
#include "series/evaluator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <random>

#include "expression/parse.hpp"
#include "program/machine.hpp"

namespace achilles {
namespace {

// x(t) = 0.3 + 0.7 t - 0.2 t^2, y(t) = 1.2 - 0.5 t + 0.1 t^3, and the parameter p.
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
    const SeriesProgram series(program, 0, 1);
    SeriesEvaluator<double> terms(series, std::span(&p, 1));
    Evaluator<double> direct(program);
    direct.input(2) = p;
    direct.fix();
    for (int round = 0; round < 2; ++round) {  // the second round must not depend on the first
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

// The midpoint of x y is constant in time. The series follows from those of x and y, with its value at order 0.
TEST(Series, KeepMidpointsConstant) {
    Graph graph;
    const Expression x = graph.symbol(0), y = graph.symbol(1), m = midpoint(x * y);
    const Expression all = m * (x + y) * (m - graph.number(2)) - m * m + y / (graph.number(1) + m);
    const Program program(std::span(&all, 1), Slots{3, 2, 3});
    const SeriesProgram series(program, 0, 1);
    SeriesEvaluator<double> terms(series, std::span(&p, 1));
    double inputs[2] = {x_series[0], y_series[0]};
    const double value = x_series[0] * y_series[0], factor = value * (value - 2.0);
    terms.begin(inputs);
    EXPECT_NEAR(terms.start(0), factor * (inputs[0] + inputs[1]) - value * value + inputs[1] / (1.0 + value), 1e-15);
    for (int k = 1; k <= 5; ++k) {
        for (int i = 0; i < 2; ++i) inputs[i] = k < 4 ? (i == 0 ? x_series : y_series)[k] : 0.0;
        terms.extend(k, inputs);
        EXPECT_NEAR(terms.output(0), factor * (inputs[0] + inputs[1]) + inputs[1] / (1.0 + value), 1e-15) << k;
    }
    EXPECT_EQ(series.inner_sums(), 1u);  // that of x y
}

// A random plan for a given number of lanes: one coordinate, 1 to 3 event functions. Every rule has an inner sum or
// none.
struct RandomSeries {
    explicit RandomSeries(std::uint32_t lanes) : factors(lanes), random(lanes) {
        const auto any = [&](std::size_t below) { return static_cast<std::uint32_t>(random() % below); };
        std::uniform_real_distribution<double> number(-0.5, 0.5);
        plan.series = 3 + lanes;  // none, the inputs, and one per rule
        plan.lanes = lanes;
        plan.weighted = any(lanes + 1);
        for (std::uint32_t i = 0; i < lanes; ++i) {
            SeriesRule rule{3 + i, any(3 + i), any(3 + i), any(8) == 0 ? 0 : plan.series + i, {}};
            for (std::size_t f = 0; f < 3; ++f) {
                factors[i][f] = number(random);
                rule.known[f] = static_cast<std::int8_t>(any(4) == 0 ? 1 : any(4) == 0 ? -1 : 0);
            }
            plan.rules.push_back(rule);
            plan.left.push_back(1 + any(2 + lanes));
            plan.right.push_back(1 + any(2 + lanes));
        }
        plan.events = 1 + lanes / 4 % 3;
        for (std::uint32_t i = 0; i <= plan.events; ++i) plan.outputs.push_back(3 + any(lanes));
        now.assign(plan.numbers(), 0.0);
        rows.assign(plan.row() * (orders + 1), 0.0);
        states.assign(plan.states() * (orders + 1), 0.2);
        states[0] = 0.3;
        states[1] = now[1] = states[plan.states()] = 0.7;
        now[2] = states[plan.states() + 1] = -0.4;
    }
    // Makes orders from k >= 2 on, until the coefficients are below the target or the last order is reached. Returns
    // the last.
    int extend(const OrderCode* code, int k, double target) {
        const SeriesTables tables{factors.data(), now.data(), rows.data()};
        MotionOrders motion;
        motion.row = states.data() + plan.states() * static_cast<std::size_t>(k - 1);
        motion.largest = motion.row;
        motion.power = 1e9;
        motion.target = target;
        return code == nullptr ? make_orders(plan, tables, motion, k, orders)
                               : code->make_orders(tables, motion, k, orders);
    }
    void begin(const OrderCode* code) {
        const SeriesTables tables{factors.data(), now.data(), rows.data()};
        if (code == nullptr) {
            make_order(plan, tables, 1);
        } else {
            code->make_first(tables);
        }
    }
    static constexpr int orders = 20;
    SeriesPlan plan;
    std::vector<SeriesFactors> factors;
    std::vector<double> now, rows, states;
    std::mt19937_64 random;
};

// The loops and the machine code of this width give the same bits, and these are the convolution sums.
class SeriesOrders : public testing::TestWithParam<Width> {};
INSTANTIATE_TEST_SUITE_P(Every, SeriesOrders, testing::Values(Width::four, Width::eight),
                         [](const auto& width) { return width.param == Width::eight ? "AVX512" : "AVX2"; });

TEST_P(SeriesOrders, AreTheSameByLoopsAndByMachineCode) {
    const bool has_code = best_width() && GetParam() <= *best_width();
    for (const std::uint32_t lanes : {4u, 8u, 12u, 16u, 20u, 24u, 28u, 32u, 36u, 40u, 44u, 64u, 100u}) {
        std::vector<double> first;
        for (const auto width : {std::optional<Width>(), std::optional(GetParam())}) {
            RandomSeries one(lanes);
            const auto code = width ? OrderCode::of(one.plan, *width) : nullptr;
            EXPECT_EQ(code != nullptr, width && has_code);
            if (width && code == nullptr) continue;
            std::vector<double> results;
            std::vector<std::vector<double>> orders{{}};  // of the series
            one.begin(code.get());
            for (int k = 1; k <= RandomSeries::orders;) {
                const std::vector<double> now(one.now.begin(), one.now.begin() + one.plan.series + one.plan.lanes);
                results.insert(results.end(), now.begin(), now.end());
                orders.push_back(now);
                for (std::size_t l = 0; !width && l < lanes; ++l) {
                    double sum = 0.0;
                    for (int j = 1; j <= k; ++j)
                        sum += (l < one.plan.weighted ? static_cast<double>(j) / (k + 1) : 1.0) *
                               orders[static_cast<std::size_t>(j)][one.plan.left[l]] *
                               orders[static_cast<std::size_t>(k + 1 - j)][one.plan.right[l]];
                    EXPECT_NEAR(now[one.plan.series + l], sum, 1e-14 * (1.0 + std::abs(sum)));
                }
                if (k == RandomSeries::orders) break;
                const int made = one.extend(code.get(), k + 1, 0.0);  // nothing exceeds the target: one order
                ASSERT_EQ(made, ++k);
            }
            // Many orders at once, starting from the states and sums of the previous calls.
            results.push_back(one.extend(code.get(), 2, 0.3));
            results.insert(results.end(), one.states.begin(), one.states.end());
            if (!width) first = results;
            EXPECT_EQ(std::memcmp(results.data(), first.data(), first.size() * sizeof(double)), 0)
                << (width ? static_cast<int>(*width) : 0) << " wide, " << lanes << " lanes";
        }
    }
    if (!has_code) GTEST_SKIP() << "no machine code of this width: the processor does not have it, or it is off";
}

// x'' = x from (1, 1), where outputs are inputs. They must not change while the next order is written.
TEST(Series, OutputsAreNeverInputs) {
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}, {"v", graph.symbol(1)}};
    const std::vector<Expression> outputs{parse("x", scope, graph), parse("v", scope, graph)};
    const SeriesProgram series(Program(outputs, Slots{2, 2, 2}), 1, 1);
    SeriesEvaluator<double> terms(series, {});
    std::vector<double> states(3 * 11);
    states[0] = states[1] = 1.0;
    terms.begin(states.data());
    states[3] = 1.0;
    states[4] = terms.start(0);
    terms.extend(1, states.data() + 3);
    MotionOrders motion;
    motion.row = states.data() + 3;
    motion.largest = motion.row;
    motion.power = 1e9;
    EXPECT_EQ(terms.extend(motion, 2, 10), 10);
    double factorial = 1.0;
    for (std::size_t k = 2; k <= 10; ++k) {
        factorial *= static_cast<double>(k);
        EXPECT_NEAR(states[3 * k], 1.0 / factorial, 1e-16) << k;
        EXPECT_NEAR(states[3 * k + 1], 1.0 / factorial, 1e-16) << k;
        EXPECT_EQ(states[3 * k + 2], states[3 * k + 1]) << k;
    }
}

// A function undefined at the start gives NaN, at order 0 or at the next.
TEST(Series, OutsideTheDomainIsNotANumber) {
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}};
    for (const char* text : {"log(x)", "sqrt(x)", "x^(1/3)"}) {
        const Expression expression = parse(text, scope, graph);
        const SeriesProgram series(Program(std::span(&expression, 1), Slots{1, 1, 1}), 0, 1);
        SeriesEvaluator<double> terms(series, {});
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
