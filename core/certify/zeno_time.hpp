// How long a bouncing still lasts after an impact of speed w: bounds that motions attain, and to third order in w.
#pragma once

#include "number/interval.hpp"

namespace achilles {

// tau_inf - tau_k wherever -hddot stays in [a_min, a_max] and e^2 a_max/a_min < 1 (theory.md 4): attained bounds
//     A_lo w <= tau_inf - tau_k <= A w,   A = 2 e (1+e)/(a_min (1 - e^2 r)),   A_lo = 2 e (1+e)/(a_max (1 - e^2/r)).
struct Wait {
    Interval earliest, latest;
};
Wait wait_for_zeno(const Interval& e, const Interval& a_min, const Interval& a_max, const Interval& w);

// How -hddot changes along a bouncing, at the restart (q, s) and sigma = 0: its value a, its rate b along the
// constrained motion, its derivative c with respect to sigma = hdot.
struct Trend {
    double a = 0.0, b = 0.0, c = 0.0;
};

// The wait to second order in w, an estimate (theory-truncation.md 3):
//     T0 - T0^2 (b/(3a) + c/6),   T0 = 2 e w/(a (1 - e)).    Needs a > 0, e < 1.
double estimated_wait(const Trend& trend, double e, double w);
// The same over any number.
template <class Number>
Number estimated_wait(const Number& a, const Number& b, const Number& c, const Number& e, const Number& w) {
    const Number T0 = 2.0 * e * w / (a * (1.0 - e));
    return T0 - T0 * T0 * (b / (3.0 * a) + c / 6.0);
}

// What is proved of -hddot = G(q, s, sigma) over a box that contains the bouncing, its bounds a_min and a_max apart. P,
// Phi and Xi are those of model/bouncing.hpp with G for hddot.
struct Drift {
    Interval start;       // G(q, s, 0) at the collision
    Interval by_sigma;    // dG/dsigma over the box
    Interval P, Phi, Xi;  // over the box
};

// Encloses the wait to third order in w (theory-truncation.md 4): `trend` may be any doubles with a > 0, and is
// best that of the collision. With T the latest end of the wait, h_m = (e w)^2/(2 a_min) and K = (1+e)/(1-e),
//     delta = -hddot - a = b t + c hdot + R,   |R| <= rho
//     rho = |G(q,s,0) - a| + |G_sigma - c| w + |P - b| T + |mid Phi| h_m + rad(Phi) w T + |Xi| w^2 T
//     |wait - (T0 - T0^2 (b/(3a) + c/6))| <= T (2 rho/(a (1-e)) + d_m S),   d_m = max |a_max - a|, |a - a_min|
//     S = T (|cA| + 1.09 |cB| + |cE|) + 2 z_m (|cC| + |cD| + |cF| + |cG|),  z_m = w sqrt(max(e, e'')^2 + e^2 a/a_min)
// The proof: for any constant a, Theta = (hdot + K z)/a with z = sqrt(hdot^2 + 2 a h) is continuous across impacts and
// falls at the rate 1 where hddot = -a; what delta adds is integrated by parts with the quadratic form Psi in (t, hdot,
// z), continuous across impacts too, whose coefficients are cA to cG. Undefined where the enclosures are.
Interval third_order_wait(const Trend& trend, const Drift& drift, const Interval& e, const Interval& a_min,
                          const Interval& a_max, const Interval& w, const Interval& latest);
// That bound by itself, whose upper end counts: T (2 rho/(a (1-e)) + d_m S).
Interval third_order_error(const Trend& trend, const Drift& drift, const Interval& e, const Interval& a_min,
                           const Interval& a_max, const Interval& w, const Interval& latest);

}  // namespace achilles
