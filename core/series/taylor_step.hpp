// One step of the Taylor method over any number: a double for a run, doubles side by side for an ensemble.
//
// With q_{k+1} = v_k/(k+1) and v_{k+1} = f_k/(k+1), order k of the program gives order k + 1 of the motion. What events
// are looked for in is an output of the same program, so its series comes with it: every contact has an event function,
// for what its law watches: its gap, or hddot for its force.
//
// Order and step: term k of the motion in units of the tolerance is m_k t^k. A step of order p ends where its last terms
// reach 1. Which order that is, and how far the last terms are trusted, is the order policy's (below).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "contacts/contact_law.hpp"
#include "number/eight.hpp"
#include "number/inner_loops.hpp"
#include "series/evaluator.hpp"
#include "series/gap.hpp"

namespace achilles {

inline constexpr double unit_roundoff = 0x1p-53;
// A state's numbers stay below this: their squares are numbers too.
inline constexpr double largest_state = 1e150;

// 1/k of the orders.
inline constexpr auto reciprocals = [] {
    std::array<double, OrderCode::highest_order + 1> table{};
    for (std::size_t k = 1; k < table.size(); ++k) table[k] = 1.0 / static_cast<double>(k);
    return table;
}();

// Of an event function's terms at the end of a step: the sum of their sizes, and that of the last two.
template <class Number>
struct TermSizes {
    Number all, last;
};

template <class Number>
class TaylorStep {
 public:
    using Series = SeriesEvaluator<Number>;
    static constexpr int highest_order = Series::highest_order;

    // `contacts`: how many event functions the motions have.
    TaylorStep(std::size_t dof, std::size_t contacts, double tolerance)
        : dof_(dof),
          contacts_(contacts),
          width_(2 * dof + contacts),
          tolerance_(tolerance),
          rows_((highest_order + 1) * width_, Number(0.0)),
          units_(width_, Number(0.0)),
          gaps_(contacts, GapOver<Number>{0.0, 0.0, 0.0, 0.0, 0.0}),
          gap_units_(contacts, 1.0) {}

    std::size_t dof() const { return dof_; }
    std::size_t contacts() const { return contacts_; }
    // Row k: order k of q, v and the event functions.
    std::size_t width() const { return width_; }
    Number* row(int k) { return rows_.data() + static_cast<std::size_t>(k) * width(); }
    const Number* row(int k) const { return rows_.data() + static_cast<std::size_t>(k) * width(); }
    const Number& event(std::size_t contact, int k) const { return row(k)[2 * dof_ + contact]; }
    // 1/(tolerance of each component).
    const Number* units() const { return units_.data(); }
    // What 1 m of a coordinate makes of a gap, roughly: tolerances of event functions are in it. 1 unless it is set.
    double& gap_unit(std::size_t contact) { return gap_units_[contact]; }
    int order() const { return order_; }
    // Whether the event function of a contact is its gap.
    bool watches_gap(std::size_t contact) const { return gaps_watched_.contains(contact); }
    bool watches_any_gap() const {
        for (std::size_t i = 0; i < contacts(); ++i)
            if (watches_gap(i)) return true;
        return false;
    }

    // ---- expansion ----

    // What is true of the state where a step starts: it is made of numbers, and M is positive definite there.
    struct Start {
        Condition<Number> numbers, regular;
    };
    // Of the state where the step starts, to be set before it is expanded; of a held contact only the state_error counts,
    // and the time (s) only where the motion depends on it.
    GapOver<Number>& gap(std::size_t contact) { return gaps_[contact]; }
    Number& time() { return time_; }
    // The series at the state whose q and v stand in row 0, to the order that the policy finds is needed for `longest`
    // (s), along the motion in this mode.
    template <class OrderPolicy>
    Start expand(Series& series, OrderPolicy& policy, Mode mode, const Number& longest) {
        gaps_watched_ = contacts_watching(mode, WatchedFunction::gap);
        const Start start = begin(series);
        if (any(start.numbers & start.regular)) order_ = policy.expand(*this, series, longest);
        return start;
    }
    // For a policy: after order 1 has been made, open gaps move at the rates that are known.
    void give_rates() {
        for (std::size_t i = 0; i < contacts(); ++i)
            if (watches_gap(i)) row(1)[2 * dof_ + i] = gaps_[i].hdot;
    }
    // For a policy, after order 2: as long as the parabola of the open gap that closes first and a little more, or
    // `longest`. Every gap must be known well against the height of such a flight.
    Number aim(const Number& longest);

    // ---- the step's length ----

    // m_k: the largest coefficient of order k in units of its tolerance. What is no number is not seen.
    Number size(int k) const;
    // log2 of the time t at which term k of size m is m t^k = 2^(k allowed).
    Number reach(int k, const Number& m, double allowed) const {
        return allowed - rough_log2(m) * reciprocals[static_cast<std::size_t>(k)];
    }

    // ---- what is reached, and the event functions ----

    // q and v after a time.
    template <class Place>
    void evaluate(const Number& span, Place* q_and_v) const;
    // A contact's event function as a polynomial in theta = t/span: order() + 1 terms.
    void event_terms(std::size_t contact, const Number& span, Number* terms) const;

    // What is left out of an event function, what the steps before have made it wrong by where the step ends, and
    // how fast the error of the state moves it.
    struct Doubt {
        Number own, earlier, drifting;
        Number remainder() const { return own + earlier; }
    };
    Doubt doubt(std::size_t contact, const Number& span, const TermSizes<Number>& sizes) const;
    // Adds to a gap at the end of the step what later steps must take it to be wrong by.
    void add_error(std::size_t contact, const Number& span, const TermSizes<Number>& sizes, const Doubt& doubt,
                   GapOver<Number>& end) const;
    // Whether an event function stays below zero by more than its remainder, as Abel's sums tell: first_descent()
    // would find the same. term(k) is asked for in ascending order.
    template <class Term>
    Condition<Number> stays_negative(std::size_t contact, const Number& span, const Term& term) const;

 private:
    Start begin(Series& series);
    void set_unit(std::size_t i, const Number& size) { units_[i] = 1.0 / (tolerance_ * size); }
    const Number& unit(std::size_t contact) const { return units_[2 * dof_ + contact]; }

    std::size_t dof_, contacts_, width_;
    double tolerance_;
    std::vector<Number> rows_, units_;
    std::vector<GapOver<Number>> gaps_;  // where the step starts
    std::vector<double> gap_units_;
    Number time_ = 0.0;  // the same
    ContactSet gaps_watched_;
    int order_ = 0;  // of the last expansion
};

// Orders 0 of all and 1 of q and v.
template <class Number>
auto TaylorStep<Number>::begin(Series& series) -> Start {
    using std::abs;
    Number *const c = row(0), *const events = c + 2 * dof_;
    Start start{Condition<Number>(true), Condition<Number>(true)};
    for (std::size_t i = 0; i < 2 * dof_; ++i) {
        start.numbers = start.numbers & (abs(c[i]) < largest_state);
        set_unit(i, 1.0 + abs(c[i]));
    }
    if (!any(start.numbers)) return start;
    series.begin(c, time_);
    for (std::size_t i = 0; i < dof_; ++i) start.regular = start.regular & (series.start(dof_ + contacts() + i) > 0.0);
    for (std::size_t i = 0; i < contacts(); ++i) {
        events[i] = watches_gap(i) ? gaps_[i].h : series.start(dof_ + i);
        set_unit(2 * dof_ + i, gap_units_[i] + abs(events[i]));
    }
    Number* const first = row(1);
    for (std::size_t i = 0; i < dof_; ++i) {
        first[i] = c[dof_ + i];
        first[dof_ + i] = series.start(i);
    }
    return start;
}

// Where h_0 + h_1 t + h_2 t^2 comes down to zero, if it does: after a release, say, all three are nothing.
template <class Number>
Number TaylorStep<Number>::aim(const Number& longest) {
    using std::abs, std::sqrt;
    Number target = longest;
    for (std::size_t i = 0; i < contacts(); ++i) {
        if (!watches_gap(i)) continue;
        const Number h0 = max(gaps_[i].h, 0.0), h1 = gaps_[i].hdot, h2 = event(i, 2);
        const Number root = sqrt(h1 * h1 - 4.0 * h0 * h2);
        const Condition<Number> rises = h1 > 0.0;
        const Number time = select(rises, h1 + root, 2.0 * h0) / select(rises, -2.0 * h2, root - h1);
        const Number fall = select((h2 < 0.0) & ((h0 > 0.0) | rises), min(time, longest), longest);
        target = min(1.05 * fall, target);
    }
    for (std::size_t i = 0; i < contacts(); ++i) {
        if (!watches_gap(i)) continue;
        const Number height = abs(gaps_[i].h) + abs(gaps_[i].hdot) * target;
        Number& unit = units_[2 * dof_ + i];
        unit = select((height > 0.0) & (height < gap_units_[i]), 1.0 / (tolerance_ * height), unit);
    }
    return target;
}

// The even and the odd components by themselves: half as many comparisons wait for one another.
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

// Two components at a time; q and v stand side by side, so there is no odd one.
template <class Number>
template <class Place>
void TaylorStep<Number>::evaluate(const Number& span, Place* q_and_v) const {
    using Some = Pack<Number, 2>;
    for (std::size_t i = 0; i < 2 * dof_; i += Some::count)
        Some::store(sum_of_powers<typename Some::Value>(order_, span, [&](int k) { return Some::load(row(k) + i); }),
                    q_and_v + i);
}

template <class Number>
void TaylorStep<Number>::event_terms(std::size_t contact, const Number& span, Number* terms) const {
    Number even = 1.0, odd = span;
    const Number square = span * span;
    for (int k = 0; k <= order_; k += 2, even *= square, odd *= square) {
        terms[k] = event(contact, k) * even;
        if (k < order_) terms[k + 1] = event(contact, k + 1) * odd;
    }
}

// The terms fall at least by half from one to the next in a step that the tolerance allows, so what is left out is less
// than the last two together, with the rounding of all, and about the tolerance, which is in units of the flight's
// height. A dip within that, and within what the steps before have made, can be neither claimed nor denied.
template <class Number>
auto TaylorStep<Number>::doubt(std::size_t contact, const Number& span, const TermSizes<Number>& sizes) const -> Doubt {
    using std::abs;
    const GapOver<Number>& gap = gaps_[contact];
    const bool open = watches_gap(contact);
    const auto term = [&](int k) { return abs(event(contact, k)); };
    const Number own = max(sizes.last + 4.0 * unit_roundoff * sizes.all, 2.0 / unit(contact));
    const Number drifting = gap.drift(open ? 2.0 * term(2) + 6.0 * term(3) : term(0) + term(1), gap_units_[contact]);
    return {own, open ? gap.error_after(span, drifting) : drifting, drifting};
}

// The end is better known than the remainder says of the whole step. But what is left out is wrong in the rate too, as
// many times as there are orders, and moves the gap for a step; terms at the level of rounding tell nothing of what
// is left out. The weights are measured with bench_floor's dips: right or undecided, and at a tolerance of 1e-14 right,
// but for 2 of 3300.
template <class Number>
void TaylorStep<Number>::add_error(std::size_t contact, const Number& span, const TermSizes<Number>& sizes,
                                   const Doubt& doubt, GapOver<Number>& end) const {
    const Number left_out = 0.16 * max(sizes.last - 1024.0 * unit_roundoff * sizes.all, 0.0);
    end.error = doubt.earlier + 0.125 * doubt.own + left_out;
    end.rate_error = doubt.drifting * span + static_cast<double>(order_ + 1) * left_out / span;
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

// Which order a Taylor step has, and how far its last terms are trusted: what TaylorStep is given as a policy.

// What a step costs, in processor cycles, measured: a step on its own; of each order a part on its own and one a rule;
// of each order squared a part an inner sum.
struct OrderCosts {
    double step, order, rule, square;
    int lowest;  // order that is worth a step
};
// A release is a triple root: the gap needs more terms than that.
inline constexpr OrderCosts costs_of_one_run{1000.0, 40.0, 2.0, 0.125, 5};
// By machine code for eight runs. The times are nearly the same over a few orders; a low weight of the step takes the
// lower ones, whose steps are more exact. The last four terms tell the step.
inline constexpr OrderCosts costs_of_eight_runs{400.0, 60.0, 5.0, 0.8, 10};

// The order p at which cost(p)/length(p) is least: a step of order p has a length of about (tolerance)^(1/p) times the
// radius of convergence.
int best_order(const SeriesProgram& program, double tolerance, const OrderCosts& costs);

// A single run's. How far the next event can be is often known from the first terms (a flight ends about where its
// parabola does); then the order is the first one whose terms are that small there, and a short flight costs a few
// orders. Else it is the order at which the cost of a step over its length is least.
class AdaptiveOrder {
 public:
    AdaptiveOrder(const SeriesProgram& program, double tolerance);

    // The order, until two in a row are small or as many as pay; none if no step can be made of what is finite.
    int expand(TaylorStep<double>& step, SeriesEvaluator<double>& series, double longest);
    // As far as is wanted, or to where the last terms reach 1.
    double natural_step(const TaylorStep<double>& step) const;

 private:
    struct Magnitude {
        double m;
        std::size_t component;  // that it is of
    };
    static Magnitude magnitude(const TaylorStep<double>& step, int k);
    int begin_flight(TaylorStep<double>& step, SeriesEvaluator<double>& series, MotionOrders& motion, double longest);
    int leave_out_infinite(const TaylorStep<double>& step, int order);

    int most_;
    double target_ = 0.0;   // the longest step that the order is needed for, as far as is known
    double power_ = 0.0;    // target^order
    bool reached_ = false;  // the last two terms are small there
};

// All steps have one order, so that none depends on its neighbours: that of runs side by side.
template <class Number>
class FixedOrder {
 public:
    // If `ends_late`, the last term may reach 2 and the one before it 4 where a step ends: those left out are then, as a
    // rule, less than 1 together. That will do where no event waits for the end to be known better.
    FixedOrder(int order, bool ends_late) : order_(order), ends_late_(ends_late) {}

    int expand(TaylorStep<Number>& step, SeriesEvaluator<Number>& series, const Number&) const {
        series.extend(step.row(1), order_);
        step.give_rates();
        return order_;
    }
    // As far as is wanted, or as it reaches.
    Number natural_step(const TaylorStep<Number>& step, const Number& longest) const {
        return min(reach(step), longest);
    }
    // To where the last two terms reach 1, and half of it is within the reach of the two before; the step is expanded to this
    // order, or further.
    Number reach(const TaylorStep<Number>& step) const {
        constexpr int counted = 4;
        Number exponent = 900.0;  // of 2
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
