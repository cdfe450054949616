#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "simulate/polynomial.hpp"

namespace achilles {
namespace {

Polynomial from_roots(std::initializer_list<double> roots, double lead) {
    Polynomial p;
    p.c[0] = lead;
    for (const double root : roots) {
        ++p.degree;
        for (int i = p.degree; i >= 0; --i) {
            const auto k = static_cast<std::size_t>(i);
            p.c[k] = (i > 0 ? p.c[k - 1] : 0.0) - root * p.c[k];
        }
    }
    return p;
}

TEST(Polynomials, InterpolationMeetsItsValues) {
    const std::array<double, 5> values{1.0, -2.0, 0.5, 3.0, 7.0};
    const Polynomial p = interpolate(values);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(p(0.25 * static_cast<double>(k)), values[k], 1e-13);
    EXPECT_NEAR(p.slope(0.3), (p(0.3 + 1e-6) - p(0.3 - 1e-6)) / 2e-6, 1e-7);
}

TEST(Polynomials, TheFirstDescentIsFoundToTheLastBit) {
    EXPECT_NEAR(*first_descent(from_roots({0.3}, -1.0), 0), 0.3, 1e-15);
    EXPECT_NEAR(*first_descent(from_roots({0.3, 0.7, 2.0}, -1.0), 0), 0.3, 1e-15);
    EXPECT_NEAR(*first_descent(from_roots({-0.5, 0.9}, -1.0), 0), 0.9, 1e-15);
    EXPECT_FALSE(first_descent(from_roots({1.5}, -1.0), 0));
    EXPECT_FALSE(first_descent(from_roots({-0.5}, 1.0), 0));
}

TEST(Polynomials, TwoRootsInOneStepLeaveNoSignChangeAtItsEndsAndAreSeen) {
    for (const double width : {1e-1, 1e-3, 1e-6}) {
        const auto root = first_descent(from_roots({0.4, 0.4 + width}, 1.0), 0);
        ASSERT_TRUE(root) << width;
        EXPECT_NEAR(*root, 0.4, 1e-9);
    }
    EXPECT_FALSE(first_descent(from_roots({0.4, 0.4}, 1.0), 0));  // a touch
}

TEST(Polynomials, KnownRootsAreDividedOut) {
    EXPECT_NEAR(*first_descent(from_roots({0.0, 0.6}, -1.0), 1), 0.6, 1e-15);
    EXPECT_NEAR(*first_descent(from_roots({0.0, 0.0, 0.0, 0.25}, -1.0), 3), 0.25, 1e-15);
    EXPECT_FALSE(first_descent(from_roots({0.0, 0.0, 0.0, 1.25}, -1.0), 3));
    EXPECT_EQ(*first_descent(from_roots({0.0, 1.0}, -1.0), 1), 1.0);
}

TEST(Polynomials, RandomRootsAgreeWithASearchOnAGrid) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-0.5, 1.5);
    for (int trial = 0; trial < 2000; ++trial) {
        Polynomial p = from_roots({place(random), place(random), place(random), place(random)}, 1.0);
        if (p(0.0) < 0.0)
            for (double& c : p.c) c = -c;
        std::optional<double> expected;
        for (int i = 1; i <= 4000 && !expected; ++i)
            if (p(i / 4000.0) < 0.0) expected = i / 4000.0;
        const auto found = first_descent(p, 0);
        if (expected) {
            ASSERT_TRUE(found);
            EXPECT_LE(*found, *expected);
            if (*found > 1e-6) {
                EXPECT_GT(p(0.5 * *found), -1e-12);
            }
            EXPECT_NEAR(p(*found), 0.0, 1e-13);
        }
    }
}

}  // namespace
}  // namespace achilles
