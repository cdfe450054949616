#include "depend/flow_difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

constexpr double digits = 1e-4;  // relative, of a derivative
constexpr int lowest = 4;
constexpr double most_open = 0.03;  // relative, of what is left out

double size_of(const State& state) {
    return 1.0 + std::max(state.q.cwiseAbs().maxCoeff(), state.v.cwiseAbs().maxCoeff());
}

}  // namespace

FlowDifference::FlowDifference(const Model& model, ContactSet held, const Tangent& tangent,
                               std::span<const double> parameters)
    : tangent_(tangent), motion_(model, held, parameters), part_(model, held, parameters) {
    const bool has_clock = model.motion(held).series.inputs()[model.layout().t()];
    for (std::size_t k = 0; k < 2 * tangent.dof; ++k)
        beside_.push_back({tangent.variable(k), 0.0, MotionSeries(model, held, parameters)});
    if (has_clock) beside_.push_back({Tangent::t(), 0.0, MotionSeries(model, held, parameters)});
}

void FlowDifference::expand_beside(const State& state) {
    constexpr double relative = 0x1p-20;
    for (Beside& beside : beside_) {
        State other = state;
        const Eigen::Index column = beside.column;
        double& x = column == Tangent::t()   ? other.t
                    : column < tangent_.v(0) ? other.q[column - tangent_.q(0)]
                                             : other.v[column - tangent_.v(0)];
        const double here = x;
        x += relative * (1.0 + std::abs(here));
        beside.distance = x - here;
        beside.motion.expand(other, slope_order_);
    }
}

// How large the last two terms are after such a time beside the largest, at most. A start at another time alone changes nothing at
// first: its terms are compared with what the motion does in that time, too. What they add to that may be rounding.
double FlowDifference::last_terms(double length) const {
    double most = 0.0, rate = 0.0;
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) rate = std::max(rate, std::abs(motion_.coefficient(1, i)));
    for (const Beside& beside : beside_) {
        double largest = beside.column == Tangent::t() ? rate : 0.0, last = 0.0, power = 1.0;
        for (int k = 0; k <= slope_order_; ++k, power *= length)
            for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
                const double term = std::abs(slope(beside, k, i)) * power;
                largest = std::max(largest, term);
                if (k >= slope_order_ - 1) last = std::max(last, term);
            }
        if (last > 0.0) most = std::max(most, last / largest);
    }
    return most;
}

// Of the motion and those beside it.
int FlowDifference::finite_order() const {
    int order = motion_.finite_order();
    for (const Beside& beside : beside_) order = std::min(order, beside.motion.finite_order());
    return order;
}

double FlowDifference::expand(const State& state, double length, int least_order) {
    constexpr int highest = MotionSeries::highest_order;
    state_ = state;
    slope_order_ = std::max(lowest, slope_order_ - 1);
    order_ = std::min(std::max(least_order, slope_order_), highest);
    motion_.expand(state, order_);
    for (;;) {
        expand_beside(state);
        if (const int finite = finite_order(); finite < slope_order_) {
            if (finite < lowest) return length;  // the derivative is no number, which shows
            slope_order_ = finite;
            break;
        }
        if (last_terms(length) <= digits) return length;
        if (slope_order_ >= highest) break;
        slope_order_ = std::min(slope_order_ + 3, highest);
        if (slope_order_ > order_) motion_.expand(state, order_ = slope_order_);
    }
    for (int round = 0; round < 60 && !(last_terms(length) <= digits); ++round) length *= 0.7;
    return length;
}

void FlowDifference::slope_after(double span, ContactSet held, RowMatrix& S) {
    for (const Beside& beside : beside_) {
        for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
            double sum = 0.0;
            for (int k = slope_order_; k >= 0; --k) sum = sum * span + slope(beside, k, i);
            S(tangent_.q(i), beside.column) = sum;
        }
        // The gap, of which order 0 and 1 are given apart, and its rate.
        for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
            if (held.contains(contact)) continue;
            double h = 0.0, u = 0.0;
            for (int k = slope_order_; k >= 2; --k) {
                const double c = slope(beside, k, 2 * tangent_.dof + contact);
                h = h * span + c;
                u = u * span + k * c;
            }
            S(tangent_.h(contact), beside.column) = h * span * span;
            S(tangent_.u(contact), beside.column) = u * span;
        }
    }
    for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
        if (held.contains(contact)) continue;
        S(tangent_.h(contact), tangent_.h(contact)) = S(tangent_.u(contact), tangent_.u(contact)) = 1.0;
        S(tangent_.h(contact), tangent_.u(contact)) = span;
    }
}

void FlowDifference::left_out(int degree, double span, RowMatrix& delta) {
    const int first = degree + 1, last = std::min(order_, degree + more_orders);
    delta.setZero(tangent_.size(), 1);
    if (first > last) return;
    if (motion_.finite_order() < order_) return by_parts(degree, span, delta);
    double largest = 0.0, open = 0.0;  // of the sums; of what may follow
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
        const double sum = motion_.sum(first, last, i, span);
        delta(tangent_.q(i), 0) = sum;
        largest = std::max(largest, std::abs(sum));
        open = std::max(open, std::abs(motion_.sum(std::max(first, last - 1), last, i, span)));
    }
    // Differences are known to a rounding of the state only, and so are the sums of the run.
    const double rounding = 0x1p-48 * size_of(state_);
    if (open > most_open * largest && largest > rounding && !by_halves(degree, span, delta))
        by_parts(degree, span, delta);
}

// The last two terms of q and v at a time, at most.
double FlowDifference::open_terms(const MotionSeries& motion, double span) const {
    double open = 0.0;
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i)
        open = std::max(open, std::abs(motion.coefficient(order_, i) * std::pow(span, order_)) +
                                  std::abs(motion.coefficient(order_ - 1, i) * std::pow(span, order_ - 1)));
    return open;
}

// False where the terms of the halves fall too slowly, too.
bool FlowDifference::by_halves(int degree, double span, RowMatrix& delta) {
    const double half = 0.5 * span;
    State middle = state_;
    middle.t += half;
    for (std::size_t i = 0; i < tangent_.dof; ++i) {
        middle.q[static_cast<Eigen::Index>(i)] = motion_.sum(0, order_, i, half);
        middle.v[static_cast<Eigen::Index>(i)] = motion_.sum(0, order_, tangent_.dof + i, half);
    }
    part_.expand(middle, order_);
    double largest = 0.0;
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
        const double difference = part_.sum(0, order_, i, half) - motion_.sum(0, degree, i, span);
        delta(tangent_.q(i), 0) = difference;
        largest = std::max(largest, std::abs(difference));
    }
    return std::max(open_terms(motion_, half), open_terms(part_, half)) <= most_open * largest;
}

// After this time the last four terms are rounding; symmetry may hide three in a row.
double FlowDifference::reach(const MotionSeries& motion, int order, std::size_t rows, double size) {
    constexpr double unit_roundoff = 0x1p-53;
    double reach = order < lowest ? 0.0 : std::numeric_limits<double>::infinity();
    for (int k = order - 3; k <= order && reach > 0.0; ++k)
        for (std::size_t i = 0; i < rows; ++i) {
            const double c = std::abs(motion.coefficient(k, i));
            if (c > 0.0) reach = std::min(reach, std::pow(unit_roundoff * size / c, 1.0 / k));
        }
    return reach;
}

// A step may be longer than its series converges: behind a narrow pulse the force is nothing, to the run's tolerance, in the
// terms that the run keeps, and the terms that follow grow beyond all bounds before they fall.
void FlowDifference::by_parts(int degree, double span, RowMatrix& delta) {
    constexpr int most_parts = 5000, least_order = 24;
    const std::size_t n = tangent_.dof;
    State at = state_;
    double left = span;
    for (int part = 0; left > 0.0; ++part) {
        part_.expand(at, std::max(order_, least_order));
        const int order = part_.finite_order();
        const double length = std::min(left, reach(part_, order, 2 * n, size_of(at)));
        if (part == most_parts || !(length > 0x1p-40 * span)) {
            delta.setConstant(std::numeric_limits<double>::quiet_NaN());
            return;
        }
        left = length < left ? left - length : 0.0;
        at.t = state_.t + (span - left);
        for (std::size_t i = 0; i < n; ++i) {
            at.q[static_cast<Eigen::Index>(i)] = part_.sum(0, order, i, length);
            at.v[static_cast<Eigen::Index>(i)] = part_.sum(0, order, n + i, length);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        delta(tangent_.q(i), 0) = at.q[k] - motion_.sum(0, degree, i, span);
        delta(tangent_.v(i), 0) = at.v[k] - motion_.sum(0, degree, n + i, span);
    }
}

}  // namespace achilles
