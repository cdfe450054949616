#include "series/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "expression/sine.hpp"

namespace achilles {

namespace {

// Doubles from the start of a cache line on, in a block with some room before.
double* aligned(double* block) {
    constexpr std::size_t line = SeriesPlan::aligned * sizeof(double);
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    return block + ((line - address % line) % line) / sizeof(double);
}
std::size_t room(const SeriesPlan& plan) {
    return plan.numbers() + plan.row() * (SeriesEvaluator::highest_order + 1) + SeriesPlan::aligned;
}

double function_value(Operation function, double a) {
    switch (function) {
        case Operation::log:
            return std::log(a);
        case Operation::asin:
            return std::asin(a);
        case Operation::acos:
            return std::acos(a);
        case Operation::atan:
            return std::atan(a);
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

double combined(Operation operation, double a, double b) {
    switch (operation) {
        case Operation::add:
            return a + b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::negate:
            return -a;
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

}  // namespace

SeriesEvaluator::SeriesEvaluator(const SeriesProgram& program, std::span<const double> parameters)
    : program_(&program),
      inputs_(program.program_.slots_.fixed_begin),
      zero_(program.program_),
      factors_(program.plan_.rules.size()),
      tables_block_(std::make_unique_for_overwrite<double[]>(room(program.plan_))) {
    double* const now = aligned(tables_block_.get());
    tables_ = {factors_.data(), now, now + program.plan_.numbers()};
    std::fill_n(now, program.plan_.numbers(), 0.0);
    for (std::size_t i = 0; i < parameters.size(); ++i) zero_.input(inputs_ + i) = parameters[i];
    zero_.fix();
    zero_.registers_.resize(program.registers_, 0.0);
    coefficients_.reserve(program.coefficients_.size());
    for (const SeriesProgram::Coefficient& c : program.coefficients_) {
        if (coefficients_.empty()) {
            coefficients_.push_back(1.0);
        } else if (c.operation == Operation::number) {
            coefficients_.push_back(zero_.registers_[c.a]);
        } else {
            coefficients_.push_back(combined(c.operation, coefficients_[c.a], coefficients_[c.b]));
        }
    }
    for (const SeriesProgram::Combination& c : program.combinations_)
        for (std::size_t i = 0; i < 3; ++i) factors_[c.rule][i] = coefficients_[c.coefficient[i]];
}

// The program itself gives order 0 of its registers; here follow the hidden ones, and the factors of the rules.
void SeriesEvaluator::begin(const double* inputs) {
    using Kind = SeriesProgram::Kind;
    std::copy_n(inputs, inputs_, zero_.registers_.data());
    zero_.run();
    std::fill_n(tables_.now + program_->plan_.series, program_->plan_.lanes, 0.0);  // sums of order 1
    double* const z = zero_.registers_.data();
    const std::size_t own = zero_.program_->slots_.count + zero_.program_->constants_.size() + zero_.program_->size();
    for (const SeriesProgram::Seed& seed : program_->seeds_) {
        const double a = z[seed.a], b = z[seed.b], sign = seed.sign;
        const double by_a = coefficients_[seed.scale_a], by_b = coefficients_[seed.scale_b];
        const auto set = [&](std::size_t rule, double x, double y, double w) {
            factors_[seed.rule + rule] = {x, y, w};
        };
        double& r = z[seed.result];
        const bool hidden = seed.result >= own;
        switch (seed.kind) {
            case Kind::multiply:
                if (hidden) r = a * b;
                set(0, a * by_b, b * by_a, by_a * by_b);
                break;
            case Kind::square:
                if (hidden) r = a * a;
                set(0, 2.0 * a * by_a, 0.0, by_a * by_a);
                break;
            case Kind::unit_and_square:
                if (hidden) r = 1.0 + sign * (a * a);
                set(0, sign * 2.0 * a * by_a, 0.0, sign * by_a * by_a);
                break;
            case Kind::divide: {
                if (hidden) r = sign < 0.0 ? 1.0 / b : a / b;
                const double inverse = 1.0 / b;
                set(0, by_a * inverse, -(r * by_b * inverse), -(by_b * inverse));
                break;
            }
            case Kind::sqrt: {
                if (hidden) r = std::sqrt(a);
                const double inverse = 0.5 / r;
                set(0, by_a * inverse, 0.0, -inverse);
                break;
            }
            case Kind::exp:
                if (hidden) r = std::exp(a);
                set(0, by_a * r, 0.0, by_a);
                break;
            case Kind::sin_cos: {
                double& c = z[seed.partner];
                if (sign < 0.0) {
                    const SineCosine wave = sine_and_cosine(a);
                    r = wave.sine;
                    c = wave.cosine;
                } else {
                    if (hidden) r = std::sinh(a);
                    if (seed.partner >= own) c = std::cosh(a);
                }
                set(0, by_a * c, 0.0, by_a);
                set(1, sign * by_a * r, 0.0, sign * by_a);
                break;
            }
            case Kind::tangent: {
                if (hidden) r = sign > 0.0 ? std::tan(a) : std::tanh(a);
                const double w = z[seed.partner] = 1.0 + sign * (r * r);
                set(0, by_a * w, 0.0, by_a);
                set(1, sign * 2.0 * r, 0.0, sign);
                break;
            }
            case Kind::integral_of_ratio: {
                if (hidden) r = function_value(seed.function, a);
                const double inverse = 1.0 / b;
                set(0, sign * by_a * inverse, 0.0, -(by_b * inverse));
                break;
            }
            case Kind::power: {
                // a p' = e a' p:  a_0 p_k = e (a_k p_0 + sum j a_j p_{k-j}/k) - sum j p_j a_{k-j}/k
                if (hidden) r = std::pow(a, b);
                const double inverse = by_a / a;
                set(0, b * r * inverse, b * inverse, -inverse);
                break;
            }
        }
    }
}

void SeriesEvaluator::extend(int k, const double* inputs) {
    std::copy_n(inputs, inputs_, tables_.now + 1);
    if (k == 1 && program_->code_) return program_->code_->make_first(tables_);
    make_order(program_->plan_, tables_, k);
}

int SeriesEvaluator::extend(SeriesMotion& motion, int k, int last) {
    if (program_->code_) return program_->code_->make_orders(tables_, motion, k, last);
    return make_orders(program_->plan_, tables_, motion, k, last);
}

}  // namespace achilles
