// Suggestions for function names of other languages.
#include <gtest/gtest.h>

#include "expression/name_suggestions.hpp"

namespace achilles {
namespace {

TEST(Words, RatesAsOtherProgramsWriteThem) {
    const std::vector<std::string> words{"m", "x", "x'", "y", "y'"};
    for (const char* word : {"xdot", "x_dot", "dx", "vx", "v_x"})
        EXPECT_EQ(did_you_mean(word, words), "; rates are written x'") << word;
    EXPECT_EQ(did_you_mean("ydot", words), "; rates are written y'");
    EXPECT_EQ(did_you_mean("v", words), "; rates are written x'");
    EXPECT_EQ(rates_are_written("mdot", words), "");
    EXPECT_EQ(rates_are_written("xdot", std::vector<std::string>{"x", "x''"}), "");
    EXPECT_EQ(rates_are_written("v", std::vector<std::string>{"x"}), "");
}

TEST(Words, GreekLettersHaveNames) {
    EXPECT_EQ(spelled_out("2*θ1 + Ω"), "2*theta1 + Omega");
    EXPECT_EQ(spelled_out("theta"), "theta");
    EXPECT_EQ(did_you_mean("θ1", std::vector<std::string>{"theta1", "theta2"}), "; did you mean 'theta1'?");
    EXPECT_EQ(did_you_mean("φ", std::vector<std::string>{"theta1"}), "; spell out Greek letters: phi");
}

}  // namespace
}  // namespace achilles
