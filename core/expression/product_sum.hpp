// Sums of products of powers: the form in which the reader derives energies, forces and gaps from bodies, and in which a
// person reads them.
//
// Like terms meet, and nothing else is simplified. A factor is an atom, that is a symbol, a function, or a sum in
// parentheses, which stays as it is. Products of two sums are multiplied out, unless the caller packs one of them first.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "expression/expression.hpp"

namespace achilles {

class ProductSum {
 public:
    struct Factor {
        std::uint32_t atom;  // id of its node
        int exponent;
        friend auto operator<=>(const Factor&, const Factor&) = default;  // NOLINT(modernize-use-nullptr)
    };
    using Factors = std::vector<Factor>;  // by id, exponents are not 0
    struct Product {
        Expression coefficient;  // a number, not 0
        Factors factors;
    };

    ProductSum() = default;  // 0
    static ProductSum atom(Expression expression);
    static ProductSum product(Graph& graph, const Expression& coefficient, Factors factors);
    static ProductSum function(Operation function, const ProductSum& argument, Graph& graph);
    static ProductSum number(Graph& graph, long numerator, long denominator = 1);
    // Collects the terms of an expression; its parentheses stay, except around sums of sums.
    static ProductSum from(Expression expression) { return collect(expression, false); }
    // The same for a part of a sum, whose functions are simple already: they stay. Sums call this, because from() inside
    // from() would take twice the time for each level of nested functions.
    static ProductSum from_part(Expression expression) { return collect(expression, true); }

    bool is_zero() const { return products_.empty(); }
    bool is_single() const { return products_.size() == 1; }
    bool is_number() const;
    const std::vector<Product>& products() const { return products_; }
    // One of its products as a sum.
    ProductSum term(const Product& one) const { return product(*graph_, one.coefficient, one.factors); }
    Expression expression(Graph& graph) const;
    // The same as one product: a number times a sum in parentheses. A single product stays.
    ProductSum packed() const;
    // The same with c u cos(a)^2 + c u sin(a)^2 written as c u.
    ProductSum without_squares() const;
    // True if it depends on any of these symbols.
    bool depends_on(std::span<const std::uint32_t> slots) const;
    ProductSum derivative(std::uint32_t slot) const;

    friend ProductSum operator+(ProductSum a, const ProductSum& b);
    friend ProductSum operator-(ProductSum a, const ProductSum& b);
    friend ProductSum operator-(ProductSum a);
    friend ProductSum operator*(const ProductSum& a, const ProductSum& b);
    // Divides by a sum in parentheses, or by each factor of a single product. Throws std::domain_error if b is 0.
    friend ProductSum operator/(const ProductSum& a, const ProductSum& b);
    friend bool operator==(const ProductSum& a, const ProductSum& b) { return (a - b).is_zero(); }

 private:
    static ProductSum collect(Expression expression, bool keeps_functions);
    void add(const Expression& coefficient, const Factors& factors);
    bool merge_squares();
    Graph* graph_ = nullptr;  // null: 0
    std::vector<Product> products_;
};

ProductSum power(const ProductSum& base, int exponent);  // of the packed sum
// Draws the root of a rational square; sqrt(x^2) stays, because the sign of x is not known here.
ProductSum square_root(const ProductSum& square);
// cos and sin of an angle. Multiples of pi/2 and the arctangent in a sum are resolved, so that an angle of pi/2 - a gives
// sin(a), and one of atan(z) gives 1/sqrt(1 + z^2).
std::pair<ProductSum, ProductSum> cosine_and_sine(const ProductSum& angle, Graph& graph);

// Writes sums as text that parse() can read: factors that are constant in a run first, then coordinates and functions,
// then rates; terms that differ by constant factors share a bracket.
class ProductSumWriter {
 public:
    enum class Rank : std::uint8_t { constant, state, rate };
    // Writes sums of this graph. `names` and `ranks` are by slot.
    ProductSumWriter(Graph& graph, std::vector<std::string> names, std::vector<Rank> ranks)
        : graph_(graph), names_(std::move(names)), ranks_(std::move(ranks)) {}

    // Throws ExpressionTooLarge if the text would have more than 200000 characters.
    std::string text(const ProductSum& sum);
    Rank rank(Expression expression);

 private:
    struct Group {
        ProductSum::Factors factors;
        std::vector<ProductSum::Product> constants;
    };
    std::string group(const Group& group, bool& is_negative);
    std::string product(const Expression& coefficient, const ProductSum::Factors& factors, const std::string& bracket);
    std::string base(Expression atom);
    std::string factor_text(Expression atom);
    Graph& graph_;
    std::vector<std::string> names_;
    std::vector<Rank> ranks_;
    // By the id of a factor: a factor that is shared is written once.
    std::map<std::uint32_t, std::string> bases_;
    std::map<std::uint32_t, Rank> known_ranks_;
};

}  // namespace achilles
