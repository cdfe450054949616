#include "model/friction_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "model/rate_polynomial.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr const char* slips_are =
    "a slip is a velocity: rates times functions of coordinates, t and parameters, plus the speed of a surface, as in "
    "x' + R*phi' - V";

bool is_affine(Expression e, const std::vector<std::uint32_t>& rates) {
    Expression offender;
    const auto polynomial = expand_in_rates(e, rates, offender);
    return polynomial && std::all_of(polynomial->begin(), polynomial->end(),
                                     [](const auto& term) { return degree(term.first) <= 1; });
}

// Names the first term of the text that is not affine by itself, or the whole text.
Mistake not_affine(const Text& text, const TextParts& parts, const std::vector<std::uint32_t>& rates) {
    const auto term = std::find_if(parts.terms.begin(), parts.terms.end(),
                                   [&](const TextPart& part) { return !is_affine(part.value, rates); });
    const bool is_one_term = term != parts.terms.end();
    const std::size_t offset = is_one_term ? term->offset : 0;
    return {place_in(text, offset),
            fmt::format("the slip is not affine in the rates: {}",
                        shown(is_one_term ? text.text.substr(offset, term->size) : text.text)),
            slips_are};
}

}  // namespace

void split_slip(const SystemDescription& system, const Layout& layout, const Text& text, const TextParts& parts,
                FrictionLaw& law) {
    std::vector<std::uint32_t> rates;
    for (std::size_t i = 0; i < layout.dof; ++i) rates.push_back(layout.v(i));
    if (!is_affine(law.slip, rates)) throw not_affine(text, parts, rates);
    Expression offender;
    const Expression nothing = law.slip.graph().number(0);
    law.d.assign(layout.dof, nothing);
    law.c = nothing;
    const auto polynomial = expand_in_rates(law.slip, rates, offender);
    for (const auto& [exponents, coefficient] : *polynomial) {
        const auto rate = std::find(exponents.begin(), exponents.end(), 1);
        if (rate == exponents.end())
            law.c = coefficient;
        else
            law.d[static_cast<std::size_t>(rate - exponents.begin())] = coefficient;
    }
    if (std::any_of(law.d.begin(), law.d.end(), [](Expression e) { return !e.is_zero(); })) return;
    throw Mistake{text.at, law.c.is_zero() ? "the slip is 0 everywhere" : "the slip depends on no rate: nothing slides",
                  text.is_written ? fmt::format("a slip is the sliding velocity, as in {}'", system.coordinates[0].name)
                                  : "the touching point moves only along the normal: leave the friction out"};
}

Expression at_slip_zero(Expression level, const Layout& layout, const Text& text) {
    const std::uint32_t speed[] = {layout.sliding_speed()};
    const Expression zero[] = {level.graph().number(0)};
    try {
        return substitute(level, speed, zero);
    } catch (const std::domain_error&) {
        throw Mistake{text.at, fmt::format("the friction {} is not defined at slip 0", shown(text.text)),
                      "it must have a value for every slip from 0 on, as 0.2 + 0.3*exp(-slip/v0) has"};
    }
}

void drop_zero_friction(SystemDescription& system, Equations& equations) {
    FrictionLaws laws;
    std::vector<FrictionDescription> joints;
    for (const SlidingPlace& place : sliding_places(system)) {
        FrictionLaw& law = equations.friction.at(place.number);
        const bool is_kept = law.never_slides || !law.level.is_zero() || !law.static_level.is_zero();
        if (is_kept && is_joint(place.number)) {
            laws.emplace(joint_number(joints.size()), std::move(law));
            joints.push_back(system.frictions[place.number - joint_number(0)]);
        } else if (is_kept) {
            laws.emplace(place.number, std::move(law));
        } else if (!is_joint(place.number)) {
            system.constraints[place.number].friction = {};
            system.constraints[place.number].static_friction.reset();
        }
    }
    system.frictions = std::move(joints);
    equations.friction = std::move(laws);
}

}  // namespace achilles
