#include "depend/flow_slope.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "number/lanes.hpp"
#include "series/series_slopes.hpp"

namespace achilles {

namespace {

constexpr int highest = SeriesSlopes::highest_order, first_few = 4;
constexpr double nearly = 8.0;
constexpr std::size_t N = SeriesSlopes::directions;
using Eights = Lanes<16>;

// The variables of a motion, as inputs of its program: q, v, then what it depends on of the parameters and the time.
std::vector<std::uint32_t> variables_of(const SeriesProgram& program, const Tangent& tangent,
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

class FlowSlopeBySeries : public FlowSlope {
 public:
    FlowSlopeBySeries(const SeriesProgram& program, ContactSet held, const Tangent& tangent,
                      std::span<const double> parameters, const std::vector<bool>& varied, double tolerance)
        : held_(held),
          tangent_(tangent),
          tolerance_(tolerance),
          variables_(variables_of(program, tangent, varied)),
          series_(program, parameters, variables_),
          start_(2 * tangent.dof),
          value_limits_(rows()),
          limits_(series_.groups() * rows()) {}

    double expand(const State& state, double length, int least_order) override {
        const auto n = static_cast<Eigen::Index>(tangent_.dof);
        std::copy_n(state.q.data(), n, start_.begin());
        std::copy_n(state.v.data(), n, start_.begin() + n);
        series_.begin(start_.data(), state.t);
        order_ = 0;
        // The last term is small beside the first few, and the one before nearly.
        const int least = std::clamp(least_order, first_few + 1, highest);
        raise_to_powers(length);
        bool before = false;
        while (order_ < highest) {
            series_.extend(++order_);
            if (order_ == first_few - 1) set_limits();
            if (order_ < least - 1) continue;
            if (before && is_small(order_, 1.0)) return length;
            before = is_small(order_, nearly);
        }
        // Shorter, then: the last terms fall at least so fast. No shorter than steps of the run could be wrong by.
        const double least_length = 1e-3 * length;
        for (double excess = last_terms(); excess > 1.0 && length > least_length; excess = last_terms()) {
            length *= std::isfinite(excess) ? std::clamp(std::pow(excess, -1.0 / (highest - 1)), 0.05, 0.9) : 0.05;
            raise_to_powers(length);
            set_limits();
        }
        return length;
    }
    int order() const override { return order_; }
    double coefficient(int k, std::size_t i) const override { return series_.value(k, i); }

    void slope_after(double span, ContactSet held, RowMatrix& S) override {
        if (span != powers_[1]) raise_to_powers(span);
        for (std::size_t group = 0; group < series_.groups(); ++group) {
            const auto sum = [&](std::size_t i, const Powers& weights, int first, Eigen::Index row) {
                const Eight slope = series_.sum(group, i, weights.data(), first, order_);
                for (std::size_t d = 0; d < directions(group); ++d)
                    S(row, tangent_.variable(variables_[group * N + d])) = slope[d];
            };
            for (std::size_t i = 0; i < 2 * tangent_.dof; ++i) sum(i, powers_, 0, tangent_.q(i));
            // The gap, of which order 0 and 1 are given apart, and its rate.
            for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
                if (held.contains(contact)) continue;
                sum(2 * tangent_.dof + contact, powers_, 2, tangent_.h(contact));
                sum(2 * tangent_.dof + contact, rates_, 2, tangent_.u(contact));
            }
        }
        for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
            if (held.contains(contact)) continue;
            S(tangent_.h(contact), tangent_.h(contact)) = S(tangent_.u(contact), tangent_.u(contact)) = 1.0;
            S(tangent_.h(contact), tangent_.u(contact)) = span;
        }
    }

 private:
    using Powers = std::array<double, highest + 1>;

    std::size_t directions(std::size_t group) const { return std::min(N, variables_.size() - group * N); }
    // t^k; and k t^(k-1), from k = 2 on.
    void raise_to_powers(double t) {
        powers_[0] = 1.0;
        for (std::size_t k = 1; k < powers_.size(); ++k) powers_[k] = powers_[k - 1] * t;
        for (std::size_t k = 2; k < rates_.size(); ++k) rates_[k] = static_cast<double>(k) * powers_[k - 1];
    }

    // Row i of q, v and the gaps: order k of it, or of gaps of their rate, counts so much.
    double weight(std::size_t i, int k) const {
        return (i < 2 * tangent_.dof ? powers_ : rates_)[static_cast<std::size_t>(k)];
    }
    std::size_t rows() const { return 2 * tangent_.dof + tangent_.contacts; }

    // The tolerance of each row's terms: of the largest of the first few. What is so much smaller than the other directions' is
    // rounding, or comes late.
    void set_limits() {
        for (std::size_t i = 0; i < rows(); ++i) {
            const bool is_held = i >= 2 * tangent_.dof && held_.contains(i - 2 * tangent_.dof);
            const double none = is_held ? std::numeric_limits<double>::infinity() : 0.0;
            double size = none;
            for (int k = 0; k < first_few; ++k) size = std::max(size, std::abs(series_.value(k, i)) * weight(i, k));
            value_limits_[i] = tolerance_ * size;
            for (std::size_t group = 0; group < series_.groups(); ++group) {
                Eights sizes = none;
                for (int k = 0; k < first_few; ++k)
                    sizes = max(abs(Eights(series_.slope(group, k, i))) * weight(i, k), sizes);
                double least = size;
                for (std::size_t d = 0; d < N; ++d) least = std::max(least, sizes[d]);
                limits_[group * rows() + i] = tolerance_ * max(sizes, Eights(1e-6 * least));
            }
        }
    }
    // Whether the terms of order k are within their limits, or so many times these.
    bool is_small(int k, double times) const {
        const std::size_t states = 2 * tangent_.dof;
        for (std::size_t i = 0; i < rows(); ++i)
            if (std::abs(series_.value(k, i)) * weight(i, k) > times * value_limits_[i]) return false;
        for (std::size_t group = 0; group < series_.groups(); ++group) {
            const std::span limits(limits_.data() + group * rows(), rows());
            if (series_.any_above(group, k, 0, limits.first(states), weight(0, k) / times) ||
                series_.any_above(group, k, states, limits.subspan(states), weight(states, k) / times))
                return false;
        }
        return true;
    }
    // How large the last two terms are beside what they may be, at most.
    double last_terms() const {
        double largest = 0.0;
        const auto take = [&](double term, double limit) {
            if (term > limit) largest = std::max(largest, term / limit);
        };
        for (const int k : {order_ - 1, order_})
            for (std::size_t i = 0; i < rows(); ++i) {
                take(std::abs(series_.value(k, i)) * weight(i, k), value_limits_[i]);
                for (std::size_t group = 0; group < series_.groups(); ++group)
                    for (std::size_t d = 0; d < N; ++d)
                        take(std::abs(series_.slope(group, k, i)[d]) * weight(i, k), limits_[group * rows() + i][d]);
            }
        return largest;
    }

    ContactSet held_;
    Tangent tangent_;
    double tolerance_;
    std::vector<std::uint32_t> variables_;
    SeriesSlopes series_;
    std::vector<double> start_;  // q and v
    Powers powers_{}, rates_{};  // of the step
    std::vector<double> value_limits_;
    std::vector<Eight> limits_;
    int order_ = 0;
};

}  // namespace

std::unique_ptr<FlowSlope> make_flow_slope(const Model& model, ContactSet held, const Tangent& tangent,
                                           std::span<const double> parameters, const std::vector<bool>& varied,
                                           double tolerance) {
    return std::make_unique<FlowSlopeBySeries>(model.motion(held).series, held, tangent, parameters, varied, tolerance);
}

}  // namespace achilles
