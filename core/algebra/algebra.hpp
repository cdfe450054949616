// Expressions as quotients of coprime polynomials, to simplify them.
//
// Atoms are symbols, pi, and functions of simplified arguments. The reductions are sin^2 + cos^2 = 1, cosh^2 - sinh^2 =
// 1 and sqrt(u)^2 = u. For the files of this library only: see multinomial.hpp.
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

// numerator/denominator, coprime; the leading coefficient of the denominator is positive.
struct Fraction {
    Multinomial numerator, denominator{1};
    bool is_zero() const { return numerator.is_zero(); }
    friend bool operator==(const Fraction&, const Fraction&) = default;
};

class Algebra {
 public:
    // Creates atoms and nodes in the graph. `work` limits the number of products of terms; beyond it all functions
    // throw SimplificationLimit. If `expand_angles`, sines and cosines of sums are expanded into products.
    Algebra(Graph& graph, Work work, bool expand_angles = false);

    // Throws std::domain_error if a denominator is identically 0.
    Fraction simplify(Expression expression);
    Expression expression(const Fraction& fraction);
    Expression expression(const Multinomial& polynomial);

    Fraction add(const Fraction& a, const Fraction& b);
    Fraction multiply(const Fraction& a, const Fraction& b);
    Fraction divide(const Fraction& a, const Fraction& b);

    // The polynomial after the reductions above.
    Multinomial reduced(Multinomial polynomial);
    Multinomial with_sines(const Multinomial& polynomial, std::size_t cosine);

    Expression atom(std::size_t index) const { return atoms_[index].expression; }
    std::size_t atom_count() const { return atoms_.size(); }
    // The atom of an expression, if it exists already.
    std::optional<std::size_t> find(Expression expression) const;
    // The polynomial that replaces the square of an atom, if there is one.
    const std::optional<Multinomial>& square(std::size_t index) const { return atoms_[index].square; }
    // For a cosine, the atom of the sine with the same argument.
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
    std::unordered_map<std::uint32_t, std::size_t> index_;  // by id of the node
};

// number times bases to integer powers. The bases are primitive (their coefficients have no common divisor) and
// distinct.
struct FactoredForm {
    struct Factor {
        Multinomial base;
        int exponent = 1;
    };
    boost::multiprecision::cpp_rational number = 1;
    std::vector<Factor> factors;
};

// Factors found by greatest common divisors: atoms, common contents, repeated factors. A factor with 1 - cos^2 is
// written with sin^2 if that has fewer terms.
FactoredForm factor(const Fraction& fraction, Algebra& algebra);

FactoredForm operator*(FactoredForm a, const FactoredForm& b);
Fraction expand(const FactoredForm& factored, Algebra& algebra);

// What is known about the sign of an atom.
enum class Sign { unknown, not_negative, positive };

// Proves that polynomials are positive for all real values of the symbols of unknown sign. Records the atoms whose
// known sign was used.
class Positivity {
 public:
    // `sign_of` returns the sign of a symbol, or of a function of symbols, if it is known.
    Positivity(const Algebra& algebra, std::function<Sign(Expression)> sign_of)
        : algebra_(algebra), sign_of_(std::move(sign_of)) {}

    // True if a lower bound, in which |sin|, |cos| <= 1 bound the negative terms, is a sum of nonnegative products, at
    // least one of them positive. With `not_zero`, for a polynomial known to be nonzero (a denominator), nonnegative is
    // enough.
    bool is_positive(const Multinomial& polynomial, bool not_zero = false);

    // The atoms whose sign was used in a proof.
    const std::set<std::size_t>& used() const { return used_; }

 private:
    Sign sign(std::size_t atom);
    const Algebra& algebra_;
    std::function<Sign(Expression)> sign_of_;
    std::vector<int> known_;  // by atom; -1: not computed yet
    std::set<std::size_t> used_;
};

}  // namespace achilles
