// A figure as text: what golden tests compare before they compare pixels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/figure.hpp"

namespace achilles {

namespace {

std::string color_text(const Color& c) { return fmt::format("#{:02x}{:02x}{:02x}{:02x}", c.r, c.g, c.b, c.a); }

std::string axis_text(const char* name, const Axis& axis) {
    std::string text = fmt::format("  {} \"{}\" [{:.9g}, {:.9g}]{}{}:", name, axis.label, axis.low, axis.high,
                                   axis.logarithmic ? " log" : "", axis.labelled ? "" : " labelled below");
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) text += fmt::format(" {}", tick.label);
    return text + "\n";
}

std::string number_text(double x) { return std::isnan(x) ? "nan" : fmt::format("{:.9g}", x + 0.0); }  // no "-0"

// At most forty of the points, the first and the last among them.
std::string points_text(const std::vector<Point>& points) {
    constexpr std::size_t most = 40;
    const std::size_t shown = std::min(most, points.size());
    std::string text;
    for (std::size_t i = 0; i < shown; ++i) {
        const Point& p = points[shown == 1 ? 0 : i * (points.size() - 1) / (shown - 1)];
        text += fmt::format(" ({}, {})", number_text(p.x), number_text(p.y));
    }
    return text;
}

const char* shape_text(Markers::Shape shape) {
    switch (shape) {
        case Markers::Shape::square:
            return "square";
        case Markers::Shape::circle:
            return "circle";
        case Markers::Shape::triangle:
            return "triangle";
        case Markers::Shape::diamond:
            return "diamond";
        case Markers::Shape::bar:
            return "bar";
    }
    return "";
}

}  // namespace

std::string to_text(const Figure& figure) {
    std::string text = fmt::format("figure columns {} background {}\n", figure.columns, color_text(figure.background));
    for (const Key& key : figure.keys) text += fmt::format("key \"{}\"\n", key.label);
    for (const Panel& panel : figure.panels) {
        text += fmt::format("panel \"{}\"{}{}{}\n", panel.title, panel.equal_axes ? " equal" : "",
                            panel.rows > 1 ? fmt::format(" rows {}", panel.rows) : "",
                            !panel.legend        ? ""
                            : panel.legend_above ? " legend above"
                                                 : " legend");
        text += axis_text("x", panel.x) + axis_text("y", panel.y);
        for (const Band& band : panel.bands)
            text += fmt::format("  band \"{}\" {} {:.9g} to {:.9g}\n", band.label, color_text(band.color), band.low,
                                band.high);
        if (!panel.boundary.points.empty())
            text += fmt::format("  boundary {} points {}:{}\n", color_text(panel.boundary.stroke.color),
                                panel.boundary.points.size(), points_text(panel.boundary.points));
        for (const Curve& curve : panel.curves)
            text +=
                fmt::format("  curve \"{}\" {} width {:.9g}{} points {}:{}\n", curve.label,
                            color_text(curve.stroke.color), curve.stroke.width,
                            curve.stroke.dash.empty() ? "" : " dashed", curve.points.size(), points_text(curve.points));
        for (const TimeBar& one : panel.time_bars) {
            constexpr std::size_t most = 40;
            text += fmt::format("  bar \"{}\" of {}:", one.label, one.marks.size());
            for (std::size_t i = 0; i < std::min(most, one.marks.size()); ++i) {
                const TimeBar::Mark& mark = one.marks[i];
                text += mark.high > mark.low ? fmt::format(" {:.9g} to {:.9g}", mark.low, mark.high)
                                             : fmt::format(" {:.9g}", mark.low);
            }
            text += "\n";
        }
        for (const Markers& markers : panel.markers)
            text += fmt::format("  markers \"{}\" {} {} size {:.9g} points {}:{}\n", markers.label,
                                shape_text(markers.shape), color_text(markers.fill), markers.size,
                                markers.points.size(), points_text(markers.points));
    }
    return text;
}

}  // namespace achilles
