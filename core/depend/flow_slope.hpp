// The derivatives of one smooth motion after a time by the state where it starts, the parameters and the start's time: the Taylor
// series of runs, and what these rise by (theory-derivatives.md 2).
#pragma once

#include <memory>

#include "depend/tangent.hpp"
#include "model/model.hpp"

namespace achilles {

class FlowSlope {
 public:
    virtual ~FlowSlope() = default;

    // Expands at a state to at least this order, and so far that of the sum after `length` (s), values and derivatives, the last
    // term is below the tolerance and the one before nearly; or after as much of it as is returned.
    virtual double expand(const State& state, double length, int least_order) = 0;
    // Of the last expansion.
    virtual int order() const = 0;
    // Coefficient k of q and v, then of the gap of each open contact (from k = 2 on).
    virtual double coefficient(int k, std::size_t i) const = 0;
    // The rows of q, v, and of the open contacts' h and u after a time, whatever the others are.
    virtual void slope_after(double span, ContactSet held, RowMatrix& S) = 0;
};

// Of the motion that holds these contacts; by those parameters that may vary, or, if that is empty, by all.
std::unique_ptr<FlowSlope> make_flow_slope(const Model& model, ContactSet held, const Tangent& tangent,
                                           std::span<const double> parameters, const std::vector<bool>& varied,
                                           double tolerance);

}  // namespace achilles
