// Printed bounds claim no more than the numbers behind them.
#include "output/precision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/output/printed.hpp"

namespace achilles::test {

namespace {

// Doubles of all sizes. Some are the nearest doubles to short decimals, which lie above or below these.
std::vector<double> numbers() {
    std::vector<double> all{0.1, 0.3, 0.7, 1.0, 0.5, 1e-7, 9.999e-5, 1e23, 123456.0, 2.53e-9, 0x1p-60, 9.81};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> size(-30.0, 20.0);
    std::uniform_int_distribution<int> digits(1, 999);
    for (int i = 0; i < 300; ++i) {
        all.push_back(std::pow(10.0, size(random)));
        all.push_back(
            std::strtod(fmt::format("{}e{}", digits(random), static_cast<int>(size(random))).c_str(), nullptr));
    }
    return all;
}

double drawn(std::mt19937& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

}  // namespace

TEST(Bounds, AreRoundedToTheirSide) {
    EXPECT_EQ(rounded_up(3.51e-7), "3.6e-7");
    EXPECT_EQ(rounded_up(1.0e-3), "0.0011") << "the double is above the decimal";
    EXPECT_EQ(rounded_up(0.0), "0");
    EXPECT_EQ(rounded_up(0.3), "0.3");
    EXPECT_EQ(rounded_up(0.1), "0.11");
    EXPECT_EQ(rounded_down(0.3), "0.29");
    EXPECT_EQ(rounded_down(2.64999, 3), "2.64");
    EXPECT_EQ(rounded_down(-2.641, 3), "-2.65");
    EXPECT_EQ(rounded_down(123456.0, 2), "120000");
    for (const double x : numbers())
        for (const int digits : {1, 2, 3, 6, 10, 15, 17}) {
            const Real up(rounded_up(x, digits)), down(rounded_down(x, digits)), step = pow(Real(10), 1 - digits);
            EXPECT_GE(up, Real(x)) << digits;
            EXPECT_LE(down, Real(x)) << digits;
            EXPECT_LE(up - down, step * Real(x) * 1.0001) << digits;
            EXPECT_LE(Real(rounded_down(-x, digits)), Real(-x)) << digits;
        }
}

TEST(Bounds, OfIntervalsHoldThem) {
    EXPECT_EQ(interval_text(2.5, 2.75), "[2.5, 2.75]");
    EXPECT_EQ(interval_text(0.0, 0.0), "[0, 0]");
    EXPECT_EQ(bound_text(3e-25), "1e-16");
    EXPECT_EQ(bound_text(2.53e-9), "2.6e-9");
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
        const double low = drawn(random, -20.0, 20.0), high = low + std::pow(10.0, drawn(random, -17.0, 1.0));
        const Interval all(low, high);
        const PrintedSet said = PrintedSet::of("in " + interval_text(low, high));
        EXPECT_TRUE(holds(said, all)) << interval_text(low, high);
        EXPECT_LE(said.width(), Real(1.03) * (Real(high) - Real(low)) + Real(1e-15) * mag(all));
    }
}

// Both ends lie within the printed digits and uncertainty, and the uncertainty has two digits.
TEST(ShortText, HoldsBothEnds) {
    EXPECT_EQ(short_text(Interval(2.5)), "2.5");
    EXPECT_EQ(short_text(Interval(2.72514212, 2.72514432)), "2.7251432(12)");
    EXPECT_EQ(short_text(Interval(-0.352, 0.352)), "0.00(36)");
    EXPECT_EQ(short_text(Interval(100.25, 300.75)), "200(101)");
    EXPECT_EQ(short_text(Interval(0.1)), "0.100000000000000(1)") << "no decimal of few digits is this double";
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-20.0, 20.0), size(-14.5, 1.0);
    for (int i = 0; i < 2000; ++i) {
        const double low = place(random), high = low + std::pow(10.0, size(random));
        const std::string text = short_text(Interval(low, high));
        const std::size_t bracket = text.find('('), point = text.find('.');
        ASSERT_NE(bracket, std::string::npos) << text;
        const std::size_t decimals = point == std::string::npos ? 0 : bracket - point - 1;
        const Real shown(text.substr(0, bracket)), off = Real(text.substr(bracket + 1, text.size() - bracket - 2)) *
                                                         pow(Real(10), -static_cast<int>(decimals));
        EXPECT_TRUE(holds(PrintedSet{shown - off, shown + off}, Interval(low, high))) << text;
        EXPECT_LE(off, Real(1.2) * (high - low) + Real(2e-15)) << text << " of " << low << ", " << high;
    }
}

TEST(OuterText, HoldsBothEnds) {
    EXPECT_EQ(outer_text(Interval(0.0)), "= 0");
    EXPECT_EQ(outer_text(Interval(-2.5)), "= -2.5");
    EXPECT_EQ(outer_text(Interval(0.437528, 0.438009)), "= 0.43776 +- 2.5e-04");
    EXPECT_EQ(outer_text(Interval(-1e-3, 1e-3)), "= 0 +- 1.1e-03") << "the double is above the decimal";
    EXPECT_EQ(outer_text(Interval(0.1)), "= 0.10000000000000000 +- 1.0e-17");
    std::mt19937 random(6);
    for (int i = 0; i < 4000; ++i) {
        const double scale = std::pow(10.0, drawn(random, -20.0, 6.0)), low = scale * drawn(random, -1.0, 1.0);
        const Interval all(low, low + scale * std::pow(10.0, drawn(random, -17.0, 1.0)));
        const std::string text = outer_text(all);
        const PrintedSet said = PrintedSet::of(text);
        EXPECT_TRUE(holds(said, all)) << text << " of " << all.lo() << ", " << all.hi();
        EXPECT_LE(said.width(), Real(1.25) * (Real(all.hi()) - Real(all.lo())) + Real(4e-16) * mag(all)) << text;
    }
}

// The decimal as typed, or an interval inside it.
TEST(InnerText, LiesInside) {
    EXPECT_EQ(inner_text(interval_of_decimal(0.1)), "= 0.1");
    EXPECT_EQ(inner_text(interval_of_decimal(-9.81)), "= -9.81");
    EXPECT_EQ(inner_text(interval_of_decimal(0.0)), "= 0");
    EXPECT_EQ(inner_text(interval_of_decimal(0.30000000000000004)), "= 0.30000000000000004");
    EXPECT_EQ(inner_text(hull(interval_of_decimal(0.059), interval_of_decimal(0.061))), "in [0.059, 0.061]");
    EXPECT_EQ(inner_text(interval_of_decimal(0.7) + Interval(-1.0, 1.0) * interval_of_decimal(0.3)), "in [0.4, 1]");
    EXPECT_EQ(inner_text(Interval(0.1)), "= 1.000000000000000055511151231257827021181583404541015625e-1")
        << "the claim is of the double alone";
    EXPECT_EQ(inner_text(Interval(-1.0, 0.5)), "in [-1, 0.5]");
    std::mt19937 random(8);
    std::vector<double> ends = numbers();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double a = ends[i], b = ends[i + 1];
        EXPECT_EQ(inner_text(interval_of_decimal(a)), fmt::format("= {}", a));
        EXPECT_TRUE(lies_in(PrintedSet::of(inner_text(interval_of_decimal(a))), interval_of_decimal(a)));
        EXPECT_TRUE(lies_in(PrintedSet::of(inner_text(Interval(a))), Interval(a))) << inner_text(Interval(a));
        for (const double low : {a, -a, b * (1.0 - 1e-13)}) {
            const Interval all = hull(interval_of_decimal(low), interval_of_decimal(b));
            const PrintedSet said = PrintedSet::of(inner_text(all));
            EXPECT_TRUE(lies_in(said, all)) << inner_text(all);
            EXPECT_GE(said.width(), Real(all.hi()) - Real(all.lo()) - Real(0x1p-46) * mag(all)) << inner_text(all);
        }
    }
}

}  // namespace achilles::test
