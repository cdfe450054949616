// Taylor coefficients over numbers with their slopes, against differences of those over double; and by machine code.
#include "series/series_over.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "core/machine_code.hpp"
#include "core/systems.hpp"
#include "expression/parse.hpp"
#include "number/jet.hpp"
#include "series/lane_kinds.hpp"

namespace achilles {
namespace {

constexpr int last_order = 14;
constexpr std::size_t row_count = 3;   // x, x' and an event function
using Values = std::array<double, 4>;  // of x, x', p and the time
constexpr Values start_values = {0.3, 1.2, 1.7, 0.4};
constexpr std::size_t variable_order[] = {3, 0, 2, 1};  // variable d is this one of them: in whatever order

// x'' is this expression of x, y = x', the parameter p and the time t, and so is an event function.
SeriesProgram make_series(const std::string& text) {
    Graph graph;
    Scope scope;
    scope.allowed = {{"x", graph.symbol(0)}, {"y", graph.symbol(1)}, {"p", graph.symbol(2)}, {"t", graph.symbol(3)}};
    const Expression outputs[] = {parse(text, scope, graph), parse("x - 2*(" + text + ")*y", scope, graph)};
    return SeriesProgram(Program(outputs, Slots{4, 2, 3}), 1, 1);
}

template <class Number>
SeriesOver<Number> expansion(const SeriesProgram& program, const std::array<Number, 4>& at) {
    SeriesOver<Number> series(program);
    series.fix(std::span(&at[2], 1));
    for (int round = 0; round < 2; ++round) series.begin(at.data(), at[3]);  // nothing may be left of the first
    for (int k = 1; k <= last_order; ++k) series.extend(k, k);
    return series;
}

// By four values beside the start, to the fourth power of their distance.
double difference(const SeriesProgram& program, std::size_t variable, int k, std::size_t i) {
    constexpr double h = 0x1p-11;
    const auto at = [&](double distance) {
        Values values = start_values;
        values[variable] += distance;
        return expansion<double>(program, values).coefficient(k, i);
    };
    return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
}

void expect_slopes(const std::string& text) {
    SCOPED_TRACE(text);
    using Number = Jet8<16>;
    const SeriesProgram program = make_series(text);
    std::array<Number, 4> numbers;
    for (std::size_t d = 0; d < 4; ++d)
        numbers[variable_order[d]] = Number::variable(start_values[variable_order[d]], d);
    const SeriesOver<Number> series = expansion(program, numbers);
    const SeriesOver<double> values = expansion(program, start_values);
    for (const int k : {0, 1, 2, 3, 5, 8, last_order})
        for (std::size_t i = 0; i < row_count; ++i) {
            const Number& c = series.coefficient(k, i);
            double size = std::abs(c.value);
            for (std::size_t d = 0; d < 4; ++d) size = std::max(size, std::abs(c.slope[d]));
            EXPECT_NEAR(c.value, values.coefficient(k, i), 1e-13 * size) << k << ", " << i;
            for (std::size_t d = 0; d < 4; ++d)
                EXPECT_NEAR(c.slope[d], difference(program, variable_order[d], k, i), 1e-7 * size)
                    << k << ", " << i << ", " << d;
            for (std::size_t d = 4; d < Double8::count; ++d) EXPECT_EQ(c.slope[d], 0.0);
        }
}

TEST(SeriesOver, HasSlopesThatAreLimitsOfDifferences) {
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

// Makes one order of a motion with its slopes, from random numbers and with vectors of one size. Returns all numbers.
std::vector<double> random_order(const SeriesProgram& program, decltype(PortableLanes::make_motion_order)* make) {
    using Number = Jet8<16>;
    constexpr std::size_t k = 5;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto fill = [&](std::vector<Number>& numbers) {
        for (Number& number : numbers) {
            number = any(random);
            for (std::size_t i = 0; i < Number::directions; ++i) number.slope.set(i, any(random));
        }
    };
    const SeriesPlan& plan = LaneAccess::plan_of(program);
    const InnerSums<Number> sums(plan, program.inner_sums());
    std::vector<Number> now(plan.numbers()), rows(sums.row() * (k + 2)), states(plan.states() * (k + 1)),
        factors(3 * plan.rules.size());
    for (std::vector<Number>* numbers : {&now, &rows, &states, &factors}) fill(*numbers);
    std::vector<std::array<Number, 3>> by_rule;
    for (std::size_t i = 0; i < factors.size(); i += 3) by_rule.push_back({factors[i], factors[i + 1], factors[i + 2]});
    make(plan, sums, {by_rule.data(), now.data(), rows.data()}, states.data() + k * plan.states(), k);
    std::vector<double> all;
    for (const std::vector<Number>* numbers : {&now, &rows, &states})
        for (const Number& number : *numbers) {
            all.push_back(number.value);
            for (std::size_t i = 0; i < Number::directions; ++i) all.push_back(number.slope[i]);
        }
    return all;
}

TEST(SeriesOver, SlopesAreTheSameByVectorsOfEverySize) {
    for (const char* name : {"double_pendulum", "ball_in_gusts", "kneed_leg"}) {
        const auto model = test::load(name);
        const SeriesProgram& program = model->motion(Mode()).series;
        const std::vector<double> narrow = random_order(program, PortableLanes::make_motion_order);
        ASSERT_GT(std::count_if(narrow.begin(), narrow.end(), [](double x) { return std::isfinite(x); }), 100);
#ifdef ACHILLES_HAS_WIDE_LANES
        if (__builtin_cpu_supports("avx2") != 0) {
            EXPECT_EQ(random_order(program, Avx2Lanes::make_motion_order), narrow) << name;
        }
        if (__builtin_cpu_supports("avx512f") != 0) {
            EXPECT_EQ(random_order(program, Avx512Lanes::make_motion_order), narrow) << name;
        }
#endif
    }
}

// The coefficients of a system's motion, made by so many orders at a time: order 21 of q and v alone.
std::vector<double> coefficients_of(const Model& model, Mode mode, int at_once) {
    const Run run = model.default_run();
    const auto n = static_cast<std::size_t>(model.dof());
    SeriesOver<double> series(model.motion(mode).series);
    series.fix(run.parameters);
    std::vector<double> state(run.q.begin(), run.q.end());
    state.insert(state.end(), run.v.begin(), run.v.end());
    constexpr int last = 20;
    if (at_once < last) {
        series.begin(state.data(), 0.25);
        for (int k = 1; k <= last + 1; k += at_once) series.extend(k, std::min(k + at_once - 1, last + 1));
    } else {
        series.expand(state.data(), 0.25, last);
    }
    std::vector<double> all;
    for (int k = 0; k <= last + 1; ++k)
        for (std::size_t i = 0; i < 2 * n + (k > last ? 0 : model.contacts()); ++i)
            all.push_back(series.coefficient(k, i));
    return all;
}

TEST(SeriesOver, HasTheSameBitsByMachineCodeAndByAnyNumberOfOrdersAtOnce) {
    const auto expect_same = [](const std::string& name) {
        SCOPED_TRACE(name);
        const auto model = test::load(name);
        for (const Mode mode : {Mode(), Mode::holding(ContactSet::of(0))}) {
            if (model->contacts() == 0 && !mode.is_free()) continue;
            const std::vector<double> by_code = coefficients_of(*model, mode, 20);
            const test::MachineCodeSwitch off("0");
            const auto without = test::load(name);
            for (const int at_once : {1, 3, 20}) {
                const std::vector<double> by_loops = coefficients_of(*without, mode, at_once);
                ASSERT_EQ(by_code.size(), by_loops.size());
                EXPECT_EQ(std::memcmp(by_code.data(), by_loops.data(), by_code.size() * sizeof(double)), 0) << at_once;
            }
        }
    };
    for (const std::string& name : test::all_systems()) expect_same(name);
    for (const char* name : test::reference_systems) expect_same(name);
}

}  // namespace
}  // namespace achilles
