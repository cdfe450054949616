// The greatest common divisor of two polynomials: atoms that it cannot contain are found by images modulo a prime and
// split off by contents; for the others primitive remainder sequences.
#include <algorithm>

#include "algebra/multinomial.hpp"

namespace achilles {

namespace {

using Term = Multinomial::Term;

// Arithmetic modulo a prime below 2^31.
constexpr std::uint64_t prime = 2147483629;

std::uint64_t power_mod(std::uint64_t base, std::uint64_t exponent) {
    std::uint64_t result = 1;
    for (; exponent != 0; exponent >>= 1) {
        if (exponent & 1u) result = result * base % prime;
        base = base * base % prime;
    }
    return result;
}

// Where the other atoms are put: any fixed numbers that have no relation to each other.
std::uint64_t value_of(std::size_t atom) { return (0x9E3779B97F4A7C15ULL * (atom + 3) >> 20) % prime; }

// The polynomial in one atom alone, the others replaced by numbers, modulo the prime; ascending powers.
std::vector<std::uint64_t> image(const Multinomial& a, std::size_t atom) {
    std::vector<std::uint64_t> result(static_cast<std::size_t>(a.degree(atom)) + 1, 0);
    for (const Term& term : a.terms()) {
        Integer residue = term.coefficient % prime;
        if (residue < 0) residue += prime;
        auto value = residue.convert_to<std::uint64_t>();
        for (std::size_t i = 0; i < most_atoms; ++i)
            if (i != atom && term.powers[i] > 0) value = value * power_mod(value_of(i), term.powers[i]) % prime;
        std::uint64_t& place = result[term.powers[atom]];
        place = (place + value) % prime;
    }
    return result;
}

// An upper bound on the degree of gcd(a, b) in an atom: that of the images' divisor, if their degrees are those of a,
// b.
int degree_bound(const Multinomial& a, const Multinomial& b, std::size_t atom) {
    std::vector<std::uint64_t> x = image(a, atom), y = image(b, atom);
    if (x.back() == 0 || y.back() == 0) return std::min(a.degree(atom), b.degree(atom));
    while (true) {
        if (x.size() < y.size()) std::swap(x, y);
        // x -= x_top/y_top y^k until it is shorter
        const std::uint64_t inverse = power_mod(y.back(), prime - 2);
        while (x.size() >= y.size()) {
            const std::uint64_t factor = x.back() * inverse % prime;
            const std::size_t shift = x.size() - y.size();
            for (std::size_t i = 0; i < y.size(); ++i) x[shift + i] = (x[shift + i] + (prime - factor) * y[i]) % prime;
            while (!x.empty() && x.back() == 0) x.pop_back();
            if (x.empty()) return static_cast<int>(y.size()) - 1;
        }
        if (x.size() == 1) return 0;
    }
}

Multinomial positive(const Multinomial& a) { return !a.is_zero() && a.terms().front().coefficient < 0 ? -a : a; }

// Without its numbers' and monomials' common divisor.
Multinomial stripped(const Multinomial& a) {
    const Integer number = a.number_content();
    const Monomial powers = a.monomial_content();
    std::vector<Term> terms = a.terms();
    for (Term& term : terms) {
        term.coefficient /= number;
        for (std::size_t i = 0; i < most_atoms; ++i)
            term.powers[i] = static_cast<std::uint8_t>(term.powers[i] - powers[i]);
    }
    return positive(Multinomial(std::move(terms)));
}

// The rest of a after division by b as polynomials in an atom, a first multiplied by what makes that possible.
Multinomial pseudo_remainder(Multinomial a, const Multinomial& b, std::size_t atom, Work& work) {
    const std::vector<Multinomial> divisor = b.coefficients(atom);
    const int degree = b.degree(atom);
    while (!a.is_zero() && a.degree(atom) >= degree) {
        const Multinomial top = a.coefficients(atom).back();
        const int shift = a.degree(atom) - degree;
        const Multinomial multiple = times(times(b, top, work), power(Multinomial::atom(atom), shift, work), work);
        a = times(a, divisor.back(), work) - multiple;
    }
    return a;
}

// Of two polynomials that are primitive in an atom.
Multinomial primitive_gcd(Multinomial a, Multinomial b, std::size_t atom, Work& work) {
    if (a.degree(atom) < b.degree(atom)) std::swap(a, b);
    while (true) {
        if (divide(a, b, work)) return b;
        if (b.degree(atom) <= 1) return Multinomial(1);  // primitive of degree 1 is irreducible
        const Multinomial rest = pseudo_remainder(a, b, atom, work);
        if (rest.is_zero()) return b;
        if (rest.degree(atom) == 0) return Multinomial(1);
        a = std::move(b);
        b = quotient(rest, content(rest, atom, work), work);
    }
}

// Of several, the shortest first.
Multinomial gcd_of(std::vector<Multinomial> parts, Work& work) {
    std::sort(parts.begin(), parts.end(),
              [](const Multinomial& x, const Multinomial& y) { return x.terms().size() < y.terms().size(); });
    Multinomial result;
    for (const Multinomial& part : parts) {
        if (part.is_zero()) continue;
        result = gcd(result, part, work);
        if (result.is_one()) break;
    }
    return result;
}

// Of stripped polynomials.
Multinomial core_gcd(const Multinomial& a, const Multinomial& b, Work& work) {
    if (a.is_number() || b.is_number()) return Multinomial(1);
    work.spend(a.terms().size() + b.terms().size());
    if (a == b) return a;
    std::size_t best = most_atoms;
    int least = 256;
    bool common = false;
    std::size_t absent = most_atoms;  // an atom that the divisor does not contain
    std::vector<std::size_t> atoms = a.atoms();
    for (const std::size_t atom : b.atoms())
        if (a.degree(atom) == 0) atoms.push_back(atom);
    for (const std::size_t atom : atoms) {
        const int in_a = a.degree(atom), in_b = b.degree(atom);
        const int bound = in_a == 0 || in_b == 0 ? 0 : degree_bound(a, b, atom);
        if (bound == 0) {
            absent = atom;
        } else {
            common = true;
            if (std::min(in_a, in_b) < least) {
                least = std::min(in_a, in_b);
                best = atom;
            }
        }
    }
    if (!common) return Multinomial(1);
    if (absent != most_atoms) {
        // The divisor divides every coefficient of that atom's powers.
        std::vector<Multinomial> parts = a.coefficients(absent);
        const std::vector<Multinomial> more = b.coefficients(absent);
        parts.insert(parts.end(), more.begin(), more.end());
        return stripped(gcd_of(std::move(parts), work));
    }
    const Multinomial content_a = content(a, best, work), content_b = content(b, best, work);
    const Multinomial shared = gcd(content_a, content_b, work);
    return times(shared, primitive_gcd(quotient(a, content_a, work), quotient(b, content_b, work), best, work), work);
}

}  // namespace

Multinomial gcd(const Multinomial& a, const Multinomial& b, Work& work) {
    if (a.is_zero()) return positive(b);
    if (b.is_zero()) return positive(a);
    Term shared{a.monomial_content(), gcd(a.number_content(), b.number_content())};
    const Monomial other = b.monomial_content();
    for (std::size_t i = 0; i < most_atoms; ++i) shared.powers[i] = std::min(shared.powers[i], other[i]);
    return positive(times(core_gcd(stripped(a), stripped(b), work), shared));
}

Multinomial content(const Multinomial& a, std::size_t atom, Work& work) { return gcd_of(a.coefficients(atom), work); }

}  // namespace achilles
