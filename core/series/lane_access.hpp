// What the lanes take from programs and series programs: their insides, to run them on eight runs at once.
#pragma once

#include "series/series.hpp"

namespace achilles {

class LaneAccess {
 public:
    // Machine code over lanes for what moves; may be none.
    static std::shared_ptr<const MachineCode> machine_code_of(const Program& program);
    static const Program& program_of(const SeriesProgram& series) { return series.program_; }
    static const SeriesPlan& plan_of(const SeriesProgram& series) { return series.plan_; }
    static std::uint32_t output_of(const SeriesProgram& series, std::size_t index) { return series.outputs_[index]; }
    static std::size_t registers_of(const SeriesProgram& series) { return series.registers_; }
    static std::size_t coefficients_of(const SeriesProgram& series) { return series.coefficients_.size(); }
    static std::size_t moving_inputs(const Program& program) { return program.slots_.parameters_begin; }
    template <class Lanes>
    static const Program*& program_of(Evaluator<Lanes>& evaluator) {
        return evaluator.program_;
    }
    template <class Lanes>
    static std::vector<Lanes>& registers_of(Evaluator<Lanes>& evaluator) {
        return evaluator.registers_;
    }
    template <class Lanes>
    static void fix(const SeriesProgram& series, const Lanes* registers, Lanes* coefficients,
                    std::array<Lanes, 3>* factors) {
        series.fix(registers, coefficients, factors);
    }
    template <class Lanes>
    static void start(const SeriesProgram& series, Lanes* registers, const Lanes* coefficients,
                      std::array<Lanes, 3>* factors) {
        series.start(registers, coefficients, factors);
    }
};

}  // namespace achilles
