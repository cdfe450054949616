// Implementation of lane_stepper.hpp for one vector size: TaylorStep for eight runs, and the test for plain steps.
//
// Included only by the source file of each vector size (lane_kinds.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "number/lanes.hpp"
#include "number/polynomial.hpp"
#include "series/lane_kinds.hpp"
#include "series/lane_stepper.hpp"
#include "series/taylor_step.hpp"

namespace achilles {

// As in ExecutionAutomaton, both relative to the time t: a step shorter than stall |t| does not advance it, and a
// remaining time below end_of_time |t| counts as 0.
inline constexpr double stall = 0x1p-51, end_of_time = 1e-15;

// Order of flights. The work between two steps costs as much as a step, which favors a higher order than the step alone
// would have. A brief flight ends long before the end of such a step.
inline int order_of_flights(const SeriesProgram& flight, double tolerance, double of_best) {
    return std::min(static_cast<int>(of_best * best_order(flight, tolerance, costs_of_eight_runs)),
                    OrderCode::highest_order - 1);
}

template <class Number>
class LaneStepperOver final : public LaneStepper {
    using Mask = Condition<Number>;
    static constexpr std::size_t contact = 0;  // one-contact systems only

 public:
    LaneStepperOver(const LanePrograms& programs, double tolerance, std::optional<Width> machine_code)
        : dof_(programs.coordinates),
          // Most flights end long before the end of a series' step.
          flight_{{programs.flight, LaneCode::of(programs.flight, machine_code)},
                  {order_of_flights(programs.flight, tolerance, 1.2), false}},
          brief_(order_of_flights(programs.flight, tolerance, 0.6), false),
          contact_{{programs.contact, LaneCode::of(programs.contact, machine_code)},
                   {best_order(programs.contact, tolerance, costs_of_eight_runs), true}},
          contact_terms_(ProgramOver<Number>(programs.contact_terms,
                                             LaneAccess::machine_code_of(programs.contact_terms, machine_code)),
                         programs.coordinates),
          step_(dof_, 1, tolerance),
          before_(2 * dof_) {}

    void fix(const std::vector<Double8>& parameters) override {
        const std::span<const Double8> all(parameters);
        flight_.series.fix(all);
        contact_.series.fix(all);
        contact_terms_.fix(all);
    }

    void stay(LaneStep& step, long most) override {
        Mask plain, go_on, idle{false};
        for (std::size_t i = 0; i < Double8::count; ++i)
            if (step.idle[i]) idle.set(i);
        step.steps = 0;
        do {
            for (std::size_t i = 0; i < 2 * dof_; ++i) before_[i] = step.q_and_v[i];
            Number span;
            plain = stay_once(step, span);
            for (std::size_t i = 0; i < 2 * dof_; ++i) step.q_and_v[i] = select(plain, step.q_and_v[i], before_[i]);
            step.least_gap = select(plain, min(Number(step.end_h), step.least_gap), step.least_gap);
            go_on = plain & (span > stall * abs(Number(step.t)));
            step.t = select(plain, min(Number(step.t) + span, step.until), step.t);
            step.duration = select(plain, span, step.duration);
            go_on &= Number(step.until) - step.t > end_of_time * abs(Number(step.t));
            step.state_error = Number(step.state_error) + step.error_per_step;
        } while (++step.steps < most && !any(~(go_on | idle)));
        say(step, plain, Mask{false});
        for (std::size_t i = 0; i < Double8::count; ++i) step.goes_on[i] = go_on[i];
    }

    // A flight step is plain if partial sums prove that the gap stays open, or that it is monotone (first_descent()).
    [[gnu::flatten]] void fly(LaneStep& step, bool brief) override {
        step_.gap(contact) = {step.h, step.hdot, step.error, step.rate_error, step.state_error};
        const FixedOrder<Number>& order_policy = brief ? brief_ : flight_.order;
        Mask plain = expand(flight_.series, order_policy, step, {});
        if (!any(plain)) return say(step, plain, plain);
        const Number target = step_.aim(Number(step.until) - step.t);
        const Number span = order_policy.natural_step(step_, target);
        step.brief = brief_.reach(step_);
        const Number least = shortest(step);
        plain &= span > least;
        step_.event_terms(contact, span, terms_.data());
        const Mask from_zero = Number(step.known) > 0.5;
        terms_[0] = select(from_zero, 0.0, terms_[0]);
        const Number error = gap_at_end(step, span);
        divide_root_out(from_zero);
        auto [none, falls] = descent(error);
        Number theta = any(falls & plain) ? root(falls) : Number(1.0);
        if (any(plain & ~(none | falls))) look_closer(plain, error, none, falls, theta);
        none &= plain;
        falls &= plain;
        const Number duration = select(falls, theta * span, span);
        falls &= duration > least;
        step_.evaluate(duration, step.q_and_v.data());
        step.duration = duration;
        land(step, duration, none, falls);
        step.t = select(none | falls, min(Number(step.t) + duration, step.until), step.t);
        say(step, none, falls);
    }

 private:
    // The series of one motion and their order.
    struct LaneExpansion {
        SeriesEvaluator<Number> series;
        FixedOrder<Number> order;
    };

    // One step in contact. Returns the lanes in which the force keeps its sign by more than its remainder.
    [[gnu::flatten]] Mask stay_once(LaneStep& step, Number& span) {
        step_.gap(contact) = {0.0, 0.0, 0.0, 0.0, step.state_error};
        Mask plain = expand(contact_.series, contact_.order, step, Mode::holding(ContactSet::of(contact)));
        span = 0.0;
        if (!any(plain)) return plain;
        span = contact_.order.natural_step(step_, Number(step.until) - step.t);
        step_.event_terms(contact, span, terms_.data());
        const auto term = [&](int k) -> const Number& { return terms_[static_cast<std::size_t>(k)]; };
        plain &= step_.stays_negative(contact, span, term) & (span > shortest(step));
        step_.evaluate(span, step.q_and_v.data());
        plain &= project(step, span);
        for (std::size_t i = 0; i < dof_; ++i)
            step.q_and_v[dof_ + i] = Number(step.q_and_v[dof_ + i]) - Number(step.end_hdot) * step.impulse_direction[i];
        return plain;
    }

    // The shortest useful step (s), as Flow::least().
    Number shortest(const LaneStep& step) const { return 1e-16 * max(abs(Number(step.t)), 1e-3); }

    // Computes the series at the start of the step. Returns the lanes in which the state is valid.
    Mask expand(SeriesEvaluator<Number>& series, const FixedOrder<Number>& order, const LaneStep& step, Mode mode) {
        for (std::size_t i = 0; i < 2 * dof_; ++i) step_.row(0)[i] = step.q_and_v[i];
        step_.time() = step.t;
        const auto start = step_.expand(series, order, mode, Number(step.until) - step.t);
        return start.numbers & start.regular;
    }

    // ---- the event function ----

    std::size_t order() const { return static_cast<std::size_t>(step_.order()); }

    // The gap at the end of the step by its series, with its errors. Returns the remainder.
    Number gap_at_end(LaneStep& step, const Number& span) {
        Number value = 0.0, slope = 0.0, size = 0.0;
        for (std::size_t k = 0; k <= order(); ++k) {
            value += terms_[k];
            slope += static_cast<double>(k) * terms_[k];
            size += abs(terms_[k]);
        }
        const TermSizes<Number> sizes{size, abs(terms_[order()]) + abs(terms_[order() - 1])};
        const auto doubt = step_.doubt(contact, span, sizes);
        GapOver<Number> end{value, slope / span, 0.0, 0.0, 0.0};
        step_.add_error(contact, span, sizes, doubt, end);
        step.h = end.h;
        step.hdot = end.hdot;
        step.error = end.error;
        step.rate_error = end.rate_error;
        return doubt.remainder();
    }

    void divide_root_out(const Mask& from_zero) {
        terms_[order() + 1] = 0.0;
        for (std::size_t k = 0; k <= order(); ++k) terms_[k] = select(from_zero, terms_[k + 1], terms_[k]);
    }

    struct Descents {
        Mask none, falls;
    };
    Descents descent(const Number& remainder) {
        Number value = terms_[0] + terms_[1], least = min(value, terms_[0]), slope = terms_[1];
        min_slope_ = max_slope_ = slope;
        for (std::size_t k = 2; k <= order(); ++k) {
            value += terms_[k];
            least = min(value, least);
            slope += static_cast<double>(k) * terms_[k];
            min_slope_ = min(slope, min_slope_);
            max_slope_ = max(slope, max_slope_);
        }
        const Mask falls = max_slope_ < 0.0;
        return {(least > remainder) | (falls & (value > remainder)),
                falls & (terms_[0] > remainder) & (value < -remainder)};
    }

    // Newton's method from the root of the quadratic part, kept inside a shrinking bracket. Removes lanes that do not
    // converge from `searched`.
    Number root(Mask& searched) const {
        const Number discriminant = max(terms_[1] * terms_[1] - 4.0 * terms_[0] * terms_[2], 0.0);
        const Mask steady = min_slope_ > 3.0 * max_slope_;
        Number x = min(2.0 * terms_[0] / (sqrt(discriminant) - terms_[1]), 1.0), low = 0.0, high = 1.0;
        Mask searching = searched;
        for (int round = 0; round < 20 && any(searching); ++round) {
            const auto [value, slope] = value_and_slope(terms_.data(), step_.order(), x);
            low = select(value > 0.0, x, low);
            high = select(value > 0.0, high, x);
            const Number newtons = x - value / slope;
            const Mask met = value == 0.0, inside = (newtons > low) & (newtons < high);
            const Number next = select(inside, newtons, 0.5 * (low + high));
            const Mask quick = round < 2 ? inside & steady : inside;
            const Mask close = abs(next - x) <= select(quick, Number(0x1p-30), unit_roundoff) * x;
            x = select(searching & ~met, next, x);
            searching &= ~(close | met);
        }
        searched &= ~searching;
        return x;
    }

    // first_descent() for each lane in which the partial sums are inconclusive.
    void look_closer(const Mask& plain, const Number& remainder, Mask& none, Mask& falls, Number& theta) const {
        for (std::size_t i = 0; i < Double8::count; ++i) {
            if (!plain[i] || none[i] || falls[i]) continue;
            Polynomial p;
            p.degree = step_.order();
            for (std::size_t k = 0; k <= order(); ++k) p.c[k] = terms_[k][i];
            const auto found = first_descent(p, 0, remainder[i]);
            if (found.kind == FirstCrossing::Kind::none) none.set(i);
            if (found.kind != FirstCrossing::Kind::root || found.theta == 0.0) continue;
            falls.set(i);
            theta.set(i, found.theta);
        }
    }

    // ---- contact quantities ----

    // Evaluates the contact quantities at the end of a step of length `span` (s).
    void evaluate_contact(LaneStep& step, const Number& span) {
        for (std::size_t i = 0; i < 2 * dof_; ++i) contact_terms_.input(i) = step.q_and_v[i];
        contact_terms_.clock() = Number(step.t) + span;
        contact_terms_.run();
        step.end_h = contact_terms_.h();
        step.end_hdot = contact_terms_.hdot();
        step.end_W = contact_terms_.W();
        step.end_gap_t = contact_terms_.gap_t();
        Number sum = 0.0;
        for (std::size_t i = 0; i < dof_; ++i) {
            step.impulse_direction[i] = contact_terms_.impulse_direction(i);
            step.g[i] = contact_terms_.gradient(i);
            sum += abs(contact_terms_.gradient(i) * step.q_and_v[i]);
        }
        step.rounding = unit_roundoff * sum;
    }

    // The first two iterations of ContactKinematics::project(). Returns the lanes in which they suffice.
    Mask project(LaneStep& step, const Number& span) {
        evaluate_contact(step, span);
        const Mask regular = Number(step.end_W) > 0.0;
        const Mask far = ~(abs(Number(step.end_h)) <= 0.5 * Number(step.rounding));
        if (!any(far)) return regular;
        move_along_normal(step, far);
        evaluate_contact(step, span);
        return regular & (Number(step.end_W) > 0.0) & (abs(Number(step.end_h)) <= 4.0 * Number(step.rounding));
    }

    void move_along_normal(LaneStep& step, const Mask& which) const {
        const Number h = step.end_h;
        for (std::size_t i = 0; i < dof_; ++i)
            step.q_and_v[i] = select(which, Number(step.q_and_v[i]) - h * step.impulse_direction[i], step.q_and_v[i]);
    }

    // Projects the runs that land to h = 0; the others keep their state.
    void land(LaneStep& step, const Number& span, Mask& none, Mask& falls) {
        evaluate_contact(step, span);
        none &= (Number(step.end_W) > 0.0) & ~(step.end_h < -4.0 * Number(step.rounding));
        falls &= Number(step.end_W) > 0.0;
        const Mask far = falls & (abs(Number(step.end_h)) > 0.5 * Number(step.rounding));
        if (!any(far)) return;
        move_along_normal(step, far);
        evaluate_contact(step, span);
        falls &= (Number(step.end_W) > 0.0) & (abs(Number(step.end_h)) <= 4.0 * Number(step.rounding));
    }

    // Sets the outcome of every lane: an impact where `falls`, no event where `none`, else needs_scalar_step.
    static void say(LaneStep& step, const Mask& none, const Mask& falls) {
        for (std::size_t i = 0; i < Double8::count; ++i)
            step.end[i] = falls[i]  ? LaneStep::LaneOutcome::impact
                          : none[i] ? LaneStep::LaneOutcome::no_event
                                    : LaneStep::LaneOutcome::needs_scalar_step;
    }

    std::size_t dof_;
    LaneExpansion flight_;
    FixedOrder<Number> brief_;  // for brief flights
    LaneExpansion contact_;
    ContactTerms<ProgramOver<Number>> contact_terms_;
    TaylorStep<Number> step_;
    std::vector<Number> before_;                                       // the state before a step
    std::array<Number, TaylorStep<Number>::highest_order + 2> terms_;  // of the event function
    Number min_slope_, max_slope_;  // smallest and largest slope of the event function's partial sums along the step
};

// The functions of one vector size (lane_kinds.hpp), instantiated only by its source file.

template <std::size_t Bytes>
std::unique_ptr<LaneStepper> LaneKind<Bytes>::make_stepper(const LanePrograms& programs, double tolerance,
                                                           std::optional<Width> machine_code) {
    return std::make_unique<LaneStepperOver<Lanes<Bytes>>>(programs, tolerance, machine_code);
}

template <std::size_t Bytes>
void LaneKind<Bytes>::sine_and_cosine(const Double8* angle, Double8* sine, Double8* cosine) {
    Lanes<Bytes> s, c;
    achilles::sine_and_cosine(Lanes<Bytes>(*angle), s, c);
    *sine = s;
    *cosine = c;
}

template <std::size_t Bytes>
void LaneKind<Bytes>::start(const SeriesProgram& program, Double8* registers, const Double8* coefficients,
                            std::array<Double8, 3>* factors) {
    LaneAccess::start(program, reinterpret_cast<Lanes<Bytes>*>(registers),
                      reinterpret_cast<const Lanes<Bytes>*>(coefficients),
                      reinterpret_cast<std::array<Lanes<Bytes>, 3>*>(factors));
}

}  // namespace achilles
