// Jumps of the state, latches, and contacts that count only sometimes (theory-modes.md 1, 2, 4).
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "expression/expression.hpp"

namespace achilles {

// A jump as read. It happens right after the impacts of a contact, or where an expression falls through zero along the
// motion; then it is a watched jump.
struct JumpLaw {
    std::optional<std::size_t> contact;
    std::optional<Expression> on;
    std::optional<Expression> when;                           // it happens only where this is positive
    std::vector<std::pair<std::uint32_t, Expression>> set{};  // slots of q and v, with their values after the jump
};

// What ends the latch of a contact: the first impact of another contact, or an expression that rises through zero along
// the motion.
struct LatchLaw {
    std::optional<std::size_t> contact;
    std::optional<Expression> until;
};

// An expression whose zero along the motion is an event: `on` of a jump, or `until` of a latch.
struct WatchedGuard {
    bool is_latch;
    std::size_t number;  // of the jump in the file; of the contact with the latch
    Expression function;
};
// Those of the jumps, in the order of the file, then those of the latches, in the order of their contacts.
std::vector<WatchedGuard> watched_guards(const std::vector<JumpLaw>& jumps,
                                         const std::vector<std::optional<LatchLaw>>& latches);

}  // namespace achilles
