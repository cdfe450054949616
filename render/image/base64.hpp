// Bytes as letters, 6 bits in each (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace achilles {

std::string base64(std::string_view bytes);

}  // namespace achilles
