#include "number/angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace achilles {
namespace {

// Bit by bit, because figures and tables are compared bit by bit.
TEST(Angle, DegreesAreRadiansBy180OverPi) {
    EXPECT_EQ(degrees(1.0), 57.29577951308232);
    EXPECT_EQ(degrees(1.0), 180.0 / std::numbers::pi);
    EXPECT_EQ(degrees(std::numbers::pi), 180.0);
    EXPECT_EQ(degrees(-std::numbers::pi / 2.0), -90.0);
    EXPECT_EQ(degrees(0.1), 0.1 * 180.0 / std::numbers::pi);  // in this order
    EXPECT_NE(degrees(0.1), 0.1 * degrees(1.0));              // rounded differently
}

// Alone, together, and again from the cache.
TEST(Angle, SineAndCosineAreThoseOfTheLibrary) {
    for (const double angle : {0.0, 0.1, 1.0, -2.5, 1e6}) {
        for (int round = 0; round < 2; ++round) {
            EXPECT_EQ(sine(angle), std::sin(angle));
            EXPECT_EQ(sine_and_cosine(angle).sine, std::sin(angle));
            EXPECT_EQ(sine_and_cosine(angle).cosine, std::cos(angle));
        }
    }
}

}  // namespace
}  // namespace achilles
