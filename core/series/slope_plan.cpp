#include "series/slope_plan.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "series/series.hpp"

namespace achilles {

class SlopePlanner {
 public:
    SlopePlanner(const SeriesProgram& program, SlopePlan& plan) : program_(program), plan_(plan) {}

    void write() {
        const auto& rules = program_.plan_.rules;
        std::vector<const SeriesProgram::Seed*> seeds(rules.size(), nullptr);
        std::vector<const SeriesProgram::Combination*> combinations(rules.size(), nullptr);
        for (const auto& seed : program_.seeds_) seeds[seed.rule] = &seed;
        for (const auto& combination : program_.combinations_) combinations[combination.rule] = &combination;
        for (std::size_t i = 0; i < rules.size(); ++i) {
            if (seeds[i] != nullptr) write(*seeds[i]);
            if (combinations[i] == nullptr) continue;
            Rule& rule = add(Rule::Kind::sum, rules[i].result);
            rule.series = {rules[i].x, rules[i].y, rules[i].w};
            rule.coefficient = combinations[i]->coefficient;
        }
        place();
    }

 private:
    using Rule = SlopePlan::Rule;
    using Kind = SeriesProgram::Kind;
    using Operand = SeriesProgram::Operand;

    Rule& add(Rule::Kind kind, std::uint32_t result) {
        Rule& rule = plan_.rules.emplace_back();
        rule.kind = kind;
        rule.result = result;
        return rule;
    }
    std::uint32_t factor(const Operand& operand) {
        const auto next = static_cast<std::uint32_t>(plan_.factors.size());
        const SlopePlan::Factor factor{operand.series, operand.value, operand.scale};
        const auto [found, fresh] = ids_.emplace(factor, next);
        if (fresh) plan_.factors.push_back(factor);
        return found->second;
    }
    Rule& of_products(const Operand& result, std::initializer_list<std::pair<Operand, Operand>> products,
                      double by = 1.0) {
        Rule& rule = add(Rule::Kind::product, result.series);
        rule.own = factor(result);
        rule.hidden = result.value >= program_.hidden_;
        rule.by = by;
        for (const auto& [known, rising] : products) rule.products[rule.count++] = {factor(known), factor(rising)};
        return rule;
    }
    // divisor r' = lead a' - the products
    void divided(Rule& rule, double lead, const Operand& leading, const Operand& divisor) {
        rule.by = -1.0;
        rule.lead = lead;
        rule.leading = factor(leading);
        rule.divides = true;
        rule.divisor = factor(divisor);
    }

    void write(const SeriesProgram::Seed& seed) {
        const Operand &a = seed.a, &b = seed.b, &r = seed.result, &partner = seed.partner;
        switch (seed.kind) {
            case Kind::multiply:
                of_products(r, {{a, b}, {b, a}});
                break;
            case Kind::square:
                of_products(r, {{a, a}}, 2.0);
                break;
            case Kind::unit_and_square:
                of_products(r, {{a, a}}, 2.0 * seed.sign);
                break;
            case Kind::divide:  // b r = a, or 1
                divided(of_products(r, {{r, b}, {b, r}}), seed.sign < 0.0 ? 0.0 : 1.0, seed.sign < 0.0 ? b : a, b);
                break;
            case Kind::sqrt:  // r r = a
                divided(of_products(r, {{r, r}}), 0.5, a, r);
                break;
            case Kind::exp:
                of_products(r, {{r, a}});
                break;
            case Kind::sin_cos:
                of_products(r, {{partner, a}});
                of_products(partner, {{r, a}}, seed.sign);
                break;
            case Kind::tangent:
                of_products(r, {{partner, a}});
                of_products(partner, {{r, r}}, 2.0 * seed.sign);
                break;
            case Kind::integral_of_ratio:  // b r' = sign a'
                divided(of_products(r, {{b, r}}), seed.sign, a, b);
                break;
            case Kind::power: {
                Rule& rule = of_products(r, {{r, a}, {a, r}});
                rule.kind = Rule::Kind::power;
                rule.count = 0;
                rule.leading = factor({b.value, 0, 0});
                rule.divisor = factor(a);
                break;
            }
        }
    }

    // The factors by series.
    void place() {
        std::vector<SlopePlan::Factor>& factors = plan_.factors;
        std::sort(factors.begin(), factors.end());
        std::vector<std::uint32_t> place(factors.size());
        for (std::uint32_t i = 0; i < factors.size(); ++i) place[ids_.at(factors[i])] = i;
        for (Rule& rule : plan_.rules) {
            if (rule.kind == Rule::Kind::sum) continue;
            for (std::uint32_t* factor : {&rule.own, &rule.leading, &rule.divisor}) *factor = place[*factor];
            for (std::size_t i = 0; i < rule.count; ++i)
                rule.products[i] = {place[rule.products[i].known], place[rule.products[i].rising]};
            if (rule.count == 2 && rule.products[1].rising < rule.products[0].rising)
                std::swap(rule.products[0], rule.products[1]);
        }
        plan_.series = program_.plan_.series;
        plan_.outputs = program_.plan_.outputs;
        plan_.events = program_.plan_.events;
        std::uint32_t next = 0;
        for (std::uint32_t series = 0; series <= plan_.series; ++series) {
            while (next < factors.size() && factors[next].series < series) ++next;
            plan_.first_factor.push_back(next);
        }
    }

    const SeriesProgram& program_;
    SlopePlan& plan_;
    std::map<SlopePlan::Factor, std::uint32_t> ids_;
};

std::vector<std::uint32_t> SlopePlan::known_factors() const {
    std::set<std::uint32_t> known;
    for (const Rule& rule : rules) {
        for (std::size_t i = 0; i < rule.count; ++i) known.insert(rule.products[i].known);
        if (rule.kind == Rule::Kind::power) known.insert({rule.own, rule.divisor});
    }
    return {known.begin(), known.end()};
}

SlopePlan::SlopePlan(const SeriesProgram& program) { SlopePlanner(program, *this).write(); }

const SlopeProgram& SeriesProgram::slopes() const {
    std::call_once(slopes_->made, [&] {
        slopes_->plan = SlopePlan(*this);
        slopes_->code = SlopeOrderCode::of(slopes_->plan);
    });
    return *slopes_;
}

}  // namespace achilles
