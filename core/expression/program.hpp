// A flat program: a list of expressions, every common subexpression evaluated once, over any scalar type.
//
// Inputs are slots 0 .. inputs-1 (see model.hpp for their layout). Slots in [fixed_begin, fixed_end) are parameters:
// what depends on them alone is evaluated by fix(), once a run, and the rest by run(), with no allocation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "expression/expression.hpp"
#include "expression/scalar.hpp"

namespace achilles {

struct Slots {
    std::uint32_t count = 0;        // all inputs
    std::uint32_t fixed_begin = 0;  // the parameters among them
    std::uint32_t fixed_end = 0;
};

struct Instruction {
    Operation operation;
    std::uint32_t a = 0, b = 0;  // registers
    std::int32_t exponent = 0;
};

class Program {
 public:
    Program() = default;
    Program(std::span<const Expression> outputs, Slots slots);

    std::uint32_t input_count() const { return slots_.count; }
    std::size_t output_count() const { return outputs_.size(); }
    std::size_t size() const { return instructions_.size(); }

 private:
    template <class Scalar>
    friend class Evaluator;
    friend class SeriesCompiler;
    friend class SeriesEvaluator;
    Slots slots_;
    std::vector<Constant> constants_;        // registers count .. count + constants - 1
    std::vector<Instruction> instructions_;  // results follow in order, one register each
    std::size_t fixed_ = 0;                  // instructions that depend on parameters alone come first
    std::vector<std::uint32_t> outputs_;     // registers
};

// A program with its registers. One per thread; copying copies the registers.
template <class Scalar>
class Evaluator {
 public:
    Evaluator() = default;
    explicit Evaluator(const Program& program) : program_(&program) {
        registers_.resize(program.slots_.count + program.constants_.size() + program.instructions_.size(), Scalar(0));
        std::size_t at = program.slots_.count;
        for (const Constant& constant : program.constants_) registers_[at++] = scalar_from<Scalar>(constant);
    }

    Scalar& input(std::size_t slot) { return registers_[slot]; }
    const Scalar& output(std::size_t index) const { return registers_[program_->outputs_[index]]; }
    std::size_t output_count() const { return program_->outputs_.size(); }

    // Evaluates what depends on the parameters alone. Call after the parameter inputs change, before run().
    void fix() { execute(0, program_->fixed_); }
    // Evaluates the rest. Inputs must be set.
    void run() { execute(program_->fixed_, program_->instructions_.size()); }

 private:
    friend class SeriesEvaluator;
    void execute(std::size_t begin, std::size_t end);
    const Program* program_ = nullptr;
    std::vector<Scalar> registers_;
};

template <class Scalar>
void Evaluator<Scalar>::execute(std::size_t begin, std::size_t end) {
    using std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::log, std::sin, std::sinh, std::sqrt,
        std::tan, std::tanh, std::pow;
    Scalar* const r = registers_.data();
    Scalar* result = r + program_->slots_.count + program_->constants_.size() + begin;
    for (std::size_t i = begin; i < end; ++i, ++result) {
        const Instruction& in = program_->instructions_[i];
        const Scalar& a = r[in.a];
        switch (in.operation) {
            case Operation::add:
                *result = a + r[in.b];
                break;
            case Operation::subtract:
                *result = a - r[in.b];
                break;
            case Operation::multiply:
                *result = a * r[in.b];
                break;
            case Operation::divide:
                *result = a / r[in.b];
                break;
            case Operation::negate:
                *result = -a;
                break;
            case Operation::power:
                *result = integer_power(a, in.exponent);
                break;
            case Operation::real_power:
                *result = pow(a, r[in.b]);
                break;
            case Operation::sqrt:
                *result = sqrt(a);
                break;
            case Operation::sin:
                *result = sin(a);
                break;
            case Operation::cos:
                *result = cos(a);
                break;
            case Operation::tan:
                *result = tan(a);
                break;
            case Operation::asin:
                *result = asin(a);
                break;
            case Operation::acos:
                *result = acos(a);
                break;
            case Operation::atan:
                *result = atan(a);
                break;
            case Operation::sinh:
                *result = sinh(a);
                break;
            case Operation::cosh:
                *result = cosh(a);
                break;
            case Operation::tanh:
                *result = tanh(a);
                break;
            case Operation::exp:
                *result = exp(a);
                break;
            case Operation::log:
                *result = log(a);
                break;
            case Operation::pi:
                *result = scalar_pi<Scalar>();
                break;
            case Operation::number:
            case Operation::symbol:
                break;  // not instructions
        }
    }
}

}  // namespace achilles
