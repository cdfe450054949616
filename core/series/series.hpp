// A program over truncated power series in time: the Taylor coefficients of its outputs, one order after the other.
//
// The series x(t) = sum x_k t^k of every register obey recurrences in which order k needs the orders below k and the
// order k of the operands (Moore; Jorba & Zou 2005). A product, say:
//     c_k = a_0 b_k + a_k b_0 + sum_{0<j<k} a_j b_{k-j}
// The inner sums need lower orders alone. So all of them are formed first, one lane of a vector each (convolution.hpp),
// and then the rules run through, in scalars. Functions follow from their differential equations: with s = sin a and
// c = cos a, k s_k = sum j a_j c_{k-j}; a power with a moving exponent is exp(b log a); whole powers are products,
// because their base may be zero.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "expression/program.hpp"

namespace achilles {

// Compiled once, shared between threads. Inputs outside the program's fixed slots move with time.
class SeriesProgram {
 public:
    SeriesProgram() = default;
    explicit SeriesProgram(const Program& program);

    const Program& program() const { return program_; }
    std::size_t inner_sums() const { return sums_.size(); }
    std::size_t rules() const { return rules_.size(); }

 private:
    friend class SeriesEvaluator;
    friend class SeriesCompiler;

    enum class Kind : std::uint8_t {
        add,
        subtract,
        negate,
        scale,              // a does not move
        multiply,           // a b
        square,             // a^2
        unit_and_square,    // 1 + sign a^2
        divide,             // a / b
        sqrt,               // sqrt(a)
        exp,                // exp(a)
        sin_cos,            // result and partner: sin, cos (sign -1) or sinh, cosh (sign +1)
        tangent,            // result and partner: tan a, 1 + tan^2 a (sign +1), or tanh a, 1 - tanh^2 a (sign -1)
        integral_of_ratio,  // result' = sign a'/b: the function itself says which one it is
        power               // a^b, b does not move
    };
    struct Rule {
        Kind kind;
        Operation function = Operation::number;  // integral_of_ratio: log, asin, acos, atan
        double sign = 1.0;
        std::uint32_t result = 0, partner = 0, a = 0, b = 0;  // registers
        std::uint32_t sum = 0, other_sum = 0;                 // inner sums
    };
    // sum_{0<j<k} x_j y_{k-j}, or of j x_j y_{k-j}
    struct InnerSum {
        std::uint32_t x, y;
    };

    Program program_;
    std::vector<Rule> rules_;
    std::vector<InnerSum> sums_;  // those of j x_j first
    std::size_t weighted_ = 0;    // how many these are
    std::size_t registers_ = 0;
    static constexpr std::uint32_t none = ~0u;
    std::uint32_t one_ = none;  // a register that holds 1, where one is needed
    std::vector<std::uint32_t> outputs_;
};

// A series program with its coefficients. One per thread.
class SeriesEvaluator {
 public:
    static constexpr int highest_order = 34;

    SeriesEvaluator() = default;
    SeriesEvaluator(const SeriesProgram& program, std::span<const double> parameters);

    // Order 0 of a moving input before begin(), and its order k before extend(k).
    double& input(std::size_t slot) { return now_[slot]; }
    // Evaluates order 0.
    void begin();
    // Evaluates order k, after all lower ones; 1 <= k <= highest_order.
    void extend(int k);
    // Order 0 of an output, after begin().
    double start(std::size_t index) const { return zero_[program_->outputs_[index]]; }
    // Order k of an output, after extend(k).
    double output(std::size_t index) const { return now_[program_->outputs_[index]]; }

 private:
    void keep(int k);

    const SeriesProgram* program_ = nullptr;
    std::size_t lanes_ = 0;            // inner sums, rounded up to whole vectors
    std::vector<double> zero_, now_;   // per register: orders 0 and k
    std::vector<double> factor_;       // per rule: the reciprocal it multiplies with
    std::vector<double> rows_, sums_;  // per order: the left factors of all inner sums, then the right ones
};

}  // namespace achilles
