// There is machine code wherever the processor can run it. What compares its bits with the loops' (expression_test,
// series_test, side_by_side_test) would compare the loops with themselves if there were none.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/systems.hpp"
#include "program/program_code.hpp"
#include "series/lane_access.hpp"
#include "series/lane_order.hpp"
#include "series/lane_stepper.hpp"

namespace achilles {
namespace {

// What the processor says itself, not what core makes of it.
std::optional<Width> widest_of_processor() {
#if defined(__x86_64__) && defined(__linux__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2")) return __builtin_cpu_supports("avx512f") ? Width::eight : Width::four;
#endif
    return std::nullopt;
}

class MachineCodes : public testing::Test {
 protected:
    void SetUp() override {
        EXPECT_EQ(best_width(), widest_of_processor());
        if (!widest_of_processor()) GTEST_SKIP() << "no AVX2, or not Linux: everything is evaluated by loops";
    }
    // Where there are vectors of eight.
    static bool has_eight() { return widest_of_processor() == Width::eight; }
};

TEST_F(MachineCodes, AreMadeOfExpressions) {
    // Register 2 is x + y, 3 is that times y, 4 its sine.
    const std::vector<Instruction> instructions{
        {Operation::add, 0, 1}, {Operation::multiply, 2, 1}, {Operation::sin, 3}};
    const auto code = machine_code(instructions, 2, Width::one);
    ASSERT_TRUE(code);
    std::array<double, 5> registers{0.25, 3.0, 0.0, 0.0, 0.0};
    code->as<void(double*)>()(registers.data());
    EXPECT_EQ(registers[2], 3.25);
    EXPECT_EQ(registers[3], 9.75);
    EXPECT_EQ(registers[4], std::sin(9.75));
}

// A ball over a flat floor has nothing to sum up; these two have.
TEST_F(MachineCodes, AreMadeOfTheOrdersOfSeries) {
    for (const auto& [system, key] : test::problems) {
        const auto model = test::load(system);
        for (const SeriesProgram* series : {&model->motion({}).series, &model->motion(ContactSet::of(0)).series}) {
            EXPECT_TRUE(OrderCode::of(LaneAccess::plan_of(*series), *widest_of_processor())) << system;
        }
    }
}

TEST_F(MachineCodes, AreMadeForRunsSideBySide) {
    if (!has_eight()) GTEST_SKIP() << "no AVX-512: runs side by side are computed by the compiler's vectors";
    if (possible_vectors().front() == Vectors::portable) GTEST_SKIP() << "built without AVX-512";
    EXPECT_EQ(possible_vectors().front(), Vectors::avx512_with_machine_code);
    for (const auto& [system, key] : test::problems) {
        const auto model = test::load(system);
        EXPECT_TRUE(LaneAccess::machine_code_of(model->contact_terms())) << system;
        for (const SeriesProgram* series : {&model->motion({}).series, &model->motion(ContactSet::of(0)).series}) {
            const SeriesPlan& plan = LaneAccess::plan_of(*series);
            EXPECT_TRUE(LaneOrderCode::of(plan, LanePlan(plan, series->inner_sums()))) << system;
        }
    }
}

}  // namespace
}  // namespace achilles
