#include "surface/curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace achilles {
namespace {

constexpr double tolerance = 0.05;

double distance_to_edge(const Point& p, const Point& a, const Point& b) {
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const double s = square > 0.0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0, 1.0) : 0.0;
    return std::hypot(p.x - a.x - s * x, p.y - a.y - s * y);
}

double distance(const Point& p, const std::vector<Point>& line) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
        nearest = std::min(nearest, distance_to_edge(p, line[i], line[i + 1]));
    return nearest;
}

double length(const std::vector<Point>& line) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
        if (is_finite(line[i]) && is_finite(line[i + 1]))
            sum += std::hypot(line[i + 1].x - line[i].x, line[i + 1].y - line[i].y);
    return sum;
}

// A bouncing ball with many samples: arcs and corners of decreasing size.
std::vector<Point> bounces(int samples) {
    std::vector<Point> points;
    double x = 0.0, width = 200.0, height = 300.0;
    for (int k = 0; k < 12; ++k, x += width, width /= 2.0, height /= 4.0)
        for (int i = 0; i <= samples; ++i) {
            const double s = static_cast<double>(i) / samples;
            points.push_back({x + s * width, 350.0 - 4.0 * height * s * (1.0 - s)});
        }
    return points;
}

TEST(Polyline, ThinningStaysWithinItsTolerance) {
    const std::vector<Point> points = bounces(2000), thin = thinned(points, tolerance);
    EXPECT_LT(thin.size(), points.size() / 50);
    for (const Point& p : points) ASSERT_LE(distance(p, thin), tolerance * 1.0001);
}

TEST(Polyline, ThinningKeepsCornersAndExtremes) {
    std::vector<Point> saw;
    for (int i = 0; i < 20000; ++i) saw.push_back({i * 0.02, i % 2 == 0 ? 10.0 : 90.0});
    const std::vector<Point> thin = thinned(saw, tolerance);
    // Adjacent teeth are 0.04 px apart, but each one keeps its full height.
    EXPECT_NEAR(length(thin), length(saw), length(saw) * 1e-3);
    const std::vector<Point> there_and_back{{0, 0}, {50, 0}, {100, 0}, {60, 0}, {20, 0}, {70, 0}};
    const std::vector<Point> kept = thinned(there_and_back, tolerance);
    EXPECT_DOUBLE_EQ(length(kept), 100.0 + 80.0 + 50.0);
}

TEST(Polyline, ThinningKeepsBreaksAndPointsThatStandAlone) {
    const std::vector<Point> thin =
        thinned({{0, 0}, gap_point(), {5, 5}, {9, 5}, gap_point(), gap_point(), {7, 7}}, 0.05);
    EXPECT_EQ(std::count_if(thin.begin(), thin.end(), [](const Point& p) { return !is_finite(p); }), 2);
    EXPECT_EQ(thinned({}, tolerance).size(), 0U);
}

TEST(Polyline, CuttingKeepsWhatIsInside) {
    const std::vector<Point> inside =
        cut({{-100, 50}, {300, 50}, {300, 500}, {50, 500}, {50, -1e90}}, {0, 0, 100, 100}, {}, 0);
    EXPECT_DOUBLE_EQ(length(inside), 200.0);
    for (const Point& p : inside)
        if (is_finite(p)) {
            EXPECT_GE(p.x, 0.0);
            EXPECT_LE(p.x, 100.0);
        }
}

TEST(Polyline, DashesHaveTheirLengthsAcrossCorners) {
    // 4 on, 6 off: two fifths of the length is drawn, for any curve.
    std::vector<Point> circle;
    constexpr double radius = 400.0 / (2.0 * std::numbers::pi);
    for (int i = 0; i <= 3000; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 3000;
        circle.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    const ClipBox box{-100, -100, 100, 100};
    EXPECT_NEAR(length(cut(circle, box, {4, 6}, 0.0)), 160.0, 0.1);
    EXPECT_NEAR(length(cut(circle, box, {4, 6}, 1.0)), 80.0, 0.1);  // the caps add the rest
}

TEST(Polyline, DashesDoNotDependOnTheView) {
    const std::vector<Point> line{{-1000.5, 10}, {1000, 10}};
    const std::vector<Point> a = cut(line, {0, 0, 100, 100}, {5, 5}, 0.0),
                             b = cut(line, {50, 0, 100, 100}, {5, 5}, 0.0);
    for (const Point& p : b)
        if (is_finite(p) && p.x > 50.0) {
            EXPECT_TRUE(std::any_of(a.begin(), a.end(), [&](const Point& q) { return std::abs(p.x - q.x) < 1e-9; }));
        }
}

TEST(Polyline, StrangeDashesEnd) {
    const std::vector<Point> line{{0, 10}, {1e60, 10}, {0, 10}};
    for (const std::vector<double>& dash :
         {std::vector<double>{0, 0}, {-1, 1}, {1e-9, 1e-9}, {3.0}, {0.0, 4.0}, {1e300, 1e300}})
        EXPECT_LT(cut(line, {0, 0, 100, 100}, dash, 0.5).size(), 200U);
}

}  // namespace
}  // namespace achilles
