#include "figure/trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

#include "figure/palette.hpp"
#include "model/model.hpp"

namespace achilles {

namespace {

constexpr double flat = 0.1;  // pixels: a chord with a smaller error represents the curve

bool is_finite(const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

struct PlacedPoint {
    Point data, pixel;
    double t = 0.0;
};

// Receives the points of one curve in order of time and keeps those that are needed.
class Thinner {
 public:
    virtual ~Thinner() = default;
    Thinner() = default;
    Thinner(const Thinner&) = delete;
    Thinner& operator=(const Thinner&) = delete;
    virtual void add(const PlacedPoint& point) = 0;
    // The curve continues from another point.
    virtual void lift() = 0;
    virtual PhaseCurve take() = 0;
    // Whether points in this rectangle (pixels) would add nothing to the picture; false if unknown.
    virtual bool covers(double, double, double, double) const { return false; }

 protected:
    void keep(const PlacedPoint& point) {
        course_.points.push_back(point.data);
        course_.times.push_back(point.t);
    }
    void keep_break(double t) {
        if (course_.points.empty() || !is_finite(course_.points.back())) return;
        course_.points.push_back(break_of_curve);
        course_.times.push_back(t);
    }
    PhaseCurve course_;
};

// Thinner for curves over time. Points in one column of a fraction of a pixel show as a vertical line, which the first,
// lowest, highest and last point reproduce.
class ColumnThinner : public Thinner {
 public:
    void add(const PlacedPoint& point) override {
        const double column = std::floor(point.pixel.x * columns_per_pixel);
        if (count_ > 0 && column != column_) flush();
        if (count_ == 0 && is_lifted_) keep_break(point.t);
        is_lifted_ = false;
        column_ = column;
        watch_crowding(point.pixel);
        if (count_ == 0) first_ = lowest_ = highest_ = {point, 0};
        last_ = {point, count_++};
        if (point.data.y < lowest_.point.data.y) lowest_ = last_;
        if (point.data.y > highest_.point.data.y) highest_ = last_;
    }
    // A break inside a column is invisible, so that very many short phases add no points.
    void lift() override {
        is_lifted_ = true;
        before_.reset();
    }
    PhaseCurve take() override {
        flush();
        close_window();
        course_.is_crowded = crowded_ > 0.3 * windows_;
        return std::move(course_);
    }
    // Covers only rectangles within the column of the last point.
    bool covers(double x_low, double x_high, double y_low, double y_high) const override {
        constexpr double slack = 0.5 * flat;
        return count_ > 0 && std::floor(x_low * columns_per_pixel) == column_ &&
               std::floor(x_high * columns_per_pixel) == column_ &&
               std::min(lowest_.point.pixel.y, highest_.point.pixel.y) - slack <= y_low &&
               std::max(lowest_.point.pixel.y, highest_.point.pixel.y) + slack >= y_high;
    }

 private:
    static constexpr double columns_per_pixel = 4.0;
    struct NumberedPoint {
        PlacedPoint point;
        std::size_t number = 0;
    };
    void flush() {
        if (count_ == 0) return;
        std::array<const NumberedPoint*, 4> kept{&first_, &lowest_, &highest_, &last_};
        std::sort(kept.begin(), kept.end(), [](auto* a, auto* b) { return a->number < b->number; });
        for (std::size_t i = 0; i < kept.size(); ++i)
            if (i == 0 || kept[i]->number != kept[i - 1]->number) keep(kept[i]->point);
        count_ = 0;
    }
    // Detects curves that go up and down several times within the length of a dash.
    void watch_crowding(const Point& pixel) {
        constexpr double window = 8.0;
        if (const double here = std::floor(pixel.x / window); here != window_) {
            close_window();
            window_ = here;
            before_.reset();
        }
        if (before_) way_ += std::abs(pixel.y - before_->y);
        before_ = pixel;
        low_ = std::min(low_, pixel.y), high_ = std::max(high_, pixel.y);
    }
    void close_window() {
        constexpr double ways = 4.0, least = 6.0;
        if (high_ >= low_) windows_ += 1.0;
        if (way_ > ways * std::max(high_ - low_, least)) crowded_ += 1.0;
        way_ = 0.0;
        low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
    }
    double column_ = 0.0;
    std::size_t count_ = 0;  // number of points in the column
    bool is_lifted_ = false;
    NumberedPoint first_, lowest_, highest_, last_;
    std::optional<Point> before_;
    double window_ = -1.0, windows_ = 0.0, crowded_ = 0.0, way_ = 0.0;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

// Thinner for paths in a plane. Once there are more points than most paths need, parts inside cells that the curve has
// already crossed are dropped.
class PathThinner : public Thinner {
 public:
    explicit PathThinner(const Resolution& size)
        : columns_(static_cast<std::size_t>(size.width / cell) + 1),
          rows_(static_cast<std::size_t>(size.height / cell) + 1) {}
    void add(const PlacedPoint& point) override {
        if (!cells_.empty()) return add_if_new(point);
        pixels_.push_back(point.pixel);
        keep(point);
        if (pixels_.size() >= max_path_points) start_covering();
        last_ = point;
    }
    void lift() override {
        if (last_) keep_break(last_->t);
        if (cells_.empty()) pixels_.resize(course_.points.size(), break_of_curve);
        last_.reset();
        is_drawn_ = false;
    }
    PhaseCurve take() override {
        course_.is_crowded = !cells_.empty();
        return std::move(course_);
    }

 private:
    static constexpr double cell = 0.45;  // pixels; its diagonal is 0.64
    static constexpr std::size_t max_path_points = 15000;

    void start_covering() {
        cells_.assign(columns_ * rows_, false);
        for (std::size_t i = 1; i < pixels_.size(); ++i)
            if (is_finite(pixels_[i - 1]) && is_finite(pixels_[i])) cover(pixels_[i - 1], pixels_[i]);
        pixels_ = {};
        is_drawn_ = true;
    }
    // Whether the segment between two points crosses a new cell. Marks all of its cells.
    bool cover(const Point& a, const Point& b) {
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const double longest = 4.0 * static_cast<double>(columns_ + rows_);
        const int parts = 1 + static_cast<int>(std::min(2.0 * length / cell, longest));
        bool is_new = false;
        for (int k = 0; k <= parts; ++k) {
            const double s = static_cast<double>(k) / parts;
            const double x = (a.x + s * (b.x - a.x)) / cell, y = (a.y + s * (b.y - a.y)) / cell;
            if (!(x >= 0.0 && y >= 0.0 && x < static_cast<double>(columns_) && y < static_cast<double>(rows_)))
                continue;
            const std::size_t at = static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x);
            is_new = is_new || !cells_[at];
            cells_[at] = true;
        }
        return is_new;
    }
    void add_if_new(const PlacedPoint& point) {
        const bool is_new =
            !last_ || (is_finite(last_->pixel) && is_finite(point.pixel) && cover(last_->pixel, point.pixel));
        if (is_new && last_) {
            if (!is_drawn_) keep_break(last_->t), keep(*last_);
            keep(point);
        }
        is_drawn_ = is_new && last_.has_value();
        last_ = point;
    }
    std::size_t columns_, rows_;
    std::vector<Point> pixels_;  // of the kept points, while they are few
    std::vector<bool> cells_;    // by row: whether the curve has crossed the cell; empty while points are few
    std::optional<PlacedPoint> last_;
    bool is_drawn_ = false;  // whether the last point is the last one kept
};

// Quantities at an instant.
struct TraceNode {
    double t = 0.0;
    PhaseLook look = PhaseLook::flight;
    std::vector<double> values;  // x, then each y
    std::vector<Point> pixels;   // of each y
};

double distance_to_chord(const Point& p, const Point& a, const Point& b) {
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const double s = square > 0.0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0, 1.0) : 0.0;
    return std::hypot(p.x - a.x - s * x, p.y - a.y - s * y);
}

// Bound on how far a motion along its chord from a to b may overshoot an end where it reverses. It is the lag at the
// fraction `share` of the time behind uniform motion, less the lag that a motion without reversal may have.
double overshoot(const Point& p, const Point& a, const Point& b, double share) {
    constexpr double lag_without_turn = 0.2;  // fraction of the chord; a parabola that reverses at an end has 0.23 or
                                              // more
    const double lag = std::hypot(p.x - a.x - share * (b.x - a.x), p.y - a.y - share * (b.y - a.y));
    return lag - lag_without_turn * std::hypot(b.x - a.x, b.y - a.y);
}

class Tracer {
 public:
    Tracer(const Trajectory& trajectory, const TraceRequest& request, const ReadQuantities& read)
        : request_(request),
          read_(read),
          trajectory_(trajectory),
          model_(*trajectory.model),
          looks_(look_count(model_)),
          sampler_(trajectory),
          levels_(max_halvings + 1) {
        for (std::size_t i = 0; i < looks_ * request.quantities; ++i) {
            if (request.over_time)
                thinners_.push_back(std::make_unique<ColumnThinner>());
            else
                thinners_.push_back(std::make_unique<PathThinner>(request.size));
        }
        constexpr double infinite = std::numeric_limits<double>::infinity();
        result_.ranges.assign(request.quantities + 1, {infinite, -infinite});
        const auto off = [&](std::size_t quantity) {
            if (request.noise.empty()) return flat;
            const PanelMap& map = *request.map;
            const double at = quantity == 0 ? map.x.value(0.0) : map.y.value(0.0), more = 2.0 * request.noise[quantity];
            const double moved = quantity == 0 ? map.x(at + more) : map.y(at + more);
            return std::isfinite(moved) ? std::max(flat, std::abs(moved)) : flat;
        };
        for (std::size_t i = 0; i < request.quantities; ++i)
            tolerances_.push_back(request.over_time ? off(i + 1) : std::max(off(0), off(i + 1)));
    }
    Trace run() {
        if (request_.through.empty())
            walk();
        else
            go_through(request_.through);
        for (const auto& thinner : thinners_) result_.courses.push_back(thinner->take());
        return std::move(result_);
    }

 private:
    static constexpr int max_halvings = 24;
    static constexpr int max_of_step = 200000;  // maximum number of samples in one step

    // Straight through some of the samples, about as many as a plot has columns of pixels.
    void go_through(std::span<const Sample> samples) {
        constexpr std::size_t most = 1000;
        const std::size_t stride = 1 + samples.size() / most, last = samples.size() - 1;
        for (std::size_t i = 0; i <= last; i = i < last ? std::min(i + stride, last) : i + 1) {
            if (samples[i].t < request_.from || samples[i].t > request_.to) continue;
            read_node(samples[i], next_);
            if (is_torn(samples[i].j)) tear();
            take(next_);
        }
    }
    void walk() {
        sampler_.walk(request_.from, request_.to, request_.with_work,
                      [&](const Sample& sample, const DenseSegment* piece) {
                          read_node(sample, next_);
                          if (is_torn(sample.j)) tear();
                          if (piece != nullptr && has_last_)
                              step(*piece);
                          else
                              take(next_);
                          std::swap(last_, next_);
                          has_last_ = true;
                      });
    }
    // Whether the position has jumped since the last sample, which was before event `last_event_`.
    bool is_torn(int j) {
        const int from = std::exchange(last_event_, j);
        if (!model_.has_jumps() || from < 0) return false;
        for (int i = from; i < j; ++i) {
            const Event& event = trajectory_.events[static_cast<std::size_t>(i)];
            if (event.q_before() != event.q) return true;
        }
        return false;
    }
    // A path in a plane ends where the position jumps; over time a jump is a vertical line.
    void tear() {
        for (const auto& thinner : thinners_) thinner->lift();
        if (!request_.over_time) has_taken_ = false;
    }
    void read_node(const Sample& sample, TraceNode& node) {
        node.t = sample.t;
        node.look = look_of(model_, sample.phase, sample.mode);
        node.values.resize(request_.quantities + 1);
        node.pixels.resize(request_.quantities);
        read_(sample, node.values);
        const double x = request_.map->x(node.values[0]);
        include(0, node.values[0], x);
        for (const std::size_t i : request_.shown) {
            node.pixels[i] = {x, request_.map->y(node.values[i + 1])};
            include(i + 1, node.values[i + 1], node.pixels[i].y);
        }
    }
    // Includes a value in the range of a quantity if its axis can show it.
    void include(std::size_t quantity, double value, double pixel) {
        if (!std::isfinite(pixel)) return;
        auto& [low, high] = result_.ranges[quantity];
        low = std::min(low, value), high = std::max(high, value);
    }
    void read_at(const DenseSegment& piece, double t, TraceNode& node) {
        Sample sample = sampler_.in(piece, t, request_.with_work);
        ++samples_of_step_;
        read_node(sample, node);
        node.look = next_.look;
    }

    // Largest deviation of the curves at m from the chord between a and b, relative to the tolerance.
    double deviation(const TraceNode& a, const TraceNode& m, const TraceNode& b) const {
        double most = 0.0;
        for (const std::size_t i : request_.shown) {
            const Point p = visible(a.pixels[i]), q = visible(m.pixels[i]), r = visible(b.pixels[i]);
            const int finite = int{is_finite(p)} + int{is_finite(q)} + int{is_finite(r)};
            if (finite == 0) continue;
            if (finite < 3) return std::numeric_limits<double>::infinity();
            double off = 0.0;
            if (request_.over_time) {
                const double s = r.x > p.x ? (q.x - p.x) / (r.x - p.x) : 0.5;
                off = std::abs(q.y - p.y - s * (r.y - p.y));
            } else {
                off = std::max(distance_to_chord(q, p, r), overshoot(q, p, r, (m.t - a.t) / (b.t - a.t)));
            }
            most = std::max(most, off / tolerances_[i]);
        }
        return most;
    }
    // Clamps points far outside the picture, where nothing is visible.
    Point visible(const Point& p) const {
        const Resolution& size = request_.size;
        if (!is_finite(p)) return p;
        return {std::clamp(p.x, -size.width, 2.0 * size.width), std::clamp(p.y, -size.height, 2.0 * size.height)};
    }

    // Traces from the last node to the next one inside a step. Two interior instants at uneven spacing distinguish a
    // periodic motion from rest.
    void step(const DenseSegment& piece) {
        const double a = last_.t, b = next_.t;
        samples_of_step_ = 0;
        if (!(b > a)) return take(next_);
        constexpr double first = 0.37, second = 0.69;
        read_at(piece, a + first * (b - a), third_[0]);
        read_at(piece, a + second * (b - a), third_[1]);
        const double off = std::max(deviation(last_, third_[0], next_), deviation(last_, third_[1], next_));
        constexpr double straight = 0.25, beyond = 0.25;  // fractions of the deviation by which a curve may exceed
                                                          // these four points
        if (off <= straight) return take(next_);
        if (is_covered({&last_, &third_[0], &third_[1], &next_}, beyond * off)) return take(next_);
        refine(piece, last_, third_[0], off, 0);
        refine(piece, third_[0], third_[1], off, 0);
        refine(piece, third_[1], next_, off, 0);
    }
    // Whether all of these nodes, extended by `beyond` (relative to the tolerance), lie in a column whose range the
    // curves have covered already.
    bool is_covered(std::initializer_list<const TraceNode*> nodes, double beyond) const {
        return std::all_of(request_.shown.begin(), request_.shown.end(), [&](std::size_t i) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const TraceNode* node : nodes) {
                if (!is_finite(node->pixels[i])) return false;
                low = std::min(low, node->pixels[i].y), high = std::max(high, node->pixels[i].y);
            }
            const double more = beyond * tolerances_[i];
            return thinner(i, next_.look)
                .covers((*nodes.begin())->pixels[i].x, (*std::prev(nodes.end()))->pixels[i].x, low - more, high + more);
        });
    }
    // Adds the points between a and b, including b but not a. For a smooth curve, halving reduces the deviation to a
    // quarter. If the deviation was small before as well, both halves are accurate enough.
    void refine(const DenseSegment& piece, const TraceNode& a, const TraceNode& b, double before, int halvings) {
        const double t = 0.5 * (a.t + b.t);
        if (samples_of_step_ > max_of_step) return leave_out(b);
        if (halvings >= max_halvings || !(t > a.t && t < b.t)) return take(b);
        TraceNode& middle = levels_[static_cast<std::size_t>(halvings)];
        read_at(piece, t, middle);
        const double off = deviation(a, middle, b);
        constexpr double near = 4.0, smooth = 16.0;
        if (off <= near && before <= smooth * near) {
            if (off > 0.5) take(middle);
            return take(b);
        }
        constexpr double beyond = 0.5;
        if (is_covered({&a, &middle, &b}, beyond * off)) return take(b);
        constexpr int most_to_an_edge = 12;  // halvings up to the boundary of a quantity's domain
        if (!std::isfinite(off) && halvings >= most_to_an_edge) return take(middle), take(b);
        refine(piece, a, middle, off, halvings + 1);
        refine(piece, middle, b, off, halvings + 1);
    }

    Thinner& thinner(std::size_t quantity, PhaseLook look) const {
        return *thinners_[looks_ * quantity + static_cast<std::size_t>(look)];
    }
    // Interrupts the curves: a break is correct, but a chord across many reversals is not.
    void leave_out(const TraceNode& node) {
        for (const std::size_t i : request_.shown) thinner(i, node.look).lift();
        take(node);
    }
    // Adds a node. Where the phase changes, one curve ends and the other starts at the same point.
    void take(const TraceNode& node) {
        const bool changed = !has_taken_ || taken_.look != node.look;
        for (const std::size_t i : request_.shown) {
            Thinner& curve = thinner(i, node.look);
            if (changed) curve.lift();
            if (changed && has_taken_) put(curve, taken_, i);
            put(curve, node, i);
        }
        taken_ = node;
        has_taken_ = true;
    }
    static void put(Thinner& curve, const TraceNode& node, std::size_t i) {
        const PlacedPoint point{{node.values[0], node.values[i + 1]}, node.pixels[i], node.t};
        if (is_finite(point.data) && is_finite(point.pixel))
            curve.add(point);
        else
            curve.lift();
    }

    const TraceRequest& request_;
    const ReadQuantities& read_;
    const Trajectory& trajectory_;
    int last_event_ = -1;
    const Model& model_;
    std::size_t looks_;
    Sampler sampler_;
    std::vector<std::unique_ptr<Thinner>> thinners_;
    std::vector<double> tolerances_;  // pixels, of each y
    Trace result_;
    TraceNode last_, next_, taken_;
    std::array<TraceNode, 2> third_;
    std::vector<TraceNode> levels_;
    bool has_last_ = false, has_taken_ = false;
    int samples_of_step_ = 0;
};

}  // namespace

Trace trace(const Trajectory& trajectory, const TraceRequest& request, const ReadQuantities& read) {
    return Tracer(trajectory, request, read).run();
}

// ---- curves that retrace themselves ----

namespace {

constexpr double cell_size = 0.35;  // pixels

// The curve drawn so far on a grid of cells: arc length and direction at its first visit to each cell.
class Traces {
 public:
    struct Visit {
        double length;  // arc length of the curve up to here, in cells
        Point direction, at;
    };
    // Whether the curve was near `at` clearly earlier, in the same or the opposite direction.
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
    bool is_broken = true;  // whether the last point kept is not connected to the next
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
        // Steps are shorter than a cell. More steps than this maximum cross no panel.
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
        // Keep the new parts of the chord. A long jump may retrace an earlier line over a part of its length.
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
