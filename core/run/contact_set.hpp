// A set of contacts, such as those that impact, release or are examined; also of joints with dry friction. The contacts
// that a motion holds are in its Mode.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace achilles {

// Maximum number of contacts in a system.
inline constexpr std::size_t max_contacts = 16;
// Dry friction without a gap acts at joints. In modes and sets joint k has the number max_contacts + k.
inline constexpr std::size_t max_joints = 8;
constexpr std::size_t joint_number(std::size_t joint) { return max_contacts + joint; }
constexpr bool is_joint(std::size_t contact_or_joint) { return contact_or_joint >= max_contacts; }

class ContactSet {
 public:
    constexpr ContactSet() = default;
    static constexpr ContactSet of(std::size_t contact) { return ContactSet(1u << contact); }

    constexpr bool empty() const { return bits_ == 0; }
    constexpr int count() const { return std::popcount(bits_); }
    // True for exactly one contact; only() then returns it.
    constexpr bool has_one() const { return bits_ != 0 && (bits_ & (bits_ - 1)) == 0; }
    constexpr std::size_t only() const { return static_cast<std::size_t>(std::countr_zero(bits_)); }
    constexpr bool contains(std::size_t contact) const { return (bits_ >> contact & 1u) != 0; }
    constexpr ContactSet with(std::size_t contact) const { return ContactSet(bits_ | 1u << contact); }
    constexpr ContactSet without(std::size_t contact) const { return ContactSet(bits_ & ~(1u << contact)); }

    constexpr ContactSet with(ContactSet others) const { return ContactSet(bits_ | others.bits_); }
    constexpr ContactSet without(ContactSet others) const { return ContactSet(bits_ & ~others.bits_); }
    constexpr ContactSet within(ContactSet others) const { return ContactSet(bits_ & others.bits_); }

    friend constexpr bool operator==(const ContactSet&, const ContactSet&) = default;
    friend constexpr bool operator<(const ContactSet& a, const ContactSet& b) { return a.bits_ < b.bits_; }

    // Iterates over the contacts in ascending order.
    class Iterator {
     public:
        constexpr explicit Iterator(std::uint32_t left) : left_(left) {}
        constexpr std::size_t operator*() const { return static_cast<std::size_t>(std::countr_zero(left_)); }
        constexpr Iterator& operator++() {
            left_ &= left_ - 1;
            return *this;
        }
        friend constexpr bool operator==(const Iterator&, const Iterator&) = default;

     private:
        std::uint32_t left_;
    };
    constexpr Iterator begin() const { return Iterator(bits_); }
    constexpr Iterator end() const { return Iterator(0); }

 private:
    friend class Mode;
    constexpr explicit ContactSet(std::uint32_t bits) : bits_(bits) {}
    std::uint32_t bits_ = 0;
};

}  // namespace achilles
