#include "figure/publication.hpp"

#include <algorithm>
#include <array>

#include "figure/label.hpp"
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

// "(a)", or "(a) height" where the view has a name.
std::string lettered(std::size_t i, const std::string& name) {
    std::string letter;
    for (++i; i > 0; i = (i - 1) / 26) letter.insert(letter.begin(), static_cast<char>('a' + (i - 1) % 26));
    return "(" + letter + ")" + (name.empty() ? "" : "\u00A0\u00A0" + name);
}

// Smaller than on a screen. Impacts crowd: rims would leave odd shapes of those that others cover.
Markers for_print(Markers markers, Event::Kind kind) {
    markers.size = kind == Event::Kind::impact ? 5.5 : 9.0;
    if (kind == Event::Kind::impact) markers.edge.a = 0, markers.apart = 1.3 * markers.size;
    return markers;
}

// Whether a phase or an event of that kind occurs in any of the runs.
template <class Thing>
bool any_of(std::span<const Trajectory* const> runs, std::vector<Thing> Trajectory::*things,
            typename Thing::Kind kind) {
    return std::any_of(runs.begin(), runs.end(), [&](const Trajectory* run) {
        return std::any_of((run->*things).begin(), (run->*things).end(),
                           [&](const Thing& thing) { return thing.kind == kind; });
    });
}

// Markers and dashes mean the same in every panel, so one legend tells them all; what does not occur is not in it.
std::vector<Key> keys_of(std::span<const Trajectory* const> runs, const std::vector<Panel>& panels,
                         const Theme& theme) {
    std::vector<Key> keys;
    // Panels of several curves have hues of their own: there only the dash tells the phase.
    const bool hues = std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.legend; });
    for (const Phase::Kind kind : {Phase::Kind::hybrid, Phase::Kind::constrained}) {
        if (!any_of(runs, &Trajectory::phases, kind)) continue;
        Stroke stroke = phase_stroke(theme, kind, 0, 1);
        if (hues) stroke.color = theme.ink;
        keys.push_back({legend_text(kind), stroke});
    }
    const auto bounded = [](const Panel& panel) { return !panel.boundary.points.empty(); };
    if (const auto one = std::find_if(panels.begin(), panels.end(), bounded); one != panels.end())
        keys.push_back({typeset("gap") + " = 0", one->boundary.stroke});
    for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release}) {
        if (!any_of(runs, &Trajectory::events, kind)) continue;
        std::string name = events_name(runs, kind);
        const std::string zeno = event_markers(theme, Event::Kind::zeno).label;
        if (const std::size_t at = name.find(zeno); at != std::string::npos)
            name.insert(at + zeno.size(), ", \U0001D70F_{\u221E}");
        keys.push_back({name, for_print(event_markers(theme, kind), kind)});
    }
    return keys;
}

}  // namespace

void share_axes(Figure& figure) {
    const auto columns = static_cast<std::size_t>(std::max(figure.columns, 1));
    const std::vector<Panel>& panels = figure.panels;
    for (std::size_t row = 0; row < panels.size(); row += columns) {
        // A row with room for one panel's labels has it for all: then they stay, and the grid looks even.
        bool shared = true;
        for (std::size_t i = row; i < std::min(row + columns, panels.size()); ++i)
            shared = shared && i + columns < panels.size() && same_axis(panels[i].x, panels[i + columns].x);
        for (std::size_t i = row; i < std::min(row + columns, panels.size()); ++i)
            figure.panels[i].x.labelled = !shared;
    }
}

void dress_for_print(Figure& figure, std::span<const Trajectory* const> runs) {
    figure.grid.a = 0;
    figure.smallest_text = 0.9;  // 7 points on a page
    figure.keys = keys_of(runs, figure.panels, light_theme());
    for (Panel& panel : figure.panels) {
        panel.legend_above = panel.legend;
        constexpr std::array kinds{Event::Kind::impact, Event::Kind::zeno, Event::Kind::release};
        for (std::size_t i = 0; i < panel.markers.size(); ++i) {
            panel.markers[i] = for_print(panel.markers[i], kinds[i]);
            panel.markers[i].label.clear();
        }
    }
}

Figure publication(const Trajectory& trajectory, std::span<const ViewDescription> views,
                   const PublicationStyle& style) {
    const Theme theme = light_theme();
    const std::vector<Sample> samples = plot_samples(trajectory);
    Framing framing;
    framing.for_print = true;
    std::vector<Panel> panels;
    for (const ViewDescription& view : views)
        panels.push_back(compose(trajectory, samples, PreparedView(*trajectory.model, view), theme, framing));
    return publication(trajectory, std::move(panels), style);
}

Figure publication(const Trajectory& trajectory, std::vector<Panel> panels, const PublicationStyle& style) {
    const Theme theme = light_theme();
    Figure figure;
    figure.background = theme.background;
    figure.ink = theme.ink;
    figure.panels = std::move(panels);
    if (style.transparent) figure.background.a = 0;
    const Trajectory* const run = &trajectory;
    dress_for_print(figure, {&run, 1});
    const bool lone = figure.panels.size() == 1;
    for (std::size_t i = 0; i < figure.panels.size(); ++i)
        figure.panels[i].title = lone ? "" : lettered(i, figure.panels[i].title);
    figure.columns = style.columns > 0 ? style.columns : figure.panels.empty() ? 1 : columns_for(figure.panels);
    share_axes(figure);
    return figure;
}

}  // namespace achilles
