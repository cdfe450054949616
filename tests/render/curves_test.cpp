#include "surface/curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/support.hpp"

namespace achilles {
namespace {

constexpr Color full{0, 0, 0, 255};

Image curve(Offscreen& surface, const std::vector<Point>& points, const ScreenStroke& stroke) {
    return support::picture(surface, [&](ImDrawList* list) { add_curve(list, points, stroke); });
}

// Ink in units of black pixels.
double ink(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) sum += (255 - image.rgb[i]) / 255.0;
    return sum;
}

TEST(Curves, TheInkIsWidthTimesLength) {
    Offscreen surface(support::options());
    for (const double width : {0.6, 1.0, 1.5, 3.0})
        for (const double angle : {0.0, 0.3, 0.8}) {
            const Point end{50.3 + 300.0 * std::cos(angle), 40.7 + 300.0 * std::sin(angle)};
            const double area = width * 300.0 + width * width * std::acos(-1.0) / 4.0;
            EXPECT_NEAR(ink(curve(surface, {{50.3, 40.7}, end}, {full, width, {}})), area, 0.03 * area)
                << width << " " << angle;
        }
}

TEST(Curves, ASharpCornerHasNoSpikeAndNoHole) {
    Offscreen surface(support::options());
    const Image image = curve(surface, {{100, 300}, {103, 100}, {106, 300}}, {full, 2.0, {}});
    EXPECT_GT(support::darkness(image, 102, 101) + support::darkness(image, 103, 101), 200);
    for (int x = 0; x < image.width; ++x) ASSERT_EQ(support::darkness(image, x, 97), 0) << x;
}

// Of a curve only the parts of the picture near it are drawn, and none may be missing.
TEST(Curves, AWideLineHasNoHoles) {
    Offscreen surface(support::options());
    for (const double width : {1.6, 40.0})
        for (const Point end : {Point{530.0, 61.0}, {520.5, 330.3}, {61.7, 340.0}}) {
            const Point start{60.2, 60.4};
            const Image image = curve(surface, {start, end}, {full, width, {}});
            const double x = end.x - start.x, y = end.y - start.y, square = x * x + y * y;
            for (int row = 0; row < image.height; ++row)
                for (int column = 0; column < image.width; ++column) {
                    const double across = column + 0.5 - start.x, down = row + 0.5 - start.y;
                    const double s = std::clamp((across * x + down * y) / square, 0.0, 1.0);
                    const double off = std::hypot(across - s * x, down - s * y);
                    const int dark = support::darkness(image, column, row);
                    const bool is_inside = off<width / 2.0 - 0.51, is_outside = off> width / 2.0 + 0.51;
                    const int least = is_inside ? 255 : off < 0.1 ? 201 : 0, most = is_outside ? 0 : 255;
                    ASSERT_GE(dark, least) << column << " " << row;
                    ASSERT_LE(dark, most) << column << " " << row;
                }
        }
}

TEST(Curves, AnOverlapIsNotDarker) {
    Offscreen surface(support::options());
    const Color half{0, 0, 0, 128};
    const std::vector<Point> once{{50, 50.5}, {400, 50.5}}, often{{50, 50.5}, {400, 50.5}, {50, 50.5}, {400, 50.5}};
    EXPECT_EQ(curve(surface, once, {half, 3.0, {}}), curve(surface, often, {half, 3.0, {}}));
}

TEST(Curves, StayInsideTheClipRectangle) {
    Offscreen surface(support::options());
    const Image image = support::picture(surface, [](ImDrawList* list) {
        list->PushClipRect({100, 100}, {200, 200}, true);
        add_curve(list, {{0, 150}, {600, 150}, {600, 199}, {-1e30, 199}}, {full, 9.0, {}});
        list->PopClipRect();
    });
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (x < 100 || x >= 200 || y < 100 || y >= 200) {
                ASSERT_EQ(support::darkness(image, x, y), 0) << x << " " << y;
            }
    EXPECT_EQ(support::darkness(image, 150, 150), 255);
}

TEST(Curves, BreakAtPointsThatAreNotFinite) {
    Offscreen surface(support::options());
    const Image image =
        curve(surface, {{50, 50}, {100, 50}, gap_point(), {200, 50}, {250, 50}, {INFINITY, 50}}, {full, 4.0, {}});
    EXPECT_EQ(support::darkness(image, 75, 50), 255);
    EXPECT_EQ(support::darkness(image, 150, 50), 0);
    EXPECT_EQ(support::darkness(image, 225, 50), 255);
    EXPECT_EQ(support::darkness(image, 300, 50), 0);
}

TEST(Curves, WhatIsDrawnAfterwardsIsInItsPlace) {
    // More vertices than 16-bit indices can address, then ordinary rectangles.
    Offscreen surface(support::options());
    std::vector<Point> saw;
    for (int i = 0; i < 100000; ++i) saw.push_back({50.0 + i * 0.005, i % 2 == 0 ? 50.0 : 250.0});
    const Image image = support::picture(surface, [&](ImDrawList* list) {
        list->AddRectFilled({10, 300}, {20, 310}, IM_COL32(0, 0, 0, 255));
        add_curve(list, saw, {full, 1.0, {}});
        list->AddRectFilled({30, 300}, {40, 310}, IM_COL32(0, 0, 0, 255));
        add_curve(list, {{50, 305}, {60, 305}}, {full, 4.0, {}});
        list->AddRectFilled({70, 300}, {80, 310}, IM_COL32(0, 0, 0, 255));
    });
    for (const int x : {15, 35, 55, 75}) EXPECT_EQ(support::darkness(image, x, 305), 255) << x;
    for (const int x : {25, 45, 65, 85}) EXPECT_EQ(support::darkness(image, x, 305), 0) << x;
    EXPECT_GT(support::darkness(image, 300, 150), 250);
}

TEST(Curves, ALongCurveMayBeTheLastThingDrawn) {
    Offscreen surface(support::options());
    std::vector<Point> saw;
    for (int i = 0; i < 100000; ++i) saw.push_back({50.0 + i * 0.005, i % 2 == 0 ? 50.0 : 250.0});
    const Image image = curve(surface, saw, {full, 1.0, {}});
    EXPECT_GT(support::darkness(image, 300, 150), 250);
    EXPECT_EQ(support::darkness(image, 300, 300), 0);
}

// The masks of all curves of a picture have places of their own, also where they need more than one row of them.
TEST(Curves, ManyInOnePictureAreAsEachAlone) {
    Offscreen surface(support::options());
    const auto fan = [](int i) { return std::vector<Point>{{20.0, 20.0 + 30.0 * i}, {580.0, 22.0 + 32.0 * i}}; };
    const Image all = support::picture(surface, [&](ImDrawList* list) {
        for (int i = 0; i < 11; ++i) add_curve(list, fan(i), {full, 3.0, {}});
    });
    std::vector<int> sum(all.rgb.size() / 3);
    for (int i = 0; i < 11; ++i) {
        const Image alone = curve(surface, fan(i), {full, 3.0, {}});
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += 255 - alone.rgb[3 * k];
    }
    for (std::size_t k = 0; k < sum.size(); ++k) ASSERT_EQ(255 - all.rgb[3 * k], sum[k]) << k % 600 << " " << k / 600;
}

TEST(Curves, ThinningCannotBeSeen) {
    Offscreen surface(support::options());
    std::vector<Point> fine, coarse;
    for (int i = 0; i <= 100000; ++i) {
        const double s = i / 100000.0;
        fine.push_back({20.0 + 560.0 * s, 200.0 - 180.0 * std::sin(25.0 * s) * (1.0 - s)});
        if (i % 50 == 0) coarse.push_back(fine.back());
    }
    EXPECT_LT(worst_tile(curve(surface, fine, {full, 1.5, {}}), curve(surface, coarse, {full, 1.5, {}})),
              worst_tile_allowed);
}

TEST(Curves, TheFinerMaskDrawsTheSameCurve) {
    SurfaceOptions options = support::options();
    Offscreen plain(options);
    options.curve_fineness = 2;
    Offscreen fine(options);
    std::vector<Point> points;
    for (int i = 0; i <= 500; ++i) points.push_back({20.0 + 1.1 * i, 200.0 + 150.0 * std::sin(i * 0.05)});
    const Image a = curve(plain, points, {full, 2.0, {}}), b = curve(fine, points, {full, 2.0, {}});
    EXPECT_NE(a, b);
    EXPECT_LT(worst_tile(a, b), worst_tile_allowed);
}

// A curve shifted by one pixel must be detected as a different picture.
TEST(Curves, ACurveMovedByAPixelIsNoticed) {
    Offscreen surface(support::options());
    const auto wave = [&](double shift) {
        std::vector<Point> points;
        for (int i = 0; i <= 500; ++i) points.push_back({20.0 + 1.1 * i, shift + 200.0 + 150.0 * std::sin(i * 0.05)});
        return curve(surface, points, {full, 1.5, {}});
    };
    const Image here = wave(0.0);
    EXPECT_EQ(worst_tile(here, wave(0.0)), 0.0);
    EXPECT_GT(worst_tile(here, wave(1.0)), 2.0 * worst_tile_allowed);
}

}  // namespace
}  // namespace achilles
