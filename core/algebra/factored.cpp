#include "algebra/factored.hpp"

#include <algorithm>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

using boost::multiprecision::cpp_rational;
using Term = Multinomial::Term;

void put(Factored& result, const Multinomial& base, int exponent) {
    for (Factored::Factor& factor : result.factors)
        if (factor.base == base) {
            factor.exponent += exponent;
            return;
        }
    result.factors.push_back({base, exponent});
}

void scale(Factored& result, const Integer& number, int exponent) {
    for (int i = 0; i < std::abs(exponent); ++i)
        result.number *= exponent > 0 ? cpp_rational(number) : cpp_rational(1, number);
}

class Splitter {
 public:
    Splitter(Algebra& algebra, Factored& result) : algebra_(algebra), work_(algebra.work()), result_(result) {}

    // Puts the factors of a polynomial that is not 0.
    void split(const Multinomial& polynomial, int exponent) {
        const Integer number = polynomial.terms().front().coefficient < 0 ? Integer(-polynomial.number_content())
                                                                          : polynomial.number_content();
        const Monomial powers = polynomial.monomial_content();
        scale(result_, number, exponent);
        for (std::size_t i = 0; i < most_atoms; ++i)
            if (powers[i] > 0) put(result_, Multinomial::atom(i), powers[i] * exponent);
        split_primitive(quotient(polynomial, Multinomial({Term{powers, number}}), work_), exponent);
    }

 private:
    void split_primitive(const Multinomial& polynomial, int exponent) {
        if (polynomial.is_number()) return scale(result_, polynomial.number(), exponent);
        for (const std::size_t atom : polynomial.atoms()) {
            const Multinomial shared = content(polynomial, atom, work_);
            if (shared.is_number()) continue;
            split(shared, exponent);
            return split(quotient(polynomial, shared, work_), exponent);
        }
        for (const std::size_t atom : polynomial.atoms()) {
            if (polynomial.degree(atom) < 2) continue;
            const Multinomial repeated = gcd(polynomial, derivative(polynomial, atom), work_);
            if (repeated.is_number()) continue;
            split(repeated, exponent);
            return split(quotient(polynomial, repeated, work_), exponent);
        }
        for (const std::size_t atom : polynomial.atoms()) {
            if (polynomial.degree(atom) < 2 || !algebra_.sine_of(atom)) continue;
            const Multinomial other = algebra_.with_sines(polynomial, atom);
            if (other.terms().size() < polynomial.terms().size()) return split(other, exponent);
        }
        put(result_, polynomial, exponent);
    }

    Algebra& algebra_;
    Work& work_;
    Factored& result_;
};

}  // namespace

Factored factor(const Fraction& fraction, Algebra& algebra) {
    Factored result;
    if (fraction.is_zero()) {
        result.number = 0;
        return result;
    }
    Splitter splitter(algebra, result);
    splitter.split(fraction.numerator, 1);
    splitter.split(fraction.denominator, -1);
    // sqrt(u) u is sqrt(u)^3.
    for (Factored::Factor& root : result.factors) {
        const auto atom = root.base.atoms();
        if (root.base.terms().size() != 1 || atom.size() != 1 || !algebra.square(atom[0])) continue;
        for (Factored::Factor& other : result.factors)
            if (other.base == *algebra.square(atom[0]) && (other.exponent > 0) == (root.exponent > 0))
                root.exponent += 2 * std::exchange(other.exponent, 0);
    }
    std::erase_if(result.factors, [](const Factored::Factor& factor) { return factor.exponent == 0; });
    return result;
}

Factored operator*(Factored a, const Factored& b) {
    a.number *= b.number;
    for (const Factored::Factor& factor : b.factors) put(a, factor.base, factor.exponent);
    std::erase_if(a.factors, [](const Factored::Factor& factor) { return factor.exponent == 0; });
    return a;
}

Fraction expand(const Factored& factored, Algebra& algebra) {
    Fraction result{Multinomial(numerator(factored.number)), Multinomial(denominator(factored.number))};
    for (const auto& [base, exponent] : factored.factors)
        for (int i = 0; i < std::abs(exponent); ++i)
            result = exponent > 0 ? algebra.multiply(result, {base}) : algebra.divide(result, {base});
    return result;
}

Sign Positivity::sign(std::size_t atom) {
    if (known_.size() <= atom) known_.resize(algebra_.atom_count(), -1);
    if (known_[atom] < 0) {
        const Expression e = algebra_.atom(atom);
        const Operation operation = Builder::node(e).operation;
        Sign sign = sign_of_(e);
        if (operation == Operation::pi || operation == Operation::exp || operation == Operation::cosh)
            sign = Sign::positive;
        if (sign == Sign::unknown && (operation == Operation::sqrt || operation == Operation::real_power))
            sign = algebra_.square(atom) && is_positive(*algebra_.square(atom)) ? Sign::positive : Sign::not_negative;
        known_[atom] = static_cast<int>(sign);
    }
    return static_cast<Sign>(known_[atom]);
}

bool Positivity::is_positive(const Multinomial& polynomial, bool not_zero) {
    std::vector<Term> bound;
    std::vector<std::size_t> asked;
    for (const Term& term : polynomial.terms()) {
        Term low = term;
        bool signs_known = true, dropped = false;
        Term largest = term;  // its absolute value at most, with sin and cos at most 1
        bool bounded = true;
        for (std::size_t i = 0; i < most_atoms; ++i) {
            if (term.powers[i] == 0) continue;
            const Operation operation = Builder::node(algebra_.atom(i)).operation;
            const bool odd = term.powers[i] % 2 == 1, known = odd && sign(i) != Sign::unknown;
            const bool wave = operation == Operation::sin || operation == Operation::cos;
            if (odd && known) asked.push_back(i);
            if (odd && !known) signs_known = false;
            if (wave && !known) {
                dropped = true;
                largest.powers[i] = 0;
            } else if (odd && !known) {
                bounded = false;
            }
        }
        if (term.coefficient > 0 && signs_known) {
            if (!dropped) bound.push_back(low);
        } else if (bounded) {
            largest.coefficient = -abs(largest.coefficient);
            bound.push_back(largest);
        } else {
            return false;
        }
    }
    const Multinomial least(std::move(bound));
    bool positive = not_zero;
    for (const Term& term : least.terms()) {
        if (term.coefficient < 0) return false;
        bool strict = true;
        for (std::size_t i = 0; i < algebra_.atom_count(); ++i)
            if (term.powers[i] > 0) {
                strict = strict && sign(i) == Sign::positive;
                if (sign(i) != Sign::unknown) asked.push_back(i);
            }
        positive = positive || strict;
    }
    if (positive) used_.insert(asked.begin(), asked.end());
    return positive;
}

}  // namespace achilles
