// Colors, dashes and markers of phases and events. The colors are distinguishable with any color vision (Okabe and
// Ito); dashes and shapes repeat the distinction for print.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "figure/figure.hpp"
#include "run/trajectory.hpp"

namespace achilles {

struct Theme {
    bool dark = false;
    Color background, ink, grid;  // of a figure, or of a card in the explorer
    Color surface;                // static parts: the contact surface, a pivot
    Color ground;                 // the solid side of such a surface
    Color body;                   // moving parts
    // The interface around the figures.
    Color page;               // behind the cards
    Color frame;              // of an idle button or field
    Color border;             // lines between groups, the track of a slider
    Color faint;              // text that is less important
    Color accent;             // what the user can move, and what the user has changed
    Color selected;           // behind the chosen line of a list
    Color error, error_card;  // an error, and the background of its card
};

Theme light_theme();
Theme dark_theme();

// Contrast ratio of two colors, 1 to 21 (WCAG 2). Text needs 4.5, curves and symbols need 3.
double contrast(const Color& a, const Color& b);
// A color that a file chose for white paper, changed to the same contrast with the theme's background.
Color on_theme(const Color& color, const Theme& theme);

// How a phase is drawn. With dry friction it slips if any contact or joint slips, else it sticks; it is in contact if
// no held contact has friction.
enum class PhaseLook { flight, contact, stick, slip };
inline constexpr std::array<PhaseLook, 4> phase_looks{PhaseLook::flight, PhaseLook::contact, PhaseLook::stick,
                                                      PhaseLook::slip};
constexpr PhaseLook look_of(Phase::Kind kind) {
    return kind == Phase::Kind::hybrid ? PhaseLook::flight : PhaseLook::contact;
}
// The look of a phase or a sample of this kind and mode.
PhaseLook look_of(const Model& model, Phase::Kind kind, Mode mode);
// The look of contacts and joints that are not open in this mode.
PhaseLook look_of(const Model& model, ContactSet which, Mode mode);
// The number of looks that a system uses, from the first on: 2, or 4 with friction. A panel has so many curves for each
// quantity.
std::size_t look_count(const Model& model);
// The looks that phases of a system may have.
std::vector<PhaseLook> possible_looks(const Model& model);

// Stroke of a curve: dashed in flight, dash-dotted while something slips, else solid. A single curve of a panel has the
// color of the phase. One of several has its own hue (repeated after eight), and the dash shows the phase.
Stroke phase_stroke(const Theme& theme, PhaseLook look, std::size_t curve, std::size_t curves);
Color phase_color(const Theme& theme, PhaseLook look);
inline Stroke phase_stroke(const Theme& theme, Phase::Kind kind, std::size_t curve, std::size_t curves) {
    return phase_stroke(theme, look_of(kind), curve, curves);
}
inline Color phase_color(const Theme& theme, Phase::Kind kind) { return phase_color(theme, look_of(kind)); }
// Color of a run in a comparison, by its place from 1 to max_pinned. In a comparison the present run is drawn in ink,
// and only stroke and dash show its phases.
inline constexpr int max_pinned = 6;
Color run_color(const Theme& theme, int place);
// Stroke of a compared run, thinner than that of the present run.
Stroke pinned_stroke(const Theme& theme, const Stroke& stroke, int place);
// Filled squares at impacts, diamonds at Zeno points, triangles at releases. Events of friction: a disc where it
// sticks, a circle where a slip starts, a hollow diamond where it is reversed. The markers have no points yet.
Markers event_markers(const Theme& theme, Event::Kind kind);
// Events nearer to each other than this share a marker, points.
inline constexpr double event_marker_distance = 6.0;
// Hollow triangles above the squares of impacts that open a held contact. The markers have no points yet.
Markers opened_markers(const Theme& theme);
// Legend text of a phase.
std::string legend_text(PhaseLook look);
inline std::string legend_text(Phase::Kind kind) { return legend_text(look_of(kind)); }
// Legend text of the events of a kind in these runs. It has two names if Zeno points have different names in these
// runs.
std::string events_name(std::span<const Trajectory* const> runs, Event::Kind kind);

// ---- colors for numbers ----
// Equal steps of the number look equally far apart, and brighter is larger, for any color vision and in gray.

// The color of `share`, a fraction of the range from 0 to 1 (clamped). In OKLab (Ottosson 2020) the table is a helix.
// Lightness increases uniformly from 0.25 to 0.92, while the hue turns uniformly at chroma 0.125 from blue through red
// to yellow:
//     L = 0.25 + 0.67 s,   a = 0.125 sin(190 deg s),   b = -0.125 cos(190 deg s).
// Every step has the same length. For viewers who lack one kind of cone (simulated after Machado, Oliveira and
// Fernandes 2009), lightness also increases in every step. The shortest step is then 0.50 (protan), 0.68 (deutan) and
// 0.41 (tritan) of the longest.
Color number_color(double share);

// `count` equally spaced colors of the table.
std::vector<Color> number_colors(std::size_t count);

// From OKLab to sRGB, clamped.
Color oklab(double lightness, double a, double b);

}  // namespace achilles
