#include "sensitivity/flow_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "number/jet.hpp"
#include "series/series_over.hpp"

namespace achilles {

namespace {

using Number = Jet8<16>;  // with slopes by this many variables at once
constexpr std::size_t N = Number::directions;
using Eights = Lanes<16>;
constexpr int highest = 32, first_few = 4;  // orders; beyond `highest` the step is shortened
constexpr double nearly = 8.0;

// The inputs of a mode's program used as variables: q, v, then the parameters and the time that it depends on.
std::vector<std::uint32_t> variables_of(const SeriesProgram& program, const TangentLayout& tangent,
                                        const std::vector<bool>& varied) {
    const std::vector<bool> inputs = program.inputs();
    std::vector<std::uint32_t> variables;
    for (std::uint32_t k = 0; k < tangent.variables(); ++k) {
        const bool is_clock = k + 1 == tangent.variables(), is_state = k < 2 * tangent.dof;
        const bool is_still = !is_state && !is_clock && !varied.empty() && !varied[k - 2 * tangent.dof];
        if (is_state || (!is_still && inputs[k])) variables.push_back(k);
    }
    return variables;
}

class FlowSensitivityBySeries : public FlowSensitivity {
 public:
    FlowSensitivityBySeries(const SeriesProgram& program, Mode mode, const TangentLayout& tangent,
                            std::span<const double> parameters, const std::vector<bool>& varied, double tolerance)
        : mode_(mode),
          tangent_(tangent),
          tolerance_(tolerance),
          variables_(variables_of(program, tangent, varied)),
          start_(2 * tangent.dof),
          value_limits_(rows()) {
        std::vector<Number> numbers(parameters.size());
        for (std::size_t first = 0; first < variables_.size(); first += N) {
            for (std::size_t k = 0; k < numbers.size(); ++k)
                numbers[k] = number(parameters[k], 2 * tangent.dof + k, first);
            series_.emplace_back(program).fix(numbers);
        }
        limits_.resize(series_.size() * rows());
    }

    double expand(const State& state, double length, int min_order) override {
        const std::size_t n = tangent_.dof;
        for (std::size_t group = 0; group < series_.size(); ++group) {
            for (std::size_t i = 0; i < n; ++i) {
                start_[i] = number(state.q[static_cast<Eigen::Index>(i)], i, group * N);
                start_[n + i] = number(state.v[static_cast<Eigen::Index>(i)], n + i, group * N);
            }
            series_[group].begin(start_.data(), number(state.t, tangent_.variables() - 1, group * N));
        }
        order_ = 0;
        // Stop when the last term is small compared with the first few, and the one before nearly.
        const int least = std::clamp(min_order, first_few + 1, highest);
        raise_to_powers(length);
        bool before = false;
        while (order_ < highest) {
            ++order_;
            for (SeriesOver<Number>& series : series_) series.extend(order_, order_);
            if (order_ == first_few - 1) set_limits();
            if (order_ < least - 1) continue;
            if (before && is_small(order_, 1.0)) return length;
            before = is_small(order_, nearly);
        }
        // Otherwise shorten the step, at which the last terms fall at least this fast; but not below the length where
        // errors of the run's own steps dominate.
        const double min_length = 1e-3 * length;
        for (double excess = last_terms(); excess > 1.0 && length > min_length; excess = last_terms()) {
            length *= std::isfinite(excess) ? std::clamp(std::pow(excess, -1.0 / (highest - 1)), 0.05, 0.9) : 0.05;
            raise_to_powers(length);
            set_limits();
        }
        return length;
    }
    int order() const override { return order_; }
    double coefficient(int k, std::size_t i) const override { return value(k, i); }

    void slope_after(double span, Mode mode, RowMatrix& S) override {
        if (span != powers_[1]) raise_to_powers(span);
        for (std::size_t group = 0; group < series_.size(); ++group) {
            const auto sum = [&](std::size_t i, const Powers& weights, int first, Eigen::Index row) {
                const Eights slope = sum_of_slopes(group, i, weights, first);
                for (std::size_t d = 0; d < directions(group); ++d)
                    S(row, tangent_.variable(variables_[group * N + d])) = slope[d];
            };
            for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) sum(i, powers_, 0, tangent_.q(i));
            // h and u from order 2 on; the orders 0 and 1 are set below.
            for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
                if (mode.is_held(contact)) continue;
                sum(2 * tangent_.dof + contact, powers_, 2, tangent_.h(contact));
                sum(2 * tangent_.dof + contact, rates_, 2, tangent_.u(contact));
            }
        }
        for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
            if (mode.is_held(contact)) continue;
            S(tangent_.h(contact), tangent_.h(contact)) = S(tangent_.u(contact), tangent_.u(contact)) = 1.0;
            S(tangent_.h(contact), tangent_.u(contact)) = span;
        }
    }

 private:
    using Powers = std::array<double, highest + 1>;

    // An input of the program as a number with slopes by the variables from `first` on.
    Number number(double x, std::size_t input, std::size_t first) const {
        for (std::size_t d = 0; d < N && first + d < variables_.size(); ++d)
            if (variables_[first + d] == input) return Number::variable(x, d);
        return x;
    }
    std::size_t directions(std::size_t group) const { return std::min(N, variables_.size() - group * N); }
    double value(int k, std::size_t i) const { return series_.front().coefficient(k, i).value; }
    const Eights& slope(std::size_t group, int k, std::size_t i) const {
        return series_[group].coefficient(k, i).slope;
    }
    // The weighted sum of the slopes of orders first .. order_; even and odd orders are summed separately.
    Eights sum_of_slopes(std::size_t group, std::size_t i, const Powers& weights, int first) const {
        Eights even = 0.0, odd = 0.0;
        const auto term = [&](int k) { return weights[static_cast<std::size_t>(k)] * slope(group, k, i); };
        int k = first;
        for (; k < order_; k += 2) {
            even += term(k);
            odd += term(k + 1);
        }
        if (k == order_) even += term(k);
        return even + odd;
    }
    // t^k; and k t^(k-1) from k = 2 on.
    void raise_to_powers(double t) {
        powers_[0] = 1.0;
        for (std::size_t k = 1; k < powers_.size(); ++k) powers_[k] = powers_[k - 1] * t;
        for (std::size_t k = 2; k < rates_.size(); ++k) rates_[k] = static_cast<double>(k) * powers_[k - 1];
    }

    // The weight of order k in row i of q, v and the gaps; for a gap, that in its rate.
    double weight(std::size_t i, int k) const {
        return (i < 2 * tangent_.dof ? powers_ : rates_)[static_cast<std::size_t>(k)];
    }
    std::size_t rows() const { return 2 * tangent_.dof + tangent_.contacts; }

    // The tolerance for the terms of each row, relative to the largest of the first few. Slopes far smaller than those
    // of other directions are rounding, or become relevant only later.
    void set_limits() {
        for (std::size_t i = 0; i < rows(); ++i) {
            const bool is_held = i >= 2 * tangent_.dof && mode_.is_held(i - 2 * tangent_.dof);
            const double none = is_held ? std::numeric_limits<double>::infinity() : 0.0;
            double size = none;
            for (int k = 0; k < first_few; ++k) size = std::max(size, std::abs(value(k, i)) * weight(i, k));
            value_limits_[i] = tolerance_ * size;
            for (std::size_t group = 0; group < series_.size(); ++group) {
                Eights sizes = none;
                for (int k = 0; k < first_few; ++k) sizes = max(abs(slope(group, k, i)) * weight(i, k), sizes);
                double least = size;
                for (std::size_t d = 0; d < N; ++d) least = std::max(least, sizes[d]);
                limits_[group * rows() + i] = tolerance_ * max(sizes, Eights(1e-6 * least));
            }
        }
    }
    // Whether the terms of order k are within `times` their limits.
    bool is_small(int k, double times) const {
        for (std::size_t i = 0; i < rows(); ++i) {
            const double share = weight(i, k) / times;
            if (std::abs(value(k, i)) * share > value_limits_[i]) return false;
            for (std::size_t group = 0; group < series_.size(); ++group)
                if (any(abs(slope(group, k, i)) * share > limits_[group * rows() + i])) return false;
        }
        return true;
    }
    // The largest ratio of the last two terms to their limits; 0 if all are within them.
    double last_terms() const {
        double largest = 0.0;
        const auto take = [&](double term, double limit) {
            if (term > limit) largest = std::max(largest, term / limit);
        };
        for (const int k : {order_ - 1, order_})
            for (std::size_t i = 0; i < rows(); ++i) {
                take(std::abs(value(k, i)) * weight(i, k), value_limits_[i]);
                for (std::size_t group = 0; group < series_.size(); ++group)
                    for (std::size_t d = 0; d < N; ++d)
                        take(std::abs(slope(group, k, i)[d]) * weight(i, k), limits_[group * rows() + i][d]);
            }
        return largest;
    }

    Mode mode_;
    TangentLayout tangent_;
    double tolerance_;
    std::vector<std::uint32_t> variables_;
    std::vector<SeriesOver<Number>> series_;  // each for N of the variables
    std::vector<Number> start_;               // q and v
    Powers powers_{}, rates_{};               // for the current step
    std::vector<double> value_limits_;
    std::vector<Eights> limits_;
    int order_ = 0;
};

}  // namespace

std::unique_ptr<FlowSensitivity> make_flow_slope(const Model& model, Mode mode, const TangentLayout& tangent,
                                                 std::span<const double> parameters, const std::vector<bool>& varied,
                                                 double tolerance) {
    return std::make_unique<FlowSensitivityBySeries>(model.motion(mode).series, mode, tangent, parameters, varied,
                                                     tolerance);
}

// ---- by differences ----

namespace {

constexpr double digits = 1e-4;  // relative accuracy of a derivative
constexpr int lowest = 4;
constexpr double most_open = 0.03;  // relative uncertainty of the omitted part

double size_of(const State& state) {
    return 1.0 + std::max(state.q.cwiseAbs().maxCoeff(), state.v.cwiseAbs().maxCoeff());
}

}  // namespace

MotionSeries::MotionSeries(const Model& model, Mode mode, std::span<const double> parameters)
    : SeriesOver(model.motion(mode).series), start_(static_cast<std::size_t>(2 * model.dof())) {
    fix(parameters);
}

void MotionSeries::expand(const State& state, int order) {
    std::copy(state.v.begin(), state.v.end(), std::copy(state.q.begin(), state.q.end(), start_.begin()));
    begin(start_.data(), state.t);
    extend(1, order_ = order);
}

int MotionSeries::finite_order() const {
    for (int k = 0; k <= order_; ++k)
        for (std::size_t i = 0; i < start_.size(); ++i)
            if (!std::isfinite(coefficient(k, i))) return k - 1;
    return order_;
}

double MotionSeries::sum(int first, int last, std::size_t i, double span) const {
    double sum = 0.0;
    for (int k = last; k >= first; --k) sum = sum * span + coefficient(k, i);
    return sum * std::pow(span, first);
}

FlowDifference::FlowDifference(const Model& model, Mode mode, const TangentLayout& tangent,
                               std::span<const double> parameters)
    : tangent_(tangent), motion_(model, mode, parameters), part_(model, mode, parameters) {
    const bool has_clock = model.motion(mode).series.inputs()[model.layout().t()];
    for (std::size_t k = 0; k < 2 * tangent.dof; ++k)
        nearby_motions_.push_back({tangent.variable(k), 0.0, MotionSeries(model, mode, parameters)});
    if (has_clock) nearby_motions_.push_back({TangentLayout::t(), 0.0, MotionSeries(model, mode, parameters)});
}

void FlowDifference::expand_nearby(const State& state) {
    constexpr double relative = 0x1p-20;
    for (NearbyMotion& nearby : nearby_motions_) {
        State other = state;
        const Eigen::Index column = nearby.column;
        double& x = column == TangentLayout::t() ? other.t
                    : column < tangent_.v(0)     ? other.q[column - tangent_.q(0)]
                                                 : other.v[column - tangent_.v(0)];
        const double here = x;
        x += relative * (1.0 + std::abs(here));
        nearby.distance = x - here;
        nearby.motion.expand(other, slope_order_);
    }
}

// The largest ratio of the last two terms after this time to the largest term. A change of the start time alone has
// little effect at first, so its terms are also compared with the motion in that time: they may be rounding.
double FlowDifference::last_terms(double length) const {
    double most = 0.0, rate = 0.0;
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) rate = std::max(rate, std::abs(motion_.coefficient(1, i)));
    for (const NearbyMotion& nearby : nearby_motions_) {
        double largest = nearby.column == TangentLayout::t() ? rate : 0.0, last = 0.0, power = 1.0;
        for (int k = 0; k <= slope_order_; ++k, power *= length)
            for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
                const double term = std::abs(slope(nearby, k, i)) * power;
                largest = std::max(largest, term);
                if (k >= slope_order_ - 1) last = std::max(last, term);
            }
        if (last > 0.0) most = std::max(most, last / largest);
    }
    return most;
}

// The minimum over the motion and the neighboring ones.
int FlowDifference::finite_order() const {
    int order = motion_.finite_order();
    for (const NearbyMotion& nearby : nearby_motions_) order = std::min(order, nearby.motion.finite_order());
    return order;
}

double FlowDifference::expand(const State& state, double length, int min_order) {
    constexpr int highest = MotionSeries::highest_order;
    state_ = state;
    slope_order_ = std::max(lowest, slope_order_ - 1);
    order_ = std::min(std::max(min_order, slope_order_), highest);
    motion_.expand(state, order_);
    for (;;) {
        expand_nearby(state);
        if (const int finite = finite_order(); finite < slope_order_) {
            if (finite < lowest) return length;  // the derivative is NaN, which is visible
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

void FlowDifference::slope_after(double span, Mode mode, RowMatrix& S) {
    for (const NearbyMotion& nearby : nearby_motions_) {
        for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
            double sum = 0.0;
            for (int k = slope_order_; k >= 0; --k) sum = sum * span + slope(nearby, k, i);
            S(tangent_.q(i), nearby.column) = sum;
        }
        // h and u from order 2 on; the orders 0 and 1 are set below.
        for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
            if (mode.is_held(contact)) continue;
            double h = 0.0, u = 0.0;
            for (int k = slope_order_; k >= 2; --k) {
                const double c = slope(nearby, k, 2 * tangent_.dof + contact);
                h = h * span + c;
                u = u * span + k * c;
            }
            S(tangent_.h(contact), nearby.column) = h * span * span;
            S(tangent_.u(contact), nearby.column) = u * span;
        }
    }
    for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
        if (mode.is_held(contact)) continue;
        S(tangent_.h(contact), tangent_.h(contact)) = S(tangent_.u(contact), tangent_.u(contact)) = 1.0;
        S(tangent_.h(contact), tangent_.u(contact)) = span;
    }
}

void FlowDifference::left_out(int degree, double span, RowMatrix& delta) {
    const int first = degree + 1, last = std::min(order_, degree + more_orders);
    delta.setZero(tangent_.size(), 1);
    if (first > last) return;
    if (motion_.finite_order() < order_) return by_parts(degree, span, delta);
    double largest = 0.0, open = 0.0;  // largest sum; estimate of the terms beyond
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) {
        const double sum = motion_.sum(first, last, i, span);
        delta(tangent_.q(i), 0) = sum;
        largest = std::max(largest, std::abs(sum));
        open = std::max(open, std::abs(motion_.sum(std::max(first, last - 1), last, i, span)));
    }
    // Differences, like the sums of the run, are accurate only to a rounding of the state.
    const double rounding = 0x1p-48 * size_of(state_);
    if (open > most_open * largest && largest > rounding && !by_halves(degree, span, delta))
        by_parts(degree, span, delta);
}

// The largest sum of the last two terms of q and v after this time.
double FlowDifference::open_terms(const MotionSeries& motion, double span) const {
    double open = 0.0;
    for (std::size_t i = 0; i < 2 * tangent_.dof; ++i)
        open = std::max(open, std::abs(motion.coefficient(order_, i) * std::pow(span, order_)) +
                                  std::abs(motion.coefficient(order_ - 1, i) * std::pow(span, order_ - 1)));
    return open;
}

// Returns false if the terms of the halves fall too slowly, too.
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

// The time after which the last four terms are within rounding; symmetry may make three in a row 0.
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

// A step may be longer than the convergence radius of its series. Next to a narrow pulse, the force is negligible
// within the tolerance in the terms that the run keeps. The terms that follow, however, grow without bound before they
// fall.
void FlowDifference::by_parts(int degree, double span, RowMatrix& delta) {
    constexpr int max_parts = 5000, min_order = 24;
    const std::size_t n = tangent_.dof;
    State at = state_;
    double left = span;
    for (int part = 0; left > 0.0; ++part) {
        part_.expand(at, std::max(order_, min_order));
        const int order = part_.finite_order();
        const double length = std::min(left, reach(part_, order, 2 * n, size_of(at)));
        if (part == max_parts || !(length > 0x1p-40 * span)) {
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
