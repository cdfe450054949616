// Any quantity of a run, and on what it depends: an expression over its end, or an event of it, and its events.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depend/derivatives.hpp"
#include "model/model.hpp"

namespace achilles {

struct Quantity {
    std::string expression;       // as typed
    double value = 0.0;           // not a number where it does not exist
    Eigen::VectorXd derivatives;  // by direction, at the end time; no numbers where there are none
    std::string refused;          // why there are none at all; else empty
};

// On what a run depends: all that is told about it.
struct Dependence {
    Derivatives derivatives;
    std::vector<Quantity> quantities;
};

// Expressions, compiled: those of a view (t, coordinates, rates, parameters, gaps, lambda, energy, power, work, loss) at the end,
// and zeno_time(k), impact_time(k), impact_speed(k), release_time(k) with k from 1, or the last one without it. Of work, loss and
// least_gap there are no derivatives.
class Quantities {
 public:
    // Throws InputError with the place in the expression, and the option that it stands behind.
    Quantities(std::shared_ptr<const Model> model, std::vector<std::string> expressions, const char* option = "--of");
    // Of a run of that model, and what differentiate() says of it.
    std::vector<Quantity> of(const Trajectory& trajectory, const Derivatives& derivatives) const;
    // The same at an event, where `carriers` are the contacts that bear the motion after it: what has happened until then, and the
    // state after it, whose derivatives follow the event as it moves in time.
    std::vector<Quantity> at(const Trajectory& trajectory, const Derivatives& derivatives, std::size_t event,
                             ContactSet carriers) const;

 private:
    struct Place;
    class Inputs;
    std::vector<Quantity> evaluated(const Inputs& inputs, const Derivatives& derivatives) const;
    std::shared_ptr<const Model> model_;
    std::vector<std::string> expressions_;
    Model::MeasureProgram measures_;
};

}  // namespace achilles
