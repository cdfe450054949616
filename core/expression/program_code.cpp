#include "expression/program_code.hpp"

#include <cmath>

namespace achilles {

#if defined(__x86_64__) && defined(__linux__)

namespace {

using Code = Assembler::Code;
using Function = double (*)(double);

constexpr std::size_t most_instructions = 20000;

double whole_power(double x, int n) { return integer_power(x, n); }

Function function_of(Operation operation) {
    switch (operation) {
        case Operation::sin:
            return std::sin;
        case Operation::cos:
            return std::cos;
        case Operation::tan:
            return std::tan;
        case Operation::asin:
            return std::asin;
        case Operation::acos:
            return std::acos;
        case Operation::atan:
            return std::atan;
        case Operation::sinh:
            return std::sinh;
        case Operation::cosh:
            return std::cosh;
        case Operation::tanh:
            return std::tanh;
        case Operation::exp:
            return std::exp;
        case Operation::log:
            return std::log;
        default:
            return nullptr;
    }
}

// A function of xmm0 (and what else is in place).
void call(Assembler& code, const void* function, std::uint32_t a, std::uint32_t result) {
    code.get(0, a);
    code.call(function);
    code.store(0, result);
}

void arithmetic(Assembler& code, Code operation, const Instruction& in, std::uint32_t result) {
    const unsigned reg = code.result(result);
    code.combine(operation, reg, in.a, in.b);
    code.store(reg, result);
}

// False if there is no code for it.
bool write(Assembler& code, const Instruction& in, std::uint32_t result) {
    unsigned reg = 0;
    switch (in.operation) {
        case Operation::add:
            arithmetic(code, Code::add, in, result);
            return true;
        case Operation::subtract:
            arithmetic(code, Code::subtract, in, result);
            return true;
        case Operation::multiply:
            arithmetic(code, Code::multiply, in, result);
            return true;
        case Operation::divide:
            arithmetic(code, Code::divide, in, result);
            return true;
        case Operation::negate:
            reg = code.result(result);
            code.negative_zero(reg);
            code.apply(Code::subtract, reg, reg, in.a);
            code.store(reg, result);
            return true;
        case Operation::sqrt:
            reg = code.result(result);
            code.apply(Code::sqrt, reg, reg, in.a);
            code.store(reg, result);
            return true;
        case Operation::power:
            code.integer_argument(in.exponent);
            call(code, reinterpret_cast<const void*>(&whole_power), in.a, result);
            return true;
        case Operation::real_power:
            code.get(1, in.b);
            call(code, reinterpret_cast<const void*>(static_cast<double (*)(double, double)>(std::pow)), in.a, result);
            return true;
        default:
            break;
    }
    const Function function = function_of(in.operation);
    if (function == nullptr) return false;
    call(code, reinterpret_cast<const void*>(function), in.a, result);
    return true;
}

}  // namespace

std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first) {
    if (!widest_code() || instructions.empty() || instructions.size() > most_instructions) return nullptr;
    Assembler code(Assembler::Base::rbx, 2);
    code.enter();
    for (const Instruction& in : instructions)
        if (!write(code, in, first++)) return nullptr;
    code.leave();
    return MachineCode::of(code.bytes());
}

#else

std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction>, std::uint32_t) { return nullptr; }

#endif

}  // namespace achilles
