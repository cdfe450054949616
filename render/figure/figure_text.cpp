// A figure as text: what golden tests compare before they compare pixels.
#include <fmt/format.h>

#include "figure/figure.hpp"

namespace achilles {

namespace {

std::string color_text(const Color& c) { return fmt::format("#{:02x}{:02x}{:02x}{:02x}", c.r, c.g, c.b, c.a); }

std::string axis_text(const char* name, const Axis& axis) {
    std::string text = fmt::format("  {} \"{}\" [{:.9g}, {:.9g}]{}:", name, axis.label, axis.low, axis.high,
                                   axis.logarithmic ? " log" : "");
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) text += fmt::format(" {}", tick.label);
    return text + "\n";
}

// At most about forty of the points, always the last one.
std::string points_text(const std::vector<Point>& points) {
    const std::size_t stride = std::max<std::size_t>(1, (points.size() + 39) / 40);
    std::string text;
    for (std::size_t i = 0; i < points.size(); i += stride)
        text += fmt::format(" ({:.9g}, {:.9g})", points[i].x + 0.0, points[i].y + 0.0);
    if (!points.empty() && (points.size() - 1) % stride != 0)
        text += fmt::format(" ({:.9g}, {:.9g})", points.back().x + 0.0, points.back().y + 0.0);
    return text;
}

}  // namespace

std::string to_text(const Figure& figure) {
    std::string text = fmt::format("figure columns {} background {}\n", figure.columns, color_text(figure.background));
    for (const Panel& panel : figure.panels) {
        text += fmt::format("panel \"{}\"{}{}\n", panel.title, panel.equal_axes ? " equal" : "",
                            panel.legend ? " legend" : "");
        text += axis_text("x", panel.x) + axis_text("y", panel.y);
        for (const Curve& curve : panel.curves)
            text +=
                fmt::format("  curve \"{}\" {} width {:.9g}{} points {}:{}\n", curve.label,
                            color_text(curve.stroke.color), curve.stroke.width,
                            curve.stroke.dash.empty() ? "" : " dashed", curve.points.size(), points_text(curve.points));
        for (const Markers& markers : panel.markers)
            text +=
                fmt::format("  markers \"{}\" {} size {:.9g} points {}:{}\n", markers.label, color_text(markers.fill),
                            markers.size, markers.points.size(), points_text(markers.points));
    }
    return text;
}

}  // namespace achilles
