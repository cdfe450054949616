// A figure for print: the views of a run as lettered panels, with one legend above them all and every axis labelled
// once.
#pragma once

#include "figure/palette.hpp"
#include "figure/proof.hpp"
#include "study/orbit.hpp"

namespace achilles {

struct PublicationStyle {
    int columns = 0;           // 0: one for up to three views over the same axis, two up to six, else three
    bool transparent = false;  // no background
    bool ordered = false;      // the panels stay in their order, even where a path would stand better as the first
    double shape = 1.5;        // of the picture: its width over its height
    bool dark = false;         // for a screen in a dark room, not for paper
    Resolution size{};         // of the picture, pixels: how fine its curves are
};

// Throws InputError for a view that cannot be evaluated. With a proof of the run where there is one; pale after the horizon of
// the run (s), where that comes before its end.
Figure publication(const Trajectory& trajectory, std::span<const ViewDescription> views, const PublicationStyle& style,
                   const Proof* proof = nullptr, std::optional<double> horizon = {});

// The same of panels that are composed already, in the colours of the style.
Figure publication(const Trajectory& trajectory, std::vector<Panel> panels, const PublicationStyle& style);
// What a composed figure looks like in print: no grid, smaller markers, and one legend above all panels that tells what
// occurs in the runs they show.
void dress_for_print(Figure& figure, std::span<const Trajectory* const> runs, const Theme& theme = light_theme());

// "(a)", or "(a) height" where the panel has a name.
std::string lettered(std::size_t i, const std::string& name);

// Takes the labels off the x axes of every row whose panels all stand on others with the same axes. A panel beside
// several rows keeps its own.
void share_axes(Figure& figure);

// Text and strokes of a figure are made for a page about as wide as this many pixels; --scale 1 is that size.
constexpr double publication_scale = 1.4;

// Figures of a periodic run: one period as the system's views show it, and its branch.

// One quantity along a branch, with what each of its points is drawn at.
struct BranchPanel {
    Panel panel;
    std::vector<double> values;  // of the branch's points: not a number where there is none
};
// Over the branch's parameter where the run is on its section, its period where that is free, what is left of a change, and the
// margin a_inf; solid where it is stable, dashed where it is not, with what happens along it marked.
std::vector<BranchPanel> branch_panels(const Orbit& orbit, const Branch& branch, const Theme& theme);
// What strokes and signs of these mean.
std::vector<Key> branch_keys(const Branch& branch, const Theme& theme);

// These, then the first of the views over one period of the orbit. Throws InputError for a view that cannot be evaluated.
Figure compose_branch(const Orbit& orbit, const Branch& branch, std::span<const ViewDescription> views,
                      const PublicationStyle& style);

}  // namespace achilles
