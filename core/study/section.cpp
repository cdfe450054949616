#include "study/section.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

namespace achilles {

namespace {

Event::Kind kind_of(Section::Kind kind) {
    return kind == Section::Kind::impact ? Event::Kind::impact
           : kind == Section::Kind::zeno ? Event::Kind::zeno
                                         : Event::Kind::release;
}

bool is_asked(const Section& section, double t) { return !section.after || t >= *section.after; }

// The function along a run, looked at often enough.
class Along {
 public:
    Along(const Trajectory& trajectory, const std::function<double(const Sample&)>& value, bool asks_for_work,
          double from)
        : trajectory_(trajectory), sampler_(trajectory), value_(value), asks_for_work_(asks_for_work), from_(from) {}

    struct Point {
        double t, value;
        std::size_t piece;
    };

    std::vector<Point> points() {
        constexpr int parts = 8;
        for (std::size_t i = 0; i < trajectory_.pieces.size(); ++i) {
            const Piece& piece = trajectory_.pieces[i];
            if (!(piece.end > piece.start) || piece.end < from_) continue;
            Point before = add(i, piece.start);
            for (int part = 1; part <= parts; ++part) {
                const double t = part == parts ? piece.end : piece.start + (piece.end - piece.start) * part / parts;
                const Point after = at(i, t);
                look_between(before, after, deepest);
                points_.push_back(before = after);
            }
        }
        return std::move(points_);
    }

    Point at(std::size_t piece, double t) {
        return {t, value_(sampler_.in(trajectory_.pieces[piece], t, asks_for_work_)), piece};
    }
    Sample sample(std::size_t piece, double t) { return sampler_.in(trajectory_.pieces[piece], t); }

 private:
    static constexpr int deepest = 6;

    Point add(std::size_t piece, double t) { return points_.emplace_back(at(piece, t)); }

    // Two of one sign, between which the function may have come to zero: what it bends by is no less than what is left.
    void look_between(const Point& a, const Point& b, int depth) {
        if (depth == 0 || !((a.value < 0.0) == (b.value < 0.0))) return;
        const double t = 0.5 * (a.t + b.t);
        if (!(t > a.t && t < b.t)) return;
        const Point middle = at(a.piece, t);
        const double bend = std::abs(middle.value - 0.5 * (a.value + b.value));
        if (!(2.0 * bend >= std::min(std::abs(a.value), std::abs(b.value)))) return;
        look_between(a, middle, depth - 1);
        points_.push_back(middle);
        look_between(middle, b, depth - 1);
    }

    const Trajectory& trajectory_;
    Sampler sampler_;
    const std::function<double(const Sample&)>& value_;
    bool asks_for_work_;
    double from_;  // s: steps that end before it are not looked at
    std::vector<Point> points_;
};

std::size_t events_until(const Trajectory& trajectory, double t) {
    const auto later = [](double time, const Event& event) { return time < event.t; };
    return static_cast<std::size_t>(std::upper_bound(trajectory.events.begin(), trajectory.events.end(), t, later) -
                                    trajectory.events.begin());
}

// Between a value below zero and one above it, inside one piece.
double zero_between(Along& along, const Along::Point& below, const Along::Point& above) {
    const auto near = [](double a, double b) { return std::abs(b - a) <= 1e-13 * (1.0 + std::abs(a)); };
    std::uintmax_t most = 100;
    const auto value = [&](double t) { return along.at(above.piece, t).value; };
    const auto [low, high] =
        boost::math::tools::toms748_solve(value, below.t, above.t, below.value, above.value, near, most);
    return 0.5 * (low + high);
}

}  // namespace

std::vector<Moment> events_of(const Trajectory& trajectory, const Section& section) {
    std::vector<Moment> moments;
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (event.kind != kind_of(section.kind) || !is_asked(section, event.t)) continue;
        Moment moment;
        moment.events = i + 1;
        moment.contacts = event.contacts;
        Sample& sample = moment.sample;
        sample.t = event.t;
        sample.j = static_cast<int>(i + 1);
        sample.held = event.held;
        sample.contact = !event.held.empty();
        sample.phase = sample.contact ? Phase::Kind::constrained : Phase::Kind::hybrid;
        sample.carriers = carriers_of(trajectory, event.held, event.t);
        sample.state = {event.q, event.v_after, event.t};
        sample.work = event.work;
        sample.loss = event.loss;
        moments.push_back(std::move(moment));
    }
    return moments;
}

std::vector<Moment> zeros_of(const Trajectory& trajectory, const Section& section,
                             const std::function<double(const Sample&)>& value, bool asks_for_work) {
    Along along(trajectory, value, asks_for_work, section.after.value_or(trajectory.run.options.start_time));
    const std::vector<Along::Point> points = along.points();
    double largest = 0.0;
    for (const Along::Point& point : points)
        if (std::isfinite(point.value)) largest = std::max(largest, std::abs(point.value));
    const double rounding = 1e-13 * largest;
    std::vector<Moment> moments;
    const Along::Point* below = nullptr;  // the last one below zero, where none was above since
    for (const Along::Point& point : points) {
        const bool jumped = &point != points.data() && point.piece != (&point)[-1].piece &&
                            std::abs(point.value - (&point)[-1].value) > 100.0 * rounding;
        if (jumped || !std::isfinite(point.value)) below = nullptr;
        if (point.value < -rounding) below = &point;
        if (!(point.value > rounding) || below == nullptr) continue;
        // Where they are of two pieces, the piece of the latter begins with zero to rounding.
        const double t =
            below->piece == point.piece ? zero_between(along, *below, point) : trajectory.pieces[point.piece].start;
        below = nullptr;
        if (!is_asked(section, t)) continue;
        Moment moment;
        moment.sample = along.sample(point.piece, t);
        moment.events = events_until(trajectory, t);
        moments.push_back(std::move(moment));
    }
    return moments;
}

}  // namespace achilles
