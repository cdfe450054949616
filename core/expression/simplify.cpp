// Local simplification: every operator inspects its operands one level deep and returns the simplest equal node it
// finds. Signs and numeric factors move outward, so that like terms meet. No rule may change the value where it is
// defined.
#include <stdexcept>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

using Op = Operation;
using boost::multiprecision::denominator, boost::multiprecision::numerator;

Expression binary(Op operation, Expression a, Expression b) {
    return Builder::make(a.graph(), Graph::Node{operation, a.id(), b.id(), 0});
}

Expression unary(Op operation, Expression a) { return Builder::make(a.graph(), Graph::Node{operation, a.id(), 0, 0}); }

Expression number(Expression like, const Rational& value) { return Builder::number(like.graph(), value); }

// e = factor * rest, where `factor` is the outermost numeric factor.
struct ScaledExpression {
    Rational factor;
    Expression rest;
};

ScaledExpression split(Expression e) {
    if (Builder::is(e, Op::negate)) return {Rational(-1), Builder::first(e)};
    if (Builder::is(e, Op::multiply) && Builder::first(e).is_number())
        return {Builder::value(Builder::first(e)), Builder::second(e)};
    return {Rational(1), e};
}

// Whether split() finds a factor other than 1. Most expressions have none, and exact arithmetic on factors would take a
// third of the time of a derivation.
bool has_factor(Expression e) {
    return Builder::is(e, Op::negate) || (Builder::is(e, Op::multiply) && Builder::first(e).is_number());
}

// Compared by parts: Boost compares rationals by long division, which would take two fifths of a derivation.
bool is(const Rational& value, int whole) { return denominator(value) == 1 && numerator(value) == whole; }

Expression scaled(const Rational& factor, Expression rest) {
    if (factor.is_zero()) return number(rest, 0);
    if (rest.is_number()) return number(rest, Rational(factor * Builder::value(rest)));
    if (is(factor, 1)) return rest;
    if (is(factor, -1)) return unary(Op::negate, rest);
    return binary(Op::multiply, number(rest, factor), rest);
}

// e = base^exponent
std::pair<Expression, int> as_power(Expression e) {
    if (Builder::is(e, Op::power)) return {Builder::first(e), Builder::node(e).exponent};
    return {e, 1};
}

// Folds a power exactly only while the result is small; nested powers would otherwise fill the memory with digits.
bool can_fold(const Rational& base, int exponent) {
    constexpr std::size_t max_bits = 4096;
    const auto bits = msb(abs(numerator(base))) + msb(denominator(base)) + 2;
    return bits * static_cast<std::size_t>(std::abs(static_cast<long>(exponent))) <= max_bits;
}

bool fits(int exponent) { return exponent > -1000 && exponent < 1000; }

}  // namespace

Expression operator-(Expression a) {
    if (Builder::is(a, Op::subtract)) return binary(Op::subtract, Builder::second(a), Builder::first(a));
    const ScaledExpression term = split(a);
    return scaled(Rational(-term.factor), term.rest);
}

Expression operator+(Expression a, Expression b) {
    if (a.is_zero()) return b;
    if (b.is_zero()) return a;
    if (a.is_number() && b.is_number()) return number(a, Rational(Builder::value(a) + Builder::value(b)));
    if (a == b) return number(a, 2) * a;
    if (has_factor(a) || has_factor(b)) {
        const ScaledExpression x = split(a), y = split(b);
        if (x.rest == y.rest) return scaled(Rational(x.factor + y.factor), x.rest);
        if (y.factor.sign() < 0) return a - scaled(Rational(-y.factor), y.rest);
        if (x.factor.sign() < 0) return b - scaled(Rational(-x.factor), x.rest);
    }
    if (b.id() < a.id()) std::swap(a, b);
    return binary(Op::add, a, b);
}

Expression operator-(Expression a, Expression b) {
    if (b.is_zero()) return a;
    if (a == b) return number(a, 0);
    if (a.is_zero()) return -b;
    if (a.is_number() && b.is_number()) return number(a, Rational(Builder::value(a) - Builder::value(b)));
    if (has_factor(a) || has_factor(b)) {
        const ScaledExpression x = split(a), y = split(b);
        if (x.rest == y.rest) return scaled(Rational(x.factor - y.factor), x.rest);
        if (y.factor.sign() < 0) return a + scaled(Rational(-y.factor), y.rest);
    }
    if (b.is_number() && Builder::value(b).sign() < 0) return a + number(b, Rational(-Builder::value(b)));
    // (a + b) - b = a and (a + b) - a = b: both occur in every derivative of a product.
    if (Builder::is(a, Op::add) && Builder::second(a) == b) return Builder::first(a);
    if (Builder::is(a, Op::add) && Builder::first(a) == b) return Builder::second(a);
    return binary(Op::subtract, a, b);
}

Expression operator*(Expression a, Expression b) {
    if (a.is_zero() || b.is_one()) return a;
    if (b.is_zero() || a.is_one()) return b;
    if (a.is_number()) {
        const ScaledExpression term = split(b);
        return scaled(Rational(Builder::value(a) * term.factor), term.rest);
    }
    if (b.is_number()) return b * a;
    if (has_factor(a) || has_factor(b)) {
        const ScaledExpression x = split(a), y = split(b);
        return scaled(Rational(x.factor * y.factor), x.rest * y.rest);
    }
    const auto [base_a, exponent_a] = as_power(a);
    const auto [base_b, exponent_b] = as_power(b);
    if (base_a == base_b && fits(exponent_a + exponent_b)) return power(base_a, exponent_a + exponent_b);
    if (Builder::is(a, Op::sqrt) && a == b) return Builder::first(a);
    if (b.id() < a.id()) std::swap(a, b);
    return binary(Op::multiply, a, b);
}

Expression operator/(Expression a, Expression b) {
    if (b.is_zero()) throw std::domain_error("division by zero");
    if (a.is_zero() || b.is_one()) return a;
    if (a == b) return number(a, 1);
    if (b.is_number()) return number(b, Rational(1 / Builder::value(b))) * a;
    if (has_factor(a) || has_factor(b)) {
        const ScaledExpression x = split(a), y = split(b);
        if (a.is_number()) return number(a, Rational(Builder::value(a) / y.factor)) / y.rest;
        return scaled(Rational(x.factor / y.factor), x.rest / y.rest);
    }
    const auto [base_a, exponent_a] = as_power(a);
    const auto [base_b, exponent_b] = as_power(b);
    if (base_a == base_b && fits(exponent_a - exponent_b)) return power(base_a, exponent_a - exponent_b);
    return binary(Op::divide, a, b);
}

Expression power(Expression base, int exponent) {
    if (exponent == 0) return number(base, 1);
    if (exponent == 1) return base;
    if (exponent == -1) return number(base, 1) / base;
    if (base.is_number() && (base.is_zero() ? exponent > 0 : can_fold(Builder::value(base), exponent))) {
        Rational result = 1;
        for (int i = 0; i < std::abs(exponent); ++i) result *= Builder::value(base);
        return number(base, exponent > 0 ? result : Rational(1 / result));
    }
    if (base.is_zero()) throw std::domain_error("division by zero");
    const auto [inner, inner_exponent] = as_power(base);
    if (inner_exponent != 1 && std::abs(static_cast<long>(inner_exponent) * exponent) < 1000)
        return power(inner, inner_exponent * exponent);
    if (Builder::is(base, Op::sqrt) && exponent % 2 == 0) return power(Builder::first(base), exponent / 2);
    if (Builder::is(base, Op::negate)) {
        const Expression positive = power(Builder::first(base), exponent);
        return exponent % 2 == 0 ? positive : -positive;
    }
    return Builder::make(base.graph(), Graph::Node{Op::power, base.id(), 0, exponent});
}

Expression real_power(Expression base, Expression exponent) {
    if (exponent.is_number()) {
        const Rational& value = Builder::value(exponent);
        if (boost::multiprecision::denominator(value) == 1 && value < 1000 && value > -1000)
            return power(base, value.convert_to<int>());
        if (value == Rational(1, 2)) return apply(Op::sqrt, base);
    }
    if (base.is_one()) return base;
    return binary(Op::real_power, base, exponent);
}

Expression midpoint(Expression x) { return x.is_number() ? x : unary(Op::midpoint, x); }

Expression apply(Operation function, Expression x) {
    if (function == Op::midpoint) return midpoint(x);
    const bool odd = function == Op::sin || function == Op::tan || function == Op::asin || function == Op::atan ||
                     function == Op::sinh || function == Op::tanh;
    const bool even = function == Op::cos || function == Op::cosh;
    if (x.is_zero()) {
        if (odd || function == Op::sqrt) return x;
        if (even || function == Op::exp) return number(x, 1);
    }
    if (x.is_one() && function == Op::log) return number(x, 0);
    if (x.is_one() && function == Op::sqrt) return x;
    const ScaledExpression term = split(x);
    const bool negative = term.factor.sign() < 0;
    if (negative && odd) return -apply(function, -x);
    if (negative && even) return apply(function, -x);
    return unary(function, x);
}

}  // namespace achilles
