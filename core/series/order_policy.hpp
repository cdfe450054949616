// Which order a Taylor step has, and how far its last terms are trusted: what TaylorStep is given as a policy.
#pragma once

#include "series/taylor_step.hpp"

namespace achilles {

// What a step costs, in processor cycles, measured: a step on its own; of each order a part on its own and one a rule;
// of each order squared a part an inner sum.
struct OrderCosts {
    double step, order, rule, square;
    int lowest;  // order that is worth a step
};
// A release is a triple root: the gap needs more terms than that.
inline constexpr OrderCosts costs_of_one_run{1000.0, 40.0, 2.0, 0.125, 5};
// By machine code for eight runs. The times are nearly the same over a few orders; a low weight of the step takes the
// lower ones, whose steps are more exact. The last four terms tell the step.
inline constexpr OrderCosts costs_of_eight_runs{400.0, 60.0, 5.0, 0.8, 10};

// The order p at which cost(p)/length(p) is least: a step of order p has a length of about (tolerance)^(1/p) times the
// radius of convergence.
int best_order(const SeriesProgram& program, double tolerance, const OrderCosts& costs);

// A single run's. How far the next event can be is often known from the first terms (a flight ends about where its
// parabola does); then the order is the first one whose terms are that small there, and a short flight costs a few
// orders. Else it is the order at which the cost of a step over its length is least.
class AdaptiveOrder {
 public:
    AdaptiveOrder(const SeriesProgram& program, double tolerance);

    // The order, until two in a row are small or as many as pay; none if no step can be made of what is finite.
    int expand(TaylorStep<double>& step, SeriesEvaluator<double>& series, double longest);
    // As far as is wanted, or to where the last terms reach 1.
    double natural_step(const TaylorStep<double>& step) const;

 private:
    struct Magnitude {
        double m;
        std::size_t component;  // that it is of
    };
    static Magnitude magnitude(const TaylorStep<double>& step, int k);
    int begin_flight(TaylorStep<double>& step, SeriesEvaluator<double>& series, MotionOrders& motion, double longest);
    int leave_out_infinite(const TaylorStep<double>& step, int order);

    int most_;
    double target_ = 0.0;   // the longest step that the order is needed for, as far as is known
    double power_ = 0.0;    // target^order
    bool reached_ = false;  // the last two terms are small there
};

// All steps have one order, so that none depends on its neighbours: that of runs side by side.
template <class Number>
class FixedOrder {
 public:
    // If `ends_late`, the last term may reach 2 and the one before it 4 where a step ends: those left out are then, as a
    // rule, less than 1 together. That will do where no event waits for the end to be known better.
    FixedOrder(int order, bool ends_late) : order_(order), ends_late_(ends_late) {}

    int expand(TaylorStep<Number>& step, SeriesEvaluator<Number>& series, const Number&) const {
        series.extend(step.row(1), order_);
        step.give_rates();
        return order_;
    }
    // As far as is wanted, or as it reaches.
    Number natural_step(const TaylorStep<Number>& step, const Number& longest) const {
        return min(reach(step), longest);
    }
    // To where the last two terms reach 1, and half of it is within the reach of the two before; the step is expanded to this
    // order, or further.
    Number reach(const TaylorStep<Number>& step) const {
        constexpr int counted = 4;
        Number exponent = 900.0;  // of 2
        for (int i = 0; i < counted; ++i) {
            const int k = order_ - i;
            const double late = ends_late_ ? (i + 1) * reciprocals[static_cast<std::size_t>(k)] : 0.0;
            exponent = min(step.reach(k, step.size(k), i >= 2 ? 1.0 : late), exponent);
        }
        return rough_exp2(exponent);
    }

 private:
    int order_;
    bool ends_late_;
};

}  // namespace achilles
