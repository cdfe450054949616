#include "series/rule_code.hpp"

namespace achilles {

#if defined(__x86_64__) && defined(__linux__)

std::shared_ptr<const MachineCode> machine_code(std::span<const SeriesRule> rules) {
    using Code = Assembler::Code;
    constexpr std::size_t most_rules = 10000, words = sizeof(SeriesRule) / 8, factors = offsetof(SeriesRule, f) / 8;
    static_assert(sizeof(SeriesRule) % 8 == 0 && offsetof(SeriesRule, f) % 8 == 0);
    if (rules.empty() || rules.size() > most_rules) return nullptr;
    Assembler code(Assembler::Base::first);
    for (std::size_t i = 0; i < rules.size(); ++i) {
        const SeriesRule& rule = rules[i];
        const unsigned result = code.result(rule.result);  // an operand that stood there is read from memory
        const auto product = [&](unsigned reg, std::size_t factor, std::uint32_t operand) {
            code.memory(Code::load, reg, Assembler::Base::second, words * i + factors + factor);
            code.apply(Code::multiply, reg, operand);
        };
        product(result, 2, rule.w);
        product(1, 1, rule.y);
        code.registers(Code::add, result, 1);
        product(1, 0, rule.x);
        code.registers(Code::add, result, 1);
        code.store(result, rule.result);
    }
    code.leave_at_once();
    return MachineCode::of(code.bytes());
}

#else

std::shared_ptr<const MachineCode> machine_code(std::span<const SeriesRule>) { return nullptr; }

#endif

}  // namespace achilles
