#include "figure/refine.hpp"

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

constexpr int most_halvings = 56;
constexpr std::size_t most_points = 20000;  // of a curve that turns in the picture without end

struct At {
    double s;
    Point p;
};

// Whether a chord may be seen, or what of the curve is between its ends: within its own length of the picture.
bool is_near(const Point& a, const Point& b, const Drawing& seen) {
    const double reach = std::hypot(b.x - a.x, b.y - a.y);
    return std::max(a.x, b.x) + reach >= seen.x_low && std::min(a.x, b.x) - reach <= seen.x_high &&
           std::max(a.y, b.y) + reach >= seen.y_low && std::min(a.y, b.y) - reach <= seen.y_high;
}

double distance_to_chord(const Point& p, const Point& a, const Point& b) {
    const double x = b.x - a.x, y = b.y - a.y, length = std::hypot(x, y);
    if (!(length > 0.0)) return std::hypot(p.x - a.x, p.y - a.y);
    return std::abs(x * (p.y - a.y) - y * (p.x - a.x)) / length;
}

class Refiner {
 public:
    Refiner(const ParametricCurve& curve, const Drawing& seen)
        : curve_(curve), seen_(seen), size_(std::hypot(seen.x_high - seen.x_low, seen.y_high - seen.y_low)) {}

    // What is between two points, less the first.
    void add(const At& a, const At& b, int halvings) {
        const bool is_short = std::hypot(b.p.x - a.p.x, b.p.y - a.p.y) <= 0.1 * size_;
        if (halvings < most_halvings && points_.size() < most_points && is_near(a.p, b.p, seen_)) {
            const double s = 0.5 * (a.s + b.s);
            const At middle{s, curve_(s)};
            constexpr double flat = 5e-5;  // of the diagonal: a twentieth of a pixel
            if (s != a.s && s != b.s && !(is_short && distance_to_chord(middle.p, a.p, b.p) <= flat * size_)) {
                add(a, middle, halvings + 1);
                return add(middle, b, halvings + 1);
            }
        }
        points_.push_back(b.p);
    }
    std::vector<Point> points_;

 private:
    const ParametricCurve& curve_;
    const Drawing& seen_;
    double size_;
};

}  // namespace

std::vector<Point> refined(const ParametricCurve& curve, double low, double high, int pieces, const Drawing& seen) {
    Refiner refiner(curve, seen);
    At before{low, curve(low)};
    refiner.points_.push_back(before.p);
    for (int i = 1; i <= pieces; ++i) {
        const double s = low + (high - low) * i / pieces;
        const At here{s, curve(s)};
        refiner.add(before, here, 0);
        before = here;
    }
    return std::move(refiner.points_);
}

}  // namespace achilles
