// Expressions that stand behind an option of a command line.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>

#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

// What `compile` makes of the text; says of what is wrong with it behind which option it stands.
template <class Compile>
auto behind(const char* flag, const std::string& text, const Compile& compile) {
    const Text given{text, {}};
    try {
        return compile(std::span(&given, 1));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{} {}", flag, shown(text)), error.at, error.message, error.hint, text);
    }
}

}  // namespace achilles
