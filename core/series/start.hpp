// How a series program starts: order 0, and the factors of its rules; over double, or lanes.
#pragma once

#include <cmath>
#include <limits>

#include "number/sine.hpp"
#include "series/series.hpp"

namespace achilles {

template <class Scalar>
Scalar function_value(Operation function, const Scalar& a) {
    using std::acos, std::asin, std::atan, std::log;
    switch (function) {
        case Operation::log:
            return log(a);
        case Operation::asin:
            return asin(a);
        case Operation::acos:
            return acos(a);
        case Operation::atan:
            return atan(a);
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

template <class Scalar>
Scalar combined(Operation operation, const Scalar& a, const Scalar& b) {
    switch (operation) {
        case Operation::add:
            return a + b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::negate:
            return -a;
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

// What depends on the parameters alone.
template <class Scalar>
void SeriesProgram::fix_coefficients(const Scalar* registers, Scalar* coefficients) const {
    coefficients[0] = 1.0;
    for (std::size_t i = 1; i < coefficients_.size(); ++i) {
        const Coefficient& c = coefficients_[i];
        coefficients[i] = c.operation == Operation::number
                              ? registers[c.a]
                              : combined<Scalar>(c.operation, coefficients[c.a], coefficients[c.b]);
    }
}
template <class Scalar>
void SeriesProgram::fix(const Scalar* registers, Scalar* coefficients, std::array<Scalar, 3>* factors) const {
    fix_coefficients(registers, coefficients);
    for (const Combination& c : combinations_)
        for (std::size_t i = 0; i < 3; ++i) factors[c.rule][i] = coefficients[c.coefficient[i]];
}

// The program itself gives order 0 of its registers z; here follow the hidden ones, and the factors of the rules.
template <class Scalar>
void SeriesProgram::start(Scalar* z, const Scalar* coefficients, std::array<Scalar, 3>* factors) const {
    using std::cosh, std::exp, std::pow, std::sinh, std::sqrt, std::tan, std::tanh;
    for (const Seed& seed : seeds_) {
        const Scalar a = z[seed.a.value], b = z[seed.b.value];
        const Scalar by_a = coefficients[seed.a.scale], by_b = coefficients[seed.b.scale];
        const double sign = seed.sign;
        std::array<Scalar, 3>* const rule = factors + seed.rule;
        Scalar& r = z[seed.result.value];
        const bool hidden = seed.result.value >= hidden_;
        switch (seed.kind) {
            case Kind::multiply:
                if (hidden) r = a * b;
                rule[0] = {a * by_b, b * by_a, by_a * by_b};
                break;
            case Kind::square:
                if (hidden) r = a * a;
                rule[0] = {2.0 * a * by_a, 0.0, by_a * by_a};
                break;
            case Kind::unit_and_square:
                if (hidden) r = 1.0 + sign * (a * a);
                rule[0] = {sign * 2.0 * a * by_a, 0.0, sign * by_a * by_a};
                break;
            case Kind::divide: {
                if (hidden) r = sign < 0.0 ? 1.0 / b : a / b;
                const Scalar inverse = 1.0 / b;
                rule[0] = {by_a * inverse, -(r * by_b * inverse), -(by_b * inverse)};
                break;
            }
            case Kind::sqrt: {
                if (hidden) r = sqrt(a);
                const Scalar inverse = 0.5 / r;
                rule[0] = {by_a * inverse, 0.0, -inverse};
                break;
            }
            case Kind::exp:
                if (hidden) r = exp(a);
                rule[0] = {by_a * r, 0.0, by_a};
                break;
            case Kind::sin_cos: {
                Scalar& c = z[seed.partner.value];
                if (sign < 0.0) {
                    if (hidden || seed.partner.value >= hidden_) sine_and_cosine(a, r, c);
                } else {
                    if (hidden) r = sinh(a);
                    if (seed.partner.value >= hidden_) c = cosh(a);
                }
                rule[0] = {by_a * c, 0.0, by_a};
                rule[1] = {sign * by_a * r, 0.0, sign * by_a};
                break;
            }
            case Kind::tangent: {
                if (hidden) r = sign > 0.0 ? tan(a) : tanh(a);
                const Scalar w = z[seed.partner.value] = 1.0 + sign * (r * r);
                rule[0] = {by_a * w, 0.0, by_a};
                rule[1] = {sign * 2.0 * r, 0.0, sign};
                break;
            }
            case Kind::integral_of_ratio: {
                if (hidden) r = function_value(seed.function, a);
                const Scalar inverse = 1.0 / b;
                rule[0] = {sign * by_a * inverse, 0.0, -(by_b * inverse)};
                break;
            }
            case Kind::power: {
                // a p' = e a' p:  a_0 p_k = e (a_k p_0 + sum j a_j p_{k-j}/k) - sum j p_j a_{k-j}/k
                if (hidden) r = pow(a, b);
                const Scalar inverse = by_a / a;
                rule[0] = {b * r * inverse, b * inverse, -inverse};
                break;
            }
        }
    }
}

}  // namespace achilles
