// Machine code for a program over double, or over eight lanes.
#include <cmath>
#include <map>
#include <optional>

#include "number/angle.hpp"
#include "number/double8.hpp"
#include "program/assembler.hpp"
#include "program/machine.hpp"
#include "program/program.hpp"

namespace achilles {

namespace {

using Xbyak::Xmm;
using Function = double (*)(double);

constexpr std::size_t max_instructions = 20000;

double cosine(double x) { return sine_and_cosine(x).cosine; }
double whole_power(double x, int n) { return integer_power(x, n); }
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
        case Operation::midpoint:
            return [](double x) { return midpoint_of(x); };
        default:
            return nullptr;
    }
}

// ---- functions over lanes: operands and results are in memory ----

using LaneFunction = void(const Double8* a, Double8* result);

template <Operation operation>
void each(const Double8* a, Double8* result) {
    for (std::size_t i = 0; i < Double8::count; ++i) (*result)[i] = function_of(operation)((*a)[i]);
}
void each_whole_power(const Double8* a, Double8* result, int n) {
    for (std::size_t i = 0; i < Double8::count; ++i) (*result)[i] = integer_power((*a)[i], n);
}
void each_real_power(const Double8* a, Double8* result, const Double8* b) {
    for (std::size_t i = 0; i < Double8::count; ++i) (*result)[i] = std::pow((*a)[i], (*b)[i]);
}

LaneFunction* function_of_lanes(Operation operation) {
    switch (operation) {
        case Operation::sin:
            return [](const Double8* a, Double8* result) {
                Double8 cosine_too;
                sine_and_cosine_of_lanes(a, result, &cosine_too);
            };
        case Operation::cos:
            return [](const Double8* a, Double8* result) {
                Double8 sine_too;
                sine_and_cosine_of_lanes(a, &sine_too, result);
            };
        case Operation::tan:
            return each<Operation::tan>;
        case Operation::asin:
            return each<Operation::asin>;
        case Operation::acos:
            return each<Operation::acos>;
        case Operation::atan:
            return each<Operation::atan>;
        case Operation::sinh:
            return each<Operation::sinh>;
        case Operation::cosh:
            return each<Operation::cosh>;
        case Operation::tanh:
            return each<Operation::tanh>;
        case Operation::exp:
            return each<Operation::exp>;
        case Operation::log:
            return each<Operation::log>;
        case Operation::midpoint:
            return each<Operation::midpoint>;
        default:
            return nullptr;
    }
}

// ---- code generation ----

// Calls a function of xmm0 (and of other arguments that are already in place).
void call(Assembler& code, const void* function, std::uint32_t a, std::uint32_t result) {
    code.get(code.xmm0, a);
    code.call(function);
    code.store(code.xmm0, result);
}

bool is_arithmetic(const Instruction& in) {
    switch (in.operation) {
        case Operation::power:
            return in.exponent == 2;  // the same bits as integer_power()
        case Operation::add:
        case Operation::subtract:
        case Operation::multiply:
        case Operation::divide:
        case Operation::negate:
        case Operation::sqrt:
            return true;
        default:
            return false;
    }
}

void write_arithmetic(Assembler& code, const Instruction& in, std::uint32_t result) {
    const Xmm reg = code.result(result);
    if (in.operation == Operation::negate) {
        code.negate(reg, in.a);
    } else if (in.operation == Operation::sqrt) {
        code.sqrt(reg, in.a);
    } else if (in.operation == Operation::power) {
        code.combine(Assembler::vmul, reg, in.a, in.a);
    } else {
        code.combine(in.operation == Operation::add        ? Assembler::vadd
                     : in.operation == Operation::subtract ? Assembler::vsub
                     : in.operation == Operation::multiply ? Assembler::vmul
                                                           : Assembler::vdiv,
                     reg, in.a, in.b);
    }
    code.store(reg, result);
}

// to = address of a number
void address(Assembler& code, const Xbyak::Reg64& to, std::uint32_t number) { code.lea(to, code.number(number)); }

// Calls a function of (operand, result); a third argument must be in place.
void call_on_lanes(Assembler& code, const void* function, std::uint32_t a, std::uint32_t result) {
    address(code, code.rdi, a);
    address(code, code.rsi, result);
    code.call(function);
}

// Emits a call that applies a function to every lane of a vector. Returns false if there is no code for the operation.
bool write_for_lanes(Assembler& code, const Instruction& in, std::uint32_t result) {
    if (in.operation == Operation::power) {
        code.mov(code.edx, static_cast<std::uint32_t>(in.exponent));
        call_on_lanes(code, reinterpret_cast<const void*>(&each_whole_power), in.a, result);
        return true;
    }
    if (in.operation == Operation::real_power) {
        address(code, code.rdx, in.b);
        call_on_lanes(code, reinterpret_cast<const void*>(&each_real_power), in.a, result);
        return true;
    }
    LaneFunction* const function = function_of_lanes(in.operation);
    if (function == nullptr) return false;
    call_on_lanes(code, reinterpret_cast<const void*>(function), in.a, result);
    return true;
}

// The same for a single number.
bool write_for_one(Assembler& code, const Instruction& in, std::uint32_t result) {
    if (in.operation == Operation::power) {
        code.mov(code.edi, static_cast<std::uint32_t>(in.exponent));
        call(code, reinterpret_cast<const void*>(&whole_power), in.a, result);
        return true;
    }
    if (in.operation == Operation::real_power) {
        code.get(code.xmm1, in.b);
        call(code, reinterpret_cast<const void*>(static_cast<double (*)(double, double)>(std::pow)), in.a, result);
        return true;
    }
    const Function function = function_of(in.operation);
    if (function == nullptr) return false;
    call(code, reinterpret_cast<const void*>(function), in.a, result);
    return true;
}

// Indices of the results that are the sine and the cosine of one operand.
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

// Emits one call that computes sine and cosine of an operand. Does nothing at the second of the two instructions.
void call_both(Assembler& code, std::uint32_t operand, Waves& waves) {
    if (waves.written) return;
    waves.written = true;
    const bool one = code.width() == Width::one;
    if (one) {
        code.get(code.xmm0, operand);
        address(code, code.rdi, *waves.sine);
        address(code, code.rsi, *waves.cosine);
    } else {
        address(code, code.rdi, operand);
        address(code, code.rsi, *waves.sine);
        address(code, code.rdx, *waves.cosine);
    }
    code.call(one ? reinterpret_cast<const void*>(&both) : reinterpret_cast<const void*>(&sine_and_cosine_of_lanes));
}

// Emits a function call. Returns false if there is no code for it.
bool write_call(Assembler& code, const Instruction& in, std::uint32_t result, std::map<std::uint32_t, Waves>& waves) {
    const bool is_wave = in.operation == Operation::sin || in.operation == Operation::cos;
    if (is_wave && waves[in.a].sine && waves[in.a].cosine) {
        call_both(code, in.a, waves[in.a]);
        return true;
    }
    return code.width() == Width::one ? write_for_one(code, in, result) : write_for_lanes(code, in, result);
}

// True if the processor supports these vectors, and they fit numbers of this width.
bool can_work(Width of_number, Width of_vector) {
    const bool fit = (of_number == Width::one) == (of_vector == Width::one);
    const auto best = best_width();
    return fit && best && of_vector <= *best;
}

}  // namespace

// A function call processes all parts of a number at once. The arithmetic between two calls is emitted part by part.
std::shared_ptr<const MachineCode> machine_code(std::span<const Instruction> instructions, std::uint32_t first,
                                                Width of_number, Width of_vector) {
    if (!can_work(of_number, of_vector) || instructions.empty() || instructions.size() > max_instructions)
        return nullptr;
    Assembler code(Xbyak::util::rbx, 2, of_number, of_vector);
    code.prologue();
    std::map<std::uint32_t, Waves> waves = waves_of(instructions, first);
    const auto result_of = [&](std::size_t i) { return first + static_cast<std::uint32_t>(i); };
    for (std::size_t i = 0; i < instructions.size(); ++i) {
        const std::size_t begin = i;
        while (i < instructions.size() && is_arithmetic(instructions[i])) ++i;
        code.for_each_part([&] {
            for (std::size_t k = begin; k < i; ++k) write_arithmetic(code, instructions[k], result_of(k));
        });
        if (i < instructions.size() && !write_call(code, instructions[i], result_of(i), waves)) return nullptr;
    }
    code.epilogue();
    return MachineCode::of(code.bytes());
}

}  // namespace achilles
