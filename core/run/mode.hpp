// The mode of a motion: the state of every contact, and of every joint with dry friction. Equations, compiled programs
// and caches of a motion have its mode as the key.
#pragma once

#include <utility>

#include "contact_set.hpp"

namespace achilles {

// The state of a contact along a motion. The table in contacts/contact_law.hpp gives the consequences of each state. A
// held contact with friction sticks; its slip may be implied by those of others, as of the second foot of a table, and
// then it has no friction force of its own. A joint is held (it sticks) or slips; an open joint has no friction force,
// which only derivations use.
enum class ContactState : std::uint8_t { open, held, slip_plus, slip_minus };

// The sign of the slip: 1, -1, or 0 for a state without slip.
constexpr int slip_sign(ContactState state) {
    return state == ContactState::slip_plus ? 1 : state == ContactState::slip_minus ? -1 : 0;
}
constexpr ContactState slip_state(int sign) { return sign > 0 ? ContactState::slip_plus : ContactState::slip_minus; }

// The default is free flight: every contact is open, including those that the system does not have, and no joint has
// friction.
class Mode {
 public:
    constexpr Mode() = default;
    // These contacts are held, all others open.
    static constexpr Mode holding(ContactSet contacts) { return Mode().with(contacts, ContactState::held); }

    constexpr ContactState state(std::size_t contact) const {
        return static_cast<ContactState>((bits_ >> contact & 1u) | (bits_ >> high >> contact & 1u) << 1);
    }
    // True for a contact that is closed and kept closed, whether it sticks or slips; for a joint with friction.
    constexpr bool is_held(std::size_t contact) const { return state(contact) != ContactState::open; }
    // Whether every contact is open. Joints do not count.
    constexpr bool is_free() const { return held().empty(); }
    // Held contacts whose slip stays 0 because that of others does.
    constexpr ContactSet implied() const {
        const auto half = [this](std::uint32_t shift) {
            return static_cast<std::uint32_t>(bits_ >> (first_flag + shift) & 0xFFu);
        };
        return ContactSet(half(0) | half(high) << 8u);
    }
    constexpr Mode with_implied_slip(std::size_t contact) const {
        return Mode(bits_ | flags(ContactSet::of(contact).bits_), exceptions_);
    }
    // The contacts for which held(NAME) is 1 in the forces (theory-modes.md 5): the held ones, with two exceptions.
    constexpr ContactSet seen_by_forces() const { return held().without(silent()).with(acting()); }
    // Open contacts that act on the forces as held ones do. Only derivations and decisions have such modes.
    constexpr ContactSet acting() const { return exceptions_.without(held()); }
    constexpr Mode with_acting(ContactSet contacts) const {
        return Mode(bits_, exceptions_.with(contacts.without(held())));
    }
    // Held contacts that do not act on the forces: from the cut of their bouncing to the Zeno point.
    constexpr ContactSet silent() const { return exceptions_.within(held()); }
    constexpr Mode with_silent(ContactSet contacts) const {
        return Mode(bits_, exceptions_.without(held()).with(contacts.within(held())));
    }
    // The contacts that are not open, and those in a given state.
    constexpr ContactSet held() const {
        return ContactSet(static_cast<std::uint32_t>(bits_ | bits_ >> high) & of_contacts);
    }
    constexpr ContactSet contacts_in(ContactState state) const {
        return elements_in(state).within(ContactSet(of_contacts));
    }
    // The contacts and joints that slip; the joints with friction.
    constexpr ContactSet slipping() const { return ContactSet(static_cast<std::uint32_t>(bits_ >> high) & all); }
    constexpr ContactSet joints() const {
        return ContactSet(static_cast<std::uint32_t>(bits_ | bits_ >> high) & all & ~of_contacts);
    }
    // Contacts and joints in a given state.
    constexpr ContactSet elements_in(ContactState state) const {
        return ContactSet(
            static_cast<std::uint32_t>(~(bits_ ^ low_bits(all, state)) & ~((bits_ ^ high_bits(all, state)) >> high)) &
            all);
    }

    constexpr Mode with(ContactSet contacts, ContactState state) const {
        const std::uint64_t set = contacts.bits_;
        const std::uint64_t kept = bits_ & ~(set | set << high | flags(set));
        return Mode(kept | low_bits(set, state) | high_bits(set, state), exceptions_.without(contacts));
    }
    constexpr Mode with(std::size_t contact, ContactState state) const { return with(ContactSet::of(contact), state); }
    // This mode with these contacts open.
    constexpr Mode without(ContactSet contacts) const { return with(contacts, ContactState::open); }
    constexpr Mode without(std::size_t contact) const { return with(contact, ContactState::open); }
    // This mode for these contacts, with all others open. Joints keep their state.
    constexpr Mode only(ContactSet contacts) const { return without(held().without(contacts)); }

    friend constexpr bool operator==(const Mode&, const Mode&) = default;
    friend constexpr bool operator<(const Mode& a, const Mode& b) {
        return a.bits_ != b.bits_ ? a.bits_ < b.bits_ : a.exceptions_ < b.exceptions_;
    }

 private:
    // A state has two bits. The low bits of all contacts and joints are in one half of the word, the high bits in the
    // other.
    static constexpr std::uint32_t high = 32, of_contacts = (1u << max_contacts) - 1u,
                                   all = (1u << (max_contacts + max_joints)) - 1u;
    // Eight flags in each half: the slip of a held contact is implied.
    static constexpr std::uint32_t first_flag = 24;
    static constexpr std::uint64_t flags(std::uint64_t set) {
        return (set & 0xFFu) << first_flag | (set >> 8u & 0xFFu) << (first_flag + high);
    }
    static constexpr std::uint64_t low_bits(std::uint64_t set, ContactState state) {
        return (static_cast<std::uint32_t>(state) & 1u) != 0 ? set : 0u;
    }
    static constexpr std::uint64_t high_bits(std::uint64_t set, ContactState state) {
        return (static_cast<std::uint32_t>(state) & 2u) != 0 ? set << high : 0u;
    }

    constexpr explicit Mode(std::uint64_t bits, ContactSet exceptions) : bits_(bits), exceptions_(exceptions) {}
    std::uint64_t bits_ = 0;
    ContactSet exceptions_;     // contacts that forces see in another state: acting() or silent()
    std::uint32_t unused_ = 0;  // in place of padding: sweeps write modes as bytes
};

// Key of the data of one contact in a mode.
using ContactInMode = std::pair<Mode, std::size_t>;

}  // namespace achilles
