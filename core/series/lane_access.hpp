// What an evaluator over any number takes from programs and series programs: their insides.
#pragma once

#include "series/series.hpp"

namespace achilles {

class LaneAccess {
 public:
    // Machine code over lanes for what moves, by vectors of four or eight; may be none.
    static std::shared_ptr<const MachineCode> machine_code_of(const Program& program, Width vectors);
    static const SeriesPlan& plan_of(const SeriesProgram& series) { return series.plan_; }
    static std::size_t moving_inputs(const Program& program) { return program.slots_.parameters_begin; }
    static bool has_clock(const Program& program) { return program.slots_.has_clock(); }
    static std::uint32_t clock(const Program& program) { return program.slots_.clock(); }
    template <class Number>
    static const Program*& program_of(Evaluator<Number>& evaluator) {
        return evaluator.program_;
    }
    template <class Number>
    static std::vector<Number>& registers_of(Evaluator<Number>& evaluator) {
        return evaluator.registers_;
    }
};

}  // namespace achilles
