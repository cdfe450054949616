#include "algebra/algebra.hpp"

#include <algorithm>
#include <utility>

#include "expression/graph.hpp"

namespace achilles {

namespace {

using Op = Operation;
using boost::multiprecision::denominator, boost::multiprecision::numerator;

Multinomial square_of(std::size_t atom, Work& work) { return power(Multinomial::atom(atom), 2, work); }

// Replaces every square of the atom.
Multinomial replaced(const Multinomial& polynomial, std::size_t atom, const Multinomial& square, Work& work) {
    const std::vector<Multinomial> parts = polynomial.coefficients(atom);
    Multinomial result, factor(1);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (k > 1 && k % 2 == 0) factor = times(factor, square, work);
        const Multinomial part = times(parts[k], factor, work);
        result = result + (k % 2 == 0 ? part : times(part, Multinomial::atom(atom), work));
    }
    return result;
}

}  // namespace

Algebra::Algebra(Graph& graph, Work work, bool expand_angles)
    : graph_(graph), work_(work), expand_angles_(expand_angles) {}

std::optional<std::size_t> Algebra::find(Expression expression) const {
    const auto at = index_.find(expression.id());
    return at == index_.end() ? std::nullopt : std::optional(at->second);
}

std::size_t Algebra::atom_of(Expression expression) {
    if (const auto known = find(expression)) return *known;
    if (atoms_.size() == max_atoms) throw SimplificationLimit("it has too many symbols and functions");
    const std::size_t index = atoms_.size();
    atoms_.push_back({expression, {}, {}});
    index_.emplace(expression.id(), index);
    return index;
}

Multinomial Algebra::reduced(Multinomial polynomial) {
    // The square of an atom consists of earlier atoms, or of atoms whose squares are not replaced.
    for (std::size_t i = atoms_.size(); i-- > 0;)
        if (atoms_[i].square && polynomial.degree(i) > 1)
            polynomial = replaced(polynomial, i, *atoms_[i].square, work_);
    return polynomial;
}

Multinomial Algebra::with_sines(const Multinomial& polynomial, std::size_t cosine) {
    const Multinomial square = Multinomial(1) - square_of(*atoms_[cosine].sine, work_);
    return replaced(polynomial, cosine, square, work_);
}

Fraction Algebra::coprime(Multinomial top, Multinomial bottom) {
    top = reduced(std::move(top));
    bottom = reduced(std::move(bottom));
    if (bottom.is_zero()) throw std::domain_error("division by zero");
    if (top.is_zero()) return {};
    const Multinomial shared = gcd(top, bottom, work_);
    top = quotient(top, shared, work_);
    bottom = quotient(bottom, shared, work_);
    if (bottom.terms().front().coefficient < 0) return {-top, -bottom};
    return {top, bottom};
}

Fraction Algebra::add(const Fraction& a, const Fraction& b) {
    const Multinomial shared = gcd(a.denominator, b.denominator, work_);
    const Multinomial rest_a = quotient(a.denominator, shared, work_), rest_b = quotient(b.denominator, shared, work_);
    return coprime(times(a.numerator, rest_b, work_) + times(b.numerator, rest_a, work_),
                   times(a.denominator, rest_b, work_));
}

Fraction Algebra::multiply(const Fraction& a, const Fraction& b) {
    if (a.is_zero() || b.is_zero()) return {};
    const Multinomial x = gcd(a.numerator, b.denominator, work_), y = gcd(b.numerator, a.denominator, work_);
    return coprime(times(quotient(a.numerator, x, work_), quotient(b.numerator, y, work_), work_),
                   times(quotient(a.denominator, y, work_), quotient(b.denominator, x, work_), work_));
}

Fraction Algebra::divide(const Fraction& a, const Fraction& b) {
    if (b.is_zero()) throw std::domain_error("division by zero");
    const bool negative = b.numerator.terms().front().coefficient < 0;
    return multiply(a, {negative ? -b.denominator : b.denominator, negative ? -b.numerator : b.numerator});
}

Fraction Algebra::power(const Fraction& base, int exponent) {
    if (exponent < 0) return divide({Multinomial(1)}, power(base, -exponent));
    if (exponent > 255) throw SimplificationLimit("a power beyond 255");
    Fraction result{Multinomial(1)};
    for (int i = 0; i < exponent; ++i) result = multiply(result, base);
    return result;
}

// sin and cos of an angle. If expand_angles_, the angle addition formulas expand those of a sum.
Algebra::Pair Algebra::sine_and_cosine(const Fraction& angle) {
    const auto& terms = angle.numerator.terms();
    if (expand_angles_ && terms.size() > 1) {
        const auto part = [&](std::vector<Multinomial::Term> some) {
            return sine_and_cosine(coprime(Multinomial(std::move(some)), angle.denominator));
        };
        const Pair a = part({terms.front()}), b = part({terms.begin() + 1, terms.end()});
        const Fraction minus{Multinomial(-1)};
        return {add(multiply(a.sine, b.cosine), multiply(a.cosine, b.sine)),
                add(multiply(a.cosine, b.cosine), multiply(minus, multiply(a.sine, b.sine)))};
    }
    const bool negative = !terms.empty() && terms.front().coefficient < 0;
    const Expression u = expression(Fraction{negative ? -angle.numerator : angle.numerator, angle.denominator});
    if (u.is_zero()) return {{}, {Multinomial(1)}};
    const std::size_t cosine = atom_of(apply(Op::cos, u)), sine = atom_of(apply(Op::sin, u));
    atoms_[sine].square = Multinomial(1) - square_of(cosine, work_);
    atoms_[cosine].sine = sine;
    const Multinomial s = Multinomial::atom(sine);
    return {{negative ? -s : s}, {Multinomial::atom(cosine)}};
}

Fraction Algebra::function(Operation operation, const Fraction& argument) {
    if (operation == Op::sin) return sine_and_cosine(argument).sine;
    if (operation == Op::cos) return sine_and_cosine(argument).cosine;
    if (operation == Op::tan) {
        const Pair pair = sine_and_cosine(argument);
        return divide(pair.sine, pair.cosine);
    }
    const Expression value = apply(operation, expression(argument));
    if (!is_function(Builder::node(value).operation)) return simplify(value);  // sqrt(1), atan(-u), ...
    const std::size_t index = atom_of(value);
    if (operation == Op::sqrt && argument.denominator.is_one()) atoms_[index].square = argument.numerator;
    if (operation == Op::cosh) {
        const std::size_t sine = atom_of(apply(Op::sinh, Builder::first(value)));
        atoms_[index].square = Multinomial(1) + square_of(sine, work_);
    }
    return {Multinomial::atom(index)};
}

Fraction Algebra::node(Expression e, const Fraction& a, const Fraction& b) {
    const Graph::Node node = Builder::node(e);
    const auto negated = [](const Fraction& x) { return Fraction{-x.numerator, x.denominator}; };
    switch (node.operation) {
        case Op::number: {
            const Rational& value = Builder::value(e);
            return {Multinomial(numerator(value)), Multinomial(denominator(value))};
        }
        case Op::pi:
        case Op::symbol:
            return {Multinomial::atom(atom_of(e))};
        case Op::add:
            return add(a, b);
        case Op::subtract:
            return add(a, negated(b));
        case Op::negate:
            return negated(a);
        case Op::multiply:
            return multiply(a, b);
        case Op::divide:
            return divide(a, b);
        case Op::power:
            return power(a, node.exponent);
        case Op::midpoint:  // its value does not matter: 0 makes the expression shortest
            return {};
        case Op::real_power: {
            const Expression value = real_power(expression(a), expression(b));
            if (!Builder::is(value, Op::real_power)) return simplify(value);  // the exponent has become a number
            return {Multinomial::atom(atom_of(value))};
        }
        default:
            return function(node.operation, a);
    }
}

namespace {

// Whether the value of a node follows without those of its operands.
bool has_own_value(Operation operation) { return is_leaf(operation) || operation == Op::midpoint; }

// Marks the nodes that the expression is computed from. A midpoint is known, so its operands are not marked.
std::vector<bool> nodes_for(Expression expression) {
    std::vector<bool> needed(expression.id() + 1, false);
    needed.back() = true;
    for (std::uint32_t id = expression.id() + 1; id-- > 0;) {
        const Graph::Node& node = expression.graph().node(id);
        if (!needed[id] || has_own_value(node.operation)) continue;
        needed[node.a] = true;
        if (is_binary(node.operation)) needed[node.b] = true;
    }
    return needed;
}

}  // namespace

Fraction Algebra::simplify(Expression expression) {
    const std::vector<bool> needed = nodes_for(expression);
    std::vector<Fraction> of(needed.size());
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph_.node(id);
        const bool leaf = has_own_value(node.operation);
        of[id] = this->node({&graph_, id}, of[leaf ? 0 : node.a], of[is_binary(node.operation) ? node.b : 0]);
    }
    return of[expression.id()];
}

Expression Algebra::expression(const Multinomial& polynomial) {
    Expression sum = graph_.number(0);
    for (const Multinomial::Term& term : polynomial.terms()) {
        Expression part = Builder::number(graph_, Rational(term.coefficient));
        for (std::size_t i = 0; i < atoms_.size(); ++i)
            if (term.powers[i] > 0) part = part * achilles::power(atoms_[i].expression, term.powers[i]);
        sum = sum + part;
    }
    return sum;
}

Expression Algebra::expression(const Fraction& fraction) {
    return expression(fraction.numerator) / expression(fraction.denominator);
}

namespace {

using boost::multiprecision::cpp_rational;
using Term = Multinomial::Term;

void put(FactoredForm& result, const Multinomial& base, int exponent) {
    for (FactoredForm::Factor& factor : result.factors)
        if (factor.base == base) {
            factor.exponent += exponent;
            return;
        }
    result.factors.push_back({base, exponent});
}

void scale(FactoredForm& result, const Integer& number, int exponent) {
    for (int i = 0; i < std::abs(exponent); ++i)
        result.number *= exponent > 0 ? cpp_rational(number) : cpp_rational(1, number);
}

class FactorSplitter {
 public:
    FactorSplitter(Algebra& algebra, FactoredForm& result)
        : algebra_(algebra), work_(algebra.work()), result_(result) {}

    // Adds the factors of a nonzero polynomial.
    void split(const Multinomial& polynomial, int exponent) {
        const Integer number = polynomial.terms().front().coefficient < 0 ? Integer(-polynomial.number_content())
                                                                          : polynomial.number_content();
        const Monomial powers = polynomial.monomial_content();
        scale(result_, number, exponent);
        for (std::size_t i = 0; i < max_atoms; ++i)
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
    FactoredForm& result_;
};

}  // namespace

FactoredForm factor(const Fraction& fraction, Algebra& algebra) {
    FactoredForm result;
    if (fraction.is_zero()) {
        result.number = 0;
        return result;
    }
    FactorSplitter splitter(algebra, result);
    splitter.split(fraction.numerator, 1);
    splitter.split(fraction.denominator, -1);
    // Rewrites sqrt(u) u as sqrt(u)^3.
    for (FactoredForm::Factor& root : result.factors) {
        const auto atom = root.base.atoms();
        if (root.base.terms().size() != 1 || atom.size() != 1 || !algebra.square(atom[0])) continue;
        for (FactoredForm::Factor& other : result.factors)
            if (other.base == *algebra.square(atom[0]) && (other.exponent > 0) == (root.exponent > 0))
                root.exponent += 2 * std::exchange(other.exponent, 0);
    }
    std::erase_if(result.factors, [](const FactoredForm::Factor& factor) { return factor.exponent == 0; });
    return result;
}

FactoredForm operator*(FactoredForm a, const FactoredForm& b) {
    a.number *= b.number;
    for (const FactoredForm::Factor& factor : b.factors) put(a, factor.base, factor.exponent);
    std::erase_if(a.factors, [](const FactoredForm::Factor& factor) { return factor.exponent == 0; });
    return a;
}

Fraction expand(const FactoredForm& factored, Algebra& algebra) {
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
    std::vector<std::size_t> tested;
    for (const Term& term : polynomial.terms()) {
        Term low = term;
        bool signs_known = true, dropped = false;
        Term largest = term;  // bound on its absolute value, by |sin|, |cos| <= 1
        bool bounded = true;
        for (std::size_t i = 0; i < max_atoms; ++i) {
            if (term.powers[i] == 0) continue;
            const Operation operation = Builder::node(algebra_.atom(i)).operation;
            const bool odd = term.powers[i] % 2 == 1, known = odd && sign(i) != Sign::unknown;
            const bool wave = operation == Operation::sin || operation == Operation::cos;
            if (odd && known) tested.push_back(i);
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
                if (sign(i) != Sign::unknown) tested.push_back(i);
            }
        positive = positive || strict;
    }
    if (positive) used_.insert(tested.begin(), tested.end());
    return positive;
}

}  // namespace achilles
