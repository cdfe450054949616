#include "algebra/multinomial.hpp"

#include <algorithm>
#include <cstring>

namespace achilles {

namespace {

using Term = Multinomial::Term;

constexpr unsigned max_coefficient_bits = 4096;

Monomial product(const Monomial& a, const Monomial& b) {
    Monomial result;
    std::uint8_t is_over = 0;
    for (std::size_t i = 0; i < max_atoms; ++i) {  // no branch, so that the compiler uses vectors
        result[i] = static_cast<std::uint8_t>(a[i] + b[i]);
        is_over = static_cast<std::uint8_t>(is_over | (result[i] < a[i] ? 1 : 0));
    }
    if (is_over != 0) throw SimplificationLimit("a power beyond 255");
    return result;
}

std::optional<Monomial> ratio(const Monomial& a, const Monomial& b) {
    Monomial result;
    for (std::size_t i = 0; i < max_atoms; ++i) {
        if (a[i] < b[i]) return std::nullopt;
        result[i] = static_cast<std::uint8_t>(a[i] - b[i]);
    }
    return result;
}

// a + b, or a - b.
Multinomial merged(const Multinomial& a, const Multinomial& b, bool minus) {
    std::vector<Term> sum;
    sum.reserve(a.terms().size() + b.terms().size());
    auto x = a.terms().begin(), y = b.terms().begin();
    while (x != a.terms().end() || y != b.terms().end()) {
        const int order = x == a.terms().end()   ? -1
                          : y == b.terms().end() ? 1
                                                 : std::memcmp(x->powers.data(), y->powers.data(), sizeof(Monomial));
        if (order > 0) {
            sum.push_back(*x++);
            continue;
        }
        Term term{y->powers, minus ? Integer(-y->coefficient) : y->coefficient};
        ++y;
        if (order == 0) term.coefficient += (x++)->coefficient;
        if (term.coefficient != 0) sum.push_back(std::move(term));
    }
    return Multinomial::of_sorted(std::move(sum));
}

}  // namespace

void Work::spend(std::size_t products) {
    left -= static_cast<long>(products);
    if (left < 0) throw SimplificationLimit("it takes too many operations");
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
    std::vector<Term> sum;
    for (Term& term : terms) {
        if (!sum.empty() && sum.back().powers == term.powers)
            sum.back().coefficient += term.coefficient;
        else {
            if (!sum.empty() && sum.back().coefficient == 0) sum.pop_back();
            sum.push_back(std::move(term));
        }
    }
    if (!sum.empty() && sum.back().coefficient == 0) sum.pop_back();
    *this = of_sorted(std::move(sum));
}

Multinomial Multinomial::of_sorted(std::vector<Term> terms) {
    for (const Term& term : terms)
        if (msb(abs(term.coefficient)) > max_coefficient_bits)
            throw SimplificationLimit("a coefficient of too many digits");
    Multinomial result;
    result.terms_ = std::move(terms);
    return result;
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
        for (std::size_t i = 0; i < max_atoms; ++i) all[i] = std::max(all[i], term.powers[i]);
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < max_atoms; ++i)
        if (all[i] > 0) result.push_back(i);
    return result;
}

std::vector<Multinomial> Multinomial::coefficients(std::size_t atom) const {
    std::vector<Multinomial> result(static_cast<std::size_t>(degree(atom)) + 1);
    // The order of terms is unchanged when the power of one atom is removed.
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
        for (std::size_t i = 0; i < max_atoms; ++i) content[i] = std::min(content[i], term.powers[i]);
    return content;
}

Multinomial operator+(const Multinomial& a, const Multinomial& b) { return merged(a, b, false); }
Multinomial operator-(const Multinomial& a, const Multinomial& b) { return merged(a, b, true); }
Multinomial operator-(const Multinomial& a) { return times(a, Term{Monomial{}, -1}); }

// The order of terms is that of their products with one term.
Multinomial times(const Multinomial& a, const Term& factor) {
    if (factor.coefficient == 0) return {};
    std::vector<Term> terms;
    terms.reserve(a.terms().size());
    for (const Term& term : a.terms())
        terms.push_back({product(term.powers, factor.powers), Integer(term.coefficient * factor.coefficient)});
    return Multinomial::of_sorted(std::move(terms));
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
    std::vector<Term> terms;  // their order is unchanged when all powers of one atom decrease by one
    for (const Term& term : a.terms()) {
        if (term.powers[atom] == 0) continue;
        Term slope{term.powers, Integer(term.coefficient * term.powers[atom])};
        --slope.powers[atom];
        terms.push_back(slope);
    }
    return Multinomial::of_sorted(std::move(terms));
}

std::optional<Multinomial> divide(const Multinomial& a, const Multinomial& b, Work& work) {
    if (b.is_zero()) return std::nullopt;
    const Term& head = b.terms().front();
    std::vector<Term> quotient;
    for (Multinomial rest = a; !rest.is_zero();) {
        const Term& top = rest.terms().front();
        const std::optional<Monomial> powers = ratio(top.powers, head.powers);
        // The lowest terms must divide as well; most inexact divisions are detected here.
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

// Greatest common divisor of two polynomials. Images modulo a prime find atoms that it cannot contain; these are
// removed by taking contents. The other atoms are handled by primitive polynomial remainder sequences.

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

// Powers of fixed, arbitrary values of the atoms.
using PowersOfValues = std::array<std::array<std::uint32_t, 256>, max_atoms>;
const PowersOfValues& powers_of_values() {
    static const PowersOfValues all = [] {
        PowersOfValues powers{};
        for (std::size_t atom = 0; atom < max_atoms; ++atom) {
            const std::uint64_t value = (0x9E3779B97F4A7C15ULL * (atom + 3) >> 20) % prime;
            std::uint64_t power = 1;
            for (std::uint32_t& place : powers[atom]) {
                place = static_cast<std::uint32_t>(power);
                power = power * value % prime;
            }
        }
        return powers;
    }();
    return all;
}

// The images of a polynomial modulo the prime, each a polynomial in one atom, with the other atoms at fixed values. The
// atom itself is multiplied by its value, which changes no degree of a gcd, so that all images take the same products.
class Images {
 public:
    // Evaluates each term with all atoms at their values. The polynomial must outlive this object.
    explicit Images(const Multinomial& a) : polynomial_(&a) {
        const std::vector<std::size_t> atoms = a.atoms();
        values_.reserve(a.terms().size());
        for (const Term& term : a.terms()) {
            Integer residue = term.coefficient % prime;
            if (residue < 0) residue += prime;
            auto value = residue.convert_to<std::uint64_t>();
            for (const std::size_t i : atoms)
                if (term.powers[i] > 0) value = value * powers_of_values()[i][term.powers[i]] % prime;
            values_.push_back(value);
        }
    }
    // The coefficients of the image in one atom, by ascending powers.
    std::vector<std::uint64_t> in(std::size_t atom) const {
        std::vector<std::uint64_t> result(static_cast<std::size_t>(polynomial_->degree(atom)) + 1, 0);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            std::uint64_t& place = result[polynomial_->terms()[i].powers[atom]];
            place = (place + values_[i]) % prime;
        }
        return result;
    }

 private:
    const Multinomial* polynomial_;
    std::vector<std::uint64_t> values_;  // values_[i] is term i with all atoms at their values
};

// Upper bound on the degree of the gcd of two polynomials in an atom: that of the gcd of their images x and y. If an
// image has a lower degree than its polynomial, the bound is the smaller degree of the two polynomials.
int degree_bound(std::vector<std::uint64_t> x, std::vector<std::uint64_t> y) {
    if (x.back() == 0 || y.back() == 0) return static_cast<int>(std::min(x.size(), y.size())) - 1;
    while (true) {
        if (x.size() < y.size()) std::swap(x, y);
        // Subtracts multiples of y until x is shorter than y.
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

// Divides by the common divisors of the coefficients and of the monomials.
Multinomial stripped(const Multinomial& a) {
    const Integer number = a.number_content();
    const Monomial powers = a.monomial_content();
    std::vector<Term> terms = a.terms();
    for (Term& term : terms) {
        term.coefficient /= number;
        for (std::size_t i = 0; i < max_atoms; ++i)
            term.powers[i] = static_cast<std::uint8_t>(term.powers[i] - powers[i]);
    }
    return positive(Multinomial::of_sorted(std::move(terms)));
}

// Pseudo-remainder of a divided by b as polynomials in an atom: a is multiplied by the leading coefficient of b as
// needed.
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

// The gcd of two polynomials that are primitive in the atom.
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

// The gcd of several polynomials, the shortest first.
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

// The gcd of two polynomials returned by stripped().
Multinomial core_gcd(const Multinomial& a, const Multinomial& b, Work& work) {
    if (a.is_number() || b.is_number()) return Multinomial(1);
    work.spend(a.terms().size() + b.terms().size());
    if (a == b) return a;
    std::size_t best = max_atoms;
    int least = 256;
    bool common = false;
    std::size_t absent = max_atoms;  // an atom that the gcd does not contain
    std::vector<std::size_t> atoms = a.atoms();
    for (const std::size_t atom : b.atoms())
        if (a.degree(atom) == 0) atoms.push_back(atom);
    const Images images_a(a), images_b(b);
    for (const std::size_t atom : atoms) {
        const int in_a = a.degree(atom), in_b = b.degree(atom);
        const int bound = in_a == 0 || in_b == 0 ? 0 : degree_bound(images_a.in(atom), images_b.in(atom));
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
    if (absent != max_atoms) {
        // The gcd divides every coefficient of the powers of that atom.
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
    for (std::size_t i = 0; i < max_atoms; ++i) shared.powers[i] = std::min(shared.powers[i], other[i]);
    return positive(times(core_gcd(stripped(a), stripped(b), work), shared));
}

Multinomial content(const Multinomial& a, std::size_t atom, Work& work) { return gcd_of(a.coefficients(atom), work); }

}  // namespace achilles
