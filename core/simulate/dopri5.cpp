// The Runge-Kutta method of order 5 by Dormand and Prince, with dense output of order 4, from Boost.Odeint.
//
// The event functions are integrated with the motion under the same error control. For an open contact it is the gap
// (h, hdot with (h, hdot)' = (hdot, hddot)), for a held one hddot (with rate h'''). Steps are therefore as short as
// these functions require, and the gap after an impact is an increment from zero instead of a difference of large
// numbers (theory.md 9.3). While a gap surely stays open it is not needed that exactly, because the next step starts
// from h(q) again; steps are longer then.
//
// Odeint tries a step and controls its length. This file keeps the two ends with their rates, which determine the dense
// output together with Odeint's value in the middle of the step.
#include <algorithm>
#include <boost/numeric/odeint/algebra/default_operations.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/util/is_resizeable.hpp>
#include <cmath>
#include <limits>

#include "contacts/contact_law.hpp"
#include "number/inner_loops.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

namespace {

namespace odeint = boost::numeric::odeint;
// q, v, then for each contact its event function in units of GapUnits: h, hdot of a gap; hddot, 0 of a force.
// Their number is even.
using Values = std::vector<double>;
using Pair = Pack<double, 2>;

// The loops of Odeint over the components, a pair at a time: each operation on a pair is one vector instruction.
struct PairAlgebra {
    // The places of the numbers are arguments, so that they stay in registers in the loop.
    template <class Operation, class... From>
    static void apply(double* to, std::size_t width, const Operation& operation, const From*... from) {
        for (std::size_t i = 0; i < width; i += Pair::count) {
            Pair::Value value;
            operation(value, Pair::load(from + i)...);
            Pair::store(value, to + i);
        }
    }
    // The names and arguments that Odeint requires.
    template <class Operation>
    static void for_each3(Values& to, const Values& a, const Values& b, Operation operation) {
        apply(to.data(), to.size(), operation, a.data(), b.data());
    }
    template <class Operation>
    static void for_each4(Values& to, const Values& a, const Values& b, const Values& c, Operation operation) {
        apply(to.data(), to.size(), operation, a.data(), b.data(), c.data());
    }
    template <class Operation>
    static void for_each5(Values& to, const Values& a, const Values& b, const Values& c, const Values& d,
                          Operation operation) {
        apply(to.data(), to.size(), operation, a.data(), b.data(), c.data(), d.data());
    }
    template <class Operation>
    static void for_each6(Values& to, const Values& a, const Values& b, const Values& c, const Values& d,
                          const Values& e, Operation operation) {
        apply(to.data(), to.size(), operation, a.data(), b.data(), c.data(), d.data(), e.data());
    }
    template <class Operation>
    static void for_each7(Values& to, const Values& a, const Values& b, const Values& c, const Values& d,
                          const Values& e, const Values& f, Operation operation) {
        apply(to.data(), to.size(), operation, a.data(), b.data(), c.data(), d.data(), e.data(), f.data());
    }
    template <class Operation>
    static void for_each8(Values& to, const Values& a, const Values& b, const Values& c, const Values& d,
                          const Values& e, const Values& f, const Values& g, Operation operation) {
        apply(to.data(), to.size(), operation, a.data(), b.data(), c.data(), d.data(), e.data(), f.data(), g.data());
    }
};

// One end of a step, with the rates there.
struct StepEnd {
    Values y, dydt;
};

// Components that close at 0, each followed by its rate. While such a gap stays above 0 along a step, it is not needed
// to the tolerance: its error may be a part of a lower bound of it.
struct GapComponents {
    // Far below 1, because the dense output is less accurate than the end of a step.
    static constexpr double tolerated_part = 0x1p-10;
    std::vector<std::size_t> indices;
    Values tolerated;  // the errors tolerated along the last step, of all components

    // The lower bound of a gap is that of the cubic with the values and rates at both ends, by its Bernstein
    // coefficients.
    void tolerate_errors(const Values& y, const Values& end, double dt) {
        const double third = dt / 3.0;
        for (const std::size_t i : indices) {
            const double lowest =
                std::min(std::min(y[i], y[i] + third * y[i + 1]), std::min(end[i], end[i] - third * end[i + 1]));
            tolerated[i] = lowest > 0.0 ? tolerated_part * lowest : 0.0;
            tolerated[i + 1] = tolerated[i] / dt;
        }
    }
};

// The largest error of a component, relative to the tolerance times 1 + |y| + |dt y'|, which is the measure of Odeint's
// default checker, and the tolerated error of a gap. Odeint asks it when the end of the step is known.
class ErrorChecker {
 public:
    ErrorChecker(double tolerance, const StepEnd& end, GapComponents& gaps)
        : tolerance_(tolerance), end_(&end), gaps_(&gaps) {}
    double error(const PairAlgebra&, const Values& y, const Values& dydt, const Values& error, double dt) const {
        gaps_->tolerate_errors(y, end_->y, dt);
        Pair::Value largest{};
        for (std::size_t i = 0; i < y.size(); i += Pair::count) {
            const Pair::Value size = size_of(Pair::load(&y[i])) + std::abs(dt) * size_of(Pair::load(&dydt[i]));
            const Pair::Value allowed = tolerance_ + tolerance_ * size + Pair::load(&gaps_->tolerated[i]);
            const Pair::Value part = size_of(Pair::load(&error[i])) / allowed;
            largest = largest < part ? part : largest;
        }
        return std::max(largest[0], largest[1]);
    }

 private:
    static Pair::Value size_of(const Pair::Value& x) { return x < 0.0 ? -x : x; }
    double tolerance_;
    const StepEnd* end_;
    GapComponents* gaps_;
};

using Dopri5Method =
    odeint::runge_kutta_dopri5<Values, double, Values, double, PairAlgebra, odeint::default_operations>;
using ControlledDopri5 = odeint::controlled_runge_kutta<Dopri5Method, ErrorChecker>;

bool is_finite(const Values& values) {
    Pair::Value sum{};  // 0 times infinity is NaN
    for (std::size_t i = 0; i < values.size(); i += Pair::count) sum += 0.0 * Pair::load(&values[i]);
    return sum[0] + sum[1] == 0.0;
}

// Outputs of the motion for a coordinate.
struct CoordinateOutputs {
    const double *acceleration = nullptr, *pivot = nullptr;
};

// The rate of an event function: an output of the motion, hddot of a gap or h''' of a force.
struct EventRate {
    const double* output = nullptr;
    bool is_of_gap = true;
    double unit = 1.0, per_unit = 1.0;  // exact: units are powers of two
};

class Dopri5 : public Stepper {
 public:
    Dopri5(const Model& model, const Run& run, ContactCache& surfaces)
        : dof_(static_cast<std::size_t>(model.dof())),
          tolerance_(run.options.tolerance),
          method_(ErrorChecker(tolerance_, to_, gap_components_)),
          model_(&model),
          parameters_(surfaces.run().parameters),
          coordinates_(dof_),
          contacts_(model.contacts()),
          units_(model, run, surfaces) {}

    void initialize(Mode mode, const State& state, std::span<const Gap> gaps) override;
    StepFailure do_step(double time, double longest, double first, double least) override;
    StepFailure redo_step(double duration, double least) override;
    double current_time() const override { return span_; }
    const State& current_state() override { return end_; }
    void event_function(std::size_t contact, Polynomial& p) const override;
    std::uint32_t coefficients(std::vector<double>& coefficients) const override;
    bool stays_negative(std::size_t contact) const override;
    bool stays_positive(std::size_t contact) const override;
    double remainder(std::size_t contact, const Polynomial& p) const override;
    void add_error(std::size_t contact, const Polynomial& p, Gap& end) const override;
    bool is_expansion() const override { return false; }
    long evaluations() const override { return evaluations_; }

 private:
    void choose_mode(Mode mode, std::size_t functions);
    void evaluate_motion(const Values& y, double time);
    void set_rates(const Values& y, Values& dydt) const;
    void begin_step();
    double first_step() const;
    StepFailure advance(double dt, double least);
    StepFailure try_step(double dt);
    StepFailure failure_here() const;
    std::array<Pair::Value, 5> terms(std::size_t first) const;
    double own_remainder(std::size_t contact, const Polynomial& p, double tolerated) const;
    double hddot_error(std::size_t contact, const Polynomial& p) const;
    double earlier_error(std::size_t contact, double hddot_error) const;
    bool watches_gap(std::size_t contact) const {
        return contact < contacts_ && law_of(mode_.state(contact)).watched == WatchedFunction::gap;
    }
    bool is_gap(std::size_t contact) const { return event_rates_[contact].is_of_gap; }
    double unit(std::size_t contact) const { return event_rates_[contact].unit; }
    std::size_t event(std::size_t contact) const { return 2 * dof_ + 2 * contact; }  // index of its event function
    std::size_t width() const { return event(gaps_.size()); }

    std::size_t dof_;
    double tolerance_;
    ControlledDopri5 method_;
    const Model* model_;
    std::span<const double> parameters_;
    Mode mode_;
    Model::MotionEvaluators motions_;                   // by mode, created at first use
    MotionTerms<Evaluator<double>>* motion_ = nullptr;  // the entry of mode_
    bool is_evaluated_ = false;                         // motion_ has outputs for its inputs
    std::vector<CoordinateOutputs> coordinates_;
    std::size_t contacts_;
    std::span<const FrictionEvent> friction_;  // the event functions after those of the contacts
    std::vector<EventRate> event_rates_;       // for each event function
    double span_ = 0.0;
    double natural_ = 0.0;   // length of the next step by the error control; 0: unknown
    double next_ = 0.0;      // the same after the last step, if its length is by the error control
    double time_ = 0.0;      // s, start of the step
    std::vector<Gap> gaps_;  // at the start of the step, for each event function
    GapUnits units_;
    StepEnd from_, to_;             // ends of the step
    GapComponents gap_components_;  // where the gaps stand in y
    State end_;                     // the state of to_, or where the next step starts
    bool is_continued_ = false;     // the next step starts at to_
    Values middle_;                 // in the middle of the step
    long evaluations_ = 0;
};

void Dopri5::choose_mode(Mode mode, std::size_t functions) {
    mode_ = mode;
    if (functions != gaps_.size() || motion_ == nullptr) {
        gaps_.resize(functions);
        event_rates_.resize(functions);
        for (Values* values : {&from_.y, &from_.dydt, &to_.y, &to_.dydt, &middle_, &gap_components_.tolerated})
            values->resize(width());
        // Its buffers have the size of the first state.
        method_ = ControlledDopri5(ErrorChecker(tolerance_, to_, gap_components_));
    }
    motion_ = &model_->lazily(motions_, mode, parameters_);
    if (functions > contacts_) friction_ = model_->motion(mode).friction;
    is_evaluated_ = false;
    for (std::size_t i = 0; i < dof_; ++i) coordinates_[i] = {&motion_->acceleration(i), &motion_->pivot(i)};
    gap_components_.indices.clear();
    std::fill(gap_components_.tolerated.begin(), gap_components_.tolerated.end(), 0.0);
    for (std::size_t contact = 0, forces = 0; contact < gaps_.size(); ++contact) {
        if (watches_gap(contact)) {
            event_rates_[contact] = {&motion_->hddot(contact), true};
            gap_components_.indices.push_back(event(contact));
        } else {
            event_rates_[contact] = {&motion_->jerk(forces++), false};
        }
    }
}

void Dopri5::evaluate_motion(const Values& y, double time) {
    ++evaluations_;
    for (std::size_t i = 0; i < 2 * dof_; i += Pair::count) Pair::store(Pair::load(&y[i]), &motion_->input(i));
    motion_->clock() = time;
    motion_->run();
    is_evaluated_ = true;
}

// y' = (v, f, hdot, hddot) in free flight, (v, f_c, h''', 0) in contact, from the evaluated motion. If M is not
// positive definite, the derivative is NaN and the step fails.
void Dopri5::set_rates(const Values& y, Values& dydt) const {
    const double* from = y.data();
    double* to = dydt.data();
    bool is_regular = true;
    for (std::size_t i = 0; i < dof_; ++i) {
        to[i] = from[dof_ + i];
        to[dof_ + i] = *coordinates_[i].acceleration;
        is_regular = is_regular & (*coordinates_[i].pivot > 0.0);
    }
    if (!is_regular) std::fill_n(to + dof_, dof_, std::numeric_limits<double>::quiet_NaN());
    from += 2 * dof_;
    to += 2 * dof_;
    for (const EventRate& rate : event_rates_) {
        const double value = *rate.output * rate.per_unit;
        Pair::store(rate.is_of_gap ? Pair::Value{from[1], value} : Pair::Value{value, 0.0}, to);
        from += 2;
        to += 2;
    }
}

void Dopri5::initialize(Mode mode, const State& state, std::span<const Gap> gaps) {
    if (motion_ == nullptr || mode != mode_) choose_mode(mode, gaps.size());
    end_ = state;
    units_.at(state);
    for (std::size_t contact = 0; contact < event_rates_.size(); ++contact) {
        EventRate& rate = event_rates_[contact];
        const std::size_t further = contact - contacts_;  // if it is not of a contact
        rate.unit = contact < contacts_          ? units_[contact]
                    : further < friction_.size() ? units_[friction_[further]]
                                                 : units_.of_guard(further - friction_.size());
        rate.per_unit = 1.0 / rate.unit;
    }
    gaps_.assign(gaps.begin(), gaps.end());
    is_continued_ = false;
}

// Sets from_. The motion is not evaluated again if its last evaluation, at the end of the step before, was at the same
// state.
void Dopri5::begin_step() {
    Values& y = from_.y;
    for (std::size_t i = 0; i < dof_; ++i) {
        y[i] = end_.q.data()[i];
        y[dof_ + i] = end_.v.data()[i];
    }
    const bool is_known =
        is_evaluated_ && motion_->clock() == time_ && std::equal(y.data(), y.data() + 2 * dof_, &motion_->input(0));
    if (!is_known) evaluate_motion(y, time_);
    for (std::size_t contact = 0; contact < gaps_.size(); ++contact) {
        const EventRate& rate = event_rates_[contact];
        const std::size_t i = event(contact);
        Gap& gap = gaps_[contact];
        if (is_continued_) {
            gap.h = rate.unit * to_.y[i];
            gap.hdot = rate.unit * to_.y[i + 1];
        }
        y[i] = (rate.is_of_gap ? gap.h : motion_->hddot(contact)) * rate.per_unit;
        y[i + 1] = rate.is_of_gap ? gap.hdot * rate.per_unit : 0.0;
    }
    set_rates(y, from_.dydt);
}

// First step of a run: a guess from the first derivative, which the error control corrects.
double Dopri5::first_step() const {
    double size = 1e-3, rate = 1e-3;
    for (std::size_t i = 0; i < 2 * dof_; ++i) {
        size = std::max(size, std::abs(from_.y[i]));
        rate = std::max(rate, std::abs(from_.dydt[i]));
    }
    return std::isfinite(rate) ? size / rate * std::pow(tolerance_, 0.2) : 1e-3;
}

// The reason why no step has a finite result, from the size of the state.
StepFailure Dopri5::failure_here() const {
    for (std::size_t i = 0; i < 2 * dof_; ++i)
        if (!(std::abs(from_.y[i]) < 1e150)) return StepFailure::not_a_number;  // diverges to infinity
    return StepFailure::left_the_domain;
}

// One step that the error control accepts. The result may be infinite or NaN.
StepFailure Dopri5::try_step(double dt) {
    constexpr int most_rejections = 500;
    const auto system = [this](const Values& y, Values& dydt, double passed) {
        evaluate_motion(y, time_ + passed);
        set_rates(y, dydt);
    };
    span_ = 0.0;
    for (int rejections = 0;; ++rejections) {
        if (rejections == most_rejections) return StepFailure::step_too_small;
        if (method_.try_step(system, from_.y, from_.dydt, span_, to_.y, to_.dydt, dt) == odeint::success) break;
    }
    next_ = dt;
    if (!is_finite(to_.y) || !is_finite(to_.dydt)) return StepFailure::not_a_number;
    method_.stepper().calc_state(0.5 * span_, middle_, from_.y, from_.dydt, 0.0, to_.y, to_.dydt, span_);
    std::copy_n(to_.y.data(), dof_, end_.q.data());
    std::copy_n(to_.y.data() + dof_, dof_, end_.v.data());
    is_continued_ = true;
    return StepFailure::none;
}

// Steps from from_ by dt, or less if the error control or the domain requires it.
StepFailure Dopri5::advance(double dt, double least) {
    StepFailure failure = StepFailure::none;
    while (dt > least) {
        failure = try_step(dt);
        if (failure == StepFailure::none) return span_ > least ? StepFailure::none : StepFailure::step_too_small;
        if (failure == StepFailure::step_too_small) return failure;
        dt *= 0.25;
    }
    return failure == StepFailure::none ? StepFailure::step_too_small : failure_here();
}

StepFailure Dopri5::do_step(double time, double longest, double first, double least) {
    time_ = time;
    begin_step();
    if (natural_ == 0.0) natural_ = first_step();
    const double wanted = first > 0.0 ? std::min(first, natural_) : natural_;
    const bool is_shortened = wanted < natural_ || wanted > longest;
    const StepFailure failure = advance(std::min(wanted, longest), least);
    // A step shortened by request gives no information about the step that the error control would allow.
    if (failure == StepFailure::none) natural_ = is_shortened ? std::max(next_, natural_) : next_;
    return failure;
}

StepFailure Dopri5::redo_step(double duration, double least) { return advance(duration, least); }

// The polynomials of two adjacent components in theta, of degree 4, with the values and rates at both ends of the step
// and the value in its middle. In terms of differences from the first value.
std::array<Pair::Value, 5> Dopri5::terms(std::size_t first) const {
    const auto at = [first](const Values& values) { return Pair::load(&values[first]); };
    const auto begin = at(from_.y), rise = at(to_.y) - begin, rate = span_ * at(from_.dydt),
               end_rate = span_ * at(to_.dydt);
    const auto bend = 16.0 * (at(middle_) - begin) - 8.0 * rise - 2.0 * (rate - end_rate);
    return {begin, rate, 3.0 * rise - 2.0 * rate - end_rate + bend, rate + end_rate - 2.0 * (rise + bend), bend};
}

void Dopri5::event_function(std::size_t contact, Polynomial& p) const {
    const auto c = terms(event(contact));
    p.degree = 4;
    for (std::size_t k = 0; k < c.size(); ++k) p.c[k] = unit(contact) * c[k][0];
}

std::uint32_t Dopri5::coefficients(std::vector<double>& coefficients) const {
    const std::size_t first = coefficients.size(), block = 2 * dof_;
    coefficients.resize(first + 5 * block);
    for (std::size_t i = 0; i < block; i += Pair::count) {
        auto c = terms(i);
        c[1] += Pair::load(&to_.y[i]) - (c[0] + (c[1] + (c[2] + (c[3] + c[4]))));  // ends at to_ itself
        for (std::size_t k = 0; k < c.size(); ++k) Pair::store(c[k], &coefficients[first + block * k + i]);
    }
    return 4;
}

// The local error allowed by the error control, with what it tolerates beyond the tolerance, and as much again for the
// dense output, whose order is one less. In a flight much shorter than such a step, at most the highest term kept.
double Dopri5::own_remainder(std::size_t contact, const Polynomial& p, double tolerated) const {
    const double size = std::abs(p.c[0]) + std::abs(p.c[1]) + std::abs(p.c[2]) + std::abs(p.c[3]) + std::abs(p.c[4]);
    const double allowed = 4.0 * (tolerance_ * (unit(contact) + size) + unit(contact) * tolerated);
    return (is_gap(contact) ? std::min(allowed, std::abs(p.c[4])) : allowed) + 8.0 * 0x1p-53 * size;
}

// From the terms of p in theta = t/span: the sizes of hddot and of its rate at the start of the step.
double Dopri5::hddot_error(std::size_t contact, const Polynomial& p) const {
    return gaps_[contact].hddot_error(is_gap(contact)
                                          ? (2.0 * std::abs(p.c[2]) + 6.0 * std::abs(p.c[3]) / span_) / (span_ * span_)
                                          : std::abs(p.c[0]) + std::abs(p.c[1]) / span_,
                                      unit(contact));
}

// The error of the function from that of the state at the start of the step.
double Dopri5::earlier_error(std::size_t contact, double hddot_error) const {
    return is_gap(contact) ? gaps_[contact].error_after(span_, hddot_error) : hddot_error;
}

double Dopri5::remainder(std::size_t contact, const Polynomial& p) const {
    return own_remainder(contact, p, gap_components_.tolerated[event(contact)]) +
           earlier_error(contact, hddot_error(contact, p));
}

// See Stepper. By partial sums (Abel), and by twice the remainder: the function at the end of the step, with which the
// caller would correct the polynomial, differs from it by less than the remainder.
bool Dopri5::stays_negative(std::size_t contact) const {
    Polynomial p;
    event_function(contact, p);
    double sum = 0.0, highest = -std::numeric_limits<double>::infinity();
    for (int k = 0; k <= p.degree; ++k) highest = std::max(highest, sum += p.c[static_cast<std::size_t>(k)]);
    return highest < -2.0 * remainder(contact, p);
}

// GapComponents bounds the cubic with the values and rates at both ends from below. The polynomial differs from this
// cubic by its highest coefficient times (1 - theta)^2 theta^2, and that factor is at most 1/16.
bool Dopri5::stays_positive(std::size_t contact) const {
    const double tolerated = gap_components_.tolerated[event(contact)];
    if (!(tolerated > 0.0)) return false;
    Polynomial p;
    event_function(contact, p);
    return unit(contact) * tolerated / GapComponents::tolerated_part >
           2.0 * remainder(contact, p) + std::abs(p.c[4]) / 16.0;
}

// The errors of the gap and of its rate after a step grow by at most these bounds. What is tolerated along the step
// ends with it.
void Dopri5::add_error(std::size_t contact, const Polynomial& p, Gap& end) const {
    const Gap& gap = gaps_[contact];
    const double own = own_remainder(contact, p, 0.0), hddot = hddot_error(contact, p);
    end.error = earlier_error(contact, hddot) + own;
    end.state_error = gap.state_error;
    end.rate_error =
        gap.rate_error + hddot * span_ + std::min(4.0 * tolerance_ * (unit(contact) + std::abs(end.hdot)), own / span_);
}

}  // namespace

std::unique_ptr<Stepper> make_dopri5(const Model& model, const Run& run, ContactCache& surfaces) {
    return std::make_unique<Dopri5>(model, run, surfaces);
}

}  // namespace achilles
