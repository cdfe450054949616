// Newton's impact law and what follows from it, over any number: doubles, intervals, numbers with their derivatives.
//
//     v+ = v- - n (1 + e) hdot-,   n = M^-1 g'/W,   W = g M^-1 g',   g = dh     (paper (4))
//     hdot+ = -e hdot-,   p = -(1 + e) hdot-/W,   loss = p (1 - e) |hdot-|/2,   work = -p dh/dt
//
// Law: kinetic energy never rises for 0 <= e <= 1. An impact of several contacts is Moreau's (contacts/moreau.hpp).
#pragma once

#include <cstddef>

namespace achilles::newton {

// What is taken out of the velocity along n, and the gap rate that remains: their difference is hdot-.
template <class Number>
Number removed_rate(const Number& e, const Number& hdot) {
    return (1.0 + e) * hdot;
}
template <class Number>
Number rate_after(const Number& e, const Number& hdot) {
    return -(e * hdot);
}

// p >= 0. W is that of the motion which holds what stays held.
template <class Number>
Number impulse(const Number& e, const Number& hdot, const Number& W) {
    return -removed_rate(e, hdot) / W;
}

// Of energy: the impact loses this, and a surface that moves at dh/dt = gap_t does this work.
template <class Number>
Number loss(const Number& p, const Number& e, const Number& hdot) {
    return -(0.5 * p * (1.0 - e) * hdot);
}
template <class Number>
Number work(const Number& p, const Number& gap_t) {
    return -(p * gap_t);
}

// x -= n amount. Of velocities: the whole hdot leaves the tangential velocity s, removed_rate() leaves v+. Of positions: h
// moves them onto the surface, to first order.
template <class Number, class Direction>
void move_along(Number* x, std::size_t size, const Direction& n, const Number& amount) {
    for (std::size_t i = 0; i < size; ++i) x[i] = x[i] - n(i) * amount;
}

}  // namespace achilles::newton
