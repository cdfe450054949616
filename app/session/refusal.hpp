// What a command is refused with.
#pragma once

#include <string>

#include "system/description.hpp"

namespace achilles {

// A mistake that stands in no file: the user's hand made it. The hint says what would be right; it may be empty.
inline InputError refusal(const std::string& message, const std::string& hint = {}) { return {{}, {}, message, hint}; }

}  // namespace achilles
