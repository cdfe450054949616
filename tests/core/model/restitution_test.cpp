// Restitutions: the allowed rounding at the ends of [0, 1], alike for doubles and intervals.
#include "model/restitution.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace achilles {
namespace {

constexpr double rounding = 0x1p-41, mistaken = 0x1p-39;

bool is_taken(double e) { return !mistake_in(Text{}, e); }
bool is_taken(double lo, double hi) { return !mistake_in(Text{}, Interval(lo, hi)); }

TEST(Restitution, TakesTheEndsUpToRounding) {
    for (const double e : {0.0, 0.3, 1.0, 1.0 + rounding, -rounding}) EXPECT_TRUE(is_taken(e) && is_taken(e, e)) << e;
    for (const double e : {-mistaken, 1.0 + mistaken, 1.5, std::nan("")}) EXPECT_FALSE(is_taken(e)) << e;
    EXPECT_TRUE(is_taken(-rounding, 1.0 + rounding));
    EXPECT_FALSE(is_taken(-mistaken, 0.5));
    EXPECT_FALSE(is_taken(0.5, 1.0 + mistaken));
    EXPECT_NE(mistake_in(Text{}, Interval(-0.5, 0.5))->message.find("the part below 0"), std::string::npos);
}

TEST(Restitution, OfARunHasNoRounding) {
    EXPECT_EQ(without_rounding(1.0 + rounding), 1.0);
    EXPECT_EQ(without_rounding(-rounding), 0.0);
    EXPECT_EQ(without_rounding(0.3), 0.3);
    EXPECT_EQ(without_rounding(1.5), 1.5);
}

}  // namespace
}  // namespace achilles
