// A figure as text, which golden tests compare before they compare pixels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/figure.hpp"

namespace achilles {

namespace {

std::string color_text(const Color& c) { return fmt::format("#{:02x}{:02x}{:02x}{:02x}", c.r, c.g, c.b, c.a); }

std::string axis_text(const char* name, const Axis& axis) {
    std::string text = fmt::format("  {} \"{}\" [{:.9g}, {:.9g}]{}{}:", name, axis.label, axis.low, axis.high,
                                   axis.logarithmic ? " log" : "", axis.labeled ? "" : " labelled below");
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) text += fmt::format(" {}", tick.label);
    return text + "\n";
}

std::string number_text(double x) { return std::isnan(x) ? "nan" : fmt::format("{:.9g}", x + 0.0); }  // no "-0"

// At most forty of the points, including the first and the last.
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

// Run-length encoding of the colors, at most forty runs, and a checksum of all of them.
std::string cells_text(const Cells& cells) {
    constexpr int most = 40;
    std::string text;
    std::uint64_t sum = 0xCBF29CE484222325u;
    int runs = 0;
    for (std::size_t i = 0, next = 0; i < cells.colors.size(); i = next, ++runs) {
        for (next = i; next < cells.colors.size() && cells.colors[next] == cells.colors[i];) ++next;
        const Color& c = cells.colors[i];
        for (const std::size_t part : {std::size_t{c.r}, std::size_t{c.g}, std::size_t{c.b}, std::size_t{c.a}, next})
            sum = (sum ^ part) * 0x100000001B3u;
        if (runs < most) text += fmt::format(" {}{}", color_text(c), next > i + 1 ? fmt::format("x{}", next - i) : "");
    }
    return fmt::format("{} x {}, {} runs, sum {:016x}:{}", cells.columns, cells.rows, runs, sum, text);
}

std::string many_text(const Panel& panel) {
    std::string text;
    if (panel.hatch.color.a > 0)
        text += fmt::format("  hatch \"{}\" {}\n", panel.hatch.label, color_text(panel.hatch.color));
    if (panel.raster.cells)
        text += fmt::format("  raster [{:.9g}, {:.9g}] [{:.9g}, {:.9g}] {}\n", panel.raster.left, panel.raster.right,
                            panel.raster.bottom, panel.raster.top, cells_text(*panel.raster.cells));
    const Dots& dots = panel.dots;
    if (!dots.points.empty())
        text += fmt::format("  dots {} of {}:{}\n", dots.colors.empty() ? color_text(dots.ink) : "in colours",
                            dots.points.size(), points_text(dots.points));
    if (!panel.color_bar.colors.empty())
        text += axis_text("bar", panel.color_bar.axis) + fmt::format("  from {} to {}\n",
                                                                     color_text(panel.color_bar.colors.front()),
                                                                     color_text(panel.color_bar.colors.back()));
    return text;
}

// At most forty slices of the tube.
std::string tube_text(const Tube& tube) {
    constexpr std::size_t most = 40;
    const std::size_t shown = std::min(most, tube.slices.size());
    std::string text = fmt::format("  tube \"{}\" {} {} slices {}:", tube.label, color_text(tube.fill),
                                   color_text(tube.edge), tube.slices.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const Tube::Slice& at = tube.slices[shown == 1 ? 0 : i * (tube.slices.size() - 1) / (shown - 1)];
        text += fmt::format(" {}: {} to {}", number_text(at.x), number_text(at.low), number_text(at.high));
    }
    return text + "\n";
}

const char* shape_text(Markers::MarkerShape shape) {
    switch (shape) {
        case Markers::MarkerShape::square:
            return "square";
        case Markers::MarkerShape::circle:
            return "circle";
        case Markers::MarkerShape::triangle:
            return "triangle";
        case Markers::MarkerShape::inverted_triangle:
            return "inverted triangle";
        case Markers::MarkerShape::diamond:
            return "diamond";
        case Markers::MarkerShape::hexagon:
            return "hexagon";
        case Markers::MarkerShape::bar:
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
        text += many_text(panel);
        for (const Tube& tube : panel.tubes) text += tube_text(tube);
        if (!panel.boundary.points.empty())
            text += fmt::format("  boundary {} points {}:{}\n", color_text(panel.boundary.stroke.color),
                                panel.boundary.points.size(), points_text(panel.boundary.points));
        const auto add_curves = [&](const char* what, const std::vector<Curve>& curves) {
            for (const Curve& curve : curves)
                text += fmt::format("  {} \"{}\" {} width {:.9g}{} points {}:{}\n", what, curve.label,
                                    color_text(curve.stroke.color), curve.stroke.width,
                                    curve.stroke.dash.empty() ? "" : " dashed", curve.points.size(),
                                    points_text(curve.points));
        };
        const auto add_markers = [&](const char* what, const std::vector<Markers>& all) {
            for (const Markers& markers : all)
                text += fmt::format("  {} \"{}\" {} {} size {:.9g} points {}:{}\n", what, markers.label,
                                    shape_text(markers.shape), color_text(markers.fill), markers.size,
                                    markers.points.size(), points_text(markers.points));
        };
        if (!panel.beyond.label.empty()) text += fmt::format("  beyond \"{}\"\n", panel.beyond.label);
        add_curves("curve beyond", panel.beyond.curves);
        add_markers("markers beyond", panel.beyond.markers);
        add_curves("curve", panel.curves);
        for (const TimeBar& one : panel.time_bars) {
            constexpr std::size_t most = 40;
            text += fmt::format("  bar \"{}\" of {}:", one.label, one.marks.size());
            for (std::size_t i = 0; i < std::min(most, one.marks.size()); ++i) {
                const TimeBar::TimeMark& mark = one.marks[i];
                text += mark.high > mark.low ? fmt::format(" {:.9g} to {:.9g}", mark.low, mark.high)
                                             : fmt::format(" {:.9g}", mark.low);
            }
            text += "\n";
        }
        add_markers("markers", panel.markers);
    }
    return text;
}

}  // namespace achilles
