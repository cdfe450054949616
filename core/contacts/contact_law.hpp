// The contact laws: a table of what a contact does in each of its states. Derivation, events, proofs and derivatives
// read it.
//
//     state   kept            force       watched until it falls to 0    then
//     open    nothing         none        h                              impact: held or open, by the impact law
//     held    h = hdot = 0    lambda g'   lambda                         release: open
//
// core/README.md explains how to add a law.
#pragma once

#include <array>

#include "run/mode.hpp"

namespace achilles {

// The function that a contact keeps at zero. Its gradient has a multiplier, the contact force.
enum class Constraint : std::uint8_t { none, gap };

// The function whose zero ends a state.
enum class WatchedFunction : std::uint8_t {
    gap,          // h
    normal_force  // lambda, as -hddot/W of the mode in which the contact is open
};

enum class Transition : std::uint8_t { impact, release };

struct ContactLaw {
    ContactState state;
    Constraint kept;
    WatchedFunction watched;
    Transition transition;
};

// In the order of ContactState.
inline constexpr std::array contact_laws{
    ContactLaw{ContactState::open, Constraint::none, WatchedFunction::gap, Transition::impact},
    ContactLaw{ContactState::held, Constraint::gap, WatchedFunction::normal_force, Transition::release},
};

constexpr const ContactLaw& law_of(ContactState state) { return contact_laws[static_cast<std::size_t>(state)]; }

// The contacts of a mode that keep this constraint, or that watch this function. Contacts that the system does not have
// count as open.
constexpr ContactSet contacts_keeping(Mode mode, Constraint kept) {
    ContactSet found;
    for (const ContactLaw& law : contact_laws)
        if (law.kept == kept) found = found.with(mode.contacts_in(law.state));
    return found;
}
constexpr ContactSet contacts_watching(Mode mode, WatchedFunction watched) {
    ContactSet found;
    for (const ContactLaw& law : contact_laws)
        if (law.watched == watched) found = found.with(mode.contacts_in(law.state));
    return found;
}

}  // namespace achilles
