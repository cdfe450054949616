#include "figure/compose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "figure/axes.hpp"
#include "figure/label.hpp"
#include "figure/plane.hpp"
#include "figure/trace.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"
#include "output/precision.hpp"
#include "simulate/sampler.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// Range of all finite values; on a logarithmic axis, of the positive ones.
struct DataRange {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    bool positive = false;
    void include(double x) {
        if (!std::isfinite(x) || (positive && !(x > 0.0))) return;
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

}  // namespace

Sample sample_at(const Trajectory& trajectory, const Event& event) {
    Sample sample;
    sample.t = event.t;
    sample.state = {event.q, event.v_after, event.t};
    sample.work = event.work;
    sample.loss = event.loss;
    sample.heat = event.heat;
    sample.mode = event.mode;
    sample.contact = !event.mode.is_free();
    sample.load_bearing = load_bearing_contacts(trajectory, event.mode, event.t);
    return sample;
}

std::vector<Sample> plot_samples(const Trajectory& trajectory) {
    constexpr std::size_t wanted = 2000, most_steps = 20000;
    const std::size_t steps = std::max<std::size_t>(1, trajectory.pieces.size());
    const int between = static_cast<int>(std::clamp<std::size_t>(wanted / steps, 1, 200));
    Sampler sampler(trajectory);
    return steps > most_steps ? sampler.some(most_steps / 2, between) : sampler.all(between);
}

std::vector<double> values_at(const Trajectory& trajectory, const Sample& sample, const PreparedView& view) {
    Values values(view, trajectory);
    values.set(sample);
    std::vector<double> result;
    for (std::size_t i = 0; i < view.quantities().size(); ++i) result.push_back(values[i]);
    return result;
}

std::vector<double> errors_at(const Trajectory& trajectory, const Sample& sample, const PreparedView& view,
                              const Precision& precision) {
    Values values(view, trajectory);
    std::vector<double> errors;
    for (std::size_t i = 0; i < view.quantities().size(); ++i)
        errors.push_back(precision.of(
            [&](const Sample& at) {
                values.set(at);
                return values[i];
            },
            sample));
    return errors;
}

namespace {

// A curve for each quantity and each look of a phase.
void add_curves(Panel& panel, const Model& model, const PreparedView& view, const Theme& theme) {
    const auto& quantities = view.quantities();
    const std::size_t curves = quantities.size() - 1;
    panel.courses = look_count(model);
    for (std::size_t i = 0; i < curves; ++i) {
        for (const PhaseLook look : std::span(phase_looks).first(panel.courses)) {
            Curve& curve = panel.curves.emplace_back();
            curve.stroke = phase_stroke(theme, look, i, curves);
            const bool first = look == PhaseLook::flight;
            // If units differ, the legend is the only place for them.
            const std::string name =
                with_unit(quantities[i + 1].label, view.unit().empty() ? quantities[i + 1].unit : "");
            curve.label = curves == 1 ? legend_text(look) : first ? name : "";
        }
    }
}

Point point_of(double x, double y) { return std::isfinite(x) && std::isfinite(y) ? Point{x, y} : break_of_curve; }

// Samples of a part of a run: evenly spaced, and at some of its events.
std::vector<Sample> some_samples(const Trajectory& trajectory, double from, double to) {
    constexpr int evenly = 200;
    Sampler sampler(trajectory);
    std::vector<Sample> samples;
    for (int i = 0; i <= evenly; ++i) samples.push_back(sampler.at(i == evenly ? to : from + (to - from) * i / evenly));
    const auto before = [](const Event& event, double t) { return event.t < t; };
    const auto& events = trajectory.events;
    const auto first = std::lower_bound(events.begin(), events.end(), from, before),
               last = std::lower_bound(first, events.end(), to, before);
    for (auto event = first; event < last; event += 1 + (last - first) / evenly)
        for (const Vector* v : {&event->v_before, &event->v_after}) {
            samples.push_back(sample_at(trajectory, *event));
            samples.back().state.v = *v;
        }
    return samples;
}

// Adds the values of x and of all visible y to the ranges.
void include(std::span<const Sample> samples, Values& values, std::size_t curves, const Framing& framing,
             DataRange& x_range, DataRange& y_range) {
    for (const Sample& sample : samples) {
        values.set(sample);
        x_range.include(values[0]);
        for (std::size_t i = 0; i < curves; ++i)
            if (!framing.hidden.contains(i)) y_range.include(values[i + 1]);
    }
}

bool has_collapse(std::span<const Event> events) {
    return std::any_of(events.begin(), events.end(), [](const Event& event) { return event.is_collapse(); });
}

// Adds the markers of these events.
void add_markers(Panel& panel, const Trajectory& trajectory, std::span<const Event> events, Values& values,
                 const Framing& framing, const Theme& theme) {
    const std::size_t curves = panel.curves.size() / panel.courses;
    for (const EventNames& row : possible_events(*trajectory.model)) {
        const Event::Kind kind = row.kind;
        if (kind == Event::Kind::collapse && !has_collapse(events)) continue;  // rare: no empty row for it
        Markers& markers = panel.markers.emplace_back(event_markers(theme, kind));
        const Trajectory* const run = &trajectory;
        markers.label = events_name({&run, 1}, kind);
        for (const Event& event : events) {
            if (event.kind != kind) continue;
            values.set(sample_at(trajectory, event));
            for (std::size_t i = 0; i < curves; ++i) {
                if (framing.hidden.contains(i)) continue;
                const Point point = point_of(values[0], values[i + 1]);
                if (!std::isnan(point.x)) markers.points.push_back(point);
            }
        }
    }
}

// Markers where an impact opened a held contact, above the marker of that impact.
void add_opened(Panel& panel, const Trajectory& trajectory, std::span<const Event> events, Values& values,
                const Framing& framing, const Theme& theme) {
    Markers& markers = panel.markers.emplace_back(opened_markers(theme));
    for (const Event& event : events) {
        if (!event.is_impact() || event.opened.empty()) continue;
        values.set(sample_at(trajectory, event));
        for (std::size_t i = 0; i * panel.courses < panel.curves.size(); ++i) {
            const Point point = point_of(values[0], values[i + 1]);
            if (!framing.hidden.contains(i) && !std::isnan(point.x)) markers.points.push_back(point);
        }
    }
}

// Gives the name of each of several curves to the first part that is drawn: a curve in contact at all times is not
// dashed in the legend.
void name_drawn(Panel& panel) {
    for (std::size_t i = 0; i < panel.curves.size(); i += panel.courses) {
        const std::span<Curve> parts = std::span(panel.curves).subspan(i, panel.courses);
        const auto drawn = std::find_if(parts.begin(), parts.end(), [](const Curve& c) { return !c.points.empty(); });
        std::swap(parts.front().label, (drawn == parts.end() ? parts.back() : *drawn).label);
    }
}

// Error of the quantities due to the rounding of coordinates and rates, relative to their ranges. A quantity that
// varies by less is constant.
struct Noise {
    double x = 0.0, y = 0.0;      // maximum over all y quantities
    std::vector<double> least{};  // the smallest error of each quantity, beginning with x, during the run
};

Noise noise_of(const Trajectory& trajectory, std::span<const Sample> samples, Values& values, std::size_t count) {
    constexpr double rounding = 1e-14;
    constexpr std::size_t looked_at = 8;
    const auto& coordinates = trajectory.model->description().coordinates;
    const auto size = [](const std::array<double, 2>& range) {
        return std::max(std::abs(range[0]), std::abs(range[1]));
    };
    Noise noise;
    noise.least.assign(count + 1, std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < std::min(samples.size(), looked_at); ++k) {
        Sample sample = samples[k * (samples.size() - 1) / std::max<std::size_t>(1, looked_at - 1)];
        std::vector<double> here(count + 1), off(count + 1);
        values.set(sample);
        for (std::size_t i = 0; i <= count; ++i) here[i] = values[i];
        for (std::size_t c = 0; c < 2 * coordinates.size(); ++c) {
            const auto at = static_cast<Eigen::Index>(c / 2);
            double& moved = c % 2 == 0 ? sample.state.q[at] : sample.state.v[at];
            const double before = moved;
            moved += rounding * size(c % 2 == 0 ? coordinates[c / 2].range : coordinates[c / 2].rate_range);
            values.set(sample);
            moved = before;
            for (std::size_t i = 0; i <= count; ++i) off[i] += std::abs(values[i] - here[i]);
        }
        for (std::size_t i = 0; i <= count; ++i) {
            double& most = i == 0 ? noise.x : noise.y;
            if (!std::isfinite(off[i])) continue;
            most = std::max(most, off[i]);
            noise.least[i] = std::min(noise.least[i], off[i]);
        }
    }
    return noise;
}

// Keeps one of very many markers at each distinguishable position.
void thin(Markers& markers, const Panel& panel, const Resolution& size) {
    constexpr std::size_t many = 4000;
    if (markers.points.size() <= many) return;
    const PanelMap map(panel, {0.0F, 0.0F, static_cast<float>(size.width), static_cast<float>(size.height)});
    std::set<std::array<long, 2>> taken;
    std::erase_if(markers.points, [&](const Point& point) {
        const Point at = map(point);
        return !std::isfinite(at.x) || !std::isfinite(at.y) ||
               !taken.insert({std::lround(at.x), std::lround(at.y)}).second;
    });
}

// Moves the points of each curve after the horizon into `pale`, a panel with the same curves. The point at which a
// curve crosses the horizon belongs to both. `times`: time of each point (s).
void split_curves(Panel& panel, Panel& pale, const std::vector<std::vector<double>>& times, double horizon) {
    for (std::size_t i = 0; i < panel.curves.size(); ++i) {
        std::vector<Point>& points = panel.curves[i].points;
        const auto first = std::upper_bound(times[i].begin(), times[i].end(), horizon) - times[i].begin();
        pale.curves[i].stroke = panel.curves[i].stroke;
        pale.curves[i].points.assign(points.begin() + std::max<std::ptrdiff_t>(first - 1, 0), points.end());
        points.erase(points.begin() + first, points.end());
    }
}

// Converts the curves and markers of a panel to the pale part after the horizon.
HorizonTail beyond_of(Panel panel, double horizon) {
    const auto fade = [](Color& color) { color.a = std::min(color.a, pale_beyond); };
    for (Curve& curve : panel.curves) curve.label.clear(), fade(curve.stroke.color);
    for (Markers& markers : panel.markers) markers.label.clear(), fade(markers.fill), fade(markers.edge);
    return {beyond_text(horizon), std::move(panel.curves), std::move(panel.markers)};
}

// Makes the marks after the horizon pale.
void fade(std::vector<TimeBar>& bars, double horizon) {
    for (TimeBar& bar : bars) {
        std::vector<TimeBar::TimeMark> marks;
        for (TimeBar::TimeMark mark : bar.marks) {
            if (mark.low <= horizon && mark.high > horizon) {
                marks.push_back({mark.low, horizon, mark.color});
                mark.low = horizon;
            }
            if (mark.high > horizon) mark.color.a = std::min(mark.color.a, pale_beyond);
            marks.push_back(mark);
        }
        bar.marks = std::move(marks);
    }
}

void set_limits(Axis& axis, const Framing::Limits& limits, const DataRange& range, double margin) {
    if (limits)
        set_ticks(axis, (*limits)[0], (*limits)[1], 0.0);
    else
        set_ticks(axis, range.low, range.high, margin);
}

// Treats a quantity that varies by its noise only as constant.
DataRange flush_noise_to_zero(DataRange range, double noise) {
    if (range.high - range.low > noise) return range;
    const double middle = 0.5 * (range.low + range.high);
    range.low = range.high = std::abs(middle) <= noise ? 0.0 : middle;
    return range;
}

void set_axes(Panel& panel, const Trajectory& trajectory, const PreparedView& view, const Framing& framing,
              DataRange x_range, DataRange y_range, const Noise& noise) {
    x_range = flush_noise_to_zero(x_range, noise.x);
    y_range = flush_noise_to_zero(y_range, noise.y);
    const bool whole_run = view.quantities()[0].is_time && !framing.log_x;
    if (whole_run) x_range.low = trajectory.run.options.start_time, x_range.high = trajectory.end_time;
    set_limits(panel.x, framing.x, x_range, whole_run ? 0.0 : 0.05);
    set_limits(panel.y, framing.y, y_range, 0.07);
}

// The time interval of a run that a panel shows (s), and samples that outline it.
struct ShownInterval {
    double from = 0.0, to = 0.0;
    std::vector<Sample> close{};        // samples of a part of the run
    std::span<const Sample> samples{};  // `close`, or samples of the whole run
};

ShownInterval shown_interval_of(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                                const Framing& framing) {
    ShownInterval extent{trajectory.run.options.start_time, samples.back().t, {}, samples};
    if (!view.quantities()[0].is_time || !framing.x) return extent;
    const double factor = view.quantities()[0].factor;
    extent.from = std::clamp((*framing.x)[0] / factor, extent.from, extent.to);
    extent.to = std::clamp((*framing.x)[1] / factor, extent.from, extent.to);
    extent.close = some_samples(trajectory, extent.from, extent.to);
    extent.samples = extent.close;
    return extent;
}

std::span<const Event> events_within(const Trajectory& trajectory, double from, double to) {
    const auto& events = trajectory.events;
    const auto first = std::lower_bound(events.begin(), events.end(), from,
                                        [](const Event&event, double t) { return event.t < t; }),
               last =
                   std::upper_bound(first, events.end(), to, [](double t, const Event&event) { return t < event.t; });
    return {events.data() + (first - events.begin()), static_cast<std::size_t>(last - first)};
}

// Fills the curves and sets the axes. Samples give the approximate limits, the traced curves the exact ones. Returns
// the time of each point of each curve (s).
std::vector<std::vector<double>> add_courses(Panel& panel, const Trajectory& trajectory, const ShownInterval& extent,
                                             const PreparedView& view, Values& values, const Framing& framing) {
    const std::size_t curves = panel.curves.size() / panel.courses;
    DataRange x_range, y_range;
    x_range.positive = framing.log_x;
    y_range.positive = framing.log_y;
    const Noise noise = noise_of(trajectory, extent.samples, values, curves);
    if (framing.log_x || framing.log_y) {
        std::vector<double> floors(curves + 1, 0.0);
        for (std::size_t i = 0; i <= curves; ++i)
            if ((i == 0 ? framing.log_x : framing.log_y) && std::isfinite(noise.least[i])) floors[i] = noise.least[i];
        values.set_floors(std::move(floors));
    }
    include(extent.samples, values, curves, framing, x_range, y_range);
    set_axes(panel, trajectory, view, framing, x_range, y_range, noise);
    TraceRequest request;
    request.from = extent.from, request.to = extent.to;
    request.quantities = curves;
    for (std::size_t i = 0; i < curves; ++i)
        if (!framing.hidden.contains(i)) request.shown.push_back(i);
    request.over_time = view.quantities()[0].is_time;
    const Layout& layout = trajectory.model->layout();
    request.with_work = values.reads(layout.work()) || (layout.frictions > 0 && values.reads(layout.heat()));
    request.noise.assign(curves + 1, noise.y);
    request.noise[0] = noise.x;
    request.size = framing.size;
    if (framing.is_coarse && extent.close.empty()) request.through = extent.samples;
    const PanelMap map(panel,
                       {0.0F, 0.0F, static_cast<float>(framing.size.width), static_cast<float>(framing.size.height)});
    request.map = &map;
    Trace traced = trace(trajectory, request, [&](const Sample& sample, std::span<double> all) {
        values.set(sample);
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = values[i];
    });
    std::vector<std::vector<double>> times;
    for (std::size_t i = 0; i < panel.curves.size(); ++i) {
        panel.curves[i].points = std::move(traced.courses[i].points);
        times.push_back(std::move(traced.courses[i].times));
        if (traced.courses[i].is_crowded) panel.curves[i].stroke.dash.clear();
    }
    for (std::size_t i = 0; i < traced.ranges.size(); ++i)
        for (const double x : traced.ranges[i]) (i == 0 ? x_range : y_range).include(x);
    set_axes(panel, trajectory, view, framing, x_range, y_range, noise);
    return times;
}

// Widens an axis about its center to a minimum fraction of the other axis, so that a path with equal axes is not a
// thread.
void widen(Axis& axis, const Axis& other) {
    constexpr double least = 0.3;
    const double more = 0.5 * (least * (other.high - other.low) - (axis.high - axis.low));
    if (more > 0.0) set_ticks(axis, axis.low - more, axis.high + more, 0.0);
}

// Extends an axis to show the whole boundary if little of it would be cut off: a ring appears round.
void show_whole(Axis& axis, double low, double high) {
    constexpr double margin = 0.04, rounding = 1e-6;
    const double span = axis.high - axis.low;
    const bool is_below = low<axis.low - rounding * span, is_above = high> axis.high + rounding * span;
    if (!is_below && !is_above) return;
    set_ticks(axis, is_below ? low - margin * span : axis.low, is_above ? high + margin * span : axis.high, 0.0);
}

void show_whole(Panel& panel, const std::vector<Point>& line) {
    constexpr double little = 0.15;  // fraction of the axis
    DataRange x, y;
    for (const Point& point : line) x.include(point.x), y.include(point.y);
    const auto is_near = [](const Axis& axis, const DataRange& range) {
        const double more = little * (axis.high - axis.low);
        return range.low >= axis.low - more && range.high <= axis.high + more;
    };
    if (!is_near(panel.x, x) || !is_near(panel.y, y)) return;
    show_whole(panel.x, x.low, x.high);
    show_whole(panel.y, y.low, y.high);
}

// Finishes a path in a plane. With the same unit on both axes it has equal axes, unless it is too elongated.
void make_picture(Panel& panel, const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
                  const Framing& framing, const Theme& theme) {
    constexpr double longest = 12.0;
    const auto& quantities = view.quantities();
    const double shape = (panel.x.high - panel.x.low) / (panel.y.high - panel.y.low);
    const bool is_asked = framing.x && framing.y;  // then the limits are kept
    panel.equal_axes = !framing.log_x && !framing.log_y && !quantities[0].unit.empty() &&
                       quantities[0].unit == view.unit() && (is_asked || std::max(shape, 1.0 / shape) <= longest);
    if (panel.equal_axes && !framing.x) widen(panel.x, panel.y);
    if (panel.equal_axes && !framing.y) widen(panel.y, panel.x);
    for (std::vector<Curve>* const curves : {&panel.curves, &panel.beyond.curves})
        for (Curve& curve : *curves)
            if (!curve.stroke.dash.empty() && !framing.log_x && !framing.log_y)
                curve.points = without_retraced(curve.points, panel.x, panel.y, framing.size);
    panel.boundary.stroke = {theme.surface, 1.0, {}};
    panel.boundary.points = boundary(trajectory, samples, view, panel, {}, framing.size);
    if (panel.equal_axes && !framing.x && !framing.y && !panel.boundary.points.empty())
        show_whole(panel, panel.boundary.points);
}

}  // namespace

std::string beyond_text(double horizon) { return fmt::format("not trusted after t = {:.6g} s", horizon); }

Panel compose(const Trajectory& trajectory, std::span<const Sample> samples, const PreparedView& view,
              const Theme& theme, const Framing& framing, std::optional<double> horizon) {
    const auto& quantities = view.quantities();
    const bool over_time = quantities[0].is_time, single = quantities.size() == 2;
    Panel panel;
    panel.title = view.title();
    Values values(view, trajectory);
    panel.x.logarithmic = framing.log_x;
    panel.y.logarithmic = framing.log_y;
    add_curves(panel, *trajectory.model, view, theme);
    Panel pale = panel;  // the part after the horizon
    const bool several = has_several_places(*trajectory.model) && !samples.empty();
    const bool has_beyond = horizon && !samples.empty() && *horizon < samples.back().t;
    const auto mark = [&](Panel& marked, std::span<const Event> events) {
        add_markers(marked, trajectory, events, values, framing, theme);
        if (several) add_opened(marked, trajectory, events, values, framing, theme);
        for (Markers& markers : marked.markers) thin(markers, panel, framing.size);
    };
    if (!samples.empty()) {
        const ShownInterval extent = shown_interval_of(trajectory, samples, view, framing);
        const auto times = add_courses(panel, trajectory, extent, view, values, framing);
        if (!single) name_drawn(panel);
        const std::span<const Event> events = events_within(trajectory, extent.from, extent.to);
        const double known_until = has_beyond ? *horizon : extent.to;
        const auto known = std::upper_bound(events.begin(), events.end(), known_until,
                                            [](double t, const Event& event) { return t < event.t; }) -
                           events.begin();
        mark(panel, events.first(static_cast<std::size_t>(known)));
        if (has_beyond) {
            split_curves(panel, pale, times, *horizon);
            mark(pale, events.subspan(static_cast<std::size_t>(known)));
            panel.beyond = beyond_of(std::move(pale), *horizon);
        }
    } else {
        set_axes(panel, trajectory, view, framing, DataRange{}, DataRange{}, {});
        if (!single) name_drawn(panel);
    }
    if (several && over_time) panel.time_bars = contact_bars(trajectory, samples.back().t, panel.x, theme);
    if (has_beyond) fade(panel.time_bars, *horizon);
    panel.x.label = with_unit(quantities[0].label, quantities[0].unit);
    panel.y.label = view.label().empty() ? view.unit() : with_unit(view.label(), view.unit());
    if (framing.for_print && !over_time) make_picture(panel, trajectory, samples, view, framing, theme);
    panel.legend = panel.legend_above = !single && framing.for_print;
    if (!single && framing.legend && !framing.for_print) place_legend(panel);
    return panel;
}

namespace {

// Position of a value along an axis, 0 at its low end and 1 at its high end.
double share_of(const Axis& axis, double value) {
    if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
    return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

// Counts equally spaced points of the chord from a to b that lie within width x height of a corner, in fractions of the
// panel. If the chord is broken, only its end counts.
std::size_t places_in_corner(const Panel& panel, const Point& a, const Point& b, const std::array<double, 2>& corner,
                             double width, double height) {
    constexpr double step = 0.02;
    constexpr double most = 100.0;
    const Point to{share_of(panel.x, b.x), share_of(panel.y, b.y)};
    Point from{share_of(panel.x, a.x), share_of(panel.y, a.y)};
    if (!std::isfinite(from.x) || !std::isfinite(from.y)) from = to;
    const double longer = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
    const int parts = std::isfinite(longer) ? 1 + static_cast<int>(std::min(longer / step, most)) : 1;
    std::size_t found = 0;
    for (int k = 1; k <= parts; ++k) {
        const double s = static_cast<double>(k) / parts;
        const double x = from.x + s * (to.x - from.x), y = from.y + s * (to.y - from.y);
        if (std::abs(x - corner[0]) < width && std::abs(y - corner[1]) < height) ++found;
    }
    return found;
}

}  // namespace

void place_legend(Panel& panel) {
    panel.legend = true;
    constexpr double width = 0.3, height = 0.3;  // maximum fractions of a panel that a legend covers
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (const std::array<double, 2> corner : {std::array{1.0, 1.0}, {0.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}) {
        std::size_t covered = 0;
        for (const Curve& curve : panel.curves)
            for (std::size_t i = 0; i < curve.points.size(); ++i)
                covered +=
                    places_in_corner(panel, curve.points[i > 0 ? i - 1 : i], curve.points[i], corner, width, height);
        if (covered >= least) continue;
        least = covered;
        panel.legend_at = corner;
    }
    if (least == 0) return;
    panel.legend_at = {1.0, 1.0};
    const double more = height / (1.0 - height);
    const double high = panel.y.logarithmic ? panel.y.high * std::pow(panel.y.high / panel.y.low, more)
                                            : panel.y.high + more * (panel.y.high - panel.y.low);
    set_ticks(panel.y, panel.y.low, high, 0.0);
}

Figure compose(const Trajectory& trajectory, std::span<const ViewDescription> views, const Theme& theme, int columns) {
    Figure figure;
    figure.columns = columns;
    figure.background = theme.background;
    figure.ink = theme.ink;
    figure.grid = theme.grid;
    const std::vector<Sample> samples = plot_samples(trajectory);
    for (const ViewDescription& view : views)
        figure.panels.push_back(compose(trajectory, samples, PreparedView(*trajectory.model, view), theme));
    return figure;
}

// ---- what a view plots: its expressions, their names and displayed units ----

std::string name_of(const ViewDescription& view) {
    std::string name;
    for (const Text& y : view.y) name += (name.empty() ? "" : ", ") + y.text;
    return view.x.text == "t" ? name : name + " over " + view.x.text;
}

std::string title_of(const ViewDescription& view) {
    const bool is_word = view.name == "gap";  // an ordinary word, shown as it is
    return view.name == name_of(view) && !is_word ? typeset(view.name) : view.name;
}

PreparedView::PreparedView(const Model& model, const ViewDescription& view)
    : title_(title_of(view)), label_(view.label) {
    std::vector<Text> texts{view.x};
    texts.insert(texts.end(), view.y.begin(), view.y.end());
    program_ = model.compile_view(texts);
    for (const Text& text : texts)
        quantities_.push_back(quantity(model.description(), text.text, quantities_.empty() ? "" : view.unit));
    constexpr std::size_t max_names = 3;
    for (std::size_t i = 1; i < quantities_.size() && view.label.empty() && view.y.size() <= max_names; ++i)
        label_ += (i > 1 ? ", " : "") + quantities_[i].label;
    if (!view.label.empty() && view.y.size() == 1) quantities_[1].label = view.label;
}

std::string PreparedView::unit() const {
    const auto other = [&](const ViewQuantity& quantity) { return quantity.unit != quantities_[1].unit; };
    return std::any_of(quantities_.begin() + 1, quantities_.end(), other) ? "" : quantities_[1].unit;
}

PreparedView::ViewQuantity PreparedView::quantity(const SystemDescription& description, const std::string& written,
                                                  const std::string& unit) {
    const std::size_t begin = std::min(written.find_first_not_of(' '), written.size());
    const std::string text = written.substr(begin, written.find_last_not_of(' ') + 1 - begin);
    ViewQuantity result{typeset(text), unit, 1.0, text == "t"};
    result.text = text;
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const CoordinateDescription& c = description.coordinates[i];
        if (text == c.name) result.coordinate = i;
        // The unit of a coordinate's rate is its unit per second, whatever that unit is called.
        if (unit.empty() && (text == c.name || text == c.name + "'")) result.unit = unit_of(description, text);
    }
    if (result.unit.empty()) result.unit = unit_of_expression(description, text);
    const ShownUnit shown = shown_unit(result.unit);
    result.unit = shown.text;
    result.factor = shown.factor;
    return result;
}

}  // namespace achilles
