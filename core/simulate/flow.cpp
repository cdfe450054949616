#include "simulate/flow.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "simulate/contact_cache.hpp"

namespace achilles {

Flow::Flow(const Model& model, const Run& run, ContactCache& surfaces)
    : stepper_(run.options.method == Method::taylor ? make_taylor(model, run, surfaces)
                                                    : make_dopri5(model, run, surfaces)),
      edges_(model.edges().empty() ? nullptr : std::make_unique<DomainMonitor>(model, run)),
      model_(&model),
      parameters_(surfaces.run().parameters) {}

void Flow::start(Mode mode, const State& state, std::span<const Gap> gaps, double first_step) {
    mode_ = mode;
    t_ = end_ = state.t;
    span_ = 0.0;
    first_ = first_step;
    to_ = state;
    fetched_ = true;
    gaps_.assign(gaps.begin(), gaps.end());
    moved_ = true;
}

// The shortest step (s), half the resolution of time.
double Flow::least() const { return 1e-16 * std::max(1e-3, std::abs(t_)); }

StepFailure Flow::step(double until) {
    t_ = end_;
    span_ = 0.0;
    const double longest = until - t_;
    const State& start = end();
    if (moved_) stepper_->initialize(mode_, start, gaps_);
    moved_ = false;
    StepFailure failure = stepper_->do_step(t_, longest, first_, least());
    first_ = 0.0;
    if (edges_ && failure == StepFailure::none) {
        const double theta = edges_->safe_part(*stepper_, t_);
        const bool is_safe = !(theta < 1.0);
        is_examined_ = is_safe && edges_->has_motion();
        if (!is_safe) failure = stepper_->redo_step(theta * stepper_->current_time(), least());
    }
    if (failure != StepFailure::none) return failure;
    span_ = stepper_->current_time();
    // Avoid rounding past `until`: time never decreases.
    end_ = span_ == longest ? until : std::min(t_ + span_, until);
    fetched_ = false;
    return failure;
}

StepFailure Flow::redo_step(double duration) {
    moved_ = is_examined_ = false;
    const StepFailure failure = stepper_->redo_step(duration, least());
    if (failure != StepFailure::none) return failure;
    span_ = stepper_->current_time();
    end_ = t_ + span_;
    fetched_ = false;
    return failure;
}

State& Flow::edit_end() {
    end();
    moved_ = true;
    return to_;
}

void Flow::move_gap(std::size_t contact, const Gap& gap) {
    gaps_[contact] = gap;
    moved_ = true;
}

void Flow::shift_end(double dt) {
    auto& motion = model_->lazily(motions_, mode_, parameters_);
    set_state(motion, end());
    motion.run();
    for (Eigen::Index i = 0; i < to_.q.size(); ++i) {
        const double a = motion.acceleration(static_cast<std::size_t>(i));
        to_.q[i] += dt * (to_.v[i] + 0.5 * dt * a);
        to_.v[i] += dt * a;
    }
    span_ += dt;
    to_.t = end_ = t_ + span_;
    moved_ = true;
}

DenseSegment Flow::piece(std::vector<double>& coefficients) const {
    DenseSegment piece;
    piece.start = t_;
    piece.end = end_;
    piece.mode = mode_;
    piece.load_bearing = mode_.held();
    piece.first = coefficients.size();
    piece.degree = is_examined_ ? edges_->append_motion(coefficients) : stepper_->coefficients(coefficients);
    if (!moved_) return piece;
    // Corrects the polynomial to end at the projected state.
    const State& moved = end();
    const State& reached = stepper_->current_state();
    const Eigen::Index n = moved.q.size();
    double* const linear = coefficients.data() + piece.first + 2 * n;
    for (Eigen::Index i = 0; i < n; ++i) {
        linear[i] += moved.q[i] - reached.q[i];
        linear[n + i] += moved.v[i] - reached.v[i];
    }
    return piece;
}

WorkIntegrator::WorkIntegrator(const Model& model, const Run& run)
    : any_(model.equations().has_power() || model.has_friction()),
      dof_(model.dof()),
      accurate_(model.has_friction() ? std::max(0x1p-42, run.options.tolerance / 2.0) : 0x1p-42),
      model_(&model) {
    if (any_) parameters_ = run.parameters;
}

EnergyFlow WorkIntegrator::along(const DenseSegment& piece, std::span<const double> coefficients, double to) {
    if (!any_ || !(to > piece.start)) return {};
    Power* const power = power_in(piece.motion());
    if (power == nullptr) return {};
    if (const auto flow = by_series(power->series, piece, coefficients, to)) return *flow;
    const auto integral = [&](std::size_t output) {
        const auto power_at = [&](double t) {
            set_state(power->value, state_in(piece, coefficients, dof_, t));
            power->value.run();
            return power->value.output(output);
        };
        return boost::math::quadrature::gauss<double, 30>::integrate(power_at, piece.start, to);
    };
    return {integral(0), model_->has_friction() ? integral(1) : 0.0};
}

std::optional<EnergyFlow> WorkIntegrator::by_series(SeriesEvaluator<double>& power, const DenseSegment& piece,
                                                    std::span<const double> coefficients, double to) const {
    // Terms decrease at least by half, so those left out are below a fifteenth of the last four.
    constexpr double rounding = 0x1p-53;
    const double span = piece.end - piece.start, theta = std::min(1.0, (to - piece.start) / span);
    static constexpr std::array<double, 2 * max_coordinates> zeros{};
    const std::size_t width = 2 * static_cast<std::size_t>(dof_), outputs = model_->has_friction() ? 2 : 1;
    const double* order = coefficients.data() + piece.first;
    power.begin(order, piece.start, span);
    struct Sum {
        double sum = 0.0, size = 0.0;
        std::array<double, 4> last{};  // terms; symmetry may make three in a row 0
        bool is_below(double part) const { return last[0] + last[1] + last[2] + last[3] <= part * size; }
        void begin(double term) { size = std::abs(sum = term); }
        void add(double term, std::size_t place) {
            sum += term;
            size += last[place] = std::abs(term);
        }
    };
    std::array<Sum, 2> sums{};
    const double* const output[] = {&power.output(0), &power.output(outputs - 1)};  // the same for all orders
    double factor = theta;
    for (std::size_t i = 0; i < outputs; ++i) sums[i].begin(power.start(i) * theta);
    const auto are_below = [&](double part) {
        return sums[0].is_below(part) && (outputs == 1 || sums[1].is_below(part));
    };
    const auto fewest = std::max(static_cast<int>(sums[0].last.size()), static_cast<int>(piece.degree));
    for (int k = 1; k <= SeriesEvaluator<double>::highest_order; ++k) {
        power.extend(k, k <= static_cast<int>(piece.degree) ? order += width : zeros.data());
        factor *= theta;
        const std::size_t place = static_cast<std::size_t>(k) % sums[0].last.size();
        sums[0].add(*output[0] * factor / (k + 1), place);
        if (outputs == 2) sums[1].add(*output[1] * factor / (k + 1), place);
        if (k >= fewest && are_below(rounding)) break;
    }
    if (!are_below(accurate_)) return std::nullopt;
    return EnergyFlow{sums[0].sum * span, sums[1].sum * span};
}

// The power in a mode; null if it is always 0.
WorkIntegrator::Power* WorkIntegrator::power_in(Mode mode) {
    auto known = powers_.find(mode);
    if (known == powers_.end()) {
        const Program& program = model_->power(mode);
        Evaluator<double> value = model_->evaluator(program, parameters_);
        const std::vector<bool> inputs = program.inputs_of(program.output_count());
        bool is_zero = std::none_of(inputs.begin(), inputs.end(), [](bool used) { return used; });
        for (std::size_t i = 0; i < program.output_count(); ++i) is_zero = is_zero && value.output(i) == 0.0;
        known = powers_.emplace(mode, std::nullopt).first;
        if (!is_zero) known->second.emplace(Power{std::move(value), {model_->power_series(mode), parameters_}});
    }
    return known->second ? &*known->second : nullptr;
}

}  // namespace achilles
