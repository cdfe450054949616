#include "simulate/taylor_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace achilles {

namespace {

constexpr double longest_near = 0x1p29;  // s; up to here no power overflows

// The sums of the even and the odd terms.
TermSizes<double> sizes_of(const Polynomial& p) {
    using Pack2 = Pack<double, 2>;
    Pack2::Value sums{};
    const auto last = static_cast<std::size_t>(p.degree);
    for (std::size_t k = 1; k <= last; k += Pack2::count) sums += Pack2::size(Pack2::load(&p.c[k - 1]));
    if (last % 2 == 0) sums[0] += std::abs(p.c[last]);
    return {sums[0] + sums[1], std::abs(p.c[last]) + std::abs(p.c[last - 1])};
}

}  // namespace

TaylorStepper::TaylorStepper(const Model& model, const Run& run, ContactCache& surfaces)
    : dof_(static_cast<std::size_t>(model.dof())),
      tolerance_(std::max(run.options.tolerance, unit_roundoff)),
      model_(&model),
      parameters_(surfaces.run().parameters),
      step_(dof_, model.contacts(), tolerance_),
      gap_units_(model, run, surfaces) {}

void TaylorStepper::initialize(Mode mode, const State& state, std::span<const Gap> gaps) {
    if (motion_ == nullptr || mode != mode_) {
        auto known = motions_.find(mode);
        if (known == motions_.end()) {
            const ModeDynamics& motion = model_->motion(mode);
            const SeriesProgram& series = motion.series;
            known =
                motions_
                    .emplace(
                        mode,
                        MotionExpansion{
                            {series, parameters_}, {series, tolerance_}, motion.friction, motion.guards, motion.powers})
                    .first;
        }
        motion_ = &known->second;
        mode_ = mode;
        step_.set_further_events(motion_->further_events(), motion_->powers);
    }
    const std::vector<double>& units = gap_units_.at(state);
    for (std::size_t i = 0; i < units.size(); ++i) step_.gap_unit(i) = units[i];
    for (std::size_t k = 0; k < motion_->friction.size(); ++k)
        step_.gap_unit(units.size() + k) = gap_units_[motion_->friction[k]];
    for (std::size_t k = 0; k < motion_->guards; ++k)
        step_.gap_unit(units.size() + motion_->friction.size() + k) = gap_units_.of_guard(k);
    for (std::size_t i = 0; i < gaps.size(); ++i) step_.gap(i) = gaps[i];
    to_ = state;
    evaluated_ = true;
}

// Expands the series at the current state to the required order.
StepFailure TaylorStepper::expand(double longest) {
    ++evaluations_;
    current_state();
    double* const from = step_.row(0);
    for (std::size_t i = 0; i < dof_; ++i) {
        from[i] = to_.q.data()[i];
        from[dof_ + i] = to_.v.data()[i];
    }
    const auto start = step_.expand(motion_->series, motion_->order, mode_, longest);
    if (!start.numbers) return StepFailure::not_a_number;
    return start.regular && step_.order() > 0 ? StepFailure::none : StepFailure::left_the_domain;
}

void TaylorStepper::evaluate(double duration) {
    span_ = duration;
    evaluated_ = true;
    if (duration > longest_near) return evaluate_far(duration);
    std::array<double, 2 * max_coordinates> reached;
    step_.evaluate(duration, reached.data());
    std::copy_n(reached.data(), dof_, to_.q.data());
    std::copy_n(reached.data() + dof_, dof_, to_.v.data());
}

StepFailure TaylorStepper::do_step(double time, double longest, double, double least) {
    step_.time() = time;
    if (const StepFailure failure = expand(longest); failure != StepFailure::none) return failure;
    const double step = std::min(longest, motion_->order.natural_step(step_));
    if (!(step > least)) return StepFailure::step_too_small;
    span_ = step > longest_near ? within_numbers(step) : step;
    if (span_ == 0.0) return StepFailure::not_a_number;
    evaluated_ = false;
    return StepFailure::none;
}

// The end of a step is evaluated on demand, because the step may be repeated with another length.
const State& TaylorStepper::current_state() {
    if (!evaluated_) evaluate(span_);
    return to_;
}

// Row k times t^k if the power may overflow: 0 times infinity must give 0.
double TaylorStepper::far_term(int k, std::size_t component, double t) const {
    const double c = step_.row(k)[component];
    return c == 0.0 ? 0.0 : c * std::pow(t, k);
}

void TaylorStepper::evaluate_far(double duration) {
    const auto sum = [&](std::size_t component) {
        double value = 0.0;
        for (int k = step_.order(); k >= 0; --k) value += far_term(k, component, duration);
        return value;
    };
    for (std::size_t i = 0; i < dof_; ++i) {
        to_.q.data()[i] = sum(i);
        to_.v.data()[i] = sum(dof_ + i);
    }
}

// The sums are as accurate as the motion: terms decrease at least by half, so those left out are below the last two.
std::optional<EnergyFlow> TaylorStepper::energy_flow() const {
    if (motion_->powers == 0 || span_ > longest_near) return std::nullopt;
    std::array<double, 2> flow{};
    const int order = step_.order();
    for (std::size_t i = 0; i < motion_->powers; ++i) {
        const std::size_t event = step_.contacts() - motion_->powers + i;
        double power = span_, size = 0.0, last = 0.0, before = 0.0;
        for (int k = 0; k <= order; ++k, power *= span_) {
            const double term = step_.event(event, k) * power / (k + 1);
            flow[i] += term;
            before = std::exchange(last, std::abs(term));
            size += last;
        }
        if (last + before > 0.5 * tolerance_ * size) return std::nullopt;
    }
    return EnergyFlow{flow[0], flow[1]};
}

// Limits the length of a very long step, which only a nearly straight motion has, so that the state stays in the range
// that expand() accepts. Returns 0 if the state is near the end of that range already at the start of the step.
double TaylorStepper::within_numbers(double step) {
    constexpr double shorter = 0x1p-8;
    const auto size_at = [&](double t) {
        double sum = 0.0;
        for (int k = 0; k <= step_.order(); ++k)
            for (std::size_t i = 0; i < step_.width(); ++i) sum += std::abs(far_term(k, i, t));
        return sum;
    };
    const bool is_at_the_end = size_at(0.0) > 0.5 * shorter * largest_state;
    while (step > longest_near && !(size_at(step) < largest_state)) step = is_at_the_end ? 0.0 : shorter * step;
    return step;
}

StepFailure TaylorStepper::redo_step(double duration, double least) {
    if (!(duration > least)) return StepFailure::step_too_small;
    evaluate(duration);
    return StepFailure::none;
}

void TaylorStepper::event_function(std::size_t contact, Polynomial& p) const {
    p.degree = step_.order();
    if (span_ > longest_near) {
        for (int k = 0; k <= p.degree; ++k) p.c[static_cast<std::size_t>(k)] = far_term(k, 2 * dof_ + contact, span_);
    } else {
        step_.event_terms(contact, span_, p.c.data());
    }
}

std::uint32_t TaylorStepper::coefficients(std::vector<double>& coefficients) const {
    const std::size_t block = 2 * dof_;
    int degree = step_.order();
    while (degree > 1 && std::all_of(step_.row(degree), step_.row(degree) + block, [](double x) { return x == 0.0; }))
        --degree;
    const std::size_t first = coefficients.size();
    coefficients.resize(first + static_cast<std::size_t>(degree + 1) * block);
    double* to = coefficients.data() + first;
    const double* c = step_.row(0);
    using Pack2 = Pack<double, 2>;  // the number of components is even
    double power = 1.0;
    for (int k = 0; k <= degree; ++k, c += step_.width(), to += block, power *= span_)
        for (std::size_t i = 0; i < block; i += Pack2::count) Pack2::store(Pack2::load(c + i) * power, to + i);
    return static_cast<std::uint32_t>(degree);
}

std::optional<Stepper::TimeSeries> TaylorStepper::time_series() const {
    if (span_ > longest_near) return std::nullopt;
    return TimeSeries{step_.row(0), step_.width(), step_.order()};
}

double TaylorStepper::remainder(std::size_t contact, const Polynomial& p) const {
    return step_.doubt(contact, span_, sizes_of(p)).remainder();
}

void TaylorStepper::add_error(std::size_t contact, const Polynomial& p, Gap& end) const {
    const TermSizes<double> sizes = sizes_of(p);
    step_.add_error(contact, span_, sizes, step_.doubt(contact, span_, sizes), end);
}

// See Stepper. Uses the terms at the end of the step, without forming the polynomial.
bool TaylorStepper::stays_negative(std::size_t contact) const {
    const double span = span_, *c = &step_.event(contact, 0);
    double power = 1.0;
    return step_.stays_negative(contact, span, [&, width = step_.width()](int k) {
        if (k > 0) {
            power *= span;
            c += width;
        }
        return *c * power;
    });
}

std::unique_ptr<Stepper> make_taylor(const Model& model, const Run& run, ContactCache& surfaces) {
    return std::make_unique<TaylorStepper>(model, run, surfaces);
}

}  // namespace achilles
