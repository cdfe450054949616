// The Taylor coefficients of a motion over any number, an interval or one with its derivatives: the plan that runs have,
// order by order (recurrence.hpp), with every constant as that number sees it. For proofs; there is no machine code in it.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "number/jet.hpp"
#include "series/recurrence.hpp"
#include "series/series.hpp"

namespace achilles {

template <class Number>
class SeriesOver {
 public:
    static constexpr int highest_order = OrderCode::highest_order;

    explicit SeriesOver(const SeriesProgram& program)
        : program_(&program),
          zero_(program.program_),
          coefficients_(program.coefficients_.size()),
          factors_(program.plan_.rules.size()),
          sums_(program.plan_, program.inner_sums()),
          now_(program.plan_.numbers()),
          kept_(sums_.row() * (highest_order + 2)),
          rows_(program.plan_.states() * (highest_order + 2)) {
        std::vector<Number>& registers = LaneAccess::registers_of(zero_);
        registers.resize(std::max(registers.size(), program.registers_));
        tables_ = {factors_.data(), now_.data(), kept_.data()};
    }

    // Evaluates what depends on the parameters alone.
    void fix(std::span<const Number> parameters) {
        const std::size_t first = LaneAccess::moving_inputs(program_->program_);
        for (std::size_t i = 0; i < parameters.size(); ++i) zero_.input(first + i) = parameters[i];
        zero_.fix();
        program_->fix(registers(), coefficients_.data(), factors_.data());
    }

    // Makes orders 0 .. last of the event functions, 0 .. last + 1 of the state, from (q, v) and the time; 1 <= last < 34.
    void expand(const Number* state, const Number& time, int last) {
        begin(state, time);
        for (int k = 1; k <= last; ++k) extend(k);
        const std::size_t n = program_->plan_.coordinates(), width = program_->plan_.states();
        Number* const row = rows_.data() + static_cast<std::size_t>(last + 1) * width;
        const Number inverse = Number(1.0) / Number(static_cast<double>(last + 1));
        for (std::size_t i = 0; i < n; ++i) {
            row[i] = inverse * row[n + i - width];
            row[n + i] = inverse * now_[program_->plan_.outputs[i]];
        }
    }
    // The same order by order: order 0, then those of all from 1 on, one after the other, to highest_order at most.
    void begin(const Number* state, const Number& time) {
        const SeriesPlan& plan = program_->plan_;
        const std::size_t n = plan.coordinates();
        std::fill(now_.begin(), now_.end(), Number(0.0));
        for (std::size_t i = 0; i < 2 * n; ++i) zero_.input(i) = rows_[i] = state[i];
        if (plan.clock != 0) {
            zero_.clock() = time;
            now_[plan.clock] = Number(1.0);
        }
        zero_.run();
        program_->start(registers(), coefficients_.data(), factors_.data());
        for (std::size_t i = 0; i < plan.events; ++i) rows_[2 * n + i] = start(n + i);
        Number* const row = rows_.data() + plan.states();
        for (std::size_t i = 0; i < n; ++i) {
            row[i] = state[n + i];
            row[n + i] = start(i);
        }
    }
    void extend(int k) {
        const SeriesPlan& plan = program_->plan_;
        Number* const row = rows_.data() + static_cast<std::size_t>(k) * plan.states();
        make_motion_order(plan, sums_, tables_, row, static_cast<std::size_t>(k));
    }
    // Whether the series depend on the time by itself.
    bool has_clock() const { return program_->plan_.clock != 0; }
    // Order k: q and v, then the event functions.
    const Number& coefficient(int k, std::size_t i) const {
        return rows_[static_cast<std::size_t>(k) * program_->plan_.states() + i];
    }
    // Order 0 of an output: accelerations, event functions, what else there is.
    const Number& start(std::size_t index) { return registers()[program_->outputs_[index]]; }

 private:
    Number* registers() { return LaneAccess::registers_of(zero_).data(); }

    const SeriesProgram* program_;
    Evaluator<Number> zero_;  // order 0, with room for hidden registers
    std::vector<Number> coefficients_;
    std::vector<std::array<Number, 3>> factors_;
    InnerSums<Number> sums_;
    std::vector<Number> now_, kept_, rows_;
    SeriesTablesOver<Number> tables_;
};

}  // namespace achilles
