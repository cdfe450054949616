#include "panels/arrangement.hpp"

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

// Lengths at scale 1. The minimum sizes keep panels readable.
constexpr float margin = 10.0F, gap = 10.0F, min_controls = 240.0F, min_editor = 320.0F, min_center = 340.0F,
                min_plots = 240.0F, min_events = 110.0F, min_top = 240.0F, min_picture = 90.0F, min_plane = 230.0F,
                min_world = 90.0F, min_plot = 110.0F;

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

// Lecture: the title, the mechanism beside one plot, up to three sliders and the player; nothing else, unless the energy
// was asked for.
Arrangement arrange_lecture(const Scene& scene, const Measures& m) {
    const float edge = margin * m.unit, between = gap * m.unit, inside = std::max(0.0F, m.width - 2.0F * edge);
    const float bottom = std::max(0.0F, m.height - edge);
    const auto below = [&](const Rectangle& part) {
        const double end = part.y + part.height;
        return static_cast<float>(part.height > 0.0 ? end + 0.6 * double{between} : end);
    };
    Arrangement parts;
    parts.title = {edge, edge, inside, std::min(m.title, bottom - edge)};
    const float error_top = std::min(below(parts.title), bottom);
    parts.error = {edge, error_top, inside, std::min(m.error ? m.error(inside) : 0.0F, bottom - error_top)};
    const float caption_top = below(parts.error);
    parts.caption = {edge, caption_top, inside,
                     std::clamp(m.caption ? m.caption(inside) : 0.0F, 0.0F, std::max(0.0F, bottom - caption_top))};
    const float top = std::min(below(parts.caption), bottom);
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
    const float timeline = std::min(m.timeline, height);
    const float lower = top + height - timeline - between;  // lower end of the parts above the player
    const float all_results = m.results ? m.results(center) : 0.0F;
    const auto below = [&](float part, float its_height) {
        return part + its_height + (its_height > 0.0F ? 0.6F * between : 0.0F);
    };
    const float caption = m.caption ? m.caption(center) : 0.0F;
    // Minimum height: numbers and heading above the axes, and the picture itself.
    const float least = std::max((scene.shows("plane") ? min_plane : min_picture) * u,
                                 (m.state ? m.state(center) : 0.0F) + min_world * u);
    // The error message is above the picture or, if that would become too low, above the plots.
    float error = std::min(m.error ? m.error(center) : 0.0F, height);
    const float left_over = lower - below(below(top, error), caption) - all_results - 0.4F * between;
    const float beside = m.error && right > 0.0F ? m.error(right) : 0.0F;
    const bool over_plots = error > 0.0F && left_over < least && beside > 0.0F && height - beside >= min_plot * u;
    if (over_plots) error = 0.0F;
    parts.error = over_plots ? Rectangle{x + center + between, top, right, beside} : Rectangle{x, top, center, error};
    const float caption_top = below(top, error), caption_height = std::min(caption, top + height - caption_top);
    parts.caption = {x, caption_top, center, caption_height};
    const float picture = below(caption_top, caption_height);
    // The picture takes precedence: if it would be too low, the results shrink.
    float results = std::clamp(all_results, 0.0F, std::max(0.0F, lower - picture - least));
    if (results < 0.4F * all_results) results = 0.0F;  // less than one line
    const float space = results > 0.0F ? 0.4F * between : 0.0F;
    const float energy = energy_in(m, lower - results - space - 0.4F * between - picture - least);
    const float under = lower - (energy > 0.0F ? energy + 0.4F * between : 0.0F);
    parts.mechanism = {x, picture, center, std::max(0.0F, under - results - space - picture)};
    parts.results = {x, under - results, center, results};
    parts.energy = {x, lower - energy, center, energy};
    parts.timeline = {x, top + height - timeline, center, timeline};
    const float plots_at = over_plots ? below(top, beside) : top;
    const float plots_height = top + height - plots_at;
    parts.plots = {x + center + between, plots_at, right, plots_height};
    const float events_x = events_below ? edge : x;
    parts.events = {events_x, top + height + between, std::max(0.0F, m.width - edge - events_x), low};

    const double half = 0.5 * double{between};
    if (left > 0.0F)
        parts.splitters.push_back({left_panel,
                                   {edge + left, top, between, parts.controls.height},
                                   true,
                                   double{edge} + half,
                                   double{m.width}});
    if (right > 0.0F)
        parts.splitters.push_back({"plots",
                                   {x + center, top, between, height},
                                   true,
                                   double{m.width} - double{edge} - half,
                                   -double{m.width}});
    if (low > 0.0F)
        parts.splitters.push_back({"events",
                                   {events_x, top + height, parts.events.width, between},
                                   false,
                                   double{bottom} - half,
                                   -double{m.height}});
    return parts;
}

}  // namespace achilles
