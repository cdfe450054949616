#include "algebra/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "expression/graph.hpp"

namespace achilles {

namespace {

using boost::multiprecision::denominator, boost::multiprecision::numerator;

Monomial common(const Monomial& a, const Monomial& b) {
    Monomial result;
    for (std::size_t i = 0; i < max_atoms; ++i) result[i] = std::min(a[i], b[i]);
    return result;
}

}  // namespace

AlgebraWriter::AlgebraWriter(const Algebra& algebra, std::span<const std::string> names, std::span<const int> ranks,
                             Notation notation)
    : notation_(notation), order_(algebra.atom_count()) {
    const int highest = ranks.empty() ? 0 : *std::max_element(ranks.begin(), ranks.end());
    std::vector<std::pair<int, std::uint32_t>> keys;
    for (std::size_t i = 0; i < algebra.atom_count(); ++i) {
        const Expression atom = algebra.atom(i);
        const Graph::Node& node = Builder::node(atom);
        written_.push_back(achilles::write(atom, names, notation));
        const bool symbol = node.operation == Operation::symbol;
        const int rank = symbol && node.a < ranks.size()   ? ranks[node.a]
                         : node.operation == Operation::pi ? -1
                                                           : highest + 1;
        keys.emplace_back(rank, symbol ? node.a : 0);
        highest_.push_back(rank == highest);
    }
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        return keys[a] != keys[b] ? keys[a] < keys[b] : written_[a].text < written_[b].text;
    });
}

int AlgebraWriter::degree_of_highest(const Monomial& powers) const {
    int degree = 0;
    for (const std::size_t i : order_)
        if (highest_[i]) degree += powers[i];
    return degree;
}

bool AlgebraWriter::before(const SumTerm& a, const SumTerm& b) const {
    const int x = degree_of_highest(a.powers), y = degree_of_highest(b.powers);
    if (x != y) return x > y;
    for (const std::size_t i : order_)
        if (a.powers[i] != b.powers[i]) return a.powers[i] > b.powers[i];
    return false;
}

// |number| * atoms * bracket
FormattedTerm AlgebraWriter::product(const Rational& number, const Monomial& powers,
                                     const FormattedTerm* bracket) const {
    const Rational size = abs(number);
    std::vector<FormattedTerm> factors;
    for (const std::size_t i : order_) {
        if (powers[i] == 0) continue;
        factors.push_back(powers[i] == 1 ? written_[i] : write_power(written_[i], powers[i], notation_));
    }
    if (bracket != nullptr) factors.push_back(*bracket);
    // Text divides at the end of a product; LaTeX puts the fraction in front.
    const bool divide = notation_ == Notation::text && !factors.empty();
    const Rational front = divide ? Rational(numerator(size)) : size;
    if (front != 1 || factors.empty()) factors.insert(factors.begin(), write_number(front, notation_));
    FormattedTerm result = factors.front();
    for (std::size_t i = 1; i < factors.size(); ++i) result = write_product(result, factors[i], notation_);
    if (divide && denominator(size) != 1)
        result = write_quotient(result, write_number(Rational(denominator(size)), notation_), notation_);
    return result;
}

// Several terms with a common factor, as that factor times a bracket.
AlgebraWriter::Piece AlgebraWriter::collected(std::vector<SumTerm> items, const Monomial& shared) const {
    bool alike = true, whole = true;
    boost::multiprecision::cpp_int divisor = 0;
    for (SumTerm& item : items) {
        for (std::size_t i = 0; i < max_atoms; ++i)
            item.powers[i] = static_cast<std::uint8_t>(item.powers[i] - shared[i]);
        alike = alike && abs(item.number) == abs(items.front().number);
        whole = whole && denominator(item.number) == 1;
        divisor = gcd(divisor, numerator(item.number));
    }
    Rational number = alike ? Rational(abs(items.front().number)) : whole ? Rational(divisor) : Rational(1);
    if (std::all_of(items.begin(), items.end(), [](const SumTerm& item) { return item.number < 0; })) number = -number;
    for (SumTerm& item : items) item.number /= number;
    const FormattedTerm bracket = sum(std::move(items));
    if (number == 1 && shared == Monomial{}) return {false, bracket};
    return {number < 0, product(number, shared, &bracket)};
}

// The terms that share the next bracket: those with the same rates. If all terms have the same rates, those that
// contain the most frequent atom to the same power. Empty if the remaining terms are written one by one.
std::vector<std::size_t> AlgebraWriter::next_group(const std::vector<SumTerm>& items,
                                                   const std::vector<std::size_t>& left) const {
    const auto rates = [&](std::size_t item) {
        Monomial powers = items[item].powers;
        for (std::size_t i = 0; i < max_atoms; ++i)
            if (i >= highest_.size() || !highest_[i]) powers[i] = 0;
        return powers;
    };
    const bool same = std::all_of(left.begin(), left.end(), [&](std::size_t i) { return rates(i) == rates(left[0]); });
    std::vector<std::size_t> best;
    if (!same || left.size() < items.size()) {
        for (const std::size_t first : left) {
            std::vector<std::size_t> group;
            std::copy_if(left.begin(), left.end(), std::back_inserter(group),
                         [&](std::size_t i) { return rates(i) == rates(first); });
            if (group.size() > 1 && group.size() < items.size()) return group;
        }
        if (!same) return {};
    }
    for (const std::size_t atom : order_) {
        std::vector<std::size_t> group;
        std::copy_if(left.begin(), left.end(), std::back_inserter(group),
                     [&](std::size_t i) { return items[i].powers[atom] > 0; });
        const bool linear = std::all_of(group.begin(), group.end(), [&](std::size_t i) {
            return items[i].powers[atom] == items[group.front()].powers[atom];
        });
        if (linear && group.size() > std::max<std::size_t>(1, best.size())) best = group;
    }
    return best;
}

FormattedTerm AlgebraWriter::sum(std::vector<SumTerm> items) const {
    std::sort(items.begin(), items.end(), [&](const SumTerm& a, const SumTerm& b) { return before(a, b); });
    std::vector<std::pair<std::size_t, Piece>> pieces;  // by index of the first term
    std::vector<std::size_t> left(items.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (std::vector<std::size_t> group = next_group(items, left); !group.empty(); group = next_group(items, left)) {
        std::vector<SumTerm> with;
        for (const std::size_t i : group) with.push_back(items[i]);
        Monomial shared = with.front().powers;
        for (const SumTerm& item : with) shared = common(shared, item.powers);
        pieces.emplace_back(group.front(), collected(std::move(with), shared));
        std::erase_if(left, [&](std::size_t i) { return std::find(group.begin(), group.end(), i) != group.end(); });
    }
    for (const std::size_t i : left)
        pieces.emplace_back(i, Piece{items[i].number < 0, product(items[i].number, items[i].powers, nullptr)});
    std::sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    // If a sum has a positive term, it starts with one.
    const auto plus =
        std::find_if(pieces.begin(), pieces.end(), [](const auto& piece) { return !piece.second.negative; });
    if (plus != pieces.end()) std::rotate(pieces.begin(), plus, plus + 1);
    if (pieces.empty()) return write_number(0, notation_);
    FormattedTerm result = pieces.front().second.written;
    if (pieces.front().second.negative) result = {fmt::format("-{}", inside(result, 2, notation_)), 1, {}};
    for (std::size_t i = 1; i < pieces.size(); ++i)
        result = write_sum(result, pieces[i].second.negative, pieces[i].second.written, notation_);
    return result;
}

// Writes c - c cos(u)^2 as c sin(u)^2, if sin(u) is an atom.
void AlgebraWriter::gather_sines(std::vector<SumTerm>& items, const Algebra& algebra) const {
    for (std::size_t cosine = 0; cosine < written_.size(); ++cosine) {
        const std::optional<std::size_t> sine = algebra.sine_of(cosine);
        if (!sine || *sine >= written_.size()) continue;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (items[i].powers[cosine] < 2) continue;
            Monomial rest = items[i].powers;
            rest[cosine] = static_cast<std::uint8_t>(rest[cosine] - 2);
            const auto whole = std::find_if(items.begin(), items.end(), [&](const SumTerm& item) {
                return item.powers == rest && item.number == -items[i].number;
            });
            if (whole == items.end()) continue;
            whole->powers[*sine] = static_cast<std::uint8_t>(whole->powers[*sine] + 2);
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(i--));
        }
    }
}

FormattedTerm AlgebraWriter::write(const Multinomial& polynomial) const {
    return write(FactoredForm{1, {{polynomial, 1}}});
}

FormattedTerm AlgebraWriter::write(const Fraction& fraction, Algebra& algebra) const {
    if (!fraction.denominator.is_number() || fraction.is_zero()) return write(factor(fraction, algebra));
    std::vector<SumTerm> items;
    for (const Multinomial::Term& term : fraction.numerator.terms())
        items.push_back({Rational(term.coefficient, fraction.denominator.number()), term.powers});
    gather_sines(items, algebra);
    if (items.size() == 1) return sum(std::move(items));
    const Piece all = collected(std::move(items), Monomial{});
    return all.negative ? FormattedTerm{fmt::format("-{}", inside(all.written, 2, notation_)), 1, {}} : all.written;
}

FormattedTerm AlgebraWriter::write(const FactoredForm& given) const {
    FactoredForm factored = given;
    if (factored.number < 0) {
        // Writes -(a - b) as b - a.
        for (auto& [base, exponent] : factored.factors) {
            const auto& all = base.terms();
            const auto sign = [](const Multinomial::Term& term) { return term.coefficient < 0; };
            if (exponent % 2 == 0 || all.size() == 1 || std::none_of(all.begin(), all.end(), sign)) continue;
            base = -base;
            factored.number = -factored.number;
            break;
        }
    }
    struct FractionSide {
        Monomial powers{};
        std::vector<FormattedTerm> brackets;
    } top, bottom;
    const auto bracket = [&](const Multinomial& base) {
        std::vector<SumTerm> items;
        for (const Multinomial::Term& term : base.terms()) items.push_back({Rational(term.coefficient), term.powers});
        return sum(std::move(items));
    };
    for (const auto& [base, exponent] : factored.factors) {
        FractionSide& side = exponent > 0 ? top : bottom;
        const int size = std::abs(exponent);
        if (base.terms().size() == 1) {
            for (std::size_t i = 0; i < max_atoms; ++i)
                side.powers[i] = static_cast<std::uint8_t>(side.powers[i] + base.terms().front().powers[i] * size);
        } else {
            const FormattedTerm written = bracket(base);
            side.brackets.push_back(size == 1 ? written : write_power(written, size, notation_));
        }
    }
    const auto written = [&](const Rational& number, const FractionSide& side) {
        if (side.brackets.empty()) return product(number, side.powers, nullptr);
        if (side.brackets.size() == 1 && abs(number) == 1 && side.powers == Monomial{}) return side.brackets.front();
        FormattedTerm result = product(number, side.powers, &side.brackets.front());
        for (std::size_t i = 1; i < side.brackets.size(); ++i)
            result = write_product(result, side.brackets[i], notation_);
        return result;
    };
    const bool whole = bottom.powers == Monomial{} && bottom.brackets.empty();
    FormattedTerm result = written(whole ? factored.number : Rational(numerator(factored.number)), top);
    if (!whole) result = write_quotient(result, written(Rational(denominator(factored.number)), bottom), notation_);
    if (factored.number < 0) result = {fmt::format("-{}", inside(result, 2, notation_)), 1, {}};
    return result;
}

}  // namespace achilles
