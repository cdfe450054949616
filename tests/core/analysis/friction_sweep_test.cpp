// What a sweep prints of runs with dry friction.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/measures.hpp"
#include "analysis/sweep.hpp"
#include "analysis/table.hpp"
#include "core/systems.hpp"
#include "output/sweep_files.hpp"
#include "simulate/simulate.hpp"
#include "system/input_error.hpp"

namespace achilles::test {
namespace {

std::vector<double> printed(const std::string& text, const std::vector<std::string>& prints) {
    const auto model = typed(text);
    const SystemDescription& system = model->description();
    auto run = default_run(system);
    run.options.tolerance = 1e-15;
    run.options.end_time = 5.0;
    const RunMeasures measures(model, make_sweep({.over = {"F=4:5:2"}, .prints = prints}, run, system));
    std::vector<double> numbers;
    MeasureEvaluator(measures).at_end(simulate(model, run), numbers);
    return numbers;
}

// From (9, 3) it comes to rest at 15 - sqrt(205), at atan(3/14) + pi.
TEST(FrictionSweep, PrintsHeatSticksAndDerivatives) {
    const auto found = printed(
        R"toml(parameter = [{name = "F", value = 5}]
coordinate = [{name = "x", start = 9, rate = 3}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "x^2/2"
friction = [{name = "joint", slip = "x'", level = "F"}]
)toml",
        {"heat", "sticks", "slips", "stick_time(1)", "stick_time(2)", "slip_time", "friction_force_joint", "d(x, F)",
         "d(stick_time, x')", "d(friction_force_joint, x)", "reversals", "reversal_time(1)", "d(reversal_time, x)",
         "d(friction_force_joint^2, x)"});
    ASSERT_EQ(found.size(), 14u);
    const double A = std::sqrt(205.0), rest = 15.0 - A;
    EXPECT_NEAR(found[0], 45.0 - 0.5 * rest * rest, 1e-12);
    EXPECT_EQ(found[1], 1.0);
    EXPECT_EQ(found[2], 0.0);
    EXPECT_NEAR(found[3], std::atan(3.0 / 14.0) + std::numbers::pi, 1e-13);
    EXPECT_TRUE(std::isnan(found[4]));
    EXPECT_TRUE(std::isnan(found[5]));
    EXPECT_NEAR(found[6], rest, 1e-13);
    EXPECT_NEAR(found[7], 3.0 - 14.0 / A, 1e-12);
    EXPECT_NEAR(found[8], 14.0 / 205.0, 1e-13);
    EXPECT_NEAR(found[9], -14.0 / A, 1e-12);
    EXPECT_NEAR(found[13], -2.0 * rest * 14.0 / A, 1e-12);
    EXPECT_EQ(found[10], 1.0);
    EXPECT_NEAR(found[11], std::atan(3.0 / 14.0), 1e-13);
    EXPECT_NEAR(found[12], -3.0 / 205.0, 1e-13);
}

// The text of the modes in the CSV, which other processes send as bytes.
TEST(FrictionSweep, PrintsModes) {
    const auto model = typed(R"toml(parameter = [{name = "mu", value = 0.3}]
coordinate = [{name = "x", rate = 1}, {name = "y"}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y"
constraint = [{name = "foot", gap = "y", restitution = 0, slip = "x'", friction = "mu"}]
friction = [{name = "belt", slip = "x' - 2", level = 0.01}]
)toml");
    const SystemDescription& system = model->description();
    auto run = default_run(system);
    run.options.end_time = 2.0;
    const SweepTable table(model, make_sweep({.over = {"mu=0.2:1:2"}, .prints = {"modes", "sticks"}}, run, system));
    const Rows rows = table.rows(0, 2);
    EXPECT_EQ(sweep_csv_heading(table, false) + sweep_csv(table, rows),
              "mu,modes,sticks,outcome\n0.2,foot:slip++belt:slip-,0,end time\n1,foot:stick+belt:slip-,1,end time\n");
    EXPECT_EQ(rows_from(to_bytes(rows), table), rows);
}

TEST(FrictionSweep, HasNoSticksWithoutFriction) {
    try {
        printed(R"toml(parameter = [{name = "F", value = 5}]
coordinate = [{name = "x", start = 9, rate = 3}]
lagrangian.kinetic = "x'^2/2"
lagrangian.potential = "F*x^2/2"
)toml",
                {"sticks"});
        FAIL() << "it is accepted";
    } catch (const InputError& error) {
        EXPECT_NE(error.message.find("'sticks' needs friction, and this system has none"), std::string::npos)
            << error.message;
    }
}

}  // namespace
}  // namespace achilles::test
