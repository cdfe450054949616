#include "model/read_expressions.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "expression/graph.hpp"
#include "expression/parse.hpp"
#include "model/restitution.hpp"
#include "model/scopes.hpp"
#include "program/program.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

std::string without_primes(const std::string& name) { return name.substr(0, name.find('\'')); }

// Reads the texts of one file and collects their mistakes.
class ExpressionReader {
 public:
    ExpressionReader(Graph& graph, Names& names, ErrorCollector& mistakes)
        : graph_(graph), names_(names), mistakes_(mistakes) {}

    // Returns nullopt if the text is missing or has a mistake, which is added.
    std::optional<Expression> read(const Text& text, Scope& scope, TextParts* parts = nullptr) {
        if (text.text.empty()) return std::nullopt;
        for (bool is_certain = true;; is_certain = false) {
            try {
                const Expression expression = parse(text.text, scope, graph_, parts);
                return is_certain ? std::optional(expression) : std::nullopt;
            } catch (const ParseError& error) {
                // After a substituted name only further unknown names are reported: other errors may follow from the
                // substitution.
                const bool is_reported = error.name.empty() ? !is_certain : needs_no_message(error.name, scope);
                if (!is_reported) mistakes_.add({place_in(text, error.offset), error.what(), error.hint});
                // A hint proposes the whole text as intended, so parsing need not continue.
                if (error.name.empty() || !error.hint.empty() || !go_on(error.name, scope)) return std::nullopt;
            }
        }
    }

 private:
    // Whether this name needs no message. An unknown name is reported once.
    bool needs_no_message(const std::string& name, const Scope& scope) {
        const std::string bare = without_primes(name);
        if (names_.reported.contains(bare)) return true;
        if (scope.forbidden.contains(name) || is_reserved(bare)) return false;
        names_.reported.insert(bare);
        return !names_.complete;
    }

    // Replaces an unknown name by a symbol, so that parsing can continue. Returns false if that does not help.
    bool go_on(const std::string& name, Scope& scope) {
        constexpr int most = 100;  // limit for one file: each replacement parses the text again
        if (!names_.reported.contains(without_primes(name)) || ++guesses_ > most) return false;
        return scope.allowed.emplace(name, graph_.symbol(0)).second;
    }

    Graph& graph_;
    Names& names_;
    ErrorCollector& mistakes_;
    int guesses_ = 0;
};

// ---- the kinetic energy ----

std::vector<std::uint32_t> rate_slots(const Layout& layout) {
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < layout.dof; ++i) slots.push_back(layout.v(i));
    return slots;
}

int degree(const RatePolynomial::key_type& exponents) {
    int sum = 0;
    for (const std::uint8_t exponent : exponents) sum += exponent;
    return sum;
}

// One term of a polynomial in the rates, multiplied out.
Expression term_of(const RatePolynomial::value_type& entry, const Layout& layout) {
    Expression term = entry.second;
    for (std::size_t i = 0; i < layout.dof; ++i) term = term * power(term.graph().symbol(layout.v(i)), entry.first[i]);
    return term;
}

constexpr const char* quadratic = "kinetic energy must be quadratic in the rates, as in m/2*x'^2";

std::string written(const Text& text, const TextPart& part) { return shown(text.text.substr(part.offset, part.size)); }

// Message: the part of T that is not a polynomial in the rates.
Mistake not_polynomial(const Text& kinetic, const TextParts& parts, Expression offender,
                       const std::vector<std::string>& names) {
    const Operation operation = Builder::node(offender).operation;
    const bool is_power =
        operation == Operation::multiply || (operation == Operation::power && Builder::node(offender).exponent > 0);
    const char* what = is_power ? "the kinetic energy has a degree above 8 in the rates: {}"
                                : "the kinetic energy is not a polynomial in the rates: {}";
    const auto place =
        std::find_if(parts.all.begin(), parts.all.end(), [&](const TextPart& part) { return part.value == offender; });
    const bool is_written = place != parts.all.end();
    return {place_in(kinetic, is_written ? place->offset : 0),
            fmt::format(fmt::runtime(what), is_written ? written(kinetic, *place) : to_text(offender, names)),
            quadratic};
}

// Message: the first term of T, as written, that contributes a term of degree other than 2 to the expanded T.
Mistake not_quadratic(const Text& kinetic, const TextParts& parts, const RatePolynomial& whole, const Layout& layout,
                      const std::vector<std::string>& names) {
    const auto is_wrong = [](const RatePolynomial::value_type& entry) { return degree(entry.first) != 2; };
    const auto mistake_of = [&](const RatePolynomial::key_type& exponents, const std::string& term,
                                std::size_t offset) {
        const int d = degree(exponents);
        return Mistake{place_in(kinetic, offset),
                       fmt::format("the term {} of the kinetic energy has degree {} in the rates", term, d),
                       d == 0 ? "move terms without rates to the potential, with opposite sign" : quadratic};
    };
    for (const TextPart& part : parts.terms) {
        Expression ignored;
        const auto expanded = expand_in_rates(part.value, rate_slots(layout), ignored);
        for (const auto& entry : expanded.value_or(RatePolynomial{})) {
            if (!is_wrong(entry) || !whole.contains(entry.first)) continue;
            const bool is_all = expanded->size() == 1;
            return mistake_of(entry.first, is_all ? written(kinetic, part) : to_text(term_of(entry, layout), names),
                              part.offset);
        }
    }
    const auto wrong = std::find_if(whole.begin(), whole.end(), is_wrong);
    return mistake_of(wrong->first, to_text(term_of(*wrong, layout), names), 0);
}

// M from T = v'Mv/2, expanded in the rates. Throws Mistake.
void read_mass_matrix(const SystemDescription& system, const Layout& layout, const TextParts& parts,
                      Equations& equations) {
    const std::size_t n = layout.dof;
    const std::vector<std::string> names = slot_names(system, layout);
    Graph& graph = equations.kinetic.graph();
    Expression offender;
    const auto polynomial = expand_in_rates(equations.kinetic, rate_slots(layout), offender);
    if (!polynomial) throw not_polynomial(system.kinetic, parts, offender, names);
    for (const auto& [exponents, coefficient] : *polynomial)
        if (degree(exponents) != 2) throw not_quadratic(system.kinetic, parts, *polynomial, layout, names);
    equations.M.assign(n * n, graph.number(0));
    for (const auto& [exponents, coefficient] : *polynomial) {
        std::vector<std::size_t> factors;
        for (std::size_t i = 0; i < n; ++i) factors.insert(factors.end(), exponents[i], i);
        const std::size_t i = factors[0], j = factors[1];  // T = sum of c_ij v_i v_j over i <= j
        equations.M[i * n + j] = equations.M[j * n + i] = i == j ? graph.number(2) * coefficient : coefficient;
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (!equations.M[i * n + i].is_zero()) continue;
        throw Mistake{place_in(system.kinetic, 0),
                      fmt::format("the kinetic energy has no term in {}'^2", system.coordinates[i].name),
                      "every coordinate needs a positive inertia"};
    }
}

void check_gap(const Text& text, Expression gap, const Layout& layout) {
    std::vector<std::uint32_t> q;
    for (std::size_t i = 0; i < layout.dof; ++i) q.push_back(layout.q(i));
    const std::vector<Expression> slope = gradient(gap, q);
    if (std::all_of(slope.begin(), slope.end(), [](Expression e) { return e.is_zero(); }))
        throw Mistake{text.at, "dh = 0 everywhere: the gap does not change with any coordinate", {}};
}

// Calls a function that creates nodes; if the graph becomes too large, adds a mistake located at this text.
template <class Make>
void attempt_within_limits(ErrorCollector& mistakes, const Text& text, const Make& make) {
    mistakes.attempt([&] {
        try {
            make();
        } catch (const ExpressionTooLarge& problem) {
            throw Mistake{text.at, fmt::format("the equations of motion are too large: {}", problem.what()), {}};
        }
    });
}

// Reads the derived parameters to report their mistakes. Their values are part of the scopes.
void read_definitions(const SystemDescription& system, const Layout& layout, ExpressionReader& reader, Graph& graph) {
    if (system.derived.empty()) return;
    const Scope parameters = definition_scope(system, layout, graph);
    for (const DerivedDescription& derived : system.derived) {
        Scope scope = parameters;
        allow_units(scope, derived.unit, graph);
        reader.read(derived.definition, scope);
    }
}

// Q_i = force_i - dR/dv_i.
void read_forces(const SystemDescription& system, const Layout& layout, ExpressionReader& reader, Equations& equations,
                 ErrorCollector& mistakes) {
    Graph& graph = equations.kinetic.graph();
    Scope scope = force_scope(system, layout, graph);
    equations.Q.clear();
    for (const CoordinateDescription& coordinate : system.coordinates)
        equations.Q.push_back(reader.read(coordinate.force, scope).value_or(graph.number(0)));
    const auto dissipation = reader.read(system.dissipation, scope);
    if (!dissipation) return;
    attempt_within_limits(mistakes, system.dissipation, [&] {
        const std::vector<Expression> slope = gradient(*dissipation, rate_slots(layout));
        for (std::size_t i = 0; i < slope.size(); ++i) equations.Q[i] = equations.Q[i] - slope[i];
    });
}

}  // namespace

void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, ErrorCollector& mistakes) {
    ExpressionReader reader(graph, names, mistakes);
    TextParts parts;
    const auto read = [&](const Text& text, Scope scope, TextParts* places = nullptr) {
        return reader.read(text, scope, places);
    };
    read_definitions(system, layout, reader, graph);
    const auto kinetic = read(system.kinetic, kinetic_scope(system, layout, graph), &parts);
    const auto potential = read(system.potential, potential_scope(system, layout, graph));
    std::vector<std::optional<Expression>> gaps, restitutions;
    for (const ConstraintDescription& constraint : system.constraints) {
        gaps.push_back(read(constraint.gap, gap_scope(system, layout, graph)));
        restitutions.push_back(read(constraint.restitution, restitution_scope(system, layout, graph)));
    }
    const Expression nothing = graph.number(0);
    equations.kinetic = kinetic.value_or(nothing);
    equations.potential = potential.value_or(nothing);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        equations.gaps.push_back(gaps[i].value_or(nothing));
        equations.restitutions.push_back(restitutions[i].value_or(nothing));
    }
    if (kinetic && names.complete)
        attempt_within_limits(mistakes, system.kinetic, [&] { read_mass_matrix(system, layout, parts, equations); });
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const ConstraintDescription& constraint = system.constraints[i];
        if (gaps[i] && names.complete)
            attempt_within_limits(mistakes, constraint.gap, [&] { check_gap(constraint.gap, *gaps[i], layout); });
        // A restitution that depends on parameters is checked at the start of a run.
        if (restitutions[i] && is_constant(*restitutions[i]))
            if (auto mistake = mistake_in(constraint.restitution, value_of_constant(*restitutions[i])))
                mistakes.add(std::move(*mistake));
    }
    read_forces(system, layout, reader, equations, mistakes);
}

namespace {

void read_pictures(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations,
                   ExpressionReader& reader) {
    Scope in_drawings = drawing_scope(system, layout, graph);
    for (const DrawingDescription& drawing : drawings_of(system)) {
        if (drawing.shape == DrawingDescription::Shape::curve && drawing.over.empty()) continue;  // its name is missing
        if (!drawing.over.empty()) in_drawings.allowed.insert_or_assign(drawing.over, graph.symbol(layout.own()));
        for (const Text& text : texts_of(drawing)) reader.read(text, in_drawings);
        in_drawings.allowed.erase(drawing.over);
    }
    Scope in_views = view_scope(system, layout, graph, equations);
    for (const ViewDescription& view : system.views) {
        reader.read(view.x, in_views);
        for (const Text& text : view.y) reader.read(text, in_views);
    }
    if (!system.orbit) return;
    Scope in_orbit = closing_scope(system, layout, graph);
    reader.read(system.orbit->period, in_orbit);
    for (const Text& text : system.orbit->shift) reader.read(text, in_orbit);
}

}  // namespace

bool check_expressions(const SystemDescription& system, Names names, ErrorCollector& mistakes) {
    const Layout layout = layout_of(system);
    Graph graph;
    Equations equations;
    const std::size_t before = mistakes.count();
    read_equations(system, layout, graph, names, equations, mistakes);
    const bool has_equations = mistakes.count() == before;
    const Expression any_value = graph.symbol(layout.t());
    equations.energy = equations.power = any_value;
    equations.free.contacts.resize(system.constraints.size());
    for (ContactEquations& c : equations.free.contacts) c.hdot = c.hddot = c.lambda = c.gap_t = any_value;
    ExpressionReader reader(graph, names, mistakes);
    attempt_within_limits(mistakes, system.kinetic, [&] { read_pictures(system, layout, graph, equations, reader); });
    return has_equations;
}

namespace {

using Key = RatePolynomial::key_type;
constexpr int highest_degree = 8;

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
            if (std::accumulate(key.begin(), key.end(), 0) > highest_degree) return std::nullopt;
            add_term(result, key, x * y);
        }
    }
    return result;
}

bool is_free(const RatePolynomial& p) { return p.empty() || (p.size() == 1 && p.begin()->first == Key{}); }

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
            for (const auto& [key, x] : a) add_term(result, key, x / Builder::second(e));
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
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph.node(id);
        const Expression e{&graph, id};
        const bool binary = is_binary(node.operation), leaf = is_leaf(node.operation);
        if (node.operation == Operation::symbol) {
            Key key{};
            for (std::size_t i = 0; i < key.size() && i < slots.size(); ++i)
                if (slots[i] == node.a) key[i] = 1;
            of[id] = {{key, key == Key{} ? e : graph.number(1)}};
        } else if (leaf || (is_free(of[node.a]) && (!binary || is_free(of[node.b])))) {
            if (!e.is_zero()) of[id] = {{Key{}, e}};
        } else {
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
