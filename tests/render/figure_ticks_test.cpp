// Axes with extreme limits, and logarithmic axes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "figure/axes.hpp"

namespace achilles {
namespace {

struct LabeledAxis {
    Axis axis;
    std::string text;
    int count = 0;
};

LabeledAxis axis_of(bool logarithmic, double low, double high, double margin = 0.0, int most = 6) {
    LabeledAxis result;
    result.axis.logarithmic = logarithmic;
    set_ticks(result.axis, low, high, margin, most);
    for (const Tick& tick : result.axis.ticks) {
        if (tick.label.empty()) continue;
        result.text += (result.count++ == 0 ? "" : " ") + tick.label;
    }
    return result;
}

std::string decades(double low, double high) { return axis_of(true, low, high).text; }

TEST(LogarithmicTicks, ArePowersOfTen) {
    EXPECT_EQ(decades(1, 1000), "1 10 100 1000");
    EXPECT_EQ(decades(0.001, 10), "0.001 0.01 0.1 1 10");
    EXPECT_EQ(decades(1e-6, 1e-2), "10⁻⁶ 10⁻⁵ 10⁻⁴ 10⁻³ 10⁻²");
    EXPECT_EQ(decades(1e-12, 1), "10⁻¹² 10⁻⁹ 10⁻⁶ 10⁻³ 10⁰");
    EXPECT_EQ(decades(1, 50), "1 2 5 10 20 50");
    EXPECT_EQ(decades(0.15, 9), "0.2 0.5 1 2 5");
    EXPECT_EQ(decades(2.2, 3.1), "2.2 2.4 2.6 2.8 3.0");
}

TEST(LogarithmicTicks, HaveMinorOnesBetween) {
    const Axis axis = axis_of(true, 1, 1000).axis;
    EXPECT_EQ(axis.ticks.size(), 28u);
    EXPECT_EQ(axis.ticks[1].value, 2.0);
    EXPECT_EQ(axis_of(true, 0.1, 1).axis.ticks[2].value, 0.3);
}

TEST(LogarithmicTicks, KeepAPositiveAxis) {
    for (const double low : {-1.0, 0.0, 1e-20, 3.0}) {
        for (const double high : {-0.5, 0.0, 1e-300, 3.0, 1e300}) {
            const LabeledAxis result = axis_of(true, low, high, 0.05);
            EXPECT_GT(result.axis.low, 0.0);
            EXPECT_GT(result.axis.high, result.axis.low);
            EXPECT_GE(result.count, 2) << low << " " << high << " " << result.text;
            EXPECT_LE(result.count, 6) << low << " " << high << " " << result.text;
        }
    }
}

TEST(LinearTicks, EndForEveryRange) {
    const double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
    for (const double low : {-most, -1e200, -1.0, -least, 0.0}) {
        for (const double high : {0.0, least, 1e-310, 1e-200, 1.0, 1e200, most}) {
            const LabeledAxis result = axis_of(false, low, high, 0.05);
            EXPECT_TRUE(std::isfinite(result.axis.low) && std::isfinite(result.axis.high));
            EXPECT_GT(result.axis.high, result.axis.low);
            EXPECT_GE(result.count, 1) << low << " " << high;
            EXPECT_LE(result.count, 6) << low << " " << high;
        }
    }
    EXPECT_EQ(axis_of(false, 1e17, 1e17 + 64).count, axis_of(false, 1e17, 1e17).count);
}

TEST(LinearTicks, ShareOneFormOnAnAxis) {
    const auto labels = [](double low, double high) { return axis_of(false, low, high).text; };
    EXPECT_EQ(labels(0, 1e5), "0 20000 40000 60000 80000 100000");
    EXPECT_EQ(labels(9.9e4, 1.01e5), "99000 99500 100000 100500 101000");
    EXPECT_EQ(labels(0, 1e6), "0 2×10⁵ 4×10⁵ 6×10⁵ 8×10⁵ 10×10⁵");
    EXPECT_EQ(labels(-2e6, 2e6), "−2×10⁶ −1×10⁶ 0 1×10⁶ 2×10⁶");
    EXPECT_EQ(labels(9.9e6, 1.01e7), "0.990×10⁷ 0.995×10⁷ 1.000×10⁷ 1.005×10⁷ 1.010×10⁷");
    EXPECT_EQ(labels(0, 1.2e-4), "0 5×10⁻⁵ 10×10⁻⁵");
    EXPECT_EQ(labels(0, 8e4), "0 20000 40000 60000 80000");
    EXPECT_EQ(labels(0.00999, 0.01001), "0.009990 0.009995 0.010000 0.010005 0.010010");
}

TEST(LinearTicks, NeverSayMinusZero) {
    EXPECT_EQ(tick_label(-0.0, 1.0), "0");
    EXPECT_EQ(tick_label(-1e-17, 0.1), "0.0");
    EXPECT_EQ(tick_label(-2.0, 1.0), "\u22122");
    EXPECT_EQ(tick_label(-2e-7, 1e-7), "\u22122×10⁻⁷");
}

}  // namespace
}  // namespace achilles
