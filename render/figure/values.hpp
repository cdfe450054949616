// A view's quantities along one trajectory.
#pragma once

#include <span>

#include "figure/compose.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {

// Evaluates all of a view's quantities at a sample, x first, in the units they are shown in. Refers to view and trajectory.
class Values {
 public:
    Values(const PreparedView& view, const Trajectory& trajectory)
        : evaluator_(trajectory.model->evaluator(view.program(), trajectory.run.parameters)),
          quantities_(view.quantities()),
          forces_(*trajectory.model, trajectory.run.parameters) {}
    void set(const Sample& sample) { forces_.run_view(evaluator_, sample); }
    double operator[](std::size_t i) const { return evaluator_.output(i) * quantities_[i].factor; }

 private:
    Evaluator<double> evaluator_;
    std::span<const PreparedView::Quantity> quantities_;
    ContactForces forces_;
};

}  // namespace achilles
