// A double with its derivatives in eight directions. Functions of it are those of jet.hpp.
#pragma once

#include <cstddef>

#include "number/lanes.hpp"

#define IN_LANES [[gnu::always_inline]] inline

namespace achilles {

// The derivatives are stored in vectors of `Bytes` bytes. Like Lanes, its arithmetic is compiled for the vector size of
// the processor. The layout in memory does not depend on `Bytes`.
template <std::size_t Bytes>
struct Jet8 {
    using Component = double;
    static constexpr std::size_t directions = Double8::count;
    Lanes<Bytes> slope;
    double value;

    Jet8() = default;
    IN_LANES Jet8(double x) : slope(0.0), value(x) {}  // NOLINT: a constant
    IN_LANES Jet8(double x, const Lanes<Bytes>& by) : slope(by), value(x) {}
    // The independent variable of direction i.
    static Jet8 variable(double x, std::size_t i) {
        Jet8 result(x);
        result.slope.set(i, 1.0);
        return result;
    }

    // f(x) by the chain rule: f is f(x) and by_x is f'(x).
    IN_LANES friend Jet8 chain(const Jet8& x, double f, double by_x) { return {f, by_x * x.slope}; }
    // x with a b' added to its derivatives.
    IN_LANES friend Jet8 and_slope(const Jet8& x, double a, const Jet8& b) { return {x.value, x.slope + a * b.slope}; }
    IN_LANES friend Jet8 operator-(const Jet8& a) { return {-a.value, -a.slope}; }
    IN_LANES friend Jet8 operator+(const Jet8& a, const Jet8& b) { return {a.value + b.value, a.slope + b.slope}; }
    IN_LANES friend Jet8 operator-(const Jet8& a, const Jet8& b) { return {a.value - b.value, a.slope - b.slope}; }
    IN_LANES friend Jet8 operator*(const Jet8& a, const Jet8& b) {
        Jet8 result;  // scalar factors: converting them to Lanes first would cost an addition
        result.value = a.value * b.value;
        for (std::size_t p = 0; p < parts; ++p)
            result.slope.part[p] = a.slope.part[p] * b.value + a.value * b.slope.part[p];
        return result;
    }
    IN_LANES friend Jet8 operator*(const Jet8& a, double b) { return {a.value * b, a.slope * b}; }
    IN_LANES friend Jet8 operator*(double a, const Jet8& b) { return b * a; }
    // (a/b)' = (a' - (a/b) b')/b
    IN_LANES friend Jet8 operator/(const Jet8& a, const Jet8& b) {
        const double ratio = a.value / b.value;
        return {ratio, (a.slope - ratio * b.slope) / b.value};
    }
    IN_LANES friend Jet8& operator+=(Jet8& a, const Jet8& b) { return a = a + b; }

 private:
    static constexpr std::size_t parts = sizeof(Double8) / Bytes;
};

}  // namespace achilles

#undef IN_LANES
