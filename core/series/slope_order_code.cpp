#include "series/slope_plan.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <map>
#include <tuple>

#include "program/assembler.hpp"
#include "series/lane_kinds.hpp"

namespace achilles {

namespace {

using Xbyak::Zmm, Xbyak::Xmm, Xbyak::Reg64;
using Index = std::ptrdiff_t;  // of doubles

// The function's arguments, by the calling convention, what it takes from the tables, and the pointers of the loop.
constexpr Reg64 tables = Xbyak::util::rdi, k = Xbyak::util::rsi, rise = Xbyak::util::rdx, knowns = Xbyak::util::rcx,
                newest = Xbyak::util::r8, scales = Xbyak::util::r9, left = Xbyak::util::r10, right = Xbyak::util::r11,
                first = Xbyak::util::rax;
// Outside the loop; and once k is known no more, where order k of the states stands.
constexpr Reg64 coefficients = left, now = right, row = k;
constexpr unsigned scratch = 3;                          // free vector registers
constexpr unsigned first_sum = 16, inverse = first_sum;  // and those of sums; 1/k before the loop
constexpr std::size_t most_sums = 16, most_rules = 2000;
constexpr Index eight = static_cast<Index>(Eight::count);

Zmm zmm(std::size_t number) { return Zmm(static_cast<int>(number)); }

#define ACHILLES_TABLE(member) (Xbyak::util::ptr[tables + offsetof(SlopeTables, member)])

}  // namespace

class SlopeOrderWriter {
 public:
    explicit SlopeOrderWriter(const SlopePlan& plan) : plan_(plan), code_(rise, scratch, Width::eight, Width::eight) {}

    void write() {
        code_.mov(rise, ACHILLES_TABLE(rise));
        code_.mov(knowns, ACHILLES_TABLE(knowns));
        code_.mov(scales, ACHILLES_TABLE(scales));
        code_.mov(newest, k);
        code_.shl(newest, 6);
        code_.add(newest, ACHILLES_TABLE(risings));
        code_.mov(coefficients, ACHILLES_TABLE(coefficients));
        code_.mov(now, ACHILLES_TABLE(now));
        write_states();
        code_.mov(first, ACHILLES_TABLE(risings));
        std::vector<Term> terms;
        for (std::uint32_t i = 0; i < plan_.rules.size(); ++i)
            for (std::size_t p = 0; p < plan_.rules[i].count; ++p)
                terms.push_back({plan_.rules[i].products[p].rising, i, plan_.rules[i].products[p].known});
        for (auto begin = plan_.rules.begin(); begin != plan_.rules.end();) begin = sum_older(begin, terms);
        code_.mov(coefficients, ACHILLES_TABLE(coefficients));
        code_.mov(now, ACHILLES_TABLE(now));
        for (std::uint32_t i = 0; i < plan_.rules.size(); ++i) write(i);
        for (std::size_t i = 0; i < plan_.events; ++i) {
            const std::size_t n = plan_.coordinates();
            code_.get(zmm(0), plan_.outputs[n + i]);
            code_.vmovupd(at(row, eight * static_cast<Index>(2 * n + i)), zmm(0));
        }
        code_.vzeroupper();
        code_.ret();
    }
    std::span<const std::uint8_t> bytes() { return code_.bytes(); }

 private:
    struct Term {
        std::uint32_t rising, rule, known;
        auto operator<=>(const Term&) const = default;  // NOLINT(modernize-use-nullptr): its 0 is no pointer
    };
    using Rule = SlopePlan::Rule;
    using Rules = std::vector<Rule>::const_iterator;

    static Index rising(std::uint32_t factor) { return eight * static_cast<Index>(SlopeTables::orders) * factor; }
    static Xbyak::Address all_lanes(const Reg64& base, Index doubles) {
        return Xbyak::util::ptr_b[base + static_cast<std::size_t>(8 * doubles)];
    }
    // Where the sum of a rule's products waits for it: its result's place.
    Xbyak::Address waiting(const Rule& rule) const { return code_.number(rule.result); }

    // sum_{0<j<=k} known_j rising_{k-j} of so many rules as there are registers.
    Rules sum_older(Rules begin, const std::vector<Term>& all) {
        std::map<std::uint32_t, Zmm> sums;
        Rules end = begin;
        for (; end != plan_.rules.end() && sums.size() < most_sums; ++end)
            if (end->count > 0)
                sums.emplace(static_cast<std::uint32_t>(end - plan_.rules.begin()), zmm(first_sum + sums.size()));
        if (sums.empty()) return end;
        std::vector<Term> terms;
        std::copy_if(all.begin(), all.end(), std::back_inserter(terms),
                     [&](const Term& t) { return sums.contains(t.rule); });
        std::sort(terms.begin(), terms.end());
        code_.zero(zmm(0));
        for (const auto& [rule, sum] : sums) code_.vmovapd(sum, zmm(0));
        code_.lea(left, at(knowns, static_cast<Index>(plan_.factors.size())));
        code_.lea(right, at(newest, -eight));
        const Xbyak::Label loop = code_.L();
        for (std::size_t i = 0; i < terms.size(); ++i) {
            const Term& term = terms[i];
            const Zmm& sum = sums.at(term.rule);
            if (i == 0 || terms[i - 1].rising != term.rising) code_.vmovupd(zmm(0), at(right, rising(term.rising)));
            code_.vmulpd(zmm(1), zmm(0), all_lanes(left, term.known));
            code_.vaddpd(sum, sum, zmm(1));
        }
        code_.add(left, 8 * static_cast<std::uint32_t>(plan_.factors.size()));
        code_.sub(right, 8 * static_cast<std::uint32_t>(eight));
        code_.cmp(right, first);
        code_.jae(loop);
        for (const auto& [rule, sum] : sums) code_.vmovupd(waiting(plan_.rules[rule]), sum);
        return end;
    }

    // to += coefficient * series, or = where it is the first
    void add_multiple(const Zmm& to, std::uint32_t coefficient, std::uint32_t series, bool is_first) {
        const auto of = code_.holder(series);
        if (coefficient == 0) {
            if (is_first) return code_.get(to, series);
            return code_.apply(Assembler::vadd, to, to, series);
        }
        const Index place = coefficient * static_cast<Index>(sizeof(SlopeCoefficient) / sizeof(double));
        const Zmm a = is_first ? to : zmm(1), b = zmm(2);
        code_.vmovupd(b, at(coefficients, place + rise_in_coefficient));
        code_.vmulpd(b, b, all_lanes(now, series));
        if (!of) code_.get(zmm(0), series);
        code_.vmulpd(a, of ? Zmm(of->getIdx()) : zmm(0), all_lanes(coefficients, place));
        code_.vaddpd(a, a, b);
        if (!is_first) code_.vaddpd(to, to, a);
    }
    static constexpr Index rise_in_coefficient = static_cast<Index>(offsetof(SlopeCoefficient, rise) / sizeof(double));

    // Order k of a factor: where its series has a register, there; else in register 0.
    Zmm newest_of(std::uint32_t factor) {
        const auto [series, value, scale] = plan_.factors[factor];
        const auto held = code_.holder(series);
        if (scale == 0 && held) return Zmm(held->getIdx());
        code_.vmovupd(zmm(0), at(newest, rising(factor)));
        return zmm(0);
    }
    void write(std::uint32_t i) {
        const Rule& rule = plan_.rules[i];
        const Zmm result(code_.result(rule.result).getIdx());
        if (rule.kind == Rule::Kind::sum) {
            bool is_first = true;
            for (std::size_t t = 0; t < 3; ++t) {
                if (rule.series[t] == 0) continue;
                add_multiple(result, rule.coefficient[t], rule.series[t], is_first);
                is_first = false;
            }
            if (is_first) code_.zero(result);
        } else {
            code_.vmovupd(result, waiting(rule));
            for (std::size_t p = 0; p < rule.count; ++p) {
                const auto [u, x] = rule.products[p];
                if (x == rule.own) continue;
                code_.vmulpd(zmm(0), newest_of(x), all_lanes(knowns, u));
                code_.vaddpd(result, result, zmm(0));
            }
            if (rule.divides || rule.by != 1.0)
                code_.vmulpd(result, result, all_lanes(scales, 2 * static_cast<Index>(i)));
            if (rule.lead != 0.0) {
                code_.vmulpd(zmm(0), newest_of(rule.leading), all_lanes(scales, 2 * static_cast<Index>(i) + 1));
                code_.vaddpd(result, result, zmm(0));
            }
        }
        give(rule.result, result);
    }
    // Order k of a series, and of the factors that are made of it.
    void give(std::uint32_t series, const Zmm& rise_of_it) {
        code_.store(rise_of_it, series);
        for (std::uint32_t f = plan_.first_factor[series]; f < plan_.first_factor[series + 1]; ++f) {
            const std::uint32_t scale = plan_.factors[f].scale;
            if (scale != 0) add_multiple(zmm(0), scale, series, true);
            code_.vmovupd(at(newest, rising(f)), scale == 0 ? rise_of_it : zmm(0));
        }
    }
    // q and v: where k = 1 they stand; else they are those below them, and the accelerations of then, by k.
    void write_states() {
        const std::size_t n = plan_.coordinates();
        const Index width = eight * static_cast<Index>(plan_.states());
        const Reg64 here = first;
        const auto state = [&](std::size_t i) { return at(here, eight * static_cast<Index>(i)); };
        const auto below = [&](std::size_t i) { return at(here, eight * static_cast<Index>(i) - width); };
        code_.imul(here, k, static_cast<int>(8 * width));
        code_.add(here, ACHILLES_TABLE(states));
        Xbyak::Label stand;
        code_.cmp(k, 1);
        code_.je(stand);
        code_.vcvtsi2sd(Xmm(1), Xmm(1), k);
        code_.mov(k, std::bit_cast<std::uint64_t>(1.0));
        code_.vmovq(Xmm(0), k);
        code_.vdivsd(Xmm(0), Xmm(0), Xmm(1));
        code_.vbroadcastsd(zmm(inverse), Xmm(0));
        for (std::size_t i = 0; i < n; ++i) {
            code_.vmulpd(zmm(0), zmm(inverse), below(n + i));
            code_.vmulpd(zmm(1), zmm(inverse), code_.number(plan_.outputs[i]));
            code_.vmovupd(state(i), zmm(0));
            code_.vmovupd(state(n + i), zmm(1));
        }
        code_.L(stand);
        code_.mov(row, here);
        for (std::size_t i = 0; i < 2 * n; ++i) {
            const auto series = static_cast<std::uint32_t>(1 + i);
            const Zmm result(code_.result(series).getIdx());
            code_.vmovupd(result, state(i));
            give(series, result);
        }
    }

    const SlopePlan& plan_;
    Assembler code_;
};

std::shared_ptr<const SlopeOrderCode> SlopeOrderCode::of(const SlopePlan& plan) {
    const auto is_power = [](const SlopePlan::Rule& rule) { return rule.kind == SlopePlan::Rule::Kind::power; };
    if (best_width() != Width::eight || plan.rules.empty() || plan.rules.size() > most_rules ||
        std::any_of(plan.rules.begin(), plan.rules.end(), is_power))
        return nullptr;
    SlopeOrderWriter writer(plan);
    writer.write();
    auto order = std::make_shared<SlopeOrderCode>();
    order->code_ = MachineCode::of(writer.bytes());
    if (!order->code_) return nullptr;
    order->function_ = order->code_->as<Function>();
    return order;
}

}  // namespace achilles
