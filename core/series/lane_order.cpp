#include "series/lane_order.hpp"

#include <map>
#include <set>

namespace achilles {

LanePlan::LanePlan(const SeriesPlan& plan, std::size_t inner_sums) {
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> places;
    const auto place = [&](std::uint32_t series, bool weighted) {
        const auto [found, fresh] =
            places.emplace(std::pair(series, weighted), static_cast<std::uint32_t>(kept.size()));
        if (fresh) kept.push_back({series, weighted});
        return found->second;
    };
    // Which factor of an unweighted sum is the left one does not matter: the fewer there are on each side, the fewer
    // must be fetched.
    std::set<std::uint32_t> on_left, on_right;
    const auto more = [&](const Sum& sum) {
        return static_cast<int>(!on_left.contains(sum.left)) + static_cast<int>(!on_right.contains(sum.right));
    };
    for (std::size_t i = 0; i < inner_sums; ++i) {
        const bool is_weighted = i < plan.weighted;
        Sum sum{place(plan.left[i], is_weighted), place(plan.right[i], false)};
        const Sum turned{sum.right, sum.left};
        if (!is_weighted && more(turned) < more(sum)) sum = turned;
        on_left.insert(sum.left);
        on_right.insert(sum.right);
        sums.push_back(sum);
    }
}

}  // namespace achilles
