// The orders of one run by loops, the plan for eight runs, and the instantiation of the series over double.
#include "series/order.hpp"

#include <cmath>
#include <map>
#include <set>

#include "series/evaluator.hpp"
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

LanePlan::LanePlan(const SeriesPlan& plan, std::size_t inner_sums) {
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> places;
    const auto place = [&](std::uint32_t series, bool weighted) {
        const auto [found, fresh] =
            places.emplace(std::pair(series, weighted), static_cast<std::uint32_t>(stored.size()));
        if (fresh) stored.push_back({series, weighted});
        return found->second;
    };
    // The factors of an unweighted sum may be swapped. Few distinct factors on each side mean few loads.
    std::set<std::uint32_t> on_left, on_right;
    const auto more = [&](const LaneSum& sum) {
        return static_cast<int>(!on_left.contains(sum.left)) + static_cast<int>(!on_right.contains(sum.right));
    };
    for (std::size_t i = 0; i < inner_sums; ++i) {
        const bool is_weighted = i < plan.weighted;
        LaneSum sum{place(plan.left[i], is_weighted), place(plan.right[i], false)};
        const LaneSum turned{sum.right, sum.left};
        if (!is_weighted && more(turned) < more(sum)) sum = turned;
        on_left.insert(sum.left);
        on_right.insert(sum.right);
        sums.push_back(sum);
    }
}

template class SeriesEvaluator<double>;

}  // namespace achilles
