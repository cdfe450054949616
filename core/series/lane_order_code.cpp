// Machine code for the orders of eight runs.
#include <algorithm>
#include <array>
#include <map>
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

constexpr auto eight = static_cast<Index>(Double8::count);
Index lane(std::size_t number) { return static_cast<Index>(number) * eight; }

}  // namespace

// AVX-512 has 32 vector registers. If sixteen hold all inner sums, or the others all results, these stay there from one
// order to the next. Otherwise inner sums reuse the registers of results, which are stored if they are needed later.
// With vectors of four there are 16 registers, a number fills two, and each half of an order is emitted separately.
//
// Some numbers are uniform, that is the same in all lanes: those of a motion beside its derivatives. They are stored and
// added up as single doubles.
class LaneOrderWriter {
 public:
    LaneOrderWriter(const SeriesPlan& plan, const LanePlan& lanes, Width vectors)
        : plan_(plan),
          lanes_(lanes),
          code_(now, scratch, Width::eight, vectors),
          many_registers_(vectors == Width::eight),
          end_of_registers_(many_registers_ ? 32 : 16),
          all_held_(many_registers_ && plan.clock == 0 && 2 * plan.coordinates() + plan.rules.size() <= code_.room()),
          one_group_(many_registers_ && lanes.sums.size() <= 16),
          first_sum_(all_held_ || one_group_ ? 16 : scratch) {
        if (many_registers_ && first_sum_ == scratch) code_.cache_in_all_registers();
        order_rules();
        if (many_registers_ && !all_held_ && !lanes.varied.series.empty())
            for (std::uint32_t i = 0; i < plan.series; ++i)
                if (!lanes.varied.series[i]) code_.make_single(i);
        code_.store_when_needed(last_uses());
        lay_out_rows();
        std::stable_sort(by_left_.begin(), by_left_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return sum(a).left < sum(b).left; });
    }

    // Orders 1 to 3, then a loop for the others, which a second function enters again. Returns its place in the code.
    std::size_t write() {
        for (unsigned k = 1; k <= 3; ++k) order(k);
        const Xbyak::Label loop = code_.L();
        order(4);
        code_.cmp(weights, last);
        code_.jbe(loop);  // the address of the weights gives the order
        const auto held = held_between_orders();
        for (const auto& [number, reg] : held) code_.vmovupd(part(now, lane(number)), vector(reg));
        code_.vzeroupper();
        code_.ret();
        const std::size_t later = code_.getSize();
        for (const auto& [number, reg] : held) code_.vmovupd(vector(reg), part(now, lane(number)));
        code_.jmp(loop);
        return later;
    }
    std::span<const std::uint8_t> bytes() { return code_.bytes(); }
    Index row_size() const { return stride_; }

 private:
    // Uniform sums that are added up together: `left` and `right` are the places of their factors.
    struct Pack {
        std::vector<std::uint32_t> sums;
        Index left, right;
    };

    const LanePlan::LaneSum& sum(std::uint32_t i) const { return lanes_.sums[i]; }
    // Whether a sum is the same in all lanes. Its terms are added in one of them.
    bool is_uniform(std::uint32_t i) const {
        return lanes_.stored[sum(i).left].uniform && lanes_.stored[sum(i).right].uniform;
    }
    // Numbers in lanes come first in a row. Then come the factors of uniform sums, of as many sums together as a vector
    // holds, and the other uniform numbers, a double each.
    void lay_out_rows() {
        places_.assign(lanes_.stored.size(), -1);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (lanes_.stored[i].uniform) continue;
            places_[i] = stride_;
            stride_ += eight;
        }
        const auto add = [&](std::uint32_t number) {
            if (places_[number] < 0) places_[number] = stride_;
            uniform_places_.emplace_back(number, stride_++);
        };
        std::vector<std::uint32_t> uniform;
        for (std::uint32_t i = 0; i < lanes_.sums.size(); ++i)
            (is_uniform(i) && !one_group_ ? uniform : by_left_).push_back(i);
        const std::size_t wide = many_registers_ ? 8 : 4;
        for (std::size_t first = 0; first < uniform.size(); first += wide) {
            const std::size_t end = std::min(first + wide, uniform.size());
            Pack pack{{}, stride_, stride_ + static_cast<Index>(wide)};
            // Free places repeat the last sum.
            for (std::size_t i = first; i < first + wide; ++i) add(sum(uniform[std::min(i, end - 1)]).left);
            for (std::size_t i = first; i < first + wide; ++i) add(sum(uniform[std::min(i, end - 1)]).right);
            pack.sums.assign(uniform.begin() + static_cast<Index>(first), uniform.begin() + static_cast<Index>(end));
            packs_.push_back(pack);
            for (const std::uint32_t i : pack.sums)
                if (many_registers_) code_.make_single(plan_.series + i);
        }
        for (std::uint32_t i = 0; i < places_.size(); ++i)
            if (places_[i] < 0) add(i);
        stride_ = (stride_ + eight - 1) / eight * eight;
    }
    // They are loaded as one double where loads take most of the time, not where results wait for results.
    std::array<bool, 3> uniform_factors(std::size_t rule) const {
        if (all_held_ || lanes_.varied.factors.empty()) return {};
        const auto [x, y, w] = lanes_.varied.factors[rule];
        return {!x, !y, !w};
    }
    // Offset of row 1 from `now`.
    Index first_row() const { return lane(plan_.numbers()); }
    // The current part of a number, as an operand at an offset from an address.
    Xbyak::Address part(const Xbyak::Reg64& base, Index number) const { return at(base, number + code_.part()); }
    Xmm vector(std::size_t reg) const { return code_.vector(static_cast<unsigned>(reg)); }

    // Order k, where 4 stands for all higher ones; then advances to the next order.
    void order(unsigned k) {
        code_.for_each_part([&] { part_of_order(k); });
        code_.lea(row, at(row, stride_));
        code_.lea(motion, at(motion, lane(plan_.states())));
        code_.lea(weights, at(weights, weights_per_order));
    }

    void part_of_order(unsigned k) {
        remember(k > 1);
        code_.set_position(0);
        inputs(k == 1);
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const std::uint32_t i = order_[place];
            code_.set_position(place);
            const SeriesRule& rule = plan_.rules[i];
            const auto write = [&] {
                RuleWriter(code_, factors, uniform_factors(i)).write(rule, lane(3 * i) + code_.part(), false);
            };
            code_.is_single(rule.result) ? code_.compute_single(rule.result, write) : write();
        }
        for (std::size_t i = 0; i < plan_.events; ++i)
            code_.vmovupd(part(motion, lane(2 * plan_.coordinates() + i)), code_.held_or(vector(0), plan_.event(i)));
        keep();
        if (!all_held_) {
            for (const std::uint32_t number : read_in_next_order())
                if (const auto held = code_.holder(number)) code_.store(*held, number);
            code_.forget_all();
        }
        add_up(k);
    }

    // The series of which an order reads the value at the order before, until it replaces it.
    std::vector<std::uint32_t> read_in_next_order() const {
        std::vector<std::uint32_t> all(plan_.outputs.begin(),
                                       plan_.outputs.begin() + static_cast<Index>(plan_.coordinates()));
        if (plan_.clock != 0) all.push_back(plan_.clock);
        return all;
    }
    std::array<std::uint32_t, 3> operands(std::uint32_t rule) const {
        return {plan_.rules[rule].x, plan_.rules[rule].y, plan_.rules[rule].w};
    }
    // Each rule follows those of its operands as soon as possible, so that few results are needed at once.
    void order_rules() {
        constexpr std::uint32_t none = ~0u;
        std::vector<std::uint32_t> rule_of(plan_.series, none);
        for (std::uint32_t i = 0; i < plan_.rules.size(); ++i) rule_of[plan_.rules[i].result] = i;
        if (plan_.clock != 0) rule_of[plan_.clock] = none;  // the time is read before it is reset
        std::vector<bool> begun(plan_.rules.size(), false), done = begun;
        std::vector<std::uint32_t> open;  // rules to place, the next one last
        const auto place_with_operands = [&](std::uint32_t rule) {
            if (rule != none) open.push_back(rule);
            while (!open.empty()) {
                const std::uint32_t i = open.back();
                if (begun[i]) {
                    open.pop_back();
                    if (!done[i]) order_.push_back(i);
                    done[i] = true;
                    continue;
                }
                begun[i] = true;
                for (const std::uint32_t operand : operands(i))
                    if (operand < plan_.series && rule_of[operand] != none && !begun[rule_of[operand]])
                        open.push_back(rule_of[operand]);
            }
        };
        for (const std::uint32_t output : plan_.outputs) place_with_operands(rule_of[output]);
        for (std::uint32_t i = 0; i < plan_.rules.size(); ++i) place_with_operands(i);
    }
    // The position of the last rule that uses each series. It is the number of rules if a series is used after them.
    std::vector<std::size_t> last_uses() const {
        std::vector<std::size_t> last(plan_.series, 0);
        const auto use = [&](std::uint32_t number, std::size_t position) {
            if (number < last.size()) last[number] = position;
        };
        const std::size_t end = plan_.rules.size();
        for (std::size_t i = 0; i < end; ++i)
            for (const std::uint32_t operand : operands(order_[i])) use(operand, i);
        for (const LanePlan::StoredSums& number : lanes_.stored) use(number.series, end);
        for (const std::uint32_t output : plan_.outputs) use(output, end);
        for (const std::uint32_t number : read_in_next_order()) use(number, end);
        return last;
    }

    // The numbers that an order leaves in registers for the next: each result has the same register in all orders.
    std::vector<std::pair<std::uint32_t, unsigned>> held_between_orders() {
        std::vector<std::pair<std::uint32_t, unsigned>> held;
        if (all_held_)
            for (const std::uint32_t output : plan_.outputs)
                if (const auto reg = code_.holder(output)) held.emplace_back(output, reg->getIdx());
        if (one_group_)
            for (unsigned i = 0; i < by_left_.size(); ++i)
                held.emplace_back(plan_.series + by_left_[i], first_sum_ + i);
        return held;
    }
    void remember(bool any) {
        const auto held = held_between_orders();
        code_.forget_all();
        if (!any) return;
        for (const auto& [number, reg] : held) code_.hold(number, reg);
    }

    // As many sums at once as there are registers; sums with a common left factor load it once. The terms with row k
    // come last, preceded by those with row k - 1, so that the others need not wait.
    void add_up(unsigned k) {
        std::span<const std::uint32_t> sums(by_left_);
        std::span<const Pack> packs(packs_);
        if (code_.part() != 0) {  // the first part has added up the packs
            packs = {};
            spread_packs();
        }
        for (std::size_t room = end_of_registers_ - first_sum_; !sums.empty() || !packs.empty();) {
            const std::size_t packed = std::min(room, packs.size()), others = std::min(room - packed, sums.size());
            add_up(packs.first(packed), sums.first(others), k);
            packs = packs.subspan(packed);
            sums = sums.subspan(others);
        }
    }
    void add_up(std::span<const Pack> packs, std::span<const std::uint32_t> sums, unsigned k) {
        const Index first = first_row(), next = stride_;
        const unsigned first_register = first_sum_ + static_cast<unsigned>(packs.size());
        code_.zero(vector(0));
        for (unsigned i = first_sum_; i < first_register + sums.size(); ++i) code_.vmovapd(vector(i), vector(0));
        const auto add_all = [&](const Xbyak::Reg64& left, Index to_left, const Xbyak::Reg64& right, Index to_right) {
            for (unsigned i = 0; i < packs.size(); ++i) {
                code_.vmovupd(vector(0), at(left, to_left + packs[i].left));
                code_.vmulpd(vector(0), vector(0), at(right, to_right + packs[i].right));
                code_.vaddpd(vector(first_sum_ + i), vector(first_sum_ + i), vector(0));
            }
            add_products(sums, first_register, left, to_left, right, to_right);
        };
        if (k >= 4) {
            code_.lea(left_row, at(now, first + 2 * next));
            code_.lea(right_row, at(row, -2 * next));
            code_.lea(before, at(row, -next));
            Xbyak::Label none;
            code_.cmp(left_row, before);
            code_.jae(none);
            const Xbyak::Label loop = code_.L();
            add_all(left_row, 0, right_row, 0);
            code_.lea(left_row, at(left_row, next));
            code_.lea(right_row, at(right_row, -next));
            code_.cmp(left_row, before);
            code_.jb(loop);
            code_.L(none);
        }
        if (k >= 3) add_all(now, first + next, row, -next);
        if (k >= 4) add_all(row, -next, now, first + next);
        if (k >= 2) add_products(sums, first_register, row, 0, now, first);
        for (unsigned i = 0; i < sums.size(); ++i) finish(sums[i], vector(first_register + i));
        for (unsigned i = 0; i < packs.size(); ++i)
            finish(packs[i], lane(plan_.series + plan_.lanes) + eight * static_cast<Index>(i), vector(first_sum_ + i),
                   k);
    }
    // Loads a stored number of the row at an offset from an address.
    void load(const Xmm& to, const Xbyak::Reg64& base, Index row_offset, std::uint32_t number) {
        const Index place = row_offset + places_[number];
        lanes_.stored[number].uniform ? code_.broadcast(to, at(base, place)) : code_.vmovupd(to, part(base, place));
    }
    // product = x * such a number. Overwrites register 2.
    void multiply(const Xmm& product, const Xmm& x, const Xbyak::Reg64& base, Index row_offset, std::uint32_t number) {
        const Index place = row_offset + places_[number];
        if (!lanes_.stored[number].uniform) return code_.vmulpd(product, x, part(base, place));
        if (many_registers_)
            return code_.vmulpd(product, x, Xbyak::util::ptr_b[base + static_cast<std::size_t>(8 * place)]);
        load(vector(2), base, row_offset, number);
        code_.vmulpd(product, x, vector(2));
    }
    // Right factors are loaded once, too, as far as idle registers allow.
    void add_products(std::span<const std::uint32_t> sums, unsigned first_register, const Xbyak::Reg64& left,
                      Index to_left, const Xbyak::Reg64& right, Index to_right) {
        const Xmm x = vector(0), product = vector(1);
        std::map<std::uint32_t, unsigned> fetched;
        const unsigned end_of_sums = first_register + static_cast<unsigned>(sums.size());
        unsigned idle = all_held_ ? end_of_sums : scratch;
        for (const std::uint32_t i : sums) {
            if (idle == first_sum_) idle = end_of_sums;
            if (idle < end_of_registers_ && fetched.emplace(sum(i).right, idle).second)
                load(vector(idle++), right, to_right, sum(i).right);
        }
        for (unsigned i = 0; i < sums.size(); ++i) {
            const auto [x_place, y_place] = sum(sums[i]);
            if (i == 0 || sum(sums[i - 1]).left != x_place) load(x, left, to_left, x_place);
            const Xmm sum = vector(first_register + i);
            const auto y = fetched.find(y_place);
            if (is_uniform(sums[i])) {
                const Xmm one_product(product.getIdx()), one_x(x.getIdx()), one_sum(sum.getIdx());
                if (y != fetched.end())
                    code_.vmulsd(one_product, one_x, Xmm(static_cast<int>(y->second)));
                else
                    code_.vmulsd(one_product, one_x, at(right, to_right + places_[y_place]));
                code_.vaddsd(one_sum, one_sum, one_product);
                continue;
            }
            if (y != fetched.end()) {
                code_.vmulpd(product, x, vector(y->second));
            } else {
                multiply(product, x, right, to_right, y_place);
            }
            code_.vaddpd(sum, sum, product);
        }
    }

    // Adds the term x_1 y_k, with y_k from its register if it has one.
    void finish(std::uint32_t i, const Xmm& total) {
        const Xmm product = vector(1), weight = vector(2);
        const auto [left, right] = sum(i);
        const auto newest = code_.holder(lanes_.stored[right].series);
        if (!newest) load(product, row, 0, right);
        multiply(product, newest ? *newest : product, now, first_row(), left);
        if (is_uniform(i)) code_.broadcast(total, Xmm(total.getIdx()));
        code_.vaddpd(total, total, product);
        if (i < plan_.weighted) {
            code_.broadcast(weight, at(weights, by_inverse_of_next));
            code_.vmulpd(total, total, weight);
        }
        if (!one_group_) code_.vmovupd(part(now, lane(plan_.series + i)), total);
    }

    // Adds the terms x_k y_1 and x_1 y_k of each sum of a pack. They are not packed, since a vector that is loaded from
    // numbers stored one by one has to wait for them.
    void finish(const Pack& pack, Index spare, const Xmm& partial, unsigned k) {
        const Xmm total(0), product(1);
        code_.vmovupd(at(now, spare), partial);
        for (std::size_t i = 0; i < pack.sums.size(); ++i) {
            const auto [left, right] = sum(pack.sums[i]);
            const auto add = [&](std::uint32_t newest, std::uint32_t oldest) {
                code_.vmovsd(product, at(row, places_[newest]));
                code_.vmulsd(product, product, at(now, first_row() + places_[oldest]));
                code_.vaddsd(total, total, product);
            };
            code_.vmovsd(total, at(now, spare + static_cast<Index>(i)));
            if (k >= 2) add(left, right);
            add(right, left);
            if (pack.sums[i] < plan_.weighted) code_.vmulsd(total, total, at(weights, by_inverse_of_next));
            const Index place = lane(plan_.series + pack.sums[i]);
            if (many_registers_) {
                code_.vmovsd(at(now, place), total);
                continue;
            }
            code_.broadcast(vector(0), total);
            code_.vmovupd(at(now, place), vector(0));
        }
    }

    // The first part has stored these sums in the first half of their numbers only, because the second part still needed
    // those of the order before. This copies them into the second half.
    void spread_packs() {
        for (const Pack& pack : packs_)
            for (const std::uint32_t i : pack.sums) {
                code_.vmovupd(vector(0), at(now, lane(plan_.series + i)));
                code_.vmovupd(part(now, lane(plan_.series + i)), vector(0));
            }
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
            code_.vmovupd(part(motion, lane(i)), result);
        }
    }

    void keep() {
        const Xmm weight = vector(1);
        for (std::size_t i = 0; i < lanes_.stored.size(); ++i) {
            const auto [series, weighted, uniform] = lanes_.stored[i];
            if (uniform && code_.part() != 0) continue;  // the first part has stored it
            const Xmm number = code_.held_or(vector(0), series);
            if (weighted) {
                code_.broadcast(weight, at(weights, by_order));
                code_.vmulpd(weight, weight, number);
            }
            const Xmm& kept = weighted ? weight : number;
            if (!uniform) code_.vmovupd(part(row, places_[i]), kept);
            for (const auto& [of, place] : uniform_places_)
                if (of == i) code_.vmovsd(at(row, place), Xmm(kept.getIdx()));
        }
    }

    const SeriesPlan& plan_;
    const LanePlan& lanes_;
    Assembler code_;
    std::vector<std::uint32_t> order_;                             // the rules, in the order of the code
    Index stride_ = 0;                                             // size of a row of stored numbers
    std::vector<Index> places_;                                    // offset of each stored number in its row
    std::vector<std::pair<std::uint32_t, Index>> uniform_places_;  // all offsets of the uniform numbers
    std::vector<Pack> packs_;
    std::vector<std::uint32_t> by_left_;  // the other sums, by left factor
    bool many_registers_;
    unsigned end_of_registers_;
    bool all_held_;   // every result keeps its register until the end of the order
    bool one_group_;  // every sum has its own register
    unsigned first_sum_;
};

std::shared_ptr<const LaneOrderCode> LaneOrderCode::of(const SeriesPlan& plan, const LanePlan& lanes, Width vectors) {
    const auto best = best_width();
    if (!best || vectors > *best || plan.rules.size() > max_rules_in_code) return nullptr;
    LaneOrderWriter writer(plan, lanes, vectors);
    const std::size_t later = writer.write();
    auto orders = std::make_shared<LaneOrderCode>();
    orders->code_ = MachineCode::of(writer.bytes());
    if (!orders->code_) return nullptr;
    orders->first_ = orders->code_->as<Function>();
    orders->later_ = orders->code_->as<Function>(later);
    orders->first_row_ = plan.numbers() * Double8::count;
    orders->row_ = static_cast<std::size_t>(writer.row_size());
    for (int k = 1; k <= OrderCode::highest_order; ++k) {
        const double order = k;
        orders->weights_.push_back({order, 1.0 / (order + 1.0), 1.0 / order});
    }
    return orders;
}

}  // namespace achilles
