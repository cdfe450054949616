// A program over truncated power series in time: the Taylor coefficients of its outputs, one order after the other.
//
// The series x(t) = sum x_k t^k of every register obey recurrences in which order k needs the orders below k and the
// order k of the operands (Moore; Jorba & Zou 2005). A product, say:
//     c_k = a_0 b_k + b_0 a_k + sum_{0<j<k} a_j b_{k-j}
// Functions follow from their differential equations: with s = sin a and c = cos a, k s_k = sum j a_j c_{k-j}; a power
// with a moving exponent is exp(b log a); whole powers are products, because their base may be zero.
//
// Every recurrence is a sum of three terms with factors that depend on order 0 alone, so one loop without a branch runs
// them all. The inner sums need lower orders alone: all of them are formed at once, one lane of a vector each
// (order.hpp). Sums, differences and multiples by what does not move need no recurrence: they are carried along
// as linear forms of the others, with coefficients evaluated once a run, and written out where a product needs them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "program/program.hpp"
#include "series/order.hpp"

namespace achilles {

// Compiled once, shared between threads. Inputs outside the program's fixed slots move with time.
class SeriesProgram {
 public:
    SeriesProgram() = default;
    // Of the outputs, the first are wanted as series: the accelerations of so many coordinates, then so many event
    // functions; the others at order 0.
    SeriesProgram(const Program& program, std::size_t dof, std::size_t events);

    std::size_t events() const { return plan_.events; }
    std::size_t inner_sums() const { return inner_sums_; }
    std::size_t rules() const { return plan_.rules.size(); }
    // Whether a function in it has an edge, past which it is no number: a root, a logarithm.
    bool is_partial() const { return partial_; }
    // By slot: the inputs that the series depend on.
    std::vector<bool> inputs() const { return program_.inputs_of(plan_.coordinates() + plan_.events); }

 private:
    template <class Number>
    friend class SeriesEvaluator;
    friend class SeriesCompiler;
    friend class LaneAccess;

    // A number that depends on the parameters alone: one of the program's registers, or made of two others.
    struct Coefficient {
        Operation operation = Operation::number;  // number: register a
        std::uint32_t a = 0, b = 0;
    };
    // How the factors of a rule (of two, where a function has a partner) follow from order 0.
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
        power               // a^b, b does not move
    };
    // A register as a factor: its order 0, and scale * series beyond, `scale` being a coefficient.
    struct Operand {
        std::uint32_t value = 0, series = 0, scale = 0;
    };
    struct Seed {
        Kind kind;
        Operation function = Operation::number;  // of integral_of_ratio
        double sign = 1.0;
        Operand a{}, b{}, result{}, partner{};
        std::uint32_t rule = 0;
    };
    // A rule whose factors are coefficients.
    struct Combination {
        std::uint32_t rule;
        std::array<std::uint32_t, 3> coefficient;
    };

    // See series/recurrence.hpp.
    template <class Scalar>
    void fix(const Scalar* registers, Scalar* coefficients, std::array<Scalar, 3>* factors) const;
    template <class Scalar>
    void start(Scalar* registers, const Scalar* coefficients, std::array<Scalar, 3>* factors) const;

    Program program_;
    bool partial_ = false;
    std::vector<Coefficient> coefficients_;  // the first is 1
    SeriesPlan plan_;                        // series 0 is zero, then the inputs that move, then results
    std::vector<Seed> seeds_;
    std::vector<Combination> combinations_;
    std::size_t inner_sums_ = 0;
    std::size_t registers_ = 0;              // of order 0: the program's, then hidden ones
    std::size_t hidden_ = 0;                 // the first of these
    std::vector<std::uint32_t> outputs_;     // registers of order 0
    std::shared_ptr<const OrderCode> code_;  // may be none
};

// What an evaluator over any number takes from programs and series programs: their insides.
class LaneAccess {
 public:
    // Machine code over lanes for what moves, by vectors of four or eight; may be none.
    static std::shared_ptr<const MachineCode> machine_code_of(const Program& program, Width vectors);
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
