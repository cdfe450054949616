#include "series/rule_code.hpp"

namespace achilles {

namespace {

using Code = Assembler::Code;
using Index = std::ptrdiff_t;  // of doubles

class RuleWriter {
 public:
    RuleWriter(Assembler& code, Assembler::Base factors) : code_(code), factors_(factors) {}

    void write(const SeriesRule& rule, Index first, bool store) {
        using Kind = Sum::Kind;
        const unsigned result = code_.result(rule.result);
        const std::uint32_t operands[3] = {rule.x, rule.y, rule.w};
        Sum sum;
        for (int i = 2; i >= 0; --i) {
            if (operands[i] == 0) continue;
            const bool alone = sum.kind == Kind::none;
            const Sum term = product(rule.known[i], operands[i], first + code_.place(static_cast<std::uint32_t>(i)),
                                     alone ? result : 0);
            sum = alone ? term : total(sum, term, result);
        }
        if (sum.kind == Kind::none) code_.zero(result);
        if (sum.kind == Kind::number) code_.get(result, sum.number);
        if (sum.kind == Kind::negative) negate(result, sum.number);
        if (store) code_.store(result, rule.result);
    }

 private:
    // A sum as far as it is known: in a register, or a number (or its negative) that is not looked up yet.
    struct Sum {
        enum class Kind { none, in_register, number, negative } kind = Kind::none;
        unsigned reg = 0;
        std::uint32_t number = 0;
    };

    // A factor times its number; into this register unless it is known to be 1 or -1.
    Sum product(std::int8_t known, std::uint32_t number, Index factor, unsigned to) {
        if (known > 0) return {Sum::Kind::number, 0, number};
        if (known < 0) return {Sum::Kind::negative, 0, number};
        const auto held = code_.holder(number);
        if (!held) code_.get(to, number);
        code_.memory(Code::multiply, code_.width(), to, held ? *held : to, factors_, factor);
        return {Sum::Kind::in_register, to, 0};
    }

    void negate(unsigned to, std::uint32_t number) {
        code_.negative_zero(to);
        code_.apply(Code::subtract, to, to, number);
    }

    // sum + term, in the result's register
    Sum total(const Sum& sum, const Sum& term, unsigned result) {
        using Kind = Sum::Kind;
        if (sum.kind == Kind::in_register && term.kind == Kind::in_register) {
            code_.registers(Code::add, code_.width(), result, sum.reg, term.reg);
        } else if (sum.kind == Kind::in_register) {
            code_.apply(term.kind == Kind::negative ? Code::subtract : Code::add, result, sum.reg, term.number);
        } else if (term.kind == Kind::in_register) {
            code_.apply(sum.kind == Kind::negative ? Code::subtract : Code::add, result, term.reg, sum.number);
        } else if (sum.kind == Kind::number) {
            code_.combine(term.kind == Kind::negative ? Code::subtract : Code::add, result, sum.number, term.number);
        } else if (term.kind == Kind::number) {
            code_.combine(Code::subtract, result, term.number, sum.number);
        } else {
            negate(result, sum.number);
            code_.apply(Code::subtract, result, result, term.number);
        }
        return {Kind::in_register, result, 0};
    }

    Assembler& code_;
    Assembler::Base factors_;
};

}  // namespace

void write_rule(Assembler& code, const SeriesRule& rule, Assembler::Base factors, std::ptrdiff_t first, bool store) {
    RuleWriter(code, factors).write(rule, first, store);
}

}  // namespace achilles
