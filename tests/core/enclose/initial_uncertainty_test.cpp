// Uncertainties as typed around a run, and the boxes that they define.
#include "enclose/initial_uncertainty.hpp"

#include <gtest/gtest.h>

#include "core/systems.hpp"
#include "system/input_error.hpp"

namespace achilles::test {

TEST(InitialUncertainty, IsReadAndWritten) {
    const auto model = load("ball_on_sine");
    const SystemDescription& ball = model->description();
    EXPECT_FALSE(parse_interval("e=0.5", ball));
    const auto e = parse_interval(" e = 2/5..0.6", ball), rate = parse_interval("x'=-1e-3..1.5", ball);
    ASSERT_TRUE(e && rate);
    EXPECT_EQ(e->name, "e");
    EXPECT_EQ(to_text(*e), "e=0.4..0.6");
    EXPECT_EQ(to_text(*rate), "x'=-0.001..1.5");
    EXPECT_EQ(parse_interval(to_text(*rate), ball), rate);
    for (const char* wrong : {"e=0.6..0.5", "z=0..1", "e=0.5..", "e=..1", "e=0..x"})
        EXPECT_THROW(parse_interval(wrong, ball), InputError) << wrong;
    EXPECT_EQ(achilles::describe(InitialUncertainty()), "");
    EXPECT_EQ(achilles::describe(InitialUncertainty{1e-6, {*e}}), "start \u00b1 1e-06, e in [0.4, 0.6]");
    EXPECT_EQ(achilles::describe(InitialUncertainty{0.0123456789, {}}), "start \u00b1 0.0123456789")
        << "no more than is proved";
}

TEST(InitialUncertainty, MakesBoxes) {
    const auto model = load("ball_on_sine");
    const achilles::Run run = model->default_run();
    const achilles::EnclosureProblem claim =
        problem_of(model->description(), run, {1e-6, {{"e", 0.4, 0.6}, {"x'", 1.0, 2.0}}});
    EXPECT_TRUE(claim.parameters.back().contains(0.4) && claim.parameters.back().contains(0.6));
    EXPECT_LT(width(claim.parameters.back()), 0.2000001);
    EXPECT_EQ(claim.parameters.front().lo(), run.parameters.front());
    EXPECT_LE(claim.v[0].lo(), 1.0 - 1e-6);  // also around the interval
    EXPECT_GE(claim.v[0].hi(), 2.0 + 1e-6);
    EXPECT_NEAR(width(claim.q[1]), 2e-6, 1e-12);
    // The double nearest to 0.3 is below 0.3; the box contains the decimal.
    const achilles::EnclosureProblem wide = problem_of(model->description(), run, {0.3, {}});
    EXPECT_LT(wide.q[0].lo(), -0.3);
    EXPECT_GT(wide.q[0].hi(), 0.3);
}

}  // namespace achilles::test
