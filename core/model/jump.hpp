// Jumps of the state, and contacts that count only sometimes (theory-modes.md 1, 2).
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

}  // namespace achilles
