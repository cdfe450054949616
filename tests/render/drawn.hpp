// Distance between the curves of a figure and the run that they show, in pixels of the figure.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "figure/layout.hpp"
#include "figure/publication.hpp"
#include "simulate/simulate.hpp"

namespace achilles::drawn {

struct Size {
    int width = 600, height = 400;
};

inline bool is_there(const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// A figure of one view, and its plot area.
struct Picture {
    Picture(const Trajectory& run, const ViewDescription& view, Size size = {}) : prepared(*run.model, view) {
        PublicationStyle style;
        style.shape = double{1} * size.width / size.height;
        style.size = {double{1} * size.width, double{1} * size.height};
        figure = publication(run, {&view, 1}, style);
        const auto measure = [](const std::string& label, float text) {
            return 0.5F * text * static_cast<float>(label.size());
        };
        plot = plot_areas(figure, measure, {0, 0, static_cast<float>(size.width), static_cast<float>(size.height)}, 1.0)
                   .at(0)
                   .plot;
    }
    const Panel& panel() const { return figure.panels[0]; }
    PanelMap map() const { return {panel(), plot}; }
    PreparedView prepared;
    Figure figure;
    Rectangle plot;
};

// Quantities of a run at instants inside its steps, in pixels of a picture.
class Truth {
 public:
    Truth(const Trajectory& run, const Picture& picture)
        : run_(run),
          sampler_(run),
          values_(picture.prepared, run),
          map_(picture.map()),
          with_work_(values_.reads(run.model->layout().work())) {}
    Point at(const DenseSegment& piece, double t, std::size_t quantity) {
        values_.set(sampler_.in(piece, t, with_work_));
        return map_({values_[0], values_[quantity + 1]});
    }
    Point before(const Event& event, std::size_t quantity) {
        Sample sample = sample_at(run_, event);
        sample.state.v = event.v_before;
        sample.mode = mode_before(run_, static_cast<std::size_t>(&event - run_.events.data()));
        sample.contact = !sample.mode.is_free();
        sample.load_bearing = load_bearing_contacts(run_, sample.mode, event.t);
        values_.set(sample);
        return map_({values_[0], values_[quantity + 1]});
    }
    // An impact at which a collapse is cut goes on from its restart.
    Point after(const Event& event, std::size_t quantity) {
        Sample sample = sample_at(run_, event);
        const auto next = static_cast<std::size_t>(&event - run_.events.data()) + 1;
        if (event.is_impact() && next < run_.events.size() && run_.events[next].is_collapse()) {
            const auto& cut = run_.events[next].truncation;
            if (cut && cut->t == event.t) sample.state.v = cut->v;
        }
        values_.set(sample);
        return map_({values_[0], values_[quantity + 1]});
    }

 private:
    const Trajectory& run_;
    Sampler sampler_;
    Values values_;
    PanelMap map_;
    bool with_work_;
};

// Range of a curve in each column of pixels: its lowest and highest point.
class Columns {
 public:
    Columns(const Rectangle& plot, double margin)
        : left_(plot.x), margin_(margin), low_(count(plot), infinite), high_(low_.size(), -infinite) {}
    void add(const Point& a, const Point& b) {
        const double from = std::min(a.x, b.x), to = std::max(a.x, b.x);
        const auto last = static_cast<int>(low_.size()) - 1;
        const int first = std::max(0, static_cast<int>(std::floor(from - left_ - margin_)));
        for (int c = first; c <= std::min(last, static_cast<int>(std::floor(to - left_ + margin_))); ++c) {
            const double west = left_ + c - margin_, east = left_ + c + 1 + margin_;
            for (const double x : {std::clamp(west, from, to), std::clamp(east, from, to)}) {
                if (x < west || x > east) continue;
                const bool is_upright = !(to > from);
                for (const double y : {is_upright ? a.y : a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x),
                                       is_upright ? b.y : a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x)}) {
                    low_[static_cast<std::size_t>(c)] = std::min(low_[static_cast<std::size_t>(c)], y);
                    high_[static_cast<std::size_t>(c)] = std::max(high_[static_cast<std::size_t>(c)], y);
                }
            }
        }
    }
    std::size_t size() const { return low_.size(); }
    bool is_empty(std::size_t c) const { return low_[c] > high_[c]; }
    double low(std::size_t c) const { return low_[c]; }
    double high(std::size_t c) const { return high_[c]; }

 private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    static std::size_t count(const Rectangle& plot) { return static_cast<std::size_t>(std::max(plot.width, 1.0F)); }
    double left_, margin_;
    std::vector<double> low_, high_;
};

// The curves of a quantity, one for each look of a phase.
inline std::span<const Curve> curves_of(const Panel& panel, std::size_t quantity) {
    return std::span(panel.curves).subspan(panel.courses * quantity, panel.courses);
}

// Maximum over all quantities and columns of pixels of the difference, in pixels, between the drawn extremes and those
// of the run. The run is sampled at 50 instants per column, at the ends of its steps and at its events. A curve may
// cross the edge of a column by a quarter of a pixel.
inline double worst_over_time(const Trajectory& run, const Picture& picture) {
    constexpr double edge = 0.25;
    constexpr int samples = 50;
    const Panel& panel = picture.panel();
    const PanelMap map = picture.map();
    Truth truth(run, picture);
    double worst = 0.0;
    for (std::size_t i = 0; panel.courses * i < panel.curves.size(); ++i) {
        Columns drawn(picture.plot, 0.0), drawn_wide(picture.plot, edge), real(picture.plot, 0.0),
            real_wide(picture.plot, edge);
        std::vector<double> corners;
        for (const Curve& curve : curves_of(panel, i))
            for (std::size_t k = 0; k < curve.points.size(); ++k) {
                const Point p = map(curve.points[k]);
                if (!is_there(p)) continue;
                corners.push_back(curve.points[k].x);
                const Point before = k > 0 ? map(curve.points[k - 1]) : p;
                for (Columns* columns : {&drawn, &drawn_wide}) columns->add(is_there(before) ? before : p, p);
            }
        std::sort(corners.begin(), corners.end());
        const auto add = [&](const Point& p) {
            if (is_there(p)) real.add(p, p), real_wide.add(p, p);
        };
        const double step = (panel.x.high - panel.x.low) / (samples * static_cast<double>(drawn.size()));
        for (const DenseSegment& piece : run.pieces) {
            for (double t = panel.x.low + step * std::ceil((piece.start - panel.x.low) / step); t <= piece.end;
                 t += step)
                add(truth.at(piece, t, i));
            // A quantity may jump between two steps: both values belong to the run.
            for (const double t : {piece.start, piece.end}) add(truth.at(piece, t, i));
            // The true values are also known at the points of the drawn curve.
            auto corner = std::lower_bound(corners.begin(), corners.end(), piece.start);
            for (; corner != corners.end() && *corner <= piece.end; ++corner) {
                const Point p = truth.at(piece, *corner, i);
                if (is_there(p)) real_wide.add(p, p);
            }
        }
        for (const Event& event : run.events)
            if (event.kind == Event::Kind::impact) {
                const Point a = truth.before(event, i), b = truth.after(event, i);
                add(a), add(b);
                if (is_there(a) && is_there(b)) real_wide.add(a, b);
            }
        for (std::size_t c = 0; c < drawn.size(); ++c) {
            if (!real.is_empty(c)) {
                worst = std::max({worst, drawn_wide.low(c) - real.low(c), real.high(c) - drawn_wide.high(c)});
            }
            if (!drawn.is_empty(c) && !real_wide.is_empty(c))
                worst = std::max({worst, real_wide.low(c) - drawn.low(c), drawn.high(c) - real_wide.high(c)});
        }
    }
    return worst;
}

// Segments in buckets, to find the distance of a point from the nearest one.
class Segments {
 public:
    Segments(const Rectangle& plot, double reach)
        : plot_(plot),
          reach_(reach),
          columns_(static_cast<std::size_t>(plot.width / side) + 3),
          rows_(static_cast<std::size_t>(plot.height / side) + 3),
          buckets_(columns_ * rows_) {}
    void add(const Point& a, const Point& b) {
        const double length = std::min(std::hypot(b.x - a.x, b.y - a.y), 1e5);
        const int parts = 1 + static_cast<int>(length / side);
        for (int k = 0; k < parts; ++k) {
            const auto at = [&](int n) {
                const double s = static_cast<double>(n) / parts;
                return Point{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
            };
            const Point p = at(k), q = at(k + 1);
            if (std::vector<std::array<Point, 2>>* here = bucket(p)) {
                // Of very many coincident segments a few are sufficient.
                const auto is_same = [&](const std::array<Point, 2>& other) {
                    constexpr double same = 0.02;
                    return std::hypot(other[0].x - p.x, other[0].y - p.y) +
                               std::hypot(other[1].x - q.x, other[1].y - q.y) <
                           same;
                };
                if (std::none_of(here->begin(), here->end(), is_same)) here->push_back({p, q});
            }
        }
    }
    // At most the reach.
    double distance(const Point& p) const {
        double least = reach_;
        const auto column = static_cast<long>(std::floor((p.x - plot_.x) / side)) + 1,
                   row = static_cast<long>(std::floor((p.y - plot_.y) / side)) + 1;
        for (long i = column - 1; i <= column + 1; ++i)
            for (long j = row - 1; j <= row + 1; ++j) {
                if (i < 0 || j < 0 || i >= static_cast<long>(columns_) || j >= static_cast<long>(rows_)) continue;
                for (const auto& [a, b] :
                     buckets_[static_cast<std::size_t>(j) * columns_ + static_cast<std::size_t>(i)]) {
                    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
                    const double s =
                        square > 0.0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0, 1.0) : 0.0;
                    least = std::min(least, std::hypot(p.x - a.x - s * x, p.y - a.y - s * y));
                }
            }
        return least;
    }
    bool is_inside(const Point& p) const {
        return p.x >= plot_.x && p.x <= plot_.x + plot_.width && p.y >= plot_.y && p.y <= plot_.y + plot_.height;
    }

 private:
    static constexpr double side = 3.0;
    std::vector<std::array<Point, 2>>* bucket(const Point& p) {
        const double column = std::floor((p.x - plot_.x) / side) + 1.0, row = std::floor((p.y - plot_.y) / side) + 1.0;
        if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns_) &&
              row < static_cast<double>(rows_)))
            return nullptr;
        return &buckets_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
    }
    Rectangle plot_;
    double reach_;
    std::size_t columns_, rows_;
    std::vector<std::vector<std::array<Point, 2>>> buckets_;
};

// Hausdorff distance between the drawn path in a plane and the run, in pixels, at most 3. `of_step`: number of instants
// in each step.
inline double worst_in_plane(const Trajectory& run, const Picture& picture, int of_step = 48) {
    const Panel& panel = picture.panel();
    const PanelMap map = picture.map();
    Truth truth(run, picture);
    constexpr double reach = 3.0;
    double worst = 0.0;
    for (std::size_t i = 0; panel.courses * i < panel.curves.size(); ++i) {
        Segments drawn(picture.plot, reach), real(picture.plot, reach);
        std::vector<Point> of_drawn, of_real;
        const auto add = [](Segments& segments, std::vector<Point>& points, const Point& a, const Point& b) {
            segments.add(a, b);
            points.push_back(b);
            points.push_back({0.5 * (a.x + b.x), 0.5 * (a.y + b.y)});
        };
        for (const Curve& curve : curves_of(panel, i))
            for (std::size_t k = 1; k < curve.points.size(); ++k) {
                const Point a = map(curve.points[k - 1]), b = map(curve.points[k]);
                if (is_there(a) && is_there(b)) add(drawn, of_drawn, a, b);
            }
        for (const DenseSegment& piece : run.pieces) {
            Point before = truth.at(piece, piece.start, i);
            for (int k = 1; k <= of_step; ++k) {
                const Point p = truth.at(piece, piece.start + (piece.end - piece.start) * k / of_step, i);
                if (is_there(before) && is_there(p)) add(real, of_real, before, p);
                before = p;
            }
        }
        for (const Event& event : run.events) {
            if (event.is_jump()) continue;  // the path ends there, and goes on elsewhere
            const Point a = truth.before(event, i), b = truth.after(event, i);
            if (is_there(a) && is_there(b)) add(real, of_real, a, b);
        }
        for (const Point& p : of_real)
            if (real.is_inside(p)) worst = std::max(worst, drawn.distance(p));
        for (const Point& p : of_drawn)
            if (drawn.is_inside(p)) worst = std::max(worst, real.distance(p));
    }
    return worst;
}

// Whether no point of a curve lies in the plot.
inline bool is_empty(const Picture& picture) {
    const PanelMap map = picture.map();
    const Rectangle& plot = picture.plot;
    for (const Curve& curve : picture.panel().curves)
        for (const Point& point : curve.points) {
            const Point p = map(point);
            if (p.x >= plot.x && p.x <= plot.x + plot.width && p.y >= plot.y && p.y <= plot.y + plot.height)
                return false;
        }
    return true;
}

// A run of a system of the gallery with random initial rates and an end time between 1 s and `longest`, and one of its
// views.
struct RandomRun {
    std::size_t draw = 0;  // number of draws before it
    std::string about;
    Trajectory trajectory;
    ViewDescription view;
};
class RandomRuns {
 public:
    // Skips the first `skipped` draws.
    RandomRuns(unsigned seed, double longest, std::size_t skipped = 0)
        : random_(seed), longest_(longest), names_(test::all_systems()), draw_(skipped) {
        random_.discard(numbers_per_draw * skipped);
    }
    RandomRun next() {
        for (;; ++draw_) {
            const std::string& name = names_[static_cast<std::size_t>(uniform() * static_cast<double>(names_.size()))];
            const auto model = test::load(name);
            Run run = model->default_run();
            const double change = uniform() - 0.5;
            for (Eigen::Index i = 0; i < run.v.size(); ++i) run.v[i] *= 1.0 + change;
            run.options.end_time = std::pow(longest_, uniform());
            const std::vector<ViewDescription> views = views_of(*model);
            const ViewDescription view = views[static_cast<std::size_t>(uniform() * static_cast<double>(views.size()))];
            try {
                RandomRun made{draw_,
                               fmt::format("{} to {:.6g} s, rates {:+.6g}, {} | ", name, run.options.end_time, change,
                                           view.x.text),
                               simulate(model, run), view};
                for (const Text& y : view.y) made.about += y.text + " ";
                if (made.trajectory.pieces.empty()) continue;
                ++draw_;
                return made;
            } catch (const InputError&) {  // not a valid initial state of the system
            }
        }
    }

 private:
    static constexpr std::size_t numbers_per_draw = 4;  // system, rates, end, view
    double uniform() { return static_cast<double>(random_()) / 4294967296.0; }
    static std::vector<ViewDescription> views_of(const Model& model) {
        std::vector<ViewDescription> views = model.description().views;
        const auto& coordinates = model.description().coordinates;
        const auto add = [&](const std::string& x, const std::string& y) {
            ViewDescription& view = views.emplace_back();
            view.x.text = x;
            view.y.push_back({y, {}});
        };
        add(coordinates.front().name, coordinates.back().name + "'");
        add("t", coordinates.back().name + "'");
        return views;
    }
    std::mt19937 random_;
    double longest_;
    std::vector<std::string> names_;
    std::size_t draw_;
};

// Error over time or in the plane, depending on the view.
inline double worst(const Trajectory& run, const Picture& picture) {
    return picture.prepared.quantities()[0].is_time ? worst_over_time(run, picture) : worst_in_plane(run, picture);
}

}  // namespace achilles::drawn
