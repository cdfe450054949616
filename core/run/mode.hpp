// The mode of a motion: the state of every contact. Equations, compiled programs and caches of a motion have its mode
// as the key.
#pragma once

#include <utility>

#include "contact_set.hpp"

namespace achilles {

// The state of a contact along a motion. The table in contacts/contact_law.hpp gives the consequences of each state. A
// mode has room for four states.
enum class ContactState : std::uint8_t { open, held };

// The default is free flight: every contact is open, including those that the system does not have.
class Mode {
 public:
    constexpr Mode() = default;
    // These contacts are held, all others open.
    static constexpr Mode holding(ContactSet contacts) { return Mode().with(contacts, ContactState::held); }

    constexpr ContactState state(std::size_t contact) const {
        return static_cast<ContactState>((bits_ >> contact & 1u) | (bits_ >> (high + contact) & 1u) << 1);
    }
    constexpr bool is_held(std::size_t contact) const { return state(contact) != ContactState::open; }
    constexpr bool is_free() const { return bits_ == 0; }
    // The contacts that are not open, and those in a given state.
    constexpr ContactSet held() const { return ContactSet((bits_ | bits_ >> high) & all); }
    constexpr ContactSet contacts_in(ContactState state) const {
        return ContactSet(~(bits_ ^ low_bits(all, state)) & ~(bits_ >> high ^ high_bits(all, state) >> high) & all);
    }

    constexpr Mode with(ContactSet contacts, ContactState state) const {
        const std::uint32_t set = contacts.bits_;
        return Mode((bits_ & ~(set | set << high)) | low_bits(set, state) | high_bits(set, state));
    }
    constexpr Mode with(std::size_t contact, ContactState state) const { return with(ContactSet::of(contact), state); }
    // This mode with these contacts open.
    constexpr Mode without(ContactSet contacts) const { return with(contacts, ContactState::open); }
    constexpr Mode without(std::size_t contact) const { return with(contact, ContactState::open); }
    // This mode for these contacts, with all others open.
    constexpr Mode only(ContactSet contacts) const { return without(held().without(contacts)); }

    friend constexpr bool operator==(const Mode&, const Mode&) = default;
    friend constexpr bool operator<(const Mode& a, const Mode& b) { return a.bits_ < b.bits_; }

 private:
    // A state has two bits. The low bits of all contacts are in one half of the word, the high bits in the other.
    static constexpr std::uint32_t high = max_contacts, all = (1u << max_contacts) - 1u;
    static constexpr std::uint32_t low_bits(std::uint32_t set, ContactState state) {
        return (static_cast<std::uint32_t>(state) & 1u) != 0 ? set : 0u;
    }
    static constexpr std::uint32_t high_bits(std::uint32_t set, ContactState state) {
        return (static_cast<std::uint32_t>(state) & 2u) != 0 ? set << high : 0u;
    }

    constexpr explicit Mode(std::uint32_t bits) : bits_(bits) {}
    std::uint32_t bits_ = 0;
};

// Key of the data of one contact in a mode.
using ContactInMode = std::pair<Mode, std::size_t>;

}  // namespace achilles
