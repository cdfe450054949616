#include "figure/parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace achilles {

namespace {

// Local coordinates of a part: along it, and to its left.
struct PartFrame {
    Point from, along;
    double length = 0.0;
    // The point at these distances along the part and to its left.
    Point operator()(double forward, double left) const {
        return {from.x + forward * along.x - left * along.y, from.y + forward * along.y + left * along.x};
    }
};

// nullopt if the ends coincide or are not finite, because the part has no direction.
std::optional<PartFrame> way(const Point& from, const Point& to) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
    return PartFrame{from, {(to.x - from.x) / length, (to.y - from.y) / length}, length};
}

Point line_break() { return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()}; }

}  // namespace

std::vector<Point> box_corners(const Point& middle, double width, double height, double angle) {
    const PartFrame along{middle, {std::cos(angle), std::sin(angle)}, 0.0};
    const double w = 0.5 * width, h = 0.5 * height;
    return {along(-w, -h), along(w, -h), along(w, h), along(-w, h)};
}

double fitting_across(double rest, double world) {
    constexpr double of_world = 0.045, of_rest = 0.4;
    return std::min(of_world * world, rest > 0.0 && std::isfinite(rest) ? of_rest * rest : world);
}

int fitting_coils(const PartSize& size) {
    constexpr int least = 4, most = 16;
    constexpr double apart = 0.85;  // distance of coils as a fraction of their width
    const double coils = std::round(size.rest / (apart * size.across));
    return std::isfinite(coils) ? static_cast<int>(std::clamp<double>(coils, least, most)) : least;
}

std::vector<Point> spring_line(const Point& from, const Point& to, int coils, const PartSize& size) {
    const auto at = way(from, to);
    if (!at) return {from, to};
    constexpr double end_of_across = 0.5, max_of_length = 0.15;
    const double end = std::min(end_of_across * size.across, max_of_length * at->length);
    const int turns = 2 * coils;
    std::vector<Point> points{from, (*at)(end, 0.0)};
    for (int i = 0; i < turns; ++i)
        points.push_back(
            (*at)(end + (at->length - 2.0 * end) * (i + 0.5) / turns, (i % 2 == 0 ? 0.5 : -0.5) * size.across));
    points.push_back((*at)(at->length - end, 0.0));
    points.push_back(to);
    return points;
}

std::vector<Point> damper_line(const Point& from, const Point& to, const PartSize& size) {
    const auto at = way(from, to);
    if (!at) return {from, to};
    const double length = at->length, rest = size.rest > 0.0 && std::isfinite(size.rest) ? size.rest : length;
    // The cup keeps its size while it fits. The piston is in the middle of the cup at rest, near its bottom under full
    // compression, and near its mouth under large extension.
    const double bottom = 0.25 * std::min(length, rest), cup = std::min(0.4 * rest, 0.5 * length);
    const double piston = bottom + cup * (0.1 + 0.8 * length / (length + rest));
    const double wall = 0.5 * size.across, plate = 0.7 * wall;
    const auto& p = *at;
    return {from,
            p(bottom, 0.0),
            line_break(),
            p(bottom + cup, wall),
            p(bottom, wall),
            p(bottom, -wall),
            p(bottom + cup, -wall),
            line_break(),
            p(piston, plate),
            p(piston, -plate),
            line_break(),
            p(piston, 0.0),
            to};
}

std::vector<Point> hatching(const Point& from, const Point& to, double apart) {
    constexpr double most = 1000.0;
    const auto at = way(from, to);
    if (!at || !(apart > 0.0)) return {};
    const int strokes = static_cast<int>(std::clamp(std::round(at->length / apart), 1.0, most));
    const double every = at->length / strokes, deep = 0.8 * std::min(apart, every);
    std::vector<Point> points;
    for (int i = 1; i <= strokes; ++i) {
        points.push_back((*at)(i * every, 0.0));
        points.push_back((*at)(i * every - deep, -deep));
        points.push_back(line_break());
    }
    return points;
}

std::vector<Point> strip_right_of(const Point& from, const Point& to, double deep) {
    const auto at = way(from, to);
    if (!at || !(deep > 0.0)) return {};
    return {(*at)(0.0, 0.0), (*at)(at->length, 0.0), (*at)(at->length, -deep), (*at)(0.0, -deep)};
}

}  // namespace achilles
