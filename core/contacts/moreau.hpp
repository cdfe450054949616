// Impacts of several contacts: Newton's law in Moreau's form, and what would follow if they came one after the other.
#pragma once

#include <vector>

#include "contacts/delassus.hpp"

namespace achilles {

// At an impact, v+ = v- + M^-1 G' p.
struct MoreauImpact {
    ContactVector<double> impulses;    // p >= 0
    ContactVector<double> hdot_after;  // W p added; exactly 0 where a held contact stays, -e hdot- where one bounces
    ContactSet active;                 // p_j > 0
    ContactSet opened;                 // held before, and hdot+ > 0 now
    double loss = 0.0;                 // of kinetic energy relative to the walls: 1/2 sum p_j (1 - e_j) |hdot_j-|, >= 0
    bool unique = true;                // p too; hdot+ and the loss always are. Else p is as in complementarity.hpp
};

// Moreau's law (theory-gaps.md 2.1): 0 <= p_j perpendicular hdot_j+ + e_j hdot_j- >= 0, hdot+ = hdot- + W p, over the
// contacts in `colliding`, whose hdot- is <= 0; the others feel W p and give nothing. hdot- is 0 exactly for a contact
// that is held, whatever number is given. Energy never rises for 0 <= e_j <= 1.
// Where one contact lands on others at rest, and every kappa_j >= 0 (Transmission), p_i = (1 + e) |hdot_i-|/W_i^A and
// p_j = kappa_j p_i at once. Nothing where no impulse obeys it (solve_complementarity).
std::optional<MoreauImpact> moreau_impact(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                          const ContactVector<double>& e, ContactSet held, ContactSet colliding);

// The same over the held contacts, those that land (hdot- < 0) and those that touch (hdot- = 0). A contact that moves away
// takes no part: where its hdot+ is < 0, it has a further impact at the same time.
std::optional<MoreauImpact> moreau_impact(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                          const ContactVector<double>& e, ContactSet held);

// Impacts at one place, one after the other.
struct ImpactSequence {
    enum class End {
        finite,  // nobody approaches any more
        limit,   // infinitely many, ever smaller: what approaches is below 2^-40 of the first, and counts as 0
        cut      // most_impacts, and somebody still approaches
    };
    static constexpr int most_impacts = 1000;
    Eigen::Index first = 0;            // the contact that came first
    ContactVector<double> hdot_after;  // >= 0 unless cut
    ContactVector<double> impulses;    // in sum
    int impacts = 0;
    End end = End::finite;
};

// What would follow from hdot- if contact `first`, which approaches, came just before all others (theory-gaps.md 2.4).
//
// The rule: each impact is Moreau's, of who collides and of those at rest. At rest is who is held, until an impact opens it,
// and who landed with e = 0 and was left with hdot = 0; a contact that merely touches is not, as if its gap were tiny. After
// the first it is always the turn of whoever approaches most, which is told by hdot^2/W_jj, twice the energy that a
// plastic impact of j alone would cost: it does not depend on the units of gaps. Those who tie within 2^-40 collide
// together, so that the numbering of contacts decides nothing.
// Nothing where some impact has no solution.
std::optional<ImpactSequence> impacts_in_turn(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                              const ContactVector<double>& e, ContactSet held, Eigen::Index first);

// impacts_in_turn for every contact that is not held and approaches, in their order. Where there are none, empty.
std::vector<ImpactSequence> alternatives(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                         const ContactVector<double>& e, ContactSet held);

// Whether the outcome of landings that cannot be ordered depends on their order.
struct OrderDependence {
    bool by_transmission = false;  // some kappa_ji is not proved >= 0: a landing may open what is held
    bool by_landings = false;      // two landings are not proved independent
    bool rounded_zero = false;     // something counted as 0 that is 0 only within its rounding
    bool matters() const { return by_transmission || by_landings; }
};

// Landings do not depend on their order where all kappa_ji >= 0, j held and i landing, and for every two landings
// W_ik^A = 0, or W_ik^A <= 0 if they have e = 0, all of them (theory-gaps.md 2.4); that is what is to be proved.
// Landing is who is closed, not held and not moving away: one that merely touches too.
// What counts as 0 (counts_as_zero) is flagged; [0, 0] is 0 without doubt. Where W over the held contacts is not proved positive definite, nothing else is proved.
// For one landing alone by_landings is false, and by_transmission says that nearly held contacts would do otherwise.
OrderDependence order_dependence(const ContactMatrix<Interval>& W, const ContactVector<double>& e, ContactSet held,
                                 ContactSet landing);

}  // namespace achilles
