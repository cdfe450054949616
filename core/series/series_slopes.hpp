// The Taylor coefficients of a motion, and what they rise by where the start or a parameter does: the values by the code that runs
// have, then the linear recurrences of slope_plan.hpp over them, eight directions as one vector.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "number/jet.hpp"
#include "series/evaluator.hpp"
#include "series/lane_kinds.hpp"
#include "series/slope_plan.hpp"

namespace achilles {

class SeriesSlopes {
 public:
    static constexpr int highest_order = static_cast<int>(SlopeTables::orders) - 1;
    static constexpr std::size_t directions = Eight::count;  // of a group

    // By these inputs of the program: q, v, parameters, the time.
    SeriesSlopes(const SeriesProgram& program, std::span<const double> parameters,
                 std::span<const std::uint32_t> variables);

    // Order 0 of all, at a state of q and v and a time; then those from 1 on, one after the other.
    void begin(const double* q_and_v, double time);
    void extend(int k);

    std::size_t groups() const { return groups_.size(); }
    // Of order k: q and v, then the event functions (of these from order 2 on).
    double value(int k, std::size_t i) const { return rows_[static_cast<std::size_t>(k) * width_ + i]; }
    const Eight& slope(std::size_t group, int k, std::size_t i) const {
        return groups_[group].states[static_cast<std::size_t>(k) * width_ + i];
    }
    // Whether one of the slopes of order k from i on is larger, times the weight, than its limit.
    bool any_above(std::size_t group, int k, std::size_t i, std::span<const Eight> limits, double weight) const;
    // The slopes of orders first .. last, each times its weight, added up.
    Eight sum(std::size_t group, std::size_t i, const double* weights, int first, int last) const;

 private:
    using Number = Directed<16>;
    struct Group {
        Evaluator<Number> start;
        std::vector<SlopeCoefficient> coefficients;
        std::vector<Eight> risings, rise, states;
    };
    Number number(double x, std::size_t group, std::uint32_t slot) const;
    SlopeTables tables(Group& group) const;

    const SeriesProgram* program_;
    const SlopePlan* plan_;
    std::vector<std::uint32_t> variables_;
    std::size_t dof_, width_;
    SeriesEvaluator<double> series_;
    MotionOrders motion_;
    struct Known {
        std::size_t factor, series;
        double scale;
    };
    std::vector<Known> known_factors_;
    std::vector<double> rows_, knowns_, scales_of_rules_;
    std::shared_ptr<const SlopeOrderCode> code_;  // may be none
    std::vector<Group> groups_;
};

}  // namespace achilles
