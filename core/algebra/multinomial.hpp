// Polynomials in several atoms with exact integer coefficients: what simplification is made of. For the files of this
// library only: it needs Boost.Multiprecision.
//
// An atom is a number from 0 to most_atoms - 1; what stands behind it (a symbol, a sine) is the algebra's business.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace achilles {

using Integer = boost::multiprecision::cpp_int;

// More work than a simplification may cost, more atoms, or powers and coefficients that are too large.
struct TooLong : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What simplification may still cost, in products of two terms.
struct Work {
    long left = 0;
    void spend(std::size_t products);  // throws TooLong
};

inline constexpr std::size_t most_atoms = 48;

// The exponents of a product of powers of atoms.
using Monomial = std::array<std::uint8_t, most_atoms>;

class Multinomial {
 public:
    struct Term {
        Monomial powers;
        Integer coefficient;
        friend bool operator==(const Term&, const Term&) = default;
    };

    Multinomial() = default;
    explicit Multinomial(const Integer& value);
    static Multinomial atom(std::size_t index);
    // The sum of any terms.
    explicit Multinomial(std::vector<Term> terms);

    const std::vector<Term>& terms() const { return terms_; }  // no two alike, none 0, the highest first
    bool is_zero() const { return terms_.empty(); }
    bool is_number() const;
    bool is_one() const;
    Integer number() const;  // of is_number()
    int degree(std::size_t atom) const;
    std::vector<std::size_t> atoms() const;  // those it depends on
    // The coefficients of the powers 0, 1, .. of an atom.
    std::vector<Multinomial> coefficients(std::size_t atom) const;
    // The greatest common divisor of its numbers, and of its monomials.
    Integer number_content() const;
    Monomial monomial_content() const;

    friend bool operator==(const Multinomial&, const Multinomial&) = default;

 private:
    std::vector<Term> terms_;
};

Multinomial operator+(const Multinomial& a, const Multinomial& b);
Multinomial operator-(const Multinomial& a, const Multinomial& b);
Multinomial operator-(const Multinomial& a);
Multinomial times(const Multinomial& a, const Multinomial& b, Work& work);
Multinomial times(const Multinomial& a, const Multinomial::Term& term);
Multinomial power(const Multinomial& a, int exponent, Work& work);  // exponent >= 0
Multinomial derivative(const Multinomial& a, std::size_t atom);

// a/b where that is a polynomial with integer coefficients, else nothing.
std::optional<Multinomial> divide(const Multinomial& a, const Multinomial& b, Work& work);
// The quotient where the division is known to leave no rest.
Multinomial quotient(const Multinomial& a, const Multinomial& b, Work& work);

// The greatest common divisor over the integers, its highest coefficient positive; 0 of two zeros.
Multinomial gcd(const Multinomial& a, const Multinomial& b, Work& work);
// The greatest common divisor of the coefficients of an atom's powers.
Multinomial content(const Multinomial& a, std::size_t atom, Work& work);

}  // namespace achilles
