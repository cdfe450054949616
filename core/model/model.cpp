#include "model/model.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "model/read_expressions.hpp"
#include "number/ground.hpp"
#include "system/mistakes.hpp"

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
    normal_acceleration_ = program({{e.hddot}});
    release_ = program({{e.hddot, e.jerk}});
    surface_ = program({{e.gap, e.hdot}, e.impulse_direction, e.g, {e.W}});
    definition7_terms_ = program({{e.hddot}, e.impulse_direction, e.f});
    energy_ = program({{e.energy, e.kinetic, e.potential}});
    force_ = program({{e.lambda}});
    restitution_ = program({{e.restitution}});
    start_ = program({e.f, {e.hddot}, e.pivots, {e.kinetic, e.potential}});
    flight_series_ = SeriesProgram(program({e.f, {e.gap}, e.pivots}), layout_.dof + 1);
    // Two ways to say the same; one takes fewer products.
    contact_series_ = SeriesProgram(program({e.f_c, {e.hddot}, e.pivots}), layout_.dof + 1);
    SeriesProgram by_force(program({e.f_by_force, {e.hddot}, e.pivots}), layout_.dof + 1);
    if (by_force.inner_sums() < contact_series_.inner_sums()) contact_series_ = std::move(by_force);
    edges_ = edges_of(equations_, layout_);
    std::vector<Expression> distances;
    for (const Edge& edge : edges_) distances.push_back(edge.event_function);
    if (!edges_.empty()) edge_series_ = SeriesProgram(Program(distances, slots), distances.size());
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
    run.q.resize(dof());
    run.v.resize(dof());
    for (int i = 0; i < dof(); ++i) {
        run.q[i] = description_.coordinates[static_cast<std::size_t>(i)].start;
        run.v[i] = description_.coordinates[static_cast<std::size_t>(i)].rate;
    }
    return run;
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
