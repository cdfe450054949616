// Colors for numbers: uniform and monotone, for any color vision.
#include "figure/palette.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace achilles {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

Triple times(const Matrix& m, const Triple& x) {
    Triple y{};
    for (std::size_t i = 0; i < 3; ++i) y[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
    return y;
}

Triple linear(const Color& c) {
    const auto one = [](std::uint8_t byte) {
        const double x = byte / 255.0;
        return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return {one(c.r), one(c.g), one(c.b)};
}

// CIE L* and OKLab, from linear sRGB.
double lightness(const Triple& rgb) {
    const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

Triple lab(const Triple& rgb) {
    Triple lms = times({{{0.4122214708, 0.5363325363, 0.0514459929},
                         {0.2119034982, 0.6806995451, 0.1073969566},
                         {0.0883024619, 0.2817188376, 0.6299787005}}},
                       rgb);
    for (double& x : lms) x = std::cbrt(x);
    return times({{{0.2104542553, 0.7936177850, -0.0040720468},
                   {1.9779984951, -2.4285922050, 0.4505937099},
                   {0.0259040371, 0.7827717662, -0.8086757660}}},
                 lms);
}

double distance(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

struct Vision {
    const char* name;
    Matrix seen;  // Machado, Oliveira and Fernandes 2009, severity 1
    double evenness;
};

const Vision visions[] = {
    {"all cones", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0.86},  // 1 except for rounding to bytes
    {"protan",
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     0.42},
    {"deutan",
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
     0.6},
    {"tritan",
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}},
     0.36},
};

TEST(ColorTable, IsEvenForAnyColorVision) {
    constexpr std::size_t count = 33;
    const std::vector<Color> table = number_colors(count);
    for (const Vision& vision : visions) {
        double shortest = 1e9, longest = 0.0;
        for (std::size_t i = 1; i < count; ++i) {
            Triple before = times(vision.seen, linear(table[i - 1])), here = times(vision.seen, linear(table[i]));
            for (Triple* rgb : {&before, &here})
                for (double& x : *rgb) x = std::clamp(x, 0.0, 1.0);
            EXPECT_GT(lightness(here), lightness(before) + 0.5) << vision.name << " step " << i;
            const double step = distance(lab(before), lab(here));
            shortest = std::min(shortest, step);
            longest = std::max(longest, step);
        }
        EXPECT_GT(shortest / longest, vision.evenness) << vision.name;
    }
}

TEST(ColorTable, IsWholeAndInsideTheScreensColors) {
    EXPECT_EQ(number_color(-1.0), number_color(0.0));
    EXPECT_EQ(number_color(2.0), number_color(1.0));
    // No color is clamped to the sRGB gamut: the inverse map gives the formula.
    for (int i = 0; i <= 16; ++i) {
        const Triple at = lab(linear(number_color(i / 16.0)));
        EXPECT_NEAR(at[0], 0.25 + 0.67 * i / 16.0, 0.004) << i;
        EXPECT_NEAR(std::hypot(at[1], at[2]), 0.125, 0.006) << i;
    }
    // All 256 colors differ, and each is brighter than the one before.
    const std::vector<Color> table = number_colors(256);
    for (std::size_t i = 1; i < table.size(); ++i)
        EXPECT_GT(lightness(linear(table[i])), lightness(linear(table[i - 1])) - 0.15) << i;
}

}  // namespace
}  // namespace achilles
