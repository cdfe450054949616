#include "figure/publication.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "figure/axes.hpp"
#include "figure/grid.hpp"
#include "figure/label.hpp"
#include "figure/layout.hpp"
#include "output/contacts.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

bool same_axis(const Axis& a, const Axis& b) {
    return a.label == b.label && a.low == b.low && a.high == b.high && a.logarithmic == b.logarithmic;
}

int columns_for(const std::vector<Panel>& panels) {
    const bool one_axis = std::all_of(panels.begin(), panels.end(),
                                      [&](const Panel& panel) { return same_axis(panel.x, panels.front().x); });
    if (panels.size() == 1 || (panels.size() <= 3 && one_axis)) return 1;
    return panels.size() <= 6 ? 2 : 3;
}

// Markers smaller than on a screen. Impact markers have no edges, because edges of covered markers would leave odd
// shapes. The squares of collapses are hollow: their edge is what is seen.
Markers for_print(Markers markers, const Theme& theme) {
    const Color &fill = markers.fill, &paper = theme.background;
    const bool is_hollow = fill.r == paper.r && fill.g == paper.g && fill.b == paper.b;
    const bool is_impact = markers.shape == Markers::MarkerShape::square && !is_hollow;
    markers.size = is_impact ? 5.5 : 9.0;
    if (is_impact) markers.edge.a = 0, markers.apart = 1.3 * markers.size;
    if (markers.lift > 0.0) markers.lift = markers.size;
    return markers;
}

// Whether a phase of this look, or an event of this kind, occurs in any of the runs.
bool has_phase(std::span<const Trajectory* const> runs, PhaseLook look) {
    return std::any_of(runs.begin(), runs.end(), [&](const Trajectory* run) {
        return std::any_of(run->phases.begin(), run->phases.end(),
                           [&](const Phase& phase) { return look_of(*run->model, phase.kind, phase.mode) == look; });
    });
}

bool has_event(std::span<const Trajectory* const> runs, Event::Kind kind) {
    return std::any_of(runs.begin(), runs.end(), [&](const Trajectory* run) {
        return std::any_of(run->events.begin(), run->events.end(),
                           [&](const Event& event) { return event.kind == kind; });
    });
}

// Legend text about the contacts in a phase, for systems with several contacts, or joints with friction. Time bars show
// which of them are held, and which slide.
std::string about_contacts(std::span<const Trajectory* const> runs, const std::vector<Panel>& panels, PhaseLook look) {
    if (std::none_of(runs.begin(), runs.end(), [](const Trajectory* run) { return has_several_places(*run->model); }))
        return "";
    if (look == PhaseLook::flight) return ": no contact held";
    if (look == PhaseLook::stick) return ": nothing slides";
    const bool has_bars =
        std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return !panel.time_bars.empty(); });
    if (look == PhaseLook::slip) return has_bars ? ": the bars name what slides" : ": something slides";
    return has_bars ? ": the bars name the contacts held" : ": some are held";
}

// One legend for all panels, because markers and dashes mean the same in each. It has only what occurs in the runs.
std::vector<Key> keys_of(std::span<const Trajectory* const> runs, const std::vector<Panel>& panels,
                         const Theme& theme) {
    std::vector<Key> keys;
    // Panels with several curves have their own hues; only the dash shows the phase there.
    const bool hues = std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.legend; });
    for (const PhaseLook look : phase_looks) {
        if (!has_phase(runs, look)) continue;
        Stroke stroke = phase_stroke(theme, look, 0, 1);
        if (hues) stroke.color = theme.ink;
        keys.push_back({legend_text(look) + about_contacts(runs, panels, look), stroke});
    }
    const auto bounded = [](const Panel& panel) { return !panel.boundary.points.empty(); };
    if (const auto one = std::find_if(panels.begin(), panels.end(), bounded); one != panels.end())
        keys.push_back({typeset("gap") + " = 0", one->boundary.stroke});
    const std::string_view zeno = names_of(Event::Kind::zeno).name;
    for (const EventNames& names : event_names) {
        if (!has_event(runs, names.kind)) continue;
        std::string name = events_name(runs, names.kind);
        if (const std::size_t at = name.find(zeno); at != std::string::npos)
            name.insert(at + zeno.size(), ", \U0001D70F_{\u221E}");
        keys.push_back({name, for_print(event_markers(theme, names.kind), theme)});
    }
    const auto opens = [](const Event& event) { return event.is_impact() && !event.opened.empty(); };
    if (std::any_of(runs.begin(), runs.end(), [&](const Trajectory* run) {
            return std::any_of(run->events.begin(), run->events.end(), opens);
        })) {
        const Markers markers = for_print(opened_markers(theme), theme);
        keys.push_back({markers.label, markers});
    }
    for (const Panel& panel : panels) {
        if (panel.beyond.label.empty()) continue;
        Stroke stroke = phase_stroke(theme, Phase::Kind::constrained, 0, 1);
        stroke.color = theme.ink;
        stroke.color.a = pale_beyond;
        keys.push_back({panel.beyond.label, stroke});
        break;
    }
    return keys;
}

// Quality of the arrangement of a figure's panels: the sum of the logarithms of their areas and of the fractions of
// their cells that they fill. With logarithms, doubling one area balances halving another.
double ease(Figure figure, double shape) {
    constexpr float height = 800.0F;
    const auto measure = [](const std::string& label, float size) {
        return 0.5F * size * static_cast<float>(letters(label).size());
    };
    share_axes(figure);
    const Rectangle page{0.0F, 0.0F, static_cast<float>(shape) * height, height};
    double sum = 0.0;
    const auto area = [](const Rectangle& r) { return std::max(double{r.width} * double{r.height}, 1e-9); };
    for (const PlotArea& at : plot_areas(figure, measure, page, publication_scale))
        sum += std::log(area(at.plot)) + std::log(area(at.plot) / area(at.place));
    return sum;
}

Figure with_path(Figure figure, std::size_t from, std::size_t to, int rows) {
    figure.panels[from].rows = rows;
    const auto at = [&](std::size_t i) { return figure.panels.begin() + static_cast<std::ptrdiff_t>(i); };
    std::rotate(at(to), at(from), at(from + 1));
    return figure;
}

// Places a single path with equal axes beside several rows of other panels, which fill the remaining cells, if this
// gives the panels more space.
void set_path(Figure& figure, const PublicationStyle& style) {
    constexpr double worth_it = 0.1;
    const auto is_path = [](const Panel& panel) { return panel.equal_axes; };
    auto& panels = figure.panels;
    const std::size_t n = panels.size(), columns = static_cast<std::size_t>(figure.columns);
    if (n < 3 || columns < 2 || std::count_if(panels.begin(), panels.end(), is_path) != 1) return;
    const auto path = static_cast<std::size_t>(std::find_if(panels.begin(), panels.end(), is_path) - panels.begin());
    const std::size_t place = style.ordered ? path : 0;
    Figure bare = figure;  // copied for each arrangement, so without content that has no effect on the layout
    for (Panel& panel : bare.panels)
        panel.boundary = {}, panel.beyond = {}, panel.curves.clear(), panel.markers.clear();
    double best = ease(bare, style.shape) + worth_it;
    int rows = 1;
    for (std::size_t all = (n + columns - 1) / columns; all < n; ++all) {
        const std::size_t tall = columns * all - (n - 1);
        if (tall < 2 || tall > all || place / columns + tall > all) continue;
        const double here = ease(with_path(bare, path, place, static_cast<int>(tall)), style.shape);
        if (here > best) best = here, rows = static_cast<int>(tall);
    }
    if (rows > 1) figure = with_path(std::move(figure), path, place, rows);
}

}  // namespace

std::string lettered(std::size_t i, const std::string& name) {
    std::string letter;
    for (++i; i > 0; i = (i - 1) / 26) letter.insert(letter.begin(), static_cast<char>('a' + (i - 1) % 26));
    return "(" + letter + ")" + (name.empty() ? "" : "\u00A0\u00A0" + name);
}

void share_axes(Figure& figure) {
    std::vector<Panel>& panels = figure.panels;
    const std::vector<Cell> cells = cells_of(figure);
    const auto shares = [&](std::size_t i) {
        for (std::size_t below = i + 1; below < cells.size(); ++below)
            if (cells[below].column == cells[i].column && cells[below].row == cells[i].row + 1)
                return same_axis(panels[i].x, panels[below].x);
        return false;
    };
    std::map<std::size_t, bool> shared;  // by row
    // If one panel of a row needs space for its labels, the whole row has it. Then all labels are kept for a regular
    // grid.
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i].rows == 1)
            shared[cells[i].row] = shared.try_emplace(cells[i].row, true).first->second && shares(i);
    for (std::size_t i = 0; i < cells.size(); ++i) panels[i].x.labeled = cells[i].rows > 1 || !shared[cells[i].row];
}

void apply_print_style(Figure& figure, std::span<const Trajectory* const> runs, const Theme& theme) {
    figure.grid.a = 0;
    figure.smallest_text = 0.9;  // 7 points on a page
    figure.keys = keys_of(runs, figure.panels, theme);
    for (Panel& panel : figure.panels) {
        panel.legend_above = panel.legend;
        for (Markers& markers : panel.markers) {
            markers = for_print(markers, theme);
            markers.label.clear();
        }
        for (Markers& markers : panel.beyond.markers) {
            const auto alpha = markers.fill.a;
            markers = for_print(markers, theme);
            markers.fill.a = alpha;
        }
    }
}

Figure publication(const Trajectory& trajectory, std::span<const ViewDescription> views, const PublicationStyle& style,
                   const Proof* proof, std::optional<double> horizon) {
    const Theme theme = style.dark ? dark_theme() : light_theme();
    const std::vector<Sample> samples = plot_samples(trajectory);
    Framing framing;
    framing.for_print = true;
    framing.size = style.size;
    std::vector<Panel> panels;
    for (const ViewDescription& view : views) {
        const PreparedView prepared(*trajectory.model, view);
        panels.push_back(compose(trajectory, samples, prepared, theme, framing, horizon));
        if (proof != nullptr)
            panels.back() = with_proof(std::move(panels.back()), trajectory, *proof, prepared, framing, theme);
    }
    Figure figure = publication(trajectory, std::move(panels), style);
    if (proof != nullptr) name_proof(figure, *proof, theme);
    return figure;
}

Figure publication(const Trajectory& trajectory, std::vector<Panel> panels, const PublicationStyle& style) {
    const Theme theme = style.dark ? dark_theme() : light_theme();
    Figure figure;
    figure.background = theme.background;
    figure.ink = theme.ink;
    figure.panels = std::move(panels);
    if (style.transparent) figure.background.a = 0;
    const Trajectory* const run = &trajectory;
    apply_print_style(figure, {&run, 1}, theme);
    figure.columns = style.columns > 0 ? style.columns : figure.panels.empty() ? 1 : columns_for(figure.panels);
    if (style.columns == 0) set_path(figure, style);
    share_axes(figure);
    const bool lone = figure.panels.size() == 1;
    for (std::size_t i = 0; i < figure.panels.size(); ++i)
        figure.panels[i].title = lone ? "" : lettered(i, figure.panels[i].title);
    return figure;
}

// ---- a periodic orbit and its branch ----

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> unstable_dash{5.0, 3.0};

// Special points of one kind along a branch, and their marker.
struct BranchEvents {
    const std::vector<OrbitPoint>* points;
    Markers markers;
};

// Hollow markers, to be distinct from events of a run.
Markers marked(const Theme& theme, const char* label, Markers::MarkerShape shape, double size) {
    Markers markers;
    markers.label = label;
    markers.shape = shape;
    markers.fill = theme.background;
    markers.edge = theme.ink;
    markers.size = size;
    return markers;
}

std::vector<BranchEvents> branch_events(const Branch& branch, const Theme& theme) {
    using MarkerShape = Markers::MarkerShape;
    return {{&branch.folds, marked(theme, "fold", MarkerShape::square, 7.0)},
            {&branch.flips, marked(theme, "period doubling, \U0001D707 = \u22121", MarkerShape::circle, 8.0)},
            {&branch.neimark_sacker, marked(theme, "|\U0001D707| = 1, complex", MarkerShape::triangle, 9.0)},
            {&branch.zeno_lost, marked(theme, "Zeno point lost", MarkerShape::diamond, 10.0)}};
}

using Value = std::function<double(const OrbitPoint&)>;

// One quantity along the branch as two curves, one for stable and one for unstable orbits. They meet where stability
// changes.
void trace(Panel& panel, const Branch& branch, const Color& color, const Value& value) {
    Curve curves[2];
    curves[0].stroke = {color, 1.6, {}};
    curves[1].stroke = {color, 1.6, unstable_dash};
    const OrbitPoint* before = nullptr;
    for (const OrbitPoint& point : branch.points) {
        const Point at{branch.value(point), value(point)};
        std::vector<Point>& points = curves[point.stable ? 0 : 1].points;
        if (before != nullptr && before->stable != point.stable) {
            points.push_back({no_number, no_number});
            points.push_back({branch.value(*before), value(*before)});
        }
        points.push_back(at);
        before = &point;
    }
    for (Curve& curve : curves)
        if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
}

void add_branch_events(Panel& panel, const Branch& branch, const Theme& theme, const Value& value) {
    for (BranchEvents& happening : branch_events(branch, theme)) {
        for (const OrbitPoint& point : *happening.points)
            happening.markers.points.push_back({branch.value(point), value(point)});
        happening.markers.label.clear();
        if (!happening.markers.points.empty()) panel.markers.push_back(std::move(happening.markers));
    }
}

// Fits the y axis to the curves.
void fit(Panel& panel, const std::array<double, 2>& x) {
    double low = no_number, high = no_number;
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
        if (orbit_.is_autonomous) panels.push_back(of("period (s)", [](const OrbitPoint& p) { return p.period; }));
        panels.push_back(of_multipliers());
        const auto has_margin = [](const OrbitPoint& point) { return point.margins.a_inf.has_value(); };
        if (std::any_of(branch_.points.begin(), branch_.points.end(), has_margin))
            panels.push_back(of("\U0001D44E_{\u221E}",
                                [](const OrbitPoint& point) { return point.margins.a_inf.value_or(no_number); }));
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
        add_branch_events(panel, branch_, theme_, value);
        return with_values(std::move(panel), value);
    }
    BranchPanel of_state() const {
        const CoordinateDescription& first = description_.coordinates.front();
        const std::string where = orbit_.is_at_release   ? " at the release"
                                  : orbit_.is_autonomous ? " on the section"
                                                         : fmt::format(" at t = {:.4g} s", orbit_.state.t);
        const ShownUnit unit = shown_unit(first.unit);
        return of(with_unit(typeset(first.name) + where, unit.text),
                  [factor = unit.factor](const OrbitPoint& point) { return factor * point.state.q[0]; });
    }
    // Magnitudes of the multipliers, without the one along the flow and those that are zero.
    BranchPanel of_multipliers() const {
        Panel panel = begun("|\U0001D707|");
        panel.title = "multipliers";
        const std::size_t first = orbit_.is_autonomous ? 1 : 0;
        std::size_t most = 0;
        for (const OrbitPoint& point : branch_.points)
            most = std::max(most, point.multipliers.size() - point.zero_multipliers);
        const auto size_of = [](std::size_t i) -> Value {
            return [i](const OrbitPoint& point) {
                return i < point.multipliers.size() ? std::abs(point.multipliers[i]) : no_number;
            };
        };
        for (std::size_t i = first; i < std::max(most, first + 1); ++i) {
            const Value size = size_of(i);
            trace(panel, branch_, phase_stroke(theme_, Phase::Kind::constrained, i - first, most - first + 1).color,
                  size);
            if (i == first) add_branch_events(panel, branch_, theme_, size);
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
    for (const BranchEvents& happening : branch_events(branch, theme))
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
    apply_print_style(figure, {&run, 1}, theme);
    const std::vector<Key> more = branch_keys(branch, theme);
    figure.keys.insert(figure.keys.end(), more.begin(), more.end());
    figure.panels.insert(figure.panels.begin(), std::make_move_iterator(along.begin()),
                         std::make_move_iterator(along.end()));
    figure.columns = style.columns > 0 ? style.columns : 2;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) figure.panels[i].title = lettered(i, figure.panels[i].title);
    return figure;
}

}  // namespace achilles
