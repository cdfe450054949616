// One order of all series of a program: the inner loop of the Taylor method, for one run and for eight at once.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "number/eight.hpp"

namespace achilles {

class MachineCode;
enum class Width : unsigned;

// Order k of series `result` is (f[2] w_k + f[1] y_k) + f[0] x_k: what is known last comes last. An operand is a series
// or an inner sum; 0 is none. A factor that is always 1 or -1 is known, the others are looked up.
struct SeriesRule {
    std::uint32_t result = 0, x = 0, y = 0, w = 0;
    std::int8_t known[3] = {};
};
using SeriesFactors = std::array<double, 3>;

// What is to be done, the same in every run. There are `lanes` inner sums, a multiple of 4 and not none; those of no
// use sum zeros.
struct SeriesPlan {
    // What a vector is stored over must not lie in two cache lines: a number could not be read back before the whole
    // store is through. So inner sums begin at a multiple of this, and so do the tables.
    static constexpr std::uint32_t aligned = 8;

    std::vector<SeriesRule> rules;
    std::uint32_t series = 0;  // room for so many, a multiple of `aligned`; inner sums follow
    std::uint32_t lanes = 0;
    std::uint32_t weighted = 0;              // of these, the first are weighted
    std::vector<std::uint32_t> left, right;  // of each lane: the series that it multiplies
    // Of a motion: the inputs are q and v, series 1 .. 2 n, and the outputs v' (n) and the event functions, none of
    // which is an input.
    std::vector<std::uint32_t> outputs;
    std::uint32_t events = 0;  // of the outputs, the last
    // The series of the time that passes; 0: there is none. Before order 1 it is set to 1 (to the duration of a unit of
    // what the series are in), and the last rule takes that away, so that all further orders are nothing.
    std::uint32_t clock = 0;

    std::size_t coordinates() const { return outputs.size() - events; }
    std::uint32_t event(std::size_t i) const { return outputs[coordinates() + i]; }
    std::size_t states() const { return 2 * coordinates() + events; }
    std::size_t numbers() const { return series + 2 * static_cast<std::size_t>(lanes); }
    std::size_t row() const { return 2 * static_cast<std::size_t>(lanes); }
};

// What is read and written. `now` holds order k: the series, then the inner sums, then a place for as many numbers.
// Row j >= 1 of `rows` starts at j plan.row(): the left factors of all sums, the right ones.
template <class Number>
struct SeriesTablesOver {
    const std::array<Number, 3>* factors = nullptr;  // of the rules
    Number* now = nullptr;
    Number* rows = nullptr;
};
using SeriesTables = SeriesTablesOver<double>;

// A motion's coefficients, made order by order until they are small. Machine code knows the layout.
struct MotionOrders {
    double* row = nullptr;            // of the order made last: q, v, event functions; order k + 1 goes behind it
    const double* largest = nullptr;  // in that row: the one that is compared
    double power = 1.0;               // its unit times target^k
    double target = 1.0;              // s, where the terms are compared
    const double* last = nullptr;     // the tables' row of the last order that may be made
    double one = 1.0;
    double magnitude[2] = {std::bit_cast<double>(~std::uint64_t{0} >> 1), 0.0};  // a mask: all but the sign
};

// Makes order k >= 1 of all series, and the inner sums of order k + 1 (recurrence.hpp).
void make_order(const SeriesPlan& plan, const SeriesTables& tables, int k);

// Makes the orders from k >= 2 on, after order k - 1. The last is `last`, or the first at which the compared coefficient
// times target^k is not above 1. Returns it.
int make_orders(const SeriesPlan& plan, const SeriesTables& tables, MotionOrders& motion, int k, int last);

// Both as machine code for one plan, with vectors of this width (four or eight). All but the two terms with row k are
// added up before the rules, so that the processor can do both at once; the bits are the same.
class OrderCode {
 public:
    // Nothing where that is not to be had.
    static std::shared_ptr<const OrderCode> of(const SeriesPlan& plan, Width width);
    static constexpr int highest_order = 34;

    void make_first(const SeriesTables& tables) const {
        first_(tables.now, tables.factors, tables.rows + row_, tables.rows + row_, weights(1), nullptr);
    }
    // The plan is that of a motion.
    int make_orders(const SeriesTables& tables, MotionOrders& motion, int k, int last) const {
        double* const row = tables.rows + static_cast<std::size_t>(k) * row_;
        const double* const before = motion.row;
        motion.last = tables.rows + static_cast<std::size_t>(last) * row_;
        later_(tables.now, tables.factors, tables.rows + row_, row, weights(k), &motion);
        return k - 1 + static_cast<int>((motion.row - before) / static_cast<std::ptrdiff_t>(states_));
    }

 private:
    friend class OrderWriter;
    using Function = void(double* now, const SeriesFactors* factors, const double* first, double* row,
                          const double* weights, MotionOrders* motion);
    static constexpr std::ptrdiff_t weights_per_order = 18;
    const double* weights(int k) const { return weights_.data() + k * weights_per_order; }

    std::shared_ptr<const MachineCode> code_;
    Function *first_ = nullptr, *later_ = nullptr;
    std::size_t row_ = 0, states_ = 0;
    // Per order k: k, 1/(k + 1), and both again as they are in the vector whose first lanes alone are weighted.
    std::vector<double> weights_;
};

// The orders of all series of a program in eight runs at once: recurrence.hpp with a vector for every number.
//
// One run's inner sums fill a vector by themselves; eight runs' need no number to change its place, load each row once
// for all sums with one factor, and have eight times as much to do while a rule waits for the one before.

// What of an order is kept for the inner sums of later ones, and what they multiply.
struct LanePlan {
    struct Kept {
        std::uint32_t series;
        bool weighted;  // times the order
    };
    struct Sum {
        std::uint32_t left, right;  // of what is kept
    };
    std::vector<Kept> kept;
    std::vector<Sum> sums;  // in the plan's order: the first plan.weighted are weighted

    LanePlan(const SeriesPlan& plan, std::size_t inner_sums);
};

// Orders as machine code: the same bits as recurrence.hpp.
class LaneOrderCode {
 public:
    // By vectors of four or eight. Nothing where that is not to be had.
    static std::shared_ptr<const LaneOrderCode> of(const SeriesPlan& plan, const LanePlan& lanes, Width vectors);

    // Orders 1 .. last, last >= 4, where order 1 of q and v and sums of zero stand in `now`. All numbers are eight side
    // by side: `now` holds an order of the series and the inner sums (SeriesPlan::numbers()), then the rows of what is
    // kept from row 0 on; row k of `motion` is order k of q, v and the event functions; `factors` are three for each rule.
    void make_orders(const double* factors, double* now, double* motion, int last) const {
        const auto* const weights = weights_.data();
        function_(now, factors, now + first_row_, weights->data(), weights[last - 1].data(), motion + states_);
    }

 private:
    using Function = void(double* now, const double* factors, double* row, const double* weights, const double* last,
                          double* motion);
    std::shared_ptr<const MachineCode> code_;
    Function* function_ = nullptr;
    std::size_t first_row_ = 0, states_ = 0;      // doubles
    std::vector<std::array<double, 3>> weights_;  // of each order k: k, 1/(k + 1), 1/k
};

}  // namespace achilles
