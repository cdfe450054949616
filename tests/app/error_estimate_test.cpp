// The explorer's estimate of a run's error: beside the run, never before it.
#include <gtest/gtest.h>

#include "app/open.hpp"

namespace achilles::test {
namespace {

TEST(EstimateInTheExplorer, IsThatOfTheRunThatIsShown) {
    Session session = test::session("ball_on_sine");
    const auto is_of_the_run = [&] {
        const ErrorEstimate expected = estimate_error(session.trajectory());
        ASSERT_NE(session.error_estimate(), nullptr);
        EXPECT_EQ(session.error_estimate()->none_since, expected.none_since);
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
    session.apply(command::UseMethod{Method::dopri5});
    is_of_the_run();
    EXPECT_FALSE(session.error_estimate()->end);
}

// Nobody waits for it in a window; at rest it is there.
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

}  // namespace
}  // namespace achilles::test
