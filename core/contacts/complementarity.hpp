// The linear complementarity problem of contacts: 0 <= p perpendicular b + W p >= 0 (theory-gaps.md 2.1, 2.2).
#pragma once

#include "contacts/delassus.hpp"

namespace achilles {

struct Complementarity {
    ContactVector<double> p;  // >= 0: impulses or forces
    ContactVector<double> y;  // b + W p >= 0, exactly 0 where it is 0 within rounding
    ContactSet active;        // p_j > 0; y_j = 0 there
    bool unique = true;       // whether p is unique, see below
};

// Solves it for a symmetric W, positive definite or semidefinite, with at most max_closed_contacts rows. For impulses,
// b is (1 + e) hdot-. For contact forces, b is hddot in free flight, p is lambda and y is hddot with these forces.
//
// The solution is checked: p >= 0 and |y_j| (p_j > 0), -y_j (p_j = 0) <= 5e-13 (|b_j| + sum |W_jk| p_k). An entry of W
// below 64 ulp of sqrt(W_ii W_kk) counts as 0, so that rounding opens no contact. The bounds are for each contact and
// those coupled to it by W. A contact that is coupled to no faster one is therefore solved as accurately as it would be
// alone.
//
// y is unique. p is unique if W over the contacts with y = 0 is clearly positive definite (HeldBlock::clear). Otherwise
// p is the solution with the smallest sum W_jj p_j^2, a norm that does not depend on the units of the gaps. The four
// legs of a table then carry equal forces, and a gap that is given twice, or once as its double, shares its force
// (theory-gaps.md 2.5).
//
// Returns nullopt if there is no solution or a number is not finite. There is no solution if some p >= 0 has W p = 0
// and b p < 0. Then no u has G u > 0, as for the two sides of a slot without play.
std::optional<Complementarity> solve_complementarity(const ContactMatrix<double>& W, const ContactVector<double>& b);

}  // namespace achilles
