#include "model/rate_polynomial.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "expression/graph.hpp"

namespace achilles {

int degree(const RatePolynomial::key_type& exponents) { return std::accumulate(exponents.begin(), exponents.end(), 0); }

namespace {

using Key = RatePolynomial::key_type;
constexpr int highest_degree = 8;
constexpr std::size_t max_terms = 5000;  // degree 2 in 16 rates has at most 153

void add_term(RatePolynomial& sum, const Key& key, Expression coefficient) {
    const auto [place, is_new] = sum.try_emplace(key, coefficient);
    if (!is_new) place->second = place->second + coefficient;
    if (place->second.is_zero()) sum.erase(place);
}

RatePolynomial plus(const RatePolynomial& a, const RatePolynomial& b, bool minus) {
    RatePolynomial result = a;
    for (const auto& [key, coefficient] : b) add_term(result, key, minus ? -coefficient : coefficient);
    return result;
}

std::optional<RatePolynomial> times(const RatePolynomial& a, const RatePolynomial& b) {
    RatePolynomial result;
    for (const auto& [key_a, x] : a) {
        for (const auto& [key_b, y] : b) {
            Key key{};
            for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(key_a[i] + key_b[i]);
            if (degree(key) > highest_degree) return std::nullopt;
            add_term(result, key, x * y);
            if (result.size() > max_terms) return std::nullopt;
        }
    }
    return result;
}

// Whether a polynomial is a number other than 0, or an expression without rates.
bool is_free(const RatePolynomial& p) { return p.size() == 1 && p.begin()->first == Key{}; }

// The polynomial of one node whose operands' polynomials are known.
std::optional<RatePolynomial> combine(Expression e, const RatePolynomial& a, const RatePolynomial& b) {
    switch (Builder::node(e).operation) {
        case Operation::add:
            return plus(a, b, false);
        case Operation::subtract:
            return plus(a, b, true);
        case Operation::negate:
            return plus({}, a, true);
        case Operation::multiply:
            return times(a, b);
        case Operation::divide: {
            if (!is_free(b)) return std::nullopt;
            RatePolynomial result;
            for (const auto& [key, x] : a) add_term(result, key, x / b.begin()->second);
            return result;
        }
        case Operation::power: {
            const int exponent = Builder::node(e).exponent;
            if (exponent < 0 || exponent > highest_degree) return std::nullopt;
            std::optional<RatePolynomial> result = a;
            for (int i = 1; i < exponent && result; ++i) result = times(*result, a);
            return result;
        }
        default:
            return std::nullopt;  // a function of a rate
    }
}

}  // namespace

std::optional<RatePolynomial> expand_in_rates(Expression expression, std::span<const std::uint32_t> slots,
                                              Expression& offender) {
    Graph& graph = expression.graph();
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<RatePolynomial> of(needed.size());
    std::vector<bool> has_rates(needed.size(), false);
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph.node(id);
        const Expression e{&graph, id};
        const bool binary = is_binary(node.operation), leaf = is_leaf(node.operation);
        const auto rate = std::find(slots.begin(), slots.end(), node.a);
        if (node.operation == Operation::symbol && rate != slots.end()) {
            Key key{};
            key[static_cast<std::size_t>(rate - slots.begin())] = 1;
            of[id] = {{key, graph.number(1)}};
            has_rates[id] = true;
        } else if (leaf || !(has_rates[node.a] || (binary && has_rates[node.b]))) {
            if (!e.is_zero()) of[id] = {{Key{}, e}};
        } else {
            has_rates[id] = true;
            const std::optional<RatePolynomial> p = combine(e, of[node.a], binary ? of[node.b] : RatePolynomial{});
            if (!p) {
                offender = e;
                return std::nullopt;
            }
            of[id] = *p;
        }
    }
    return of[expression.id()];
}

}  // namespace achilles
