// The order policy of single runs: the order and the length of a Taylor step.
#include "series/taylor_step.hpp"

#include <algorithm>
#include <limits>

namespace achilles {

namespace {

constexpr int guarded = 10;  // from this order on, four terms determine the step
constexpr int lowest = costs_of_one_run.lowest;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Symmetry may make three successive terms vanish, but not four.
bool three_before_vanish(const TaylorStep<double>& step, int order) {
    return step.size(order - 1) + step.size(order - 2) + step.size(order - 3) == 0.0;
}

}  // namespace

int best_order(const SeriesProgram& program, double tolerance, const OrderCosts& costs) {
    const double order = costs.order + costs.rule * static_cast<double>(program.rules()),
                 square = costs.square * static_cast<double>(program.inner_sums());
    // log(cost(p)/length(p)) decreases while its derivative, times p^2 cost(p), is negative.
    const double digits = -std::log(tolerance);
    int p = costs.lowest;
    while (p < OrderCode::highest_order - 1 &&
           p * p * (order + 2.0 * square * p) < digits * (costs.step + order * p + square * p * p))
        ++p;
    return p;
}

AdaptiveOrder::AdaptiveOrder(const SeriesProgram& program, double tolerance)
    : most_(best_order(program, tolerance, costs_of_one_run)) {}

// The largest coefficient of order k in units of its tolerance, and its component. The sum propagates NaN and infinity
// of any component, which the comparisons would miss.
AdaptiveOrder::Magnitude AdaptiveOrder::magnitude(const TaylorStep<double>& step, int k) {
    const double *const c = step.row(k), *const units = step.units();
    double largest = 0.0, sum = 0.0;
    std::size_t component = 0;
    for (std::size_t i = 0; i < step.width(); ++i) {
        const double size = std::abs(c[i]) * units[i];
        const bool larger = size > largest;
        largest = larger ? size : largest;
        component = larger ? i : component;
        sum += size;
    }
    return {sum < infinity ? largest : sum, component};
}

// Reduces the order to the last one before the first that is not finite.
int AdaptiveOrder::leave_out_infinite(const TaylorStep<double>& step, int order) {
    int finite = 0;
    while (finite + 1 < order && magnitude(step, finite + 1).m < infinity) ++finite;
    power_ = std::pow(target_, finite);
    reached_ = false;
    return finite >= lowest ? finite : 0;
}

// The first orders of a flight, from which its length is estimated. No order below `lowest` may end the series, so the
// test of smallness is disabled: one component (the first v) is compared with a power that is never small.
int AdaptiveOrder::begin_flight(TaylorStep<double>& step, SeriesEvaluator<double>& series, MotionOrders& motion,
                                double longest) {
    constexpr double never_small = 1e300;
    motion.largest = step.row(1) + step.dof();
    motion.power = never_small;
    const int order = series.extend(motion, 2, lowest - 1);
    target_ = step.aim(longest);
    power_ = target_;
    for (int k = 1; k < order; ++k) power_ *= target_;
    return order;
}

int AdaptiveOrder::expand(TaylorStep<double>& step, SeriesEvaluator<double>& series, double longest) {
    double* const first = step.row(1);
    series.extend(1, first);
    for (std::size_t i = 0; i < step.contacts(); ++i) first[2 * step.dof() + i] = series.output(step.dof() + i);
    step.give_rates();
    MotionOrders motion;
    motion.row = first;
    int order = 1;
    power_ = target_ = longest;
    if (step.watches_any_gap()) order = begin_flight(step, series, motion, longest);
    for (bool small = false;;) {  // small: is the order just before small?
        const auto [m, largest] = magnitude(step, order);
        if (!(m < infinity)) return leave_out_infinite(step, order);
        const bool now = m * power_ <= 1.0;
        reached_ = small && now;
        if (order >= most_ || (order >= lowest && reached_ && (m > 0.0 || three_before_vanish(step, order))))
            return order;
        // While the component that is largest now stays large, further orders are computed without examining the
        // others.
        const int before = order;
        motion.largest = step.row(order) + largest;
        motion.power = step.units()[largest] * power_;
        motion.target = target_;
        order = series.extend(motion, before + 1, most_);
        power_ = motion.power / step.units()[largest];
        small = now && order == before + 1;
    }
}

// The last two terms may be at most 1 at the end of the step. Symmetry may make them too small, so the two before them
// must be at most 1 at half the step. This does not apply to a short series that was ended early, whose earlier terms
// are large.
double AdaptiveOrder::natural_step(const TaylorStep<double>& step) const {
    const int order = step.order();
    if (reached_ && order < guarded) return target_;
    const int counted = std::min(order, order < guarded ? 2 : 4);
    std::array<double, 4> terms{};
    bool all = true;
    double power = power_;
    for (int i = 0; i < counted; ++i, power /= target_) {
        const int k = order - i;
        const double m = terms[static_cast<std::size_t>(i)] = step.size(k);
        all = all && m * power <= (i < 2 ? 1.0 : static_cast<double>(std::int64_t{1} << k));
    }
    if (all) return target_;
    double exponent = infinity;  // exponent of 2
    for (int i = 0; i < counted; ++i) {
        const double m = terms[static_cast<std::size_t>(i)];
        if (m > 0.0) exponent = std::min(exponent, step.reach(order - i, m, i < 2 ? 0.0 : 1.0));
    }
    return std::exp2(exponent);
}

}  // namespace achilles
