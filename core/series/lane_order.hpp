// The orders of all series of a program in eight runs at once: recurrence.hpp with a vector for every number.
//
// One run's inner sums fill a vector by themselves; eight runs' need no number to change its place, load each row once
// for all sums with one factor, and have eight times as much to do while a rule waits for the one before.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "number/eight.hpp"
#include "series/order.hpp"

namespace achilles {

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
