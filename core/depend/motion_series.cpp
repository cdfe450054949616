#include "depend/motion_series.hpp"

#include <cmath>

namespace achilles {

MotionSeries::MotionSeries(const Model& model, ContactSet held, std::span<const double> parameters)
    : dof_(static_cast<std::size_t>(model.dof())),
      width_(2 * dof_ + model.contacts()),
      series_(model.motion(held).series, parameters),
      rows_(static_cast<std::size_t>(highest_order + 1) * width_) {}

void MotionSeries::expand(const State& state, int order) {
    order_ = order;
    double *const from = rows_.data(), *const first = from + width_;
    for (std::size_t i = 0; i < dof_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        from[i] = state.q[k];
        from[dof_ + i] = first[i] = state.v[k];
    }
    series_.begin(from, state.t);
    for (std::size_t i = 0; i < dof_; ++i) first[dof_ + i] = series_.start(i);
    series_.extend(1, first);
    for (std::size_t i = 2 * dof_; i < width_; ++i) first[i] = series_.output(i - dof_);
    // No term is so small that it would be the last: none but a 0 is, and then it goes on from there.
    constexpr double never_small = 1e300;
    MotionOrders motion;
    motion.row = first;
    for (int made = 1; made < order;) {
        motion.largest = motion.row + dof_;
        motion.power = never_small;
        made = series_.extend(motion, made + 1, order);
    }
}

int MotionSeries::finite_order() const {
    for (int k = 0; k <= order_; ++k)
        for (std::size_t i = 0; i < 2 * dof_; ++i)
            if (!std::isfinite(coefficient(k, i))) return k - 1;
    return order_;
}

double MotionSeries::sum(int first, int last, std::size_t i, double span) const {
    double sum = 0.0;
    for (int k = last; k >= first; --k) sum = sum * span + coefficient(k, i);
    return sum * std::pow(span, first);
}

}  // namespace achilles
