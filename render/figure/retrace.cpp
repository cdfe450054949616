#include "figure/retrace.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace achilles {

namespace {

constexpr double cells = 400.0;  // across a panel

// What has been drawn, on a grid of cells: when a line first came into each, and which way it went.
class Traces {
 public:
    struct Visit {
        double length;  // of the curve until there
        Point direction;
    };
    // Whether the curve was near `at` before, well before it came there now, and on its way there or back.
    bool is_retraced(const Point& at, const Visit& now) const {
        constexpr double well_before = 8.0, along = 0.97;
        for (int i = -1; i <= 1; ++i) {
            for (int j = -1; j <= 1; ++j) {
                const auto found = visits_.find(key(at.x + i, at.y + j));
                if (found == visits_.end() || now.length - found->second.length < well_before) continue;
                const Point& other = found->second.direction;
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

std::vector<Point> without_retraced(const std::vector<Point>& points, const Axis& x, const Axis& y) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const auto place = [&](const Point& p) {
        return Point{cells * (p.x - x.low) / (x.high - x.low), cells * (p.y - y.low) / (y.high - y.low)};
    };
    Traces traces;
    std::vector<Point> kept;
    double length = 0.0;
    bool is_broken = true;  // the last point kept does not lead to the next
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
        const int parts = static_cast<int>(std::fmin(std::ceil(1.5 * size), 4.0 * cells));
        int retraced = 0;
        for (int k = 0; k < parts; ++k) {
            const double share = (k + 0.5) / parts;
            const Point at{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
            const Traces::Visit now{length + share * size, direction};
            retraced += traces.is_retraced(at, now) ? 1 : 0;
            traces.add(at, now);
        }
        length += size;
        if (2 * retraced > parts) {
            is_broken = true;
            continue;
        }
        if (is_broken) {
            if (!kept.empty()) kept.push_back({nothing, nothing});
            kept.push_back(points[i]);
        }
        kept.push_back(points[i + 1]);
        is_broken = false;
    }
    return kept;
}

}  // namespace achilles
