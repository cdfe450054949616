// Polylines in pixels: thinned, clipped, split into dashes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "surface/curves.hpp"

namespace achilles {

namespace {

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y; }
Point between(const Point& a, const Point& b, double s) { return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}; }

// Williams' cone algorithm. From an anchor, the tolerance around each point subtends a small angle. As long as these
// angles have a common direction, a single edge from the anchor passes all points within the tolerance.
class Cone {
 public:
    Cone(const Point& anchor, double tolerance) : anchor_(anchor), farthest_(anchor), tolerance_(tolerance) {}

    // Accepts the point; false if the edge must end at farthest().
    bool accept(const Point& point) {
        const Point v = point - anchor_;
        const double r = std::sqrt(dot(v, v));      // is_finite() has excluded overflow and underflow here
        if (r < reach_ - tolerance_) return false;  // reversal: an extreme
        if (r <= tolerance_) return true;
        if (open_ && (cross(low_, v) < 0.0 || cross(v, high_) < 0.0 || dot(low_, v) < 0.0)) return false;
        narrow(v, tolerance_ / r);
        if (r > reach_) {
            reach_ = r;
            farthest_ = point;
        }
        return true;
    }
    const Point& farthest() const { return farthest_; }
    bool empty() const { return reach_ == 0.0; }

 private:
    void narrow(const Point& v, double sine) {
        const double cosine = std::sqrt(1.0 - sine * sine);
        const Point low{v.x * cosine + v.y * sine, v.y * cosine - v.x * sine};
        const Point high{v.x * cosine - v.y * sine, v.y * cosine + v.x * sine};
        if (!open_ || cross(low_, low) > 0.0) low_ = low;
        if (!open_ || cross(high, high_) > 0.0) high_ = high;
        open_ = true;
    }

    Point anchor_, farthest_, low_{}, high_{};
    double tolerance_, reach_ = 0.0;
    bool open_ = false;
};

void thin_run(const std::vector<Point>& points, std::size_t begin, std::size_t end, double tolerance,
              std::vector<Point>& out) {
    out.push_back(points[begin]);
    Cone cone(points[begin], tolerance);
    for (std::size_t i = begin + 1; i < end; ++i) {
        if (cone.accept(points[i])) continue;
        out.push_back(cone.farthest());
        cone = Cone(cone.farthest(), tolerance);
        cone.accept(points[i]);  // a new cone accepts every point
    }
    if (end - begin > 1) {
        if (!cone.empty()) out.push_back(cone.farthest());
        out.push_back(points[end - 1]);
    }
}

// Liang-Barsky clipping: the part of the edge inside the box, as fractions of the edge.
std::optional<std::pair<double, double>> inside(const Point& a, const Point& b, const ClipBox& box) {
    double enter = 0.0, leave = 1.0;
    const auto side = [&](double start, double step, double low, double high) {
        if (step == 0.0) return start >= low && start <= high;
        const double s = (low - start) / step, t = (high - start) / step;
        enter = std::max(enter, std::min(s, t));
        leave = std::min(leave, std::max(s, t));
        return enter <= leave;
    };
    if (!side(a.x, b.x - a.x, box.x_low, box.x_high) || !side(a.y, b.y - a.y, box.y_low, box.y_high)) return {};
    return std::pair{enter, leave};
}

// Collects edges and joins consecutive ones.
class Pieces {
 public:
    void add(const Point& a, const Point& b) {
        if (out_.empty() || !joined_ || out_.back().x != a.x || out_.back().y != a.y) {
            if (!out_.empty()) out_.push_back(gap_point());
            out_.push_back(a);
        }
        out_.push_back(b);
        joined_ = true;
    }
    void lift() { joined_ = false; }
    std::vector<Point> take() { return std::move(out_); }

 private:
    std::vector<Point> out_;
    bool joined_ = false;
};

// The dash pattern as a function of arc length.
class Dashes {
 public:
    Dashes(const std::vector<double>& lengths, double cap) : lengths_(lengths), cap_(cap) {
        if (lengths_.size() % 2 != 0) lengths_.insert(lengths_.end(), lengths.begin(), lengths.end());
        period_ = std::accumulate(lengths_.begin(), lengths_.end(), 0.0);
        // A pattern shorter than a pixel would be invisible but slow.
        if (!(period_ >= 1.0) || !std::isfinite(period_)) lengths_.clear();
    }
    bool solid() const { return lengths_.empty(); }

    // Adds the dashes in the interval [from, to] of an edge with the given length that starts at arc length `start`.
    void stroke(const Point& a, const Point& b, double start, double length, double from, double to,
                Pieces& pieces) const {
        if (to > farthest_dash)
            return pieces.add(between(a, b, (from - start) / length), between(a, b, (to - start) / length));
        double offset = period_ * std::floor(from / period_);
        for (; offset < to; offset += period_) {
            double at = offset;
            for (std::size_t k = 0; k < lengths_.size(); k += 2) {
                const double middle = at + lengths_[k] / 2.0;
                const double half = std::max(lengths_[k] / 2.0 - cap_, 0.0);
                const double low = std::max(middle - half, from), high = std::min(middle + half, to);
                if (low <= high)
                    pieces.add(between(a, b, (low - start) / length), between(a, b, (high - start) / length));
                if (high < to) pieces.lift();
                at += lengths_[k] + lengths_[k + 1];
            }
        }
    }

 private:
    // Beyond this arc length rounding destroys the phase of the dashes, and far beyond it adding a period has no
    // effect.
    static constexpr double farthest_dash = 1e12;

    std::vector<double> lengths_;
    double cap_, period_ = 0.0;
};

}  // namespace

Point gap_point() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
}

bool is_finite(const Point& point) {
    // Beyond this limit the squares in the formulas would overflow. No screen is that wide.
    constexpr double largest = 1e100;
    return std::abs(point.x) < largest && std::abs(point.y) < largest;
}

std::vector<Point> thinned(const std::vector<Point>& points, double tolerance) {
    std::vector<Point> out;
    for (std::size_t begin = 0; begin < points.size();) {
        if (!is_finite(points[begin])) {
            ++begin;
            continue;
        }
        std::size_t end = begin;
        while (end < points.size() && is_finite(points[end])) ++end;
        if (!out.empty()) out.push_back(gap_point());
        thin_run(points, begin, end, tolerance, out);
        begin = end;
    }
    return out;
}

std::vector<Point> cut(const std::vector<Point>& points, const ClipBox& box, const std::vector<double>& dash,
                       double cap) {
    const Dashes dashes(dash, cap);
    Pieces pieces;
    double start = 0.0;  // arc length
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Point& a = points[i];
        const Point& b = points[i + 1];
        if (!is_finite(a) || !is_finite(b)) {
            pieces.lift();
            continue;
        }
        const double length = dashes.solid() ? 0.0 : std::hypot(b.x - a.x, b.y - a.y);  // not needed for solid lines
        const auto part = inside(a, b, box);
        if (!part) {
            pieces.lift();
        } else if (dashes.solid() || length == 0.0) {
            // The end points themselves instead of a + 1 * (b - a), because adjacent edges must join exactly.
            pieces.add(part->first > 0.0 ? between(a, b, part->first) : a,
                       part->second < 1.0 ? between(a, b, part->second) : b);
        } else {
            dashes.stroke(a, b, start, length, start + part->first * length, start + part->second * length, pieces);
        }
        start += length;
    }
    return pieces.take();
}

}  // namespace achilles
