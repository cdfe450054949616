// Taylor coefficients of a program's outputs along a motion, order by order, in multiprecision. The reference motions
// are integrated with it. It shares no code with the integrators it tests.
#pragma once

#include <span>
#include <vector>

#include "certify/dual.hpp"
#include "model/derive.hpp"
#include "program/program.hpp"

namespace achilles::test {

// Reference motions use real numbers or, for derivatives, dual numbers.
template <class Number>
using List = std::vector<Number>;
using Reals = List<Real>;

template <class Number>
struct Series {};  // tag for the specialization below
constexpr std::size_t max_order = 30;

}  // namespace achilles::test

namespace achilles {

// Runs a program on power series in time. Coefficient k of the outputs needs only coefficients 0 .. k of the inputs. So
// the series of a differential equation is built order by order: set(.., k), run(k), and output(.., k) gives order k +
// 1.
template <class Number>
class Evaluator<test::Series<Number>> {
 public:
    Evaluator(const Program& program, const Layout& layout, std::span<const Number> parameters);
    void set(std::size_t slot, std::size_t order, const Number& value) { at(slot, order) = value; }
    void run(std::size_t order);
    const Number& output(std::size_t index, std::size_t order) const {
        return series_[outputs_[index] * (test::max_order + 1) + order];
    }

 private:
    enum class Kind { add, subtract, multiply, divide, negate, sqrt, sin_cos, exp, log, asin };
    struct Step {
        Kind kind;
        std::size_t a, b, result;  // sin_cos: sin into result, cos into b
    };
    Number& at(std::size_t series, std::size_t order) { return series_[series * (test::max_order + 1) + order]; }
    std::size_t fresh();
    std::size_t constant(const Number& value);
    void lower(const Instruction& instruction, std::size_t result);
    void lower_power(const Instruction& instruction, std::size_t result);
    bool is_constant(const Step& step) const;
    Number start(const Step& step);
    Number next(const Step& step, std::size_t k);
    Number product(std::size_t a, std::size_t b, std::size_t k);

    std::vector<Step> steps_;
    std::vector<bool> constant_;  // by series: all coefficients but the first are zero
    std::vector<std::size_t> outputs_;
    test::List<Number> series_;
};

}  // namespace achilles
