// Model::check(): whether a run can start.
#include <fmt/format.h>

#include <cmath>

#include "model/degenerate_gap.hpp"
#include "model/model.hpp"
#include "model/scopes.hpp"
#include "model/undefined_term.hpp"
#include "number/float_environment.hpp"
#include "system/input_error.hpp"

namespace achilles {

void Model::check(const Run& run) const {
    const auto n = static_cast<Eigen::Index>(dof());
    const std::size_t p = description_.parameters.size();
    if (run.q.size() != n || run.v.size() != n || run.parameters.size() != p)
        throw InputError(
            "the run", {},
            fmt::format(
                "it has {} coordinates, {} rates and {} parameters; the system has {} coordinates and {} parameters",
                run.q.size(), run.v.size(), run.parameters.size(), n, p),
            "start from default_run() of this system");
    const FloatEnvironmentGuard ground;
    ErrorCollector mistakes;
    const auto refuse = [&](Location at, const std::string& message, const std::string& hint = {}) {
        mistakes.add({at, message, hint});
    };
    for (const std::string& fault : validation_errors(run.options)) refuse({}, fault);
    const auto is_euclidean = [](const Options& options) {
        return options.truncation.reinitialization == Reinitialization::euclidean;
    };
    if (description_.has_friction() && is_euclidean(run.options))
        refuse(is_euclidean(description_.options) ? description_.reinitialization_at : Location{},
               "the euclidean reinitialization cannot be used with friction", "use the default, kinetic");
    if (description_.has_friction() && run.options.truncation.conditions == Conditions::paper)
        refuse({}, "the conditions of the paper cannot be used with friction", "use the default, sharp");
    const std::size_t before = mistakes.count();
    for (std::size_t i = 0; i < run.parameters.size(); ++i) {
        const auto& parameter = description_.parameters[i];
        if (!std::isfinite(run.parameters[i]))
            refuse(parameter.at, fmt::format("the parameter '{}' is not finite", parameter.name));
        if (is_subnormal(run.parameters[i]))
            refuse(parameter.at, subnormal_parameter(parameter.name, run.parameters[i]), subnormal_hint);
    }
    const std::vector<double> derived = derived_values(*this, run.parameters);
    const bool have_values = mistakes.count() == before;  // the values of the parameters that they depend on
    for (std::size_t i = 0; i < derived.size(); ++i)
        if (have_values && !std::isfinite(derived[i]))
            refuse(description_.derived[i].definition.at,
                   fmt::format("the derived parameter '{}' is not finite", description_.derived[i].name));
    for (int i = 0; i < dof(); ++i) {
        const auto& coordinate = description_.coordinates[static_cast<std::size_t>(i)];
        if (!std::isfinite(run.q[i]))
            refuse(coordinate.start_at, fmt::format("the start of '{}' is not finite", coordinate.name));
        if (!std::isfinite(run.v[i]))
            refuse(coordinate.rate_at, fmt::format("the rate of '{}' is not finite", coordinate.name));
    }
    if (mistakes.count() == before) {
        auto start = evaluator(start_, run.parameters);
        set_state(start, run.start());
        start.run();
        for (std::size_t i = 0; i < contacts(); ++i)
            if (auto mistake = mistake_in(description_.constraints[i].restitution, restitution(run.parameters, i)))
                mistakes.add(std::move(*mistake));
        // A quantity that depends on an undefined energy or gap is undefined as well; only the cause is reported.
        const bool has_energies = mistakes.attempt([&] { check_energies(run, start); });
        bool has_gap = true;
        for (std::size_t i = 0; i < contacts(); ++i) has_gap = mistakes.attempt([&] { check_gap(run, i); }) && has_gap;
        for (const SlidingPlace& place : sliding_places(description_))
            mistakes.attempt([&] { check_friction(run, place); });
        const bool has_mass = has_energies && mistakes.attempt([&] { check_mass(start); });
        if (has_mass && has_gap) mistakes.attempt([&] { check_acceleration(run, start); });
    }
    mistakes.raise(description_);
}

namespace {

// Where the part of a text stands that is undefined at the start of a run, or has an undefined slope. A text that the
// reader made from several tables has a place for each.
Location place_of_undefined(const Model& model, const Run& run, const Text& text) {
    if (text.pieces.empty()) return text.at;
    const Layout& layout = model.layout();
    Graph graph;
    const Scope scope = force_scope(model.description(), layout, graph);
    std::vector<double> values;
    for (const Vector* part : {&run.q, &run.v}) values.insert(values.end(), part->begin(), part->end());
    values.insert(values.end(), run.parameters.begin(), run.parameters.end());
    values.push_back(run.options.start_time);
    std::vector<std::uint32_t> q;
    for (std::size_t i = 0; i < layout.dof; ++i) q.push_back(layout.q(i));
    for (std::size_t i = 0; i < text.pieces.size(); ++i) {
        const TextPiece& piece = text.pieces[i];
        if (piece.is_written) continue;
        const std::size_t end = i + 1 < text.pieces.size() ? text.pieces[i + 1].begin : text.text.size();
        std::string part = text.text.substr(piece.begin, end - piece.begin);
        part.erase(part.find_last_not_of(" +-") + 1);
        try {
            const Expression whole = parse(part, scope, graph);
            std::vector<Expression> all = gradient(whole, q);
            all.push_back(whole);
            for (const Expression each : all)
                if (!std::isfinite(value_of(each, values))) return piece.at;
        } catch (const ParseError&) {  // a part of a product
        }
    }
    return text.at;
}

}  // namespace

// Checks that T and V have finite values.
void Model::check_energies(const Run& run, const StartTerms<Evaluator<double>>& start) const {
    if (!std::isfinite(start.kinetic()))
        throw no_value(*this, run, description_.kinetic.at, "the kinetic energy", {&equations_.given.kinetic, 1});
    if (!std::isfinite(start.potential()))
        throw no_value(*this, run, place_of_undefined(*this, run, description_.potential), "the potential",
                       {&equations_.given.potential, 1});
}

// Checks that the gap is defined and not clearly negative, and that a closed contact has a normal.
void Model::check_gap(const Run& run, std::size_t contact) const {
    const Location at = description_.constraints[contact].gap.at;
    const State start = run.start();
    auto gap = evaluator<Interval>(this->gap(contact), run.parameters);
    set_state(gap, start);
    gap.run();
    const Interval h = gap.output(0);
    const double error = rad(h);
    if (!std::isfinite(error)) throw no_value(*this, run, at, "the gap", {&equations_.gaps[contact], 1});
    if (mid(h) < -4.0 * error) {
        if (is_conditional(contact)) return;  // it does not count until the gap has risen
        const Run file = default_run();
        const bool is_of_file = run.q == file.q && run.parameters == file.parameters;  // otherwise its sign was right
        const auto& shapes = description_.mechanism.contacts;
        if (contact < shapes.size() && !shapes[contact].behind.empty())
            throw Mistake{at, fmt::format(fmt::runtime(shapes[contact].behind), -mid(h)), shapes[contact].hint};
        throw Mistake{
            at, fmt::format("the gap is negative at the start: h = {}", mid(h)),
            fmt::format("choose a start with h(q) >= 0{}",
                        is_of_file ? ", or reverse its sign: the gap is positive where the system is free" : "")};
    }
    if (std::abs(mid(h)) > 4.0 * error) return;
    auto terms = evaluator(programs_of(contact).contact_terms, run.parameters);
    set_state(terms, start);
    terms.run();
    double slope = 0.0;
    for (std::size_t i = 0; i < layout_.dof; ++i) slope += terms.gradient(i) * terms.gradient(i);
    constexpr double steep = 1e-6;  // below it, is_flat() decides whether the gap is flat or 0 within rounding
    if (slope < steep && is_flat(*this, run.parameters, start, contact))
        throw Mistake{at, "the start is in contact, and dh = 0 there: the normal is not defined", flat_hint};
}

// Checks that M is positive definite.
void Model::check_mass(const StartTerms<Evaluator<double>>& start) const {
    for (std::size_t i = 0; i < layout_.dof; ++i) {
        const double pivot = start.pivot(i);
        if (pivot > 0.0) continue;
        const bool has_bodies = !description_.mechanism.bodies.empty();  // T is then not in the file
        throw Mistake{has_bodies ? description_.coordinates[i].at : description_.kinetic.at,
                      fmt::format("the mass matrix is not positive definite at the start (the pivot of '{}' is {})",
                                  description_.coordinates[i].name, pivot),
                      "every coordinate needs a positive inertia"};
    }
}

// Checks that the acceleration is finite. If it is not, the error names the cause: a force, or a derivative of V, h
// or T.
void Model::check_acceleration(const Run& run, const StartTerms<Evaluator<double>>& start) const {
    bool finite = std::isfinite(start.hddot(0));
    for (std::size_t i = 0; i < layout_.dof; ++i) finite = finite && std::isfinite(start.acceleration(i));
    if (finite) return;
    Graph graph(*graph_);  // a copy, because threads share the model
    std::vector<std::uint32_t> q;
    for (std::size_t i = 0; i < layout_.dof; ++i) q.push_back(layout_.q(i));
    const auto blame = [&](const Text& text, const char* what, const std::vector<Expression>& parts) {
        const Program program(parts, layout_.slots());
        auto value = evaluator(program, run.parameters);
        set_state(value, run.start());
        value.run();
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (!std::isfinite(value.output(i)))
                throw no_value(*this, run, place_of_undefined(*this, run, text), what, parts);
    };
    for (std::size_t i = 0; i < description_.coordinates.size(); ++i)
        if (!description_.coordinates[i].force.text.empty())
            blame(description_.coordinates[i].force, "the force", {graph.adopt(equations_.given.Q[i])});
    blame(description_.potential, "a derivative of the potential", gradient(graph.adopt(equations_.potential), q));
    for (std::size_t i = 0; i < contacts(); ++i) {
        std::vector<Expression> of_gap = gradient(graph.adopt(equations_.gaps[i]), q);
        for (const auto& row : jacobian(of_gap, q)) of_gap.insert(of_gap.end(), row.begin(), row.end());
        blame(description_.constraints[i].gap, "a derivative of the gap", of_gap);
    }
    throw no_value(*this, run, description_.kinetic.at, "the acceleration", equations_.free.f);
}

}  // namespace achilles
