// Sliders: typing, resetting, markers, undo.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "app/hands.hpp"
#include "output/output.hpp"
#include "panels/slider.hpp"
#include "session/replay_script.hpp"

namespace achilles {
namespace {

// With the accuracy section unfolded.
struct SliderHand : test::Hands {
    explicit SliderHand(const std::string& system) : Hands(system) {
        session.apply(command::Show{"accuracy", true});
        rest(2);
    }
};

TEST(Slider, ADoubleClickTypesAValueAndMovesNothing) {
    for (const char* place : {"set g", "value of set g"}) {
        SliderHand hands("ball_on_sine");
        hands.double_click(place, 0.9);
        EXPECT_EQ(hands.session.run().parameters[1], 1.0) << "the first click moved it, the second took that back";
        EXPECT_EQ(hands.state.typed.id, "set g");
        EXPECT_TRUE(hands.all.empty()) << "it moved, be it there and back";
        hands.type("9.806650001");
        hands.press(key::enter);
        EXPECT_EQ(hands.session.run().parameters[1], 9.806650001) << place;
        EXPECT_EQ(hands.state.typed.id, "");
        hands.press_with_control('Z');
        EXPECT_EQ(hands.session.run().parameters[1], 1.0) << "one change";
        EXPECT_FALSE(hands.session.can_undo());
    }
}

TEST(Slider, EscapeDiscardsTheTypedValue) {
    SliderHand hands("ball_on_sine");
    hands.double_click("value of set g");
    hands.type("5");
    hands.press(key::escape);
    EXPECT_EQ(hands.session.run().parameters[1], 1.0);
    EXPECT_EQ(hands.state.typed.id, "");
    EXPECT_TRUE(hands.all.empty());
}

// Number of pixels in this color within a control.
int pixels(SliderHand& hands, const std::string& place, const Color& color) {
    const Image picture = hands.picture();
    const Rectangle r = hands.state.places.at(place);
    int count = 0;
    for (int y = static_cast<int>(r.y); y < static_cast<int>(r.y + r.height); ++y)
        for (int x = static_cast<int>(r.x); x < static_cast<int>(r.x + r.width); ++x) {
            const std::size_t at = 3 * static_cast<std::size_t>(y * picture.width + x);
            count += picture.rgb[at] == color.r && picture.rgb[at + 1] == color.g && picture.rgb[at + 2] == color.b;
        }
    return count;
}

TEST(Slider, WhatIsNoNumberTurnsTheFieldRedAndSaysWhy) {
    for (const auto& [text, why] :
         {std::pair{"0,4", "write a decimal point, 0.4"}, std::pair{"abc", "pi is the only name allowed here"},
          std::pair{"1/", "ends where a value"}, std::pair{"30 deg", "the unit is rad"}}) {
        SliderHand hands("ball_on_sine");
        hands.double_click("value of set g");
        EXPECT_EQ(pixels(hands, "set g", light_theme().error_card), 0);
        hands.type(text);
        hands.press(key::enter);
        EXPECT_EQ(hands.session.run().parameters[1], 1.0);
        EXPECT_TRUE(hands.all.empty()) << text;
        EXPECT_EQ(hands.state.typed.id, "set g") << text;
        EXPECT_NE(hands.state.typed.wrong.find(why), std::string::npos) << hands.state.typed.wrong;
        EXPECT_GT(pixels(hands, "set g", light_theme().error_card), 500) << text;
        // The text stays until it is corrected or cancelled.
        hands.click("set g");
        hands.press_with_control('A');
        hands.type("1/3");
        EXPECT_EQ(hands.state.typed.wrong, "") << "it is another text";
        hands.press(key::enter);
        EXPECT_EQ(hands.session.run().parameters[1], 1.0 / 3.0);
        EXPECT_EQ(hands.state.typed.id, "");
    }
    SliderHand hands("ball_on_sine");
    hands.double_click("value of set g");
    hands.type("0,4");
    hands.press(key::enter);
    hands.press(key::escape);
    EXPECT_EQ(hands.state.typed.id, "");
    EXPECT_EQ(hands.session.run().parameters[1], 1.0);
}

TEST(Slider, AnAngleIsTypedInDegrees) {
    SliderHand hands("double_pendulum");
    hands.double_click("value of set theta1");
    EXPECT_EQ(hands.state.typed.text, "30");
    hands.type("-45");
    hands.press(key::enter);
    EXPECT_NEAR(hands.session.run().q[0], -0.78539816339744831, 1e-15);
    for (const char* text : {"90/2 deg", "90/2", "pi/4", "1/4*pi rad"}) {
        hands.session.apply(parse_command("set theta1 0.1"));
        hands.rest(30);  // otherwise the clicks would count as the third and fourth
        hands.double_click("value of set theta1");
        hands.type(text);
        hands.press(key::enter);
        EXPECT_NEAR(hands.session.run().q[0], 0.78539816339744831, 1e-15) << text;
    }
}

TEST(Slider, ARightClickPutsBackExactlyWhatTheFileHas) {
    SliderHand hands("double_pendulum");
    const auto file = hands.session.model()->default_run();
    for (const char* line :
         {"set m1 2.5", "set theta1 0.3", "set theta2' 0.7", "tolerance 1e-7", "end 12", "eps 1e-3 1e-4 1e-5"})
        hands.session.apply(parse_command(line));
    ASSERT_EQ(hands.session.error(), "");
    hands.rest(2);
    for (const char* place :
         {"set m1", "value of set theta1", "set theta2'", "tolerance", "end", "eps q", "value of eps v", "eps t"}) {
        hands.all.clear();
        hands.right_click(place);
        std::erase(hands.all, Command(command::EndEdit{}));  // ends the change of the previous slider
        EXPECT_EQ(hands.all.size(), 1U) << place;
    }
    const auto now = hands.session.run();
    EXPECT_EQ(now.parameters, file.parameters);
    EXPECT_EQ(now.q, file.q);
    EXPECT_EQ(now.v, file.v);
    EXPECT_EQ(now.options.tolerance, file.options.tolerance);
    EXPECT_EQ(now.options.end_time, file.options.end_time);
    EXPECT_EQ(now.options.truncation.eps_q, file.options.truncation.eps_q);
    EXPECT_EQ(now.options.truncation.eps_v, file.options.truncation.eps_v);
    EXPECT_EQ(now.options.truncation.eps_t, file.options.truncation.eps_t);
    hands.all.clear();
    hands.right_click("set m1");
    std::erase(hands.all, Command(command::EndEdit{}));
    EXPECT_TRUE(hands.all.empty()) << "it is the file's already";
}

TEST(Slider, AllValuesAreResetAtOnceAndThatIsUndoneAtOnce) {
    SliderHand hands("ball_on_sine");
    const std::string before = to_text(hands.session.trajectory());
    EXPECT_FALSE(hands.state.places.contains("reset all"));
    for (const char* line : {"set g 2", "set x' 1", "conditions paper", "end 12"})
        hands.session.apply(parse_command(line));
    const std::string changed = to_text(hands.session.trajectory());
    hands.rest(2);
    hands.click("reset all");
    EXPECT_EQ(hands.all, std::vector<Command>{command::Reset{}});
    EXPECT_EQ(to_text(hands.session.trajectory()), before);
    hands.press_with_control('Z');
    EXPECT_EQ(to_text(hands.session.trajectory()), changed);
    hands.click("bar Edit");
    hands.click("menu Reset all values");
    EXPECT_EQ(to_text(hands.session.trajectory()), before);
    hands.state.places.clear();
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.contains("reset all")) << "there is nothing to reset";
}

// Values without a slider can differ from the file, too.
TEST(Slider, EveryValueCanBeReset) {
    for (const char* line :
         {"method dopri5", "max-impacts 1000", "max-steps 100000", "memory 2e8", "eps 1e-5 1e-6 1e-6",
          "reinitialization euclidean", "tolerance 1e-9", "set e 0.4", "set y' 0.1"}) {
        SliderHand hands("ball_on_sine");
        hands.session.apply(parse_command(line));
        hands.rest(2);
        ASSERT_TRUE(hands.state.places.contains("reset all")) << line;
        hands.click("reset all");
        EXPECT_EQ(hands.session.run(), hands.session.file_run()) << line;
    }
}

// All values that sliders can change.
std::vector<double> values(const Session& session) {
    const Options& o = session.run().options;
    std::vector<double> all{o.tolerance, o.end_time, o.truncation.eps_q, o.truncation.eps_v, o.truncation.eps_t};
    all.insert(all.end(), session.run().parameters.begin(), session.run().parameters.end());
    for (const Vector& part : {session.run().q, session.run().v}) all.insert(all.end(), part.begin(), part.end());
    return all;
}

TEST(Slider, EveryChangeOfTheHandIsUndone) {
    for (const char* place : {"set e", "set y", "set x'", "tolerance", "end", "eps", "eps v"}) {
        SliderHand hands("ball_on_sine");
        const std::vector<double> before = values(hands.session);
        // Beside the grab, since a click on the grab does not move it.
        hands.click(place, place == std::string("set y") ? 0.6 : 0.3);
        EXPECT_NE(values(hands.session), before) << place;
        hands.hand.mouse_y = -1e6;
        hands.rest(1);
        hands.press_with_control('Z');
        EXPECT_EQ(values(hands.session), before) << place;
    }
}

TEST(Slider, TwoDragsOfOneSliderAreTwoChanges) {
    SliderHand hands("ball_on_sine");
    const auto e = [&] { return *hands.session.value("e"); };
    const double first = e();
    hands.click("set e", 0.3);
    const double second = e();
    hands.click("set e", 0.8);
    EXPECT_NE(e(), second);
    hands.hand.mouse_y = -1e6;
    hands.rest(1);
    hands.press_with_control('Z');
    EXPECT_EQ(e(), second);
    hands.press_with_control('Z');
    EXPECT_EQ(e(), first);
}

TEST(Slider, AClickMovesItOnceItIsNoDoubleClick) {
    SliderHand hands("ball_on_sine");
    hands.point("set g", 0.8);
    hands.hand.left = true;
    hands.rest(2);
    hands.hand.left = false;
    hands.rest(2);
    EXPECT_TRUE(hands.all.empty());
    EXPECT_TRUE(waits_for_click(hands.state)) << "a window must not fall asleep now";
    hands.settle();
    EXPECT_FALSE(waits_for_click(hands.state));
    EXPECT_GT(*hands.session.value("g"), 1.0);
    ASSERT_EQ(hands.all.size(), 1U);
    // Clicks on two sliders in quick succession move both.
    for (const char* place : {"set e", "set m"}) {
        hands.point(place, 0.9);
        hands.hand.left = true;
        hands.rest(1);
        hands.hand.left = false;
        hands.rest(1);
    }
    hands.settle();
    EXPECT_GT(*hands.session.value("e"), 0.5);
    EXPECT_GT(*hands.session.value("m"), 1.0);
    // A press held without motion also moves the slider.
    hands.point("set g", 0.1);
    hands.hand.left = true;
    hands.rest(30);
    EXPECT_LT(*hands.session.value("g"), 1.0);
}

TEST(Slider, EveryUndoTakesSomethingBack) {
    SliderHand hands("ball_on_sine");
    std::vector<std::vector<double>> moments{values(hands.session)};
    const auto done = [&] { moments.push_back(values(hands.session)); };
    hands.click("set g", 0.8), done();
    hands.double_click("value of set e");  // typed, but unchanged
    hands.press(key::escape);
    hands.click("set e", 0.3), done();
    hands.right_click("set e"), done();  // a separate change
    hands.double_click("value of set y");
    hands.type("3");
    hands.press(key::enter), done();
    // A drag that returns to its start is not an undo step.
    hands.point("set m");
    hands.hand.left = true;
    hands.rest(1);
    for (const double step : {6.0, 6.0, -6.0, -6.0}) {
        hands.hand.mouse_x += step;
        hands.rest(1);
    }
    hands.hand.left = false;
    hands.rest(2);
    hands.session.apply(command::Set{"m", 1.0});
    hands.session.apply(command::EndEdit{});
    hands.session.apply(command::Fit{1});
    hands.click("set x'", 0.9), done();
    hands.hand.mouse_y = -1e6;
    hands.rest(1);
    ASSERT_EQ(moments.size(), 6U);
    for (std::size_t i = moments.size() - 1; i-- > 0;) {
        EXPECT_NE(moments[i], moments[i + 1]);
        hands.press_with_control('Z');
        EXPECT_EQ(values(hands.session), moments[i]) << i;
    }
    EXPECT_FALSE(hands.session.can_undo());
}

// The tooltip appears after a second, beside the sliders, in one line. It is hidden while the value changes.
TEST(Slider, NoTooltipCoversTheValue) {
    SliderHand hands("ball_on_sine");
    for (const char* place : {"set g", "value of set g", "end"}) {
        hands.point(place, 0.4);
        hands.rest(2);
        EXPECT_EQ(hands.tooltip().height, 0.0F) << place << ": too early";
        EXPECT_TRUE(waits_for_tooltip(hands.state)) << "a window must not fall asleep now";
        for (int i = 0; i < 200 && waits_for_tooltip(hands.state); ++i) hands.rest(1);
        const Rectangle row = hands.state.places.at("value of set g"), tip = hands.tooltip();
        ASSERT_GT(tip.height, 0.0F) << place;
        EXPECT_GE(tip.x, row.x + row.width) << place;
        EXPECT_LT(tip.height, 2.0F * row.height) << place << ": one line";
        hands.hand.left = true;
        hands.rest(1);
        hands.hand.mouse_x += 6.0;
        hands.rest(2);
        EXPECT_EQ(hands.tooltip().height, 0.0F) << place;
        hands.hand.left = false;
        hands.rest(2);
    }
}

TEST(Slider, AChangedValueIsMarked) {
    SliderHand hands("ball_on_sine");
    const auto accents = [&] {
        const Image picture = hands.picture();
        const Rectangle value = hands.state.places.at("value of set g");
        const Color accent = light_theme().accent;
        int count = 0;
        for (int y = static_cast<int>(value.y); y < static_cast<int>(value.y + value.height); ++y)
            for (int x = static_cast<int>(value.x); x < static_cast<int>(value.x + value.width); ++x) {
                const std::size_t at = 3 * static_cast<std::size_t>(y * picture.width + x);
                count +=
                    picture.rgb[at] == accent.r && picture.rgb[at + 1] == accent.g && picture.rgb[at + 2] == accent.b;
            }
        return count;
    };
    EXPECT_EQ(accents(), 0);
    hands.session.apply(parse_command("set g 2"));
    EXPECT_GE(accents(), 3);
    hands.session.apply(parse_command("set g 1"));
    EXPECT_EQ(accents(), 0);
}

TEST(Slider, TheRoundestNumberHasTheFewestDigits) {
    struct Case {
        double low, high, roundest;
    };
    for (const Case& c :
         {Case{-1.0, 2.0, 0.0}, Case{0.93, 1.07, 1.0}, Case{0.463, 0.531, 0.5}, Case{9.31, 11.2, 10.0},
          Case{-3.62, -3.37, -3.5}, Case{17.13, 17.27, 17.2}, Case{1.2e-7, 2.3e-7, 2e-7}, Case{23.0, 47.0, 40.0},
          Case{0.33305, 0.3334, 0.3332}, Case{0.0, 0.1, 0.0}, Case{3.7, 3.7, 3.7}})
        EXPECT_EQ(roundest(c.low, c.high), c.roundest) << c.low << " to " << c.high;
}

// The result of a drag is round and within one pixel of the mouse.
TEST(Slider, ADragTakesRoundNumbers) {
    SliderHand hands("ball_on_sine");
    const double width = hands.state.places.at("set e").width;
    hands.point("set e", 0.2);
    hands.hand.left = true;
    hands.rest(1);
    std::set<std::string> texts;
    for (int i = 1; i <= 40; ++i) {
        hands.hand.mouse_x += 0.013 * width;
        hands.rest(1);
        texts.insert(fmt::format("{}", *hands.session.value("e")));
    }
    hands.hand.left = false;
    hands.rest(2);
    EXPECT_GE(texts.size(), 30U) << "it follows";
    for (const std::string& text : texts) EXPECT_LE(text.size(), 5U) << text;
    // Round in degrees, if those are displayed.
    SliderHand angle("double_pendulum");
    angle.click("set theta1", 0.63);
    const double shown = *angle.session.value("theta1") * 180.0 / 3.14159265358979323846;
    EXPECT_NEAR(shown, std::round(shown), 1e-9) << shown;
    EXPECT_NE(*angle.session.value("theta1"), angle.session.file_run().q[0]);
}

TEST(Slider, ShiftMakesADragFine) {
    SliderHand hands("ball_on_sine");
    const auto drag = [&](std::vector<int> keys, double pixels) {
        hands.session.apply(parse_command("set g 1"));
        hands.rest(30);
        hands.hand.keys = std::move(keys);
        hands.point("set g", 0.8);
        hands.hand.left = true;
        hands.rest(1);
        hands.hand.mouse_x += pixels;
        hands.rest(2);
        const double value = *hands.session.value("g");
        hands.hand.left = false;
        hands.hand.keys.clear();
        hands.rest(2);
        return value;
    };
    const double coarse = drag({}, -20.0);
    EXPECT_GT(coarse, 2.5) << "where the hand is";
    const double fine = drag({key::left_shift}, 20.0);
    EXPECT_GT(fine, 1.0) << "from where it was, and a little";
    EXPECT_LT(fine, 1.1);
    const double finer = drag({key::left_shift}, 24.0);
    EXPECT_NE(finer, fine) << "less than a pixel of the others";
    EXPECT_LT(std::abs(finer - fine), 0.02);
}

// A drag to the file's value selects exactly that value, however many digits it has.
TEST(Slider, ADragBackTakesExactlyTheFilesValue) {
    SliderHand hands("ball_on_sine");
    hands.session.apply(command::SetText{
        std::regex_replace(hands.session.document().text, std::regex("value = 0.5"), "value = 0.4567")});
    hands.rest(2);
    ASSERT_EQ(*hands.session.value("e"), 0.4567);
    hands.point("set e", 0.4567);
    hands.hand.left = true;
    hands.rest(1);
    hands.hand.mouse_x += 20.0;
    hands.rest(2);
    EXPECT_NE(*hands.session.value("e"), 0.4567);
    hands.hand.mouse_x -= 20.0;
    hands.rest(2);
    EXPECT_NEAR(*hands.session.value("e"), 0.4567, 0.02);
    for (int i = 0; i < 8 && *hands.session.value("e") != 0.4567; ++i) {
        hands.hand.mouse_x += 1.0;
        hands.rest(1);
    }
    EXPECT_EQ(*hands.session.value("e"), 0.4567);
}

TEST(Slider, CountsAndTheMethodStandInAccuracy) {
    SliderHand hands("ball_on_sine");
    hands.click("max impacts", 0.2);
    hands.click("max steps", 0.2);
    hands.click("method dopri5");
    const Options& now = hands.session.run().options;
    EXPECT_LT(now.max_impacts, Options().max_impacts);
    EXPECT_LT(now.max_steps, Options().max_steps);
    EXPECT_EQ(now.method, Method::dopri5);
    EXPECT_EQ(hands.session.error(), "");
    hands.right_click("max impacts");
    EXPECT_EQ(hands.session.run().options.max_impacts, hands.session.file_run().options.max_impacts);
}

// All differences are listed with the file's values; a click restores one, with or without a slider.
TEST(Slider, AllDifferencesAreListedAndPutBack) {
    SliderHand hands("double_pendulum");
    hands.session.apply(command::Show{"accuracy", false});
    for (const char* line : {"set m1 2", "set theta1 -0.5", "memory 2e8", "eps 1e-3 1e-4 1e-5"})
        hands.session.apply(parse_command(line));
    ASSERT_EQ(hands.session.error(), "");
    hands.rest(3);
    EXPECT_TRUE(hands.says("Differs from the file"));
    const auto all = differences(hands.session.description(), hands.session.run(), hands.session.file_run());
    ASSERT_EQ(all.size(), 4U);
    EXPECT_EQ(all[1].now, "\u221228.6479\u00b0");
    EXPECT_EQ(all[1].other, "30\u00b0");
    for (const RunDifference& difference : all) {
        hands.all.clear();
        hands.click("put back " + difference.name);
        std::erase(hands.all, Command(command::EndEdit{}));
        EXPECT_EQ(hands.all, std::vector<Command>{difference.back}) << difference.name;
        hands.rest(2);
    }
    EXPECT_EQ(hands.session.run(), hands.session.file_run());
    EXPECT_FALSE(hands.says("Differs from the file"));
}

// A click on the number starts typing, as a double click does.
TEST(Slider, AClickOnItsNumberStartsTyping) {
    for (const bool is_double : {false, true}) {
        test::Hands hands("ball_on_sine");
        if (is_double)
            hands.double_click("value of set e");
        else
            hands.click("value of set e");
        EXPECT_EQ(hands.state.typed.id, "set e");
        hands.type("0.3");
        hands.press(key::enter);
        EXPECT_EQ(hands.session.value("e"), 0.3) << is_double;
    }
}

}  // namespace
}  // namespace achilles
