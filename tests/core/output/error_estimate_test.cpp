// Output of estimated errors: JSON and summary.
#include <gtest/gtest.h>

#include "core/sensitivity/estimates.hpp"
#include "output/output.hpp"

namespace achilles::test {
namespace {

Trajectory ball(Method method) {
    const auto model = load("ball_on_sine");
    auto run = model->default_run();
    run.options.method = method;
    return simulate(model, run);
}

TEST(ErrorEstimateOutput, StandInJson) {
    const Trajectory trajectory = ball(Method::taylor);
    const auto estimate = estimate_error(trajectory);
    const auto json = nlohmann::json::parse(to_json(trajectory));
    const auto& end = json["end"]["error_estimate"];
    EXPECT_EQ(end["norm"], estimate.end->norm);
    EXPECT_EQ(end["reach"], 1.5 * estimate.end->norm + 3.0 * estimate.end->sigma);
    EXPECT_EQ(end["q"][0], estimate.end->q[0]);
    EXPECT_EQ(end["v"].size(), 2U);
    EXPECT_FALSE(json["end"].contains("no_error_estimate"));
    ASSERT_EQ(estimate.events.size(), trajectory.events.size());
    for (std::size_t i = 0; i < estimate.events.size(); ++i)
        EXPECT_EQ(json["events"][i]["error_estimate"], estimate.events[i]);
}

TEST(ErrorEstimateOutput, AreNullWithAReason) {
    const auto json = nlohmann::json::parse(to_json(ball(Method::dopri5)));
    EXPECT_TRUE(json["end"]["error_estimate"].is_null());
    EXPECT_EQ(json["end"]["no_error_estimate"], "errors are estimated only for Taylor's method (--method taylor)");
    for (const auto& event : json["events"]) EXPECT_TRUE(event["error_estimate"].is_null());
}

TEST(ErrorEstimateOutput, AreCalledAnEstimate) {
    const std::string told = summary(ball(Method::taylor));
    EXPECT_NE(told.find("\nestimated error 4e-09 at the end: an estimate, not a proof\n"), std::string::npos) << told;
    EXPECT_NE(told.find("integration error of this time: about 1e-08 s (estimate)"), std::string::npos) << told;
    EXPECT_NE(
        summary(ball(Method::dopri5)).find("\nno estimate of the error at the end: errors are estimated only for "),
        std::string::npos);
}

}  // namespace
}  // namespace achilles::test
