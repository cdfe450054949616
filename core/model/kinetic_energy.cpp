#include "model/kinetic_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "algebra/vanishes.hpp"
#include "expression/graph.hpp"
#include "model/rate_polynomial.hpp"
#include "model/scopes.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// One term of a polynomial in the rates, multiplied out.
Expression term_of(const RatePolynomial::value_type& entry, const Layout& layout) {
    Expression term = entry.second;
    for (std::size_t i = 0; i < layout.dof; ++i) term = term * power(term.graph().symbol(layout.v(i)), entry.first[i]);
    return term;
}

constexpr const char* at_most_quadratic =
    "kinetic energy must have degree 2 or less in the rates, as in m/2*(x' + u*cos(t))^2";
constexpr const char* moving_coordinate =
    "choose a coordinate that moves with the prescribed motion: with s = l(t)*theta instead of theta, "
    "m/2*(l(t)*theta')^2 "
    "is m/2*(s' - s*l'(t)/l(t))^2, and the factor of s'^2 does not depend on t";

std::string written(const Text& text, const TextPart& part) { return shown(text.text.substr(part.offset, part.size)); }

// Writes the messages about a kinetic energy. `parts` locates the terms of its text.
class KineticMistakes {
 public:
    KineticMistakes(const SystemDescription& system, const Layout& layout, const TextParts& parts)
        : text_(system.kinetic), layout_(layout), parts_(parts), names_(slot_names(system, layout)) {}

    // The part of T that is not a polynomial in the rates.
    Mistake not_polynomial(Expression offender) const {
        const Operation operation = Builder::node(offender).operation;
        const bool is_power =
            operation == Operation::multiply || (operation == Operation::power && Builder::node(offender).exponent > 0);
        const char* what = is_power ? "the kinetic energy has a degree far above 2 in the rates: {}"
                                    : "the kinetic energy is not a polynomial in the rates: {}";
        const auto place = std::find_if(parts_.all.begin(), parts_.all.end(),
                                        [&](const TextPart& part) { return part.value == offender; });
        const bool is_written = place != parts_.all.end();
        return {place_in(text_, is_written ? place->offset : 0),
                fmt::format(fmt::runtime(what), is_written ? written(text_, *place) : to_text(offender, names_)),
                at_most_quadratic};
    }

    // The first term of T, as written, that contributes a term of degree 3 or more to the expanded T.
    Mistake degree_above_2(const RatePolynomial& whole, std::span<const std::uint32_t> rates) const {
        const auto is_wrong = [](const RatePolynomial::value_type& entry) { return degree(entry.first) > 2; };
        const auto [entry, text, offset] = first_term(whole, rates, is_wrong);
        return {place_in(text_, offset),
                fmt::format("the term {} of the kinetic energy has degree {} in the rates", text, degree(entry.first)),
                at_most_quadratic};
    }

    // The first term of T, as written, in which the factor of these rates depends on t.
    Mistake depends_on_time(const RatePolynomial& whole, const RatePolynomial::key_type& exponents,
                            std::span<const std::uint32_t> rates) const {
        const std::uint32_t t = layout_.t();
        const auto is_wrong = [&](const RatePolynomial::value_type& entry) {
            return entry.first == exponents && depends_on(entry.second, {&t, 1});
        };
        const auto [entry, text, offset] = first_term(whole, rates, is_wrong);
        return {place_in(text_, offset),
                fmt::format("the term {} of the kinetic energy makes the mass matrix depend on t", text),
                moving_coordinate};
    }

 private:
    struct Found {
        RatePolynomial::value_type entry;
        std::string text;
        std::size_t offset;
    };
    // The first term of the text with an entry of the expanded T for which is_wrong(entry) holds; the whole T if no
    // term has one by itself.
    template <class IsWrong>
    Found first_term(const RatePolynomial& whole, std::span<const std::uint32_t> rates, const IsWrong& is_wrong) const {
        for (const TextPart& part : parts_.terms) {
            Expression ignored;
            const auto expanded = expand_in_rates(part.value, rates, ignored);
            for (const auto& entry : expanded.value_or(RatePolynomial{})) {
                if (!is_wrong(entry) || !whole.contains(entry.first)) continue;
                const bool is_all = expanded->size() == 1;
                return {entry, is_all ? written(text_, part) : to_text(term_of(entry, layout_), names_), part.offset};
            }
        }
        const auto& entry = *std::find_if(whole.begin(), whole.end(), is_wrong);
        return {entry, to_text(term_of(entry, layout_), names_), 0};
    }

    const Text& text_;
    const Layout& layout_;
    const TextParts& parts_;
    std::vector<std::string> names_;
};

// The same expression without t, if it is proved not to depend on t; else the expression itself.
Expression without_time(Expression expression, std::uint32_t t) {
    if (!depends_on(expression, {&t, 1}) || !vanishes(derivative(expression, t))) return expression;
    const Expression zero = expression.graph().number(0);
    try {
        return substitute(expression, {&t, 1}, {&zero, 1});
    } catch (const std::domain_error&) {  // undefined at t = 0
        return expression;
    }
}

// Leaves out the terms of a sum that contain none of these symbols.
Expression terms_with(Expression sum, std::span<const std::uint32_t> symbols) {
    Graph& graph = sum.graph();
    const Expression nothing = graph.number(0);
    const std::vector<bool> needed = reachable(std::span(&sum, 1));
    std::vector<Expression> kept(needed.size(), nothing);  // by node; 0 for a node without the symbols
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph.node(id);  // a copy, because nodes are created below
        const bool is_symbol = node.operation == Operation::symbol;
        if (is_symbol && std::find(symbols.begin(), symbols.end(), node.a) != symbols.end()) kept[id] = {&graph, id};
        if (is_leaf(node.operation)) continue;
        const Expression a = kept[node.a], b = is_binary(node.operation) ? kept[node.b] : nothing;
        if (a.is_zero() && b.is_zero()) continue;
        kept[id] = {&graph, id};
        if (node.operation == Operation::add) kept[id] = a + b;
        if (node.operation == Operation::subtract) kept[id] = a - b;
        if (node.operation == Operation::negate) kept[id] = -a;
        if (node.operation == Operation::multiply && a.is_zero()) kept[id] = Expression(&graph, node.a) * b;
        if (node.operation == Operation::multiply && b.is_zero()) kept[id] = a * Expression(&graph, node.b);
        if (node.operation == Operation::divide && b.is_zero()) kept[id] = a / Expression(&graph, node.b);
    }
    return kept[sum.id()];
}

std::vector<std::uint32_t> slots_of(const Layout& layout, std::uint32_t (Layout::*slot)(std::size_t) const) {
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < layout.dof; ++i) slots.push_back((layout.*slot)(i));
    return slots;
}

}  // namespace

bool PrescribedMotion::is_none() const {
    return T0.is_zero() && std::all_of(c.begin(), c.end(), [](Expression x) { return x.is_zero(); });
}

PrescribedMotion read_kinetic_energy(const SystemDescription& system, const Layout& layout, const TextParts& parts,
                                     Equations& equations) {
    const std::size_t n = layout.dof;
    const KineticMistakes mistakes(system, layout, parts);
    const std::vector<std::uint32_t> rates = slots_of(layout, &Layout::v);
    const std::uint32_t t = layout.t();
    Graph& graph = equations.given.kinetic.graph();
    Expression offender;
    const auto polynomial = expand_in_rates(equations.given.kinetic, rates, offender);
    if (!polynomial) throw mistakes.not_polynomial(offender);
    for (const auto& [exponents, coefficient] : *polynomial)
        if (degree(exponents) > 2) throw mistakes.degree_above_2(*polynomial, rates);
    const Expression nothing = graph.number(0);
    equations.M.assign(n * n, nothing);
    PrescribedMotion motion{std::vector<Expression>(n, nothing), nothing};
    Expression quadratic = nothing;
    bool is_quadratic = true;
    for (const auto& [exponents, given] : *polynomial) {
        const Expression coefficient = without_time(given, t);
        std::vector<std::size_t> factors;
        for (std::size_t i = 0; i < n; ++i) factors.insert(factors.end(), exponents[i], i);
        is_quadratic = is_quadratic && factors.size() == 2 && coefficient == given;
        if (factors.empty()) motion.T0 = terms_with(coefficient, slots_of(layout, &Layout::q));
        if (factors.size() == 1) motion.c[factors[0]] = coefficient;
        if (factors.size() != 2) continue;
        if (depends_on(coefficient, {&t, 1})) throw mistakes.depends_on_time(*polynomial, exponents, rates);
        const std::size_t i = factors[0], j = factors[1];  // T2 = sum of c_ij v_i v_j over i <= j
        equations.M[i * n + j] = equations.M[j * n + i] = i == j ? graph.number(2) * coefficient : coefficient;
        quadratic = quadratic + term_of({exponents, coefficient}, layout);
    }
    equations.kinetic = is_quadratic ? equations.given.kinetic : quadratic;
    for (std::size_t i = 0; i < n; ++i) {
        if (!equations.M[i * n + i].is_zero()) continue;
        throw Mistake{place_in(system.kinetic, 0),
                      fmt::format("the kinetic energy has no term in {}'^2", system.coordinates[i].name),
                      "every coordinate needs a positive inertia"};
    }
    return motion;
}

void add_prescribed_motion(const PrescribedMotion& motion, const Layout& layout, Equations& equations) {
    if (motion.is_none()) return;
    const std::size_t n = layout.dof;
    Graph& graph = motion.T0.graph();
    const std::vector<std::vector<Expression>> slope = jacobian(motion.c, slots_of(layout, &Layout::q));
    for (std::size_t i = 0; i < n; ++i) {
        Expression force = -derivative(motion.c[i], layout.t());
        for (std::size_t k = 0; k < n; ++k)
            if (k != i) force = force - (slope[i][k] - slope[k][i]) * graph.symbol(layout.v(k));
        equations.Q[i] = equations.Q[i] + force;
    }
    equations.potential = equations.potential - motion.T0;
}

}  // namespace achilles
