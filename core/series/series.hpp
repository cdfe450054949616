// Taylor coefficients in time of a program's outputs: the program is evaluated over truncated power series, order by
// order.
//
// The series x(t) = sum x_k t^k of the registers obey recurrences: order k follows from lower orders and from order k
// of the operands (Moore; Jorba & Zou 2005). For a product:
//     c_k = a_0 b_k + b_0 a_k + sum_{0<j<k} a_j b_{k-j}
// Functions follow from their differential equations: with s = sin a and c = cos a, k s_k = sum j a_j c_{k-j}. A power
// with a moving exponent is exp(b log a). Integer powers are products, because their base may be zero.
//
// Every recurrence is a sum of at most three terms whose factors depend on order 0 only, so one loop without branches
// evaluates them all. The inner sums need lower orders only: all of them are formed together, one per lane of a vector
// (order.hpp). Sums, differences and multiples by constants need no recurrence: they are kept as linear forms of other
// series, with coefficients evaluated once per run, and evaluated only where a product needs them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "program/program.hpp"
#include "series/order.hpp"

namespace achilles {

// Compiled once, shared between threads. All inputs except the parameters move with time.
class SeriesProgram {
 public:
    SeriesProgram() = default;
    // The first outputs are wanted as series: the accelerations of `dof` coordinates, then `events` event functions.
    // The other outputs are wanted at order 0 only.
    SeriesProgram(const Program& program, std::size_t dof, std::size_t events);

    std::size_t events() const { return plan_.events; }
    std::size_t inner_sums() const { return inner_sums_; }
    std::size_t rules() const { return plan_.rules.size(); }
    // True if it contains a function with a limited domain: a square root, a logarithm.
    bool is_partial() const { return partial_; }
    // By slot: true for inputs that the series depend on.
    std::vector<bool> inputs() const { return program_.inputs_of(plan_.coordinates() + plan_.events); }

 private:
    template <class Number>
    friend class SeriesEvaluator;
    friend class SeriesCompiler;
    friend class LaneAccess;
    friend struct LaneCode;

    // A number that depends on parameters only: a register of the program, or an operation on two other coefficients.
    struct Coefficient {
        Operation operation = Operation::number;  // number: register a
        std::uint32_t a = 0, b = 0;
    };
    // How the factors of a rule follow from order 0. A function with a partner has two rules.
    enum class Kind : std::uint8_t {
        multiply,         // a b
        square,           // a^2
        unit_and_square,  // 1 + sign a^2
        divide,           // a/b; sign -1: 1/b
        sqrt,
        exp,
        sin_cos,            // with partner; sign +1: hyperbolic
        tangent,            // tan a with partner 1 + tan^2 a; sign -1: tanh a, 1 - tanh^2 a
        integral_of_ratio,  // r' = sign a'/b: log, asin, acos, atan
        power               // a^b, b constant in time
    };
    // A register as a factor: its value at order 0, and coefficient `scale` times series `series` at higher orders.
    struct Operand {
        std::uint32_t value = 0, series = 0, scale = 0;
    };
    struct Seed {
        Kind kind;
        Operation function = Operation::number;  // for integral_of_ratio
        double sign = 1.0;
        Operand a{}, b{}, result{}, partner{};
        std::uint32_t rule = 0;
    };
    // A rule whose factors are coefficients, constant during a run.
    struct Combination {
        std::uint32_t rule;
        std::array<std::uint32_t, 3> coefficient;
    };

    // See series/recurrence.hpp.
    template <class Scalar>
    void fix(const Scalar* registers, Scalar* coefficients, std::array<Scalar, 3>* factors) const;
    template <class Scalar>
    void start(Scalar* registers, const Scalar* coefficients, std::array<Scalar, 3>* factors) const;

    // The series and the factors that depend on these inputs.
    VariedNumbers dependent_on(const std::vector<bool>& inputs) const;

    Program program_;
    bool partial_ = false;
    std::vector<Coefficient> coefficients_;  // the first is 1
    SeriesPlan plan_;                        // series 0 is zero, then the moving inputs, then results
    std::vector<Seed> seeds_;
    std::vector<Combination> combinations_;
    std::size_t inner_sums_ = 0;
    std::size_t registers_ = 0;              // number at order 0: the program's, then hidden ones
    std::size_t hidden_ = 0;                 // index of the first hidden register
    std::vector<std::uint32_t> outputs_;     // registers at order 0
    std::shared_ptr<const OrderCode> code_;  // may be null
};

// What the evaluation of a series program over eight lanes needs. It is compiled once. Machine code is null if there is
// none.
struct LaneCode {
    LanePlan plan;
    std::shared_ptr<const MachineCode> start;  // order 0
    std::shared_ptr<const LaneOrderCode> orders;
    // Compiles machine code for vectors of four or eight doubles, or none. `varied` tells whether each input differs
    // between the lanes; if it is empty, all inputs do.
    static LaneCode of(const SeriesProgram& program, std::optional<Width> vectors,
                       const std::vector<bool>& varied = {});
};

// Access to the internals of programs and series programs, for evaluators over any number type.
class LaneAccess {
 public:
    // Machine code over lanes for the moving part of a program, with vectors of four or eight, or none; may be null.
    static std::shared_ptr<const MachineCode> machine_code_of(const Program& program, std::optional<Width> vectors);
    template <class Scalar>
    static void start(const SeriesProgram& series, Scalar* registers, const Scalar* coefficients,
                      std::array<Scalar, 3>* factors) {
        series.start(registers, coefficients, factors);
    }
    static const SeriesPlan& plan_of(const SeriesProgram& series) { return series.plan_; }
    static std::size_t moving_inputs(const Program& program) { return program.slots_.parameters_begin; }
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
