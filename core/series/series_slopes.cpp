#include "series/series_slopes.hpp"

#include <algorithm>

#include "number/jet.hpp"  // its functions
#include "series/lane_stepper.hpp"
#include "series/series.hpp"

namespace achilles {

namespace {

constexpr std::size_t orders = SlopeTables::orders;

// By the widest vectors that the processor has.
struct Kind {
    decltype(&SlopeKind<16>::make_order) make_order = SlopeKind<16>::make_order;
    decltype(&SlopeKind<16>::make_hidden) make_hidden = SlopeKind<16>::make_hidden;
    decltype(&SlopeKind<16>::any_above) any_above = SlopeKind<16>::any_above;
    decltype(&SlopeKind<16>::add_up) add_up = SlopeKind<16>::add_up;
};
const Kind kind = [] {
    Kind best;
#ifdef ACHILLES_HAS_AVX512
    const std::vector<Vectors> possible = possible_vectors();
    if (std::find(possible.begin(), possible.end(), Vectors::avx512) != possible.end())
        best = {SlopeKind<64>::make_order, SlopeKind<64>::make_hidden, SlopeKind<64>::any_above, SlopeKind<64>::add_up};
#endif
    return best;
}();

}  // namespace

SeriesSlopes::SeriesSlopes(const SeriesProgram& program, std::span<const double> parameters,
                           std::span<const std::uint32_t> variables)
    : program_(&program),
      plan_(&program.slopes().plan),
      variables_(variables.begin(), variables.end()),
      dof_(plan_->coordinates()),
      width_(plan_->states()),
      series_(program, parameters),
      rows_(orders * width_),
      knowns_(orders * plan_->factors.size()),
      scales_of_rules_(2 * plan_->rules.size()),
      code_(program.slopes().code),
      groups_((variables.size() + directions - 1) / directions) {
    const std::size_t first = LaneAccess::moving_inputs(program.program_);
    std::vector<Number> coefficients(program.coefficients_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        Group& group = groups_[g];
        group.start = Evaluator<Number>(program.program_);
        for (std::size_t i = 0; i < parameters.size(); ++i)
            group.start.input(first + i) = number(parameters[i], g, static_cast<std::uint32_t>(first + i));
        group.start.fix();
        program.fix_coefficients(LaneAccess::registers_of(group.start).data(), coefficients.data());
        for (const Number& c : coefficients) {
            const Eight rise = c.slope;
            const bool rises =
                std::any_of(std::begin(rise.lane), std::end(rise.lane), [](double x) { return x != 0.0; });
            group.coefficients.push_back({c.value, rises, rise});
        }
        group.risings.resize(orders * plan_->factors.size());
        group.rise.resize(plan_->series);
        group.states.resize(orders * width_);
    }
    for (const std::uint32_t f : plan_->known_factors()) {
        const SlopePlan::Factor& factor = plan_->factors[f];
        const double scale = groups_.empty() ? 1.0 : groups_.front().coefficients[factor.scale].value;
        known_factors_.push_back({f, factor.series, scale});
    }
}

auto SeriesSlopes::number(double x, std::size_t group, std::uint32_t slot) const -> Number {
    const auto begin = variables_.begin() + static_cast<std::ptrdiff_t>(group * directions);
    const auto end = variables_.end() - begin > static_cast<std::ptrdiff_t>(directions)
                         ? begin + static_cast<std::ptrdiff_t>(directions)
                         : variables_.end();
    const auto found = std::find(begin, end, slot);
    return found == end ? Number(x) : Number::variable(x, static_cast<std::size_t>(found - begin));
}

SlopeTables SeriesSlopes::tables(Group& group) const {
    return {group.coefficients.data(), scales_of_rules_.data(), series_.series(),    knowns_.data(),
            group.risings.data(),      group.rise.data(),       group.states.data(), plan_->factors.size()};
}

void SeriesSlopes::begin(const double* q_and_v, double time) {
    const Program& program = program_->program_;
    const std::vector<SlopePlan::Factor>& factors = plan_->factors;
    std::copy_n(q_and_v, 2 * dof_, rows_.data());
    series_.begin(rows_.data(), time);
    for (std::size_t f = 0; f < factors.size(); ++f) knowns_[f] = series_.registers()[factors[f].value];
    for (std::size_t i = 0; i < plan_->rules.size(); ++i) {
        const SlopePlan::Rule& rule = plan_->rules[i];
        const double inverse = rule.divides ? 1.0 / knowns_[rule.divisor] : 1.0;
        scales_of_rules_[2 * i] = rule.by * inverse;
        scales_of_rules_[2 * i + 1] = rule.lead * inverse;
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        Group& group = groups_[g];
        const std::vector<Number>& at = LaneAccess::registers_of(group.start);
        for (std::size_t i = 0; i < 2 * dof_; ++i) {
            const Number x = number(q_and_v[i], g, static_cast<std::uint32_t>(i));
            group.start.input(i) = x;
            group.states[i] = x.slope;
        }
        if (LaneAccess::has_clock(program)) group.start.clock() = number(time, g, LaneAccess::clock(program));
        group.start.run();
        for (std::size_t f = 0; f < factors.size(); ++f) {
            const std::uint32_t value = factors[f].value;
            if (value < program_->hidden_) group.risings[f * orders] = at[value].slope;
        }
        // Order 1 of q and v is given: an output that does not move has no series.
        for (std::size_t i = 0; i < dof_; ++i) {
            group.states[width_ + i] = group.states[dof_ + i];
            group.states[width_ + dof_ + i] = group.start.output(i).slope;
        }
        kind.make_hidden(*plan_, tables(group));
    }
}

void SeriesSlopes::extend(int k) {
    double* const row = rows_.data() + static_cast<std::size_t>(k) * width_;
    if (k == 1) {
        for (std::size_t i = 0; i < dof_; ++i) {
            row[i] = rows_[dof_ + i];
            row[dof_ + i] = series_.start(i);
        }
        series_.extend(1, row);
        motion_ = {};
        motion_.row = row;
        motion_.largest = row + dof_;
    } else {
        series_.extend(motion_, k, k);
    }
    const double* const now = series_.series();
    double* const order = knowns_.data() + static_cast<std::size_t>(k) * plan_->factors.size();
    for (const auto& [factor, series, scale] : known_factors_) order[factor] = scale * now[series];
    for (Group& group : groups_) kind.make_order(*plan_, tables(group), code_.get(), static_cast<std::size_t>(k));
}

bool SeriesSlopes::any_above(std::size_t group, int k, std::size_t i, std::span<const Eight> limits,
                             double weight) const {
    return kind.any_above(&slope(group, k, i), limits.data(), limits.size(), weight);
}

Eight SeriesSlopes::sum(std::size_t group, std::size_t i, const double* weights, int first, int last) const {
    Eight result;
    kind.add_up(groups_[group].states.data() + i, width_, weights, first, last, &result);
    return result;
}

}  // namespace achilles
