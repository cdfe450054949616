// Contacts that bounce in a system with dry friction (theory-friction.md 4): what their programs need.
#pragma once

#include <optional>
#include <tuple>

#include "model/bouncing.hpp"

namespace achilles {

// How a contact bounces: the state in which it is held after its Zeno point, and until then in the motion that replaces
// the bouncing. A contact with friction slides with one sign at every impact, or it sticks (held).
struct BouncingKey {
    std::size_t contact = 0;
    Mode mode = {};  // of the others, in which this contact is open
    ContactState state = ContactState::held;
    friend bool operator<(const BouncingKey& a, const BouncingKey& b) {
        return std::tie(a.mode, a.contact, a.state) < std::tie(b.mode, b.contact, b.state);
    }
};

// Why the bouncing has no programs: a joint that sticks and feels the impulses slides and sticks again in every flight,
// forever; a contact that slides and feels them must have a coefficient that does not depend on the slip.
std::optional<BouncingObstacle> obstacle_to_bouncing(const BouncingKey& key, ContactModes& modes, const Layout& layout);

// The programs of such a contact. If it sticks at its impacts, `sticking` is set.
BouncingModel derive_bouncing(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                              const Layout& layout);
// The conditions on the others, and on the slip of this contact (theory-friction.md 4.1, 4.3).
OtherContactTerms derive_other_contacts(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                                        const Layout& layout);

// The programs of two contacts that bounce in turn in a system with friction, each sliding with the sign of its state in
// `closed`, or without friction. Nothing else may be held in that mode. W_10 is set.
PairPrograms derive_sliding_pair(std::size_t first, std::size_t second, Mode closed, ContactModes& modes,
                                 const Equations& equations, const Layout& layout);
// Whether a contact slides with a coefficient that does not depend on the speed, or has no friction.
bool slides_evenly(std::size_t contact, ContactState state, const FrictionLaws& laws, const Layout& layout);

}  // namespace achilles
