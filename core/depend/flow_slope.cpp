#include "depend/flow_slope.hpp"

#include <algorithm>
#include <cmath>

#include "number/directed.hpp"
#include "series/directed_order.hpp"
#include "series/series_over.hpp"

namespace achilles {

namespace {

constexpr int highest = 32;

using Number = Directed<16>;
using Eights = Lanes<16>;
constexpr std::size_t N = Number::directions;

// The series by so many variables of Tangent::variable(), eight at most.
class Part {
 public:
    Part(const SeriesProgram& program, const Tangent& tangent, std::vector<std::size_t> variables,
         std::span<const double> parameters)
        : variables_(std::move(variables)),
          dof_(tangent.dof),
          contacts_(tangent.contacts),
          clock_(tangent.variables() - 1),
          series_(program) {
        std::vector<Number> given;
        for (std::size_t k = 0; k < parameters.size(); ++k) given.push_back(variable(parameters[k], 2 * dof_ + k));
        series_.fix(given);
        state_.resize(2 * dof_);
    }

    void begin(const State& state) {
        for (std::size_t i = 0; i < dof_; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            state_[i] = variable(state.q[k], i);
            state_[dof_ + i] = variable(state.v[k], dof_ + i);
        }
        series_.begin(state_.data(), variable(state.t, clock_));
    }
    void extend(int k) { series_.extend(k); }

    // How large the terms k and k - 1 are after such a time beside the largest of the first few, at most.
    double last_terms(int k, double span, ContactSet held) const {
        constexpr int first = 4;
        double far = 1.0;  // span^(k - 1)
        for (int j = 1; j < k; ++j) far *= span;
        double largest = 0.0;
        for (std::size_t i = 0; i < 2 * dof_ + contacts_; ++i) {
            const bool is_event = i >= 2 * dof_;
            if (is_event && held.contains(i - 2 * dof_)) continue;
            Eights sizes = 0.0, lasts = 0.0;
            double size = 0.0, last = 0.0, power = 1.0;
            const auto take = [&](int j, double to_the_j, Eights& slopes, double& value) {
                const Number& c = series_.coefficient(j, i);
                const double share = is_event ? to_the_j / (j + 1) : to_the_j;  // of its integral
                slopes = max(slopes, abs(c.slope) * share);
                value = std::max(value, std::abs(c.value) * share);
            };
            for (int j = 0; j < std::min(first, k - 1); ++j, power *= span) take(j, power, sizes, size);
            take(k - 1, far, lasts, last);
            take(k, far * span, lasts, last);
            if (last > 0.0) largest = std::max(largest, last / std::max(size, last));
            // What is so much smaller than the other directions' is rounding, or comes late.
            double least = size;
            for (std::size_t d = 0; d < variables_.size(); ++d) least = std::max(least, sizes[d]);
            const Eights share = lasts / max(sizes, Eights(1e-6 * least));  // no number where both are 0
            for (std::size_t d = 0; d < variables_.size(); ++d)
                if (lasts[d] > 0.0) largest = std::max(largest, std::min(share[d], 1.0));
        }
        return largest;
    }
    double coefficient(int k, std::size_t i) const { return series_.coefficient(k, i).value; }

    void slope_after(int order, double span, ContactSet held, const Tangent& tangent, Eigen::MatrixXd& S) const {
        for (std::size_t i = 0; i < 2 * dof_; ++i) {
            Eights sum = series_.coefficient(order, i).slope;
            for (int k = order - 1; k >= 0; --k) sum = sum * span + series_.coefficient(k, i).slope;
            put(sum, tangent.q(i), tangent, S);
        }
        for (std::size_t contact = 0; contact < contacts_; ++contact) {
            if (held.contains(contact)) continue;
            // u' = hddot, h' = u: the integrals of the series.
            Eights u = 0.0, h = 0.0;
            for (int k = order; k >= 0; --k) {
                const Eights& c = series_.coefficient(k, 2 * dof_ + contact).slope;
                const double once = 1.0 / (k + 1), twice = once / (k + 2);
                u = u * span + c * once;
                h = h * span + c * twice;
            }
            put(u * span, tangent.u(contact), tangent, S);
            put(h * (span * span), tangent.h(contact), tangent, S);
        }
    }

 private:
    Number variable(double x, std::size_t k) const {
        const auto found = std::find(variables_.begin(), variables_.end(), k);
        return found == variables_.end() ? Number(x)
                                         : Number::variable(x, static_cast<std::size_t>(found - variables_.begin()));
    }
    void put(const Eights& slope, Eigen::Index row, const Tangent& tangent, Eigen::MatrixXd& S) const {
        for (std::size_t d = 0; d < variables_.size(); ++d) S(row, tangent.variable(variables_[d])) = slope[d];
    }

    std::vector<std::size_t> variables_;
    std::size_t dof_, contacts_, clock_;
    SeriesOver<Number> series_;
    std::vector<Number> state_;
};

class FlowSlopeOfParts : public FlowSlope {
 public:
    FlowSlopeOfParts(const Model& model, ContactSet held, const Tangent& tangent, std::span<const double> parameters,
                     const std::vector<bool>& varied, double tolerance)
        : held_(held), tangent_(tangent), tolerance_(tolerance) {
        const SeriesProgram& program = model.hddot_series(held);
        std::vector<std::size_t> variables;
        for (std::size_t k = 0; k < tangent.variables(); ++k) {
            const bool is_clock = k + 1 == tangent.variables();
            const std::uint32_t slot =
                is_clock ? model.layout().t() : static_cast<std::uint32_t>(k);  // q, v, then the parameters
            const bool is_state = k < 2 * tangent.dof;
            const bool is_still = !is_state && !is_clock && !varied.empty() && !varied[k - 2 * tangent.dof];
            if (is_state || (!is_still && program.depends_on(slot))) variables.push_back(k);
        }
        for (std::size_t first = 0; first < variables.size(); first += N) {
            const auto begin = variables.begin() + static_cast<std::ptrdiff_t>(first);
            const auto count = static_cast<std::ptrdiff_t>(std::min(N, variables.size() - first));
            parts_.push_back(std::make_unique<Part>(program, tangent, std::vector(begin, begin + count), parameters));
        }
    }

    double expand(const State& state, double length, int least_order) override {
        for (const auto& part : parts_) part->begin(state);
        order_ = 0;
        double excess = 0.0;
        const int least = std::clamp(least_order, 2, highest);
        while (order_ < highest) {
            ++order_;
            for (const auto& part : parts_) part->extend(order_);
            if (order_ < least) continue;
            excess = last_terms(length);
            if (excess <= tolerance_) return length;
        }
        // Shorter, then: the last terms fall at least so fast. No shorter than steps of the run could be wrong by.
        const double least_length = 1e-3 * length;
        while (!(excess <= tolerance_) && length > least_length) {
            length *= std::isfinite(excess) ? std::clamp(std::pow(tolerance_ / excess, 1.0 / (highest - 1)), 0.05, 0.9)
                                            : 0.05;
            excess = last_terms(length);
        }
        return length;
    }
    int order() const override { return order_; }
    double coefficient(int k, std::size_t i) const override { return parts_.front()->coefficient(k, i); }

    void slope_after(double span, ContactSet held, Eigen::MatrixXd& S) const override {
        for (const auto& part : parts_) part->slope_after(order_, span, held, tangent_, S);
        for (std::size_t contact = 0; contact < tangent_.contacts; ++contact) {
            if (held.contains(contact)) continue;
            S(tangent_.h(contact), tangent_.h(contact)) = S(tangent_.u(contact), tangent_.u(contact)) = 1.0;
            S(tangent_.h(contact), tangent_.u(contact)) = span;
        }
    }

 private:
    double last_terms(double length) const {
        double largest = 0.0;
        for (const auto& part : parts_) largest = std::max(largest, part->last_terms(order_, length, held_));
        return largest;
    }

    ContactSet held_;
    Tangent tangent_;
    double tolerance_;
    std::vector<std::unique_ptr<Part>> parts_;
    int order_ = 0;
};

}  // namespace

std::unique_ptr<FlowSlope> make_flow_slope(const Model& model, ContactSet held, const Tangent& tangent,
                                           std::span<const double> parameters, const std::vector<bool>& varied,
                                           double tolerance) {
    return std::make_unique<FlowSlopeOfParts>(model, held, tangent, parameters, varied, tolerance);
}

}  // namespace achilles
