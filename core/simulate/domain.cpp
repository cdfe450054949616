#include "simulate/domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/undefined.hpp"

namespace achilles {

namespace {

using Values = std::vector<Interval>;  // q, v, t

// The first undefined part of some expressions over a box, named with the value of its operand at the state; or "".
std::string undefined_among(const Model& model, const Run& run, std::span<const Expression> expressions,
                            const State& state, const Values& box, const char* name) {
    const auto found = first_undefined(model, run.parameters, expressions, state, box);
    if (!found) return "";
    return fmt::format("{} in {} becomes undefined, with {} = {:.3g}", found->part, name, found->operand, found->value);
}

// The first function that may come to its edge in the box, where it has a value and is not smooth; or "".
std::string first_edge(const Model& model, const Run& run, const State& state, const Values& box) {
    for (const Edge& edge : model.edges()) {
        if (edge.kind != Edge::Kind::edge) continue;
        const Program program(std::span(&edge.event_function, 1), model.layout().slots());
        auto distance = model.evaluator<Interval>(program, run.parameters);
        set_box(distance, box);
        distance.run();
        if (certainly_positive(distance.output(0))) continue;
        return fmt::format("{} in {} reaches a point where it is not smooth, with {} = {:.3g}",
                           shortened(model, edge.function), edge.place, shortened(model, edge.argument),
                           value_at(model, run.parameters, edge.argument, state));
    }
    return "";
}

// The first pivot of M that is not positive all over the box, with its value at the state; or "".
std::string first_bad_pivot(const Model& model, const Run& run, const State& state, const Values& box) {
    const Program program(model.equations().pivots, model.layout().slots());
    auto enclosure = model.evaluator<Interval>(program, run.parameters);
    auto value = model.evaluator(program, run.parameters);
    set_box(enclosure, box);
    enclosure.run();
    set_state(value, state);
    value.run();
    for (std::size_t i = 0; i < program.output_count(); ++i) {
        const Interval pivot = enclosure.output(i);
        if (!pivot.is_defined() || certainly_positive(pivot)) continue;
        return fmt::format("the mass matrix is no longer positive definite: the pivot of '{}' is {:.3g}",
                           model.description().coordinates[i].name, value.output(i));
    }
    return "";
}

// What the user wrote comes first: a derivative of log(x) is 1/x, which is no help.
std::string undefined_in(const Model& model, const Run& run, const State& state, const Values& box) {
    const Equations& e = model.equations();
    const auto look = [&](const std::vector<Expression>& expressions, const char* name) {
        return undefined_among(model, run, expressions, state, box, name);
    };
    std::string found = look({e.kinetic}, "the kinetic energy");
    if (found.empty()) found = look({e.potential}, "the potential");
    if (found.empty()) found = look(e.gaps, "the gap");
    if (found.empty()) found = look(e.Q, "the forces");
    if (found.empty()) found = first_edge(model, run, state, box);
    if (found.empty()) found = first_bad_pivot(model, run, state, box);
    if (found.empty()) found = look(e.free.f, "the equations of motion");
    return found;
}

}  // namespace

std::string edge_of_domain(const Model& model, const Run& run, const State& state) {
    const double scale = std::max(1e-3, std::abs(state.t));
    for (const double reach : {1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9}) {
        Values box = box_of(state);
        for (Eigen::Index i = 0; i < state.q.size(); ++i) {
            const double ahead = state.q[i] + reach * scale * state.v[i];
            box[static_cast<std::size_t>(i)] = hull(Interval(state.q[i]), Interval(ahead));
        }
        box.back() = Interval(state.t, state.t + reach * scale);
        const std::string found = undefined_in(model, run, state, box);
        if (!found.empty()) return found;
    }
    return "";
}

std::string edge_of_contact(const Model& model, const Run& run, const State& state) {
    return undefined_in(model, run, state, box_of(state));
}

}  // namespace achilles
