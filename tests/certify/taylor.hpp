// Taylor coefficients of a program's outputs along a motion, order by order, in multiprecision: the integrator of the
// truth that certificates are compared with. It shares no code with the integrators it judges.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <span>
#include <vector>

#include "model/derive.hpp"
#include "program/program.hpp"

namespace achilles::test {

using Real = boost::multiprecision::cpp_bin_float_quad;  // 34 digits
using Reals = std::vector<Real>;

struct Series {};  // only names the specialisation below
constexpr std::size_t max_order = 30;

}  // namespace achilles::test

namespace achilles {

// Runs a program on power series in time. Coefficient k of the outputs needs coefficients 0 .. k of the inputs only, so
// that a differential equation fills its own series: set(.., k), run(k), read output(.., k), which gives order k + 1.
template <>
class Evaluator<test::Series> {
 public:
    Evaluator(const Program& program, const Layout& layout, std::span<const double> parameters);
    void set(std::size_t slot, std::size_t order, const test::Real& value) { at(slot, order) = value; }
    void run(std::size_t order);
    const test::Real& output(std::size_t index, std::size_t order) const {
        return series_[outputs_[index] * (test::max_order + 1) + order];
    }

 private:
    enum class Kind { add, subtract, multiply, divide, negate, sqrt, sin_cos, exp, log };
    struct Step {
        Kind kind;
        std::size_t a, b, result;  // sin_cos: sin into result, cos into b
    };
    test::Real& at(std::size_t series, std::size_t order) { return series_[series * (test::max_order + 1) + order]; }
    std::size_t fresh();
    std::size_t constant(const test::Real& value);
    void lower(const Instruction& instruction, std::size_t result);
    void lower_power(const Instruction& instruction, std::size_t result);
    bool is_constant(const Step& step) const;
    test::Real start(const Step& step);
    test::Real next(const Step& step, std::size_t k);
    test::Real product(std::size_t a, std::size_t b, std::size_t k);

    std::vector<Step> steps_;
    std::vector<bool> constant_;  // by series: all coefficients but the first are zero
    std::vector<std::size_t> outputs_;
    test::Reals series_;
};

}  // namespace achilles
