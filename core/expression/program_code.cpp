#include "expression/program_code.hpp"

#include <cmath>
#include <map>
#include <optional>

#include "expression/sine.hpp"

namespace achilles {

#if defined(__x86_64__) && defined(__linux__)

namespace {

using Code = Assembler::Code;
using Function = double (*)(double);

constexpr std::size_t most_instructions = 20000;

double whole_power(double x, int n) { return integer_power(x, n); }
double sine(double x) { return sine_and_cosine(x).sine; }
double cosine(double x) { return sine_and_cosine(x).cosine; }
void both(double x, double* sine, double* cosine) {
    const SineCosine value = sine_and_cosine(x);
    *sine = value.sine;
    *cosine = value.cosine;
}

Function function_of(Operation operation) {
    switch (operation) {
        case Operation::sin:
            return sine;
        case Operation::cos:
            return cosine;
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

// The results that are sine and cosine of one operand.
struct Waves {
    std::optional<std::uint32_t> sine, cosine;
    bool written = false;
};

std::map<std::uint32_t, Waves> waves_of(std::span<const Instruction> instructions, std::uint32_t first) {
    std::map<std::uint32_t, Waves> waves;
    for (const Instruction& in : instructions) {
        if (in.operation == Operation::sin) waves[in.a].sine = first;
        if (in.operation == Operation::cos) waves[in.a].cosine = first;
        ++first;
    }
    return waves;
}

// Where the first of the two stands.
void call_both(Assembler& code, std::uint32_t operand, Waves& waves) {
    if (waves.written) return;
    waves.written = true;
    code.get(0, operand);
    code.address(Assembler::Base::rdi, Assembler::Base::rbx, *waves.sine);
    code.address(Assembler::Base::rsi, Assembler::Base::rbx, *waves.cosine);
    code.call(reinterpret_cast<const void*>(&both));
}

}  // namespace

std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first) {
    if (!widest_code() || instructions.empty() || instructions.size() > most_instructions) return nullptr;
    Assembler code(Assembler::Base::rbx, 2);
    code.enter();
    std::map<std::uint32_t, Waves> waves = waves_of(instructions, first);
    for (const Instruction& in : instructions) {
        const std::uint32_t result = first++;
        const bool is_wave = in.operation == Operation::sin || in.operation == Operation::cos;
        if (is_wave && waves[in.a].sine && waves[in.a].cosine) {
            call_both(code, in.a, waves[in.a]);
        } else if (!write(code, in, result)) {
            return nullptr;
        }
    }
    code.leave();
    return MachineCode::of(code.bytes());
}

#else

std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction>, std::uint32_t) { return nullptr; }

#endif

}  // namespace achilles
