// A double with its derivatives in eight directions side by side, in vectors of so many bytes: a jet (number/jet.hpp) whose
// arithmetic is compiled for the vectors that a processor has, as that of lanes is.
#pragma once

#include "number/lanes.hpp"

#define IN_LANES [[gnu::always_inline]] inline

namespace achilles {

template <std::size_t Bytes>
struct Directed {
    using Component = double;
    static constexpr std::size_t directions = Eight::count;
    Lanes<Bytes> slope;
    double value;

    Directed() = default;
    IN_LANES Directed(double x) : slope(0.0), value(x) {}  // NOLINT: a constant
    IN_LANES Directed(double x, const Lanes<Bytes>& by) : slope(by), value(x) {}
    // The variable of direction i.
    static Directed variable(double x, std::size_t i) {
        Directed result(x);
        result.slope.set(i, 1.0);
        return result;
    }

    // f(x) where f'(x) is given.
    IN_LANES friend Directed chain(const Directed& x, double f, double by_x) { return {f, by_x * x.slope}; }
    // x, which rises by a b' besides.
    IN_LANES friend Directed and_slope(const Directed& x, double a, const Directed& b) {
        return {x.value, x.slope + a * b.slope};
    }
    IN_LANES friend Directed operator-(const Directed& a) { return {-a.value, -a.slope}; }
    IN_LANES friend Directed operator+(const Directed& a, const Directed& b) {
        return {a.value + b.value, a.slope + b.slope};
    }
    IN_LANES friend Directed operator-(const Directed& a, const Directed& b) {
        return {a.value - b.value, a.slope - b.slope};
    }
    IN_LANES friend Directed operator*(const Directed& a, const Directed& b) {
        Directed result;  // by the numbers themselves: a number that was made lanes before costs a sum
        result.value = a.value * b.value;
        for (std::size_t p = 0; p < parts; ++p)
            result.slope.part[p] = a.slope.part[p] * b.value + a.value * b.slope.part[p];
        return result;
    }
    IN_LANES friend Directed operator*(const Directed& a, double b) { return {a.value * b, a.slope * b}; }
    IN_LANES friend Directed operator*(double a, const Directed& b) { return b * a; }
    // (a/b)' = (a' - (a/b) b')/b
    IN_LANES friend Directed operator/(const Directed& a, const Directed& b) {
        const double ratio = a.value / b.value;
        return {ratio, (a.slope - ratio * b.slope) / b.value};
    }
    IN_LANES friend Directed& operator+=(Directed& a, const Directed& b) { return a = a + b; }

 private:
    static constexpr std::size_t parts = sizeof(Eight) / Bytes;
};

}  // namespace achilles

#undef IN_LANES
