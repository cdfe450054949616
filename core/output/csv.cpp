#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "number/ground.hpp"
#include "output/output.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

// The shortest form that reads back the same double; empty where it is not finite.
void append(std::string& row, double x) {
    row += ',';
    if (std::isfinite(x)) row += fmt::format("{}", x + 0.0);
}

}  // namespace

std::string to_csv(const Trajectory& trajectory) {
    const Ground ground;
    const Model& model = *trajectory.model;
    const auto n = static_cast<std::size_t>(model.dof());
    std::string text = "t,phase";
    for (std::size_t i = 0; i < 2 * n; ++i) text += "," + model.slot_names()[i];
    text += ",gap,gap rate,lambda,energy,j\n";

    auto contact = model.evaluator(model.contact_terms(), trajectory.run.parameters);
    auto force = model.evaluator(model.force(), trajectory.run.parameters);
    auto energy = model.evaluator(model.energy(), trajectory.run.parameters);
    // Step ends and events; where steps are long, so many instants between them that a plot of the rows is a curve.
    constexpr std::size_t wanted = 1000;
    const auto between = static_cast<int>(wanted / std::max<std::size_t>(1, trajectory.pieces.size()));
    for (const Sample& sample : Sampler(trajectory).all(between)) {
        for (Evaluator<double>* program : std::initializer_list<Evaluator<double>*>{&contact, &force, &energy}) {
            set_state(*program, sample.state);
            program->run();
        }
        text += fmt::format("{},{}", sample.t + 0.0, to_text(sample.phase));
        for (Eigen::Index i = 0; i < model.dof(); ++i) append(text, sample.state.q[i]);
        for (Eigen::Index i = 0; i < model.dof(); ++i) append(text, sample.state.v[i]);
        append(text, contact.h());
        append(text, contact.hdot());
        append(text, sample.contact ? force.output(0) : 0.0);
        append(text, energy.total());
        text += fmt::format(",{}\n", sample.j);
    }
    return text;
}

}  // namespace achilles
