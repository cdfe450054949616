// A flat program: evaluates a list of expressions over any scalar type, each common subexpression once.
//
// Inputs are slots 0 .. inputs-1 (see model.hpp for their layout). Slots in [parameters_begin, parameters_end) are
// parameters. fix() evaluates what depends on parameters only, once per run; run() evaluates the rest, without
// allocation.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "expression/expression.hpp"
#include "expression/scalar.hpp"

namespace achilles {

class MachineCode;

struct Slots {
    std::uint32_t count = 0;             // all inputs
    std::uint32_t parameters_begin = 0;  // the parameters among them
    std::uint32_t parameters_end = 0;
    // The input after the parameters is the time, if the program has one.
    std::uint32_t clock() const { return parameters_end; }
    bool has_clock() const { return parameters_end < count; }
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
    // By slot: true for inputs that the first `outputs` outputs depend on.
    std::vector<bool> inputs_of(std::size_t outputs) const;

 private:
    template <class Scalar>
    friend class Evaluator;
    friend class SeriesCompiler;
    friend class SeriesProgram;
    template <class Number>
    friend class SeriesEvaluator;
    friend class LaneAccess;
    Slots slots_;
    std::vector<Constant> constants_;        // registers count .. count + constants - 1
    std::vector<Instruction> instructions_;  // their results follow in this order, one register each
    std::size_t fixed_ = 0;                  // number of instructions that depend on parameters only; they come first
    std::vector<std::size_t> runs_;          // end index of each run of instructions with the same operation
    std::size_t fixed_runs_ = 0;
    std::vector<std::uint32_t> outputs_;  // registers
    // Code over double for the instructions after `fixed_`; may be null.
    std::shared_ptr<const MachineCode> code_;
    void (*run_code_)(double* registers) = nullptr;
};

// A program with its registers. Use one per thread; a copy has its own registers.
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
    // The time, for a program with a time input.
    Scalar& clock() { return registers_[program_->slots_.clock()]; }
    const Scalar& output(std::size_t index) const { return registers_[program_->outputs_[index]]; }
    std::size_t output_count() const { return program_->outputs_.size(); }

    // Evaluates what depends on parameters only. Call after changing parameter inputs, before run().
    void fix() { execute(0, program_->fixed_runs_); }
    // Evaluates the rest. All inputs must be set.
    void run() {
        if constexpr (std::is_same_v<Scalar, double>)
            if (program_->run_code_ != nullptr) return program_->run_code_(registers_.data());
        run_by_loop();
    }
    // The same as run(), without machine code.
    void run_by_loop() { execute(program_->fixed_runs_, program_->runs_.size()); }

 private:
    template <class Number>
    friend class SeriesEvaluator;
    friend class LaneAccess;
    void execute(std::size_t first_run, std::size_t last_run);
    const Program* program_ = nullptr;
    std::vector<Scalar> registers_;
};

// Branches once per run of equal operations, not once per instruction: branches by instruction are hard to predict.
template <class Scalar>
void Evaluator<Scalar>::execute(std::size_t first_run, std::size_t last_run) {
    using std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::log, std::sin, std::sinh, std::sqrt,
        std::tan, std::tanh, std::pow;
    Scalar* const r = registers_.data();
    const Instruction* const begin = program_->instructions_.data();
    const Instruction* in = begin + (first_run == 0 ? 0 : program_->runs_[first_run - 1]);
    Scalar* result = r + program_->slots_.count + program_->constants_.size() + (in - begin);
    for (std::size_t run = first_run; run < last_run; ++run) {
        const Instruction* const end = begin + program_->runs_[run];
        switch (in->operation) {
            case Operation::add:
                for (; in != end; ++in, ++result) *result = r[in->a] + r[in->b];
                break;
            case Operation::subtract:
                for (; in != end; ++in, ++result) *result = r[in->a] - r[in->b];
                break;
            case Operation::multiply:
                for (; in != end; ++in, ++result) *result = r[in->a] * r[in->b];
                break;
            case Operation::divide:
                for (; in != end; ++in, ++result) *result = r[in->a] / r[in->b];
                break;
            case Operation::negate:
                for (; in != end; ++in, ++result) *result = -r[in->a];
                break;
            case Operation::power:
                for (; in != end; ++in, ++result) *result = integer_power(r[in->a], in->exponent);
                break;
            case Operation::real_power:
                for (; in != end; ++in, ++result) *result = pow(r[in->a], r[in->b]);
                break;
            case Operation::sqrt:
                for (; in != end; ++in, ++result) *result = sqrt(r[in->a]);
                break;
            case Operation::sin:
                for (; in != end; ++in, ++result) *result = sin(r[in->a]);
                break;
            case Operation::cos:
                for (; in != end; ++in, ++result) *result = cos(r[in->a]);
                break;
            case Operation::tan:
                for (; in != end; ++in, ++result) *result = tan(r[in->a]);
                break;
            case Operation::asin:
                for (; in != end; ++in, ++result) *result = asin(r[in->a]);
                break;
            case Operation::acos:
                for (; in != end; ++in, ++result) *result = acos(r[in->a]);
                break;
            case Operation::atan:
                for (; in != end; ++in, ++result) *result = atan(r[in->a]);
                break;
            case Operation::sinh:
                for (; in != end; ++in, ++result) *result = sinh(r[in->a]);
                break;
            case Operation::cosh:
                for (; in != end; ++in, ++result) *result = cosh(r[in->a]);
                break;
            case Operation::tanh:
                for (; in != end; ++in, ++result) *result = tanh(r[in->a]);
                break;
            case Operation::exp:
                for (; in != end; ++in, ++result) *result = exp(r[in->a]);
                break;
            case Operation::log:
                for (; in != end; ++in, ++result) *result = log(r[in->a]);
                break;
            case Operation::midpoint:
                for (; in != end; ++in, ++result) *result = midpoint_of(r[in->a]);
                break;
            case Operation::pi:
                for (; in != end; ++in, ++result) *result = scalar_pi<Scalar>();
                break;
            case Operation::number:
            case Operation::symbol:
                break;  // not instructions
        }
    }
}

extern template void Evaluator<double>::execute(std::size_t, std::size_t);
extern template void Evaluator<Interval>::execute(std::size_t, std::size_t);

}  // namespace achilles
