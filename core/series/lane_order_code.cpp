// The orders of eight runs as machine code.
#include <algorithm>
#include <map>
#include <numeric>
#include <span>

#include "program/machine.hpp"
#include "series/lane_order.hpp"
#include "series/rule_code.hpp"

namespace achilles {

namespace {

using Base = Assembler::Base;
using Code = Assembler::Code;
using Index = std::ptrdiff_t;  // of doubles

// The function's arguments, by the calling convention, and the pointers of the loop over older rows.
constexpr Base now = Base::rdi, factors = Base::rsi, row = Base::rdx, weights = Base::rcx, last = Base::r8,
               motion = Base::r9, left_row = Base::rax, right_row = Base::r10, before = Base::r11;
constexpr unsigned scratch = 3;     // free vector registers
constexpr unsigned first_sum = 16;  // and those of inner sums
constexpr std::size_t most_sums = 16;
constexpr Width eight = Width::eight;
constexpr Index by_order = 0, by_inverse_of_next = 1, by_inverse = 2, weights_per_order = 3;

Index lane(std::size_t number) { return static_cast<Index>(number * Eight::count); }

}  // namespace

class LaneOrderWriter {
 public:
    LaneOrderWriter(const SeriesPlan& plan, const LanePlan& lanes)
        : plan_(plan),
          lanes_(lanes),
          code_(now, scratch, eight),
          by_left_(lanes.sums.size()),
          all_held_(2 * plan.coordinates() + plan.rules.size() <= code_.room()),
          one_group_(lanes.sums.size() <= most_sums) {
        std::iota(by_left_.begin(), by_left_.end(), 0u);
        std::stable_sort(by_left_.begin(), by_left_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return sum(a).left < sum(b).left; });
    }

    // Orders 1 to 3, then the others, which are alike.
    void write() {
        for (unsigned k = 1; k <= 3; ++k) order(k);
        const std::size_t loop = code_.here();
        order(4);
        code_.jump_back_if_not_above(weights, last, loop);  // the weights tell the orders apart
        code_.leave_at_once();
    }
    const std::vector<std::uint8_t>& bytes() const { return code_.bytes(); }

 private:
    const LanePlan::Sum& sum(std::uint32_t i) const { return lanes_.sums[i]; }
    Index stride() const { return lane(lanes_.kept.size()); }
    // Row 1, from `now` on.
    Index first_row() const { return lane(plan_.numbers()) + stride(); }

    // Order k, 4 for all that follow; and on to the next.
    void order(unsigned k) {
        remember(k > 1);
        inputs(k == 1);
        for (std::size_t i = 0; i < plan_.rules.size(); ++i)
            write_rule(code_, plan_.rules[i], factors, lane(3 * i), !all_held_);
        code_.memory(Code::store, eight, held(plan_.outputs.back(), 0), motion, lane(plan_.states() - 1));
        keep();
        add_up(k);
        code_.address(row, row, stride());
        code_.address(motion, motion, lane(plan_.states()));
        code_.address(weights, weights, weights_per_order);
    }

    // What the order before has left in registers: results have the same ones in all orders.
    void remember(bool any) {
        std::vector<std::pair<std::uint32_t, unsigned>> left;
        if (any && all_held_)
            for (const std::uint32_t output : plan_.outputs)
                if (const auto reg = code_.holder(output)) left.emplace_back(output, *reg);
        if (any && one_group_)
            for (unsigned i = 0; i < by_left_.size(); ++i) left.emplace_back(plan_.series + by_left_[i], first_sum + i);
        code_.forget_all();
        for (const auto& [number, reg] : left) code_.hold(number, reg);
    }

    // So many sums at once as there are registers; those with one left factor load it once. The terms with row k come
    // last, before them those with row k - 1: the others need not wait.
    void add_up(unsigned k) {
        const std::span<const std::uint32_t> all(by_left_);
        for (std::size_t i = 0; i < all.size(); i += most_sums)
            add_up(all.subspan(i, std::min(most_sums, all.size() - i)), k);
    }
    void add_up(std::span<const std::uint32_t> sums, unsigned k) {
        const Index first = first_row(), next = stride();
        code_.zero(0);
        for (unsigned i = 0; i < sums.size(); ++i) code_.registers(Code::load, eight, first_sum + i, 0, 0);
        if (k >= 4) {
            code_.address(left_row, now, first + 2 * next);
            code_.address(right_row, row, -2 * next);
            code_.address(before, row, -next);
            const std::size_t none = code_.jump_if_not_below(left_row, before);
            const std::size_t loop = code_.here();
            add_products(sums, left_row, 0, right_row, 0);
            code_.address(left_row, left_row, next);
            code_.address(right_row, right_row, -next);
            code_.jump_back_if_below(left_row, before, loop);
            code_.land(none);
        }
        if (k >= 3) add_products(sums, now, first + next, row, -next);
        if (k >= 4) add_products(sums, row, -next, now, first + next);
        if (k >= 2) add_products(sums, row, 0, now, first);
        for (unsigned i = 0; i < sums.size(); ++i) finish(sums[i], first_sum + i);
    }
    // The right factors are fetched once too where there are registers for them.
    void add_products(std::span<const std::uint32_t> sums, Base left, Index to_left, Base right, Index to_right) {
        constexpr unsigned x = 0, product = 1, last_register = 31;
        std::map<std::uint32_t, unsigned> fetched;
        unsigned next = first_sum + static_cast<unsigned>(sums.size());
        for (const std::uint32_t i : sums)
            if (next <= last_register && fetched.emplace(sum(i).right, next).second)
                code_.memory(Code::load, eight, next++, right, to_right + lane(sum(i).right));
        for (unsigned i = 0; i < sums.size(); ++i) {
            const auto [x_place, y_place] = sum(sums[i]);
            if (i == 0 || sum(sums[i - 1]).left != x_place)
                code_.memory(Code::load, eight, x, left, to_left + lane(x_place));
            if (const auto y = fetched.find(y_place); y != fetched.end()) {
                code_.registers(Code::multiply, eight, product, x, y->second);
            } else {
                code_.memory(Code::multiply, eight, product, x, right, to_right + lane(y_place));
            }
            code_.registers(Code::add, eight, first_sum + i, first_sum + i, product);
        }
    }

    // The term x_1 y_k, from the register of y_k where it has one.
    void finish(std::uint32_t i, unsigned total) {
        constexpr unsigned product = 1, weight = 2;
        const auto [left, right] = sum(i);
        const auto newest = code_.holder(lanes_.kept[right].series);
        if (!newest) code_.memory(Code::load, eight, product, row, lane(right));
        code_.memory(Code::multiply, eight, product, newest ? *newest : product, now, first_row() + lane(left));
        code_.registers(Code::add, eight, total, total, product);
        if (i < plan_.weighted) {
            code_.broadcast(eight, weight, weights, by_inverse_of_next);
            code_.registers(Code::multiply, eight, total, total, weight);
        }
        if (!one_group_) code_.memory(Code::store, eight, total, now, lane(plan_.series + i));
    }

    // The register that holds a number, or else this one, with it.
    unsigned held(std::uint32_t number, unsigned otherwise) {
        if (const auto reg = code_.holder(number)) return *reg;
        code_.get(otherwise, number);
        return otherwise;
    }

    // q_k = v_{k-1}/k, v_k = v'_{k-1}/k; those of order 1 are given.
    void inputs(bool given) {
        constexpr unsigned inverse = 0;
        const auto n = static_cast<std::uint32_t>(plan_.coordinates());
        code_.broadcast(eight, inverse, weights, by_inverse);
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const unsigned result = code_.result(1 + i);
            if (given) {
                code_.memory(Code::load, eight, result, now, lane(1 + i));
                continue;
            }
            if (i < n) {
                const Index below = lane(n + i) - lane(plan_.states());
                code_.memory(Code::multiply, eight, result, inverse, motion, below);
            } else {
                code_.apply(Code::multiply, result, inverse, plan_.outputs[i - n]);
            }
            if (!all_held_) code_.store(result, 1 + i);
            code_.memory(Code::store, eight, result, motion, lane(i));
        }
    }

    void keep() {
        for (std::size_t i = 0; i < lanes_.kept.size(); ++i) {
            const auto [series, weighted] = lanes_.kept[i];
            unsigned reg = held(series, 0);
            if (weighted) {
                code_.broadcast(eight, 1, weights, by_order);
                code_.registers(Code::multiply, eight, 1, 1, reg);
                reg = 1;
            }
            code_.memory(Code::store, eight, reg, row, lane(i));
        }
    }

    const SeriesPlan& plan_;
    const LanePlan& lanes_;
    Assembler code_;
    std::vector<std::uint32_t> by_left_;  // the sums
    bool all_held_;                       // no result leaves its register before the order is through
    bool one_group_;                      // all sums have registers of their own
};

std::shared_ptr<const LaneOrderCode> LaneOrderCode::of(const SeriesPlan& plan, const LanePlan& lanes) {
    if (best_width() != Width::eight || plan.rules.size() > most_rules_in_code) return nullptr;
    LaneOrderWriter writer(plan, lanes);
    writer.write();
    auto orders = std::make_shared<LaneOrderCode>();
    orders->code_ = MachineCode::of(writer.bytes());
    if (!orders->code_) return nullptr;
    orders->function_ = orders->code_->as<Function>();
    orders->first_row_ = (plan.numbers() + lanes.kept.size()) * Eight::count;
    orders->states_ = plan.states() * Eight::count;
    for (int k = 1; k <= OrderCode::highest_order; ++k) {
        const double order = k;
        orders->weights_.push_back({order, 1.0 / (order + 1.0), 1.0 / order});
    }
    return orders;
}

}  // namespace achilles
