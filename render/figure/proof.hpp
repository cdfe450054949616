// A proof in a figure: tubes around the curves of a run in which the run is proved to stay (theory-enclosure.md 8).
#pragma once

#include <vector>

#include "enclose/initial_uncertainty.hpp"
#include "figure/compose.hpp"

namespace achilles {

// A proof about a run with the spread around it.
struct Proof {
    InitialUncertainty spread;
    EnclosureProblem claim;
    Enclosure enclosure;
};

// Style of a proof's tubes. No curve or event has this hue.
Tube proof_tube(const Theme& theme);

// The claim to be proved about a run, with as many instants as smooth tubes need. Throws InputError if a spread is
// impossible.
EnclosureProblem problem_to_draw(const Trajectory& run, const InitialUncertainty& spread);
// Proves the claim of problem_to_draw(). Throws InputError for a system that no proof covers.
Proof proof_of(const Trajectory& run, const InitialUncertainty& spread);

// A plot over time with the tubes of a proof of such a claim, where they are wide enough to be visible. At every
// instant the expressions are evaluated in intervals over the whole box. Automatic limits are widened for the tubes, up
// to half the panel. If the proof is undecided, a line marks where it ends, and the rest is shaded.
Panel with_proof(Panel panel, const Trajectory& run, const Proof& proof, const PreparedView& view,
                 const Framing& framing, const Theme& theme);

// Appends the legend entries of a proof to the keys of a figure.
void name_proof(Figure& figure, const Proof& proof, const Theme& theme);

}  // namespace achilles
