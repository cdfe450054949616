// What closed contacts do next, proved: who is held and who leaves (theory-gaps.md 2.2). On a Ground, as every proof.
#pragma once

#include "contacts/delassus.hpp"

namespace achilles {

// Of the accelerations hddot and forces lambda that solve 0 <= lambda perpendicular hddot + W lambda >= 0.
struct AccelerationSigns {
    ContactSet held;       // lambda_j > 0 is proved
    ContactSet leaves;     // an acceleration > 0 is proved
    ContactSet undecided;  // neither
    // Enclosures: of lambda where held, of the acceleration where it leaves. Where undecided, of what either would be with
    // every choice of who holds among the undecided.
    ContactVector<Interval> lambda, acceleration;
};

// Classifies the contacts, of which solve_complementarity holds `active` for some W and hddot inside the enclosures. True
// of every symmetric W and every hddot inside them: where a sign is not proved, the contact may be held or not, and what
// is proved of others is proved both ways, for every such choice. So no contact is judged alone, or by a set that is
// itself in doubt.
// Nothing where W is not proved positive definite over the held and the undecided.
std::optional<AccelerationSigns> classify(const ContactMatrix<Interval>& W, const ContactVector<Interval>& hddot,
                                          ContactSet active);

}  // namespace achilles
