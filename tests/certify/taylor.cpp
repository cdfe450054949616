#include "certify/taylor.hpp"

#include <stdexcept>

namespace achilles {

using test::max_order, test::Series;

template <class Number>
Evaluator<Series<Number>>::Evaluator(const Program& program, const Layout& layout, std::span<const Number> parameters) {
    for (std::size_t i = 0; i < program.slots_.count; ++i) fresh();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        at(layout.parameter(i), 0) = parameters[i];
        constant_[layout.parameter(i)] = true;
    }
    for (const Constant& value : program.constants_) constant(scalar_from<Number>(value));
    const std::size_t first = constant_.size();
    for (std::size_t i = 0; i < program.instructions_.size(); ++i) fresh();
    for (std::size_t i = 0; i < program.instructions_.size(); ++i) lower(program.instructions_[i], first + i);
    outputs_.assign(program.outputs_.begin(), program.outputs_.end());
}

template <class Number>
std::size_t Evaluator<Series<Number>>::fresh() {
    constant_.push_back(false);
    series_.resize(series_.size() + max_order + 1);
    return constant_.size() - 1;
}

template <class Number>
std::size_t Evaluator<Series<Number>>::constant(const Number& value) {
    const std::size_t series = fresh();
    at(series, 0) = value;
    constant_[series] = true;
    return series;
}

template <class Number>
void Evaluator<Series<Number>>::lower(const Instruction& in, std::size_t result) {
    const auto add = [&](Kind kind) { steps_.push_back({kind, in.a, in.b, result}); };
    switch (in.operation) {
        case Operation::add:
            return add(Kind::add);
        case Operation::subtract:
            return add(Kind::subtract);
        case Operation::multiply:
            return add(Kind::multiply);
        case Operation::divide:
            return add(Kind::divide);
        case Operation::negate:
            return add(Kind::negate);
        case Operation::sqrt:
            return add(Kind::sqrt);
        case Operation::exp:
            return add(Kind::exp);
        case Operation::log:
            return add(Kind::log);
        case Operation::sin:
            steps_.push_back({Kind::sin_cos, in.a, fresh(), result});
            return;
        case Operation::cos: {
            const std::size_t sine = fresh();
            steps_.push_back({Kind::sin_cos, in.a, result, sine});
            return;
        }
        case Operation::asin: {  // asin(a)' sqrt(1 - a^2) = a'
            const std::size_t square = fresh(), rest = fresh(), root = fresh();
            steps_.push_back({Kind::multiply, in.a, in.a, square});
            steps_.push_back({Kind::subtract, constant(1), square, rest});
            steps_.push_back({Kind::sqrt, rest, 0, root});
            steps_.push_back({Kind::asin, in.a, root, result});
            return;
        }
        case Operation::power:
            return lower_power(in, result);
        case Operation::pi:
            at(result, 0) = scalar_pi<Number>();
            constant_[result] = true;
            return;
        default:
            throw std::invalid_argument("the Taylor integrator of the tests lacks a function of this system");
    }
}

// Powers by repeated products. The usual recurrence would divide by the base, which may vanish.
template <class Number>
void Evaluator<Series<Number>>::lower_power(const Instruction& in, std::size_t result) {
    const int n = std::abs(in.exponent);
    std::size_t so_far = in.a;
    for (int factor = 2; factor <= n; ++factor) {
        const std::size_t target = factor == n && in.exponent > 0 ? result : fresh();
        steps_.push_back({Kind::multiply, so_far, in.a, target});
        so_far = target;
    }
    if (in.exponent < 0) steps_.push_back({Kind::divide, constant(1), so_far, result});
}

template <class Number>
bool Evaluator<Series<Number>>::is_constant(const Step& step) const {
    const bool binary = step.kind == Kind::add || step.kind == Kind::subtract || step.kind == Kind::multiply ||
                        step.kind == Kind::divide;
    return constant_[step.a] && (!binary || constant_[step.b]);
}

template <class Number>
void Evaluator<Series<Number>>::run(std::size_t order) {
    for (const Step& step : steps_) {
        if (order == 0) {
            at(step.result, 0) = start(step);
            if (step.kind == Kind::sin_cos) at(step.b, 0) = cos(at(step.a, 0));
            constant_[step.result] = is_constant(step);
            if (step.kind == Kind::sin_cos) constant_[step.b] = constant_[step.result];
        } else if (!constant_[step.result]) {
            at(step.result, order) = next(step, order);
            if (step.kind != Kind::sin_cos) continue;
            Number sum = 0;
            for (std::size_t j = 1; j <= order; ++j) sum += j * at(step.a, j) * at(step.result, order - j);
            at(step.b, order) = -sum / order;
        }
    }
}

template <class Number>
Number Evaluator<Series<Number>>::start(const Step& step) {
    const Number &a = at(step.a, 0), &b = at(step.b, 0);
    switch (step.kind) {
        case Kind::add:
            return a + b;
        case Kind::subtract:
            return a - b;
        case Kind::multiply:
            return a * b;
        case Kind::divide:
            return a / b;
        case Kind::negate:
            return -a;
        case Kind::sqrt:
            return sqrt(a);
        case Kind::sin_cos:
            return sin(a);
        case Kind::exp:
            return exp(a);
        case Kind::log:
            return log(a);
        case Kind::asin:
            return asin(a);
    }
    return 0;
}

template <class Number>
Number Evaluator<Series<Number>>::product(std::size_t a, std::size_t b, std::size_t k) {
    if (constant_[a]) return at(a, 0) * at(b, k);
    if (constant_[b]) return at(a, k) * at(b, 0);
    Number sum = 0;
    for (std::size_t j = 0; j <= k; ++j) sum += at(a, j) * at(b, k - j);
    return sum;
}

// Coefficient k >= 1 from the earlier ones, by the usual recurrences of automatic differentiation.
template <class Number>
Number Evaluator<Series<Number>>::next(const Step& step, std::size_t k) {
    const std::size_t a = step.a, b = step.b, c = step.result;
    Number sum = 0;
    switch (step.kind) {
        case Kind::add:
            return at(a, k) + at(b, k);
        case Kind::subtract:
            return at(a, k) - at(b, k);
        case Kind::multiply:
            return product(a, b, k);
        case Kind::divide:
            if (!constant_[b])
                for (std::size_t j = 1; j <= k; ++j) sum += at(b, j) * at(c, k - j);
            return (at(a, k) - sum) / at(b, 0);
        case Kind::negate:
            return -at(a, k);
        case Kind::sqrt:
            for (std::size_t j = 1; j < k; ++j) sum += at(c, j) * at(c, k - j);
            return (at(a, k) - sum) / (2 * at(c, 0));
        case Kind::sin_cos:
            for (std::size_t j = 1; j <= k; ++j) sum += j * at(a, j) * at(b, k - j);
            return sum / k;
        case Kind::exp:
            for (std::size_t j = 1; j <= k; ++j) sum += j * at(a, j) * at(c, k - j);
            return sum / k;
        case Kind::log:
            for (std::size_t j = 1; j < k; ++j) sum += j * at(c, j) * at(a, k - j);
            return (at(a, k) - sum / k) / at(a, 0);
        case Kind::asin:
            for (std::size_t j = 1; j < k; ++j) sum += j * at(c, j) * at(b, k - j);
            return (at(a, k) - sum / k) / at(b, 0);
    }
    return 0;
}

template class Evaluator<Series<test::Real>>;
template class Evaluator<Series<test::Dual>>;

}  // namespace achilles
