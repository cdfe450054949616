// Functions that are not smooth at the edge of their domain (roots, logarithms, arcsines), and functions that a
// truncated series can miss.
//
// sqrt(u) is smooth as long as u > 0. If u falls below 0, sqrt(u) has no value, which is detected. If u touches 0,
// sqrt(u) has a kink that no formula shows. For example, sqrt(x^2) is |x|, and its Taylor series at x = -1 is that of
// -x, which is smooth at x = 0. The distance d from the edge is therefore monitored along the motion. It is a root
// itself:
//
//     sqrt(u), u^a (a not an integer), log(u)     d = sqrt(u)
//     asin(u), acos(u)                            d = sqrt(1 - u^2)
//
//     a/b, b^-n, tan(u)                           d = b^2 of each factor of the divisor, of cos(u)
//
// Quotients have poles where the divisor vanishes. A numerator below the tolerance hides such a pole from the series of
// the motion. The series of d changes sign where u touches the edge, and comes close to zero where u nearly does.
//
// A series can also miss a function: exp(-400 (x - 1)^2) is negligible at x = 0.6 in all terms that a series keeps, and
// equals 1 at x = 1. The growth of such functions is therefore limited. In one step, u may rise by at most `growth`
// (for a^b, u = b log a). In sinh(u), cosh(u) and tanh(u), a large |u| may fall by at most growth/2, because the
// differences from the asymptotes are exp(-2|u|).
#pragma once

#include <vector>

#include "model/derive.hpp"

namespace achilles {

struct DomainBoundary {
    enum class Kind { edge, exponential, hyperbolic };
    static constexpr double growth = 4.0;
    Expression function;  // as written in T, V, h or a force
    Expression argument;
    Expression event_function;  // d, positive where the function is smooth; or u
    const char* place;          // for messages, such as "the gap"
    Kind kind;
};

// The edges in T, V, h and the forces whose argument varies during a run, each distance once. Derivatives add no
// further edges. Creates nodes in the graph of the equations.
std::vector<DomainBoundary> edges_of(const Equations& equations, const Layout& layout);

}  // namespace achilles
