// Simplified expressions as products, and proofs that a factor is positive. For the files of this library only: see
// multinomial.hpp.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <functional>
#include <set>
#include <vector>

#include "algebra/algebra.hpp"

namespace achilles {

// number times bases to integer powers. The bases are primitive: no number divides them; no two are alike.
struct Factored {
    struct Factor {
        Multinomial base;
        int exponent = 1;
    };
    boost::multiprecision::cpp_rational number = 1;
    std::vector<Factor> factors;
};

// The factors that greatest common divisors find: atoms, what some of the atoms share, what is repeated. A factor in
// 1 - cos^2 is written as sin^2 where that is shorter.
Factored factor(const Fraction& fraction, Algebra& algebra);

Factored operator*(Factored a, const Factored& b);
Fraction expand(const Factored& factored, Algebra& algebra);

// What is known of the sign of an atom that depends on parameters alone.
enum class Sign { unknown, not_negative, positive };

// Proves that polynomials are positive at every real value of the symbols whose sign is not known, and remembers what
// it took to be positive.
class Positivity {
 public:
    // `sign_of` tells the sign of symbols and of functions of them, where it is known.
    Positivity(const Algebra& algebra, std::function<Sign(Expression)> sign_of)
        : algebra_(algebra), sign_of_(std::move(sign_of)) {}

    // Sums of products of what is not negative, one of them positive, after |sin|, |cos| <= 1 in what is subtracted. Of
    // a polynomial that is known not to be 0 (a denominator) it is enough that it is not negative.
    bool is_positive(const Multinomial& polynomial, bool not_zero = false);

    // The atoms whose sign was used.
    const std::set<std::size_t>& used() const { return used_; }

 private:
    Sign sign(std::size_t atom);
    const Algebra& algebra_;
    std::function<Sign(Expression)> sign_of_;
    std::vector<int> known_;  // by atom, -1: not asked yet
    std::set<std::size_t> used_;
};

}  // namespace achilles
