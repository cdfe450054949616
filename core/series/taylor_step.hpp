// One step of the Taylor method over any number type: a double for one run, eight doubles for an ensemble.
//
// With q_{k+1} = v_k/(k+1) and v_{k+1} = f_k/(k+1), order k of the program gives order k + 1 of the motion. Event
// functions are outputs of the same program, so their series are computed along with it. Every contact has one, chosen
// by its law: its gap, or hddot for the sign of its force. Those of friction follow; their number depends on the mode.
//
// Order and step size: term k of the motion in units of the tolerance is m_k t^k. A step of order p ends where its last
// terms reach 1. The order policy (below) chooses p, and how many of the last terms are considered.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "contacts/contact_law.hpp"
#include "number/double8.hpp"
#include "number/inner_loops.hpp"
#include "series/evaluator.hpp"
#include "series/gap.hpp"

namespace achilles {

inline constexpr double unit_roundoff = 0x1p-53;
// Bound on the absolute values of a state, so that their squares do not overflow.
inline constexpr double largest_state = 1e150;

// 1/k by order k.
inline constexpr auto reciprocals = [] {
    std::array<double, OrderCode::highest_order + 1> table{};
    for (std::size_t k = 1; k < table.size(); ++k) table[k] = 1.0 / static_cast<double>(k);
    return table;
}();

// Sizes of an event function's terms at the end of a step: the sum of all absolute values, and that of the last two.
template <class Number>
struct TermSizes {
    Number all, last;
};

template <class Number>
class TaylorStep {
 public:
    using Series = SeriesEvaluator<Number>;
    static constexpr int highest_order = Series::highest_order;

    // `contacts`: number of event functions, one for each contact.
    TaylorStep(std::size_t dof, std::size_t contacts, double tolerance)
        : dof_(dof),
          contacts_(contacts),
          gaps_end_(contacts),
          width_(2 * dof + contacts),
          tolerance_(tolerance),
          rows_((highest_order + 1) * width_, Number(0.0)),
          units_(width_, Number(0.0)),
          gaps_(contacts, GapOver<Number>{0.0, 0.0, 0.0, 0.0, 0.0}),
          gap_units_(contacts, 1.0) {}

    std::size_t dof() const { return dof_; }
    // Number of event functions.
    std::size_t contacts() const { return contacts_; }
    // Changes it for a mode that watches this many more functions than it has contacts, and expands this many powers
    // after them. Powers do not limit the step.
    void set_further_events(std::size_t watched, std::size_t powers) {
        powers_ = powers;
        if (contacts_ == gaps_end_ + watched + powers) return;
        contacts_ = gaps_end_ + watched + powers;
        width_ = 2 * dof_ + contacts_;
        rows_.assign((highest_order + 1) * width_, Number(0.0));
        units_.assign(width_, Number(0.0));
        gaps_.resize(contacts_, GapOver<Number>{0.0, 0.0, 0.0, 0.0, 0.0});
        gap_units_.resize(contacts_, 1.0);
    }
    // Numbers per row. Row k is order k of q, v and the event functions.
    std::size_t width() const { return width_; }
    Number* row(int k) { return rows_.data() + static_cast<std::size_t>(k) * width(); }
    const Number* row(int k) const { return rows_.data() + static_cast<std::size_t>(k) * width(); }
    const Number& event(std::size_t contact, int k) const { return row(k)[2 * dof_ + contact]; }
    // 1/(tolerance of the component), by component.
    const Number* units() const { return units_.data(); }
    // Scale of a contact's gap per meter of a coordinate, for the tolerances of its event function. The default is 1.
    double& gap_unit(std::size_t contact) { return gap_units_[contact]; }
    int order() const { return order_; }
    // True if the event function of the contact is its gap.
    bool watches_gap(std::size_t contact) const { return contact < gaps_end_ && gaps_watched_.contains(contact); }
    bool watches_any_gap() const {
        for (std::size_t i = 0; i < gaps_end_; ++i)
            if (watches_gap(i)) return true;
        return false;
    }

    // ---- expansion ----

    // Conditions on the initial state: all numbers are finite and not too large; M is positive definite.
    struct Start {
        Condition<Number> numbers, regular;
    };
    // The gap at the start of the step, to be set before expand(). For a held contact only state_error is used. time()
    // (s) is needed only if the motion depends on it.
    GapOver<Number>& gap(std::size_t contact) { return gaps_[contact]; }
    Number& time() { return time_; }
    // Computes the series of this mode's motion from the q and v in row 0. The policy chooses the order needed for a
    // step of at most `longest` (s).
    template <class OrderPolicy>
    Start expand(Series& series, OrderPolicy& policy, Mode mode, const Number& longest) {
        gaps_watched_ = contacts_watching(mode, WatchedFunction::gap);
        const Start start = begin(series);
        if (any(start.numbers & start.regular)) order_ = policy.expand(*this, series, longest);
        return start;
    }
    // For a policy, after order 1: sets the rates of open gaps to the known values.
    void give_rates() {
        for (std::size_t i = 0; i < gaps_end_; ++i)
            if (watches_gap(i)) row(1)[2 * dof_ + i] = gaps_[i].hdot;
    }
    // For a policy, after order 2: 1.05 times the shortest time in which the parabola of an open gap closes, at most
    // `longest` (s). Also tightens the tolerance of each gap in proportion to the height of that flight.
    Number aim(const Number& longest);

    // ---- the step's length ----

    // m_k: the largest coefficient of order k in units of its tolerance. NaN is ignored.
    Number size(int k) const;
    // log2 of the time t at which term k, of size m, reaches m t^k = 2^(k allowed).
    Number reach(int k, const Number& m, double allowed) const {
        return allowed - rough_log2(m) * reciprocals[static_cast<std::size_t>(k)];
    }

    // ---- state at the end, and event functions ----

    // q and v after a time (s).
    template <class Place>
    void evaluate(const Number& span, Place* q_and_v) const;
    // A contact's event function as a polynomial in theta = t/span, with order() + 1 terms.
    void event_terms(std::size_t contact, const Number& span, Number* terms) const;

    // Error bounds of an event function: the remainder of this step, the error at its end from earlier steps, and the
    // error of hddot.
    struct EventUncertainty {
        Number own, earlier, hddot_error;
        Number remainder() const { return own + earlier; }
    };
    EventUncertainty doubt(std::size_t contact, const Number& span, const TermSizes<Number>& sizes) const;
    // Adds the error of this step to the gap at its end, for later steps.
    void add_error(std::size_t contact, const Number& span, const TermSizes<Number>& sizes,
                   const EventUncertainty& doubt, GapOver<Number>& end) const;
    // True if partial sums (Abel) prove that an event function is below minus its remainder throughout the step, as
    // first_descent() would. term(k) is called in ascending order of k.
    template <class Term>
    Condition<Number> stays_negative(std::size_t contact, const Number& span, const Term& term) const;

 private:
    Start begin(Series& series);
    const Number& unit(std::size_t contact) const { return units_[2 * dof_ + contact]; }

    std::size_t dof_, contacts_, gaps_end_, width_;  // gaps_end_: number of contacts
    std::size_t powers_ = 0;                         // the last event functions
    double tolerance_;
    std::vector<Number> rows_, units_;
    std::vector<GapOver<Number>> gaps_;  // at the start of the step
    std::vector<double> gap_units_;
    Number time_ = 0.0;  // at the start of the step
    ContactSet gaps_watched_;
    int order_ = 0;  // of the last expansion
};

// Order 0 of all components, and order 1 of q and v.
template <class Number>
auto TaylorStep<Number>::begin(Series& series) -> Start {
    using std::abs;
    Number *const c = row(0), *const events = c + 2 * dof_;
    Start start{Condition<Number>(true), Condition<Number>(true)};
    Number* const units = units_.data();
    const double tolerance = tolerance_;  // a copy, which no store may change
    for (std::size_t i = 0; i < 2 * dof_; ++i) {
        start.numbers = start.numbers & (abs(c[i]) < largest_state);
        units[i] = 1.0 / (tolerance * (1.0 + abs(c[i])));
    }
    if (!any(start.numbers)) return start;
    series.begin(c, time_);
    for (std::size_t i = 0; i < dof_; ++i) start.regular = start.regular & (series.start(dof_ + contacts() + i) > 0.0);
    for (std::size_t i = 0; i < contacts(); ++i) {
        events[i] = watches_gap(i) ? gaps_[i].h : series.start(dof_ + i);
        units[2 * dof_ + i] = 1.0 / (tolerance * (gap_units_[i] + abs(events[i])));
    }
    for (std::size_t i = width_ - powers_; i < width_; ++i) units_[i] = 0.0;
    Number* const first = row(1);
    for (std::size_t i = 0; i < dof_; ++i) {
        first[i] = c[dof_ + i];
        first[dof_ + i] = series.start(i);
    }
    return start;
}

// The time at which h_0 + h_1 t + h_2 t^2 decreases to zero, if it does. All three coefficients may be 0, as after a
// release.
template <class Number>
Number TaylorStep<Number>::aim(const Number& longest) {
    using std::abs, std::sqrt;
    Number target = longest;
    for (std::size_t i = 0; i < gaps_end_; ++i) {
        if (!watches_gap(i)) continue;
        const Number h0 = max(gaps_[i].h, 0.0), h1 = gaps_[i].hdot, h2 = event(i, 2);
        const Number root = sqrt(h1 * h1 - 4.0 * h0 * h2);
        const Condition<Number> rises = h1 > 0.0;
        const Number time = select(rises, h1 + root, 2.0 * h0) / select(rises, -2.0 * h2, root - h1);
        const Number fall = select((h2 < 0.0) & ((h0 > 0.0) | rises), min(time, longest), longest);
        target = min(1.05 * fall, target);
    }
    for (std::size_t i = 0; i < gaps_end_; ++i) {
        if (!watches_gap(i)) continue;
        const Number height = abs(gaps_[i].h) + abs(gaps_[i].hdot) * target;
        Number& unit = units_[2 * dof_ + i];
        unit = select((height > 0.0) & (height < gap_units_[i]), 1.0 / (tolerance_ * height), unit);
    }
    return target;
}

// Even and odd components have separate maxima, to shorten the chain of dependent comparisons.
template <class Number>
Number TaylorStep<Number>::size(int k) const {
    using std::abs;
    const Number* const c = row(k);
    Number even = 0.0, odd = 0.0;
    for (std::size_t i = 0; i < 2 * dof_; i += 2) {
        even = max(abs(c[i]) * units_[i], even);
        odd = max(abs(c[i + 1]) * units_[i + 1], odd);
    }
    Number largest = max(even, odd);
    for (std::size_t i = 2 * dof_; i < width(); ++i) largest = max(largest, abs(c[i]) * units_[i]);
    return largest;
}

// Two components at a time; the number 2 dof of components is even.
template <class Number>
template <class Place>
void TaylorStep<Number>::evaluate(const Number& span, Place* q_and_v) const {
    using Pack2 = Pack<Number, 2>;
    for (std::size_t i = 0; i < 2 * dof_; i += Pack2::count)
        Pack2::store(sum_of_powers<typename Pack2::Value>(order_, span, [&](int k) { return Pack2::load(row(k) + i); }),
                     q_and_v + i);
}

template <class Number>
void TaylorStep<Number>::event_terms(std::size_t contact, const Number& span, Number* terms) const {
    Number even = 1.0, odd = span;
    const Number square = span * span;
    const Number* c = &event(contact, 0);
    const std::size_t width = width_;
    int k = 0;
    for (; k < order_; k += 2, c += 2 * width, even *= square, odd *= square) {
        terms[k] = c[0] * even;
        terms[k + 1] = c[width] * odd;
    }
    if (k == order_) terms[k] = c[0] * even;
}

// The terms decrease at least by half from one to the next in a step that the tolerance allows. The truncation error is
// therefore below the sum of the last two terms; the rounding errors and twice the tolerance, in units of the height of
// the flight, are included too. A dip smaller than this and the errors of earlier steps can be neither confirmed nor
// excluded.
template <class Number>
auto TaylorStep<Number>::doubt(std::size_t contact, const Number& span, const TermSizes<Number>& sizes) const
    -> EventUncertainty {
    using std::abs;
    const GapOver<Number>& gap = gaps_[contact];
    const bool open = watches_gap(contact);
    const auto term = [&](int k) { return abs(event(contact, k)); };
    const Number own = max(sizes.last + 4.0 * unit_roundoff * sizes.all, 2.0 / unit(contact));
    const Number hddot_error =
        gap.hddot_error(open ? 2.0 * term(2) + 6.0 * term(3) : term(0) + term(1), gap_units_[contact]);
    return {own, open ? gap.error_after(span, hddot_error) : hddot_error, hddot_error};
}

// The end of the step is known better than the remainder, which holds for the whole step. But a truncation error also
// affects the rate, multiplied by the order, and moves the gap during the next step. Terms at the level of rounding say
// nothing about truncation. The weights are fitted to the dips of bench_floor: results are right or undecided, and at a
// tolerance of 1e-14 right except for 2 of 3300.
template <class Number>
void TaylorStep<Number>::add_error(std::size_t contact, const Number& span, const TermSizes<Number>& sizes,
                                   const EventUncertainty& doubt, GapOver<Number>& end) const {
    const Number left_out = 0.16 * max(sizes.last - 1024.0 * unit_roundoff * sizes.all, 0.0);
    end.error = doubt.earlier + 0.125 * doubt.own + left_out;
    end.rate_error = doubt.hddot_error * span + static_cast<double>(order_ + 1) * left_out / span;
    end.state_error = gaps_[contact].state_error;
}

template <class Number>
template <class Term>
Condition<Number> TaylorStep<Number>::stays_negative(std::size_t contact, const Number& span, const Term& term) const {
    using std::abs;
    Number last = term(0), before = 0.0, sum = last, highest = sum, size = abs(sum);
    for (int k = 1; k <= order_; ++k) {
        before = last;
        last = term(k);
        sum += last;
        highest = max(sum, highest);
        size += abs(last);
    }
    return highest < -doubt(contact, span, {size, abs(last) + abs(before)}).remainder();
}

// Order policies of TaylorStep: which order a step has, and how far its last terms are trusted.

// Measured cost of a step in processor cycles: a constant part per step, a constant part and one per rule for each
// order, and a part per inner sum for each order squared.
struct OrderCosts {
    double step, order, rule, square;
    int lowest;  // lowest order used
};
// A release is a triple root, so the gap needs more than three terms.
inline constexpr OrderCosts costs_of_one_run{1000.0, 40.0, 2.0, 0.125, 5};
// With machine code for eight runs. Times hardly differ within a few orders; a low cost of the step favors lower
// orders, whose steps are more accurate. Four terms determine the step, hence the higher minimum.
inline constexpr OrderCosts costs_of_eight_runs{400.0, 60.0, 5.0, 0.8, 10};

// The order p that minimizes cost(p)/length(p). A step of order p has a length of about (tolerance)^(1/p) times the
// radius of convergence.
int best_order(const SeriesProgram& program, double tolerance, const OrderCosts& costs);

// Policy of a single run. The first terms often show how far away the next event is, because a flight ends about where
// its parabola does. The order is then the first whose terms are small at that time, so a short flight costs few
// orders. Otherwise it is best_order().
class AdaptiveOrder {
 public:
    AdaptiveOrder(const SeriesProgram& program, double tolerance);

    // Computes orders until two successive ones are small, or the best order is reached. Returns the order, or 0 if too
    // few coefficients are finite.
    int expand(TaylorStep<double>& step, SeriesEvaluator<double>& series, double longest);
    // Step size (s): as long as requested, or until the last terms reach 1.
    double natural_step(const TaylorStep<double>& step) const;

 private:
    struct Magnitude {
        double m;
        std::size_t component;  // the component that has it
    };
    static Magnitude magnitude(const TaylorStep<double>& step, int k);
    int begin_flight(TaylorStep<double>& step, SeriesEvaluator<double>& series, MotionOrders& motion, double longest);
    int leave_out_infinite(const TaylorStep<double>& step, int order);

    int most_;
    double target_ = 0.0;   // the longest step needed, as far as known
    double power_ = 0.0;    // target^order
    bool reached_ = false;  // the last two terms are small at the target
};

// Policy of runs side by side: all steps have the same order, so that no run depends on its neighbors.
template <class Number>
class FixedOrder {
 public:
    // If `ends_late`, the last term may reach 2 and the one before it 4 at the end of a step. The omitted terms
    // together are then usually below 1. This is accurate enough if no event depends on the end of the step.
    FixedOrder(int order, bool ends_late) : order_(order), ends_late_(ends_late) {}

    int expand(TaylorStep<Number>& step, SeriesEvaluator<Number>& series, const Number&) const {
        series.extend(step.row(1), 1, order_);
        step.give_rates();
        return order_;
    }
    // Step size (s): as long as requested, or reach() if that is shorter.
    Number natural_step(const TaylorStep<Number>& step, const Number& longest) const {
        return min(reach(step), longest);
    }
    // Step size (s) at which the last two terms reach 1, at most twice that at which the two terms before them do. The
    // step must be expanded to this order or further.
    Number reach(const TaylorStep<Number>& step) const {
        constexpr int counted = 4;
        Number exponent = 900.0;  // exponent of 2
        for (int i = 0; i < counted; ++i) {
            const int k = order_ - i;
            const double late = ends_late_ ? (i + 1) * reciprocals[static_cast<std::size_t>(k)] : 0.0;
            exponent = min(step.reach(k, step.size(k), i >= 2 ? 1.0 : late), exponent);
        }
        return rough_exp2(exponent);
    }

 private:
    int order_;
    bool ends_late_;
};

}  // namespace achilles
