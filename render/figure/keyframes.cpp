#include "figure/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace achilles {

namespace {

bool is_same_look(const DrawnShape& a, const DrawnShape& b) {
    return a.kind == b.kind && a.text == b.text && a.fill == b.fill && a.closed == b.closed &&
           a.fill_color == b.fill_color && a.stroke.color == b.stroke.color && a.stroke.width == b.stroke.width &&
           a.stroke.dash == b.stroke.dash;
}

// Whether each number of the one can move to that of the other: breaks are at the same places.
bool can_interpolate(const ShapeNumbers& a, const ShapeNumbers& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return std::isfinite(x) == std::isfinite(y); });
}

bool is_equal(const ShapeNumbers& a, const ShapeNumbers& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

// The largest distance of a number from the place `share` of the way between two others.
double deviation(const ShapeNumbers& from, const ShapeNumbers& to, const ShapeNumbers& at, double share) {
    double most = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i)
        if (std::isfinite(at[i])) most = std::max(most, std::abs(from[i] + share * (to[i] - from[i]) - at[i]));
    return most;
}

// The slopes with which each number can leave its place and pass all later ones within the tolerance.
class SlopeLimits {
 public:
    explicit SlopeLimits(double tolerance) : tolerance_(tolerance) {}
    void clear() { limits_.clear(); }
    bool allow(const ShapeNumbers& from, const ShapeNumbers& to, double duration, std::size_t& next) const {
        for (std::size_t i = 0; i < to.size(); ++i, ++next) {
            if (next >= limits_.size() || !std::isfinite(to[i])) continue;
            const double slope = (to[i] - from[i]) / duration;
            if (!(slope >= limits_[next][0] && slope <= limits_[next][1])) return false;
        }
        return true;
    }
    void narrow(const ShapeNumbers& from, const ShapeNumbers& at, double duration, std::size_t& next) {
        for (std::size_t i = 0; i < at.size(); ++i, ++next) {
            constexpr double inf = std::numeric_limits<double>::infinity();
            if (next >= limits_.size()) limits_.push_back({-inf, inf});
            if (!std::isfinite(at[i])) continue;
            auto& [low, high] = limits_[next];
            low = std::max(low, (at[i] - tolerance_ - from[i]) / duration);
            high = std::min(high, (at[i] + tolerance_ - from[i]) / duration);
        }
    }

 private:
    double tolerance_;
    std::vector<std::array<double, 2>> limits_;
};

}  // namespace

PictureShape picture_shape(std::size_t picture, const DrawnShape& shape) {
    ShapeNumbers numbers;
    for (const Point& p : shape.points) numbers.insert(numbers.end(), {p.x, p.y});
    if (shape.kind == DrawnShape::Kind::disc) numbers.push_back(shape.radius);
    PictureShape made{picture, shape, std::make_shared<const ShapeNumbers>(std::move(numbers))};
    made.look.points.clear();
    return made;
}

Keyframes::Keyframes(const Trajectory& trajectory, ShapesAt shapes, double tolerance)
    : trajectory_(trajectory), shapes_(std::move(shapes)) {
    constexpr double steps = 600.0;  // of a stepped shape
    constexpr std::size_t max_steps = 3000;
    constexpr int max_depth = 10;
    step_ = (trajectory.end_time - trajectory.run.options.start_time) / steps;
    Sampler sampler(trajectory);
    const std::size_t pieces = trajectory.pieces.size();
    // Several samples in each step, so that no oscillation hides between two of them.
    const int between =
        static_cast<int>(std::clamp<std::size_t>(2 * max_steps / std::max<std::size_t>(pieces, 1), 1, 8));
    const bool has_all = pieces <= max_steps;
    std::vector<Frame> coarse;
    for (const Sample& sample : has_all ? sampler.all(between) : sampler.some(max_steps, between)) {
        add(coarse, frame(sample));
        if (coarse.size() > 1) note_stepped(coarse[coarse.size() - 2], coarse.back());
    }
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        if (i > 0 && (has_all || coarse[i - 1].now.j == coarse[i].now.j))
            refine(sampler, coarse[i - 1], coarse[i], tolerance, max_depth);
        add(frames_, coarse[i]);
    }
}

// Remembers the shapes, by their place in the list, that cannot be interpolated from one frame to the next.
void Keyframes::note_stepped(const Frame& from, const Frame& to) {
    if (!continues(from, to)) return;
    is_stepped_.resize(std::max(is_stepped_.size(), to.shapes.size()));
    for (std::size_t i = 0; i < to.shapes.size(); ++i)
        if (!can_interpolate(*from.shapes[i].numbers, *to.shapes[i].numbers)) is_stepped_[i] = true;
}

Keyframes::Frame Keyframes::frame(const Sample& now) const {
    return {now, phase_label(*trajectory_.model, now), shapes_(now, light_theme())};
}

// Shapes that have not moved share their numbers.
void Keyframes::add(std::vector<Frame>& frames, Frame frame) {
    if (!frames.empty()) {
        const auto& before = frames.back().shapes;
        for (std::size_t i = 0; i < std::min(before.size(), frame.shapes.size()); ++i)
            if (is_equal(*before[i].numbers, *frame.shapes[i].numbers)) frame.shapes[i].numbers = before[i].numbers;
    }
    frames.push_back(std::move(frame));
}

bool Keyframes::continues(const Frame& from, const Frame& to) {
    return from.phase.text == to.phase.text && from.phase.color == to.phase.color &&
           std::equal(from.shapes.begin(), from.shapes.end(), to.shapes.begin(), to.shapes.end(),
                      [](const PictureShape& a, const PictureShape& b) {
                          return a.picture == b.picture && is_same_look(a.look, b.look);
                      });
}

// Adds frames between two, in which there is no event, until each lies where interpolation puts it.
void Keyframes::refine(Sampler& sampler, const Frame& from, const Frame& to, double tolerance, int depth) {
    const double duration = to.now.t - from.now.t;
    if (depth == 0 || !(duration > 1e-12 * std::max(1.0, std::abs(to.now.t)))) return;
    const Frame middle = frame(sampler.at(from.now.t + 0.5 * duration));
    bool is_fine = continues(from, middle) && continues(middle, to);
    for (std::size_t i = 0; i < middle.shapes.size() && is_fine; ++i) {
        const ShapeNumbers &a = *from.shapes[i].numbers, &b = *to.shapes[i].numbers, &m = *middle.shapes[i].numbers;
        const bool is_stepped =
            (i < is_stepped_.size() && is_stepped_[i]) || !can_interpolate(a, m) || !can_interpolate(m, b);
        is_fine = is_stepped ? duration <= step_ || (is_equal(a, m) && is_equal(m, b))
                             : deviation(a, b, m, 0.5) <= 0.5 * tolerance;
    }
    if (is_fine) return;
    refine(sampler, from, middle, tolerance, depth - 1);
    add(frames_, middle);
    refine(sampler, middle, to, tolerance, depth - 1);
}

std::vector<MotionClip> Keyframes::clips(double tolerance) const {
    std::vector<MotionClip> all;
    for (std::size_t first = 0; first < frames_.size();) {
        std::size_t last = first + 1;
        while (last < frames_.size() && continues(frames_[first], frames_[last])) ++last;
        all.push_back(clip(first, last, tolerance));
        first = last;
    }
    return all;
}

MotionClip Keyframes::clip(std::size_t first, std::size_t last, double tolerance) const {
    const Frame& begin = frames_[first];
    MotionClip made;
    made.phase = begin.phase;
    const std::vector<PictureShape> dark = shapes_(begin.now, dark_theme());
    std::vector<MotionClip::Course> courses;
    for (std::size_t i = 0; i < begin.shapes.size(); ++i) {
        MotionClip::Course course = MotionClip::Course::still;
        for (std::size_t k = first + 1; k < last; ++k) {
            const auto &a = frames_[k - 1].shapes[i].numbers, &b = frames_[k].shapes[i].numbers;
            if (a == b || is_equal(*a, *b)) continue;
            course =
                can_interpolate(*a, *b) ? std::max(course, MotionClip::Course::smooth) : MotionClip::Course::stepped;
        }
        courses.push_back(course);
        made.shapes.push_back({begin.shapes[i].picture, begin.shapes[i].look, dark[i].look, course, {}});
    }
    for (const std::size_t k : kept(first, last, courses, tolerance)) {
        made.times.push_back(frames_[k].now.t);
        for (std::size_t i = 0; i < courses.size(); ++i)
            if (courses[i] != MotionClip::Course::still || made.times.size() == 1)
                made.shapes[i].numbers.push_back(frames_[k].shapes[i].numbers);
    }
    return made;
}

// The frames to keep: from each, all those up to the next lie within the tolerance of uniform motion.
std::vector<std::size_t> Keyframes::kept(std::size_t first, std::size_t last,
                                         const std::vector<MotionClip::Course>& courses, double tolerance) const {
    std::vector<std::size_t> keys{first};
    SlopeLimits limits(tolerance);
    const auto for_each_smooth = [&](std::size_t k, const auto& call) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < courses.size(); ++i)
            if (courses[i] == MotionClip::Course::smooth &&
                !call(*frames_[keys.back()].shapes[i].numbers, *frames_[k].shapes[i].numbers, next))
                return false;
        return true;
    };
    const bool is_stepped = std::find(courses.begin(), courses.end(), MotionClip::Course::stepped) != courses.end();
    const auto keep = [&](std::size_t k) {
        if (keys.back() != k) keys.push_back(k);
        limits.clear();
    };
    for (std::size_t k = first + 1; k < last; ++k) {
        const double duration = frames_[k].now.t - frames_[keys.back()].now.t;
        if (frames_[k].now.t == frames_[k - 1].now.t) {  // before and after an event
            bool has_jumped = false;
            for (std::size_t i = 0; i < courses.size(); ++i) {
                const ShapeNumbers &a = *frames_[k - 1].shapes[i].numbers, &b = *frames_[k].shapes[i].numbers;
                has_jumped = has_jumped || !can_interpolate(a, b) || deviation(a, b, a, 1.0) > 0.1 * tolerance;
            }
            if (has_jumped) keep(k - 1), keep(k);
            continue;
        }
        const auto is_allowed = [&](const ShapeNumbers& from, const ShapeNumbers& to, std::size_t& next) {
            return limits.allow(from, to, duration, next);
        };
        if (!for_each_smooth(k, is_allowed) || (is_stepped && duration > step_)) keep(k - 1);
        const double since = frames_[k].now.t - frames_[keys.back()].now.t;
        for_each_smooth(k, [&](const ShapeNumbers& from, const ShapeNumbers& to, std::size_t& next) {
            limits.narrow(from, to, since, next);
            return true;
        });
    }
    keep(last - 1);
    return keys;
}

}  // namespace achilles
