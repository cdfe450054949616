#include "figure/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "expression/parse.hpp"
#include "figure/axes.hpp"
#include "figure/label.hpp"

namespace achilles {

namespace {

constexpr std::array<std::pair<CameraMode, std::string_view>, 4> mode_names{{{CameraMode::fit, "fit"},
                                                                             {CameraMode::fixed, "fixed"},
                                                                             {CameraMode::follow, "follow"},
                                                                             {CameraMode::zeno, "zeno"}}};

void include(Drawing& all, const Point& p) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    all.x_low = std::min(all.x_low, p.x), all.x_high = std::max(all.x_high, p.x);
    all.y_low = std::min(all.y_low, p.y), all.y_high = std::max(all.y_high, p.y);
}

double unit_of(const Drawing& limits, const CameraPicture& picture) {
    return std::min(picture.width / (limits.x_high - limits.x_low), picture.height / (limits.y_high - limits.y_low));
}

Drawing square(const Drawing& like, const Point& middle, double size) {
    Drawing drawing;
    drawing.size = like.size;
    drawing.x_low = middle.x - 0.5 * size, drawing.x_high = middle.x + 0.5 * size;
    drawing.y_low = middle.y - 0.5 * size, drawing.y_high = middle.y + 0.5 * size;
    return drawing;
}

Point middle_of(const Drawing& d) { return {0.5 * (d.x_low + d.x_high), 0.5 * (d.y_low + d.y_high)}; }

// Smooth step from 0 to 1 with zero slope at both ends.
double eased(double s) { return s * s * (3.0 - 2.0 * s); }

}  // namespace

std::string_view to_text(CameraMode mode) { return mode_names[static_cast<std::size_t>(mode)].second; }

std::optional<CameraMode> camera_mode_from(std::string_view text) {
    for (const auto& [mode, name] : mode_names)
        if (name == text) return mode;
    return std::nullopt;
}

Drawing widened(const Drawing& limits, double width, double height) {
    Drawing seen = limits;
    seen.shapes.clear();
    const double unit = unit_of(limits, {width, height});
    if (!(unit > 0.0) || !std::isfinite(unit)) return seen;
    const Point middle = middle_of(limits);
    seen.x_low = middle.x - 0.5 * width / unit, seen.x_high = middle.x + 0.5 * width / unit;
    seen.y_low = middle.y - 0.5 * height / unit, seen.y_high = middle.y + 0.5 * height / unit;
    return seen;
}

Camera::Camera(const Mechanism& mechanism, const ContactGeometry& touch, const Trajectory& trajectory,
               std::span<const Sample> samples, const Trail& trail, const Drawing& limits)
    : touch_(touch),
      trajectory_(trajectory),
      samples_(samples),
      trail_(trail),
      limits_(limits),
      grips_(mechanism.grips(trajectory.run.parameters)) {
    Point sum;
    for (std::size_t i = 0; i < trail.points.size(); ++i) {
        if (i > 0) {
            const double half = 0.5 * (samples[i].t - samples[i - 1].t);
            sum.x += half * (trail.points[i].x + trail.points[i - 1].x);
            sum.y += half * (trail.points[i].y + trail.points[i - 1].y);
        }
        integral_.push_back(sum);
    }
    for (std::size_t i = 0; i < trajectory.events.size(); ++i)
        if (trajectory.events[i].is_zeno())
            if (auto approach = approach_to(i)) approaches_.push_back(std::move(*approach));
}

// ---- the bouncing sequence before a Zeno point ----

Camera::Bounce Camera::bounce(std::size_t grip, std::size_t contact, const Sample& sample) const {
    AnchorPoint point = grips_[grip];
    const auto body = Body::of(point, sample.t, sample.state);
    if (!body) return {};
    const Model& model = *trajectory_.model;
    auto terms = model.evaluator(model.programs_of(contact).contact_terms, trajectory_.run.parameters);
    State state = sample.state;
    state.t = sample.t;
    set_state(terms, state);
    terms.run();
    Vector n(state.q.size());
    for (Eigen::Index i = 0; i < n.size(); ++i) n[i] = terms.impulse_direction(static_cast<std::size_t>(i));
    const Point carried = body->velocity(n);
    const bool is_known = std::isfinite(carried.x) && std::isfinite(carried.y) && std::isfinite(terms.h());
    return is_known ? Bounce{terms.h(), carried} : Bounce{};
}

// The point that meets the ground; else the point that moves most per change of the gap, the first one if several move
// equally.
std::size_t Camera::grip_for(std::size_t contact, const Sample& near) const {
    if (const auto tip = touch_.tip_of(contact)) return *tip;
    std::size_t best = 0;
    double most = 0.0;
    for (std::size_t i = 0; i < grips_.size(); ++i) {
        const Point carried = bounce(i, contact, near).rise;
        if (const double size = std::hypot(carried.x, carried.y); size > most * 1.01) most = size, best = i;
    }
    return best;
}

std::optional<Camera::Approach> Camera::approach_to(std::size_t event) const {
    const Event& zeno = trajectory_.events[event];
    if (grips_.empty() || is_plastic_landing(zeno) || zeno.contacts.empty()) return std::nullopt;
    Approach approach;
    approach.zeno = zeno.t;
    for (approach.contact = 0; !zeno.contacts.contains(approach.contact);) ++approach.contact;
    std::vector<double> times{zeno.t};
    std::size_t i = event;
    approach.begin = trajectory_.run.options.start_time;
    while (i-- > 0) {
        const Event& before = trajectory_.events[i];
        if (!before.is_impact()) {
            approach.begin = before.t;
            break;
        }
        if (before.contacts.contains(approach.contact)) times.push_back(before.t);
    }
    std::reverse(times.begin(), times.end());
    if (times.size() < 3) return std::nullopt;
    approach.cut = times[times.size() - 2];
    Sampler sampler(trajectory_);
    const Sample first = sampler.at(times.front());
    const auto known = std::find_if(approaches_.begin(), approaches_.end(),
                                    [&](const Approach& other) { return other.contact == approach.contact; });
    approach.grip = known != approaches_.end() ? known->grip : grip_for(approach.contact, first);
    AnchorPoint grip = grips_[approach.grip];
    approach.on_ground = touch_.ground_below(grip, approach.contact, first.t, first.state).has_value();
    const Point way = bounce(approach.grip, approach.contact, first).rise;
    const double carried = std::hypot(way.x, way.y);
    if (!(carried > 0.0)) return std::nullopt;
    auto gap = trajectory_.model->evaluator(trajectory_.model->gap(approach.contact), trajectory_.run.parameters);
    for (std::size_t k = 0; k + 2 < times.size(); ++k) {
        Sample middle = sampler.at(0.5 * (times[k] + times[k + 1]));
        middle.state.t = middle.t;
        set_state(gap, middle.state);
        gap.run();
        const double height = carried * gap.output(0);
        if (std::isfinite(height) && height > 0.0 && zeno.t > times[k])
            approach.flights.push_back({zeno.t - times[k], height});
    }
    // Make the heights nonincreasing, from the last flight to the first.
    for (std::size_t k = approach.flights.size(); k-- > 1;)
        approach.flights[k - 1].height = std::max(approach.flights[k - 1].height, approach.flights[k].height);
    if (approach.flights.empty()) return std::nullopt;
    return approach;
}

// Interpolates the height between flights as a power of the time left, and after the last flight as its square, as
// under constant acceleration. From the cut on there are no bounces, and the height stays.
double Camera::Approach::height(double t) const {
    const double left = std::max(0.0, zeno - std::min(t, cut));
    const auto next =
        std::find_if(flights.begin(), flights.end(), [&](const FlightHeight& f) { return f.left <= left; });
    if (next == flights.begin()) return flights.front().height;
    const FlightHeight& before = *std::prev(next);
    if (next == flights.end()) return before.height * (left / before.left) * (left / before.left);
    const double s = std::log(before.left / left) / std::log(before.left / next->left);
    return before.height * std::pow(next->height / before.height, s);
}

std::optional<double> Camera::height_left(double t) const {
    for (const Approach& approach : approaches_)
        if (t >= approach.zeno - approach.flights.front().left && t <= approach.zeno) return approach.height(t);
    return std::nullopt;
}

// ---- the visible part of the world ----

Drawing Camera::at(CameraMode mode, const Sample& now, const CameraPicture& picture) const {
    if (mode == CameraMode::follow && !trail_.points.empty()) return follow(now, picture);
    if (mode == CameraMode::zeno) return near_zeno(now, picture);
    return fit(picture);
}

// Arrows have a fixed length in pixels, hence a length in the world that grows with the visible part; the limits are
// iterated.
Drawing Camera::fit(const CameraPicture& picture) const {
    Drawing seen = limits_;
    if (!(picture.velocity > 0.0) && !(picture.force > 0.0)) return seen;
    constexpr int rounds = 4;
    for (int round = 0; round < rounds; ++round) {
        const double unit = unit_of(seen, picture);
        if (!(unit > 0.0) || !std::isfinite(unit)) return limits_;
        seen = limits_;
        for (const Trail::Arrows& arrows : trail_.arrows)
            for (const auto& [share, length] :
                 {std::pair{arrows.velocity, picture.velocity}, std::pair{arrows.force, picture.force}})
                include(seen, {arrows.at.x + share.x * length / unit, arrows.at.y + share.y * length / unit});
    }
    return seen;
}

// Mean position of the body over [t - reach, t + reach], clipped to the run.
Point Camera::mean_place(double t, double reach) const {
    const double low = std::max(t - reach, samples_.front().t), high = std::min(t + reach, samples_.back().t);
    const auto until = [&](double time) {
        const auto after = std::upper_bound(samples_.begin(), samples_.end(), time,
                                            [](double value, const Sample& sample) { return value < sample.t; });
        const auto i = static_cast<std::size_t>(after - samples_.begin());
        if (i == 0) return integral_.front();
        Point sum = integral_[i - 1];
        const Point& p = trail_.points[i - 1];
        const double rest = time - samples_[i - 1].t;
        const double whole = i < samples_.size() ? samples_[i].t - samples_[i - 1].t : 0.0;
        const Point& q = whole > 0.0 ? trail_.points[i] : p;
        const double s = whole > 0.0 ? rest / whole : 0.0;
        sum.x += rest * (p.x + 0.5 * s * (q.x - p.x));
        sum.y += rest * (p.y + 0.5 * s * (q.y - p.y));
        return sum;
    };
    if (!(high > low)) return trail_.points.front();
    const Point a = until(low), b = until(high);
    return {(b.x - a.x) / (high - low), (b.y - a.y) / (high - low)};
}

Drawing Camera::follow(const Sample& now, const CameraPicture& picture) const {
    if (grips_.empty()) return fit(picture);
    AnchorPoint grip = grips_.front();
    const AnchorPoint::Hold body = grip.at(now.t, now.state);
    const Drawing all = fit(picture);
    const double largest = std::max(all.x_high - all.x_low, all.y_high - all.y_low);
    constexpr double share = 0.4, radii = 20.0, window = 0.04;
    const double size = std::min(std::max(share * largest, radii * body.radius), largest);
    Point middle = mean_place(now.t, window * (trajectory_.end_time - trajectory_.run.options.start_time));
    // The arrow stays inside: the margin is that of the longest arrow.
    const double unit = std::min(picture.width, picture.height) / size;
    const double room = std::max(0.1, 0.44 - std::max(picture.velocity, picture.force) / (unit * size)) * size;
    middle.x = std::clamp(middle.x, body.at.x - room, body.at.x + room);
    middle.y = std::clamp(middle.y, body.at.y - room, body.at.y + room);
    return square(limits_, middle, size);
}

// Size of the visible world before and after a Zeno point; `full` is the size at other times.
double Camera::size_at(std::size_t which, double t, double full) const {
    constexpr double heights = 4.0;  // the picture is this many times the highest remaining bounce
    const Approach& approach = approaches_[which];
    const auto sized = [&](double height) { return std::clamp(heights * height, smallest(approach), full); };
    const double first = approach.zeno - approach.flights.front().left;
    if (t < approach.begin) return full;
    if (t < first)
        return full *
               std::pow(sized(approach.height(first)) / full, eased((t - approach.begin) / (first - approach.begin)));
    if (t <= approach.zeno) return sized(approach.height(t));
    const bool is_last = which + 1 == approaches_.size();
    const double end =
        is_last ? trajectory_.end_time : approaches_[which + 1].zeno - approaches_[which + 1].flights.front().left;
    constexpr double most = 0.1, of_rest = 0.5;
    const double run = trajectory_.end_time - trajectory_.run.options.start_time;
    const double lasts = std::min(most * run, of_rest * (end - approach.zeno));
    if (t >= approach.zeno + lasts) return full;
    return full * std::pow(sized(approach.height(t)) / full, 1.0 - eased((t - approach.zeno) / lasts));
}

// Center of the zoomed view: the contact point on the ground, in the lower part of the picture.
Point Camera::focus(const Approach& approach, const Sample& now, double size) const {
    AnchorPoint grip = grips_[approach.grip];
    if (const auto touched = touch_.ground_below(grip, approach.contact, now.t, now.state)) {
        constexpr double above = 0.2;
        return {touched->foot.x + above * size * touched->away.x, touched->foot.y + above * size * touched->away.y};
    }
    // The drawing does not show the contact point, for example at the stop of a joint. The body is near it.
    AnchorPoint body = grips_.front();
    return body.at(now.t, now.state).at;
}

Camera::ZenoZoom Camera::zoom(double t, const Drawing& all) const {
    const double full = std::min(all.x_high - all.x_low, all.y_high - all.y_low);
    ZenoZoom zoom{nullptr, full, full};
    for (std::size_t i = 0; i < approaches_.size(); ++i)
        if (const double size = size_at(i, t, full); size < zoom.size)
            zoom.size = size, zoom.approach = &approaches_[i];
    return zoom;
}

std::optional<Camera::ZenoView> Camera::zeno_view(const Sample& now, const CameraPicture& picture) const {
    const auto [on_way, size, full] = zoom(now.t, widened(fit(picture), picture.width, picture.height));
    if (on_way == nullptr || now.t < on_way->zeno - on_way->flights.front().left || now.t > on_way->zeno)
        return std::nullopt;
    const Bounce here = bounce(on_way->grip, on_way->contact, now);
    // The flight under way, or the last one.
    const auto later =
        std::find_if(on_way->flights.begin(), on_way->flights.end(),
                     [left = on_way->zeno - now.t](const Approach::FlightHeight& f) { return f.left < left; });
    AnchorPoint grip = grips_[on_way->grip];
    return ZenoView{full / size, std::max(0.0, std::hypot(here.rise.x, here.rise.y) * here.gap),
                    std::prev(later)->height, now.t >= on_way->cut, grip.at(now.t, now.state).radius > size};
}

Drawing Camera::near_zeno(const Sample& now, const CameraPicture& picture) const {
    const Drawing all = widened(fit(picture), picture.width, picture.height);
    const auto [on_way, size, full] = zoom(now.t, all);
    if (on_way == nullptr) return all;
    // As if the viewer approached the contact point: it moves to the center of the picture, and the previous center
    // moves out.
    const double left = std::max(0.0, (size - smallest(*on_way)) / (full - smallest(*on_way)));
    const Point looked_at = focus(*on_way, now, size * (1.0 - left)), middle = middle_of(all);
    const Point there{looked_at.x + left * left * (middle.x - looked_at.x),
                      looked_at.y + left * left * (middle.y - looked_at.y)};
    return widened(square(limits_, there, size), picture.width, picture.height);
}

// ---- scale bar: round lengths and their unit ----

double round_length(double most) {
    if (!(most > 0.0) || !std::isfinite(most)) return 0.0;
    const double decade = std::pow(10.0, std::floor(std::log10(most)));
    for (const double digit : {5.0, 2.0, 1.0})
        if (digit * decade <= most * (1.0 + 1e-12)) return digit * decade;
    return 0.5 * decade;
}

std::string length_unit(const SystemDescription& description) {
    constexpr std::array<std::string_view, 8> lengths{"m", "km", "cm", "mm", "um", "nm", "ft", "in"};
    std::set<std::string> found;
    for (const DrawingDescription& drawing : drawings_of(description))
        for (const Text& text : texts_of(drawing))
            for (const std::string& name : names_in(text.text)) {
                const std::string unit = unit_of(description, name);
                if (std::find(lengths.begin(), lengths.end(), unit) != lengths.end()) found.insert(unit);
            }
    if (drawings_of(description).empty())
        for (const CoordinateDescription& coordinate : description.coordinates)
            if (std::find(lengths.begin(), lengths.end(), coordinate.unit) != lengths.end())
                found.insert(coordinate.unit);
    return found.size() == 1 ? *found.begin() : "";
}

std::string length_label(double length, const std::string& unit) {
    const int exponent = static_cast<int>(std::floor(std::log10(length) + 1e-9));
    std::string text;
    if (exponent >= -3 && exponent <= 4) {
        text = fmt::format("{:.{}f}", length, std::max(0, -exponent));
    } else {
        const double digit = std::round(length / std::pow(10.0, exponent));
        text = (digit == 1.0 ? "" : fmt::format("{:.0f}\u00b7", digit)) + power_of_ten(exponent);
    }
    return unit.empty() ? text : text + " " + typeset_unit(unit);
}

}  // namespace achilles
