#include "figure/lens.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "figure/axes.hpp"
#include "model/model.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

constexpr int points_a_flight = 48;

// Gap at u in [0, 1] of a flight of duration `length` between two impacts, from the normal velocities at its ends. The
// cubic has an error of O(length^4). Evaluating h(q) instead would lose h ~ speed^2 in the rounding of q ~ 1.
double cubic_gap(double u, double length, double up, double down) {
    return length * u * (1.0 - u) * (up * (1.0 - u) + down * u);
}

double share(int i) { return static_cast<double>(i) / points_a_flight; }

// Ticks at powers of ten of the time left, as many as fit, with minor ticks at 2 to 9 times each if all are labeled.
void set_time_left(Axis& axis, double low, double high) {
    constexpr double most = 8.0;
    axis.low = low;
    axis.high = high;
    const double every = std::max(1.0, std::ceil((high - low) / most));
    for (double k = std::floor(low); k <= high; ++k) {
        if (k >= low) axis.ticks.push_back({k, std::fmod(k, every) == 0.0 ? power_of_ten(-static_cast<int>(k)) : ""});
        for (int digit = 9; every == 1.0 && digit >= 2; --digit) {
            const double x = k + 1.0 - std::log10(digit);
            if (x >= low && x <= high) axis.ticks.push_back({x, ""});
        }
    }
}

// The contact that bounces before a Zeno event.
std::size_t the_contact(const Event& zeno) {
    std::size_t contact = 0;
    while (!zeno.contacts.contains(contact)) ++contact;
    return contact;
}

Mode mode_while_bouncing(const Event& zeno) { return zeno.mode.without(zeno.contacts); }

// First impact of the row: the impacts of that contact without other events between them, while the same other contacts
// are held.
std::size_t first_impact(const Trajectory& trajectory, std::size_t zeno) {
    const ContactSet contact = trajectory.events[zeno].contacts;
    const Mode mode = mode_while_bouncing(trajectory.events[zeno]);
    std::size_t first = zeno;
    while (first > 0) {
        const Event& before = trajectory.events[first - 1];
        if (!before.is_impact() || !(before.contacts == contact) || !(before.mode == mode)) break;
        --first;
    }
    return first;
}

}  // namespace

std::optional<Lens> Lens::at(const Trajectory& trajectory, std::size_t event) {
    if (event >= trajectory.events.size()) return std::nullopt;
    const Event& zeno = trajectory.events[event];
    if (!zeno.is_zeno() || !zeno.truncation || zeno.contacts.count() != 1) return std::nullopt;
    const std::size_t first = first_impact(trajectory, event);
    if (event - first < 2) return std::nullopt;
    const Model& model = *trajectory.model;
    const std::size_t contact = the_contact(zeno);
    Lens lens;
    lens.e_ = model.restitution(trajectory.run.parameters, contact);
    auto flight = model.evaluator(model.motion(mode_while_bouncing(zeno)).program, trajectory.run.parameters);
    set_state(flight, State{zeno.q, zeno.v_after, zeno.t});
    flight.run();
    const double a = -flight.hddot(contact);
    if (!(lens.e_ > 0.0) || !(lens.e_ < 1.0) || !(a > 0.0)) return std::nullopt;
    lens.spacing_ = -std::log10(lens.e_);
    lens.height_ = lens.e_ * lens.e_ / (2.0 * a);
    const auto x = [&](double t) { return -std::log10(zeno.t - t); };
    lens.cut_ = x(zeno.truncation->t);
    if (zeno.certificate && zeno.certificate->certified && zeno.certificate->zeno_low < zeno.t)
        lens.interval_ = std::max(lens.cut_, x(zeno.certificate->zeno_low));

    auto gap = model.evaluator(model.gap(contact), trajectory.run.parameters);
    Sampler sampler(trajectory);
    for (std::size_t i = first; i + 1 < event; ++i) {  // up to the impact at which the sequence is truncated
        const Event &impact = trajectory.events[i], &next = trajectory.events[i + 1];
        const double w = impact.impact_speed, down = next.impact_speed, length = next.t - impact.t;
        FlightCurve& drawn = lens.flights_.emplace_back(FlightCurve{x(impact.t), w, {}});
        for (int k = 0; k <= points_a_flight; ++k) {
            const double u = share(k), t = impact.t + u * length;
            double h = cubic_gap(u, length, lens.e_ * w, down);
            if (length > 1e-3 && k > 0 && k < points_a_flight) {
                set_state(gap, sampler.at(t).state);
                gap.run();
                h = gap.output(0);
            }
            drawn.points.push_back({x(t), h / (w * w)});
        }
    }
    return lens;
}

Lens::LensPart Lens::overview() const {
    constexpr double least = 4.0, most = 12.0, before = 0.3, between = 0.45;  // decades; fractions of the width
    const double far = interval_ ? (*interval_ - cut_) / between : 0.0;
    const double width = std::clamp(far, least * std::max(1.0, spacing_), most * std::max(1.0, spacing_));
    const double low = std::max(first() - 0.05 * width, cut_ - before * width);
    return {low, low + width};
}

Panel Lens::panel(double low, double high, const Theme& theme) const {
    Panel panel;
    panel.x.label = "time left, τ_{∞} − t (s)";
    panel.y.label = "h / w²";
    panel.legend = panel.legend_above = true;
    panel.curves.resize(2);
    Curve &run = panel.curves[0], &limit = panel.curves[1];
    run.label = "run";
    limit.label = "limit";
    run.stroke = limit.stroke = phase_stroke(theme, Phase::Kind::hybrid, 0, 1);
    run.stroke.dash.clear();
    limit.stroke.dash = {2.0, 2.5};
    Markers& impacts = panel.markers.emplace_back(event_markers(theme, Event::Kind::impact));
    for (const FlightCurve& flight : flights_) {
        if (flight.points.back().x < low || flight.x > high) continue;
        impacts.points.push_back({flight.x, 0.0});
        run.points.insert(run.points.end(), flight.points.begin(), flight.points.end());
    }
    // Flight number k of the limit starts when e^k of the time left at the cut is left. Only visible flights are drawn.
    const double begin = std::max(0.0, std::floor((low - cut_) / spacing_));
    for (double k = begin; cut_ + k * spacing_ <= high; ++k) {
        const double x = cut_ + k * spacing_;
        impacts.points.push_back({x, 0.0});
        for (int i = 0; i <= points_a_flight; ++i) {
            const double u = share(i);
            limit.points.push_back({x - std::log10(1.0 - (1.0 - e_) * u), 4.0 * height_ * u * (1.0 - u)});
        }
    }
    const auto bar = [&](double x, const char* label, const Color& color) {
        Markers& markers = panel.markers.emplace_back();
        markers.shape = Markers::MarkerShape::bar;
        markers.label = label;
        markers.fill = markers.edge = color;
        markers.size = 1.5;
        if (x >= low && x <= high) markers.points.push_back({x, 0.0});
    };
    bar(cut_, "cut here", theme.surface);
    if (interval_) {
        Color color = event_markers(theme, Event::Kind::zeno).fill;
        bar(*interval_, "τ_{∞} is certified to lie to the right", color);
        color.a = 36;
        panel.bands.push_back({"certified", color, *interval_, std::numeric_limits<double>::max()});
    }
    set_time_left(panel.x, low, high);
    // The y range follows from the limit instead of the visible part, so that nothing jumps while scrolling. An early
    // flight over ground that is not yet flat may leave the picture.
    set_ticks(panel.y, 0.0, 1.5 * height_, 0.0, 4);
    panel.y.low = -0.08 * height_;
    return panel;
}

}  // namespace achilles
