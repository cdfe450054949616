#include "session/arrangement.hpp"

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

// Lengths at scale 1. The minimum sizes keep panels readable.
constexpr float margin = 10.0F, gap = 10.0F, min_controls = 240.0F, min_editor = 320.0F, min_center = 340.0F,
                min_plots = 240.0F, min_events = 110.0F, min_study = 150.0F, min_top = 240.0F, min_picture = 90.0F,
                min_plane = 230.0F, min_world = 90.0F;
// In a narrower window the panels are tabs.
constexpr float min_window = 1000.0F;

// The size set by the user or, without one, the preferred size; rounded down to whole pixels and clamped to [least,
// most].
float size_of(double share, float whole, float fitting, float least, float most) {
    const float wanted = share > 0.0 ? static_cast<float>(share) * whole : fitting;
    return std::floor(std::max(0.0F, std::min(std::max(wanted, least), std::max(most, 0.0F))));
}

// The energy panel: with its time plot, without it if the picture above would be too low, or hidden.
float energy_in(const Measures& m, float room) {
    if (m.energy <= room) return m.energy;
    return m.min_energy <= room ? m.min_energy : 0.0F;
}

// Where the next part begins, below this one.
float below(const Rectangle& part, const Measures& m) {
    const double end = part.y + part.height, space = part.height > 0.0 ? 0.6 * double{gap * m.unit} : 0.0;
    return static_cast<float>(end + space);
}

// The caption of a tour, from `top` on; returns where the next part begins. There, in front of it, is the message: it
// comes and goes, and nothing moves.
float place_messages(Arrangement& parts, const Measures& m, float x, float top, float width, float bottom) {
    parts.caption = {x, top, width, std::clamp(m.caption ? m.caption(width) : 0.0F, 0.0F, bottom - top)};
    const float next = std::min(below(parts.caption, m), bottom);
    parts.error = {x, next, width, std::min(m.error ? m.error(width) : 0.0F, bottom - next)};
    return next;
}

// Minimum height of the mechanism's panel: numbers and heading above the axes, and the picture itself.
float least_picture(const Scene& scene, const Measures& m, float width) {
    return std::max((scene.shows("plane") ? min_plane : min_picture) * m.unit,
                    (m.state ? m.state(width) : 0.0F) + min_world * m.unit);
}

// The mechanism with its results, energy and player, one below the other. The picture takes precedence: if it would be
// too low, the results shrink, and in the end the player goes.
void place_mechanism(Arrangement& parts, const Scene& scene, const Measures& m, const Rectangle& column) {
    const float between = gap * m.unit, space = 0.4F * between, x = column.x, width = column.width;
    const float bottom = column.y + column.height, least = least_picture(scene, m, width);
    const float player = std::min(m.timeline, column.height);
    const float timeline = column.height - player - between >= 0.5F * min_world * m.unit ? player : 0.0F;
    const float lower = timeline > 0.0F ? bottom - timeline - between : bottom;
    const float all_results = m.results ? m.results(width) : 0.0F;
    float results = std::clamp(all_results, 0.0F, std::max(0.0F, lower - column.y - least));
    if (results < 0.6F * all_results) results = 0.0F;  // less than one line and its margins
    const float over_results = results > 0.0F ? space : 0.0F;
    const float energy = energy_in(m, lower - results - over_results - space - column.y - least);
    const float under = lower - (energy > 0.0F ? energy + space : 0.0F);
    parts.mechanism = {x, column.y, width, std::max(0.0F, under - results - over_results - column.y)};
    parts.results = {x, under - results, width, results};
    parts.energy = {x, lower - energy, width, energy};
    parts.timeline = {x, bottom - timeline, width, timeline};
}

// The gap on the left of the plots, or above the events.
void add_splitter(Arrangement& parts, const Measures& m, const char* panel, const Rectangle& of) {
    const float between = gap * m.unit;
    const double half = 0.5 * double{between};
    const bool is_of_plots = std::string_view(panel) == "plots";
    const Rectangle area = is_of_plots ? Rectangle{of.x - between, of.y, between, of.height}
                                       : Rectangle{of.x, of.y - between, of.width, between};
    const double end = is_of_plots ? of.x + of.width : of.y + of.height;
    parts.splitters.push_back({panel, area, is_of_plots, end - half, -double{is_of_plots ? m.width : m.height}});
}

// The panel in front where the panels are tabs: the one that was shown last. Beside the mechanism there is always one.
std::string front_of(const Scene& scene, bool is_beside) {
    const std::string& last = scene.front();
    if (last == "editor" || last == "controls") return "controls";
    if (last == "plots") return last;
    if (last != "mechanism") return scene.below();
    if (!is_beside) return last;
    if (scene.shows("editor") || scene.shows("controls")) return "controls";
    if (scene.shows("plots")) return "plots";
    return scene.below().empty() ? last : scene.below();
}

// A window too narrow or too low for all panels: one row of tabs. Controls and plots are beside the mechanism, events
// and studies below it; without the room for both, the panel in front is alone with the player.
Arrangement arrange_tabs(const Scene& scene, const Measures& m) {
    const float u = m.unit, edge = margin * u, between = gap * u, inside = std::max(0.0F, m.width - 2.0F * edge);
    const float bottom = std::max(m.bar, m.height - m.status - 0.6F * between), beside = min_center * u + between;
    Arrangement parts;
    parts.bar = {0.0F, 0.0F, m.width, m.bar};
    parts.status = {0.0F, std::max(0.0F, m.height - m.status), m.width, m.status};
    parts.is_alone = inside < beside + min_plots * u;
    parts.front = front_of(scene, !parts.is_alone);
    parts.tabs = {edge, m.bar, inside, std::min(m.tabs, bottom - m.bar)};
    const float top = place_messages(parts, m, edge, std::min(below(parts.tabs, m), bottom), inside, bottom);
    const float height = bottom - top;
    const bool is_study = parts.front != "controls" && parts.front != "plots";
    Rectangle& panel = is_study ? parts.events : parts.front == "plots" ? parts.plots : parts.controls;
    const float least = (parts.front == "controls" && scene.shows("editor") ? min_editor : min_plots) * u;
    if (parts.front == "mechanism") {
        place_mechanism(parts, scene, m, {edge, top, inside, height});
    } else if (!is_study && inside >= beside + least) {
        const float width = size_of(scene.share("plots"), m.width, 0.45F * inside, least, inside - beside);
        panel = {edge + inside - width, top, width, height};
        place_mechanism(parts, scene, m, {edge, top, inside - width - between, height});
        add_splitter(parts, m, "plots", panel);
    } else if (is_study && height >= (min_top + min_study) * u + between) {
        const float low =
            size_of(scene.share("events"), m.height, 0.45F * height, min_study * u, height - between - min_top * u);
        panel = {edge, bottom - low, inside, low};
        place_mechanism(parts, scene, m, {edge, top, inside, height - low - between});
        add_splitter(parts, m, "events", panel);
    } else {
        const float timeline = height >= m.timeline + between + min_study * u ? m.timeline : 0.0F;
        panel = {edge, top, inside, height - (timeline > 0.0F ? timeline + between : 0.0F)};
        parts.timeline = {edge, bottom - timeline, inside, timeline};
    }
    return parts;
}

// Lecture: the title, the mechanism beside one plot, up to three sliders and the player; nothing else, unless the energy
// was asked for.
Arrangement arrange_lecture(const Scene& scene, const Measures& m) {
    const float edge = margin * m.unit, between = gap * m.unit, inside = std::max(0.0F, m.width - 2.0F * edge);
    const float bottom = std::max(0.0F, m.height - edge);
    Arrangement parts;
    parts.title = {edge, edge, inside, std::min(m.title, bottom - edge)};
    const float top = place_messages(parts, m, edge, std::min(below(parts.title, m), bottom), inside, bottom);
    const float timeline = std::min(m.timeline, bottom - top), lower = bottom - timeline;
    const float left_over = lower - between - top - min_picture * m.unit;
    const float sliders = m.sliders <= left_over ? m.sliders : 0.0F;
    const float above = sliders > 0.0F ? sliders + 0.4F * between : 0.0F;
    const float energy = energy_in(m, left_over - above - 0.4F * between - min_picture * m.unit),
                below_sliders = energy > 0.0F ? energy + 0.4F * between : 0.0F;
    const float height = std::max(0.0F, lower - between - top - above - below_sliders);
    const bool has_plots = scene.shows("plots") || scene.shows("sweep");
    const float right = has_plots ? std::floor(0.48F * (inside - between)) : 0.0F;
    const float center = inside - (has_plots ? right + between : 0.0F);
    parts.mechanism = {edge, top, center, height};
    // A visible sweep replaces the plot.
    (scene.shows("sweep") ? parts.sweep : parts.plots) = {edge + center + between, top, right, height};
    parts.sliders = {edge, lower - between - below_sliders - sliders, inside, sliders};
    parts.energy = {edge, lower - between - energy, inside, energy};
    parts.timeline = {edge, lower, inside, timeline};
    return parts;
}

}  // namespace

Arrangement arrange(const Scene& scene, const Measures& m) {
    if (scene.presents()) return arrange_lecture(scene, m);
    const float u = m.unit, edge = margin * u, between = gap * u;
    const float least_height = m.bar + m.status + (min_top + min_events) * u + 2.0F * between;
    if (m.width < min_window * u || m.height < least_height) return arrange_tabs(scene, m);
    const bool editor = scene.shows("editor"), has_left = editor || scene.shows("controls");
    const bool has_plots = scene.shows("plots");
    const bool has_events = !scene.below().empty();
    const float top = m.bar, bottom = std::max(top, m.height - m.status - 0.6F * between);
    Arrangement parts;
    parts.bar = {0.0F, 0.0F, m.width, m.bar};
    parts.status = {0.0F, std::max(0.0F, m.height - m.status), m.width, m.status};
    const float inside = std::max(0.0F, m.width - 2.0F * edge), all = bottom - top;

    const std::string left_panel = editor ? "editor" : "controls";
    const float min_left = (editor ? min_editor : min_controls) * u;
    const float others = (min_center + (has_plots ? min_plots : 0.0F)) * u + 2.0F * between;
    // Room for the lines of the text.
    const float fitting = editor ? std::min(std::max(0.36F * m.width, 420.0F * u), 0.6F * m.width)
                                 : std::clamp(0.2F * m.width, 272.0F * u, 320.0F * u);
    const float left = has_left ? size_of(scene.share(left_panel), m.width, fitting, min_left, inside - others) : 0.0F;
    // Space for a certificate and for the curve of a sweep. The same for the events and for every study, so that nothing
    // jumps when another one is shown.
    const float fitting_events = std::clamp(0.43F * m.height - 100.0F * u, 180.0F * u, 330.0F * u);
    const float low =
        has_events ? size_of(scene.share("events"), m.height, fitting_events, min_events * u, all - min_top * u) : 0.0F;
    const float height = std::max(0.0F, all - (low > 0.0F ? low + between : 0.0F));
    const float x = edge + (left > 0.0F ? left + between : 0.0F), width = std::max(0.0F, m.width - edge - x);
    const float right = has_plots ? size_of(scene.share("plots"), m.width, 0.54F * width, min_plots * u,
                                            width - between - min_center * u)
                                  : 0.0F;
    const float center = std::max(0.0F, width - (right > 0.0F ? right + between : 0.0F));

    // Beside the editor the events would be too narrow for a certificate: put them below it.
    const bool events_below = editor && low > 0.0F;
    parts.controls = {edge, top, left, events_below ? height : all};
    const float picture = place_messages(parts, m, x, top, center, top + height);
    place_mechanism(parts, scene, m, {x, picture, center, top + height - picture});
    parts.plots = {x + center + between, top, right, height};
    const float events_x = events_below ? edge : x;
    parts.events = {events_x, top + height + between, std::max(0.0F, m.width - edge - events_x), low};

    if (left > 0.0F)
        parts.splitters.push_back({left_panel,
                                   {edge + left, top, between, parts.controls.height},
                                   true,
                                   double{edge} + 0.5 * double{between},
                                   double{m.width}});
    if (right > 0.0F) add_splitter(parts, m, "plots", {x + center + between, top, right, height});
    if (low > 0.0F) add_splitter(parts, m, "events", parts.events);
    return parts;
}

}  // namespace achilles
