// Machine code for the orders of eight runs.
#include <algorithm>
#include <map>
#include <numeric>
#include <span>

#include "program/assembler.hpp"
#include "series/order.hpp"
#include "series/rule_code.hpp"

namespace achilles {

namespace {

using Xbyak::Xmm;
using Index = std::ptrdiff_t;  // in doubles

// The function's arguments, by the calling convention, and pointers of the loop over older rows.
constexpr Xbyak::Reg64 now = Xbyak::util::rdi, factors = Xbyak::util::rsi, row = Xbyak::util::rdx,
                       weights = Xbyak::util::rcx, last = Xbyak::util::r8, motion = Xbyak::util::r9,
                       left_row = Xbyak::util::rax, right_row = Xbyak::util::r10, before = Xbyak::util::r11;
constexpr unsigned scratch = 3;  // registers for temporary use
constexpr Index by_order = 0, by_inverse_of_next = 1, by_inverse = 2, weights_per_order = 3;

Index lane(std::size_t number) { return static_cast<Index>(number * Double8::count); }

}  // namespace

// AVX-512 has 32 vector registers. Sixteen are for inner sums; if all sums fit, they and the results stay there from
// one order to the next. With vectors of four there are 16, and a number fills two. Each half of an order is then
// emitted separately, inner sums reuse the registers of its results, and all results are in memory.
class LaneOrderWriter {
 public:
    LaneOrderWriter(const SeriesPlan& plan, const LanePlan& lanes, Width vectors)
        : plan_(plan),
          lanes_(lanes),
          code_(now, scratch, Width::eight, vectors),
          by_left_(lanes.sums.size()),
          many_registers_(vectors == Width::eight),
          first_sum_(many_registers_ ? 16 : scratch),
          end_of_registers_(many_registers_ ? 32 : 16),
          all_held_(many_registers_ && plan.clock == 0 && 2 * plan.coordinates() + plan.rules.size() <= code_.room()),
          one_group_(many_registers_ && lanes.sums.size() <= end_of_registers_ - first_sum_) {
        std::iota(by_left_.begin(), by_left_.end(), 0u);
        std::stable_sort(by_left_.begin(), by_left_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return sum(a).left < sum(b).left; });
    }

    // Orders 1 to 3, then a loop for the others.
    void write() {
        for (unsigned k = 1; k <= 3; ++k) order(k);
        const Xbyak::Label loop = code_.L();
        order(4);
        code_.cmp(weights, last);
        code_.jbe(loop);  // the address of the weights gives the order
        code_.vzeroupper();
        code_.ret();
    }
    std::span<const std::uint8_t> bytes() { return code_.bytes(); }

 private:
    const LanePlan::LaneSum& sum(std::uint32_t i) const { return lanes_.sums[i]; }
    Index stride() const { return lane(lanes_.stored.size()); }
    // Offset of row 1 from `now`.
    Index first_row() const { return lane(plan_.numbers()) + stride(); }
    // The current part of a number, as an operand at an offset from an address.
    Xbyak::Address part(const Xbyak::Reg64& base, Index number) const { return at(base, number + code_.part()); }
    Xmm vector(std::size_t reg) const { return code_.vector(static_cast<unsigned>(reg)); }

    // Order k, where 4 stands for all higher ones; then advances to the next order.
    void order(unsigned k) {
        code_.for_each_part([&] { part_of_order(k); });
        code_.lea(row, at(row, stride()));
        code_.lea(motion, at(motion, lane(plan_.states())));
        code_.lea(weights, at(weights, weights_per_order));
    }

    void part_of_order(unsigned k) {
        remember(k > 1);
        inputs(k == 1);
        for (std::size_t i = 0; i < plan_.rules.size(); ++i)
            RuleWriter(code_, factors).write(plan_.rules[i], lane(3 * i) + code_.part(), !all_held_);
        for (std::size_t i = 0; i < plan_.events; ++i)
            code_.vmovupd(part(motion, lane(2 * plan_.coordinates() + i)), code_.held_or(vector(0), plan_.event(i)));
        keep();
        if (!all_held_) code_.forget_all();
        add_up(k);
    }

    // Restores which numbers the previous order left in registers: each result has the same register in all orders.
    void remember(bool any) {
        std::vector<std::pair<std::uint32_t, unsigned>> left;
        if (any && all_held_)
            for (const std::uint32_t output : plan_.outputs)
                if (const auto reg = code_.holder(output)) left.emplace_back(output, reg->getIdx());
        if (any && one_group_)
            for (unsigned i = 0; i < by_left_.size(); ++i)
                left.emplace_back(plan_.series + by_left_[i], first_sum_ + i);
        code_.forget_all();
        for (const auto& [number, reg] : left) code_.hold(number, reg);
    }

    // As many sums at once as there are registers; sums with a common left factor load it once. The terms with row k
    // come last, preceded by those with row k - 1, so that the others need not wait.
    void add_up(unsigned k) {
        const std::span<const std::uint32_t> all(by_left_);
        const std::size_t most = end_of_registers_ - first_sum_;
        for (std::size_t i = 0; i < all.size(); i += most) add_up(all.subspan(i, std::min(most, all.size() - i)), k);
    }
    void add_up(std::span<const std::uint32_t> sums, unsigned k) {
        const Index first = first_row(), next = stride();
        code_.zero(vector(0));
        for (unsigned i = 0; i < sums.size(); ++i) code_.vmovapd(vector(first_sum_ + i), vector(0));
        if (k >= 4) {
            code_.lea(left_row, at(now, first + 2 * next));
            code_.lea(right_row, at(row, -2 * next));
            code_.lea(before, at(row, -next));
            Xbyak::Label none;
            code_.cmp(left_row, before);
            code_.jae(none);
            const Xbyak::Label loop = code_.L();
            add_products(sums, left_row, 0, right_row, 0);
            code_.lea(left_row, at(left_row, next));
            code_.lea(right_row, at(right_row, -next));
            code_.cmp(left_row, before);
            code_.jb(loop);
            code_.L(none);
        }
        if (k >= 3) add_products(sums, now, first + next, row, -next);
        if (k >= 4) add_products(sums, row, -next, now, first + next);
        if (k >= 2) add_products(sums, row, 0, now, first);
        for (unsigned i = 0; i < sums.size(); ++i) finish(sums[i], vector(first_sum_ + i));
    }
    // Right factors are loaded once, too, as far as idle registers allow.
    void add_products(std::span<const std::uint32_t> sums, const Xbyak::Reg64& left, Index to_left,
                      const Xbyak::Reg64& right, Index to_right) {
        const Xmm x = vector(0), product = vector(1);
        std::map<std::uint32_t, unsigned> fetched;
        const unsigned end_of_sums = first_sum_ + static_cast<unsigned>(sums.size());
        unsigned idle = all_held_ ? end_of_sums : scratch;
        for (const std::uint32_t i : sums) {
            if (idle == first_sum_) idle = end_of_sums;
            if (idle < end_of_registers_ && fetched.emplace(sum(i).right, idle).second)
                code_.vmovupd(vector(idle++), part(right, to_right + lane(sum(i).right)));
        }
        for (unsigned i = 0; i < sums.size(); ++i) {
            const auto [x_place, y_place] = sum(sums[i]);
            if (i == 0 || sum(sums[i - 1]).left != x_place) code_.vmovupd(x, part(left, to_left + lane(x_place)));
            if (const auto y = fetched.find(y_place); y != fetched.end()) {
                code_.vmulpd(product, x, vector(y->second));
            } else {
                code_.vmulpd(product, x, part(right, to_right + lane(y_place)));
            }
            code_.vaddpd(vector(first_sum_ + i), vector(first_sum_ + i), product);
        }
    }

    // Adds the term x_1 y_k, with y_k from its register if it has one.
    void finish(std::uint32_t i, const Xmm& total) {
        const Xmm product = vector(1), weight = vector(2);
        const auto [left, right] = sum(i);
        const auto newest = code_.holder(lanes_.stored[right].series);
        if (!newest) code_.vmovupd(product, part(row, lane(right)));
        code_.vmulpd(product, newest ? *newest : product, part(now, first_row() + lane(left)));
        code_.vaddpd(total, total, product);
        if (i < plan_.weighted) {
            code_.broadcast(weight, at(weights, by_inverse_of_next));
            code_.vmulpd(total, total, weight);
        }
        if (!one_group_) code_.vmovupd(part(now, lane(plan_.series + i)), total);
    }

    // q_k = v_{k-1}/k, v_k = v'_{k-1}/k; order 1 is given.
    void inputs(bool given) {
        const Xmm inverse = vector(0);
        const auto n = static_cast<std::uint32_t>(plan_.coordinates());
        code_.broadcast(inverse, at(weights, by_inverse));
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const Xmm result = code_.result(1 + i);
            if (given) {
                code_.vmovupd(result, part(now, lane(1 + i)));
                continue;
            }
            if (i < n) {
                const Index below = lane(n + i) - lane(plan_.states());
                code_.vmulpd(result, inverse, part(motion, below));
            } else {
                code_.apply(Assembler::vmul, result, inverse, plan_.outputs[i - n]);
            }
            if (!all_held_) code_.store(result, 1 + i);
            code_.vmovupd(part(motion, lane(i)), result);
        }
    }

    void keep() {
        const Xmm weight = vector(1);
        for (std::size_t i = 0; i < lanes_.stored.size(); ++i) {
            const auto [series, weighted] = lanes_.stored[i];
            const Xmm number = code_.held_or(vector(0), series);
            if (weighted) {
                code_.broadcast(weight, at(weights, by_order));
                code_.vmulpd(weight, weight, number);
            }
            code_.vmovupd(part(row, lane(i)), weighted ? weight : number);
        }
    }

    const SeriesPlan& plan_;
    const LanePlan& lanes_;
    Assembler code_;
    std::vector<std::uint32_t> by_left_;  // the sums, by left factor
    bool many_registers_;
    unsigned first_sum_, end_of_registers_;
    bool all_held_;   // every result keeps its register until the end of the order
    bool one_group_;  // every sum has its own register
};

std::shared_ptr<const LaneOrderCode> LaneOrderCode::of(const SeriesPlan& plan, const LanePlan& lanes, Width vectors) {
    const auto best = best_width();
    if (!best || vectors > *best || plan.rules.size() > max_rules_in_code) return nullptr;
    LaneOrderWriter writer(plan, lanes, vectors);
    writer.write();
    auto orders = std::make_shared<LaneOrderCode>();
    orders->code_ = MachineCode::of(writer.bytes());
    if (!orders->code_) return nullptr;
    orders->function_ = orders->code_->as<Function>();
    orders->first_row_ = (plan.numbers() + lanes.stored.size()) * Double8::count;
    orders->states_ = plan.states() * Double8::count;
    for (int k = 1; k <= OrderCode::highest_order; ++k) {
        const double order = k;
        orders->weights_.push_back({order, 1.0 / (order + 1.0), 1.0 / order});
    }
    return orders;
}

}  // namespace achilles
