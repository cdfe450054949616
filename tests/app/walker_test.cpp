// Walkers in the explorer: the slope slider shows their steps at once, and the branch of a gait is followed.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/hands.hpp"

namespace achilles {
namespace {

using test::Hands;

std::ptrdiff_t steps_of(const Session& session) {
    const auto& events = session.trajectory().events;
    return std::count_if(events.begin(), events.end(), [](const Event& event) { return event.is_jump(); });
}

TEST(WalkerWindow, ShowsItsStepsAtOnceUnderTheSlopeSlider) {
    Hands hands("compass_gait");
    hands.point("set slope", 0.5);
    hands.hand.left = true;
    hands.rest(1);
    const Rectangle slider = hands.state.places.at("set slope");
    double last = *hands.session.value("slope");
    for (double share = 0.6; share < 0.8; share += 0.04) {
        hands.hand.mouse_x = slider.x + share * slider.width;
        hands.rest(2);
        const double slope = *hands.session.value("slope");
        EXPECT_GT(slope, last);
        last = slope;
        EXPECT_EQ(hands.session.trajectory().run.parameters, hands.session.run().parameters);
        EXPECT_GE(steps_of(hands.session), 3) << slope;
    }
    hands.hand.left = false;
    hands.rest(2);
    EXPECT_EQ(hands.session.error(), "");
    hands.press_with_control('Z');
    EXPECT_EQ(hands.session.run(), hands.session.file_run()) << "a slider that is dragged is one change";
}

TEST(WalkerWindow, FollowsTheBranchOfTheGait) {
    Session session = test::session("compass_gait");
    session.apply(command::FindOrbit{"--continue slope=0.05:0.06"});
    ASSERT_EQ(session.error(), "");
    const auto found = session.orbit();
    ASSERT_TRUE(found && found->answer.branch);
    ASSERT_GT(found->count(), 3u);
    for (std::size_t i = 0; i < found->count(); ++i) {
        session.apply(command::SelectBranchPoint{static_cast<int>(i) + 1});
        ASSERT_EQ(session.error(), "");
        EXPECT_EQ(*session.value("slope"), found->answer.branch->value(found->point(i)));
        const double begin = session.run().options.start_time, period = found->point(i).period;
        const State first = session.at(begin).state, last = session.at(begin + period).state;
        EXPECT_LT((last.q - first.q).norm() + (last.v - first.v).norm(), 1e-7) << i;
    }
}

}  // namespace
}  // namespace achilles
