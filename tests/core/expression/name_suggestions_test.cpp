// Name suggestions: a misspelled name is recognized, a different one is not.
#include "expression/name_suggestions.hpp"

#include <gtest/gtest.h>

namespace achilles {
namespace {

const std::vector<std::string> names{"start", "rate", "range", "theta1", "theta2", "sin", "m", "e"};

TEST(NameSuggestions, RecognizesMisspellings) {
    EXPECT_EQ(nearest("strat", names), "start");   // two neighboring letters swapped
    EXPECT_EQ(nearest("rates", names), "rate");    // one letter too many
    EXPECT_EQ(nearest("theta", names), "theta1");  // the first of equally near names
    EXPECT_EQ(nearest("si", names), "sin");
    EXPECT_EQ(nearest("mm", names), "m");
}

TEST(NameSuggestions, KnowsCapitalsAndBeginnings) {
    const std::vector<std::string> keys{"coordinate", "parameter", "restitution", "eps_q", "eps_v"};
    EXPECT_EQ(nearest("THETA1", names), "theta1");
    EXPECT_EQ(nearest("M", names), "m");
    EXPECT_EQ(nearest("param", keys), "parameter");
    EXPECT_EQ(nearest("Coord", keys), "coordinate");
    EXPECT_EQ(nearest("pa", keys), "");   // too short to guess
    EXPECT_EQ(nearest("eps", keys), "");  // two keys begin with it
    EXPECT_EQ(nearest("epsq", keys), "eps_q");
}

TEST(NameSuggestions, TakesTheNearestOfSeveral) {
    const std::vector<std::string> keys{"range", "rate", "rate_range", "start"};
    EXPECT_EQ(nearest("rate_rnage", keys), "rate_range");  // a swap is one edit
    EXPECT_EQ(nearest("rnage", keys), "range");
    EXPECT_EQ(nearest("raet", keys), "rate");
    EXPECT_EQ(nearest("strt", keys), "start");
}

TEST(NameSuggestions, OffersNothingFarAway) {
    EXPECT_EQ(nearest("q", names), "");  // equally far from all names
    EXPECT_EQ(nearest("velocity", names), "");
    EXPECT_EQ(nearest("cos", names), "");
    EXPECT_EQ(nearest("", names), "");
    EXPECT_EQ(nearest("x", {}), "");
    EXPECT_EQ(nearest(std::string(1 << 20, 'a'), names), "");
}

TEST(NameSuggestions, Asks) {
    EXPECT_EQ(did_you_mean("strat", names), "; did you mean 'start'?");
    EXPECT_EQ(did_you_mean("velocity", names), "");
}

}  // namespace
}  // namespace achilles
