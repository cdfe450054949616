// Output to a terminal. Titles, names and messages may come from untrusted files or pictures, so control characters are
// replaced.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

#include "system/input_error.hpp"

namespace achilles {

// Prints printable() of the formatted text.
template <class... Arguments>
void print_clean(std::FILE* where, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    const std::string text = printable(fmt::format(format, std::forward<Arguments>(arguments)...));
    std::fwrite(text.data(), 1, text.size(), where);
}

}  // namespace achilles
