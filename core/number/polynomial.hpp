// Polynomials in the fraction theta of one step, and the first downward zero crossing of such a polynomial.
#pragma once

#include <array>

namespace achilles {

struct Polynomial {
    static constexpr int capacity = 40;
    std::array<double, capacity> c;  // ascending powers; entries above the degree are unspecified
    int degree = 0;

    Polynomial() {}  // leaves the coefficients uninitialized, because they are filled in at once

    double operator()(double theta) const;
    double slope(double theta) const;
    // Value and derivative at the end of the step, theta = 1: the same bits as the functions above, in less than half
    // the time.
    struct EndValue {
        double value = 0.0, slope = 0.0;
    };
    EndValue at_end() const;
};

// The polynomial of degree 4 through the values at theta = 0, 1/4, 1/2, 3/4, 1. Its value at 0 is values[0] exactly.
Polynomial interpolate(const std::array<double, 5>& values);

// The first crossing of a quantity from positive to negative, when the quantity is known up to a remainder. Its use in
// a run: theory-truncation.md 6.
struct FirstCrossing {
    enum class Kind {
        none,        // no crossing: the quantity is not found to become negative
        root,        // a crossing at theta, accurate to the last bit of the polynomial
        undecided,   // from theta on it lies within the remainder, then leaves it upward: a touch, or two roots
        increasing,  // it starts within the remainder and has left it upward at theta
        open         // from theta on it lies within the remainder until the end of the step
    };
    Kind kind = Kind::none;
    double theta = 0.0;
};

// The first crossing in (0, 1] of a quantity that differs from the polynomial by at most `remainder`. A root of
// multiplicity `known` at 0 is divided out first. Roots are isolated by sign variations in the Bernstein basis, of the
// polynomial minus and plus the remainder: no root is missed or invented. If the quantity starts within the remainder
// and increases, the result is `increasing`: a caller that knows the initial value can decide.
FirstCrossing first_descent(const Polynomial& polynomial, int known, double remainder);

}  // namespace achilles
