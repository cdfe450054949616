// The Runge-Kutta method of order 5 by Dormand and Prince, with dense output of order 4, from Boost.Odeint.
//
// The event functions are integrated with the motion under the same error control. For an open contact it is the gap
// (h, hdot with (h, hdot)' = (hdot, hddot)), for a held one hddot (with rate h'''). Steps are therefore as short as
// these functions require, and the gap after an impact is an increment from zero instead of a difference of large
// numbers (theory.md 9.3).
#include <algorithm>

// Must be included first: dense_output_runge_kutta.hpp does not include it.
#include <boost/numeric/odeint/util/unwrap_reference.hpp>

#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>

#include "contacts/contact_law.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

namespace {

namespace odeint = boost::numeric::odeint;
// q, v, then for each contact its event function in units of GapUnits: h, hdot of a gap; hddot, 0 of a force.
using Values = std::vector<double>;
using Dense = odeint::result_of::make_dense_output<odeint::runge_kutta_dopri5<Values>>::type;

bool is_finite(const Values& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

class Dopri5 : public Stepper {
 public:
    Dopri5(const Model& model, const Run& run)
        : dof_(static_cast<std::size_t>(model.dof())),
          tolerance_(run.options.tolerance),
          dense_(odeint::make_dense_output(tolerance_, tolerance_, odeint::runge_kutta_dopri5<Values>())),
          model_(&model),
          parameters_(run.parameters),
          contacts_(model.contacts()),
          gaps_(contacts_),
          units_(model, run) {}

    void initialize(Mode mode, const State& state, std::span<const Gap> gaps) override;
    StepFailure do_step(double time, double longest, double first, double least) override;
    StepFailure redo_step(double duration, double least) override;
    double current_time() const override { return span_; }
    const State& current_state() override { return to_; }
    void event_function(std::size_t contact, Polynomial& p) const override {
        p = component(event(contact));
        for (int k = 0; k <= p.degree; ++k) p.c[static_cast<std::size_t>(k)] *= unit(contact);
    }
    std::uint32_t coefficients(std::vector<double>& coefficients) const override;
    double remainder(std::size_t contact, const Polynomial& p) const override;
    void add_error(std::size_t contact, const Polynomial& p, Gap& end) const override;
    bool is_expansion() const override { return false; }
    long evaluations() const override { return evaluations_; }

 private:
    void derivative(const Values& y, Values& dydt, double passed);
    auto system() {
        return [this](const Values& y, Values& dydt, double passed) { derivative(y, dydt, passed); };
    }
    void guess_first_step();
    void set(double dt);
    StepFailure advance(double dt, double least);
    StepFailure accept();
    StepFailure failure_here() const;
    double own_remainder(std::size_t contact, const Polynomial& p) const;
    double hddot_error(std::size_t contact, const Polynomial& p) const;
    double earlier_error(std::size_t contact, const Polynomial& p) const;
    bool watches_gap(std::size_t contact) const {
        return contact < contacts_ && law_of(mode_.state(contact)).watched == WatchedFunction::gap;
    }
    double unit(std::size_t contact) const { return contact < contacts_ ? units_[contact] : 1.0; }
    std::size_t event(std::size_t contact) const { return 2 * dof_ + 2 * contact; }  // index of its event function
    std::size_t width() const { return event(gaps_.size()); }
    Values values_of(const State& state) const;
    Polynomial component(std::size_t i) const {
        return interpolate({nodes_[0][i], nodes_[1][i], nodes_[2][i], nodes_[3][i], nodes_[4][i]});
    }

    std::size_t dof_;
    double tolerance_;
    Dense dense_;
    const Model* model_;
    std::vector<double> parameters_;
    Mode mode_;
    Model::MotionEvaluators motions_;                   // by mode, created at first use
    MotionTerms<Evaluator<double>>* motion_ = nullptr;  // the entry of mode_
    double span_ = 0.0;
    double natural_ = 0.0;  // length of the next step by the error control; 0: unknown
    State from_, to_;       // the ends of the last step
    double time_ = 0.0;     // s, start of the step
    double begun_ = 0.0;    // the same on Odeint's clock
    std::size_t contacts_;
    std::vector<Gap> gaps_;  // at from_, for each event function
    GapUnits units_;
    bool continuing_ = false;  // Odeint's stepper is at to_, ready for a step of natural_
    std::array<Values, 5> nodes_;
    long evaluations_ = 0;
};

// y' = (v, f, hdot, hddot) in free flight, (v, f_c, h''', 0) in contact; `passed` is Odeint's clock. If M is not
// positive definite, the derivative is NaN and the step fails.
void Dopri5::derivative(const Values& y, Values& dydt, double passed) {
    ++evaluations_;
    MotionTerms<Evaluator<double>>& motion = *motion_;
    for (std::size_t i = 0; i < 2 * dof_; ++i) motion.input(i) = y[i];
    motion.clock() = time_ + (passed - begun_);
    motion.run();
    bool regular = true;
    for (std::size_t i = 0; i < dof_; ++i) regular = regular && motion.pivot(i) > 0.0;
    for (std::size_t i = 0; i < dof_; ++i) {
        dydt[i] = y[dof_ + i];
        dydt[dof_ + i] = regular ? motion.acceleration(i) : std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t contact = 0, forces = 0; contact < gaps_.size(); ++contact) {
        const std::size_t i = event(contact);
        dydt[i] = watches_gap(contact) ? y[i + 1] : motion.jerk(forces++) / unit(contact);
        dydt[i + 1] = watches_gap(contact) ? motion.hddot(contact) / unit(contact) : 0.0;
    }
}

Values Dopri5::values_of(const State& state) const {
    Values y(width(), 0.0);
    for (std::size_t i = 0; i < dof_; ++i) {
        y[i] = state.q[static_cast<Eigen::Index>(i)];
        y[dof_ + i] = state.v[static_cast<Eigen::Index>(i)];
    }
    return y;
}

void Dopri5::initialize(Mode mode, const State& state, std::span<const Gap> gaps) {
    if (motion_ == nullptr || mode != mode_) motion_ = &model_->lazily(motions_, mode, parameters_);
    mode_ = mode;
    to_ = state;
    units_.at(state);
    time_ = state.t;
    begun_ = 0.0;
    // Odeint's buffers have the size of the first state that they see.
    if (gaps.size() != gaps_.size())
        dense_ = odeint::make_dense_output(tolerance_, tolerance_, odeint::runge_kutta_dopri5<Values>());
    gaps_.assign(gaps.begin(), gaps.end());
    continuing_ = false;
    if (natural_ == 0.0) guess_first_step();
}

// First step of a run: a guess from the first derivative, which the error control corrects.
void Dopri5::guess_first_step() {
    Values dydt(width());
    const Values y = values_of(to_);
    derivative(y, dydt, begun_);
    double size = 1e-3, rate = 1e-3;
    for (std::size_t i = 0; i < 2 * dof_; ++i) {
        size = std::max(size, std::abs(y[i]));
        rate = std::max(rate, std::abs(dydt[i]));
    }
    natural_ = std::isfinite(rate) ? size / rate * std::pow(tolerance_, 0.2) : 1e-3;
}

void Dopri5::set(double dt) {
    Values y = values_of(from_);
    if (!(mode_ == Mode())) {  // hddot and the functions of friction at the state itself
        for (std::size_t i = 0; i < 2 * dof_; ++i) motion_->input(i) = y[i];
        motion_->clock() = time_;
        motion_->run();
    }
    for (std::size_t contact = 0; contact < gaps_.size(); ++contact) {
        const std::size_t i = event(contact);
        y[i] = (watches_gap(contact) ? gaps_[contact].h : motion_->hddot(contact)) / unit(contact);
        if (watches_gap(contact)) y[i + 1] = gaps_[contact].hdot / unit(contact);
    }
    dense_.initialize(y, 0.0, dt);
    begun_ = 0.0;
}

// The reason why no step has a finite result, from the size of the state.
StepFailure Dopri5::failure_here() const {
    for (const double y : values_of(from_))
        if (!(std::abs(y) < 1e150)) return StepFailure::not_a_number;  // diverges to infinity
    return StepFailure::left_the_domain;
}

// Reads the last step: dense output at theta = 0, 1/4, 1/2, 3/4, 1, which determines a quartic.
StepFailure Dopri5::accept() {
    const double begin = dense_.previous_time();
    span_ = dense_.current_time() - begin;
    for (std::size_t k = 0; k < 5; ++k) {
        nodes_[k].resize(width());
        if (k == 0) nodes_[k] = dense_.previous_state();
        if (k == 4) nodes_[k] = dense_.current_state();
        if (k > 0 && k < 4) dense_.calc_state(begin + 0.25 * static_cast<double>(k) * span_, nodes_[k]);
        if (!is_finite(nodes_[k])) return StepFailure::not_a_number;
    }
    for (std::size_t i = 0; i < dof_; ++i) {
        to_.q[static_cast<Eigen::Index>(i)] = nodes_[4][i];
        to_.v[static_cast<Eigen::Index>(i)] = nodes_[4][dof_ + i];
    }
    return StepFailure::none;
}

// Steps from `from` by dt, or less if the error control or the domain requires it.
StepFailure Dopri5::advance(double dt, double least) {
    bool finite = true;
    while (dt > least) {
        set(dt);
        try {
            dense_.do_step(system());
        } catch (const odeint::odeint_error&) {  // 500 rejections in a row
            return StepFailure::step_too_small;
        }
        finite = accept() == StepFailure::none;
        if (finite) return span_ > least ? StepFailure::none : StepFailure::step_too_small;
        dt *= 0.25;
    }
    return finite ? StepFailure::step_too_small : failure_here();
}

StepFailure Dopri5::do_step(double time, double longest, double first, double least) {
    time_ = time;
    begun_ = continuing_ ? dense_.current_time() : 0.0;
    const double wanted = first > 0.0 ? std::min(first, natural_) : natural_;
    const bool by_order = wanted < natural_ || wanted > longest;
    for (std::size_t contact = 0; continuing_ && contact < gaps_.size(); ++contact) {
        gaps_[contact].h = unit(contact) * nodes_[4][event(contact)];
        gaps_[contact].hdot = unit(contact) * nodes_[4][event(contact) + 1];
    }
    from_ = to_;
    StepFailure failure = StepFailure::not_a_number;
    if (continuing_ && !by_order) {
        try {
            dense_.do_step(system());
            failure = accept();
        } catch (const odeint::odeint_error&) {
            return StepFailure::step_too_small;
        }
    }
    if (failure != StepFailure::none) failure = advance(std::min(wanted, longest), least);
    if (failure != StepFailure::none) return failure;
    // A step shortened by request gives no information about the step that the error control would allow.
    const double next = dense_.current_time_step();
    natural_ = by_order ? std::max(next, natural_) : next;
    continuing_ = true;
    return failure;
}

StepFailure Dopri5::redo_step(double duration, double least) {
    continuing_ = false;
    return advance(duration, least);
}

std::uint32_t Dopri5::coefficients(std::vector<double>& coefficients) const {
    const std::size_t first = coefficients.size();
    coefficients.resize(first + 10 * dof_);
    for (std::size_t i = 0; i < 2 * dof_; ++i) {
        Polynomial p = component(i);
        p.c[1] += nodes_[4][i] - p(1.0);
        for (std::size_t k = 0; k <= 4; ++k) coefficients[first + 2 * dof_ * k + i] = p.c[k];
    }
    return 4;
}

// The local error allowed by the error control, and as much again for the dense output, whose order is one less. In a
// flight much shorter than such a step, at most the highest term kept.
double Dopri5::own_remainder(std::size_t contact, const Polynomial& p) const {
    double size = 0.0;
    for (int i = 0; i <= p.degree; ++i) size += std::abs(p.c[static_cast<std::size_t>(i)]);
    const double allowed = 4.0 * tolerance_ * (unit(contact) + size);
    return (watches_gap(contact) ? std::min(allowed, std::abs(p.c[4])) : allowed) + 8.0 * 0x1p-53 * size;
}

// From the terms of p in theta = t/span: the sizes of hddot and of its rate at the start of the step.
double Dopri5::hddot_error(std::size_t contact, const Polynomial& p) const {
    return gaps_[contact].hddot_error(watches_gap(contact)
                                          ? (2.0 * std::abs(p.c[2]) + 6.0 * std::abs(p.c[3]) / span_) / (span_ * span_)
                                          : std::abs(p.c[0]) + std::abs(p.c[1]) / span_,
                                      unit(contact));
}

double Dopri5::earlier_error(std::size_t contact, const Polynomial& p) const {
    const double error = hddot_error(contact, p);
    return watches_gap(contact) ? gaps_[contact].error_after(span_, error) : error;
}

double Dopri5::remainder(std::size_t contact, const Polynomial& p) const {
    return own_remainder(contact, p) + earlier_error(contact, p);
}

// The errors of the gap and of its rate after a step grow by at most these bounds.
void Dopri5::add_error(std::size_t contact, const Polynomial& p, Gap& end) const {
    const Gap& gap = gaps_[contact];
    const double own = own_remainder(contact, p);
    end.error = earlier_error(contact, p) + own;
    end.state_error = gap.state_error;
    end.rate_error = gap.rate_error + hddot_error(contact, p) * span_ +
                     std::min(4.0 * tolerance_ * (unit(contact) + std::abs(end.hdot)), own / span_);
}

}  // namespace

std::unique_ptr<Stepper> make_dopri5(const Model& model, const Run& run) {
    return std::make_unique<Dopri5>(model, run);
}

}  // namespace achilles
