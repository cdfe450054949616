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
    law.w.assign(layout.dof, nothing);
    law.drift = nothing;
    const auto polynomial = expand_in_rates(law.slip, rates, offender);
    for (const auto& [exponents, coefficient] : *polynomial) {
        const auto rate = std::find(exponents.begin(), exponents.end(), 1);
        if (rate == exponents.end())
            law.drift = coefficient;
        else
            law.w[static_cast<std::size_t>(rate - exponents.begin())] = coefficient;
    }
    if (std::any_of(law.w.begin(), law.w.end(), [](Expression e) { return !e.is_zero(); })) return;
    throw Mistake{text.at,
                  law.drift.is_zero() ? "the slip is 0 everywhere" : "the slip depends on no rate: nothing slides",
                  text.is_written ? fmt::format("a slip is the sliding velocity, as in {}'", system.coordinates[0].name)
                                  : "what touches moves along the normal only: leave the friction out"};
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
    const auto is_none = [](const FrictionLaw& law) {
        return !law.never_slides && law.level.is_zero() && law.static_level.is_zero();
    };
    std::size_t joint = 0;
    for (const FrictionLaw& law : equations.frictions) {
        const bool is_kept = !is_none(law);
        if (!law.contact) {
            if (is_kept)
                ++joint;
            else
                system.frictions.erase(system.frictions.begin() + static_cast<std::ptrdiff_t>(joint));
        } else if (!is_kept) {
            system.constraints[*law.contact].friction = {};
            system.constraints[*law.contact].static_friction.reset();
        }
    }
    std::erase_if(equations.frictions, is_none);
}

void refuse_friction_until_runs_have_it(const SystemDescription& system) {
    const auto places = sliding_places(system);
    if (places.empty()) return;
    throw system.error(places.front().level->at, "friction is read and checked, but no run has it yet",
                       "achilles check prints the equations; leave the friction out to run the system without it");
}

}  // namespace achilles
