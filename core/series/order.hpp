// One order of all series of a program, the inner loop of the Taylor method, for one run or for eight.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "number/double8.hpp"

namespace achilles {

class MachineCode;
enum class Width : unsigned;

// Order k of series `result` is (f[2] w_k + f[1] y_k) + f[0] x_k: x, which is available last, is added last. An operand
// is the index of a series or of an inner sum; 0 means none. `known` is 1 or -1 for a factor that is always 1 or -1,
// else 0.
struct SeriesRule {
    std::uint32_t result = 0, x = 0, y = 0, w = 0;
    std::int8_t known[3] = {};
};
using SeriesFactors = std::array<double, 3>;

// The operations of one order, the same in every run. The number `lanes` of inner sums is a positive multiple of 4;
// unused lanes sum zeros.
struct SeriesPlan {
    // Inner sums and tables start at multiples of this, so that no vector store crosses a cache line. A load from a
    // store that crosses one must wait until the whole store is complete.
    static constexpr std::uint32_t aligned = 8;

    std::vector<SeriesRule> rules;
    std::uint32_t series = 0;  // number of series, rounded up to a multiple of `aligned`; inner sums follow
    std::uint32_t lanes = 0;
    std::uint32_t weighted = 0;              // number of weighted sums; they come first
    std::vector<std::uint32_t> left, right;  // for each lane, the series that it multiplies
    // For a motion, the inputs are q and v (series 1 .. 2 n), and the outputs are v' (n) and the event functions. No
    // output is an input.
    std::vector<std::uint32_t> outputs;
    std::uint32_t events = 0;  // number of event functions, the last outputs
    // Series of the time; 0 if time does not occur. Before order 1 it is set to 1 (or to the duration of a unit of
    // time). The last rule resets it to 0, its coefficient at all higher orders.
    std::uint32_t clock = 0;

    std::size_t coordinates() const { return outputs.size() - events; }
    std::uint32_t event(std::size_t i) const { return outputs[coordinates() + i]; }
    std::size_t states() const { return 2 * coordinates() + events; }
    std::size_t numbers() const { return series + 2 * static_cast<std::size_t>(lanes); }
    std::size_t row() const { return 2 * static_cast<std::size_t>(lanes); }
};

// Tables of one evaluation. `now` holds order k: the series, the inner sums, and room for as many numbers again. Row j
// >= 1 of `rows` starts at j plan.row(): the left factors of all sums, then the right factors.
template <class Number>
struct SeriesTablesOver {
    const std::array<Number, 3>* factors = nullptr;  // by rule
    Number* now = nullptr;
    Number* rows = nullptr;
};
using SeriesTables = SeriesTablesOver<double>;

// State of the loop that makes a motion's coefficients until they are small. Machine code relies on its layout.
struct MotionOrders {
    double* row = nullptr;            // the order made last: q, v, event functions; order k + 1 follows
    const double* largest = nullptr;  // the coefficient in that row that is compared
    double power = 1.0;               // the unit of that coefficient times target^k
    double target = 1.0;              // the time (s) at which terms are compared
    const double* last = nullptr;     // row in the tables of the highest allowed order
    double one = 1.0;
    double magnitude[2] = {std::bit_cast<double>(~std::uint64_t{0} >> 1), 0.0};  // mask that clears the sign bit
};

// Computes order k >= 1 of all series, and the inner sums of order k + 1 (recurrence.hpp).
void make_order(const SeriesPlan& plan, const SeriesTables& tables, int k);

// Computes the orders from k >= 2 on, after order k - 1. Stops at `last`, or at the first order at which the compared
// coefficient times its power is not above 1. Returns the order reached.
int make_orders(const SeriesPlan& plan, const SeriesTables& tables, MotionOrders& motion, int k, int last);

// Machine code for these functions and one plan, with vectors of four or eight. All terms of the inner sums except the
// two with row k are added before the rules, so that the processor can overlap both. The results are the same to the
// last bit.
class OrderCode {
 public:
    // Returns null if machine code is not available.
    static std::shared_ptr<const OrderCode> of(const SeriesPlan& plan, Width width);
    static constexpr int highest_order = 34;

    void make_first(const SeriesTables& tables) const {
        first_(tables.now, tables.factors, tables.rows + row_, tables.rows + row_, weights(1), nullptr);
    }
    // Order k >= 2. Requires a plan without coordinates; order k of its inputs is in the tables.
    void make_given(const SeriesTables& tables, int k) const {
        given_(tables.now, tables.factors, tables.rows + row_, tables.rows + static_cast<std::size_t>(k) * row_,
               weights(k), nullptr);
    }
    // Requires the plan of a motion.
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
    Function *first_ = nullptr, *later_ = nullptr, *given_ = nullptr;
    std::size_t row_ = 0, states_ = 0;
    // For each order k: k and 1/(k + 1), and both again as vectors for the vector in which only the first lanes are
    // weighted.
    std::vector<double> weights_;
};

// Which series, and which factors of rules, differ between lanes. If empty, all do.
struct VariedNumbers {
    std::vector<bool> series;
    std::vector<std::array<bool, 3>> factors;
};

// The inner sums when eight runs are computed at once: what is stored of each order for the inner sums of later orders,
// and which stored numbers each sum multiplies.
//
// For one run, several inner sums share a vector. For eight runs each number is a vector: no number changes its lane,
// each row is loaded once for all sums with one factor, and there is more independent work to overlap with waiting
// rules.
struct LanePlan {
    struct StoredSums {
        std::uint32_t series;
        bool weighted;         // multiplied by the order
        bool uniform = false;  // the same in all lanes
    };
    struct LaneSum {
        std::uint32_t left, right;  // indices into `stored`
    };
    std::vector<StoredSums> stored;
    std::vector<LaneSum> sums;  // in the order of the plan: the first plan.weighted are weighted
    VariedNumbers varied;

    LanePlan(const SeriesPlan& plan, std::size_t inner_sums, VariedNumbers varied_numbers = {});
};

// Machine code for the orders of all series of eight runs at once. Its results have the same bits as recurrence.hpp.
class LaneOrderCode {
 public:
    // Generates code for vectors of four or eight doubles. Returns null if machine code is switched off or not
    // available for such vectors, or if the plan has too many rules.
    static std::shared_ptr<const LaneOrderCode> of(const SeriesPlan& plan, const LanePlan& lanes, Width vectors);

    // The size of `now` below, in numbers of eight doubles.
    std::size_t numbers() const { return (first_row_ + OrderCode::highest_order * row_) / Double8::count; }
    // Computes orders 1 .. last, last >= 4, or orders k .. last after such a call. On entry `now` holds order 1 of q
    // and v, and inner sums of zero. All numbers are eight doubles. `now` holds one order of the series and the inner
    // sums (SeriesPlan::numbers()), then the stored rows from row 1 on. `motion` is the row of order k of q, v and the
    // event functions; that of order k - 1 precedes it. `factors` has three numbers per rule.
    void make_orders(const double* factors, double* now, double* motion, int k, int last) const {
        const auto* const weights = weights_.data();
        const auto below = static_cast<std::size_t>(k - 1);
        (k == 1 ? first_ : later_)(now, factors, now + first_row_ + below * row_, weights[below].data(),
                                   weights[last - 1].data(), motion);
    }

 private:
    using Function = void(double* now, const double* factors, double* row, const double* weights, const double* last,
                          double* motion);
    std::shared_ptr<const MachineCode> code_;
    Function *first_ = nullptr, *later_ = nullptr;
    std::size_t first_row_ = 0, row_ = 0;         // in doubles
    std::vector<std::array<double, 3>> weights_;  // for each order k: k, 1/(k + 1), 1/k
};

}  // namespace achilles
