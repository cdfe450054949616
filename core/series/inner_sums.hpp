// The inner sums of a plan: which there are, each once, and where they stand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "series/order.hpp"

namespace achilles {

// Sums over 0 < j < k of x_j y_{k-j}, or, weighted, of j x_j y_{k-j}/k.
class InnerSums {
 public:
    // The sum of these series, as an operand of a rule until it has its place.
    std::uint32_t of(std::uint32_t x, std::uint32_t y, bool weighted) {
        const auto [found, fresh] = ids_.emplace(std::tuple(x, y, weighted), static_cast<std::uint32_t>(sums_.size()));
        if (fresh) sums_.push_back({x, y, weighted});
        return mark | found->second;
    }
    std::size_t count() const { return sums_.size(); }

    // Gives each a lane behind the plan's series, and the operands of the rules their places. Weighted sums come first:
    // their left factors are stored times the order.
    void place(SeriesPlan& plan) const {
        std::vector<std::uint32_t> position(sums_.size());
        for (const bool weighted : {true, false}) {
            for (std::size_t i = 0; i < sums_.size(); ++i) {
                if (sums_[i].weighted != weighted) continue;
                position[i] = plan.series + static_cast<std::uint32_t>(plan.left.size());
                plan.left.push_back(sums_[i].x);
                plan.right.push_back(sums_[i].y);
            }
            if (weighted) plan.weighted = static_cast<std::uint32_t>(plan.left.size());
        }
        // One vector at least: the rows tell the orders apart.
        plan.lanes = static_cast<std::uint32_t>(std::max<std::size_t>(1, (sums_.size() + 3) / 4) * 4);
        plan.left.resize(plan.lanes, 0);
        plan.right.resize(plan.lanes, 0);
        for (SeriesRule& rule : plan.rules)
            for (std::uint32_t* operand : {&rule.x, &rule.y, &rule.w})
                if (*operand & mark) *operand = position[*operand & ~mark];
    }

 private:
    static constexpr std::uint32_t mark = 1u << 31;
    struct Sum {
        std::uint32_t x, y;
        bool weighted;
    };
    std::vector<Sum> sums_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, std::uint32_t> ids_;
};

}  // namespace achilles
