// A view's quantities along one trajectory.
#pragma once

#include <span>
#include <vector>

#include "figure/compose.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {

// Evaluates all of a view's quantities at a sample, x first, in the units they are shown in. Refers to view and trajectory.
class Values {
 public:
    Values(const PreparedView& view, const Trajectory& trajectory)
        : evaluator_(trajectory.model->evaluator(view.program(), trajectory.run.parameters)),
          reads_(view.program().inputs_of(view.program().output_count())),
          quantities_(view.quantities()),
          forces_(*trajectory.model, trajectory.run.parameters) {}
    void set(const Sample& sample) { forces_.run_view(evaluator_, sample, reads_); }
    double operator[](std::size_t i) const { return evaluator_.output(i) * quantities_[i].factor; }
    // Whether a quantity depends on an input (model/derive.hpp).
    bool reads(std::size_t slot) const { return reads_[slot]; }

 private:
    Evaluator<double> evaluator_;
    std::vector<bool> reads_;  // by slot
    std::span<const PreparedView::Quantity> quantities_;
    ContactForces forces_;
};

}  // namespace achilles
