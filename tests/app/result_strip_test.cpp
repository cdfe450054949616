// The strip of results below the mechanism: scrolling by time and by mouse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "app/hands.hpp"

namespace achilles {
namespace {

using test::Hands;

// With dozens of results the last one reached is always visible; the number of hidden ones is shown at both ends.
TEST(ResultStrip, KeepThePresentInView) {
    for (const int width : {1024, 1600}) {
        Hands hands("driven_double_pendulum", test::surface(width, 800));
        hands.session.apply(parse_command("end 60"));
        const auto& events = hands.session.trajectory().events;
        std::size_t turns = 0, first = 0;
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (events[i].kind == Event::Kind::impact) continue;
            if (turns++ == 0) first = i;
            hands.session.apply(command::Seek{events[i].t});
            hands.state.places.clear();
            hands.rest(2);
            ASSERT_TRUE(hands.state.places.contains("result " + std::to_string(i + 1))) << width << ", " << i;
        }
        EXPECT_GT(turns, 20U);
        EXPECT_TRUE(hands.state.places.contains("results before"));
        hands.session.apply(command::Seek{0.0});
        hands.state.places.clear();
        hands.rest(2);
        EXPECT_TRUE(hands.state.places.contains("result " + std::to_string(first + 1)));
        EXPECT_FALSE(hands.state.places.contains("results before"));
        EXPECT_TRUE(hands.state.places.contains("results after"));
    }
}

// Drag, wheel and the numbers at the ends only scroll the strip; a change of the current result resets it.
TEST(ResultStrip, AreMovedByAHand) {
    Hands hands("driven_double_pendulum", test::surface(1280, 800));
    hands.session.apply(parse_command("end 60"));
    hands.session.apply(command::Seek{0.0});
    hands.rest(2);
    const auto first = [&] {
        hands.state.places.clear();
        hands.rest(1);
        int found = 1 << 20;
        for (const auto& [name, area] : hands.state.places)
            if (name.starts_with("result ")) found = std::min(found, std::atoi(name.c_str() + 7));
        return found;
    };
    const int at_first = first();
    const std::string place = "result " + std::to_string(at_first);
    hands.point(place);
    hands.hand.wheel = -1.0;
    hands.rest(1);
    hands.hand.wheel = 0.0;
    const int by_wheel = first();
    EXPECT_GT(by_wheel, at_first);
    hands.click("results after");
    const int by_click = first();
    EXPECT_GT(by_click, by_wheel);
    hands.point("result " + std::to_string(by_click));
    hands.hand.left = true;
    hands.rest(1);
    for (int i = 0; i < 12; ++i) {
        hands.hand.mouse_x += 25.0;
        hands.rest(1);
    }
    hands.hand.left = false;
    hands.rest(2);
    const int by_drag = first();
    EXPECT_LT(by_drag, by_click);
    EXPECT_TRUE(hands.all.empty()) << "a strip that is dragged selects nothing: " << to_text(hands.all.front());
    hands.click("result " + std::to_string(by_drag));
    EXPECT_EQ(hands.all, std::vector<Command>{command::Select{by_drag}});
    hands.session.apply(command::Select{0});
    hands.session.apply(command::Seek{0.0});
    hands.rest(1);
    EXPECT_EQ(first(), at_first);
}

// A dialog that opens in the frame in which the mouse enters a result. A tooltip there once crashed the program.
TEST(ResultStrip, SayNothingBehindADialog) {
    Hands hands("ball_on_sine");
    const Point at = hands.middle("result 10");
    hands.hand.mouse_x = at.x, hands.hand.mouse_y = at.y;
    hands.state.file_question = FileQuestion{"a.journal", "write a.toml", 0, {}};
    hands.rest(3);
    EXPECT_TRUE(hands.says("a.toml"));
    EXPECT_EQ(hands.tooltip().height, 0.0F);
}

}  // namespace
}  // namespace achilles
