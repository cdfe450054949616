#include "algebra/multinomial.hpp"

#include <algorithm>

namespace achilles {

namespace {

using Term = Multinomial::Term;

constexpr unsigned most_coefficient_bits = 4096;

Monomial product(const Monomial& a, const Monomial& b) {
    Monomial result;
    for (std::size_t i = 0; i < most_atoms; ++i) {
        const int sum = a[i] + b[i];
        if (sum > 255) throw TooLong("a power beyond 255");
        result[i] = static_cast<std::uint8_t>(sum);
    }
    return result;
}

std::optional<Monomial> ratio(const Monomial& a, const Monomial& b) {
    Monomial result;
    for (std::size_t i = 0; i < most_atoms; ++i) {
        if (a[i] < b[i]) return std::nullopt;
        result[i] = static_cast<std::uint8_t>(a[i] - b[i]);
    }
    return result;
}

Multinomial merged(const Multinomial& a, const Multinomial& b, bool minus) {
    std::vector<Term> sum = a.terms();
    for (const Term& term : b.terms())
        sum.push_back({term.powers, minus ? Integer(-term.coefficient) : term.coefficient});
    return Multinomial(std::move(sum));
}

}  // namespace

void Work::spend(std::size_t products) {
    left -= static_cast<long>(products);
    if (left < 0) throw TooLong("it takes too many operations");
}

Multinomial::Multinomial(const Integer& value) {
    if (value != 0) terms_.push_back({Monomial{}, value});
}

Multinomial Multinomial::atom(std::size_t index) {
    Multinomial result(1);
    result.terms_.front().powers.at(index) = 1;
    return result;
}

Multinomial::Multinomial(std::vector<Term> terms) {
    std::sort(terms.begin(), terms.end(), [](const Term& x, const Term& y) { return x.powers > y.powers; });
    for (Term& term : terms) {
        if (!terms_.empty() && terms_.back().powers == term.powers)
            terms_.back().coefficient += term.coefficient;
        else {
            if (!terms_.empty() && terms_.back().coefficient == 0) terms_.pop_back();
            terms_.push_back(std::move(term));
        }
    }
    if (!terms_.empty() && terms_.back().coefficient == 0) terms_.pop_back();
    for (const Term& term : terms_)
        if (msb(abs(term.coefficient)) > most_coefficient_bits) throw TooLong("a coefficient of too many digits");
}

bool Multinomial::is_number() const {
    return terms_.empty() || (terms_.size() == 1 && terms_.front().powers == Monomial{});
}
bool Multinomial::is_one() const { return is_number() && number() == 1; }
Integer Multinomial::number() const { return terms_.empty() ? Integer(0) : terms_.front().coefficient; }

int Multinomial::degree(std::size_t atom) const {
    int degree = 0;
    for (const Term& term : terms_) degree = std::max(degree, static_cast<int>(term.powers[atom]));
    return degree;
}

std::vector<std::size_t> Multinomial::atoms() const {
    Monomial all{};
    for (const Term& term : terms_)
        for (std::size_t i = 0; i < most_atoms; ++i) all[i] = std::max(all[i], term.powers[i]);
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < most_atoms; ++i)
        if (all[i] > 0) result.push_back(i);
    return result;
}

std::vector<Multinomial> Multinomial::coefficients(std::size_t atom) const {
    std::vector<Multinomial> result(static_cast<std::size_t>(degree(atom)) + 1);
    // Terms without the atom's power keep their order.
    for (const Term& term : terms_) {
        Term rest = term;
        rest.powers[atom] = 0;
        result[term.powers[atom]].terms_.push_back(rest);
    }
    return result;
}

Integer Multinomial::number_content() const {
    Integer content = 0;
    for (const Term& term : terms_) {
        content = gcd(content, term.coefficient);
        if (content == 1) break;
    }
    return content;
}

Monomial Multinomial::monomial_content() const {
    if (terms_.empty()) return {};
    Monomial content = terms_.front().powers;
    for (const Term& term : terms_)
        for (std::size_t i = 0; i < most_atoms; ++i) content[i] = std::min(content[i], term.powers[i]);
    return content;
}

Multinomial operator+(const Multinomial& a, const Multinomial& b) { return merged(a, b, false); }
Multinomial operator-(const Multinomial& a, const Multinomial& b) { return merged(a, b, true); }
Multinomial operator-(const Multinomial& a) { return times(a, Term{Monomial{}, -1}); }

Multinomial times(const Multinomial& a, const Term& factor) {
    std::vector<Term> terms;
    for (const Term& term : a.terms())
        terms.push_back({product(term.powers, factor.powers), Integer(term.coefficient * factor.coefficient)});
    return Multinomial(std::move(terms));
}

Multinomial times(const Multinomial& a, const Multinomial& b, Work& work) {
    work.spend(a.terms().size() * b.terms().size());
    std::vector<Term> terms;
    terms.reserve(a.terms().size() * b.terms().size());
    for (const Term& x : a.terms())
        for (const Term& y : b.terms())
            terms.push_back({product(x.powers, y.powers), Integer(x.coefficient * y.coefficient)});
    return Multinomial(std::move(terms));
}

Multinomial power(const Multinomial& a, int exponent, Work& work) {
    Multinomial result(1);
    for (int i = 0; i < exponent; ++i) result = times(result, a, work);
    return result;
}

Multinomial derivative(const Multinomial& a, std::size_t atom) {
    std::vector<Term> terms;
    for (const Term& term : a.terms()) {
        if (term.powers[atom] == 0) continue;
        Term slope{term.powers, Integer(term.coefficient * term.powers[atom])};
        --slope.powers[atom];
        terms.push_back(slope);
    }
    return Multinomial(std::move(terms));
}

std::optional<Multinomial> divide(const Multinomial& a, const Multinomial& b, Work& work) {
    if (b.is_zero()) return std::nullopt;
    const Term& head = b.terms().front();
    std::vector<Term> quotient;
    for (Multinomial rest = a; !rest.is_zero();) {
        const Term& top = rest.terms().front();
        const std::optional<Monomial> powers = ratio(top.powers, head.powers);
        // The lowest terms must divide as well: most divisions that fail do so here.
        if (!powers || !ratio(rest.terms().back().powers, b.terms().back().powers)) return std::nullopt;
        const Integer coefficient = top.coefficient / head.coefficient;
        if (coefficient * head.coefficient != top.coefficient) return std::nullopt;
        quotient.push_back({*powers, coefficient});
        work.spend(rest.terms().size() + b.terms().size());
        rest = rest - times(b, quotient.back());
    }
    return Multinomial(std::move(quotient));
}

Multinomial quotient(const Multinomial& a, const Multinomial& b, Work& work) {
    if (b.is_one()) return a;
    const std::optional<Multinomial> result = divide(a, b, work);
    if (!result) throw std::logic_error("the division leaves a remainder");
    return *result;
}

}  // namespace achilles
