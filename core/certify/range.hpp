// The range of an expression over a box, enclosed with the help of its gradient.
#pragma once

#include <vector>

#include "model/derive.hpp"
#include "program/program.hpp"

namespace achilles {

// An expression with its derivatives with respect to some of its inputs; the other inputs are fixed.
class Range {
 public:
    Range() = default;
    // The parameters of `value` and `gradient` must be set. Output i of `gradient` is the derivative by input slots[i].
    // Further outputs may follow; output() reads them.
    Range(Evaluator<Interval> value, Evaluator<Interval> gradient, std::vector<std::uint32_t> slots);

    // Encloses the values over the box (one interval for each of the slots). If the value varies little over the box,
    // this is the mean-value form. Otherwise, variables in which the expression is monotone are set to the ends where
    // the extremes lie. Over the others, the mean-value form and plain evaluation are intersected. Undefined if the
    // expression is not defined on the whole box.
    Interval over(const std::vector<Interval>& box);
    // The enclosure over a part of the last box by the mean-value form, with the slopes over the whole box. It is tight
    // if the part lies near the center.
    Interval over_part(const std::vector<Interval>& part) const;
    // Output i of the gradient program after the derivatives, over the last box.
    const Interval& output(std::size_t i) const { return gradient_.output(slots_.size() + i); }
    // The derivative by variable i over the last box; undefined if it is not defined on the whole box.
    const Interval& slope(std::size_t i) const { return slopes_[i]; }

 private:
    Interval evaluate(const std::vector<Interval>& box);
    Interval bound(const std::vector<Interval>& box, bool upper);

    Evaluator<Interval> value_, gradient_;
    std::vector<std::uint32_t> slots_;
    std::vector<Interval> slopes_;         // the slopes over the box that is bounded
    std::vector<Interval> face_, middle_;  // bound() stores a face of the box and its middle here
    std::vector<Interval> center_;         // the center of the box that is bounded
    Interval at_center_;                   // the value there
};

// The interval of all numbers within `radius` of x.
inline Interval widened(const Interval& x, double radius) { return x + Interval(-radius, radius); }

// The interval of all numbers that rounding could have turned into x, which was computed from terms of this size. A
// certificate holds for all of them. `size` is that of the terms, because s = v - n hdot may cancel.
inline Interval rounding_interval(double x, double size) { return widened(Interval(x), 0x1p-50 * size); }

// A radius larger than `need` by the factor `room`, and positive even if `need` is 0. The added constant is so large
// that products of a few such radii are still normal numbers: arithmetic with subnormal ones takes a hundred times as
// long.
inline double inflated(double need, double room = 1.2) { return room * need + 0x1p-200; }

// Whether `need` is below the radius. If it is not, the radius grows to inflated(need).
inline bool fits(double need, double& radius, double room = 1.2) {
    if (need < radius) return true;
    radius = inflated(need, room);
    return false;
}

}  // namespace achilles
