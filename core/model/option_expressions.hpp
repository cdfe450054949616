// Expressions typed as the value of a command-line option.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>

#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

// Calls `compile` on the text. An InputError in the text is rethrown with the option's name and the text in its
// message.
template <class Compile>
auto compile_option(const char* flag, const std::string& text, const Compile& compile) {
    const Text given{text, {}};
    try {
        return compile(std::span(&given, 1));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{} {}", flag, shown(text)), error.at, error.message, error.hint, text);
    }
}

}  // namespace achilles
