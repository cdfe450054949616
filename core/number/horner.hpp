// Sums of powers over any number, the even and the odd powers by themselves: half as many sums wait for one another.
#pragma once

namespace achilles {

// c_0 + c_1 t + ... + c_degree t^degree, degree >= 1, of values that the coefficients' type adds up: numbers, or some
// side by side. coefficient(k) is c_k.
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

// p = a(s) + x b(s) and p' = b + 2 x (a' + x b') at s = x^2.
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

}  // namespace achilles
