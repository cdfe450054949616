// Newton's impact law and its consequences, for doubles, intervals and numbers with derivatives.
//
//     v+ = v- - n (1 + e) hdot-,   n = M^-1 g'/W,   W = g M^-1 g',   g = dh     (paper (4))
//     hdot+ = -e hdot-,   p = -(1 + e) hdot-/W,   loss = p (1 - e) |hdot-|/2,   work = -p dh/dt
//
// The kinetic energy never increases if 0 <= e <= 1. Impacts of several contacts follow Moreau's law
// (contacts/moreau.hpp).
#pragma once

#include <cmath>
#include <cstddef>

namespace achilles::newton {

// The change of the gap rate, (1 + e) hdot-, and the gap rate after the impact, -e hdot-.
template <class Number>
Number removed_rate(const Number& e, const Number& hdot) {
    return (1.0 + e) * hdot;
}
template <class Number>
Number rate_after(const Number& e, const Number& hdot) {
    return -(e * hdot);
}

// The speed of the slip at the end of the compression, |u+ + e u-|/(1 + e), by the slips before and after the impact.
// The coefficient of friction is taken there (theory-friction.md 3).
inline double slip_speed(double after, double e, double before) { return std::abs(after + e * before) / (1.0 + e); }

// The impulse p >= 0. W belongs to the mode of the contacts that stay held.
template <class Number>
Number impulse(const Number& e, const Number& hdot, const Number& W) {
    return -removed_rate(e, hdot) / W;
}

// The energy that the impact dissipates, and the work of a contact surface that moves with dh/dt = gap_t.
template <class Number>
Number loss(const Number& p, const Number& e, const Number& hdot) {
    return -(0.5 * p * (1.0 - e) * hdot);
}
template <class Number>
Number work(const Number& p, const Number& gap_t) {
    return -(p * gap_t);
}

// x -= n amount. For a velocity, the amount hdot gives the tangential velocity s, and removed_rate() gives v+. For a
// position, the amount h moves it onto the contact surface, to first order.
template <class Number, class Direction>
void move_along(Number* x, std::size_t size, const Direction& n, const Number& amount) {
    for (std::size_t i = 0; i < size; ++i) x[i] = x[i] - n(i) * amount;
}

}  // namespace achilles::newton
