// Machine code for one order of all series.
#include <algorithm>
#include <span>

#include "program/assembler.hpp"
#include "series/order.hpp"
#include "series/rule_code.hpp"

namespace achilles {

namespace {

using Xbyak::Xmm, Xbyak::Ymm, Xbyak::Zmm, Xbyak::Label;

// The function's arguments, by the calling convention, and pointers of the loop over older rows.
constexpr Xbyak::Reg64 now = Xbyak::util::rdi, factors = Xbyak::util::rsi, first_row = Xbyak::util::rdx,
                       row = Xbyak::util::rcx, weights = Xbyak::util::r8, motion = Xbyak::util::r9,
                       left_row = Xbyak::util::rax, right_row = Xbyak::util::r10, last_pair = Xbyak::util::r11;
constexpr unsigned scratch = 4;  // registers for temporary use

using Index = std::ptrdiff_t;  // in doubles

// Lanes [begin, begin + width).
struct LaneRange {
    Index begin;
    Width width;
    Index end() const { return begin + static_cast<Index>(width); }
    // A register of this part's width.
    Ymm vector(std::size_t reg) const {
        const auto number = static_cast<int>(reg);
        return width == Width::eight ? Zmm(number) : Ymm(number);
    }
};

// Offset of a member of MotionOrders, in doubles.
#define ACHILLES_PLACE(member) (static_cast<Index>(offsetof(MotionOrders, member) / sizeof(double)))

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

    // Emit a function and return its offset in the code.
    std::size_t write_first() {
        const std::size_t begin = code_.getSize();
        code_.forget_all();
        write_order(true);
        code_.vzeroupper();
        code_.ret();
        return begin;
    }
    // Order k >= 2 where order k of the inputs is given.
    std::size_t write_given() {
        const std::size_t begin = code_.getSize();
        code_.forget_all();
        sum_older();
        write_order(false);
        code_.vzeroupper();
        code_.ret();
        return begin;
    }
    std::size_t write_later() {
        const std::size_t begin = code_.getSize();
        Label done;
        const Label next = code_.L();
        code_.forget_all();
        sum_older();
        inputs();
        write_order(false);
        keep_and_compare();
        code_.jbe(done);  // also if either is NaN
        code_.cmp(row, last_pair);
        code_.jae(done);
        code_.lea(row, at(row, 2 * lanes_));
        code_.lea(weights, at(weights, OrderCode::weights_per_order));
        code_.jmp(next);
        code_.L(done);
        code_.vzeroupper();
        code_.ret();
        return begin;
    }
    std::span<const std::uint8_t> bytes() { return code_.bytes(); }

 private:
    Index older() const { return sums_ + lanes_; }

    void write_order(bool first) {
        for (std::size_t i = 0; i < plan_.rules.size(); ++i)
            RuleWriter(code_, factors).write(plan_.rules[i], static_cast<Index>(3 * i));
        for (const LaneRange& part : parts_) keep_and_sum(part, first);
    }

    // ---- terms of the inner sums with rows of earlier orders ----

    // Even and odd rows have separate sums. Processes as many vectors at once as there are registers.
    void sum_older() {
        constexpr std::size_t most = 6;
        for (std::size_t i = 0; i < parts_.size(); i += most)
            sum_older(std::span(parts_).subspan(i, std::min(most, parts_.size() - i)));
    }
    void sum_older(std::span<const LaneRange> parts) {
        const Index stride = 2 * lanes_;
        const std::size_t count = parts.size();
        for (std::size_t i = 0; i < 2 * count; ++i) code_.zero(Xmm(static_cast<int>(2 + i)));
        code_.lea(left_row, at(first_row, stride));
        code_.lea(right_row, at(row, -stride));
        code_.lea(last_pair, at(row, -stride));
        Label no_pair, none;
        code_.cmp(left_row, last_pair);
        code_.jae(no_pair);
        const Label loop = code_.L();
        add_products(parts, 2, 0, 0);
        add_products(parts, 2 + count, stride, -stride);
        code_.lea(left_row, at(left_row, 2 * stride));
        code_.lea(right_row, at(right_row, -2 * stride));
        code_.cmp(left_row, last_pair);
        code_.jb(loop);
        code_.L(no_pair);
        code_.cmp(left_row, row);
        code_.jae(none);
        add_products(parts, 2, 0, 0);
        code_.L(none);
        for (std::size_t i = 0; i < count; ++i) {
            const Ymm even = parts[i].vector(2 + i), odd = parts[i].vector(2 + count + i);
            code_.vaddpd(even, even, odd);
            code_.vmovupd(at(now, older() + parts[i].begin), even);
        }
    }
    // sums[i] += left * right
    void add_products(std::span<const LaneRange> parts, std::size_t sums, Index left, Index right) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const LaneRange& part = parts[i];
            const Ymm product = part.vector(i % 2), sum = part.vector(sums + i);
            code_.vmovupd(product, at(left_row, left + part.begin));
            code_.vmulpd(product, product, at(right_row, right + part.begin + lanes_));
            code_.vaddpd(sum, sum, product);
        }
    }

    // ---- the motion ----

    void inputs() {
        constexpr Xbyak::Reg64 below = left_row;
        constexpr Xmm inverse(0);
        const auto n = static_cast<std::uint32_t>(plan_.coordinates());
        const auto states = static_cast<Index>(plan_.states());
        code_.mov(below, at(motion, ACHILLES_PLACE(row)));
        code_.vmovsd(inverse, at(weights, 1 - OrderCode::weights_per_order));  // 1/k
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const Xmm result = code_.result(1 + i);
            if (i < n) {
                code_.vmulsd(result, inverse, at(below, n + i));
            } else {
                code_.apply(Assembler::vmul, result, inverse, plan_.outputs[i - n]);
            }
            code_.store(result, 1 + i);
            code_.vmovsd(at(below, states + i), result);
        }
    }

    // Compares the scaled coefficient with 1. Loads the last row into last_pair.
    void keep_and_compare() {
        constexpr Xbyak::Reg64 state = left_row, largest = right_row;
        constexpr Xmm scaled(0), size(1);
        const auto width = static_cast<Index>(plan_.states());
        code_.mov(state, at(motion, ACHILLES_PLACE(row)));
        code_.lea(state, at(state, width));
        code_.mov(at(motion, ACHILLES_PLACE(row)), state);
        for (std::uint32_t i = 0; i < plan_.events; ++i)
            code_.vmovsd(at(state, width - plan_.events + i), code_.held_or(Xmm(0), plan_.event(i)));
        code_.mov(largest, at(motion, ACHILLES_PLACE(largest)));
        code_.lea(largest, at(largest, width));
        code_.mov(at(motion, ACHILLES_PLACE(largest)), largest);
        code_.mov(last_pair, at(motion, ACHILLES_PLACE(last)));
        code_.vmovsd(scaled, at(motion, ACHILLES_PLACE(power)));
        code_.vmulsd(scaled, scaled, at(motion, ACHILLES_PLACE(target)));
        code_.vmovsd(at(motion, ACHILLES_PLACE(power)), scaled);
        code_.vmovsd(size, at(largest, 0));
        code_.vandpd(size, size, at(motion, ACHILLES_PLACE(magnitude)));
        code_.vmulsd(scaled, scaled, size);
        code_.vucomisd(scaled, at(motion, ACHILLES_PLACE(one)));
    }

    // ---- storing this order as a row ----

    // Loads two numbers into one register.
    void pair(const Xmm& to, std::uint32_t low, std::uint32_t high) {
        const Xmm from = code_.held_or(to, low);
        if (const auto held = code_.holder(high)) {
            code_.vunpcklpd(to, from, *held);
        } else {
            code_.vmovhpd(to, from, code_.number(high));
        }
    }
    // Loads four numbers into register `to`; overwrites the next register.
    void four(const std::uint32_t* numbers, int to) {
        pair(Xmm(to), numbers[0], numbers[1]);
        pair(Xmm(to + 1), numbers[2], numbers[3]);
        code_.vinsertf128(Ymm(to), Ymm(to), Xmm(to + 1), 1);
    }
    // Loads the numbers of a part into register `to`; overwrites the next two registers.
    void gather(const std::uint32_t* numbers, const LaneRange& part, int to) {
        four(numbers + part.begin, to);
        if (part.width != Width::eight) return;
        four(numbers + part.begin + 4, to + 1);
        code_.vinsertf64x4(Zmm(to), Zmm(to), Ymm(to + 1), 1);
    }

    // In weighted lanes: reg *= the order k (which = 0) or 1/(k + 1) (which = 1).
    void weigh(const LaneRange& part, const Ymm& reg, Index which, const Ymm& free) {
        if (part.begin >= weighted_) return;
        if (part.end() <= weighted_) {
            code_.vbroadcastsd(free, at(weights, which));
            code_.vmulpd(reg, reg, free);
        } else {
            code_.vmulpd(reg, reg, at(weights, 2 + 8 * which));
        }
    }

    void keep_and_sum(const LaneRange& part, bool first) {
        const Index right = part.begin + lanes_;
        const Ymm x = part.vector(0), y = part.vector(1), free = part.vector(2);
        gather(plan_.left.data(), part, 0);
        weigh(part, x, 0, y);
        code_.vmovupd(at(row, part.begin), x);
        gather(plan_.right.data(), part, 1);
        code_.vmovupd(at(row, right), y);
        code_.vmulpd(y, y, at(first_row, part.begin));
        if (!first) {
            code_.vmulpd(x, x, at(first_row, right));
            code_.vaddpd(y, y, x);
            code_.vaddpd(y, y, at(now, older() + part.begin));
        }
        weigh(part, y, 1, free);
        code_.vmovupd(at(now, sums_ + part.begin), y);
    }

    const SeriesPlan& plan_;
    Index lanes_, weighted_, sums_;
    Assembler code_;
    std::vector<LaneRange> parts_;
};

std::shared_ptr<const OrderCode> OrderCode::of(const SeriesPlan& plan, Width width) {
    const auto best = best_width();
    if (!best || width > *best || plan.rules.empty() || plan.rules.size() > max_rules_in_code) return nullptr;
    OrderWriter writer(plan, width);
    const std::size_t first = writer.write_first();
    const bool is_motion = plan.coordinates() > 0;
    const std::size_t later = is_motion ? writer.write_later() : writer.write_given();
    auto order = std::make_shared<OrderCode>();
    order->code_ = MachineCode::of(writer.bytes());
    if (!order->code_) return nullptr;
    order->first_ = order->code_->as<Function>(first);
    (is_motion ? order->later_ : order->given_) = order->code_->as<Function>(later);
    order->row_ = plan.row();
    order->states_ = plan.states();
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
