// The derivatives of a motion as a motion of its own: against differences, and by vectors of every size.
#include "model/variation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>

#include "core/systems.hpp"
#include "expression/parse.hpp"
#include "model/model.hpp"
#include "number/lanes.hpp"
#include "program/machine.hpp"
#include "series/series_over.hpp"

namespace achilles {
namespace {

using Number = Lanes<16>;

// ---- slopes ----

constexpr int last_order = 14;
constexpr std::size_t row_count = 3;   // x, x' and an event function
using Values = std::array<double, 4>;  // of x, x', p and the time
constexpr Values start_values = {0.3, 1.2, 1.7, 0.4};
constexpr std::uint32_t variable_order[] = {3, 0, 2, 1};  // their order does not matter
constexpr std::uint32_t directions = 2;                   // sixteen variables, of which the last four are those

// x'' is this expression of x, y = x', the parameter p and the time t, and so is the gap.
struct Written {
    explicit Written(const std::string& text) {
        Scope scope;
        scope.allowed = {
            {"x", graph.symbol(0)}, {"y", graph.symbol(1)}, {"p", graph.symbol(2)}, {"t", graph.symbol(3)}};
        motion.f = {parse(text, scope, graph)};
        motion.event_functions = {parse("x - 2*(" + text + ")*y", scope, graph)};
    }
    SeriesProgram series() const {
        return SeriesProgram(Program(joined({motion.f, motion.event_functions}), layout.slots()), 1, 1);
    }
    Graph graph;
    Layout layout{.dof = 1, .p = 1};
    ModeDynamics motion;
};

SeriesOver<double> expansion(const SeriesProgram& program, const Values& at) {
    SeriesOver<double> series(program);
    series.fix(std::span(&at[2], 1));
    series.begin(at.data(), at[3]);
    series.extend(1, last_order);
    return series;
}

// The derivative by four values beside the start. Its error is of fourth order in their distance.
double difference(const SeriesProgram& program, std::size_t variable, int k, std::size_t i) {
    constexpr double h = 0x1p-11;
    const auto at = [&](double distance) {
        Values values = start_values;
        values[variable] += distance;
        return expansion(program, values).coefficient(k, i);
    };
    return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
}

void expect_slopes(const std::string& text) {
    SCOPED_TRACE(text);
    const Written written(text);
    const MotionVariation variation = make_variation(written.motion, written.layout, directions);
    const Slots slots = variation.layout.slots();
    std::vector<Number> numbers(slots.count, 0.0);
    for (std::uint32_t i = 0; i < 3; ++i) numbers[variation.layout.input(0, i)] = start_values[i];
    for (std::uint32_t d = 0; d < 4; ++d)
        numbers[variation.layout.input(directions, variable_order[d])].set(4 + d, 1.0);
    SeriesOver<Number> series(variation.series, variation.code);
    series.fix(
        std::span<const Number>(numbers).subspan(slots.parameters_begin, slots.clock() - slots.parameters_begin));
    for (int round = 0; round < 2; ++round) series.begin(numbers.data(), start_values[3]);  // nothing may be left
    series.extend(1, last_order);
    const SeriesProgram program = written.series();
    const SeriesOver<double> values = expansion(program, start_values);
    // Rows are x and its slopes, x' and its slopes, the gap and its slopes.
    const auto coefficient = [&](std::uint32_t copy, int k, std::size_t i) {
        return series.coefficient(k, i * variation.layout.copies() + copy);
    };
    for (const int k : {0, 1, 2, 3, 5, 8, last_order})
        for (std::size_t i = 0; i < row_count; ++i) {
            const Number value = coefficient(0, k, i), slope = coefficient(directions, k, i);
            double size = std::abs(value[0]);
            for (std::size_t d = 0; d < 4; ++d) size = std::max(size, std::abs(slope[4 + d]));
            for (std::size_t lane = 0; lane < Double8::count; ++lane)
                EXPECT_NEAR(value[lane], values.coefficient(k, i), 1e-13 * size) << k << ", " << i;
            for (std::size_t d = 0; d < 4; ++d) {
                EXPECT_EQ(slope[d], 0.0);
                EXPECT_NEAR(slope[4 + d], difference(program, variable_order[d], k, i), 1e-7 * size)
                    << k << ", " << i << ", " << d;
                EXPECT_EQ(coefficient(1, k, i)[d], 0.0);
            }
        }
}

TEST(Variation, HasSlopesThatAreLimitsOfDifferences) {
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

TEST(Variation, HasAnInputForEveryCopy) {
    const VariationLayout layout{3, 4, 2};
    std::set<std::uint32_t> inputs;
    for (std::uint32_t copy = 0; copy < layout.copies(); ++copy)
        for (std::uint32_t slot = 0; slot <= 2 * layout.dof + layout.p; ++slot) inputs.insert(layout.input(copy, slot));
    const Slots slots = layout.slots();
    EXPECT_EQ(inputs.size(), slots.count);
    EXPECT_EQ(*inputs.rbegin(), slots.clock());
    EXPECT_EQ(layout.input(0, 2 * layout.dof + layout.p), slots.clock());
    EXPECT_EQ(slots.parameters_begin, 2 * layout.coordinates());
}

TEST(Variation, HasNoGapsOfHeldContacts) {
    const auto model = test::load("newtons_cradle");
    const Mode held = Mode::holding(ContactSet::of(0));
    const MotionVariation& variation = model->variation(held, 1);
    const auto n = static_cast<std::size_t>(model->dof());
    SeriesOver<Number> series(variation.series, variation.code);
    const Slots slots = variation.layout.slots();
    series.fix(std::span<const Number>(std::vector<Number>(slots.clock() - slots.parameters_begin, 1.0)));
    series.begin(std::vector<Number>(4 * n, 0.5).data(), 0.0);
    const std::size_t contacts = model->contacts(), gaps = 4 * n;
    for (const std::size_t copy : {0, 1}) {
        EXPECT_EQ(series.coefficient(0, gaps + copy * contacts)[0], 0.0);
        EXPECT_NE(series.coefficient(0, gaps + copy * contacts + 1)[0], 0.0);
    }
}

// ---- vectors of every size ----

// All orders of a system's motion and of its derivatives in random directions, made by this many orders at a time.
std::vector<std::uint64_t> bits_of_series(const Model& model, const MotionVariation& variation, const LaneCode& code,
                                          int at_once) {
    constexpr int last = 20, first = 4;
    const Run run = model.default_run();
    const VariationLayout& layout = variation.layout;
    const Slots slots = layout.slots();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    std::vector<Number> numbers(slots.count, 0.0);
    const auto n = static_cast<std::uint32_t>(model.dof());
    for (std::uint32_t i = 0; i < n; ++i) {
        numbers[layout.input(0, i)] = run.q[static_cast<Eigen::Index>(i)] + 0.01 * any(random);
        numbers[layout.input(0, n + i)] = run.v[static_cast<Eigen::Index>(i)] + 0.01 * any(random);
    }
    for (std::uint32_t i = 0; i < run.parameters.size(); ++i) numbers[layout.input(0, 2 * n + i)] = run.parameters[i];
    for (std::uint32_t copy = 1; copy < layout.copies(); ++copy)
        for (std::uint32_t slot = 0; slot <= model.layout().t(); ++slot)
            for (std::size_t lane = 0; lane < Double8::count; ++lane)
                numbers[layout.input(copy, slot)].set(lane, any(random));
    SeriesOver<Number> series(variation.series, code);
    series.fix(
        std::span<const Number>(numbers).subspan(slots.parameters_begin, slots.clock() - slots.parameters_begin));
    series.begin(numbers.data(), 0.25);
    series.extend(1, first);
    for (int k = first + 1; k <= last; k += at_once) series.extend(k, std::min(k + at_once - 1, last));
    std::vector<std::uint64_t> bits;
    for (int k = 0; k <= last; ++k)
        for (std::size_t i = 0; i < slots.parameters_begin + layout.copies() * model.contacts(); ++i)
            for (std::size_t lane = 0; lane < Double8::count; ++lane)
                bits.push_back(std::bit_cast<std::uint64_t>(series.coefficient(k, i)[lane]));
    return bits;
}

// Machine code treats numbers that are the same in all lanes differently. In these systems all results, some of them, or
// only few of them fit in registers.
TEST(Variation, HasTheSameBitsByVectorsOfEverySize) {
    for (const char* name : {"ball_on_sine", "double_pendulum", "ball_in_gusts", "triple_pendulum", "kneed_leg"}) {
        const auto model = test::load(name);
        for (const Mode mode : {Mode(), Mode::holding(ContactSet::of(0))})
            for (const std::uint32_t copies : {1u, 2u}) {
                SCOPED_TRACE(std::string(name) + (mode.is_free() ? ", free, " : ", held, ") + std::to_string(copies));
                const MotionVariation& variation = model->variation(mode, copies);
                std::vector<bool> varied(variation.layout.slots().count, false);
                for (std::uint32_t copy = 1; copy <= copies; ++copy)
                    for (std::uint32_t slot = 0; slot <= model->layout().t(); ++slot)
                        varied[variation.layout.input(copy, slot)] = true;
                const auto bits = [&](std::optional<Width> vectors, int at_once) {
                    return bits_of_series(*model, variation, LaneCode::of(variation.series, vectors, varied), at_once);
                };
                const std::vector<std::uint64_t> by_loops = bits({}, 20);
                EXPECT_EQ(bits({}, 1), by_loops);
                for (const Width vectors : {Width::four, Width::eight}) {
                    if (!best_width() || vectors > *best_width()) continue;
                    for (const int at_once : {1, 3, 20}) EXPECT_EQ(bits(vectors, at_once), by_loops) << at_once;
                }
            }
    }
}

}  // namespace
}  // namespace achilles
