// Taylor coefficients of a motion over any number type, row by row: double as in runs, intervals for proofs, eight lanes
// for derivatives in eight directions.
#pragma once

#include <algorithm>
#include <memory>
#include <span>

#include "series/evaluator.hpp"

namespace achilles {

template <class Number>
class SeriesOver {
 public:
    static constexpr int highest_order = SeriesEvaluator<Number>::highest_order;

    // Call fix() before use. The program must outlive this object. Over lanes, its code follows (LaneCode).
    template <class... Code>
    explicit SeriesOver(const SeriesProgram& program, const Code&... code)
        : dof_(LaneAccess::plan_of(program).coordinates()),
          events_(program.events()),
          width_(2 * dof_ + events_),
          series_(program, code...),
          rows_(std::make_unique_for_overwrite<Number[]>(width_ * (highest_order + 2))) {}

    // Evaluates what depends on parameters only.
    void fix(std::span<const Number> parameters) { series_.fix(parameters); }

    // Computes orders 0 .. last of the event functions and 0 .. last + 1 of the state, from (q, v) and the time (s); 1
    // <= last <= highest_order.
    void expand(const Number* state, const Number& time, int last) {
        begin(state, time);
        extend(1, last);
        Number* const next = row(last + 1);
        const Number inverse = Number(1.0) / Number(static_cast<double>(last + 1));
        for (std::size_t i = 0; i < dof_; ++i) {
            next[i] = inverse * row(last)[dof_ + i];
            next[dof_ + i] = inverse * series_.output(i);
        }
    }
    // The same in steps: begin() computes order 0 of all components and order 1 of the state; extend() computes orders
    // k .. last of all, k >= 1, and requires all lower orders. Over lanes, the first call makes order 4 or more.
    void begin(const Number* state, const Number& time) {
        std::copy_n(state, 2 * dof_, row(0));
        series_.begin(row(0), time);
        for (std::size_t i = 0; i < events_; ++i) row(0)[2 * dof_ + i] = start(dof_ + i);
        for (std::size_t i = 0; i < dof_; ++i) {
            row(1)[i] = state[dof_ + i];
            row(1)[dof_ + i] = start(i);
        }
    }
    void extend(int k, int last) { series_.extend(row(k), k, last); }

    // Order k of component i: q and v, then the event functions.
    const Number& coefficient(int k, std::size_t i) const { return rows_[static_cast<std::size_t>(k) * width_ + i]; }
    // Order 0 of an output: accelerations, event functions, then any others.
    const Number& start(std::size_t index) { return series_.start(index); }

 private:
    Number* row(int k) { return rows_.get() + static_cast<std::size_t>(k) * width_; }

    std::size_t dof_, events_, width_;
    SeriesEvaluator<Number> series_;
    std::unique_ptr<Number[]> rows_;
};

}  // namespace achilles
