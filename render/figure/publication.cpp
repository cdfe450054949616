#include "figure/publication.hpp"

#include <algorithm>
#include <array>

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
    if (kind == Event::Kind::impact) markers.edge.a = 0;
    return markers;
}

// Markers and dashes mean the same in every panel, so one legend tells them all; what does not occur is not in it.
std::vector<Key> keys_of(const Trajectory& trajectory, const std::vector<Panel>& panels, const Theme& theme) {
    std::vector<Key> keys;
    // Panels of several curves have hues of their own: there only the dash tells the phase.
    const bool hues = std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.legend; });
    for (const Phase::Kind kind : {Phase::Kind::hybrid, Phase::Kind::constrained}) {
        if (std::none_of(trajectory.phases.begin(), trajectory.phases.end(),
                         [&](const Phase& phase) { return phase.kind == kind; }))
            continue;
        Stroke stroke = phase_stroke(theme, kind, 0, 1);
        if (hues) stroke.color = theme.ink;
        keys.push_back({legend_text(kind), stroke});
    }
    for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release}) {
        if (std::none_of(trajectory.events.begin(), trajectory.events.end(),
                         [&](const Event& event) { return event.kind == kind; }))
            continue;
        const Markers markers = for_print(event_markers(theme, kind), kind);
        keys.push_back({markers.label + (kind == Event::Kind::zeno ? ", \U0001D70F_{\u221E}" : ""), markers});
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

Figure publication(const Trajectory& trajectory, std::span<const ViewDescription> views,
                   const PublicationStyle& style) {
    return publication(trajectory, compose(trajectory, views, light_theme(), 1).panels, style);
}

Figure publication(const Trajectory& trajectory, std::vector<Panel> panels, const PublicationStyle& style) {
    const Theme theme = light_theme();
    Figure figure = compose(trajectory, std::span<const ViewDescription>(), theme, 1);  // its colours
    figure.panels = std::move(panels);
    if (style.transparent) figure.background.a = 0;
    figure.grid.a = 0;
    figure.keys = keys_of(trajectory, figure.panels, theme);
    for (Panel& panel : figure.panels) {
        panel.legend_above = panel.legend;
        constexpr std::array kinds{Event::Kind::impact, Event::Kind::zeno, Event::Kind::release};
        for (std::size_t i = 0; i < panel.markers.size(); ++i) {
            panel.markers[i] = for_print(panel.markers[i], kinds[i]);
            panel.markers[i].label.clear();
        }
    }
    const bool lone = figure.panels.size() == 1;
    for (std::size_t i = 0; i < figure.panels.size(); ++i)
        figure.panels[i].title = lone ? "" : lettered(i, figure.panels[i].title);
    figure.columns = style.columns > 0 ? style.columns : figure.panels.empty() ? 1 : columns_for(figure.panels);
    share_axes(figure);
    return figure;
}

}  // namespace achilles
