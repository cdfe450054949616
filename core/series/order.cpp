// The orders of one run by loops, the plan for eight runs, and the instantiation of the series over double.
#include "series/order.hpp"

#include <cmath>
#include <map>
#include <mutex>
#include <new>
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

LanePlan::LanePlan(const SeriesPlan& plan, std::size_t inner_sums, VariedNumbers varied_numbers)
    : varied(std::move(varied_numbers)) {
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> places;
    const auto place = [&](std::uint32_t series, bool weighted) {
        const auto [found, fresh] =
            places.emplace(std::pair(series, weighted), static_cast<std::uint32_t>(stored.size()));
        if (fresh) stored.push_back({series, weighted, !varied.series.empty() && !varied.series[series]});
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
        const bool left_uniform = stored[sum.left].uniform, right_uniform = stored[sum.right].uniform;
        if (!is_weighted && (left_uniform != right_uniform ? left_uniform : more(turned) < more(sum))) sum = turned;
        on_left.insert(sum.left);
        on_right.insert(sum.right);
        sums.push_back(sum);
    }
}

namespace {

constexpr auto line = static_cast<std::align_val_t>(SeriesPlan::aligned * sizeof(double));

struct SpareTables {
    struct Spare {
        void* table;
        std::size_t bytes;
    };
    static constexpr std::size_t most = 16, smallest = 1 << 15, largest = 1 << 20;
    static bool are_kept(std::size_t bytes) { return bytes >= smallest && bytes <= largest; }
    std::mutex mutex;
    std::vector<Spare> spares;
};
// It is never destroyed, because an evaluator may live as long as the program.
SpareTables& spare_tables() {
    static auto* const tables = new SpareTables;
    return *tables;
}

}  // namespace

void* borrow_table(std::size_t bytes) {
    if (SpareTables::are_kept(bytes)) {
        SpareTables& all = spare_tables();
        const std::scoped_lock lock(all.mutex);
        for (SpareTables::Spare& spare : all.spares)
            if (spare.bytes == bytes) {
                void* const table = spare.table;
                spare = all.spares.back();
                all.spares.pop_back();
                return table;
            }
    }
    return ::operator new(bytes, line);
}

void return_table(void* table, std::size_t bytes) {
    if (SpareTables::are_kept(bytes)) {
        SpareTables& all = spare_tables();
        const std::scoped_lock lock(all.mutex);
        if (all.spares.size() < SpareTables::most) return all.spares.push_back({table, bytes});
    }
    ::operator delete(table, line);
}

template class SeriesEvaluator<double>;

}  // namespace achilles
