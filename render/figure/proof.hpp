// A proof in a figure: beside the curves of a run the tubes in which it is proved to stay (theory-enclosure.md 8).
#pragma once

#include <vector>

#include "enclose/spread.hpp"
#include "figure/compose.hpp"

namespace achilles {

// A theorem about a run and what is spread about it.
struct Proof {
    Spread spread;
    Claim claim;
    Enclosure enclosure;
};

// How its tubes look: in a hue that no curve and no event has.
Tube proof_tube(const Theme& theme);

// What is to be proved of a run, at so many instants that what is drawn of it is as smooth as the curves. Throws InputErrors
// where a part of that is impossible.
Claim claim_to_draw(const Trajectory& run, const Spread& spread);
// The same, proved. Throws InputError for a system that no proof covers.
Proof proof_of(const Trajectory& run, const Spread& spread);

// A plot over time of a run with the tubes of a proof of such a claim, wherever they are wide enough to be seen: at every instant the expressions over the whole box, in intervals. Limits that nobody chose give way to them, as
// far as half the panel. Where the proof is undecided a line marks how far it goes, and what follows is shaded.
Panel with_proof(Panel panel, const Trajectory& run, const Proof& proof, const PreparedView& view,
                 const Framing& framing, const Theme& theme);

// Puts what the legend of a figure says of it behind its other keys.
void name_proof(Figure& figure, const Proof& proof, const Theme& theme);

}  // namespace achilles
