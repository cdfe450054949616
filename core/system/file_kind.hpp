// What a file holds that is no system file: a picture, a result, another encoding.
#pragma once

#include <string>
#include <string_view>

#include "system/description.hpp"

namespace achilles {

// Throws InputError, about `name`, where the first bytes show that a text is no TOML: a picture, an archive, JSON, a table,
// UTF-16, a program in another language, nothing at all.
void refuse_other_files(std::string_view text, const std::string& name);

}  // namespace achilles
