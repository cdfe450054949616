#include "series/series.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "series/start.hpp"

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

}  // namespace

SeriesEvaluator::SeriesEvaluator(const SeriesProgram& program, std::span<const double> parameters)
    : program_(&program),
      inputs_(program.program_.slots_.parameters_begin),
      zero_(program.program_),
      factors_(program.plan_.rules.size()),
      tables_block_(std::make_unique_for_overwrite<double[]>(room(program.plan_))) {
    double* const now = aligned(tables_block_.get());
    tables_ = {factors_.data(), now, now + program.plan_.numbers()};
    std::fill_n(now, program.plan_.numbers(), 0.0);
    for (std::size_t i = 0; i < parameters.size(); ++i) zero_.input(inputs_ + i) = parameters[i];
    zero_.fix();
    zero_.registers_.resize(program.registers_, 0.0);
    coefficients_.resize(program.coefficients_.size());
    program.fix(zero_.registers_.data(), coefficients_.data(), factors_.data());
}

void SeriesEvaluator::begin(const double* inputs) {
    std::copy_n(inputs, inputs_, zero_.registers_.data());
    zero_.run();
    std::fill_n(tables_.now + program_->plan_.series, program_->plan_.lanes, 0.0);  // sums of order 1
    program_->start(zero_.registers_.data(), coefficients_.data(), factors_.data());
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
