// Several mistakes in a system file are reported together, in order, each once.
#include <gtest/gtest.h>

#include "core/system/mistakes.hpp"
#include "core/systems.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"

namespace achilles {
namespace {

using test::changed, test::good, test::told;

std::vector<InputError> all_of(const std::string& text) {
    try {
        const Model model(parse_system(text, "f.toml"));
        model.check(model.default_run());
    } catch (const InputError& error) {
        return each_of(error);
    }
    return {};
}

TEST(SeveralMistakes, AreAllToldInOrderOfPosition) {
    const std::string text = changed(good, {{"start = 1\n", "strat = 1\n"},
                                            {"value = 2\n", "value = [2]\n"},
                                            {"\"m*x\"", "\"m*abs(x)\""},
                                            {"end_time = 5", "end_time = -5"},
                                            {"[\"gap'\"]", "[\"lamda\", \"y\"]"}});
    EXPECT_EQ(
        told(text),
        "f.toml:4:1: unknown key 'strat' in [[coordinate]]; did you mean 'start'?\n    strat = 1\n    ^\nknown keys: "
        "name, start, rate, force, unit, range, rate_range\n\nf.toml:10:9: 'value' in [[parameter]] must be a number, "
        "not an array\n    value = [2]\n            ^\n\nf.toml:16:16: 'abs' is not allowed: it is not smooth, and the "
        "equations of motion need derivatives\n    potential = \"m*abs(x)\"\n                   ^\nsqrt(x^2 + w^2) "
        "approximates |x| for small w\n\nf.toml:21:12: the end time -5 is not after the start time 0\n    end_time = "
        "-5\n               ^\n\nf.toml:31:7: unknown name 'lamda'; did you mean 'lambda'?\n    y = [\"lamda\", "
        "\"y\"]\n          ^\n\nf.toml:31:16: unknown name 'y'\n    y = [\"lamda\", \"y\"]\n                   ^");
}

// Drawings do not affect the start of a run, so both errors are reported.
TEST(SeveralMistakes, OfADrawingAndOfTheStartAreToldTogether) {
    const std::vector<InputError> all =
        all_of(changed(good, {{"start = 1\n", "start = -1\n"}, {"\"s^2\"", "\"r^2\""}, {"[\"gap'\"]", "[\"lamda\"]"}}));
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].message, "the gap is negative at the start: h = -1");
    EXPECT_EQ(all[0].at.line, 18);
    EXPECT_EQ(all[1].message, "unknown name 'r'");
    EXPECT_EQ(all[2].at.line, 31);
}

TEST(SeveralMistakes, CarryTheirPlacesAsData) {
    const std::vector<InputError> all = all_of(changed(good, {{"rate = 0.5", "rate = inf"}, {"\"m*x\"", "\"m*\""}}));
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].at.line, 5);
    EXPECT_EQ(all[0].at.column, 8);
    EXPECT_EQ(all[0].message, "'rate' in [[coordinate]] must be finite, not inf");
    EXPECT_EQ(all[1].at.line, 16);
    EXPECT_EQ(all[1].at.column, 16);
    EXPECT_EQ(all[1].message, "the expression ends where a value is expected");
    EXPECT_EQ(all[1].file, "f.toml");
    EXPECT_EQ(all_of("title = \n").size(), 1u);
    EXPECT_EQ(all_of(good).size(), 0u);
}

TEST(SeveralMistakes, AreAtMostTenAndTheOthersAreCounted) {
    std::string text = good + "[extra]\n";
    for (int i = 0; i < 13; ++i) text = "wrong" + std::to_string(i) + " = 1\n" + text;
    const std::string message = told(text);
    EXPECT_EQ(message.substr(0, 42), "f.toml:1:1: unknown key 'wrong12' in a sys");
    EXPECT_EQ(message.substr(message.size() - 12), "\n\nand 3 more");
    EXPECT_NE(message.find("\nf.toml:10:1: "), message.npos);
    EXPECT_EQ(message.find("\nf.toml:11:1: "), message.npos);
    EXPECT_EQ(all_of(text).size(), 10u);
}

TEST(SeveralMistakes, OfTheStartAreToldTogether) {
    const std::vector<InputError> all =
        all_of(changed(good, {{"start = 1", "start = -1"}, {"value = 2", "value = -2"}, {"value = 0.5", "value = 5"}}));
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].message, "the mass matrix is not positive definite at the start (the pivot of 'x' is -2)");
    EXPECT_EQ(all[1].message, "the gap is negative at the start: h = -1");
    EXPECT_EQ(all[2].message, "the restitution must lie in [0, 1], but it is 5");
}

// One cause, one message.
TEST(OneMistake, DoesNotBringOthers) {
    const auto only = [](const std::string& from, const std::string& to, const std::string& message) {
        const std::vector<InputError> all = all_of(changed(good, {{from, to}}));
        ASSERT_EQ(all.size(), 1u) << to;
        EXPECT_EQ(all[0].message, message);
    };
    // a name used in four expressions, with and without prime
    only("name = \"theta\"", "name = \"thteta\"", "unknown name theta'; did you mean thteta'?");
    only("name = \"theta\"", "naem = \"theta\"", "unknown key 'naem' in [[coordinate]]; did you mean 'name'?");
    only("name = \"m\"", "name = \"1m\"", "'1m' is not a name");
    only("[[parameter]]\nname = \"m\"", "[[constant]]\nname = \"m\"",
         "unknown key 'constant' in a system file; did you mean 'constraint'?");
    only("[lagrangian]", "[Lagrangian]", "unknown key 'Lagrangian' in a system file; did you mean 'lagrangian'?");
    only("over = ", "ovr = ", "unknown key 'ovr' in [[drawing]] of shape curve; did you mean 'over'?");
    only("(x'^2 + ", "(xx^x + ", "unknown name 'xx'; did you mean 'x'?");  // not about the exponent
}

}  // namespace
}  // namespace achilles
