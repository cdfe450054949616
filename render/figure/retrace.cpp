#include "figure/retrace.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace achilles {

namespace {

constexpr double cell_size = 0.35;  // pixels

// What has been drawn, on a grid of cells: when a line first came into each, and which way it went.
class Traces {
 public:
    struct Visit {
        double length;  // of the curve until there, cells
        Point direction, at;
    };
    // Whether the curve was near `at` before, well before it came there now, and on its way there or back.
    bool is_retraced(const Point& at, const Visit& now) const {
        constexpr double well_before = 10.0 / cell_size, along = 0.97, near = 0.25 / cell_size;
        for (int i = -2; i <= 2; ++i) {
            for (int j = -2; j <= 2; ++j) {
                const auto found = visits_.find(key(at.x + i, at.y + j));
                if (found == visits_.end() || now.length - found->second.length < well_before) continue;
                const Point &other = found->second.direction, &there = found->second.at;
                if (std::hypot(there.x - at.x, there.y - at.y) > near) continue;
                if (std::abs(other.x * now.direction.x + other.y * now.direction.y) > along) return true;
            }
        }
        return false;
    }
    void add(const Point& at, const Visit& visit) { visits_.try_emplace(key(at.x, at.y), visit); }

 private:
    static std::uint64_t key(double x, double y) {
        const auto cell = [](double v) {
            return static_cast<std::uint32_t>(
                static_cast<std::int32_t>(std::floor(std::fmin(std::fmax(v, -1e6), 1e6))));
        };
        return (std::uint64_t{cell(x)} << 32) | cell(y);
    }
    std::unordered_map<std::uint64_t, Visit> visits_;
};

}  // namespace

std::vector<Point> without_retraced(const std::vector<Point>& points, const Axis& x, const Axis& y,
                                    const Resolution& size_of_plot) {
    const double columns = size_of_plot.width / cell_size, rows = size_of_plot.height / cell_size;
    const auto place = [&](const Point& p) {
        return Point{columns * (p.x - x.low) / (x.high - x.low), rows * (p.y - y.low) / (y.high - y.low)};
    };
    Traces traces;
    std::vector<Point> kept;
    double length = 0.0;
    bool is_broken = true;  // the last point kept does not lead to the next
    std::vector<bool> retraced;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Point a = place(points[i]), b = place(points[i + 1]);
        const double size = std::hypot(b.x - a.x, b.y - a.y);
        if (!std::isfinite(size)) {
            is_broken = true;
            continue;
        }
        if (size == 0.0) continue;
        const Point direction{(b.x - a.x) / size, (b.y - a.y) / size};
        // In steps of less than a cell; more than these cross no panel.
        const int parts = static_cast<int>(std::fmin(std::ceil(1.5 * size), 4.0 * (columns + rows)));
        retraced.assign(static_cast<std::size_t>(parts), false);
        for (int k = 0; k < parts; ++k) {
            const double share = (k + 0.5) / parts;
            const Point at{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
            const Traces::Visit now{length + share * size, direction, at};
            retraced[static_cast<std::size_t>(k)] = traces.is_retraced(at, now);
            traces.add(at, now);
        }
        length += size;
        // What is new of the chord, which may be a long jump that goes over an earlier one for a part of its way.
        const auto at = [&](int k) {
            const double share = static_cast<double>(k) / parts;
            return Point{points[i].x + share * (points[i + 1].x - points[i].x),
                         points[i].y + share * (points[i + 1].y - points[i].y)};
        };
        for (int k = 0; k < parts;) {
            int end = k;
            while (end < parts && retraced[static_cast<std::size_t>(end)] == retraced[static_cast<std::size_t>(k)])
                ++end;
            if (retraced[static_cast<std::size_t>(k)]) {
                is_broken = true;
            } else {
                if (is_broken) {
                    if (!kept.empty()) kept.push_back(break_of_curve);
                    kept.push_back(k == 0 ? points[i] : at(k));
                }
                kept.push_back(end == parts ? points[i + 1] : at(end));
                is_broken = false;
            }
            k = end;
        }
    }
    return kept;
}

}  // namespace achilles
