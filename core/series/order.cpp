#include "series/order.hpp"

#include <cmath>

#include "series/recurrence.hpp"

namespace achilles {

void make_order(const SeriesPlan& plan, const SeriesTables& tables, int k) {
    make_order(plan, InnerSums<double>(plan), tables, static_cast<std::size_t>(k));
}

int make_orders(const SeriesPlan& plan, const SeriesTables& tables, MotionOrders& motion, int k, int last) {
    for (;; ++k) {
        motion.row += plan.states();
        make_motion_order(plan, InnerSums<double>(plan), tables, motion.row, static_cast<std::size_t>(k));
        motion.largest += plan.states();
        motion.power *= motion.target;
        if (k >= last || !(motion.power * std::abs(*motion.largest) > 1.0)) return k;
    }
}

}  // namespace achilles
