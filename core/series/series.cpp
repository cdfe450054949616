#include "series/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "series/convolution.hpp"

namespace achilles {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

constexpr auto reciprocals = [] {
    std::array<double, SeriesEvaluator::highest_order + 1> table{};
    for (std::size_t k = 1; k < table.size(); ++k) table[k] = 1.0 / static_cast<double>(k);
    return table;
}();

}  // namespace

// ---- compilation ----

// Registers 0 .. are those of the program, so that what does not move can be copied; more follow for partners.
class SeriesCompiler {
 public:
    using Kind = SeriesProgram::Kind;
    using Rule = SeriesProgram::Rule;

    explicit SeriesCompiler(SeriesProgram& series) : series_(series), program_(series.program_) {}

    void compile() {
        const std::uint32_t first = program_.slots_.count + static_cast<std::uint32_t>(program_.constants_.size());
        const std::size_t count = first + program_.instructions_.size();
        place_.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) place_[i] = i;
        next_ = static_cast<std::uint32_t>(count);
        for (std::size_t i = program_.fixed_; i < program_.instructions_.size(); ++i)
            translate(program_.instructions_[i], first + static_cast<std::uint32_t>(i));
        for (const std::uint32_t output : program_.outputs_) series_.outputs_.push_back(place_[output]);
        series_.registers_ = next_;
        order_sums();
    }

 private:
    bool moves(std::uint32_t reg) const {
        if (reg < program_.slots_.count) return reg < program_.slots_.fixed_begin || reg >= program_.slots_.fixed_end;
        const std::uint32_t first_moving = program_.slots_.count +
                                           static_cast<std::uint32_t>(program_.constants_.size()) +
                                           static_cast<std::uint32_t>(program_.fixed_);
        return reg >= first_moving;
    }

    // The same rule with the same operands is made once: sine and cosine of one angle, squares, chains of powers.
    std::uint32_t make(Rule rule, std::uint32_t result) {
        const auto key = std::tuple(rule.kind, rule.function, rule.sign, rule.a, rule.b);
        if (const auto found = made_.find(key); found != made_.end()) return series_.rules_[found->second].result;
        made_.emplace(key, series_.rules_.size());
        rule.result = result;
        const auto sum = [&](std::uint32_t x, std::uint32_t y, bool weighted) {
            sums_.push_back({{x, y}, weighted});
            return static_cast<std::uint32_t>(sums_.size() - 1);
        };
        switch (rule.kind) {
            case Kind::multiply:
                rule.sum = sum(rule.a, rule.b, false);
                break;
            case Kind::square:
            case Kind::unit_and_square:
                rule.sum = sum(rule.a, rule.a, false);
                break;
            case Kind::divide:
                rule.sum = sum(result, rule.b, false);
                break;
            case Kind::sqrt:
                rule.sum = sum(result, result, false);
                break;
            case Kind::exp:
                rule.sum = sum(rule.a, result, true);
                break;
            case Kind::sin_cos:
                rule.partner = next_++;
                rule.sum = sum(rule.a, rule.partner, true);
                rule.other_sum = sum(rule.a, result, true);
                break;
            case Kind::tangent:
                rule.partner = next_++;
                rule.sum = sum(rule.a, rule.partner, true);
                rule.other_sum = sum(result, result, false);
                break;
            case Kind::integral_of_ratio:
                rule.sum = sum(result, rule.b, true);
                break;
            case Kind::power:
                rule.sum = sum(rule.a, result, true);
                rule.other_sum = sum(result, rule.a, true);
                break;
            default:
                break;
        }
        series_.rules_.push_back(rule);
        return result;
    }
    std::uint32_t make(Rule rule) { return make(rule, next_++); }

    std::uint32_t product(std::uint32_t a, std::uint32_t b) {
        return a == b ? make({.kind = Kind::square, .a = a}) : make({.kind = Kind::multiply, .a = a, .b = b});
    }

    // base^n, n >= 2, by repeated squaring; the last factor takes the register of the result.
    std::uint32_t whole_power(std::uint32_t base, unsigned n) {
        std::uint32_t result = 0;
        bool any = false;
        for (; n != 0; n >>= 1) {
            if (n & 1u) {
                result = any ? product(result, base) : base;
                any = true;
            }
            if (n > 1) base = product(base, base);
        }
        return result;
    }

    void translate(const Instruction& in, std::uint32_t result) {
        const std::uint32_t a = place_[in.a], b = place_[in.b];
        const auto function = [&](Kind kind, double sign) { return Rule{.kind = kind, .sign = sign, .a = a}; };
        const auto ratio = [&](double sign, std::uint32_t denominator) {
            return Rule{
                .kind = Kind::integral_of_ratio, .function = in.operation, .sign = sign, .a = a, .b = denominator};
        };
        std::uint32_t& place = place_[result];
        switch (in.operation) {
            case Operation::add:
                place = make({.kind = Kind::add, .a = a, .b = b}, result);
                break;
            case Operation::subtract:
                place = make({.kind = Kind::subtract, .a = a, .b = b}, result);
                break;
            case Operation::multiply:
                if (!moves(a)) {
                    place = make({.kind = Kind::scale, .a = a, .b = b}, result);
                } else if (!moves(b)) {
                    place = make({.kind = Kind::scale, .a = b, .b = a}, result);
                } else {
                    place = a == b ? make({.kind = Kind::square, .a = a}, result)
                                   : make({.kind = Kind::multiply, .a = a, .b = b}, result);
                }
                break;
            case Operation::divide:
                place = make({.kind = Kind::divide, .a = a, .b = b}, result);
                break;
            case Operation::negate:
                place = make({.kind = Kind::negate, .a = a}, result);
                break;
            case Operation::power: {
                const auto n = static_cast<unsigned>(std::abs(in.exponent));
                place = whole_power(a, n);
                if (in.exponent < 0) place = make({.kind = Kind::divide, .a = one(), .b = place}, result);
                break;
            }
            case Operation::real_power:
                if (!moves(b)) {
                    place = make({.kind = Kind::power, .a = a, .b = b}, result);
                } else {
                    Rule log = ratio(1.0, a);
                    log.function = Operation::log;
                    place = make({.kind = Kind::exp, .a = product(b, make(log))}, result);
                }
                break;
            case Operation::sqrt:
                place = make({.kind = Kind::sqrt, .a = a}, result);
                break;
            case Operation::sin:
                place = make(function(Kind::sin_cos, -1.0), result);
                break;
            case Operation::cos:
                place = partner_of(make(function(Kind::sin_cos, -1.0)));
                break;
            case Operation::sinh:
                place = make(function(Kind::sin_cos, 1.0), result);
                break;
            case Operation::cosh:
                place = partner_of(make(function(Kind::sin_cos, 1.0)));
                break;
            case Operation::tan:
                place = make(function(Kind::tangent, 1.0), result);
                break;
            case Operation::tanh:
                place = make(function(Kind::tangent, -1.0), result);
                break;
            case Operation::asin:
            case Operation::acos: {
                const std::uint32_t root = make({.kind = Kind::sqrt, .a = make(function(Kind::unit_and_square, -1.0))});
                place = make(ratio(in.operation == Operation::asin ? 1.0 : -1.0, root), result);
                break;
            }
            case Operation::atan:
                place = make(ratio(1.0, make(function(Kind::unit_and_square, 1.0))), result);
                break;
            case Operation::exp:
                place = make({.kind = Kind::exp, .a = a}, result);
                break;
            case Operation::log:
                place = make(ratio(1.0, a), result);
                break;
            case Operation::number:
            case Operation::symbol:
            case Operation::pi:
                break;  // do not move
        }
    }

    std::uint32_t partner_of(std::uint32_t result) const {
        for (const Rule& rule : series_.rules_)
            if (rule.result == result) return rule.partner;
        return result;
    }

    // A register that holds 1: its order 0 is set by the evaluator.
    std::uint32_t one() {
        if (series_.one_ == SeriesProgram::none) series_.one_ = next_++;
        return series_.one_;
    }

    // Sums with weights first: their left factors are stored times the order.
    void order_sums() {
        std::vector<std::uint32_t> position(sums_.size());
        for (const bool weighted : {true, false}) {
            for (std::size_t i = 0; i < sums_.size(); ++i) {
                if (sums_[i].weighted != weighted) continue;
                position[i] = static_cast<std::uint32_t>(series_.sums_.size());
                series_.sums_.push_back(sums_[i].sum);
            }
            if (weighted) series_.weighted_ = series_.sums_.size();
        }
        if (sums_.empty()) return;
        for (Rule& rule : series_.rules_) {
            rule.sum = position[rule.sum];
            rule.other_sum = position[rule.other_sum];
        }
    }

    struct Pending {
        SeriesProgram::InnerSum sum;
        bool weighted;
    };
    SeriesProgram& series_;
    const Program& program_;
    std::vector<std::uint32_t> place_;  // of the program's registers
    std::uint32_t next_ = 0;
    std::map<std::tuple<Kind, Operation, double, std::uint32_t, std::uint32_t>, std::size_t> made_;
    std::vector<Pending> sums_;
};

SeriesProgram::SeriesProgram(const Program& program) : program_(program) { SeriesCompiler(*this).compile(); }

// ---- evaluation ----

SeriesEvaluator::SeriesEvaluator(const SeriesProgram& program, std::span<const double> parameters)
    : program_(&program),
      lanes_((program.sums_.size() + 7) / 8 * 8),
      zero_(program.registers_, 0.0),
      now_(program.registers_, 0.0),
      factor_(program.rules_.size(), 0.0),
      rows_(2 * lanes_ * (highest_order + 1), 0.0),
      sums_(std::max<std::size_t>(lanes_, 8), 0.0) {
    Evaluator<double> fixed(program.program_);
    for (std::size_t i = 0; i < parameters.size(); ++i)
        fixed.input(program.program_.slots_.fixed_begin + i) = parameters[i];
    fixed.fix();
    std::copy(fixed.registers_.begin(), fixed.registers_.end(), zero_.begin());
    if (program.one_ != SeriesProgram::none) zero_[program.one_] = 1.0;
}

namespace {

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
            return nan;
    }
}

}  // namespace

void SeriesEvaluator::begin() {
    using Kind = SeriesProgram::Kind;
    const Program& program = program_->program_;
    double* const z = zero_.data();
    for (std::uint32_t i = 0; i < program.slots_.fixed_begin; ++i) z[i] = now_[i];
    double* factor = factor_.data();
    for (const SeriesProgram::Rule& rule : program_->rules_) {
        const double a = z[rule.a], b = z[rule.b];
        double& result = z[rule.result];
        switch (rule.kind) {
            case Kind::add:
                result = a + b;
                break;
            case Kind::subtract:
                result = a - b;
                break;
            case Kind::negate:
                result = -a;
                break;
            case Kind::scale:
            case Kind::multiply:
                result = a * b;
                break;
            case Kind::square:
                result = a * a;
                break;
            case Kind::unit_and_square:
                result = 1.0 + rule.sign * (a * a);
                break;
            case Kind::divide:
                result = a / b;
                *factor = 1.0 / b;
                break;
            case Kind::sqrt:
                result = std::sqrt(a);
                *factor = 0.5 / result;
                break;
            case Kind::exp:
                result = std::exp(a);
                break;
            case Kind::sin_cos:
                if (rule.sign < 0.0) {
                    result = std::sin(a);
                    z[rule.partner] = std::cos(a);
                } else {
                    result = std::sinh(a);
                    z[rule.partner] = std::cosh(a);
                }
                break;
            case Kind::tangent:
                result = rule.sign > 0.0 ? std::tan(a) : std::tanh(a);
                z[rule.partner] = 1.0 + rule.sign * (result * result);
                break;
            case Kind::integral_of_ratio:
                result = function_value(rule.function, a);
                *factor = 1.0 / b;
                break;
            case Kind::power:
                result = std::pow(a, b);
                *factor = 1.0 / a;
                break;
        }
        ++factor;
    }
}

// Order k - 1 becomes a row. Row 0 is never read: the inner sums leave out orders 0 and k.
void SeriesEvaluator::keep(int k) {
    double* const x = rows_.data() + 2 * lanes_ * static_cast<std::size_t>(k);
    double* const y = x + lanes_;
    const double* const n = now_.data();
    const double weight = k;
    const SeriesProgram::InnerSum* const sums = program_->sums_.data();
    const std::size_t weighted = program_->weighted_, count = program_->sums_.size();
    for (std::size_t i = 0; i < weighted; ++i) {
        x[i] = weight * n[sums[i].x];
        y[i] = n[sums[i].y];
    }
    for (std::size_t i = weighted; i < count; ++i) {
        x[i] = n[sums[i].x];
        y[i] = n[sums[i].y];
    }
}

void SeriesEvaluator::extend(int k) {
    using Kind = SeriesProgram::Kind;
    static const InnerSums inner = inner_sums();
    inner(rows_.data(), lanes_, k, sums_.data());
    const double* const z = zero_.data();
    const double* const s = sums_.data();
    double* const n = now_.data();
    const double* factor = factor_.data();
    const double inverse = reciprocals[static_cast<std::size_t>(k)];
    for (const SeriesProgram::Rule& rule : program_->rules_) {
        const double a = n[rule.a];
        switch (rule.kind) {
            case Kind::add:
                n[rule.result] = a + n[rule.b];
                break;
            case Kind::subtract:
                n[rule.result] = a - n[rule.b];
                break;
            case Kind::negate:
                n[rule.result] = -a;
                break;
            case Kind::scale:
                n[rule.result] = z[rule.a] * n[rule.b];
                break;
            case Kind::multiply:
                n[rule.result] = (z[rule.a] * n[rule.b] + a * z[rule.b]) + s[rule.sum];
                break;
            case Kind::square:
                n[rule.result] = 2.0 * (z[rule.a] * a) + s[rule.sum];
                break;
            case Kind::unit_and_square:
                n[rule.result] = rule.sign * (2.0 * (z[rule.a] * a) + s[rule.sum]);
                break;
            case Kind::divide:
                n[rule.result] = ((a - z[rule.result] * n[rule.b]) - s[rule.sum]) * *factor;
                break;
            case Kind::sqrt:
                n[rule.result] = (a - s[rule.sum]) * *factor;
                break;
            case Kind::exp:
                n[rule.result] = a * z[rule.result] + s[rule.sum] * inverse;
                break;
            case Kind::sin_cos: {
                n[rule.result] = a * z[rule.partner] + s[rule.sum] * inverse;
                n[rule.partner] = rule.sign * (a * z[rule.result] + s[rule.other_sum] * inverse);
                break;
            }
            case Kind::tangent: {
                const double tangent = a * z[rule.partner] + s[rule.sum] * inverse;
                n[rule.result] = tangent;
                n[rule.partner] = rule.sign * (2.0 * (z[rule.result] * tangent) + s[rule.other_sum]);
                break;
            }
            case Kind::integral_of_ratio:
                n[rule.result] = (rule.sign * a - s[rule.sum] * inverse) * *factor;
                break;
            case Kind::power: {
                // a p' = r a' p:  k a_0 p_k = r (k a_k p_0 + sum j a_j p_{k-j}) - sum j p_j a_{k-j}
                const double moved = z[rule.b] * (k * a * z[rule.result] + s[rule.sum]);
                n[rule.result] = (moved - s[rule.other_sum]) * inverse * *factor;
                break;
            }
        }
        ++factor;
    }
    keep(k);
}

}  // namespace achilles
