// The contact laws: a table of what a contact does in each of its states. Derivation, events, proofs and derivatives
// read it.
//
//     state   kept            force                        watched until it falls to 0    then
//     open    nothing         none                         h                              impact: held or open
//     held    h = hdot = 0    lambda g'                    lambda                         release: open
//     slip+-  h = hdot = 0    lambda (g' -+ mu d')         lambda                         release: open
//
// With friction (theory-friction.md 1) a contact has a slip u = d v + c as well. A held one sticks. A joint has no gap:
// it keeps nothing but u, and its lambda is 1.
//
//     state   kept besides    force besides                watched besides                then
//     held    u = 0           tau d'                       mu_s lambda - tau, + tau       slip-, slip+
//     slip+-  nothing         none                         +-u, and W_sigma where needed  held or slip-+; none
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
// What friction watches besides, if a contact or joint has it; a mode lists them (ModeDynamics::friction).
enum class FrictionFunction : std::uint8_t {
    slip,         // sigma u while it slips; then it sticks or slips the other way
    upper_limit,  // mu_s lambda - tau, times a positive factor, while it sticks; then slip-
    lower_limit,  // mu_s lambda + tau, times the same; then slip+
    pivot         // the acceleration of a held gap by its unit force, where other friction may make it 0; no motion
};
struct FrictionEvent {
    std::size_t contact;  // or joint
    FrictionFunction watched;
    int power;  // the function has the unit of the contact's gap to this power, if gap and slip have one unit; 0: joint
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
    ContactLaw{ContactState::slip_plus, Constraint::gap, WatchedFunction::normal_force, Transition::release},
    ContactLaw{ContactState::slip_minus, Constraint::gap, WatchedFunction::normal_force, Transition::release},
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
