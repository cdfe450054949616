// Building blocks of inner loops over any number type: sums of powers, and adjacent numbers as one vector.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace achilles {

// c_0 + c_1 t + ... + c_degree t^degree, degree >= 1, where coefficient(k) returns c_k. A value is a number or a vector
// of numbers. Even and odd powers are summed separately, which halves the chain of dependent operations.
template <class Value, class Number, class Coefficient>
Value sum_of_powers(int degree, const Number& t, const Coefficient& coefficient) {
    const Number square = t * t;
    Value even{}, odd{};
    int k = degree;
    if (k % 2 == 0) even = coefficient(k--);
    for (; k > 0; k -= 2) {
        odd = odd * square + coefficient(k);
        even = even * square + coefficient(k - 1);
    }
    return even + t * odd;
}

template <class Number>
struct ValueAndSlope {
    Number value, slope;
};

// Polynomial and derivative by splitting into even and odd powers: with s = x^2, p = a(s) + x b(s) and p' = b + 2 x (a'
// + x b').
template <class Number>
ValueAndSlope<Number> value_and_slope(const Number* c, int degree, const Number& x) {
    const Number s = x * x;
    Number a = 0.0, a_slope = 0.0, b = 0.0, b_slope = 0.0;
    int i = degree;
    if (i % 2 == 0) a = c[i--];
    for (; i > 0; i -= 2) {
        a_slope = a_slope * s + a;
        b_slope = b_slope * s + b;
        b = b * s + c[i];
        a = a * s + c[i - 1];
    }
    return {a + x * b, b + 2.0 * x * (a_slope + x * b_slope)};
}

// Adjacent numbers in memory that are processed together: `most` doubles as one vector, any other type one by one.
template <class Number, std::size_t most>
struct Pack {
    static constexpr std::size_t count = 1;
    using Value = Number;
    static const Number& load(const Number* from) { return *from; }
    template <class Place>
    static void store(const Number& value, Place* to) {
        *to = value;
    }
};
template <std::size_t most>
struct Pack<double, most> {
    static constexpr std::size_t count = most;
    using Value [[gnu::vector_size(most * sizeof(double))]] = double;
    static Value load(const double* from) {
        Value value;
        std::memcpy(&value, from, sizeof value);
        return value;
    }
    static void store(const Value& value, double* to) { std::memcpy(to, &value, sizeof value); }
    // Absolute values.
    static Value size(const Value& value) {
        using Bits [[gnu::vector_size(most * sizeof(double))]] = std::int64_t;
        return reinterpret_cast<Value>(reinterpret_cast<Bits>(value) & std::numeric_limits<std::int64_t>::max());
    }
};

}  // namespace achilles
