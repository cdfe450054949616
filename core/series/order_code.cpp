// One order of all series as machine code.
#include <algorithm>
#include <span>

#include "program/machine.hpp"
#include "series/order.hpp"
#include "series/rule_code.hpp"

namespace achilles {

namespace {

using Base = Assembler::Base;
using Code = Assembler::Code;

// The function's arguments, by the calling convention, and the pointers of the loop over older rows.
constexpr Base now = Base::rdi, factors = Base::rsi, first_row = Base::rdx, row = Base::rcx, weights = Base::r8,
               motion = Base::r9, left_row = Base::rax, right_row = Base::r10, last_pair = Base::r11;
constexpr unsigned scratch = 4;  // free vector registers

using Index = std::ptrdiff_t;  // of doubles

// Lanes [begin, begin + width).
struct Part {
    Index begin;
    Width width;
    Index end() const { return begin + static_cast<Index>(width); }
};

// Where a member of SeriesMotion stands.
#define ACHILLES_PLACE(member) (static_cast<Index>(offsetof(SeriesMotion, member) / sizeof(double)))

}  // namespace

class OrderWriter {
 public:
    OrderWriter(const SeriesPlan& plan, Width width)
        : plan_(plan),
          lanes_(static_cast<Index>(plan.lanes)),
          weighted_(static_cast<Index>(plan.weighted)),
          sums_(static_cast<Index>(plan.series)),
          code_(now, scratch) {
        for (Index lane = 0; lane < lanes_; lane = parts_.back().end())
            parts_.push_back({lane, lanes_ - lane < 8 ? Width::four : width});
    }

    // Write a function; return where it begins.
    std::size_t write_first() {
        const std::size_t begin = code_.here();
        code_.forget_all();
        write_order(true);
        code_.leave_at_once();
        return begin;
    }
    std::size_t write_later() {
        const std::size_t begin = code_.here();
        code_.forget_all();
        sum_older();
        inputs();
        write_order(false);
        const std::size_t small = keep_and_compare();
        const std::size_t last = code_.jump_if_not_below(row, last_pair);
        code_.address(row, row, 2 * lanes_);
        code_.address(weights, weights, OrderCode::weights_per_order);
        code_.jump_back(begin);
        code_.land(small);
        code_.land(last);
        code_.leave_at_once();
        return begin;
    }
    const std::vector<std::uint8_t>& bytes() const { return code_.bytes(); }

 private:
    Index older() const { return sums_ + lanes_; }

    void write_order(bool first) {
        for (std::size_t i = 0; i < plan_.rules.size(); ++i)
            write_rule(code_, plan_.rules[i], factors, static_cast<Index>(3 * i));
        for (const Part& part : parts_) keep_and_sum(part, first);
    }

    // ---- terms of the inner sums that lie before this order ----

    // Two rows at a time, into sums of their own; so many vectors at once as there are registers.
    void sum_older() {
        constexpr std::size_t most = 6;
        for (std::size_t i = 0; i < parts_.size(); i += most)
            sum_older(std::span(parts_).subspan(i, std::min(most, parts_.size() - i)));
    }
    void sum_older(std::span<const Part> parts) {
        const Index stride = 2 * lanes_;
        const auto count = static_cast<unsigned>(parts.size());
        for (unsigned i = 0; i < 2 * count; ++i) code_.zero(2 + i);
        code_.address(left_row, first_row, stride);
        code_.address(right_row, row, -stride);
        code_.address(last_pair, row, -stride);
        const std::size_t skip = code_.jump_if_not_below(left_row, last_pair);
        const std::size_t loop = code_.here();
        add_products(parts, 2, 0, 0);
        add_products(parts, 2 + count, stride, -stride);
        code_.address(left_row, left_row, 2 * stride);
        code_.address(right_row, right_row, -2 * stride);
        code_.jump_back_if_below(left_row, last_pair, loop);
        code_.land(skip);
        const std::size_t none = code_.jump_if_not_below(left_row, row);
        add_products(parts, 2, 0, 0);
        code_.land(none);
        for (unsigned i = 0; i < count; ++i) {
            code_.registers(Code::add, parts[i].width, 2 + i, 2 + i, 2 + count + i);
            code_.memory(Code::store, parts[i].width, 2 + i, now, older() + parts[i].begin);
        }
    }
    // sums[i] += left * right
    void add_products(std::span<const Part> parts, unsigned sums, Index left, Index right) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Part& part = parts[i];
            const auto reg = static_cast<unsigned>(i % 2), sum = sums + static_cast<unsigned>(i);
            code_.memory(Code::load, part.width, reg, 0, left_row, left + part.begin);
            code_.memory(Code::multiply, part.width, reg, reg, right_row, right + part.begin + lanes_);
            code_.registers(Code::add, part.width, sum, sum, reg);
        }
    }

    // ---- the motion ----

    void inputs() {
        constexpr Base below = left_row;
        constexpr unsigned inverse = 0;
        const auto n = static_cast<std::uint32_t>(plan_.coordinates());
        code_.load_address(below, motion, ACHILLES_PLACE(row));
        code_.memory(Code::load, Width::one, inverse, weights, 1 - OrderCode::weights_per_order);  // 1/k
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const unsigned result = code_.result(1 + i);
            if (i < n) {
                code_.memory(Code::multiply, Width::one, result, inverse, below, n + i);
            } else {
                code_.apply(Code::multiply, result, inverse, plan_.outputs[i - n]);
            }
            code_.store(result, 1 + i);
            code_.memory(Code::store, Width::one, result, below, 2 * n + 1 + i);
        }
    }

    // A jump if what is compared is not above 1 any more. Leaves the last row in last_pair.
    std::size_t keep_and_compare() {
        constexpr Base state = left_row, largest = right_row;
        const auto width = static_cast<Index>(plan_.states());
        const std::uint32_t watched = plan_.outputs.back();
        code_.load_address(state, motion, ACHILLES_PLACE(row));
        code_.address(state, state, width);
        code_.store_address(state, motion, ACHILLES_PLACE(row));
        auto held = code_.holder(watched);
        if (!held) code_.get(0, watched);
        code_.memory(Code::store, Width::one, held ? *held : 0, state, width - 1);
        code_.load_address(largest, motion, ACHILLES_PLACE(largest));
        code_.address(largest, largest, width);
        code_.store_address(largest, motion, ACHILLES_PLACE(largest));
        code_.load_address(last_pair, motion, ACHILLES_PLACE(last));
        code_.memory(Code::load, Width::one, 0, motion, ACHILLES_PLACE(power));
        code_.memory(Code::multiply, Width::one, 0, 0, motion, ACHILLES_PLACE(target));
        code_.memory(Code::store, Width::one, 0, motion, ACHILLES_PLACE(power));
        code_.memory(Code::load, Width::one, 1, largest, 0);
        code_.memory(Code::both, Width::two, 1, 1, motion, ACHILLES_PLACE(magnitude));
        code_.registers(Code::multiply, Width::one, 0, 0, 1);
        return code_.jump_if_not_above(0, motion, ACHILLES_PLACE(one));
    }

    // ---- this order as a row ----

    // Two numbers side by side.
    void pair(unsigned to, std::uint32_t low, std::uint32_t high) {
        const auto a = code_.holder(low), b = code_.holder(high);
        if (!a) code_.get(to, low);
        const unsigned from = a ? *a : to;
        if (b) {
            code_.registers(Code::unpack, Width::two, to, from, *b);
        } else {
            code_.memory(Code::load_high, Width::one, to, from, now, high);
        }
    }
    // So many as the width says, side by side, in `to`; `free` and the next are lost.
    void gather(const std::uint32_t* numbers, Width width, unsigned to, unsigned free) {
        pair(to, numbers[0], numbers[1]);
        pair(free, numbers[2], numbers[3]);
        code_.join(Width::four, to, to, free);
        if (width != Width::eight) return;
        pair(free, numbers[4], numbers[5]);
        pair(free + 1, numbers[6], numbers[7]);
        code_.join(Width::four, free, free, free + 1);
        code_.join(Width::eight, to, to, free);
    }

    // reg *= the order (which = 0) or its successor's inverse (1), in the lanes that are weighted
    void weigh(const Part& part, unsigned reg, Index which, unsigned free) {
        if (part.begin >= weighted_) return;
        if (part.end() <= weighted_) {
            code_.broadcast(part.width, free, weights, which);
            code_.registers(Code::multiply, part.width, reg, reg, free);
        } else {
            code_.memory(Code::multiply, part.width, reg, reg, weights, 2 + 8 * which);
        }
    }

    void keep_and_sum(const Part& part, bool first) {
        const Index right = part.begin + lanes_;
        constexpr unsigned x = 0, y = 1;
        gather(plan_.left.data() + part.begin, part.width, x, 1);
        weigh(part, x, 0, 1);
        code_.memory(Code::store, part.width, x, row, part.begin);
        gather(plan_.right.data() + part.begin, part.width, y, 2);
        code_.memory(Code::store, part.width, y, row, right);
        code_.memory(Code::multiply, part.width, y, y, first_row, part.begin);
        if (!first) {
            code_.memory(Code::multiply, part.width, x, x, first_row, right);
            code_.registers(Code::add, part.width, y, y, x);
            code_.memory(Code::add, part.width, y, y, now, older() + part.begin);
        }
        weigh(part, y, 1, 2);
        code_.memory(Code::store, part.width, y, now, sums_ + part.begin);
    }

    const SeriesPlan& plan_;
    Index lanes_, weighted_, sums_;
    Assembler code_;
    std::vector<Part> parts_;
};

std::shared_ptr<const OrderCode> OrderCode::of(const SeriesPlan& plan, Width width) {
    const auto best = best_width();
    if (!best || width > *best || plan.rules.empty() || plan.rules.size() > most_rules_in_code) return nullptr;
    OrderWriter writer(plan, width);
    const std::size_t first = writer.write_first();
    const std::optional<std::size_t> later = plan.outputs.empty() ? std::nullopt : std::optional(writer.write_later());
    auto order = std::make_shared<OrderCode>();
    order->code_ = MachineCode::of(writer.bytes());
    if (!order->code_) return nullptr;
    order->first_ = order->code_->as<Function>(first);
    if (later) order->later_ = order->code_->as<Function>(*later);
    order->row_ = plan.row();
    order->states_ = later ? plan.states() : 0;
    const std::size_t mixed = plan.weighted % static_cast<std::size_t>(width);
    for (int k = 0; k <= highest_order; ++k) {
        const double weight = k, inverse = 1.0 / static_cast<double>(k + 1);
        order->weights_.insert(order->weights_.end(), {weight, inverse});
        for (const double x : {weight, inverse})
            for (std::size_t lane = 0; lane < 8; ++lane) order->weights_.push_back(lane < mixed ? x : 1.0);
    }
    return order;
}

}  // namespace achilles
