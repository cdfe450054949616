// A program over double, or doubles side by side, with machine code where that is to be had.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "program/machine.hpp"
#include "series/lane_access.hpp"

namespace achilles {

template <class Number>
class ProgramOver {
    static constexpr bool is_one = std::is_same_v<Number, double>;  // whose machine code is the program's own

 public:
    // Lanes may have machine code by vectors of four or eight. With room for so many registers, if these are more than the
    // program's.
    explicit ProgramOver(const Program& program, std::optional<Width> machine_code = {}, std::size_t registers = 0)
        : program_(&program) {
        if constexpr (is_one) {
            evaluator_ = Evaluator<double>(program);
            numbers().resize(std::max(registers, numbers().size()), 0.0);
        } else {
            LaneAccess::program_of(evaluator_) = &program;
            Evaluator<double> one(program);
            const std::vector<double>& constants = LaneAccess::registers_of(one);
            numbers().resize(std::max(registers, constants.size()), Number(0.0));
            for (std::size_t i = 0; i < constants.size(); ++i) numbers()[i] = constants[i];
            if (!machine_code) return;
            code_ = LaneAccess::machine_code_of(program, *machine_code);
            if (code_) run_ = code_->as<void(Number*)>();
        }
    }

    // Evaluates what depends on the parameters alone.
    template <class Parameter>
    void fix(std::span<const Parameter> parameters) {
        const std::size_t first = LaneAccess::moving_inputs(*program_);
        for (std::size_t i = 0; i < parameters.size(); ++i) evaluator_.input(first + i) = parameters[i];
        evaluator_.fix();
    }
    Number& input(std::size_t slot) { return evaluator_.input(slot); }
    Number& clock() { return evaluator_.clock(); }
    const Number& output(std::size_t index) const { return evaluator_.output(index); }
    // All registers, the inputs first.
    std::vector<Number>& numbers() { return LaneAccess::registers_of(evaluator_); }

    void run() {
        if constexpr (is_one) {
            evaluator_.run();
        } else {
            if (run_ != nullptr) return run_(numbers().data());
            evaluator_.run_by_loop();
        }
    }

 private:
    const Program* program_;
    Evaluator<Number> evaluator_;
    std::shared_ptr<const MachineCode> code_;
    void (*run_)(Number*) = nullptr;
};

}  // namespace achilles
