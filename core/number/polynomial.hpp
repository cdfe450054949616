// Polynomials in the fraction theta of one step, and their first root.
#pragma once

#include <array>

namespace achilles {

struct Polynomial {
    static constexpr int capacity = 40;
    std::array<double, capacity> c;  // ascending powers; what is above the degree has no meaning
    int degree = 0;

    Polynomial() {}  // what is filled in at once need not be zero before

    double operator()(double theta) const;
    double slope(double theta) const;
    // Value and slope where the step ends, at theta = 1: the same bits, in less than half of the time.
    struct End {
        double value = 0.0, slope = 0.0;
    };
    End at_end() const;
};

// The polynomial of degree 4 through values at theta = 0, 1/4, 1/2, 3/4, 1. The first value is met exactly.
Polynomial interpolate(const std::array<double, 5>& values);

// Where a quantity that is known to within a remainder first goes from positive to negative. What a run makes of it
// stands in theory-truncation.md 6.
struct Descent {
    enum class Kind {
        none,       // it stays positive
        root,       // it does at theta, to the last bit of the polynomial
        undecided,  // from theta on it lies inside the remainder and comes out above: a touch, or two roots
        rose,       // the same from 0 on: it starts inside the remainder, and has left it at theta
        open        // from theta on it lies inside the remainder until the end of the step
    };
    Kind kind = Kind::none;
    double theta = 0.0;
};

// The first descent in (0, 1] of a polynomial from which the true quantity differs by at most `remainder`, with a root
// of multiplicity `known` at 0 divided out first. Roots are isolated by sign variations in the Bernstein basis, of the
// polynomial raised and lowered by the remainder, so that no two roots inside one step are missed and none is invented.
// Of a quantity that starts inside the remainder and rises nothing is known: whoever knows where it starts may decide.
Descent first_descent(const Polynomial& polynomial, int known, double remainder);

}  // namespace achilles
