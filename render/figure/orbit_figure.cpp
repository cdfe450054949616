#include "figure/orbit_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "figure/label.hpp"
#include "figure/shown_unit.hpp"
#include "figure/ticks.hpp"

namespace achilles {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> unstable_dash{5.0, 3.0};

// What happens along a branch, each with its sign.
struct Happening {
    const std::vector<OrbitPoint>* points;
    Markers markers;
};

// Hollow, so that none is taken for an event of a run.
Markers marked(const Theme& theme, const char* label, Markers::Shape shape, double size) {
    Markers markers;
    markers.label = label;
    markers.shape = shape;
    markers.fill = theme.background;
    markers.edge = theme.ink;
    markers.size = size;
    return markers;
}

std::vector<Happening> happenings(const Branch& branch, const Theme& theme) {
    using Shape = Markers::Shape;
    return {{&branch.folds, marked(theme, "fold", Shape::square, 7.0)},
            {&branch.flips, marked(theme, "period doubling, \U0001D707 = \u22121", Shape::circle, 8.0)},
            {&branch.circles, marked(theme, "|\U0001D707| = 1, complex", Shape::triangle, 9.0)},
            {&branch.lost, marked(theme, "Zeno point lost", Shape::diamond, 10.0)}};
}

using Value = std::function<double(const OrbitPoint&)>;

// One quantity along the branch: two curves, one of what is stable, one of what is not, that meet where it changes.
void trace(Panel& panel, const Branch& branch, const Color& color, const Value& value) {
    Curve curves[2];
    curves[0].stroke = {color, 1.6, {}};
    curves[1].stroke = {color, 1.6, unstable_dash};
    const OrbitPoint* before = nullptr;
    for (const OrbitPoint& point : branch.points) {
        const Point at{branch.value(point), value(point)};
        std::vector<Point>& points = curves[point.stable ? 0 : 1].points;
        if (before != nullptr && before->stable != point.stable) {
            points.push_back({nan, nan});
            points.push_back({branch.value(*before), value(*before)});
        }
        points.push_back(at);
        before = &point;
    }
    for (Curve& curve : curves)
        if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
}

void add_happenings(Panel& panel, const Branch& branch, const Theme& theme, const Value& value) {
    for (Happening& happening : happenings(branch, theme)) {
        for (const OrbitPoint& point : *happening.points)
            happening.markers.points.push_back({branch.value(point), value(point)});
        happening.markers.label.clear();
        if (!happening.markers.points.empty()) panel.markers.push_back(std::move(happening.markers));
    }
}

// From the least to the greatest of what is drawn.
void fit(Panel& panel, const std::array<double, 2>& x) {
    double low = nan, high = nan;
    for (const Curve& curve : panel.curves)
        for (const Point& point : curve.points) {
            low = std::fmin(low, point.y);
            high = std::fmax(high, point.y);
        }
    set_ticks(panel.x, x[0], x[1], 0.03);
    set_ticks(panel.y, low, high, 0.06);
}

Curve level(const Theme& theme, const std::array<double, 2>& x, double y) {
    Curve line;
    line.stroke = {theme.surface, 0.8, {}};
    line.points = {{x[0], y}, {x[1], y}};
    return line;
}

class BranchPanels {
 public:
    BranchPanels(const Orbit& orbit, const Branch& branch, const Theme& theme)
        : orbit_(orbit), branch_(branch), theme_(theme), description_(orbit.run.model->description()) {
        x_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const OrbitPoint& point : branch.points)
            x_ = {std::min(x_[0], branch.value(point)), std::max(x_[1], branch.value(point))};
        const ParameterDescription& parameter = description_.parameters[branch.parameter];
        x_label_ = with_unit(typeset(parameter.name), typeset_unit(parameter.unit));
    }

    std::vector<BranchPanel> all() const {
        std::vector<BranchPanel> panels{of_state()};
        if (orbit_.has_flow) panels.push_back(of("period (s)", [](const OrbitPoint& p) { return p.period; }));
        panels.push_back(of_multipliers());
        const auto has_margin = [](const OrbitPoint& point) { return point.margins.a_inf.has_value(); };
        if (std::any_of(branch_.points.begin(), branch_.points.end(), has_margin))
            panels.push_back(
                of("\U0001D44E_{\u221E}", [](const OrbitPoint& point) { return point.margins.a_inf.value_or(nan); }));
        return panels;
    }

 private:
    Panel begun(const std::string& label) const {
        Panel panel;
        panel.x.label = x_label_;
        panel.y.label = label;
        return panel;
    }
    BranchPanel with_values(Panel panel, const Value& value) const {
        BranchPanel whole{std::move(panel), {}};
        for (const OrbitPoint& point : branch_.points) whole.values.push_back(value(point));
        return whole;
    }
    BranchPanel of(const std::string& label, const Value& value) const {
        Panel panel = begun(label);
        trace(panel, branch_, phase_color(theme_, Phase::Kind::hybrid), value);
        fit(panel, x_);
        add_happenings(panel, branch_, theme_, value);
        return with_values(std::move(panel), value);
    }
    BranchPanel of_state() const {
        const CoordinateDescription& first = description_.coordinates.front();
        const std::string where = orbit_.is_at_release ? " at the release"
                                  : orbit_.has_flow    ? " on the section"
                                                       : fmt::format(" at t = {:.4g} s", orbit_.state.t);
        const ShownUnit unit = shown_unit(first.unit);
        return of(with_unit(typeset(first.name) + where, unit.text),
                  [factor = unit.factor](const OrbitPoint& point) { return factor * point.state.q[0]; });
    }
    // Sizes, of all but the flow's and the zeros.
    BranchPanel of_multipliers() const {
        Panel panel = begun("|\U0001D707|");
        panel.title = "multipliers";
        const std::size_t first = orbit_.has_flow ? 1 : 0;
        std::size_t most = 0;
        for (const OrbitPoint& point : branch_.points)
            most = std::max(most, point.multipliers.size() - point.zero_multipliers);
        const auto size_of = [](std::size_t i) -> Value {
            return [i](const OrbitPoint& point) {
                return i < point.multipliers.size() ? std::abs(point.multipliers[i]) : nan;
            };
        };
        for (std::size_t i = first; i < std::max(most, first + 1); ++i) {
            const Value size = size_of(i);
            trace(panel, branch_, phase_stroke(theme_, Phase::Kind::constrained, i - first, most - first + 1).color,
                  size);
            if (i == first) add_happenings(panel, branch_, theme_, size);
        }
        fit(panel, x_);
        if (panel.y.low < 1.0 && panel.y.high > 1.0)
            panel.curves.insert(panel.curves.begin(), level(theme_, {panel.x.low, panel.x.high}, 1.0));
        return with_values(std::move(panel), size_of(first));
    }

    const Orbit& orbit_;
    const Branch& branch_;
    const Theme& theme_;
    const SystemDescription& description_;
    std::array<double, 2> x_;
    std::string x_label_;
};

}  // namespace

std::vector<BranchPanel> branch_panels(const Orbit& orbit, const Branch& branch, const Theme& theme) {
    return BranchPanels(orbit, branch, theme).all();
}

std::vector<Key> branch_keys(const Branch& branch, const Theme& theme) {
    std::vector<Key> keys;
    for (const bool stable : {true, false})
        if (std::any_of(branch.points.begin(), branch.points.end(),
                        [&](const OrbitPoint& point) { return point.stable == stable; }))
            keys.push_back({stable ? "stable" : "not stable",
                            Stroke{theme.ink, 1.6, stable ? std::vector<double>{} : unstable_dash}});
    for (const Happening& happening : happenings(branch, theme))
        if (!happening.points->empty()) keys.push_back({happening.markers.label, happening.markers});
    return keys;
}

Figure compose_branch(const Orbit& orbit, const Branch& branch, std::span<const ViewDescription> views,
                      const PublicationStyle& style) {
    const Theme theme = style.dark ? dark_theme() : light_theme();
    Figure figure;
    figure.background = theme.background;
    figure.ink = theme.ink;
    if (style.transparent) figure.background.a = 0;
    std::vector<Panel> along;
    for (BranchPanel& one : branch_panels(orbit, branch, theme)) along.push_back(std::move(one.panel));
    if (!views.empty()) {
        const std::vector<Sample> samples = plot_samples(orbit.run);
        Framing framing;
        framing.for_print = true;
        figure.panels.push_back(
            compose(orbit.run, samples, PreparedView(*orbit.run.model, views.front()), theme, framing));
        Panel& period = figure.panels.back();
        const ParameterDescription& parameter = orbit.run.model->description().parameters[branch.parameter];
        period.title =
            fmt::format("one period, {} = {:.6g}", typeset(parameter.name), orbit.parameters[branch.parameter]);
    }
    const Trajectory* const run = &orbit.run;
    dress_for_print(figure, {&run, 1}, theme);
    const std::vector<Key> more = branch_keys(branch, theme);
    figure.keys.insert(figure.keys.end(), more.begin(), more.end());
    figure.panels.insert(figure.panels.begin(), std::make_move_iterator(along.begin()),
                         std::make_move_iterator(along.end()));
    figure.columns = style.columns > 0 ? style.columns : 2;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) figure.panels[i].title = lettered(i, figure.panels[i].title);
    return figure;
}

}  // namespace achilles
