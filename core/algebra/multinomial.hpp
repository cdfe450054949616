// Polynomials in several atoms with exact integer coefficients, the basis of simplification. For the files of this
// library only, because it needs Boost.Multiprecision.
//
// An atom is the number of a symbol or function, below max_atoms. The class Algebra stores the symbol or function.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace achilles {

using Integer = boost::multiprecision::cpp_int;

// Thrown if a simplification takes too much work, too many atoms, or too large powers or coefficients.
struct SimplificationLimit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The work left for a simplification, in products of two terms.
struct Work {
    long left = 0;
    void spend(std::size_t products);  // throws SimplificationLimit
};

inline constexpr std::size_t max_atoms = 48;

// The exponents of a product of powers, by atom.
using Monomial = std::array<std::uint8_t, max_atoms>;

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
    // The sum of the terms, which may repeat and be in any order.
    explicit Multinomial(std::vector<Term> terms);
    // The same for distinct, nonzero terms, the highest first.
    static Multinomial of_sorted(std::vector<Term> terms);

    const std::vector<Term>& terms() const { return terms_; }  // distinct, nonzero, the highest first
    bool is_zero() const { return terms_.empty(); }
    bool is_number() const;
    bool is_one() const;
    Integer number() const;  // requires is_number()
    int degree(std::size_t atom) const;
    std::vector<std::size_t> atoms() const;  // the atoms that it depends on
    // The coefficients of the powers 0, 1, ... of an atom.
    std::vector<Multinomial> coefficients(std::size_t atom) const;
    // The greatest common divisor of the coefficients, and that of the monomials.
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

// a/b if that is a polynomial with integer coefficients, else nullopt.
std::optional<Multinomial> divide(const Multinomial& a, const Multinomial& b, Work& work);
// The quotient of a division that is known to be exact.
Multinomial quotient(const Multinomial& a, const Multinomial& b, Work& work);

// The greatest common divisor over the integers, with positive leading coefficient; gcd(0, 0) = 0.
Multinomial gcd(const Multinomial& a, const Multinomial& b, Work& work);
// The greatest common divisor of the coefficients of an atom's powers.
Multinomial content(const Multinomial& a, std::size_t atom, Work& work);

}  // namespace achilles
