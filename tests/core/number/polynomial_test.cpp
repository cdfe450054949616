#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "number/polynomial.hpp"

namespace achilles {
namespace {

Polynomial from_roots(std::initializer_list<double> roots, double lead) {
    Polynomial p;
    p.c[0] = lead;
    for (const double root : roots) {
        ++p.degree;
        for (int i = p.degree; i >= 0; --i) {
            const auto k = static_cast<std::size_t>(i);
            p.c[k] = (i > 0 ? p.c[k - 1] : 0.0) - (i < p.degree ? root * p.c[k] : 0.0);
        }
    }
    return p;
}

using Kind = FirstCrossing::Kind;

TEST(Polynomials, InterpolationMeetsItsValues) {
    const std::array<double, 5> values{1.0, -2.0, 0.5, 3.0, 7.0};
    const Polynomial p = interpolate(values);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(p(0.25 * static_cast<double>(k)), values[k], 1e-13);
    EXPECT_NEAR(p.slope(0.3), (p(0.3 + 1e-6) - p(0.3 - 1e-6)) / 2e-6, 1e-7);
}

double root_of(const Polynomial& polynomial, int known) {
    const FirstCrossing descent = first_descent(polynomial, known, 0.0);
    EXPECT_EQ(descent.kind, Kind::root);
    return descent.theta;
}

// Coefficients above the degree are ignored, whatever they are.
TEST(Polynomials, WhatStandsAboveTheDegreeHasNoMeaning) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(0.05, 0.95);
    for (int i = 0; i < 1000; ++i) {
        Polynomial line = from_roots({number(random)}, -number(random));
        line.c[2] = 0.0;
        const double root = root_of(line, 0);
        for (const double above : {1e300, -1e300, 0.3, -7.0}) {
            line.c[2] = above;
            EXPECT_EQ(root_of(line, 0), root) << line.c[0] << " " << line.c[1] << " " << above;
        }
    }
}

TEST(Polynomials, TheFirstDescentIsFoundToTheLastBit) {
    EXPECT_NEAR(root_of(from_roots({0.3}, -1.0), 0), 0.3, 1e-15);
    EXPECT_NEAR(root_of(from_roots({0.3, 0.7, 2.0}, -1.0), 0), 0.3, 1e-15);
    EXPECT_NEAR(root_of(from_roots({-0.5, 0.9}, -1.0), 0), 0.9, 1e-15);
    EXPECT_EQ(first_descent(from_roots({1.5}, -1.0), 0, 0.0).kind, Kind::none);
    EXPECT_EQ(first_descent(from_roots({-0.5}, 1.0), 0, 0.0).kind, Kind::none);
}

TEST(Polynomials, TwoRootsInOneStepLeaveNoSignChangeAtItsEndsAndAreSeen) {
    for (const double width : {1e-1, 1e-3, 1e-6}) {
        EXPECT_NEAR(root_of(from_roots({0.4, 0.4 + width}, 1.0), 0), 0.4, 1e-9);
    }
    EXPECT_NE(first_descent(from_roots({0.4, 0.4}, 1.0), 0, 0.0).kind, Kind::root);  // touches zero
}

TEST(Polynomials, KnownRootsAreDividedOut) {
    EXPECT_NEAR(root_of(from_roots({0.0, 0.6}, -1.0), 1), 0.6, 1e-15);
    EXPECT_NEAR(root_of(from_roots({0.0, 0.0, 0.0, 0.25}, -1.0), 3), 0.25, 1e-15);
    EXPECT_EQ(first_descent(from_roots({0.0, 0.0, 0.0, 1.25}, -1.0), 3, 0.0).kind, Kind::none);
    EXPECT_EQ(first_descent(from_roots({0.0, 1.0}, -1.0), 1, 0.0).kind, Kind::open);  // at the end: for the next step
}

// (theta - 0.4)^2 + c: a minimum of c, with remainder 1e-6.
TEST(Polynomials, WhatLiesInsideTheRemainderIsUndecided) {
    const auto dip = [](double least) {
        Polynomial p = from_roots({0.4, 0.4}, 1.0);
        p.c[0] += least;
        return first_descent(p, 0, 1e-6);
    };
    EXPECT_EQ(dip(1e-3).kind, Kind::none);
    EXPECT_EQ(dip(1.1e-6).kind, Kind::none);
    EXPECT_EQ(dip(-1e-3).kind, Kind::root);
    EXPECT_EQ(dip(-1.1e-6).kind, Kind::root);
    for (const double least : {0.9e-6, 1e-9, 0.0, -1e-9, -0.9e-6}) {
        EXPECT_EQ(dip(least).kind, Kind::undecided) << least;
        EXPECT_NEAR(dip(least).theta, 0.4 - std::sqrt(1e-6 - least), 1e-12) << least;  // where it enters the remainder
    }
    // Ends within the remainder: open. Starts within it and increases: rose. Starts within it and decreases: a root.
    EXPECT_EQ(first_descent(from_roots({1.0000001}, -1.0), 0, 1e-6).kind, Kind::open);
    EXPECT_EQ(first_descent(from_roots({-1e-7}, 1.0), 0, 1e-6).kind, Kind::increasing);
    const FirstCrossing falls = first_descent(from_roots({1e-7}, -1.0), 0, 1e-6);
    EXPECT_EQ(falls.kind, Kind::root);
    EXPECT_NEAR(falls.theta, 1e-7, 1e-15);
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
        const FirstCrossing found = first_descent(p, 0, 0.0);
        if (expected) {
            ASSERT_EQ(found.kind, Kind::root);
            EXPECT_LE(found.theta, *expected);
            if (found.theta > 1e-6) {
                EXPECT_GT(p(0.5 * found.theta), -1e-12);
            }
            EXPECT_NEAR(p(found.theta), 0.0, 1e-13);
        }
    }
}

}  // namespace
}  // namespace achilles
