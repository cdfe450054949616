// How things look: the one table from phase and event to colour, dash and marker. Colours are told apart by people with
// any colour vision (Okabe and Ito); dash and shape say the same again for print.
#pragma once

#include <span>
#include <vector>

#include "figure/figure.hpp"
#include "run/trajectory.hpp"

namespace achilles {

struct Theme {
    bool dark = false;
    Color background, ink, grid;  // of a figure, or of a card in the explorer
    Color surface;                // what does not move: the contact surface, a pivot
    Color ground;                 // what is solid behind such a surface
    Color body;                   // what moves
    // Of the interface around the figures.
    Color page;               // behind the cards
    Color frame;              // of a button or a field that does nothing yet
    Color border;             // lines between groups, the track of a slider
    Color faint;              // text that is less important
    Color accent;             // what the hand can move, and what it changed
    Color selected;           // behind the chosen line of a list
    Color error, error_card;  // what is wrong, and behind it
};

Theme light_theme();
Theme dark_theme();

// How well one colour is seen on another, 1 to 21 (WCAG 2): text wants 4.5, curves and signs want 3.
double contrast(const Color& a, const Color& b);
// A colour that a file chose on white paper, as far from the theme's background as it was from white.
Color on_theme(const Color& color, const Theme& theme);

// Hybrid phases are dashed, constrained ones solid. One curve in a panel has the phase's colour; the i-th of several
// has a hue of its own (the ninth has the first's again), and the dash still tells the phase.
Stroke phase_stroke(const Theme& theme, Phase::Kind kind, std::size_t curve, std::size_t curves);
Color phase_color(const Theme& theme, Phase::Kind kind);
// Runs that the present one is compared with have a hue each, by their places from 1 to most_pinned; where they are drawn
// the present run is in ink, and stroke and dash alone tell its phases.
inline constexpr int most_pinned = 6;
Color run_color(const Theme& theme, int place);
// Of such a run, which lies under `above` others and the present one: so wide that it is seen beside them where they coincide.
Stroke pinned_stroke(const Theme& theme, const Stroke& stroke, int place, std::size_t above);
// Filled squares at impacts, diamonds at Zeno points, triangles at releases; no points yet.
Markers event_markers(const Theme& theme, Event::Kind kind);
// Hollow triangles above the squares of impacts that open a held contact; no points yet.
Markers opened_markers(const Theme& theme);
// What a legend calls them.
std::string legend_text(Phase::Kind kind);
// What the markers of that kind mean in these runs: one name, or both of a run that lands and one that bounces.
std::string events_name(std::span<const Trajectory* const> runs, Event::Kind kind);

// Colours for numbers: equal steps of the number look equally far apart, and brighter is more, to people with any colour
// vision and in grey.

// Of a share of the way from the least number to the greatest, clamped to [0, 1]. In OKLab (Ottosson 2020) the table is a
// screw line: the lightness rises evenly from 0.25 to 0.92 while the hue turns evenly at chroma 0.125 from blue through
// red to yellow,
//     L = 0.25 + 0.67 s,   a = 0.125 sin(190 deg s),   b = -0.125 cos(190 deg s),
// so that every step has the same length. To who lacks a kind of cone (simulated after Machado, Oliveira and Fernandes 2009)
// the lightness rises in every step, too, and the shortest step is 0.50 (protan), 0.68 (deutan) and 0.41 (tritan) of the
// longest.
Color number_color(double share);

// The table in so many steps.
std::vector<Color> number_colors(std::size_t count);

// From OKLab to sRGB, clamped.
Color oklab(double lightness, double a, double b);

}  // namespace achilles
