#include "model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/rate_polynomial.hpp"

namespace achilles {

namespace {

// The place of a byte inside a text that starts at `text.at`.
Location place_in(const Text& text, std::size_t offset) {
    Location at = text.at;
    for (std::size_t i = 0; i < offset && i < text.text.size(); ++i) {
        ++at.column;
        if (text.text[i] == '\n') at = {at.line + 1, 1};
    }
    return at;
}

// Coordinates, rates and parameters by name.
struct Names {
    Scope coordinates, rates, parameters;  // only `allowed` is filled
};

Names names_of(const SystemDescription& description, const Layout& layout, Graph& graph) {
    Names names;
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const std::string& name = description.coordinates[i].name;
        names.coordinates.allowed.emplace(name, graph.symbol(layout.q(i)));
        names.rates.allowed.emplace(name + "'", graph.symbol(layout.v(i)));
    }
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        names.parameters.allowed.emplace(description.parameters[i].name, graph.symbol(layout.parameter(i)));
    return names;
}

void allow(Scope& scope, const Scope& names) { scope.allowed.insert(names.allowed.begin(), names.allowed.end()); }

void forbid(Scope& scope, const Scope& names, const std::string& why) {
    for (const auto& [name, symbol] : names.allowed)
        scope.forbidden.emplace(name, fmt::format(fmt::runtime(why), name));
}

// Words that mean something in views only.
void forbid_outputs(Scope& scope) {
    for (const char* word : {"gap", "gap'", "gap''", "lambda", "energy"})
        scope.forbidden.emplace(word, fmt::format("'{}' may stand in a [[view]] only", word));
    scope.forbidden.emplace("t", "'t' may stand in a [[view]] only: a system does not depend on time");
}

Scope position_scope(const Names& names, const char* what) {
    Scope scope;
    allow(scope, names.coordinates);
    allow(scope, names.parameters);
    forbid(scope, names.rates,
           fmt::format("the rate {{}} may not stand in the {}: it depends on coordinates alone", what));
    forbid_outputs(scope);
    return scope;
}

}  // namespace

Model::Model(SystemDescription description) : description_(std::move(description)), graph_(std::make_unique<Graph>()) {
    layout_ = {static_cast<std::uint32_t>(description_.coordinates.size()),
               static_cast<std::uint32_t>(description_.parameters.size())};
    for (const auto& coordinate : description_.coordinates) slot_names_.push_back(coordinate.name);
    for (const auto& coordinate : description_.coordinates) slot_names_.push_back(coordinate.name + "'");
    for (const auto& parameter : description_.parameters) slot_names_.push_back(parameter.name);
    for (const char* name : {"t", "contact", "sigma", "own"}) slot_names_.emplace_back(name);

    const Names names = names_of(description_, layout_, *graph_);
    Scope kinetic = position_scope(names, "kinetic energy");
    kinetic.forbidden.clear();
    allow(kinetic, names.rates);
    forbid_outputs(kinetic);
    Scope restitution;
    allow(restitution, names.parameters);
    forbid(restitution, names.coordinates, "the coordinate '{}' may not stand in the restitution: parameters alone");
    forbid(restitution, names.rates, "the rate {} may not stand in the restitution: parameters alone");
    forbid_outputs(restitution);

    equations_.kinetic = read(description_.kinetic, kinetic, *graph_);
    equations_.potential = read(description_.potential, position_scope(names, "potential"), *graph_);
    equations_.gap = read(description_.gap, position_scope(names, "gap"), *graph_);
    equations_.restitution = read(description_.restitution, restitution, *graph_);
    try {
        derive_equations();
        compile();
        read_pictures();
    } catch (const TooLarge& problem) {
        throw description_.error(description_.kinetic.at,
                                 fmt::format("the equations of motion are too large: {}", problem.what()));
    }
}

void Model::derive_equations() {
    try {
        read_mass_matrix();
        std::vector<std::uint32_t> q;
        for (std::size_t i = 0; i < layout_.n; ++i) q.push_back(layout_.q(i));
        const std::vector<Expression> slope = gradient(equations_.gap, q);
        if (std::all_of(slope.begin(), slope.end(), [](Expression e) { return e.is_zero(); }))
            throw description_.error(description_.gap.at,
                                     "dh = 0 everywhere: the gap does not change with any coordinate");
        derive(equations_, layout_, *graph_);
    } catch (const std::domain_error& problem) {
        throw description_.error(description_.kinetic.at,
                                 fmt::format("the mass matrix is positive definite nowhere: {}", problem.what()),
                                 "every coordinate needs a positive inertia");
    }
}

// A mistake in a view or a drawing speaks now, not when it is drawn.
void Model::read_pictures() const {
    Graph graph(*graph_);
    const Scope view_names = view_scope(graph);
    for (const ViewDescription& view : description_.views) {
        read(view.x, view_names, graph);
        for (const Text& y : view.y) read(y, view_names, graph);
    }
    Scope names = drawing_scope(graph);
    for (const DrawingDescription& drawing : description_.drawings) {
        if (!drawing.over.empty()) names.allowed.insert_or_assign(drawing.over, graph.symbol(layout_.own()));
        for (const Text& text : texts_of(drawing)) read(text, names, graph);
        names.allowed.erase(drawing.over);
    }
}

Expression Model::read(const Text& text, const Scope& scope, Graph& graph) const {
    try {
        return parse(text.text, scope, graph);
    } catch (const ParseError& error) {
        throw description_.error(place_in(text, error.offset), error.what());
    }
}

void Model::read_mass_matrix() {
    const std::size_t n = layout_.n;
    std::vector<std::uint32_t> rates;
    for (std::size_t i = 0; i < n; ++i) rates.push_back(layout_.v(i));
    Expression offender;
    const auto polynomial = expand_in_rates(equations_.kinetic, rates, offender);
    const std::string wanted = "kinetic energy must be quadratic in the rates, as in m/2*x'^2";
    if (!polynomial)
        throw description_.error(
            description_.kinetic.at,
            fmt::format("the kinetic energy is no polynomial in the rates: {}", to_text(offender, slot_names_)),
            wanted);
    equations_.M.assign(n * n, graph_->number(0));
    for (const auto& [exponents, coefficient] : *polynomial) {
        std::vector<std::size_t> factors;
        Expression term = coefficient;
        for (std::size_t i = 0; i < n; ++i) {
            factors.insert(factors.end(), exponents[i], i);
            term = term * power(graph_->symbol(layout_.v(i)), exponents[i]);
        }
        if (factors.size() != 2)
            throw description_.error(description_.kinetic.at,
                                     fmt::format("the term {} of the kinetic energy is of degree {} in the rates",
                                                 to_text(term, slot_names_), factors.size()),
                                     wanted);
        const std::size_t i = factors[0], j = factors[1];  // T = sum of c_ij v_i v_j over i <= j
        equations_.M[i * n + j] = equations_.M[j * n + i] = i == j ? graph_->number(2) * coefficient : coefficient;
    }
}

void Model::compile() {
    const Equations& e = equations_;
    const Slots slots = layout_.slots();
    const auto program = [&](std::initializer_list<std::vector<Expression>> parts) {
        std::vector<Expression> outputs;
        for (const auto& part : parts) outputs.insert(outputs.end(), part.begin(), part.end());
        return Program(outputs, slots);
    };
    flight_ = program({e.f, {e.hddot}, e.pivots});
    contact_ = program({e.f_c, {e.hddot}, e.pivots, {e.jerk}});
    gap_ = program({{e.gap}});
    normal_ = program({{e.hddot}});
    release_ = program({{e.hddot, e.jerk}});
    surface_ = program({{e.gap, e.hdot}, e.n, e.g, {e.W}});
    bounds_ = program({{e.hddot}, e.n, e.f});
    energy_ = program({{e.energy, e.kinetic, e.potential}});
    force_ = program({{e.lambda}});
    restitution_ = program({{e.restitution}});
    flight_series_ = SeriesProgram(program({e.f, {e.gap}, e.pivots}), layout_.n + 1);
    contact_series_ = SeriesProgram(program({e.f_c, {e.hddot}, e.pivots}), layout_.n + 1);
}

const Bouncing& Model::bouncing() const {
    std::call_once(bouncing_once_, [&] {
        try {
            bouncing_ = std::make_unique<const Bouncing>(derive_bouncing(equations_, layout_));
        } catch (const TooLarge& problem) {
            throw description_.error(description_.kinetic.at,
                                     fmt::format("what proves a truncation is too large: {}", problem.what()));
        }
    });
    return *bouncing_;
}

Run Model::default_run() const {
    Run run;
    run.options = description_.options;
    for (const auto& parameter : description_.parameters) run.parameters.push_back(parameter.value);
    run.q.resize(n());
    run.v.resize(n());
    for (int i = 0; i < n(); ++i) {
        run.q[i] = description_.coordinates[static_cast<std::size_t>(i)].start;
        run.v[i] = description_.coordinates[static_cast<std::size_t>(i)].rate;
    }
    return run;
}

void Model::check(const Run& run) const {
    const auto fail = [&](Location at, const std::string& message) { throw description_.error(at, message); };
    const Options& options = run.options;
    const auto positive = [&](const char* name, double value) {
        if (!(value > 0.0) || !std::isfinite(value))
            fail({}, fmt::format("{} must be a positive number, but it is {}", name, value));
    };
    positive("end_time", options.end_time);
    positive("tolerance", options.tolerance);
    positive("eps_q", options.truncation.eps_q);
    positive("eps_v", options.truncation.eps_v);
    positive("eps_t", options.truncation.eps_t);
    if (options.max_impacts < 1) fail({}, "max_impacts must be at least 1");
    if (options.max_steps < 1) fail({}, "max_steps must be at least 1");
    for (std::size_t i = 0; i < run.parameters.size(); ++i)
        if (!std::isfinite(run.parameters[i]))
            fail(description_.parameters[i].at,
                 fmt::format("the parameter '{}' is not finite", slot_names_[2 * layout_.n + i]));
    for (int i = 0; i < n(); ++i) {
        const auto& coordinate = description_.coordinates[static_cast<std::size_t>(i)];
        if (!std::isfinite(run.q[i]))
            fail(coordinate.start_at, fmt::format("the start of '{}' is not finite", coordinate.name));
        if (!std::isfinite(run.v[i]))
            fail(coordinate.rate_at, fmt::format("the rate of '{}' is not finite", coordinate.name));
    }
    const double e = evaluator(restitution_, run.parameters).output(0);
    if (!(e >= 0.0 && e <= 1.0))
        fail(description_.restitution.at, fmt::format("the restitution must lie in [0, 1], but it is {}", e));
    check_start(run);
}

void Model::check_start(const Run& run) const {
    const State start{run.q, run.v};
    auto flight = evaluator(flight_, run.parameters);
    put(flight, start);
    flight.run();
    for (std::size_t i = 0; i < layout_.n; ++i)
        if (!(flight.output(layout_.n + 1 + i) > 0.0))
            throw description_.error(
                description_.kinetic.at,
                fmt::format("the mass matrix is not positive definite at the start (pivot {} is {})", i + 1,
                            flight.output(layout_.n + 1 + i)),
                "every coordinate needs a positive inertia");
    auto gap = evaluator<Interval>(gap_, run.parameters);
    put(gap, start);
    gap.run();
    const Interval h = gap.output(0);
    if (!h.is_defined())
        throw description_.error(description_.gap.at,
                                 "the gap cannot be evaluated at the start: a function is outside its domain");
    const double error = rad(h);
    if (mid(h) < -4.0 * error)
        throw description_.error(description_.gap.at, fmt::format("the gap is negative at the start: h = {}", mid(h)),
                                 "choose a start with h(q) >= 0");
    if (std::abs(mid(h)) <= 4.0 * error) {
        auto surface = evaluator(surface_, run.parameters);
        put(surface, start);
        surface.run();
        if (!(surface.output(2 + 2 * layout_.n) > 0.0))
            throw description_.error(description_.gap.at,
                                     "dh = 0 at the start, which is in contact: the normal is not defined");
    }
    for (std::size_t i = 0; i <= layout_.n; ++i)
        if (!std::isfinite(flight.output(i)))
            throw description_.error(description_.kinetic.at,
                                     "the acceleration is not finite at the start: a function is outside its domain");
}

Scope Model::view_scope(Graph& graph) const {
    const Names names = names_of(description_, layout_, graph);
    const Expression contact = graph.symbol(layout_.contact());
    Scope scope;
    allow(scope, names.coordinates);
    allow(scope, names.rates);
    allow(scope, names.parameters);
    scope.allowed.emplace("t", graph.symbol(layout_.t()));
    scope.allowed.emplace("gap", graph.adopt(equations_.gap));
    scope.allowed.emplace("gap'", graph.adopt(equations_.hdot));
    scope.allowed.emplace("gap''", (graph.number(1) - contact) * graph.adopt(equations_.hddot));
    scope.allowed.emplace("lambda", contact * graph.adopt(equations_.lambda));
    scope.allowed.emplace("energy", graph.adopt(equations_.energy));
    return scope;
}

Scope Model::drawing_scope(Graph& graph) const {
    return position_scope(names_of(description_, layout_, graph), "drawing");
}

Program Model::compile_view(std::span<const Text> texts) const {
    Graph graph(*graph_);  // a copy: a model is shared between threads and never changes
    const Scope scope = view_scope(graph);
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

Program Model::compile_drawing(std::span<const Text> texts, const std::string& own) const {
    Graph graph(*graph_);
    Scope scope = drawing_scope(graph);
    if (!own.empty()) scope.allowed.insert_or_assign(own, graph.symbol(layout_.own()));
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

}  // namespace achilles
