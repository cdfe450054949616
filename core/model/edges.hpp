// Functions that end at an edge, where they are not smooth: roots, logarithms, arcsines. And those that hide.
//
// sqrt(u) is smooth as long as u > 0. Where u falls below zero it has no value, which shows. Where u touches zero it
// has a kink that no formula shows: sqrt(x^2) is |x|, and the Taylor series of it at x = -1 is that of -x, which goes
// on through x = 0 as if nothing was there. So the distance from the edge is watched along the motion, as a root
// itself:
//
//     sqrt(u), u^a (a no integer), log(u)     d = sqrt(u)
//     asin(u), acos(u)                        d = sqrt(1 - u^2)
//
//     a/b, b^-n, tan(u)                       d = b^2 of each factor of the divisor, of cos(u)
//
// Quotients have poles there, which a coefficient below the tolerance hides from the series of the motion.
// The series of d changes its sign where u touches the edge, and comes close to zero where u nearly does.
//
// In the same way a function may hide: exp(-400 (x - 1)^2) is nothing at x = 0.6, in all the digits of the terms that a
// series keeps, and one at x = 1. So its growth is watched: no step is longer than what lets u rise by `growth` (for
// a^b it is u = b log a), or |u| fall by half of it where it is large in sinh(u), cosh(u), tanh(u), whose differences
// from their asymptotes are exp(-2|u|).
#pragma once

#include <vector>

#include "model/derive.hpp"

namespace achilles {

struct Edge {
    enum class Kind { edge, exponential, hyperbolic };
    static constexpr double growth = 4.0;
    Expression function;  // as it stands in T, V, h or a force
    Expression argument;
    Expression event_function;  // d, above zero where the function is smooth; or u
    const char* place;          // "the gap", for messages
    Kind kind;
};

// Those of T, V, h and the forces whose argument moves; derivatives have no others. Each distance once. Makes nodes in the graph of
// the equations.
std::vector<Edge> edges_of(const Equations& equations, const Layout& layout);

}  // namespace achilles
