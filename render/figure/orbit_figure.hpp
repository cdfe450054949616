// Figures of a periodic run: one period as the system's views show it, and its branch.
#pragma once

#include "figure/palette.hpp"
#include "figure/publication.hpp"
#include "study/orbit.hpp"

namespace achilles {

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
