// Impacts of several contacts: Newton's law in Moreau's form, and the outcomes if the impacts were successive.
#pragma once

#include <vector>

#include "contacts/delassus.hpp"

namespace achilles {

// The result of an impact; v+ = v- + M^-1 G' p.
struct MoreauImpact {
    ContactVector<double> impulses;    // p >= 0
    ContactVector<double> hdot_after;  // exactly 0 for a contact that stays held, -e hdot- for one that bounces
    ContactSet active;                 // contacts with p_j > 0
    ContactSet opened;                 // contacts that were held and have hdot+ > 0
    double loss = 0.0;                 // of kinetic energy relative to the walls: 1/2 sum p_j (1 - e_j) |hdot_j-|, >= 0
    bool unique = true;                // whether p is unique (see complementarity.hpp); hdot+ and the loss always are
};

// Moreau's law (theory-gaps.md 2.1): 0 <= p_j perpendicular hdot_j+ + e_j hdot_j- >= 0, hdot+ = hdot- + W p, over the
// contacts in `colliding`, whose hdot- is <= 0. The gap rates of the other contacts change by W p, but these contacts
// have no impulse. For a held contact hdot- is taken as exactly 0, whatever value is given. The energy never increases
// for 0 <= e_j <= 1.
// If one contact closes on others at rest and every kappa_j >= 0 (Transmission), p_i = (1 + e) |hdot_i-|/W_i^A and
// p_j = kappa_j p_i directly. Returns nullopt if no impulse obeys the law (solve_complementarity).
std::optional<MoreauImpact> moreau_impact(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                          const ContactVector<double>& e, ContactSet held, ContactSet colliding);

// The same over the contacts that are held, that close (hdot- < 0) or that touch (hdot- = 0). A contact that separates
// takes no part. If its hdot+ is < 0, it has a further impact at the same time.
std::optional<MoreauImpact> moreau_impact(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                          const ContactVector<double>& e, ContactSet held);

// Successive impacts at the same position.
struct ImpactSequence {
    enum class SequenceEnd {
        finite,  // no contact closes any more
        limit,   // infinitely many, ever smaller; closing speeds below 2^-40 of the first count as 0
        cut      // stopped after most_impacts, while a contact still closes
    };
    static constexpr int most_impacts = 1000;
    Eigen::Index first = 0;            // the contact of the first impact
    ContactVector<double> hdot_after;  // >= 0 unless cut
    ContactVector<double> impulses;    // total
    int impacts = 0;
    SequenceEnd end = SequenceEnd::finite;
};

// The outcome from hdot- if contact `first`, which closes, impacts just before all others (theory-gaps.md 2.4).
// The rule: each impact obeys Moreau's law over the contacts that collide and those at rest. At rest are the held
// contacts until an impact opens them, and contacts that impacted with e = 0 and were left with hdot = 0. A touching
// contact is not at rest; it is treated as if its gap were tiny. After the first impact, the next contact is always the
// one with the largest hdot^2/W_jj. That is twice the energy that a plastic impact of j alone would dissipate, and does
// not depend on the units of gaps. Contacts that tie within 2^-40 collide together, so that the numbering of contacts
// has no effect. Returns nullopt if an impact has no solution.
std::optional<ImpactSequence> impacts_in_turn(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                              const ContactVector<double>& e, ContactSet held, Eigen::Index first);

// impacts_in_turn() with each contact that closes and is not held as the first, in their order. Empty if there is none.
std::vector<ImpactSequence> alternatives(const ContactMatrix<double>& W, const ContactVector<double>& hdot_before,
                                         const ContactVector<double>& e, ContactSet held);

// Whether the outcome of impacts that cannot be ordered in time depends on their order.
struct OrderDependence {
    bool by_transmission = false;  // some kappa_ji is not proved >= 0: an impact may open a held contact
    bool by_landings = false;      // two impacts are not proved independent
    bool rounded_zero = false;     // a number counted as 0 that is 0 only within its rounding
    bool matters() const { return by_transmission || by_landings; }
};

// Impacts do not depend on their order under two conditions (theory-gaps.md 2.4): all kappa_ji >= 0 (j held, i
// impacting), and for every two impacting contacts W_ik^A = 0, or W_ik^A <= 0 if all impacting contacts have e = 0.
// This function tries to prove both. Impacting are all closed contacts that are neither held nor separating, also those
// that only touch.
// Numbers that count as 0 (counts_as_zero) set rounded_zero; [0, 0] does not. If W over the held contacts is not proved
// positive definite, nothing is proved. For a single impact, by_landings is false, and by_transmission means that the
// outcome would differ if the held contacts were only nearly closed.
OrderDependence order_dependence(const ContactMatrix<Interval>& W, const ContactVector<double>& e, ContactSet held,
                                 ContactSet landing);

}  // namespace achilles
