#include "analysis/section.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "number/float_environment.hpp"

namespace achilles {

std::optional<PathBounds> PathBounds::of(const Model& model, const Program& section,
                                         std::span<const double> parameters) {
    const Layout& layout = model.layout();
    const std::vector<bool> inputs = section.inputs_of(1);
    bool is_known = !inputs[layout.work()] && (layout.frictions == 0 || !inputs[layout.heat()]);
    for (std::size_t k = 0; k < layout.frictions; ++k) is_known = is_known && !inputs[layout.friction_force(k)];
    for (std::size_t i = 0; i < layout.contacts; ++i)
        is_known = is_known && !inputs[layout.acceleration(i)] && !inputs[layout.force(i)];
    if (!is_known) return std::nullopt;
    return PathBounds(model, section, parameters);
}

PathBounds::PathBounds(const Model& model, const Program& section, std::span<const double> parameters)
    : layout_(model.layout()),
      variables_(2 * layout_.dof),
      section_(model.evaluator<Interval>(section, parameters)),
      rates_(variables_) {}

Interval PathBounds::value(const Trajectory& trajectory, const DenseSegment& piece, double from, double to) {
    const Interval start(piece.start), length = Interval(piece.end) - start;
    const Interval theta = (Interval(from, to) - start) / length;
    const double* const coefficients = trajectory.coefficients.data() + piece.first;
    for (std::size_t i = 0; i < variables_; ++i) {
        Interval sum(0.0), slope(0.0);  // by theta
        for (std::size_t k = piece.degree + 1; k-- > 0;) {
            const Interval c(coefficients[variables_ * k + i]);
            if (k > 0) slope = slope * theta + Interval(static_cast<double>(k)) * c;
            sum = sum * theta + c;
        }
        section_.input(i) = sum;
        rates_[i] = slope / length;
    }
    section_.clock() = Interval(from, to);
    section_.input(layout_.contact()) = Interval(piece.mode.is_free() ? 0.0 : 1.0);
    section_.input(layout_.loss()) = Interval(piece.loss);
    section_.run();
    return section_.output(0);
}

Interval PathBounds::rate() {
    Interval sum = section_.output(1);
    for (std::size_t i = 0; i < variables_; ++i) sum = sum + section_.output(2 + i) * rates_[i];
    return sum;
}

namespace {

bool is_after_start(const Section& section, double t) { return !section.after || t >= *section.after; }

// Evaluates the function along a run at sufficiently many points.
class SectionSampler {
 public:
    SectionSampler(const Trajectory& trajectory, const SectionFunction& function, double from)
        : trajectory_(trajectory), sampler_(trajectory), function_(function) {
        for (std::size_t i = 0; i < trajectory.pieces.size(); ++i)
            if (trajectory.pieces[i].end > std::max(trajectory.pieces[i].start, from)) pieces_.push_back(i);
    }

    struct SampledPoint {
        double t, value;
        std::size_t piece;
    };

    std::vector<SampledPoint> points() {
        std::vector<SampledPoint> ends;
        for (const std::size_t i : pieces_)
            for (const double t : {trajectory_.pieces[i].start, trajectory_.pieces[i].end}) ends.push_back(at(i, t));
        for (const SampledPoint& end : ends)
            if (std::isfinite(end.value)) rounding_ = std::max(rounding_, relative_rounding * std::abs(end.value));
        if (is_zero_everywhere(ends)) return {};
        left_ = max_evaluations + evaluations_per_piece * pieces_.size();
        for (std::size_t i = 0; i < ends.size(); i += 2) {
            points_.push_back(ends[i]);
            search_between(ends[i], ends[i + 1]);
            points_.push_back(ends[i + 1]);
        }
        return std::move(points_);
    }
    // Rounding level of a value that is zero.
    double rounding() const { return rounding_; }

    SampledPoint at(std::size_t piece, double t) {
        return {t, function_.value(sampler_.in(trajectory_.pieces[piece], t, function_.asks_for_work)), piece};
    }
    Sample sample(std::size_t piece, double t) { return sampler_.in(trajectory_.pieces[piece], t); }

 private:
    static constexpr double relative_rounding = 1e-13;
    static constexpr int deepest = 40, deepest_by_bend = 6;
    static constexpr std::size_t max_evaluations = std::size_t{1} << 18, evaluations_per_piece = 32;

    // Whether all values are zero within rounding, also inside the steps, because steps may all end at zeros.
    bool is_zero_everywhere(const std::vector<SampledPoint>& ends) {
        if (function_.bounds == nullptr) return false;
        constexpr double share = 0.382;
        const auto rounds_to = [&](const SampledPoint& point) {
            const DenseSegment& piece = trajectory_.pieces[point.piece];
            return std::abs(point.value) <= 4.0 * rad(function_.bounds->value(trajectory_, piece, point.t, point.t));
        };
        const auto is_zero_in = [&](std::size_t i) {
            const DenseSegment& piece = trajectory_.pieces[i];
            return rounds_to(at(i, piece.start + share * (piece.end - piece.start)));
        };
        return std::all_of(ends.begin(), ends.end(), rounds_to) &&
               std::all_of(pieces_.begin(), pieces_.end(), is_zero_in);
    }

    void search_between(const SampledPoint& a, const SampledPoint& b) {
        if (function_.bounds != nullptr) return divide(a, b, deepest);
        constexpr int parts = 8;
        SampledPoint before = a;
        for (int part = 1; part <= parts; ++part) {
            const SampledPoint after = part == parts ? b : at(a.piece, a.t + (b.t - a.t) * part / parts);
            divide_where_it_bends(before, after, deepest_by_bend);
            if (part < parts) points_.push_back(after);
            before = after;
        }
    }

    // Bisects until the bounds exclude a zero between two points, or allow at most one, which then shows in the signs.
    void divide(const SampledPoint& a, const SampledPoint& b, int depth) {
        if (left_ == 0) return divide_where_it_bends(a, b, std::min(depth, deepest_by_bend));
        --left_;
        const double t = 0.5 * (a.t + b.t);
        if (depth == 0 || !(t > a.t && t < b.t)) return;
        const Interval value = function_.bounds->value(trajectory_, trajectory_.pieces[a.piece], a.t, b.t);
        if (mig(value) > 0.0 || mag(value) <= rounding_) return;
        if (value.is_defined() && mig(function_.bounds->rate()) > 0.0) return;
        const SampledPoint middle = at(a.piece, t);
        divide(a, middle, depth - 1);
        points_.push_back(middle);
        divide(middle, b, depth - 1);
    }

    // Bisects between two points of equal sign if the curvature of the function is large enough for a zero between
    // them.
    void divide_where_it_bends(const SampledPoint& a, const SampledPoint& b, int depth) {
        if (depth == 0 || !((a.value < 0.0) == (b.value < 0.0))) return;
        const double t = 0.5 * (a.t + b.t);
        if (!(t > a.t && t < b.t)) return;
        const SampledPoint middle = at(a.piece, t);
        const double bend = std::abs(middle.value - 0.5 * (a.value + b.value));
        if (!(2.0 * bend >= std::min(std::abs(a.value), std::abs(b.value)))) return;
        divide_where_it_bends(a, middle, depth - 1);
        points_.push_back(middle);
        divide_where_it_bends(middle, b, depth - 1);
    }

    const Trajectory& trajectory_;
    Sampler sampler_;
    const SectionFunction& function_;
    std::vector<std::size_t> pieces_;  // indices of the steps to examine
    std::vector<SampledPoint> points_;
    double rounding_ = 0.0;
    std::size_t left_ = 0;  // remaining number of bound evaluations
};

std::size_t events_until(const Trajectory& trajectory, double t) {
    const auto later = [](double time, const Event& event) { return time < event.t; };
    return static_cast<std::size_t>(std::upper_bound(trajectory.events.begin(), trajectory.events.end(), t, later) -
                                    trajectory.events.begin());
}

// The zero between a negative and a positive value in one step. Returns nullopt for a jump or a pole, where the value
// next to it stays large.
std::optional<double> zero_between(SectionSampler& along, const SectionSampler::SampledPoint& below,
                                   const SectionSampler::SampledPoint& above) {
    const auto near = [](double a, double b) { return std::abs(b - a) <= 1e-13 * (1.0 + std::abs(a)); };
    std::uintmax_t most = 100;
    const auto value = [&](double t) { return along.at(above.piece, t).value; };
    const auto [low, high] =
        boost::math::tools::toms748_solve(value, below.t, above.t, below.value, above.value, near, most);
    const double beside = std::max(std::abs(value(low)), std::abs(value(high)));
    if (!(beside <= 0.5 * std::max(-below.value, above.value))) return std::nullopt;
    return 0.5 * (low + high);
}

}  // namespace

std::vector<SectionPoint> events_of(const Trajectory& trajectory, const Section& section) {
    std::vector<SectionPoint> moments;
    for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
        const Event& event = trajectory.events[i];
        if (section.event != event.kind || !is_after_start(section, event.t)) continue;
        SectionPoint moment;
        moment.events = i + 1;
        moment.contacts = event.contacts;
        Sample& sample = moment.sample;
        sample.t = event.t;
        sample.j = static_cast<int>(i + 1);
        sample.mode = event.mode;
        sample.contact = !event.mode.is_free();
        sample.phase = sample.contact ? Phase::Kind::constrained : Phase::Kind::hybrid;
        sample.load_bearing = load_bearing_contacts(trajectory, event.mode, event.t);
        sample.state = {event.q, event.v_after, event.t};
        sample.work = event.work;
        sample.loss = event.loss;
        sample.heat = event.heat;
        moments.push_back(std::move(moment));
    }
    return moments;
}

std::vector<SectionPoint> zeros_of(const Trajectory& trajectory, const Section& section,
                                   const SectionFunction& function) {
    const FloatEnvironmentGuard ground;  // for the bounds
    SectionSampler along(trajectory, function, section.after.value_or(trajectory.run.options.start_time));
    const std::vector<SectionSampler::SampledPoint> points = along.points();
    const double rounding = along.rounding();
    std::vector<SectionPoint> moments;
    const SectionSampler::SampledPoint* below = nullptr;  // the last negative point with no positive one after it
    for (const SectionSampler::SampledPoint& point : points) {
        const bool jumped = &point != points.data() && point.piece != (&point)[-1].piece &&
                            std::abs(point.value - (&point)[-1].value) > 100.0 * rounding;
        if (jumped || !std::isfinite(point.value)) below = nullptr;
        if (point.value < -rounding) below = &point;
        if (!(point.value > rounding) || below == nullptr) continue;
        // If the two points are in different steps, the second step starts at zero within rounding.
        const std::optional<double> t =
            below->piece == point.piece ? zero_between(along, *below, point) : trajectory.pieces[point.piece].start;
        below = nullptr;
        if (!t || !is_after_start(section, *t)) continue;
        SectionPoint moment;
        moment.sample = along.sample(point.piece, *t);
        moment.events = events_until(trajectory, *t);
        moments.push_back(std::move(moment));
    }
    return moments;
}

}  // namespace achilles
