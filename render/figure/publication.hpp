// A figure for print: the views of a run as lettered panels, with one legend above all panels and shared axes labeled
// once.
#pragma once

#include "analysis/orbit.hpp"
#include "figure/palette.hpp"
#include "figure/proof.hpp"

namespace achilles {

struct PublicationStyle {
    int columns = 0;           // 0: one for up to three views over the same axis, two for up to six, else three
    bool transparent = false;  // no background
    bool ordered = false;      // keep the order of the panels, even if a path would fit better as the first
    double shape = 1.5;        // width / height of the picture
    bool dark = false;         // for a dark screen instead of paper
    Resolution size{};         // of the picture, pixels: determines how fine its curves are
};

// Composes the figure, with a proof of the run if one is given. Pale after the horizon of the run (s), if that comes
// before its end. Throws InputError if a view cannot be evaluated.
Figure publication(const Trajectory& trajectory, std::span<const ViewDescription> views, const PublicationStyle& style,
                   const Proof* proof = nullptr, std::optional<double> horizon = {});

// The same for panels that are already composed in the colors of the style.
Figure publication(const Trajectory& trajectory, std::vector<Panel> panels, const PublicationStyle& style);
// Converts a composed figure to print style: no grid, smaller markers, and one legend above all panels with the kinds
// of phases and events that occur in these runs.
void apply_print_style(Figure& figure, std::span<const Trajectory* const> runs, const Theme& theme = light_theme());

// "(a)", or "(a) height" if the panel has a name.
std::string lettered(std::size_t i, const std::string& name);

// Removes the x labels of every row whose panels all stand above others with the same axes. A panel beside several rows
// keeps its labels.
void share_axes(Figure& figure);

// Layout scale of a figure for print at --scale 1.
constexpr double publication_scale = 1.4;

// ---- figures of a periodic orbit: one period in the system's views, and its branch ----

// One quantity along a branch, and its value at each point of the branch.
struct BranchPanel {
    Panel panel;
    std::vector<double> values;  // NaN at points without a value
};
// Panels over the parameter of the branch: the state on the section, the period if it is free, the magnitudes of the
// multipliers, and the margin a_inf. Curves are solid where the orbit is stable, dashed where it is not. Special points
// along the branch are marked.
std::vector<BranchPanel> branch_panels(const Orbit& orbit, const Branch& branch, const Theme& theme);
// Legend of these panels.
std::vector<Key> branch_keys(const Branch& branch, const Theme& theme);

// The branch panels, then the first of the views over one period of the orbit. Throws InputError if a view cannot be
// evaluated.
Figure compose_branch(const Orbit& orbit, const Branch& branch, std::span<const ViewDescription> views,
                      const PublicationStyle& style);

}  // namespace achilles
