// Evaluators of a program, and of a series program with its coefficients, over double, eight doubles, or any other
// number type. Use one per thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "number/lanes.hpp"
#include "program/machine.hpp"
#include "series/recurrence.hpp"
#include "series/series.hpp"

namespace achilles {

// Memory for the table of an evaluator, aligned to a cache line. What is returned is kept for the next table of this
// size: the system would take back such a block and give it again page by page, which takes as long as some orders.
void* borrow_table(std::size_t bytes);
void return_table(void* table, std::size_t bytes);

template <class Number>
inline constexpr bool is_lanes = false;
template <std::size_t Bytes>
inline constexpr bool is_lanes<Lanes<Bytes>> = true;

// Does what SeriesProgram::start() does over eight lanes, with the widest vectors that the processor has.
void start_of_lanes(const SeriesProgram& program, Double8* registers, const Double8* coefficients,
                    std::array<Double8, 3>* factors);

// A program over any number type. Over double and lanes it uses machine code if available. Over lanes the constants are
// those of double; over other types they are as accurate as the type allows.
template <class Number>
class ProgramOver {
 public:
    // Over lanes, `code` may be null. `registers` is the minimum number of registers.
    explicit ProgramOver(const Program& program, std::shared_ptr<const MachineCode> code = {},
                         std::size_t registers = 0)
        : program_(&program), code_(std::move(code)) {
        if constexpr (!is_lanes<Number>) {
            evaluator_ = Evaluator<Number>(program);
            numbers().resize(std::max(registers, numbers().size()), Number(0.0));
        } else {
            LaneAccess::program_of(evaluator_) = &program;
            Evaluator<double> one(program);
            const std::vector<double>& constants = LaneAccess::registers_of(one);
            numbers().resize(std::max(registers, constants.size()), Number(0.0));
            for (std::size_t i = 0; i < constants.size(); ++i) numbers()[i] = constants[i];
            if (code_) run_ = code_->template as<void(Number*)>();
        }
    }

    // Evaluates what depends on parameters only.
    template <class Parameter>
    void fix(std::span<const Parameter> parameters) {
        const std::size_t first = LaneAccess::moving_inputs(*program_);
        for (std::size_t i = 0; i < parameters.size(); ++i) evaluator_.input(first + i) = parameters[i];
        evaluator_.fix();
    }
    Number& input(std::size_t slot) { return evaluator_.input(slot); }
    Number& clock() { return evaluator_.clock(); }
    const Number& output(std::size_t index) const { return evaluator_.output(index); }
    // All registers, inputs first.
    std::vector<Number>& numbers() { return LaneAccess::registers_of(evaluator_); }

    void run() {
        if constexpr (is_lanes<Number>)
            if (run_ != nullptr) return run_(numbers().data());
        evaluator_.run();
    }

 private:
    const Program* program_;
    Evaluator<Number> evaluator_;
    std::shared_ptr<const MachineCode> code_;
    void (*run_)(Number*) = nullptr;
};

// A series program with its coefficients.
template <class Number>
class SeriesEvaluator {
    static constexpr bool is_one = std::is_same_v<Number, double>;
    // Machine code that computes orders faster, with the same bits; may be null. It is null for all types except double
    // and lanes.
    using Code = std::conditional_t<is_one, OrderCode, LaneOrderCode>;

 public:
    static constexpr int highest_order = OrderCode::highest_order;

    // Call fix() before use.
    explicit SeriesEvaluator(const SeriesProgram& program) requires(!is_lanes<Number>)
        : SeriesEvaluator(&program, InnerSums<Number>(program.plan_, program.inner_sums()), code_of(program)) {}
    SeriesEvaluator(const SeriesProgram& program, std::span<const double> parameters) requires is_one
        : SeriesEvaluator(program) {
        fix(parameters);
    }
    // Call fix() before use. (It is a template because clang 14 compiles it for all number types otherwise.)
    template <class Same = Number>
    SeriesEvaluator(const SeriesProgram& program, const LaneCode& code) requires is_lanes<Same>
        : SeriesEvaluator(&program, InnerSums<Number>(code.plan), code.orders, code.start) {}

    // Evaluates what depends on parameters only.
    template <class Parameter>
    void fix(std::span<const Parameter> parameters) {
        zero_.fix(parameters);
        program_->fix(zero_.numbers().data(), coefficients_.data(), factors_.data());
    }

    // Evaluates order 0 at these values of the moving inputs and this time. `rate` is the derivative of the time with
    // respect to the variable of the series: 1, or the duration of its unit.
    void begin(const Number* inputs, const Number& time = 0.0, const Number& rate = 1.0) {
        for (std::size_t i = 0; i < inputs_; ++i) zero_.numbers()[i] = inputs[i];
        if (program_->plan_.clock != 0) {
            zero_.clock() = time;
            tables_.now[program_->plan_.clock] = rate;
        }
        zero_.run();
        Number* const sums = tables_.now + program_->plan_.series;
        for (std::size_t i = 0; i < sums_.count(); ++i) sums[i] = 0.0;  // inner sums of order 1
        if constexpr (std::is_same_v<Number, Lanes<16>>)
            start_of_lanes(*program_, reinterpret_cast<Double8*>(zero_.numbers().data()),
                           reinterpret_cast<const Double8*>(coefficients_.data()),
                           reinterpret_cast<std::array<Double8, 3>*>(factors_.data()));
        else
            program_->start(zero_.numbers().data(), coefficients_.data(), factors_.data());
    }
    // Order 0 of an output. Requires begin().
    const Number& start(std::size_t index) { return zero_.numbers()[program_->outputs_[index]]; }

    // Evaluates order k, 1 <= k <= highest_order, given order k of the moving inputs. Requires all lower orders.
    void extend(int k, const Number* inputs) {
        std::copy_n(inputs, inputs_, tables_.now + 1);
        if constexpr (is_one) {
            if (k == 1 && code_) return code_->make_first(tables_);
            if (code_ && program_->plan_.coordinates() == 0) return code_->make_given(tables_, k);
        }
        make_order(program_->plan_, sums_, tables_, static_cast<std::size_t>(k));
    }
    // Order k of an output, valid from extend(k) until the next call of extend().
    const Number& output(std::size_t index) const { return tables_.now[program_->plan_.outputs[index]]; }

    // For a motion, see make_orders(). Requires order 1.
    int extend(MotionOrders& motion, int k, int last) requires is_one {
        if (code_) return code_->make_orders(tables_, motion, k, last);
        return make_orders(program_->plan_, tables_, motion, k, last);
    }
    // Orders k .. last of a motion, in rows of q, v and the event functions; `row` is that of order k. Requires all
    // lower orders; for k = 1, q and v in the row. Over lanes, the first call makes order 4 or more.
    void extend(Number* row, int k, int last) {
        const SeriesPlan& plan = program_->plan_;
        const std::size_t n = plan.coordinates();
        if constexpr (is_one) {
            if (k == 1) {
                extend(1, row);
                for (std::size_t i = 0; i < plan.events; ++i) row[2 * n + i] = output(n + i);
                row += plan.states();
                ++k;
            }
            // With this power no nonzero coefficient counts as small. A coefficient 0 ends a call, and the loop
            // continues after it.
            constexpr double never_small = 1e300;
            MotionOrders motion;
            motion.row = row - plan.states();
            while (k <= last) {
                motion.largest = motion.row + n;
                motion.power = never_small;
                k = extend(motion, k, last) + 1;
            }
        } else {
            if constexpr (is_lanes<Number>)
                if (code_) {
                    if (k == 1) std::copy_n(row, inputs_, tables_.now + 1);
                    const auto doubles = [](auto* numbers) { return reinterpret_cast<double*>(numbers); };
                    return code_->make_orders(doubles(factors_.data()), doubles(tables_.now), doubles(row), k, last);
                }
            for (; k <= last; ++k, row += plan.states())
                make_motion_order(plan, sums_, tables_, row, static_cast<std::size_t>(k));
        }
    }

 private:
    static std::shared_ptr<const Code> code_of(const SeriesProgram& program) {
        if constexpr (is_one)
            return program.code_;
        else
            return nullptr;
    }
    SeriesEvaluator(const SeriesProgram* program, InnerSums<Number> sums, std::shared_ptr<const Code> code,
                    std::shared_ptr<const MachineCode> code_of_start = {})
        : program_(program),
          inputs_(program->program_.slots_.parameters_begin),
          zero_(program->program_, std::move(code_of_start), program->registers_),
          coefficients_(program->coefficients_.size()),
          factors_(program->plan_.rules.size()),
          sums_(std::move(sums)),
          code_(std::move(code)) {
        const std::size_t numbers = program->plan_.numbers();
        std::size_t size = numbers + sums_.row() * (highest_order + 1);
        if constexpr (is_lanes<Number>)
            if (code_) size = code_->numbers();
        const std::size_t bytes = size * sizeof(Number);
        auto* const now = static_cast<Number*>(borrow_table(bytes));
        table_ = {now, {bytes}};
        static_assert(std::is_trivially_destructible_v<Number>);
        std::uninitialized_default_construct_n(now, size);
        tables_ = {factors_.data(), now, now + numbers};
        std::fill_n(now, numbers, Number(0.0));
    }

    const SeriesProgram* program_;
    std::size_t inputs_;                          // number of moving inputs
    ProgramOver<Number> zero_;                    // order 0, with room for hidden registers
    std::vector<Number> coefficients_;            // of the program, by index
    std::vector<std::array<Number, 3>> factors_;  // by rule
    InnerSums<Number> sums_;
    struct ReturnTable {
        std::size_t bytes = 0;
        void operator()(Number* table) const { return_table(table, bytes); }
    };
    std::unique_ptr<Number, ReturnTable> table_;
    SeriesTablesOver<Number> tables_;
    std::shared_ptr<const Code> code_;
};

extern template class SeriesEvaluator<double>;

}  // namespace achilles
