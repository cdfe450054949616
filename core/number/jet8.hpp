// A double with its derivatives in eight directions. Functions of it are those of jet.hpp.
#pragma once

#include <cstddef>
#include <iterator>

#include "number/lanes.hpp"

namespace achilles {

// It uses the vectors that every processor has. The loops of Jet<double, 8> are slower.
struct Jet8 {
    using Component = double;
    using Slopes = Lanes<16>;
    Slopes slope;
    double value;

    Jet8() = default;
    Jet8(double x) : slope(0.0), value(x) {}  // NOLINT: a constant
    Jet8(double x, const Slopes& by) : slope(by), value(x) {}
    // The independent variable of direction i.
    static Jet8 variable(double x, std::size_t i) {
        Jet8 result(x);
        result.slope.set(i, 1.0);
        return result;
    }

    // f(x) by the chain rule: f is f(x) and by_x is f'(x).
    friend Jet8 chain(const Jet8& x, double f, double by_x) { return {f, by_x * x.slope}; }
    // The value of x, with the derivatives of x plus a times those of b.
    friend Jet8 and_slope(const Jet8& x, double a, const Jet8& b) { return {x.value, x.slope + a * b.slope}; }
    friend Jet8 operator-(const Jet8& a) { return {-a.value, -a.slope}; }
    friend Jet8 operator+(const Jet8& a, const Jet8& b) { return {a.value + b.value, a.slope + b.slope}; }
    friend Jet8 operator-(const Jet8& a, const Jet8& b) { return {a.value - b.value, a.slope - b.slope}; }
    friend Jet8 operator*(const Jet8& a, const Jet8& b) {
        Jet8 result;  // the factors stay scalar: converting them to Lanes first would cost an addition
        result.value = a.value * b.value;
        for (std::size_t p = 0; p < std::size(result.slope.part); ++p)
            result.slope.part[p] = a.slope.part[p] * b.value + a.value * b.slope.part[p];
        return result;
    }
    friend Jet8 operator*(const Jet8& a, double b) { return {a.value * b, a.slope * b}; }
    friend Jet8 operator*(double a, const Jet8& b) { return b * a; }
    // (a/b)' = (a' - (a/b) b')/b
    friend Jet8 operator/(const Jet8& a, const Jet8& b) {
        const double ratio = a.value / b.value;
        return {ratio, (a.slope - ratio * b.slope) / b.value};
    }
    friend Jet8& operator+=(Jet8& a, const Jet8& b) { return a = a + b; }
};

}  // namespace achilles
