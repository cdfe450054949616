// Expressions as quotients of polynomials without a common divisor, to simplify them as a person would.
//
// Atoms are symbols, pi, and functions of simplified arguments. sin^2 + cos^2 = 1, cosh^2 - sinh^2 = 1 and
// sqrt(u)^2 = u are used as reductions. For the files of this library only: see multinomial.hpp.
#pragma once

#include <optional>
#include <unordered_map>

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

}  // namespace achilles
