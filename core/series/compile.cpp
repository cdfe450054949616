// Compiles a flat program into the recurrences of its series.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "expression/expression.hpp"
#include "program/machine.hpp"
#include "series/order.hpp"
#include "series/recurrence.hpp"
#include "series/series.hpp"

namespace achilles {

// The distinct inner sums of a plan, and their lanes.

// Sums over 0 < j < k of x_j y_{k-j}, or, if weighted, of j x_j y_{k-j}/k.
class InnerSumLanes {
 public:
    // The sum of these series, as an operand that place() replaces by its lane.
    std::uint32_t of(std::uint32_t x, std::uint32_t y, bool weighted) {
        const auto [found, fresh] = ids_.emplace(std::tuple(x, y, weighted), static_cast<std::uint32_t>(sums_.size()));
        if (fresh) sums_.push_back({x, y, weighted});
        return mark | found->second;
    }
    std::size_t count() const { return sums_.size(); }

    // Gives each sum a lane after the plan's series, and replaces the operands of the rules. Weighted sums come first,
    // because their left factors are stored multiplied by the order.
    void place(SeriesPlan& plan) const {
        std::vector<std::uint32_t> position(sums_.size());
        for (const bool weighted : {true, false}) {
            for (std::size_t i = 0; i < sums_.size(); ++i) {
                if (sums_[i].weighted != weighted) continue;
                position[i] = plan.series + static_cast<std::uint32_t>(plan.left.size());
                plan.left.push_back(sums_[i].x);
                plan.right.push_back(sums_[i].y);
            }
            if (weighted) plan.weighted = static_cast<std::uint32_t>(plan.left.size());
        }
        // At least one vector, because the code distinguishes the orders by the addresses of their rows.
        plan.lanes = static_cast<std::uint32_t>(std::max<std::size_t>(1, (sums_.size() + 3) / 4) * 4);
        plan.left.resize(plan.lanes, 0);
        plan.right.resize(plan.lanes, 0);
        for (SeriesRule& rule : plan.rules)
            for (std::uint32_t* operand : {&rule.x, &rule.y, &rule.w})
                if (*operand & mark) *operand = position[*operand & ~mark];
    }

 private:
    static constexpr std::uint32_t mark = 1u << 31;
    struct InnerSum {
        std::uint32_t x, y;
        bool weighted;
    };
    std::vector<InnerSum> sums_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, std::uint32_t> ids_;
};

class SeriesCompiler {
 public:
    explicit SeriesCompiler(SeriesProgram& series) : series_(series), program_(series.program_) {}

    // The first `wanted` outputs are compiled as series.
    void compile(std::size_t wanted) {
        const Slots& slots = program_.slots_;
        const auto first = slots.count + static_cast<std::uint32_t>(program_.constants_.size());
        const auto count = first + static_cast<std::uint32_t>(program_.instructions_.size());
        first_moving_ = first + static_cast<std::uint32_t>(program_.fixed_);
        series_.coefficients_.push_back({});  // the number 1
        series_.hidden_ = next_register_ = count;
        next_series_ = 1 + slots.parameters_begin;
        forms_.resize(count);
        for (std::uint32_t i = 0; i < slots.parameters_begin; ++i) forms_[i] = {{1 + i, one}};
        if (uses_clock()) start_clock();
        for (std::uint32_t reg = first_moving_; reg < count; ++reg) {
            const Instruction& in = program_.instructions_[reg - first];
            function_registers_.emplace(std::pair(in.operation, in.a), reg);
            series_.partial_ = series_.partial_ || has_edge(in.operation);
        }
        for (std::uint32_t reg = first_moving_; reg < count; ++reg)
            forms_[reg] = translate(program_.instructions_[reg - first], reg);
        for (const std::uint32_t output : program_.outputs_) {
            const bool as_series = series_.outputs_.size() < wanted;
            series_.outputs_.push_back(output);
            if (as_series) series_.plan_.outputs.push_back(written_apart(operand(output)));
        }
        if (series_.plan_.clock != 0) series_.plan_.rules.push_back({series_.plan_.clock});
        series_.registers_ = next_register_;
        series_.plan_.series = (next_series_ + SeriesPlan::aligned - 1) / SeriesPlan::aligned * SeriesPlan::aligned;
        sums_.place(series_.plan_);
        series_.inner_sums_ = sums_.count();
    }

 private:
    using Kind = SeriesProgram::Kind;
    using Seed = SeriesProgram::Seed;
    using Operand = SeriesProgram::Operand;

    // coefficient * series. A form is a sum of such terms, for the higher orders of a register.
    struct FormTerm {
        std::uint32_t series, coefficient;
    };
    using Form = std::vector<FormTerm>;
    static constexpr std::size_t longest_form = 6;

    static constexpr std::uint32_t one = 0;  // index of the coefficient 1

    static bool has_edge(Operation operation) {
        return operation == Operation::sqrt || operation == Operation::log || operation == Operation::asin ||
               operation == Operation::acos || operation == Operation::real_power;
    }

    bool moves(std::uint32_t reg) const {
        return reg < program_.slots_.parameters_begin || reg >= first_moving_ || is_clock(reg);
    }

    // ---- time ----

    bool is_clock(std::uint32_t reg) const { return program_.slots_.has_clock() && reg == program_.slots_.clock(); }
    bool uses_clock() const {
        const auto& all = program_.instructions_;
        const auto uses = [&](const Instruction& in) { return is_clock(in.a) || is_clock(in.b); };
        return std::any_of(all.begin() + static_cast<std::ptrdiff_t>(program_.fixed_), all.end(), uses) ||
               std::any_of(program_.outputs_.begin(), program_.outputs_.end(), [&](auto reg) { return is_clock(reg); });
    }
    // The time is read from a copy, because its own series is reset at the end of an order (SeriesPlan::clock).
    void start_clock() {
        const std::uint32_t clock = series_.plan_.clock = next_series_++, copy = next_series_++;
        combine(copy, {clock, 0, 0}, {one, one, one});
        forms_[program_.slots_.clock()] = {{copy, one}};
    }

    // ---- coefficients ----

    std::uint32_t coefficient(Operation operation, std::uint32_t a, std::uint32_t b = 0) {
        const auto [found, fresh] = coefficient_ids_.emplace(std::tuple(operation, a, b),
                                                             static_cast<std::uint32_t>(series_.coefficients_.size()));
        if (fresh) series_.coefficients_.push_back({operation, a, b});
        return found->second;
    }
    std::uint32_t of_register(std::uint32_t reg) { return coefficient(Operation::number, reg); }
    std::uint32_t times(std::uint32_t a, std::uint32_t b) {
        if (a == one) return b;
        return b == one ? a : coefficient(Operation::multiply, a, b);
    }

    // ---- linear forms ----

    Form scaled(const Form& form, std::uint32_t factor) {
        Form result = form;
        for (FormTerm& term : result) term.coefficient = times(term.coefficient, factor);
        return result;
    }
    Form negated(const Form& form) {
        Form result = form;
        for (FormTerm& term : result) term.coefficient = coefficient(Operation::negate, term.coefficient);
        return result;
    }
    Form sum(const Form& a, const Form& b) {
        Form result = a;
        for (const FormTerm& term : b) {
            std::size_t i = 0;
            while (i < result.size() && result[i].series != term.series) ++i;
            if (i == result.size()) {
                result.push_back(term);
            } else {
                result[i].coefficient = coefficient(Operation::add, result[i].coefficient, term.coefficient);
            }
        }
        return result.size() > longest_form ? Form{{written_out(result), one}} : result;
    }

    // Adds a rule whose factors are coefficients.
    void combine(std::uint32_t result, const std::array<std::uint32_t, 3>& series,
                 const std::array<std::uint32_t, 3>& coefficients) {
        series_.combinations_.push_back({static_cast<std::uint32_t>(series_.plan_.rules.size()), coefficients});
        SeriesRule rule{result, series[0], series[1], series[2]};
        for (std::size_t i = 0; i < 3; ++i) rule.known[i] = known(coefficients[i]);
        series_.plan_.rules.push_back(rule);
    }
    // 1 or -1 if the coefficient is always that, else 0.
    std::int8_t known(std::uint32_t coefficient) const {
        if (coefficient == one) return 1;
        const SeriesProgram::Coefficient& c = series_.coefficients_[coefficient];
        return c.operation == Operation::negate && c.a == one ? -1 : 0;
    }

    // A series equal to the form, by rules of up to three terms.
    std::uint32_t written_out(const Form& form) {
        std::uint32_t series = form[0].series, scale = form[0].coefficient;
        for (std::size_t i = 1; i < form.size(); i += 2) {
            const bool third = i + 1 < form.size();
            const std::uint32_t result = next_series_++;
            combine(result, {series, form[i].series, third ? form[i + 1].series : 0},
                    {scale, form[i].coefficient, third ? form[i + 1].coefficient : one});
            series = result;
            scale = one;
        }
        return series;
    }

    // A register as a factor. A form of several terms is replaced by a series once.
    Operand operand(std::uint32_t reg) {
        if (!moves(reg) || forms_[reg].empty()) return {reg, 0, one};
        Form& form = forms_[reg];
        if (form.size() > 1) form = {{written_out(form), one}};
        return {reg, form[0].series, form[0].coefficient};
    }

    // The series of an output, scaled. An output that is an input is copied: the inputs of the next order may be
    // written while outputs are still read.
    std::uint32_t written_apart(const Operand& output) {
        const bool is_input = output.series != 0 && output.series <= program_.slots_.parameters_begin;
        if (!is_input && output.scale == one) return output.series;
        const std::uint32_t copy = next_series_++;
        combine(copy, {output.series, 0, 0}, {output.scale, one, one});
        return copy;
    }

    // ---- recurrences ----

    // Adds the recurrence of a function and returns its result as a factor. Equal functions of equal operands share one
    // recurrence, as in the sine and cosine of one angle or in powers.
    Operand make(Seed seed, const Operand& a, const Operand& b, std::uint32_t value,
                 std::optional<std::uint32_t> partner_value = {}) {
        const auto key = std::tuple(seed.kind, seed.function, seed.sign, a.value, a.series, b.value, b.series);
        if (const auto found = operands_.find(key); found != operands_.end()) return found->second;
        seed.a = a;
        seed.b = b;
        seed.rule = static_cast<std::uint32_t>(series_.plan_.rules.size());
        const std::uint32_t r = next_series_++;
        const Operand result{value, r, one};
        Operand partner = result;
        if (seed.kind == Kind::sin_cos || seed.kind == Kind::tangent) {
            partner = {partner_value ? *partner_value : next_register_++, next_series_++, one};
        }
        seed.result = result;
        seed.partner = partner;
        const std::uint32_t p = partner.series;
        // The factor of w is known if it consists of known scales only (see SeriesProgram::start).
        const std::int8_t by_a = known(a.scale), by_b = known(b.scale);
        const auto sign = static_cast<std::int8_t>(seed.sign);
        const auto add = [&](std::uint32_t to, std::uint32_t x, std::uint32_t y, std::uint32_t w, int of_w = 0) {
            series_.plan_.rules.push_back({to, x, y, w, {0, 0, static_cast<std::int8_t>(of_w)}});
        };
        switch (seed.kind) {
            case Kind::multiply: {
                const bool is_scaled = a.series == 0 || b.series == 0;  // by a factor that is constant in time
                add(r, b.series, a.series, is_scaled ? 0 : sums_.of(a.series, b.series, false), by_a * by_b);
                break;
            }
            case Kind::square:
                add(r, a.series, 0, sums_.of(a.series, a.series, false), by_a * by_a);
                break;
            case Kind::unit_and_square:
                add(r, a.series, 0, sums_.of(a.series, a.series, false), sign * by_a * by_a);
                break;
            case Kind::divide:
                add(r, a.series, b.series, b.series == 0 ? 0 : sums_.of(r, b.series, false));  // 0: constant in time
                break;
            case Kind::sqrt:
                add(r, a.series, 0, sums_.of(r, r, false));
                break;
            case Kind::exp:
                add(r, a.series, 0, sums_.of(a.series, r, true), by_a);
                break;
            case Kind::sin_cos:
                add(r, a.series, 0, sums_.of(a.series, p, true), by_a);
                add(p, a.series, 0, sums_.of(a.series, r, true), sign * by_a);
                break;
            case Kind::tangent:
                add(r, a.series, 0, sums_.of(a.series, p, true), by_a);
                add(p, r, 0, sums_.of(r, r, false), sign);
                break;
            case Kind::integral_of_ratio:
                add(r, a.series, 0, sums_.of(r, b.series, true));
                break;
            case Kind::power:
                add(r, a.series, sums_.of(a.series, r, true), sums_.of(r, a.series, true));
                break;
        }
        series_.seeds_.push_back(seed);
        operands_.emplace(key, result);
        partners_.emplace(result.series, partner);
        return result;
    }
    // For a result that has no register in the program.
    Operand hidden(Seed seed, const Operand& a, const Operand& b) { return make(seed, a, b, next_register_++); }
    Operand partner_of(const Operand& result) const { return partners_.at(result.series); }

    Operand product(const Operand& a, const Operand& b) {
        const bool same = a.value == b.value && a.series == b.series;
        return hidden({.kind = same ? Kind::square : Kind::multiply}, a, b);
    }

    // Order 0 of each function is read from the program if the program contains it.
    Operand sine_and_cosine(const Instruction& in) {
        const bool circular = in.operation == Operation::sin || in.operation == Operation::cos;
        const Operand a = operand(in.a);
        const auto existing = [&](Operation function) -> std::optional<std::uint32_t> {
            const auto found = function_registers_.find({function, in.a});
            if (found == function_registers_.end()) return std::nullopt;
            return found->second;
        };
        const auto sine = existing(circular ? Operation::sin : Operation::sinh);
        const auto cosine = existing(circular ? Operation::cos : Operation::cosh);
        return make({.kind = Kind::sin_cos, .sign = circular ? -1.0 : 1.0}, a, a, sine ? *sine : next_register_++,
                    cosine);
    }

    // base^n, n >= 2, by repeated squaring.
    Operand whole_power(Operand base, unsigned n) {
        std::optional<Operand> result;
        for (; n != 0; n >>= 1) {
            if (n & 1u) result = result ? product(*result, base) : base;
            if (n > 1) base = product(base, base);
        }
        return *result;
    }

    static Form form_of(const Operand& operand) { return {{operand.series, operand.scale}}; }

    Form translate(const Instruction& in, std::uint32_t result) {
        const auto form = [&](std::uint32_t reg) { return moves(reg) ? forms_[reg] : Form(); };
        // Midpoints, and what is computed from them alone, are constant in time.
        const bool is_constant = form(in.a).empty() && (!is_binary(in.operation) || form(in.b).empty());
        if (in.operation == Operation::midpoint || is_constant) return {};
        const auto function = [&](Kind kind, double sign = 1.0) {
            const Operand a = operand(in.a);
            return make({.kind = kind, .sign = sign}, a, a, result);
        };
        const auto ratio = [&](double sign, const Operand& denominator) {
            return form_of(make({.kind = Kind::integral_of_ratio, .function = in.operation, .sign = sign},
                                operand(in.a), denominator, result));
        };
        const auto unit_and_square = [&](double sign) {
            const Operand a = operand(in.a);
            return hidden({.kind = Kind::unit_and_square, .sign = sign}, a, a);
        };
        switch (in.operation) {
            case Operation::add:
                return sum(form(in.a), form(in.b));
            case Operation::subtract:
                return sum(form(in.a), negated(form(in.b)));
            case Operation::negate:
                return negated(form(in.a));
            case Operation::multiply:
                if (!moves(in.a)) return scaled(form(in.b), of_register(in.a));
                if (!moves(in.b)) return scaled(form(in.a), of_register(in.b));
                if (in.a == in.b) return form_of(function(Kind::square));
                return form_of(make({.kind = Kind::multiply}, operand(in.a), operand(in.b), result));
            case Operation::divide:
                if (!moves(in.b)) return scaled(form(in.a), coefficient(Operation::divide, one, of_register(in.b)));
                return form_of(make({.kind = Kind::divide}, operand(in.a), operand(in.b), result));
            case Operation::power: {
                const Operand power = whole_power(operand(in.a), static_cast<unsigned>(std::abs(in.exponent)));
                if (in.exponent > 0) return form_of(power);
                return form_of(make({.kind = Kind::divide, .sign = -1.0}, {power.value, 0, one}, power, result));
            }
            case Operation::real_power: {
                if (!moves(in.b)) return form_of(make({.kind = Kind::power}, operand(in.a), operand(in.b), result));
                const Operand a = operand(in.a);
                const Operand log = hidden({.kind = Kind::integral_of_ratio, .function = Operation::log}, a, a);
                const Operand exponent = product(operand(in.b), log);
                return form_of(make({.kind = Kind::exp}, exponent, exponent, result));
            }
            case Operation::sqrt:
                return form_of(function(Kind::sqrt));
            case Operation::sin:
            case Operation::sinh:
                return form_of(sine_and_cosine(in));
            case Operation::cos:
            case Operation::cosh:
                return form_of(partner_of(sine_and_cosine(in)));
            case Operation::tan:
                return form_of(function(Kind::tangent, 1.0));
            case Operation::tanh:
                return form_of(function(Kind::tangent, -1.0));
            case Operation::asin:
            case Operation::acos: {
                const Operand square = unit_and_square(-1.0);
                const Operand root = hidden({.kind = Kind::sqrt}, square, square);
                return ratio(in.operation == Operation::asin ? 1.0 : -1.0, root);
            }
            case Operation::atan:
                return ratio(1.0, unit_and_square(1.0));
            case Operation::exp:
                return form_of(function(Kind::exp));
            case Operation::log:
                return ratio(1.0, operand(in.a));
            case Operation::midpoint:
            case Operation::number:
            case Operation::symbol:
            case Operation::pi:
                break;  // do not move
        }
        return {};
    }

    SeriesProgram& series_;
    const Program& program_;
    std::uint32_t first_moving_ = 0, next_register_ = 0, next_series_ = 0;
    std::vector<Form> forms_;  // by moving register of the program
    std::map<std::tuple<Operation, std::uint32_t, std::uint32_t>, std::uint32_t> coefficient_ids_;
    std::map<std::tuple<Kind, Operation, double, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>, Operand>
        operands_;
    std::map<std::uint32_t, Operand> partners_;                                        // by series of the result
    std::map<std::pair<Operation, std::uint32_t>, std::uint32_t> function_registers_;  // by function and operand
    InnerSumLanes sums_;
};

SeriesProgram::SeriesProgram(const Program& program, std::size_t dof, std::size_t events) : program_(program) {
    plan_.events = static_cast<std::uint32_t>(events);
    SeriesCompiler(*this).compile(dof + events);
    if (const auto best = best_width()) code_ = OrderCode::of(plan_, *best);
}

std::shared_ptr<const MachineCode> LaneAccess::machine_code_of(const Program& program, std::optional<Width> vectors) {
    if (!vectors) return nullptr;
    const auto first = program.slots_.count + static_cast<std::uint32_t>(program.constants_.size() + program.fixed_);
    return machine_code(std::span(program.instructions_).subspan(program.fixed_), first, Width::eight, *vectors);
}

namespace {

// Whether a number depends on some inputs, as a number type.
struct Dependence {
    bool any = false;

    Dependence() = default;
    Dependence(double) {}  // NOLINT: a constant
    explicit Dependence(bool depends) : any(depends) {}
    friend Dependence operator+(Dependence a, Dependence b) { return Dependence(a.any || b.any); }
    friend Dependence operator*(Dependence a, Dependence b) { return a + b; }
    friend Dependence operator/(Dependence a, Dependence b) { return a + b; }
    friend Dependence operator-(Dependence a) { return a; }
    friend Dependence pow(Dependence a, Dependence b) { return a + b; }
    friend void sine_and_cosine(Dependence a, Dependence& sine, Dependence& cosine) { sine = cosine = a; }
#define SAME(function) \
    friend Dependence function(Dependence a) { return a; }
    SAME(sqrt) SAME(exp) SAME(log) SAME(tan) SAME(asin) SAME(acos) SAME(atan) SAME(sinh) SAME(cosh) SAME(tanh)
#undef SAME
};

}  // namespace

VariedNumbers SeriesProgram::dependent_on(const std::vector<bool>& inputs) const {
    std::vector<Dependence> z(registers_), coefficients(coefficients_.size()), now(plan_.numbers());
    std::vector<std::array<Dependence, 3>> factors(plan_.rules.size());
    for (std::size_t i = 0; i < inputs.size(); ++i) z[i] = Dependence(inputs[i]);
    std::size_t reg = program_.slots_.count + program_.constants_.size();
    for (const Instruction& in : program_.instructions_)
        z[reg++] = is_leaf(in.operation) ? Dependence() : z[in.a] + (is_binary(in.operation) ? z[in.b] : Dependence());
    fix(z.data(), coefficients.data(), factors.data());
    start(z.data(), coefficients.data(), factors.data());
    for (std::uint32_t i = 0; i < program_.slots_.parameters_begin; ++i) now[1 + i] = z[i];
    // An inner sum may need a series whose rule comes later.
    for (bool changed = true; changed;) {
        changed = false;
        const auto set = [&](std::size_t number, Dependence value) {
            changed = changed || value.any != now[number].any;
            now[number] = value;
        };
        for (std::size_t i = 0; i < plan_.rules.size(); ++i)
            set(plan_.rules[i].result, value_of(plan_.rules[i], factors[i], now.data()));
        for (std::size_t i = 0; i < plan_.lanes; ++i) set(plan_.series + i, now[plan_.left[i]] + now[plan_.right[i]]);
    }
    VariedNumbers dependent;
    for (std::size_t i = 0; i < plan_.series; ++i) dependent.series.push_back(now[i].any);
    for (const auto& [x, y, w] : factors) dependent.factors.push_back({x.any, y.any, w.any});
    return dependent;
}

LaneCode LaneCode::of(const SeriesProgram& program, std::optional<Width> vectors, const std::vector<bool>& varied) {
    LanePlan lanes(program.plan_, program.inner_sums_, varied.empty() ? VariedNumbers() : program.dependent_on(varied));
    std::shared_ptr<const LaneOrderCode> orders;
    if (vectors) orders = LaneOrderCode::of(program.plan_, lanes, *vectors);
    return {std::move(lanes), LaneAccess::machine_code_of(program.program_, vectors), std::move(orders)};
}

}  // namespace achilles
