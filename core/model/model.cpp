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
        if (text.at.line > 0) throw description_.error(place_in(text, error.offset), error.what());
        // It stands in no file: it is shown itself.
        throw InputError({}, place_in({text.text, {0, 1}}, error.offset), error.what(), {}, text.text);
    }
}

void Model::compile() {
    const Equations& e = equations_;
    const Slots slots = layout_.slots();
    const auto program = [&](Expression output) { return Program(std::span(&output, 1), slots); };
    gap_ = program(e.gap);
    normal_acceleration_ = program(e.hddot);
    force_ = program(e.lambda);
    restitution_ = program(e.restitution);
    contact_terms_ = ProgramOf<ContactTerms>::of(slots, e.gap, e.hdot, e.impulse_direction, e.g, e.W, e.gap_t);
    release_terms_ = ProgramOf<ReleaseTerms>::of(slots, e.hddot, e.jerk);
    definition7_terms_ = ProgramOf<Definition7Terms>::of(slots, e.hddot, e.impulse_direction, e.f);
    energy_ = ProgramOf<EnergyTerms>::of(slots, e.energy, e.kinetic, e.potential);
    power_ = ProgramOf<PowerTerms>::of(slots, e.power, e.lambda * e.gap_t);
    start_ = ProgramOf<StartTerms>::of(slots, e.f, e.pivots, e.hddot, e.kinetic, e.potential);
    edges_ = edges_of(equations_, layout_);
    std::vector<Expression> distances;
    for (const Edge& edge : edges_) distances.push_back(edge.event_function);
    if (!edges_.empty()) edge_series_ = SeriesProgram(Program(distances, slots), 0, distances.size());
}

const Motion& Model::motion(ContactSet held) const {
    const std::scoped_lock lock(motions_mutex_);
    const auto known = motions_.find(held);
    if (known != motions_.end()) return known->second;
    const Ground ground;
    return motions_.emplace(held, make_motion(held, equations_, layout_)).first->second;
}

LanePrograms Model::lane_programs() const {
    return {layout_.dof, motion({}).series, motion(ContactSet::of(0)).series, contact_terms_};
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
