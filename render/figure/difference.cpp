#include "figure/difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "figure/label.hpp"

namespace achilles {

namespace {

// Times at which runs are compared: equally spaced, and at and just before the events of both runs, where rates jump.
// Events beyond a maximum number are too close to be distinguished on a screen.
std::vector<double> instants(const Trajectory& a, const Trajectory& b, double from, double to) {
    constexpr int evenly = 1000;
    constexpr std::size_t most_events = 400;
    std::vector<double> times;
    for (int i = 0; i <= evenly; ++i) times.push_back(i == evenly ? to : from + (to - from) * i / evenly);
    for (const Trajectory* run : {&a, &b}) {
        const auto before = [](const Event& event, double t) { return event.t < t; };
        const auto first = std::lower_bound(run->events.begin(), run->events.end(), from, before),
                   last = std::lower_bound(first, run->events.end(), to, before);
        if (last - first > static_cast<std::ptrdiff_t>(most_events)) continue;
        for (auto event = first; event < last; ++event)
            times.insert(times.end(), {std::max(from, std::nextafter(event->t, from)), event->t});
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

// Quantities of a run at any time.
class ViewSampler {
 public:
    ViewSampler(const Trajectory& run, const PreparedView& view) : sampler_(run), values_(view, run) {}
    void go_to(double t) { values_.set(sampler_.at(t)); }
    double operator[](std::size_t i) const { return values_[i]; }

 private:
    Sampler sampler_;
    Values values_;
};

Stroke stroke_of(const Color& color, std::size_t quantity) {
    const std::array<std::vector<double>, 4> dashes{{{}, {6.0, 3.0}, {1.5, 2.5}, {8.0, 2.5, 1.5, 2.5}}};
    return {color, 1.6, dashes[quantity % dashes.size()]};
}

// The largest power of ten that does not exceed the rounding noise of quantities of this magnitude.
double floor_of(double largest) {
    return largest > 0.0 && std::isfinite(largest) ? std::pow(10.0, std::floor(std::log10(noise * largest))) : noise;
}

}  // namespace

std::vector<std::size_t> compared_quantities(const PreparedView& view, const Framing& framing) {
    std::vector<std::size_t> quantities;
    if (!view.quantities()[0].is_time) quantities.push_back(0);
    for (std::size_t i = 1; i < view.quantities().size(); ++i)
        if (!framing.hidden.contains(i - 1)) quantities.push_back(i);
    return quantities;
}

Panel difference(const Trajectory& present, std::span<const ComparedRun> others, const PreparedView& view,
                 const Framing& framing, std::optional<double> horizon) {
    const std::vector<std::size_t> quantities = compared_quantities(view, framing);
    Panel panel;
    panel.title = "difference: " + view.title();
    panel.y.logarithmic = true;
    ViewSampler now(present, view);
    double largest = 0.0, high = 0.0, start = present.run.options.start_time, end = start;
    for (const ComparedRun& other : others) {
        const double begin = std::max(present.run.options.start_time, other.run->run.options.start_time),
                     until = std::min(present.end_time, other.run->end_time);
        if (!(until > begin)) continue;
        end = std::max(end, until);
        const double from = framing.x ? std::clamp((*framing.x)[0], begin, until) : begin,
                     to = framing.x ? std::clamp((*framing.x)[1], from, until) : until;
        ViewSampler then(*other.run, view);
        const std::size_t first = panel.curves.size();
        const double known = std::min(horizon.value_or(until), other.horizon.value_or(until));
        if (known < until) panel.beyond.label = beyond_text(known);
        for (std::size_t k = 0; k < quantities.size(); ++k) {
            const std::string& label = view.quantities()[quantities[k]].label;
            panel.curves.push_back(
                {quantities.size() == 1 ? other.name : label + ": " + other.name, stroke_of(other.color, k), {}});
            Curve& beyond = panel.beyond.curves.emplace_back(Curve{"", panel.curves.back().stroke, {}});
            beyond.stroke.color.a = pale_beyond;
        }
        std::vector<double> times = instants(present, *other.run, from, to);
        if (known > from && known < to)  // the parts before and after the horizon share this point
            times.insert(std::lower_bound(times.begin(), times.end(), known), known);
        for (const double t : times) {
            now.go_to(t);
            then.go_to(t);
            for (std::size_t k = 0; k < quantities.size(); ++k) {
                const double a = now[quantities[k]], b = then[quantities[k]], gap = std::abs(a - b);
                const Point point = std::isfinite(gap) ? Point{t, gap} : break_of_curve;
                if (t <= known) panel.curves[first + k].points.push_back(point);
                if (t >= known && known < until) panel.beyond.curves[first + k].points.push_back(point);
                if (!std::isfinite(gap)) continue;
                largest = std::max({largest, std::abs(a), std::abs(b)});
                high = std::max(high, gap);
            }
        }
    }
    const double least = floor_of(largest);
    for (std::vector<Curve>* const curves : {&panel.curves, &panel.beyond.curves})
        for (Curve& curve : *curves)
            for (Point& point : curve.points)
                if (point.y < least) point.y = least;
    std::erase_if(panel.beyond.curves, [](const Curve& curve) { return curve.points.empty(); });
    set_ticks(panel.x, framing.x ? (*framing.x)[0] : start, framing.x ? (*framing.x)[1] : std::max(end, start + 1e-9),
              0.0);
    if (framing.y)
        set_ticks(panel.y, (*framing.y)[0], (*framing.y)[1], 0.0);
    else
        set_ticks(panel.y, least, std::max(2.0 * high, 1e4 * least), 0.0);
    const auto& all = view.quantities();
    panel.x.label = with_unit(typeset("t"), "s");
    std::string unit = quantities.empty() ? "" : all[quantities.front()].unit;
    for (const std::size_t i : quantities)
        if (all[i].unit != unit) unit.clear();
    panel.y.label =
        with_unit(quantities.size() == 1 ? "|\u0394" + all[quantities.front()].label + "|" : "|\u0394|", unit);
    if (panel.curves.empty()) return panel;
    panel.legend = panel.legend_above = framing.for_print;
    // On a screen, which has less space, the legend of many runs is shown elsewhere.
    constexpr std::size_t max_named = 4;
    if (!framing.for_print && panel.curves.size() <= max_named) place_legend(panel);
    return panel;
}

}  // namespace achilles
