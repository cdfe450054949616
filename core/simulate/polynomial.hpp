// Polynomials in the fraction theta of one step, and their first root.
#pragma once

#include <array>
#include <optional>

namespace achilles {

struct Polynomial {
    static constexpr int capacity = 40;
    std::array<double, capacity> c{};  // ascending powers
    int degree = 0;

    double operator()(double theta) const;
    double slope(double theta) const;
};

// The polynomial of degree 4 through values at theta = 0, 1/4, 1/2, 3/4, 1. The first value is met exactly.
Polynomial interpolate(const std::array<double, 5>& values);

// The first theta in (0, 1] at which the polynomial goes from positive to negative (or reaches 0 at 1), with a root of
// multiplicity `known` at 0 divided out first. Roots are isolated by sign variations in the Bernstein basis, so two
// roots inside one step are both seen; a touch without a change of sign is no root.
std::optional<double> first_descent(const Polynomial& polynomial, int known);

}  // namespace achilles
