// Machine code for one rule, for any vector width.
#pragma once

#include <array>

#include "program/assembler.hpp"
#include "series/order.hpp"

namespace achilles {

constexpr std::size_t max_rules_in_code = 10000;

// The three factors of a rule are contiguous at (factors, first). Overwrites register 0.
class RuleWriter {
 public:
    using Index = std::ptrdiff_t;  // in doubles

    // `uniform` tells of each factor of the rule whether it is the same in all lanes.
    RuleWriter(Assembler& code, const Xbyak::Reg64& factors, const std::array<bool, 3>& uniform = {})
        : code_(code), factors_(factors), uniform_(uniform) {}

    // Storing the result can be omitted if its register keeps it for as long as it is needed.
    void write(const SeriesRule& rule, Index first, bool store = true) {
        using Kind = PartialSum::Kind;
        const Xbyak::Xmm result = code_.result(rule.result);
        const std::uint32_t operands[3] = {rule.x, rule.y, rule.w};
        PartialSum sum;
        for (int i = 2; i >= 0; --i) {
            if (operands[i] == 0) continue;
            const bool alone = sum.kind == Kind::none;
            const PartialSum term = product(rule.known[i], operands[i], factor(first, static_cast<std::uint32_t>(i)),
                                            alone ? result : code_.vector(0));
            sum = alone ? term : total(sum, term, result);
        }
        if (sum.kind == Kind::none) code_.zero(result);
        if (sum.kind == Kind::number) code_.get(result, sum.number);
        if (sum.kind == Kind::negative) code_.negate(result, sum.number);
        if (store) code_.store(result, rule.result);
    }

 private:
    // A partial sum: in a register, or a number or its negative that is not loaded yet.
    struct PartialSum {
        enum class Kind { none, in_register, number, negative } kind = Kind::none;
        Xbyak::Xmm reg;
        std::uint32_t number = 0;
    };

    // A uniform factor is loaded as one double: a load of eight takes twice as long.
    Xbyak::Address factor(Index first, std::uint32_t i) const {
        const Index place = first + code_.place(i);
        if (!uniform_[i] || code_.width() != Width::eight) return at(factors_, place);
        return Xbyak::util::ptr_b[factors_ + static_cast<std::size_t>(8 * place)];
    }

    // A factor times its number, in register `to` unless the factor is known to be 1 or -1.
    PartialSum product(std::int8_t known, std::uint32_t number, const Xbyak::Address& factor, const Xbyak::Xmm& to) {
        if (known > 0) return {PartialSum::Kind::number, Xbyak::Xmm(), number};
        if (known < 0) return {PartialSum::Kind::negative, Xbyak::Xmm(), number};
        code_.apply(Assembler::vmul, to, code_.held_or(to, number), factor);
        return {PartialSum::Kind::in_register, to, 0};
    }

    // Writes code for sum + term. The result is in register `result`.
    PartialSum total(const PartialSum& sum, const PartialSum& term, const Xbyak::Xmm& result) {
        using Kind = PartialSum::Kind;
        constexpr auto vadd = Assembler::vadd, vsub = Assembler::vsub;
        if (sum.kind == Kind::in_register && term.kind == Kind::in_register) {
            code_.apply(vadd, result, sum.reg, term.reg);
        } else if (sum.kind == Kind::in_register) {
            code_.apply(term.kind == Kind::negative ? vsub : vadd, result, sum.reg, term.number);
        } else if (term.kind == Kind::in_register) {
            code_.apply(sum.kind == Kind::negative ? vsub : vadd, result, term.reg, sum.number);
        } else if (sum.kind == Kind::number) {
            code_.combine(term.kind == Kind::negative ? vsub : vadd, result, sum.number, term.number);
        } else if (term.kind == Kind::number) {
            code_.combine(vsub, result, term.number, sum.number);
        } else {
            code_.negate(result, sum.number);
            code_.apply(vsub, result, result, term.number);
        }
        return {Kind::in_register, result, 0};
    }

    Assembler& code_;
    Xbyak::Reg64 factors_;
    std::array<bool, 3> uniform_;
};

}  // namespace achilles
