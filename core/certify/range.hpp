// The range of one expression over a box, enclosed as tightly as its gradient allows.
#pragma once

#include <vector>

#include "model/derive.hpp"
#include "program/program.hpp"

namespace achilles {

// An evaluated expression with its derivatives with respect to some of its inputs; the other inputs stay fixed.
class Range {
 public:
    Range() = default;
    // `value` and `gradient` are prepared with the parameters; gradient output i is the derivative by input slots[i].
    // More outputs may follow, to be read by output().
    Range(Evaluator<Interval> value, Evaluator<Interval> gradient, std::vector<std::uint32_t> slots);

    // Contains the value at every point of the box (one interval for each of the slots). Over a box on which the value
    // hardly changes this is the mean-value form. Else, where the derivative by a variable keeps its sign, the extremes
    // lie at that variable's ends; the rest is bounded by the mean-value form, and never worse than by plain
    // evaluation. Undefined where the expression is not defined on the whole box.
    Interval over(const std::vector<Interval>& box);
    // The same over a part of the box that was looked at last, by the slopes over the whole of it: tight where it lies
    // near the middle.
    Interval over_part(const std::vector<Interval>& part) const;
    // Output i of the gradient's program after the derivatives, over that box.
    const Interval& output(std::size_t i) const { return gradient_.output(slots_.size() + i); }
    // The derivative by variable i over the box that was looked at last; undefined where it is not defined all over it.
    const Interval& slope(std::size_t i) const { return slopes_[i]; }

 private:
    Interval evaluate(const std::vector<Interval>& box);
    Interval bound(const std::vector<Interval>& box, bool upper);

    Evaluator<Interval> value_, gradient_;
    std::vector<std::uint32_t> slots_;
    std::vector<Interval> slopes_, rest_, middle_, centre_;  // of the box that is looked at
    Interval at_centre_;                                     // the value there
};

// The interval of all numbers within `radius` of x.
inline Interval widened(const Interval& x, double radius) { return x + Interval(-radius, radius); }

// A number computed from terms of this size stands for every number that rounding could have made it from; a
// certificate holds for all of them. The size is that of the terms: s = v - n hdot may cancel.
inline Interval rounding_interval(double x, double size) { return widened(Interval(x), 0x1p-50 * size); }

// A radius larger than `need` by the factor `room`, and positive even if nothing was needed. Its minimum is so large that
// products of a few such radii are still normal numbers: arithmetic with denormal ones takes a hundred times as long.
inline double inflated(double need, double room = 1.2) { return room * need + 0x1p-200; }

// Whether `need` is inside a radius. Where it is not, the radius grows to it, with some room.
inline bool fits(double need, double& radius, double room = 1.2) {
    if (need < radius) return true;
    radius = inflated(need, room);
    return false;
}

}  // namespace achilles
