// Values and derivatives of user-defined quantities of a run: expressions over its events and its state at the end or
// at an event.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "sensitivity/derivatives.hpp"

namespace achilles {

struct Quantity {
    std::string expression;       // as typed
    double value = 0.0;           // NaN if it does not exist
    Eigen::VectorXd derivatives;  // by direction, at the end time; NaN if there are none
    std::string refused;          // the reason if there are no derivatives; else empty
};

// The derivatives of a run and of quantities of it.
struct Dependence {
    Derivatives derivatives;
    std::vector<Quantity> quantities;
};

// Compiled expressions. They may contain the names of a view (t, coordinates, rates, parameters, gaps, lambda, energy,
// power, work, loss) at the end. Of events they may contain zeno_time(k), impact_time(k), impact_speed(k) and
// release_time(k), with k from 1, or the last one without an argument. work, loss and least_gap have no derivatives.
class Quantities {
 public:
    // Throws InputError with the place in the expression and the name of the option.
    Quantities(std::shared_ptr<const Model> model, std::vector<std::string> expressions, const char* option = "--of");
    // Evaluates the quantities of a run of this model, with the result of differentiate().
    std::vector<Quantity> of(const Trajectory& trajectory, const Derivatives& derivatives) const;
    // The same at an event: the events until then, and the state after it, whose derivatives follow the event in time.
    // `load_bearing` are the load-bearing contacts after the event.
    std::vector<Quantity> at(const Trajectory& trajectory, const Derivatives& derivatives, std::size_t event,
                             ContactSet load_bearing) const;

 private:
    struct EvaluationPoint;
    class Inputs;
    std::vector<Quantity> evaluated(const Inputs& inputs, const Derivatives& derivatives) const;
    std::shared_ptr<const Model> model_;
    std::vector<std::string> expressions_;
    Model::MeasureProgram measures_;
};

}  // namespace achilles
