// The Taylor coefficients of one motion at a state, to an order that is asked for: what a run's steps are made of, and the terms
// that they leave out.
#pragma once

#include <span>
#include <vector>

#include "model/model.hpp"
#include "series/evaluator.hpp"

namespace achilles {

class MotionSeries {
 public:
    static constexpr int highest_order = SeriesEvaluator<double>::highest_order;

    // Of the motion that holds these contacts.
    MotionSeries(const Model& model, ContactSet held, std::span<const double> parameters);

    // Expands at a state; 1 <= order <= highest_order.
    void expand(const State& state, int order);
    // Of the last expansion: coefficient k of q and v, then of each contact's event function, its gap where it is open (from
    // k = 2 on), hddot where it is held.
    double coefficient(int k, std::size_t i) const { return rows_[static_cast<std::size_t>(k) * width_ + i]; }
    // The highest order up to which all coefficients are numbers: a function may overflow, as cosh(x)^2 does, in the terms of a
    // series alone.
    int finite_order() const;
    // The sum of the terms of orders first .. last after a time.
    double sum(int first, int last, std::size_t i, double span) const;

 private:
    std::size_t dof_, width_;
    int order_ = 0;  // of the last expansion
    SeriesEvaluator<double> series_;
    std::vector<double> rows_;
};

}  // namespace achilles
