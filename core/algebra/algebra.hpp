// Expressions as quotients of polynomials without a common divisor, to simplify them as a person would.
//
// Atoms are symbols, pi, and functions of simplified arguments. sin^2 + cos^2 = 1, cosh^2 - sinh^2 = 1 and
// sqrt(u)^2 = u are used as reductions. For the files of this library only: see multinomial.hpp.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <functional>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "algebra/multinomial.hpp"
#include "expression/expression.hpp"

namespace achilles {

// numerator/denominator, coprime, the denominator's highest coefficient positive.
struct Fraction {
    Multinomial numerator, denominator{1};
    bool is_zero() const { return numerator.is_zero(); }
    friend bool operator==(const Fraction&, const Fraction&) = default;
};

class Algebra {
 public:
    // Atoms and nodes are made in the graph. At most `work` products of terms are spent; what would take more throws
    // TooLong, here as everywhere below. With `expand_angles` sines and cosines of sums become products.
    Algebra(Graph& graph, Work work, bool expand_angles = false);

    // Throws std::domain_error where a denominator is 0 everywhere.
    Fraction simplify(Expression expression);
    Expression expression(const Fraction& fraction);
    Expression expression(const Multinomial& polynomial);

    Fraction add(const Fraction& a, const Fraction& b);
    Fraction multiply(const Fraction& a, const Fraction& b);
    Fraction divide(const Fraction& a, const Fraction& b);

    // The polynomial after the reductions above, and the same with cos^2 replaced instead of sin^2 for one cosine.
    Multinomial reduced(Multinomial polynomial);
    Multinomial with_sines(const Multinomial& polynomial, std::size_t cosine);

    Expression atom(std::size_t index) const { return atoms_[index].expression; }
    std::size_t atom_count() const { return atoms_.size(); }
    // The atom behind an expression, if there is one already.
    std::optional<std::size_t> find(Expression expression) const;
    // What the square of an atom is replaced by.
    const std::optional<Multinomial>& square(std::size_t index) const { return atoms_[index].square; }
    // The sine with the same argument, for a cosine.
    std::optional<std::size_t> sine_of(std::size_t index) const { return atoms_[index].sine; }
    Graph& graph() const { return graph_; }
    Work& work() { return work_; }

 private:
    struct Atom {
        Expression expression;
        std::optional<Multinomial> square;
        std::optional<std::size_t> sine;
    };
    std::size_t atom_of(Expression expression);
    Fraction coprime(Multinomial numerator, Multinomial denominator);
    Fraction power(const Fraction& base, int exponent);
    Fraction node(Expression e, const Fraction& a, const Fraction& b);
    Fraction function(Operation operation, const Fraction& argument);
    struct Pair {
        Fraction sine, cosine;
    };
    Pair sine_and_cosine(const Fraction& angle);

    Graph& graph_;
    Work work_;
    bool expand_angles_;
    std::vector<Atom> atoms_;
    std::unordered_map<std::uint32_t, std::size_t> index_;  // by node
};

// Simplified expressions as products, and proofs that a factor is positive.

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
