#include "model/read_expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "expression/graph.hpp"
#include "model/rate_polynomial.hpp"
#include "program/program.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

void allow_positions(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph) {
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
        scope.allowed.emplace(system.coordinates[i].name, graph.symbol(layout.q(i)));
}

void allow_rates(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph) {
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
        scope.allowed.emplace(system.coordinates[i].name + "'", graph.symbol(layout.v(i)));
}

void allow_parameters(Scope& scope, const SystemDescription& system, const Layout& layout, Graph& graph) {
    for (std::size_t i = 0; i < system.parameters.size(); ++i)
        scope.allowed.emplace(system.parameters[i].name, graph.symbol(layout.parameter(i)));
}

// Names with primes that mean nothing anywhere.
void forbid_primes(Scope& scope, const SystemDescription& system) {
    for (const CoordinateDescription& coordinate : system.coordinates)
        scope.forbidden.emplace(
            coordinate.name + "''",
            fmt::format("the acceleration {}'' may not stand in an expression: it follows from them", coordinate.name));
    for (const ParameterDescription& parameter : system.parameters)
        scope.forbidden.emplace(parameter.name + "'",
                                fmt::format("'{}' is a parameter: it has no rate", parameter.name));
}

// Words that mean something in views only.
void forbid_outputs(Scope& scope) {
    for (const char* word : {"gap", "gap'", "gap''", "lambda", "energy"})
        scope.forbidden.emplace(word, fmt::format("'{}' may stand in a [[view]] only", word));
    scope.forbidden.emplace("t", "'t' may stand in a [[view]] only: a system does not depend on time");
}

Scope kinetic_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    Scope scope;
    allow_positions(scope, system, layout, graph);
    allow_rates(scope, system, layout, graph);
    allow_parameters(scope, system, layout, graph);
    forbid_primes(scope, system);
    forbid_outputs(scope);
    return scope;
}

// Coordinates and parameters; `what` is the text that they stand in.
Scope position_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const char* what) {
    Scope scope;
    allow_positions(scope, system, layout, graph);
    allow_parameters(scope, system, layout, graph);
    for (const CoordinateDescription& coordinate : system.coordinates)
        scope.forbidden.emplace(coordinate.name + "'",
                                fmt::format("the rate {}' may not stand in the {}: it depends on coordinates alone",
                                            coordinate.name, what));
    forbid_primes(scope, system);
    forbid_outputs(scope);
    return scope;
}

Scope restitution_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    Scope scope;
    allow_parameters(scope, system, layout, graph);
    for (const CoordinateDescription& coordinate : system.coordinates) {
        const std::string& name = coordinate.name;
        scope.forbidden.emplace(
            name, fmt::format("the coordinate '{}' may not stand in the restitution: parameters alone", name));
        scope.forbidden.emplace(name + "'",
                                fmt::format("the rate {}' may not stand in the restitution: parameters alone", name));
    }
    forbid_primes(scope, system);
    forbid_outputs(scope);
    return scope;
}

std::string without_primes(const std::string& name) { return name.substr(0, name.find('\'')); }

// Reads the texts of one file.
class Reader {
 public:
    Reader(Graph& graph, Names& names, Mistakes& mistakes) : graph_(graph), names_(names), mistakes_(mistakes) {}

    // Nothing where the text is missing or has a mistake, which is added.
    std::optional<Expression> read(const Text& text, Scope& scope, TextParts* parts = nullptr) {
        if (text.text.empty()) return std::nullopt;
        for (bool is_certain = true;; is_certain = false) {
            try {
                const Expression expression = parse(text.text, scope, graph_, parts);
                return is_certain ? std::optional(expression) : std::nullopt;
            } catch (const ParseError& error) {
                // With a guess in it, nothing but another name can be blamed.
                const bool is_told = error.name.empty() ? !is_certain : excuse(error.name, scope);
                if (!is_told) mistakes_.add({place_in(text, error.offset), error.what(), {}});
                if (error.name.empty() || !go_on(error.name, scope)) return std::nullopt;
            }
        }
    }

 private:
    // True if nothing needs to be said about this name. An unknown one is told once.
    bool excuse(const std::string& name, const Scope& scope) {
        const std::string bare = without_primes(name);
        if (names_.excused.contains(bare)) return true;
        if (scope.forbidden.contains(name) || is_reserved(bare)) return false;
        names_.excused.insert(bare);
        return !names_.complete;
    }

    // Lets an unknown name stand for anything, to read on. False if that does not help.
    bool go_on(const std::string& name, Scope& scope) {
        constexpr int most = 100;  // in one file: each costs another reading
        if (!names_.excused.contains(without_primes(name)) || ++guesses_ > most) return false;
        return scope.allowed.emplace(name, graph_.symbol(0)).second;
    }

    Graph& graph_;
    Names& names_;
    Mistakes& mistakes_;
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

// The part of T that is no polynomial in the rates.
Mistake not_polynomial(const Text& kinetic, const TextParts& parts, Expression offender,
                       const std::vector<std::string>& names) {
    const Operation operation = Builder::node(offender).operation;
    const bool is_power =
        operation == Operation::multiply || (operation == Operation::power && Builder::node(offender).exponent > 0);
    const char* what = is_power ? "the kinetic energy is of a degree above 8 in the rates: {}"
                                : "the kinetic energy is no polynomial in the rates: {}";
    const auto place =
        std::find_if(parts.all.begin(), parts.all.end(), [&](const TextPart& part) { return part.value == offender; });
    const bool is_written = place != parts.all.end();
    return {place_in(kinetic, is_written ? place->offset : 0),
            fmt::format(fmt::runtime(what), is_written ? written(kinetic, *place) : to_text(offender, names)),
            quadratic};
}

// The first term of T, as written, that leaves a term of another degree than 2 in the whole.
Mistake not_quadratic(const Text& kinetic, const TextParts& parts, const RatePolynomial& whole, const Layout& layout,
                      const std::vector<std::string>& names) {
    const auto is_wrong = [](const RatePolynomial::value_type& entry) { return degree(entry.first) != 2; };
    const auto told = [&](const RatePolynomial::key_type& exponents, const std::string& term, std::size_t offset) {
        const int d = degree(exponents);
        return Mistake{place_in(kinetic, offset),
                       fmt::format("the term {} of the kinetic energy is of degree {} in the rates", term, d),
                       d == 0 ? "what has no rate in it belongs to the potential, with the other sign" : quadratic};
    };
    for (const TextPart& part : parts.terms) {
        Expression ignored;
        const auto expanded = expand_in_rates(part.value, rate_slots(layout), ignored);
        for (const auto& entry : expanded.value_or(RatePolynomial{})) {
            if (!is_wrong(entry) || !whole.contains(entry.first)) continue;
            const bool is_all = expanded->size() == 1;
            return told(entry.first, is_all ? written(kinetic, part) : to_text(term_of(entry, layout), names),
                        part.offset);
        }
    }
    const auto wrong = std::find_if(whole.begin(), whole.end(), is_wrong);
    return told(wrong->first, to_text(term_of(*wrong, layout), names), 0);
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

// Runs what makes nodes, and tells what became too large at this text.
template <class Make>
void attempt_within_limits(Mistakes& mistakes, const Text& text, const Make& make) {
    mistakes.attempt([&] {
        try {
            make();
        } catch (const TooLarge& problem) {
            throw Mistake{text.at, fmt::format("the equations of motion are too large: {}", problem.what()), {}};
        }
    });
}

// A restitution that no parameter changes. One that parameters change is looked at when a run starts.
void check_restitution(const Text& text, Expression restitution) {
    if (!is_constant(restitution)) return;
    const double e = value_of_constant(restitution);
    if (!(e >= 0.0 && e <= 1.0))
        throw Mistake{text.at, fmt::format("the restitution must lie in [0, 1], but it is {}", e),
                      "0 is plastic, 1 is elastic"};
}

}  // namespace

std::vector<std::string> slot_names(const SystemDescription& system, const Layout& layout) {
    std::vector<std::string> names(layout.count());
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
        names[layout.q(i)] = system.coordinates[i].name;
        names[layout.v(i)] = system.coordinates[i].name + "'";
    }
    for (std::size_t i = 0; i < system.parameters.size(); ++i) names[layout.parameter(i)] = system.parameters[i].name;
    names[layout.t()] = "t";
    names[layout.contact()] = "contact";
    names[layout.sigma()] = "sigma";
    names[layout.own()] = "own";
    names[layout.work()] = "work";
    names[layout.loss()] = "loss";
    return names;
}

Scope view_scope(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations) {
    Scope scope;
    allow_positions(scope, system, layout, graph);
    allow_rates(scope, system, layout, graph);
    allow_parameters(scope, system, layout, graph);
    forbid_primes(scope, system);
    const Expression contact = graph.symbol(layout.contact());
    scope.allowed.emplace("t", graph.symbol(layout.t()));
    scope.allowed.emplace("gap", graph.adopt(equations.gap));
    scope.allowed.emplace("gap'", graph.adopt(equations.hdot));
    scope.allowed.emplace("gap''", (graph.number(1) - contact) * graph.adopt(equations.hddot));
    scope.allowed.emplace("lambda", contact * graph.adopt(equations.lambda));
    scope.allowed.emplace("energy", graph.adopt(equations.energy));
    scope.allowed.emplace(
        "power", graph.adopt(equations.power) - contact * graph.adopt(equations.lambda) * graph.adopt(equations.gap_t));
    scope.allowed.emplace("work", graph.symbol(layout.work()));
    scope.allowed.emplace("loss", graph.symbol(layout.loss()));
    return scope;
}

Scope drawing_scope(const SystemDescription& system, const Layout& layout, Graph& graph) {
    return position_scope(system, layout, graph, "drawing");
}

void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, Mistakes& mistakes) {
    Reader reader(graph, names, mistakes);
    TextParts parts;
    const auto read = [&](const Text& text, Scope scope, TextParts* places = nullptr) {
        return reader.read(text, scope, places);
    };
    const auto kinetic = read(system.kinetic, kinetic_scope(system, layout, graph), &parts);
    const auto potential = read(system.potential, position_scope(system, layout, graph, "potential"));
    const auto gap = read(system.gap, position_scope(system, layout, graph, "gap"));
    const auto restitution = read(system.restitution, restitution_scope(system, layout, graph));
    const Expression nothing = graph.number(0);
    equations.kinetic = kinetic.value_or(nothing);
    equations.potential = potential.value_or(nothing);
    equations.gap = gap.value_or(nothing);
    equations.restitution = restitution.value_or(nothing);
    equations.Q.assign(layout.dof, nothing);
    if (kinetic && names.complete)
        attempt_within_limits(mistakes, system.kinetic, [&] { read_mass_matrix(system, layout, parts, equations); });
    if (gap && names.complete)
        attempt_within_limits(mistakes, system.gap, [&] { check_gap(system.gap, *gap, layout); });
    if (restitution) mistakes.attempt([&] { check_restitution(system.restitution, *restitution); });
}

namespace {

void read_pictures(const SystemDescription& system, const Layout& layout, Graph& graph, const Equations& equations,
                   Reader& reader) {
    Scope in_drawings = drawing_scope(system, layout, graph);
    for (const DrawingDescription& drawing : system.drawings) {
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
}

}  // namespace

void check_expressions(const SystemDescription& system, Names names, Mistakes& mistakes) {
    const Layout layout{static_cast<std::uint32_t>(system.coordinates.size()),
                        static_cast<std::uint32_t>(system.parameters.size())};
    Graph graph;
    Equations equations;
    read_equations(system, layout, graph, names, equations, mistakes);
    equations.hdot = equations.hddot = equations.lambda = equations.energy = equations.power = equations.gap_t =
        graph.symbol(layout.t());  // any value
    Reader reader(graph, names, mistakes);
    attempt_within_limits(mistakes, system.kinetic, [&] { read_pictures(system, layout, graph, equations, reader); });
}

}  // namespace achilles
