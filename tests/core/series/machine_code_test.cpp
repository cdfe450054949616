// Machine code exists on every processor that can run it, unless it is switched off. It gives the same bits as the
// loops, and its memory is never writable and executable. Without these tests, the bit comparisons (here and in
// expression_test, series_test, side_by_side_test) could compare the loops with themselves.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string_view>

#include "core/deny_executable.hpp"
#include "core/machine_code.hpp"
#include "core/systems.hpp"
#include "number/lanes.hpp"
#include "output/output.hpp"
#include "program/machine.hpp"
#include "series/evaluator.hpp"
#include "series/lane_stepper.hpp"
#include "series/order.hpp"
#include "series/series.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

// Read from the processor directly, independently of core.
std::optional<Width> widest_of_processor() {
#if ACHILLES_MACHINE_CODE
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2")) return __builtin_cpu_supports("avx512f") ? Width::eight : Width::four;
#endif
    return std::nullopt;
}

class MachineCodes : public testing::Test {
 protected:
    void SetUp() override {
        EXPECT_EQ(best_width(), widest_of_processor());
        if (!widest_of_processor()) GTEST_SKIP() << "no AVX2, or built without: everything is evaluated by loops";
    }
    // The vector widths for runs in lanes: four, or four and eight.
    static std::vector<Width> of_lanes() {
        if (widest_of_processor() == Width::eight) return {Width::four, Width::eight};
        return {Width::four};
    }

 private:
    test::MachineCodeSwitch on_{nullptr};
};

std::shared_ptr<const Model> load_without(const std::string& system) {
    const test::MachineCodeSwitch off("0");
    auto model = test::load(system);
    for (const Mode mode : {Mode(), Mode::holding(ContactSet::of(0))}) model->motion(mode);  // compiled while it is off
    return model;
}

// Register 2 is x + y, register 3 is that times y, register 4 is its sine.
constexpr Instruction few[] = {{Operation::add, 0, 1}, {Operation::multiply, 2, 1}, {Operation::sin, 3}};

// ---- where machine code exists ----

TEST_F(MachineCodes, AreMadeOfExpressions) {
    const auto code = machine_code(few, 2);
    ASSERT_TRUE(code);
    std::array<double, 5> registers{0.25, 3.0, 0.0, 0.0, 0.0};
    code->as<void(double*)>()(registers.data());
    EXPECT_EQ(registers[2], 3.25);
    EXPECT_EQ(registers[3], 9.75);
    EXPECT_EQ(registers[4], std::sin(9.75));
}

// A ball over a flat floor has no sums to vectorize; these two systems have.
TEST_F(MachineCodes, AreMadeOfTheOrdersOfSeries) {
    for (const auto& [system, key] : test::problems) {
        const auto model = test::load(system);
        for (const SeriesProgram* series :
             {&model->motion({}).series, &model->motion(Mode::holding(ContactSet::of(0))).series}) {
            EXPECT_TRUE(OrderCode::of(LaneAccess::plan_of(*series), *widest_of_processor())) << system;
        }
    }
}

TEST_F(MachineCodes, AreMadeForRunsSideBySide) {
    const auto possible = possible_vectors();
    EXPECT_EQ(std::count(possible.begin(), possible.end(), Vectors::portable_with_machine_code), 1);
    for (const auto& [system, key] : test::problems) {
        const auto model = test::load(system);
        for (const Width vectors : of_lanes()) {
            EXPECT_TRUE(LaneAccess::machine_code_of(model->contact_terms(), vectors)) << system;
            for (const SeriesProgram* series :
                 {&model->motion({}).series, &model->motion(Mode::holding(ContactSet::of(0))).series}) {
                const SeriesPlan& plan = LaneAccess::plan_of(*series);
                EXPECT_TRUE(LaneOrderCode::of(plan, LanePlan(plan, series->inner_sums()), vectors)) << system;
            }
        }
    }
}

// The widest vectors that the processor has come first. Their code is compiled by GCC only.
#if defined(__GNUC__) && !defined(__clang__)
TEST_F(MachineCodes, TakeTheWidestVectorsOfTheProcessor) {
    const auto possible = possible_vectors();
    EXPECT_EQ(possible.front(), widest_of_processor() == Width::eight ? Vectors::avx512_with_machine_code
                                                                      : Vectors::avx2_with_machine_code);
    EXPECT_EQ(std::count(possible.begin(), possible.end(), Vectors::avx2), 1);
}

// Skipped on processors without AVX-512. Then no test runs its code paths.
TEST_F(MachineCodes, TakeAvx512WhereTheProcessorHasIt) {
    if (widest_of_processor() != Width::eight) GTEST_SKIP() << "this processor has no AVX-512: its paths were not run";
    const auto possible = possible_vectors();
    EXPECT_EQ(std::count(possible.begin(), possible.end(), Vectors::avx512), 1);
}
#endif

TEST_F(MachineCodes, AreNotMadeWhereTheyAreSwitchedOff) {
    const auto model = test::load("ball_on_sine");
    const SeriesPlan& plan = LaneAccess::plan_of(model->motion({}).series);
    for (const char* value : {"", "1", "on"}) {
        const test::MachineCodeSwitch on(value);
        EXPECT_TRUE(machine_code(few, 2)) << value;
    }
    const test::MachineCodeSwitch off("0");
    EXPECT_FALSE(best_width());
    EXPECT_FALSE(machine_code(few, 2));
    EXPECT_FALSE(OrderCode::of(plan, Width::four));
    const LanePlan lanes(plan, model->motion({}).series.inner_sums());
    for (const Width vectors : {Width::four, Width::eight}) {
        EXPECT_FALSE(LaneOrderCode::of(plan, lanes, vectors));
        EXPECT_FALSE(machine_code(few, 2, Width::eight, vectors));
    }
    for (const Vectors vectors : possible_vectors()) {
        EXPECT_NE(vectors, Vectors::avx512_with_machine_code);
        EXPECT_NE(vectors, Vectors::avx2_with_machine_code);
        EXPECT_NE(vectors, Vectors::portable_with_machine_code);
    }
}

// Also run with the variable set, by the test core/without_machine_code.
TEST(MachineCodeSwitch, IsTheProgramsEnvironment) {
    const char* const given = std::getenv("ACHILLES_MACHINE_CODE");
    const bool off = given != nullptr && std::string_view(given) == "0";
    EXPECT_EQ(best_width(), off ? std::nullopt : widest_of_processor());
}

// ---- memory protection ----

struct Mapping {
    std::uintptr_t begin = 0, end = 0;
    std::string permissions, path;
};

std::vector<Mapping> mappings() {
    std::ifstream file("/proc/self/maps");
    std::vector<Mapping> all;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        Mapping one;
        std::string offset, device, inode;
        char dash = 0;
        words >> std::hex >> one.begin >> dash >> one.end >> one.permissions >> offset >> device >> inode >> one.path;
        all.push_back(one);
    }
    return all;
}

// Number of executable bytes in anonymous memory.
std::size_t bytes_of_code() {
    std::size_t bytes = 0;
    for (const Mapping& one : mappings())
        if (one.permissions[2] == 'x' && one.path.empty()) bytes += one.end - one.begin;
    return bytes;
}

TEST_F(MachineCodes, StandWhereNothingIsWritten) {
    const auto code = machine_code(few, 2);
    ASSERT_TRUE(code);
    const auto address = reinterpret_cast<std::uintptr_t>(code->as<void(double*)>());
    bool found = false;
    for (const Mapping& one : mappings()) {
        EXPECT_FALSE(one.permissions[1] == 'w' && one.permissions[2] == 'x') << one.path;
        if (address < one.begin || address >= one.end) continue;
        found = true;
        EXPECT_EQ(one.permissions, "r-xp");
    }
    EXPECT_TRUE(found);
}

TEST_F(MachineCodes, LeaveNoMemoryBehind) {
    const std::size_t before = bytes_of_code();
    const auto without = load_without("triple_pendulum");
    EXPECT_EQ(bytes_of_code(), before);
    {
        const auto with = test::load("triple_pendulum");
        EXPECT_GT(bytes_of_code(), before);
    }
    EXPECT_EQ(bytes_of_code(), before);
}

std::string run_of(const std::shared_ptr<const Model>& model) { return to_json(simulate(model, model->default_run())); }

TEST_F(MachineCodes, AreDoneWithoutWhereNoMemoryCanBeMadeExecutable) {
    enum Status { as_expected, has_code, other_bits, not_denied };
    const std::string expected = run_of(test::load("ball_on_sine"));
    const pid_t child = fork();  // the denial is permanent
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (!test::deny_executable_memory()) _exit(not_denied);
        if (machine_code(few, 2)) _exit(has_code);
        const auto model = test::load("ball_on_sine");
        make_lane_stepper(model->lane_programs(), 1e-10);
        _exit(run_of(model) == expected ? as_expected : other_bits);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == not_denied) GTEST_SKIP() << "no seccomp here";
    EXPECT_EQ(WEXITSTATUS(status), as_expected);
}

// ---- the same bits as the loops for all systems; for runs in lanes see side_by_side_test ----

// The gallery's systems with contacts, and those with explicit time in forces or gaps.
std::vector<std::string> systems_with_time() {
    std::vector<std::string> names = test::all_systems();
    std::erase_if(names, [](const std::string& name) { return test::load(name)->contacts() == 0; });
    names.insert(names.end(), std::begin(test::timed_systems), std::end(test::timed_systems));
    return names;
}

// Compares bit by bit. Returns how many are finite.
int expect_bits(const std::vector<double>& a, const std::vector<double>& b, const std::string& what) {
    EXPECT_EQ(a.size(), b.size());
    int numbers = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        EXPECT_TRUE(std::isnan(a[i]) ? std::isnan(b[i])
                                     : std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]))
            << what << ", " << i << ": " << a[i] << ", " << b[i];
        if (std::isfinite(a[i])) ++numbers;
    }
    return numbers;
}

// A random state near the start or far from it.
std::vector<double> any_state(const Model& model, std::mt19937_64& random) {
    const Run run = model.default_run();
    std::vector<double> state(run.q.begin(), run.q.end());
    state.insert(state.end(), run.v.begin(), run.v.end());
    std::normal_distribution<double> number(0.0, random() % 2 == 0 ? 0.1 : 3.0);
    for (double& x : state) x += number(random);
    return state;
}

TEST_F(MachineCodes, GiveTheValuesOfTheLoops) {
    const auto outputs = [](const Model& model, const Program& program, const std::vector<double>& state) {
        Evaluator<double> evaluator = model.evaluator(program, model.default_run().parameters);
        for (std::size_t i = 0; i < state.size(); ++i) evaluator.input(i) = state[i];
        evaluator.clock() = 10.0 * state[0];
        evaluator.run();
        std::vector<double> values;
        for (std::size_t i = 0; i < evaluator.output_count(); ++i) values.push_back(evaluator.output(i));
        return values;
    };
    for (const std::string& system : systems_with_time()) {
        const auto with = test::load(system), without = load_without(system);
        std::mt19937_64 random(8);
        const auto programs = [](const Model& model) {
            return std::vector<const Program*>{&model.motion({}).program,
                                               &model.motion(Mode::holding(ContactSet::of(0))).program,
                                               &model.gap(),
                                               &model.force(),
                                               &model.normal_acceleration(),
                                               &model.release_terms(),
                                               &model.contact_terms(),
                                               &model.definition7_terms(),
                                               &model.energy(),
                                               &model.restitution()};
        };
        for (std::size_t k = 0; k < programs(*with).size(); ++k) {
            int numbers = 0;
            for (int i = 0; i < 30; ++i) {
                const auto state = any_state(*with, random);
                numbers += expect_bits(outputs(*with, *programs(*with)[k], state),
                                       outputs(*without, *programs(*without)[k], state), system);
            }
            EXPECT_GT(numbers, 15) << system;
        }
    }
}

// All orders of the motion from this state at a start time of its own; the second order separately; order 0.
std::vector<double> orders_of(const Model& model, const SeriesProgram& program, const std::vector<double>& state) {
    const std::size_t n = state.size() / 2, events = program.events(), width = 2 * n + events;
    SeriesEvaluator<double> series(program, model.default_run().parameters);
    std::vector<double> rows(width * (SeriesEvaluator<double>::highest_order + 1));
    std::copy(state.begin(), state.end(), rows.begin());
    const auto begin = [&] {
        series.begin(rows.data(), 10.0 * state[0], 0.7);
        for (std::size_t i = 0; i < events; ++i) rows[2 * n + i] = series.start(n + i);
        for (std::size_t i = 0; i < n; ++i) {
            rows[width + i] = rows[n + i];
            rows[width + n + i] = series.start(i);
        }
        series.extend(1, rows.data() + width);
        for (std::size_t i = 0; i < events; ++i) rows[width + 2 * n + i] = series.output(n + i);
    };
    begin();
    MotionOrders motion;
    motion.row = rows.data() + width;
    motion.largest = motion.row + n;
    motion.power = 1e4;
    motion.target = 0.9;
    const int last = series.extend(motion, 2, SeriesEvaluator<double>::highest_order);
    rows.push_back(last);
    rows.push_back(motion.power);
    begin();
    series.extend(2, rows.data() + width);
    for (std::size_t i = 0; i < n + events; ++i) rows.push_back(series.output(i));
    return rows;
}

// All orders of a program that is not a motion: the distances from the edges of domains, along any given series.
std::vector<double> orders_of_edges(const Model& model, const std::vector<double>& state) {
    SeriesEvaluator<double> series(model.edge_series(), model.default_run().parameters);
    std::vector<double> orders, inputs = state;
    series.begin(inputs.data(), 10.0 * state[0], 0.7);
    for (int k = 1; k <= SeriesEvaluator<double>::highest_order; ++k) {
        for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] *= 0.3 + 0.1 * static_cast<double>(i % 3);
        series.extend(k, inputs.data());
        for (std::size_t i = 0; i < model.edges().size(); ++i) orders.push_back(series.output(i));
    }
    return orders;
}

TEST_F(MachineCodes, GiveTheDistancesFromEdgesOfTheLoops) {
    int systems = 0;
    for (const std::string& system : systems_with_time()) {
        const auto with = test::load(system), without = load_without(system);
        if (with->edges().empty()) continue;
        ++systems;
        std::mt19937_64 random(10);
        for (int i = 0; i < 30; ++i) {
            const auto state = any_state(*with, random);
            expect_bits(orders_of_edges(*with, state), orders_of_edges(*without, state), system);
        }
    }
    EXPECT_GT(systems, 2);
}

TEST_F(MachineCodes, GiveTheOrdersOfTheLoops) {
    for (const std::string& system : systems_with_time()) {
        const auto with = test::load(system), without = load_without(system);
        std::mt19937_64 random(9);
        for (const Mode mode : {Mode(), Mode::holding(ContactSet::of(0))}) {
            int numbers = 0;
            for (int i = 0; i < 30; ++i) {
                const auto state = any_state(*with, random);
                numbers += expect_bits(orders_of(*with, with->motion(mode).series, state),
                                       orders_of(*without, without->motion(mode).series, state), system);
            }
            EXPECT_GT(numbers, 30 * 3 * with->dof()) << system;
        }
    }
}

// A motion with two event functions, the gap and hddot, by the code of one run and by that of eight.
TEST_F(MachineCodes, GiveTheOrdersOfEveryEventFunction) {
    constexpr int last = 12;
    for (const std::string& system : systems_with_time()) {
        const auto model = test::load(system);
        if (model->contacts() > 1) continue;  // their gaps need other cancellation bounds
        const Equations& e = model->equations();
        const Program program(joined({e.free.f, {e.gaps[0], e.free.contacts[0].hddot}, e.pivots}),
                              model->layout().slots());
        const auto dof = static_cast<std::size_t>(model->dof()), width = 2 * dof + 2;
        const SeriesProgram series(program, dof, 2);
        EXPECT_TRUE(OrderCode::of(LaneAccess::plan_of(series), *widest_of_processor())) << system;
        std::mt19937_64 random(3);
        const std::vector<double> state = any_state(*model, random), parameters = model->default_run().parameters;
        // Row k: the coefficients of order k of q, v, h and hddot.
        const auto rows_of = [&](auto evaluator) {
            using Number = std::remove_cvref_t<decltype(evaluator.start(0))>;
            std::vector<Number> rows(width * (last + 2), Number(0.0));
            std::copy(state.begin(), state.end(), rows.begin());
            evaluator.begin(rows.data(), Number(10.0 * state[0]));
            for (std::size_t i = 0; i < 2; ++i) rows[2 * dof + i] = evaluator.start(dof + i);
            for (std::size_t i = 0; i < dof; ++i) {
                rows[width + i] = rows[dof + i];
                rows[width + dof + i] = evaluator.start(i);
            }
            if constexpr (std::is_same_v<Number, double>) {
                evaluator.extend(1, rows.data() + width);
                for (std::size_t i = 0; i < 2; ++i) rows[width + 2 * dof + i] = evaluator.output(dof + i);
                MotionOrders motion;
                motion.row = rows.data() + width;
                motion.largest = motion.row;
                for (int k = 2; k <= last; ++k) evaluator.extend(motion, k, k);
            } else {
                evaluator.extend(rows.data() + width, 1, last);
            }
            return rows;
        };
        const auto one = rows_of(SeriesEvaluator<double>(series, parameters));
        for (std::size_t k = 0; k + 2 <= last; ++k) {
            const auto factor = static_cast<double>((k + 1) * (k + 2));
            const double hddot = one[width * k + 2 * dof + 1], of_gap = factor * one[width * (k + 2) + 2 * dof];
            EXPECT_NEAR(hddot, of_gap, 1e-10 * (1.0 + std::abs(hddot))) << system << ", order " << k;
        }
        std::vector<Lanes<16>> fixed(parameters.begin(), parameters.end());
        const auto eight_by = [&](std::optional<Width> machine_code) {
            SeriesEvaluator<Lanes<16>> evaluator(series, LaneCode::of(series, machine_code));
            evaluator.fix(std::span<const Lanes<16>>(fixed));
            return rows_of(std::move(evaluator));
        };
        const auto by_loops = eight_by({});
        for (const Width vectors : of_lanes()) {
            const auto by_code = eight_by(vectors);
            for (std::size_t i = 0; i < one.size(); ++i) {
                for (std::size_t lane = 0; lane < Double8::count; ++lane)
                    EXPECT_EQ(by_code[i][lane], by_loops[i][lane]) << system << ", row " << i / width;
                EXPECT_NEAR(by_code[i][5], one[i], 1e-9 * (1.0 + std::abs(one[i]))) << system << ", row " << i / width;
            }
        }
    }
}

TEST_F(MachineCodes, GiveTheRunsOfTheLoops) {
    for (const std::string& system : systems_with_time())
        EXPECT_TRUE(run_of(test::load(system)) == run_of(load_without(system))) << system;
}

}  // namespace
}  // namespace achilles
