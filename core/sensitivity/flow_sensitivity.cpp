#include "sensitivity/flow_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "series/series_over.hpp"

namespace achilles {

namespace {

using Eights = Lanes<16>;  // derivatives by this many variables at once
constexpr std::size_t N = Double8::count;
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
    FlowSensitivityBySeries(const Model& model, Mode mode, const TangentLayout& tangent,
                            std::span<const double> parameters, const std::vector<bool>& varied, double tolerance)
        : mode_(mode),
          tangent_(tangent),
          tolerance_(tolerance),
          variables_(variables_of(model.motion(mode).series, tangent, varied)),
          variation_(model.variation(mode, static_cast<std::uint32_t>((variables_.size() + N - 1) / N))),
          series_(variation_.series, variation_.code),
          start_(2 * variation_.layout.coordinates(), Eights(0.0)),
          limits_(variation_.layout.copies() * (2 * tangent.dof + tangent.contacts)) {
        const VariationLayout& inputs = variation_.layout;
        const Slots slots = inputs.slots();
        std::vector<Eights> numbers(slots.parameters_end - slots.parameters_begin, Eights(0.0));
        const auto first = static_cast<std::uint32_t>(2 * tangent.dof);
        for (std::uint32_t k = 0; k < parameters.size(); ++k)
            numbers[inputs.input(0, first + k) - slots.parameters_begin] = parameters[k];
        for (std::uint32_t k = 0; k < variables_.size(); ++k) {
            const auto direction = static_cast<std::uint32_t>(k / N);
            const std::uint32_t place = inputs.input(1 + direction, variables_[k]);
            (place < start_.size() ? start_[place] : numbers[place - slots.parameters_begin]).set(k % N, 1.0);
        }
        series_.fix(numbers);
    }

    double expand(const State& state, double length, int min_order) override {
        const auto n = static_cast<std::uint32_t>(tangent_.dof);
        for (std::uint32_t i = 0; i < n; ++i) {
            start_[variation_.layout.input(0, i)] = state.q[static_cast<Eigen::Index>(i)];
            start_[variation_.layout.input(0, n + i)] = state.v[static_cast<Eigen::Index>(i)];
        }
        series_.begin(start_.data(), state.t);
        // Stop when the last term is small compared with the first few, and the one before nearly.
        order_ = std::clamp(min_order, first_few + 1, highest) - 1;
        series_.extend(1, order_);
        raise_to_powers(length);
        set_limits();
        for (bool before = is_small(order_, nearly); order_ < highest; before = is_small(order_, nearly)) {
            ++order_;
            series_.extend(order_, order_);
            if (before && is_small(order_, 1.0)) return length;
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
    double coefficient(int k, std::size_t i) const override { return series_.coefficient(k, place(0, i))[0]; }

    void slope_after(double span, Mode mode, RowMatrix& S) override {
        if (span != powers_[1]) raise_to_powers(span);
        const auto sum = [&](std::size_t i, const Powers& weights, int first, Eigen::Index row) {
            for (std::uint32_t copy = 1; copy < variation_.layout.copies(); ++copy) {
                const Eights slope = sum_of_terms(place(copy, i), weights, first);
                const std::size_t begin = (copy - 1) * N, end = std::min(begin + N, variables_.size());
                for (std::size_t k = begin; k < end; ++k) S(row, tangent_.variable(variables_[k])) = slope[k - begin];
            }
        };
        for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) sum(i, powers_, 0, tangent_.q(i));
        // h and u from order 2 on; the orders 0 and 1 are set below.
        for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
            if (mode.is_held(contact)) continue;
            sum(2 * tangent_.dof + contact, powers_, 2, tangent_.h(contact));
            sum(2 * tangent_.dof + contact, rates_, 2, tangent_.u(contact));
            S(tangent_.h(contact), tangent_.h(contact)) = S(tangent_.u(contact), tangent_.u(contact)) = 1.0;
            S(tangent_.h(contact), tangent_.u(contact)) = span;
        }
    }

 private:
    using Powers = std::array<double, highest + 1>;

    // The place of a copy of q, v or a gap in the rows of the series.
    std::size_t place(std::uint32_t copy, std::size_t i) const {
        const std::size_t states = 2 * tangent_.dof;
        if (i < states) return variation_.layout.input(copy, static_cast<std::uint32_t>(i));
        return start_.size() + copy * tangent_.contacts + (i - states);
    }
    // The number of places, and the weight of order k there: for a gap, that in its rate.
    std::size_t places() const { return limits_.size(); }
    double weight(std::size_t place, int k) const {
        return (place < start_.size() ? powers_ : rates_)[static_cast<std::size_t>(k)];
    }
    Eights size_of_term(std::size_t place, int k) const {
        return abs(series_.coefficient(k, place)) * weight(place, k);
    }
    // The weighted sum of the orders first .. order_; even and odd orders are summed separately.
    Eights sum_of_terms(std::size_t place, const Powers& weights, int first) const {
        Eights even = 0.0, odd = 0.0;
        const auto term = [&](int k) { return weights[static_cast<std::size_t>(k)] * series_.coefficient(k, place); };
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

    // The tolerance for the terms of each row, relative to the largest of the first few. Slopes far smaller than those
    // of other directions are rounding, or become relevant only later.
    void set_limits() {
        for (std::size_t i = 0; i < 2 * tangent_.dof + tangent_.contacts; ++i) {
            const bool is_held = i >= 2 * tangent_.dof && mode_.is_held(i - 2 * tangent_.dof);
            const double none = is_held ? std::numeric_limits<double>::infinity() : 0.0;
            double least = 0.0;
            for (std::uint32_t copy = 0; copy < variation_.layout.copies(); ++copy) {
                const std::size_t at = place(copy, i);
                Eights sizes = none;
                for (int k = 0; k < first_few; ++k) sizes = max(size_of_term(at, k), sizes);
                double largest = copy == 0 ? 0.0 : least;
                for (std::size_t d = 0; d < N; ++d) largest = std::max(largest, sizes[d]);
                if (copy == 0) least = largest;
                limits_[at] = tolerance_ * max(sizes, Eights(1e-6 * largest));
            }
        }
    }
    // Whether the terms of order k are within `times` their limits. The place where one was not is tried first.
    bool is_small(int k, double times) {
        const auto is_large = [&](std::size_t at) { return any(size_of_term(at, k) > times * limits_[at]); };
        if (is_large(large_)) return false;
        Eights::Mask large(false);
        for (std::size_t i = 0; i < places(); ++i) large = large | (size_of_term(i, k) > times * limits_[i]);
        if (!any(large)) return true;
        for (large_ = 0; !is_large(large_);) ++large_;
        return false;
    }
    // The largest ratio of the last two terms to their limits; 0 if all are within them.
    double last_terms() const {
        double largest = 0.0;
        for (const int k : {order_ - 1, order_})
            for (std::size_t i = 0; i < places(); ++i) {
                const Eights size = size_of_term(i, k);
                for (std::size_t d = 0; d < N; ++d)
                    if (size[d] > limits_[i][d]) largest = std::max(largest, size[d] / limits_[i][d]);
            }
        return largest;
    }

    Mode mode_;
    TangentLayout tangent_;
    double tolerance_;
    std::vector<std::uint32_t> variables_;
    const MotionVariation& variation_;  // over lanes, direction d is by N of the variables
    SeriesOver<Eights> series_;
    std::vector<Eights> start_;  // copies of q and v
    Powers powers_{}, rates_{};  // for the current step
    std::vector<Eights> limits_;
    std::size_t large_ = 0;
    int order_ = 0;
};

}  // namespace

std::unique_ptr<FlowSensitivity> make_flow_slope(const Model& model, Mode mode, const TangentLayout& tangent,
                                                 std::span<const double> parameters, const std::vector<bool>& varied,
                                                 double tolerance) {
    return std::make_unique<FlowSensitivityBySeries>(model, mode, tangent, parameters, varied, tolerance);
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
