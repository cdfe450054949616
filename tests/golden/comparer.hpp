// Difference of a text from its golden file. That of pictures is in render/image/comparison.hpp.
#pragma once

#include <string>
#include <string_view>

namespace achilles::golden {

// The first lines in which two texts differ: golden ones after "-", actual ones after "+". Numbers may differ by the
// limits of tolerance.hpp. Empty if there is no difference.
std::string difference(std::string_view golden, std::string_view actual);

}  // namespace achilles::golden
