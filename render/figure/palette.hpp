// How things look: the one table from phase and event to colour, dash and marker. Colours are told apart by people with
// any colour vision (Okabe and Ito); dash and shape say the same again for print.
#pragma once

#include "figure/figure.hpp"
#include "trajectory.hpp"

namespace achilles {

struct Theme {
    bool dark = false;
    Color background, ink, grid;
    Color surface;  // what does not move: the contact surface, a pivot
    Color body;     // what moves
};

Theme light_theme();
Theme dark_theme();

// Hybrid phases are dashed, constrained ones solid. One curve in a panel has the phase's colour; the i-th of several
// has a hue of its own (the ninth has the first's again), and the dash still tells the phase.
Stroke phase_stroke(const Theme& theme, Phase::Kind kind, std::size_t curve, std::size_t curves);
Color phase_color(const Theme& theme, Phase::Kind kind);
// Filled squares at impacts, diamonds at Zeno points, triangles at releases; no points yet.
Markers event_markers(const Theme& theme, Event::Kind kind);
// What a legend calls them.
std::string legend_text(Phase::Kind kind);

}  // namespace achilles
