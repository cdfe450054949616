// Figures made by hand for the rendering tests.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "figure/figure.hpp"

namespace achilles::samples {

// A measure of labels: every byte is half as wide as it is high.
inline float half(const std::string& label, float size) { return 0.5F * size * static_cast<float>(label.size()); }

inline std::string number(double value) {
    // For these samples only: a few digits, and U+2212 for minus.
    std::string text = std::to_string(std::abs(value)).substr(0, 4);
    while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
        const bool point = text.back() == '.';
        text.pop_back();
        if (point) break;
    }
    return (value < 0.0 ? "\u2212" : "") + text;
}

inline Axis axis(const std::string& label, double low, double high, double step) {
    Axis result;
    result.label = label;
    result.low = low;
    result.high = high;
    for (int i = static_cast<int>(std::ceil(low / step - 1e-9)); i * step <= high + 1e-9; ++i) {
        result.ticks.push_back({i * step, number(i * step)});
        if ((i + 0.5) * step < high) result.ticks.push_back({(i + 0.5) * step, ""});
    }
    return result;
}

constexpr Color blue{31, 90, 160, 255}, red{200, 60, 40, 255}, gray{150, 150, 150, 255}, white{255, 255, 255, 255};

// Member by member, because GCC 12 reports nested braces here as uninitialized memory.
inline Curve curve(const std::string& label, Color color, double width, const std::vector<double>& dash) {
    Curve result;
    result.label = label;
    result.stroke.color = color;
    result.stroke.width = width;
    result.stroke.dash = dash;
    return result;
}

// A ball that bounces to rest: corners, dense impacts, a dashed phase, a legend.
inline Panel bouncing(const std::string& title = "(a)") {
    Panel panel;
    panel.title = title;
    panel.x = axis("t [s]", 0.0, 5.0, 1.0);
    panel.y = axis("y [m]", 0.0, 2.2, 0.5);
    Curve flight = curve("hybrid phase", blue, 1.5, {});
    Markers impacts{"impacts", Markers::MarkerShape::circle, white, blue, 6.0, {}};
    double t = 0.0, speed = 0.0, height = 2.0;
    constexpr double g = 4.0;
    for (int bounce = 0; bounce < 60; ++bounce) {
        const double flight_time = (speed + std::sqrt(speed * speed + 2.0 * g * height)) / g;
        for (int i = 0; i <= 60; ++i) {
            const double s = flight_time * i / 60;
            flight.points.push_back({t + s, height + speed * s - g * s * s / 2.0});
        }
        t += flight_time;
        impacts.points.push_back({t, 0.0});
        speed = 0.5 * (g * flight_time - speed);
        height = 0.0;
    }
    panel.markers.push_back({"Zeno point", Markers::MarkerShape::bar, gray, gray, 6.0, {{t, 0.0}}});
    panel.curves.push_back(flight);
    Curve rest = curve("constrained phase", red, 2.0, {7.0, 4.0});
    rest.points = {{t, 0.02}, {5.0, 0.02}};
    panel.curves.push_back(rest);
    panel.markers.push_back(impacts);
    panel.legend = true;
    return panel;
}

// A plane curve with equal axes, Greek labels with dots, a break, and events of every shape.
inline Panel phase_plane(const std::string& title = "(b)") {
    Panel panel;
    panel.title = title;
    panel.x = axis("\u03b8\u2081 [\u00b0]", -2.0, 2.0, 1.0);
    panel.y = axis("\u03b8\u0307\u2081 [\u00b0/s]", -1.5, 1.5, 0.5);
    panel.equal_axes = true;
    Curve spiral = curve("q\u0308 = \u03bb \u2202h", {120, 60, 150, 255}, 1.5, {});
    for (int i = 0; i <= 2000; ++i) {
        const double s = i / 2000.0, angle = 30.0 * s;
        spiral.points.push_back({1.8 * (1.0 - s) * std::cos(angle), 1.3 * (1.0 - s) * std::sin(angle)});
        if (i == 700) spiral.points.push_back({std::numeric_limits<double>::quiet_NaN(), 0.0});
    }
    panel.curves.push_back(spiral);
    const Color edge{40, 40, 40, 255};
    panel.markers.push_back({"impact", Markers::MarkerShape::square, red, edge, 7.0, {{-1.0, 0.5}}});
    panel.markers.push_back({"release", Markers::MarkerShape::triangle, {240, 180, 40, 255}, edge, 8.0, {{0.5, -0.5}}});
    panel.markers.push_back({"Zeno point", Markers::MarkerShape::diamond, blue, edge, 8.0, {{0.0, 0.0}}});
    panel.legend = true;
    panel.legend_at = {0.0, 1.0};
    return panel;
}

// A sawtooth line: only corners.
inline Panel corners(const std::string& title = "(c)") {
    Panel panel;
    panel.title = title;
    panel.x = axis("j", 0.0, 20.0, 5.0);
    panel.y = axis("v\u207b [m/s]", -1000.0, 1000.0, 500.0);
    Curve saw = curve("", red, 1.5, {});
    for (int i = 0; i <= 40; ++i) saw.points.push_back({i / 2.0, (i % 2 == 0 ? 950.0 : -950.0) * (1.0 - i / 80.0)});
    panel.curves.push_back(saw);
    return panel;
}

// A logarithmic axis.
inline Panel decay(const std::string& title = "(d)") {
    Panel panel;
    panel.title = title;
    panel.x = axis("impact k", 0.0, 24.0, 4.0);
    panel.y = {"|v\u2096 \u2212 v\u221e| [m/s]", 1e-6, 10.0, true, {}};
    const char* powers[] = {"10\u207b\u2076", "10\u207b\u2074", "10\u207b\u00b2", "1"};
    for (int i = 0; i < 4; ++i) panel.y.ticks.push_back({std::pow(10.0, 2.0 * i - 6.0), powers[i]});
    for (int i = 0; i < 3; ++i) panel.y.ticks.push_back({std::pow(10.0, 2.0 * i - 5.0), ""});
    Markers speeds{"", Markers::MarkerShape::circle, blue, blue, 4.0, {}};
    Curve line = curve("", gray, 1.0, {4.0, 3.0});
    for (int i = 0; i <= 24; ++i) {
        speeds.points.push_back({static_cast<double>(i), 3.0 * std::pow(0.55, i)});
        line.points.push_back(speeds.points.back());
    }
    panel.curves.push_back(line);
    panel.markers.push_back(speeds);
    return panel;
}

inline Figure figure(int panels) {
    Figure result;
    result.columns = panels > 4 ? 3 : panels > 1 ? 2 : 1;
    const std::string letters = "abcdefgh";
    for (int i = 0; i < panels; ++i) {
        const std::string title = {'(', letters[static_cast<std::size_t>(i)], ')'};
        result.panels.push_back(i % 4 == 0   ? bouncing(title)
                                : i % 4 == 1 ? phase_plane(title)
                                : i % 4 == 2 ? corners(title)
                                             : decay(title));
    }
    return result;
}

// A pendulum over a wavy floor.
inline Drawing mechanism() {
    Drawing drawing;
    drawing.x_low = -2.0, drawing.x_high = 2.0, drawing.y_low = -1.5, drawing.y_high = 1.5;
    DrawnShape floor;
    for (int i = 0; i <= 100; ++i) floor.points.push_back({-2.0 + 0.04 * i, -1.0 + 0.15 * std::sin(0.25 * i)});
    floor.points.push_back({2.0, -1.5});
    floor.points.push_back({-2.0, -1.5});
    floor.closed = floor.fill = true;
    floor.fill_color = {222, 222, 214, 255};
    floor.stroke = {{110, 110, 100, 255}, 1.5, {}};
    DrawnShape rod;
    rod.points = {{0.0, 1.2}, {0.8, 0.4}, {0.5, -0.5}};
    rod.stroke = {{60, 60, 60, 255}, 4.0, {}};
    DrawnShape ball;
    ball.kind = DrawnShape::Kind::disc;
    ball.points = {{0.5, -0.5}};
    ball.radius = 0.18;
    ball.fill = true;
    ball.fill_color = blue;
    ball.stroke = {{20, 50, 100, 255}, 1.5, {}};
    DrawnShape word;
    word.kind = DrawnShape::Kind::text;
    word.points = {{-1.2, 0.9}};
    word.text = "\u03b8\u0307\u2081 = 0.3";
    word.stroke.color = {30, 30, 30, 255};
    drawing.shapes = {floor, rod, ball, word};
    return drawing;
}

}  // namespace achilles::samples
