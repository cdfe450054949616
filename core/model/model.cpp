#include "model/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "model/mistakes.hpp"
#include "model/read_expressions.hpp"
#include "number/ground.hpp"

namespace achilles {

Model::Model(SystemDescription description) : description_(std::move(description)), graph_(std::make_unique<Graph>()) {
    layout_ = {static_cast<std::uint32_t>(description_.coordinates.size()),
               static_cast<std::uint32_t>(description_.parameters.size())};
    slot_names_ = achilles::slot_names(description_, layout_);
    const Ground ground;  // constants become intervals, too
    Mistakes mistakes;
    Names names;
    read_equations(description_, layout_, *graph_, names, equations_, mistakes);
    mistakes.raise(description_);
    try {
        derive(equations_, layout_, *graph_);
        compile();
    } catch (const TooLarge& problem) {
        throw description_.error(description_.kinetic.at,
                                 fmt::format("the equations of motion are too large: {}", problem.what()));
    } catch (const std::domain_error& problem) {
        throw description_.error(description_.kinetic.at,
                                 fmt::format("the mass matrix is positive definite nowhere: {}", problem.what()),
                                 "every coordinate needs a positive inertia");
    }
}

Expression Model::read(const Text& text, const Scope& scope, Graph& graph) const {
    try {
        return parse(text.text, scope, graph);
    } catch (const ParseError& error) {
        throw description_.error(place_in(text, error.offset), error.what());
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
    // Two ways to say the same; one takes fewer products.
    contact_series_ = SeriesProgram(program({e.f_c, {e.hddot}, e.pivots}), layout_.n + 1);
    SeriesProgram by_force(program({e.f_by_force, {e.hddot}, e.pivots}), layout_.n + 1);
    if (by_force.inner_sums() < contact_series_.inner_sums()) contact_series_ = std::move(by_force);
}

const Bouncing& Model::bouncing() const {
    std::call_once(bouncing_once_, [&] {
        const Ground ground;
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
    const Ground ground;
    Mistakes mistakes;
    const auto refuse = [&](Location at, const std::string& message) { mistakes.add({at, message, {}}); };
    const Options& options = run.options;
    const auto positive = [&](const char* name, double value) {
        if (!(value > 0.0) || !std::isfinite(value))
            refuse({}, fmt::format("{} must be a positive number, but it is {}", name, value));
    };
    positive("end_time", options.end_time);
    positive("tolerance", options.tolerance);
    positive("eps_q", options.truncation.eps_q);
    positive("eps_v", options.truncation.eps_v);
    positive("eps_t", options.truncation.eps_t);
    if (options.max_impacts < 1) refuse({}, "max_impacts must be at least 1");
    if (options.max_steps < 1) refuse({}, "max_steps must be at least 1");
    const std::size_t before = mistakes.count();
    for (std::size_t i = 0; i < run.parameters.size(); ++i)
        if (!std::isfinite(run.parameters[i]))
            refuse(description_.parameters[i].at,
                   fmt::format("the parameter '{}' is not finite", description_.parameters[i].name));
    for (int i = 0; i < n(); ++i) {
        const auto& coordinate = description_.coordinates[static_cast<std::size_t>(i)];
        if (!std::isfinite(run.q[i]))
            refuse(coordinate.start_at, fmt::format("the start of '{}' is not finite", coordinate.name));
        if (!std::isfinite(run.v[i]))
            refuse(coordinate.rate_at, fmt::format("the rate of '{}' is not finite", coordinate.name));
    }
    if (mistakes.count() == before) {
        mistakes.attempt([&] { check_restitution(run); });
        mistakes.attempt([&] { check_gap(run); });
        mistakes.attempt([&] { check_acceleration(run); });
    }
    mistakes.raise(description_);
}

void Model::check_restitution(const Run& run) const {
    const double e = evaluator(restitution_, run.parameters).output(0);
    if (!(e >= 0.0 && e <= 1.0))
        throw Mistake{description_.restitution.at, fmt::format("the restitution must lie in [0, 1], but it is {}", e),
                      "0 is plastic, 1 is elastic"};
}

// The gap is not clearly negative, and where there is contact there is a normal.
void Model::check_gap(const Run& run) const {
    const State start{run.q, run.v};
    auto gap = evaluator<Interval>(gap_, run.parameters);
    put(gap, start);
    gap.run();
    const Interval h = gap.output(0);
    if (!h.is_defined())
        throw Mistake{
            description_.gap.at, "the gap cannot be evaluated at the start: a function is outside its domain", {}};
    const double error = rad(h);
    if (mid(h) < -4.0 * error)
        throw Mistake{description_.gap.at, fmt::format("the gap is negative at the start: h = {}", mid(h)),
                      "choose a start with h(q) >= 0"};
    if (std::abs(mid(h)) > 4.0 * error) return;
    auto surface = evaluator(surface_, run.parameters);
    put(surface, start);
    surface.run();
    bool is_flat = true;
    for (std::size_t i = 0; i < layout_.n; ++i) is_flat = is_flat && surface.output(2 + layout_.n + i) == 0.0;
    if (is_flat)
        throw Mistake{description_.gap.at, "dh = 0 at the start, which is in contact: the normal is not defined", {}};
}

// M is positive definite, and the equations of motion have a value.
void Model::check_acceleration(const Run& run) const {
    auto flight = evaluator(flight_, run.parameters);
    put(flight, State{run.q, run.v});
    flight.run();
    for (std::size_t i = 0; i < layout_.n; ++i) {
        const double pivot = flight.output(layout_.n + 1 + i);
        if (pivot > 0.0) continue;
        throw Mistake{description_.kinetic.at,
                      fmt::format("the mass matrix is not positive definite at the start (the pivot of '{}' is {})",
                                  description_.coordinates[i].name, pivot),
                      "every coordinate needs a positive inertia"};
    }
    for (std::size_t i = 0; i <= layout_.n; ++i)
        if (!std::isfinite(flight.output(i)))
            throw Mistake{description_.kinetic.at,
                          "the acceleration is not finite at the start: a function is outside its domain",
                          {}};
}

Program Model::compile_view(std::span<const Text> texts) const {
    Graph graph(*graph_);  // a copy: a model is shared between threads and never changes
    const Scope scope = view_scope(description_, layout_, graph, equations_);
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

Program Model::compile_drawing(std::span<const Text> texts, const std::string& own) const {
    Graph graph(*graph_);
    Scope scope = drawing_scope(description_, layout_, graph);
    if (!own.empty()) scope.allowed.insert_or_assign(own, graph.symbol(layout_.own()));
    std::vector<Expression> outputs;
    for (const Text& text : texts) outputs.push_back(read(text, scope, graph));
    return Program(outputs, layout_.slots());
}

}  // namespace achilles
