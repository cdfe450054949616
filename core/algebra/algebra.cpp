#include "algebra/algebra.hpp"

#include "expression/graph.hpp"

namespace achilles {

namespace {

using Op = Operation;
using boost::multiprecision::denominator, boost::multiprecision::numerator;

Multinomial square_of(std::size_t atom, Work& work) { return power(Multinomial::atom(atom), 2, work); }

// The polynomial with every square of an atom replaced.
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
    if (atoms_.size() == most_atoms) throw TooLong("it has too many symbols and functions");
    const std::size_t index = atoms_.size();
    atoms_.push_back({expression, {}, {}});
    index_.emplace(expression.id(), index);
    return index;
}

Multinomial Algebra::reduced(Multinomial polynomial) {
    // An atom's square is made of earlier atoms, or of ones whose squares stay.
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
    if (exponent > 255) throw TooLong("a power beyond 255");
    Fraction result{Multinomial(1)};
    for (int i = 0; i < exponent; ++i) result = multiply(result, base);
    return result;
}

// sin and cos of an angle; of a sum by the addition theorems where that is wanted.
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
    if (!is_function(Builder::node(value).operation)) return simplify(value);  // sqrt(1), atan(-u), ..
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
        case Op::real_power: {
            const Expression value = real_power(expression(a), expression(b));
            if (!Builder::is(value, Op::real_power)) return simplify(value);  // an exponent that is a number after all
            return {Multinomial::atom(atom_of(value))};
        }
        default:
            return function(node.operation, a);
    }
}

Fraction Algebra::simplify(Expression expression) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<Fraction> of(needed.size());
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph_.node(id);
        const bool leaf = is_leaf(node.operation);
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

}  // namespace achilles
