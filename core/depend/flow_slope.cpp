#include "depend/flow_slope.hpp"

#include <algorithm>
#include <cmath>

#include "series/series_over.hpp"

namespace achilles {

namespace {

constexpr int highest = 32;

// Some of the directions.
class Part {
 public:
    virtual ~Part() = default;
    virtual void begin(const State& state) = 0;
    virtual void extend(int k) = 0;
    // How large the terms k and k - 1 are after such a time beside what they are a part of, at most.
    virtual double last_terms(int k, double span, ContactSet held) const = 0;
    virtual double coefficient(int k, std::size_t i) const = 0;
    virtual void slope_after(int order, double span, ContactSet held, const Tangent& tangent,
                             Eigen::MatrixXd& S) const = 0;
};

template <std::size_t N>
class PartOver : public Part {
    using Number = Jet<double, N>;

 public:
    PartOver(const SeriesProgram& program, const Tangent& tangent, std::vector<std::size_t> variables,
             std::span<const double> parameters)
        : variables_(std::move(variables)), dof_(tangent.dof), contacts_(tangent.contacts), series_(program) {
        std::vector<Number> given;
        for (std::size_t k = 0; k < parameters.size(); ++k) given.push_back(variable(parameters[k], 2 * dof_ + k));
        clock_ = tangent.variables() - 1;
        series_.fix(given);
        state_.resize(2 * dof_);
    }

    void begin(const State& state) override {
        for (std::size_t i = 0; i < dof_; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            state_[i] = variable(state.q[k], i);
            state_[dof_ + i] = variable(state.v[k], dof_ + i);
        }
        series_.begin(state_.data(), variable(state.t, clock_));
    }
    void extend(int k) override { series_.extend(k); }

    double last_terms(int k, double span, ContactSet held) const override {
        double largest = 0.0;
        for (std::size_t i = 0; i < 2 * dof_ + contacts_; ++i) {
            const bool is_event = i >= 2 * dof_;
            if (is_event && held.contains(i - 2 * dof_)) continue;
            std::array<double, N + 1> size{}, last{};
            double power = 1.0;
            for (int j = 0; j <= k; ++j, power *= span) {
                const Number& c = series_.coefficient(j, i);
                const double share = is_event ? power / (j + 1) : power;  // of its integral
                for (std::size_t d = 0; d <= N; ++d) {
                    const double term = std::abs(d < N ? c.slope[d] : c.value) * share;
                    size[d] = std::max(size[d], term);
                    if (j >= k - 1) last[d] = std::max(last[d], term);
                }
            }
            for (std::size_t d = 0; d <= N; ++d)
                if (last[d] > 0.0) largest = std::max(largest, last[d] / size[d]);
        }
        return largest;
    }
    double coefficient(int k, std::size_t i) const override { return series_.coefficient(k, i).value; }

    void slope_after(int order, double span, ContactSet held, const Tangent& tangent,
                     Eigen::MatrixXd& S) const override {
        for (std::size_t i = 0; i < 2 * dof_; ++i) {
            std::array<double, N> sum = series_.coefficient(order, i).slope;
            for (int k = order - 1; k >= 0; --k) {
                const std::array<double, N>& c = series_.coefficient(k, i).slope;
                for (std::size_t d = 0; d < N; ++d) sum[d] = sum[d] * span + c[d];
            }
            put(sum, tangent.q(i), tangent, S);
        }
        for (std::size_t contact = 0; contact < contacts_; ++contact) {
            if (held.contains(contact)) continue;
            // u' = hddot, h' = u: the integrals of the series.
            std::array<double, N> u{}, h{};
            for (int k = order; k >= 0; --k) {
                const std::array<double, N>& c = series_.coefficient(k, 2 * dof_ + contact).slope;
                const double once = 1.0 / (k + 1), twice = once / (k + 2);
                for (std::size_t d = 0; d < N; ++d) {
                    u[d] = u[d] * span + c[d] * once;
                    h[d] = h[d] * span + c[d] * twice;
                }
            }
            for (std::size_t d = 0; d < N; ++d) {
                u[d] *= span;
                h[d] *= span * span;
            }
            put(u, tangent.u(contact), tangent, S);
            put(h, tangent.h(contact), tangent, S);
        }
    }

 private:
    Number variable(double x, std::size_t k) const {
        const auto found = std::find(variables_.begin(), variables_.end(), k);
        return found == variables_.end() ? Number(x)
                                         : Number::variable(x, static_cast<std::size_t>(found - variables_.begin()));
    }
    void put(const std::array<double, N>& slope, Eigen::Index row, const Tangent& tangent, Eigen::MatrixXd& S) const {
        for (std::size_t d = 0; d < variables_.size(); ++d) S(row, tangent.variable(variables_[d])) = slope[d];
    }

    std::vector<std::size_t> variables_;  // of Tangent::variable()
    std::size_t dof_, contacts_, clock_ = 0;
    SeriesOver<Number> series_;
    std::vector<Number> state_;
};

std::unique_ptr<Part> make_part(const SeriesProgram& program, const Tangent& tangent,
                                std::vector<std::size_t> variables, std::span<const double> parameters) {
    const auto make = [&]<std::size_t N>() -> std::unique_ptr<Part> {
        return std::make_unique<PartOver<N>>(program, tangent, std::move(variables), parameters);
    };
    const std::size_t count = variables.size();
    if (count <= 4) return make.template operator()<4>();
    if (count <= 6) return make.template operator()<6>();
    if (count <= 8) return make.template operator()<8>();
    if (count <= 10) return make.template operator()<10>();
    if (count <= 12) return make.template operator()<12>();
    return make.template operator()<16>();
}

class FlowSlopeOfParts : public FlowSlope {
 public:
    FlowSlopeOfParts(const Model& model, ContactSet held, const Tangent& tangent, std::span<const double> parameters,
                     double tolerance)
        : held_(held), tangent_(tangent), tolerance_(tolerance) {
        const SeriesProgram& program = model.hddot_series(held);
        std::vector<std::size_t> variables;
        for (std::size_t k = 0; k < tangent.variables(); ++k) {
            const bool is_clock = k + 1 == tangent.variables();
            const std::uint32_t slot =
                is_clock ? model.layout().t() : static_cast<std::uint32_t>(k);  // q, v, then the parameters
            if (k < 2 * tangent.dof || program.depends_on(slot)) variables.push_back(k);
        }
        constexpr std::size_t most = 16;
        for (std::size_t first = 0; first < variables.size(); first += most) {
            const auto begin = variables.begin() + static_cast<std::ptrdiff_t>(first);
            const std::size_t count = std::min(most, variables.size() - first);
            parts_.push_back(
                make_part(program, tangent, {begin, begin + static_cast<std::ptrdiff_t>(count)}, parameters));
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
        // Shorter, then: the last terms fall at least so fast.
        for (int round = 0; round < 60; ++round) {
            length *= std::isfinite(excess) ? std::clamp(std::pow(tolerance_ / excess, 1.0 / (highest - 1)), 0.05, 0.9)
                                            : 0.05;
            excess = last_terms(length);
            if (excess <= tolerance_) break;
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
                                           std::span<const double> parameters, double tolerance) {
    return std::make_unique<FlowSlopeOfParts>(model, held, tangent, parameters, tolerance);
}

}  // namespace achilles
