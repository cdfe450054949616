// The linear complementarity problem of contacts: 0 <= p perpendicular b + W p >= 0 (theory-gaps.md 2.1, 2.2).
#pragma once

#include "contacts/delassus.hpp"

namespace achilles {

struct Complementarity {
    ContactVector<double> p;  // >= 0
    ContactVector<double> y;  // b + W p >= 0, exactly 0 where that is its rounding
    ContactSet active;        // p_j > 0; y_j = 0 there
    bool unique = true;       // p too, see below
};

// Solves it for a symmetric W, positive definite or semidefinite, of at most most_contacts rows. For impulses b is
// (1 + e) hdot-, for contact forces b is hddot, p is lambda and y the accelerations with them.
//
// The answer is checked: p >= 0 and |y_j| (p_j > 0), -y_j (p_j = 0) <= 5e-13 (|b_j| + sum |W_jk| p_k). An entry of W
// below 64 ulp of sqrt(W_ii W_kk) counts as 0, so that rounding opens no contact. The bounds are of each contact and
// those that it meets through W: however much faster than it others are, it is solved as it would be alone.
//
// y is unique. p is where W over the contacts with y = 0 is clearly positive definite (HeldBlock::clear). Otherwise p is,
// of all solutions, the one of the least sum W_jj p_j^2, the least norm whatever the units of the gaps: a table has the
// same force in each of its four legs, and a gap that is given twice, or once as its double, shares its force
// (theory-gaps.md 2.5).
//
// Nothing where there is no solution, which takes a p >= 0 with W p = 0 and b p < 0: then there is no u with G u > 0, as
// for the two sides of a slot without play. Nothing either where a number is not finite.
std::optional<Complementarity> solve_complementarity(const ContactMatrix<double>& W, const ContactVector<double>& b);

}  // namespace achilles
