// The error estimate in the explorer, computed after the run without delaying it.
#include <gtest/gtest.h>

#include "app/open.hpp"

namespace achilles::test {
namespace {

TEST(EstimateInTheExplorer, IsThatOfTheRunThatIsShown) {
    Session session = test::session("ball_on_sine");
    const auto is_of_the_run = [&] {
        const ErrorEstimate expected = estimate_error(session.trajectory());
        ASSERT_NE(session.error_estimate(), nullptr);
        EXPECT_EQ(session.error_estimate()->no_estimate_reason, expected.no_estimate_reason);
        ASSERT_EQ(session.error_estimate()->end.has_value(), expected.end.has_value());
        if (expected.end) {
            EXPECT_EQ(session.error_estimate()->end->norm, expected.end->norm);
        }
    };
    is_of_the_run();
    session.apply(command::Set{"e", 0.3});
    is_of_the_run();
    session.apply(command::Open{"double_pendulum"});
    is_of_the_run();
    session.apply(command::SetMethod{Method::dopri5});
    is_of_the_run();
    EXPECT_FALSE(session.error_estimate()->end);
}

// A window does not wait for it; a settled session has it.
TEST(EstimateInTheExplorer, ComesAfterTheRun) {
    Session session = test::session("ball_on_sine", 0.0);
    session.settle();
    EXPECT_EQ(session.under_way(), nullptr);
    ASSERT_NE(session.error_estimate(), nullptr);
    session.apply(command::Set{"e", 0.3});
    session.settle();
    ASSERT_NE(session.error_estimate(), nullptr);
    EXPECT_EQ(session.error_estimate()->end->norm, estimate_error(session.trajectory()).end->norm);
}

// A run that is inaccurate at its end: first remark of the status line, pale plots, no digits. An accurate run shows
// none of these.
TEST(HorizonInTheExplorer, IsShownWhenTheEstimateIsThere) {
    const std::string file = ACHILLES_SOURCE_DIR "/tests/reference/horizon/shaker.toml";
    Session session(file, read_system(file), library());
    ASSERT_TRUE(session.horizon());
    const double horizon = *session.horizon();
    EXPECT_EQ(horizon, estimate_error(session.trajectory()).trusted_until);
    ASSERT_FALSE(session.remarks().empty());
    EXPECT_EQ(session.remarks()[0].label.find("trusted until t = "), 0U);
    EXPECT_NE(to_text(session).find("\ntrusted until "), std::string::npos);
    for (std::size_t i = 0; i < session.plots().size(); ++i) {
        const Panel& panel = session.plots()[i];
        ASSERT_FALSE(panel.beyond.curves.empty());
        if (!session.plotted().list()[i].over_time()) continue;
        for (const Curve& curve : panel.curves)
            for (const Point& point : curve.points) EXPECT_FALSE(point.x > horizon);
        for (const Curve& curve : panel.beyond.curves) {
            EXPECT_EQ(curve.stroke.color.a, pale_beyond);
            for (const Point& point : curve.points) EXPECT_FALSE(point.x < horizon);
        }
    }
    const std::vector<double> late = session.errors(0, session.at(9.0)), early = session.errors(0, session.at(1.0));
    EXPECT_TRUE(std::isinf(late.back()));
    EXPECT_LT(early.back(), 1e-6);
    session.apply(command::SetEndTime{4.0});
    EXPECT_FALSE(session.horizon());
    EXPECT_TRUE(session.remarks().empty());
    for (const Panel& panel : session.plots()) EXPECT_TRUE(panel.beyond.curves.empty());
}

// When the estimate arrives later, the plots are composed again.
TEST(HorizonInTheExplorer, ComesAfterTheRun) {
    const std::string file = ACHILLES_SOURCE_DIR "/tests/reference/horizon/shaker.toml";
    Session session(file, read_system(file), library(), 0.0);
    session.settle();
    ASSERT_TRUE(session.horizon());
    EXPECT_FALSE(session.plots()[0].beyond.curves.empty());
    EXPECT_EQ(session.remarks()[0].label.find("trusted until t = "), 0U);
}

}  // namespace
}  // namespace achilles::test
