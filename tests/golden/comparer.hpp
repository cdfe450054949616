// Distance of a picture or a text from its golden file.
#pragma once

#include <string>
#include <string_view>

#include "image/image.hpp"

namespace achilles::golden {

struct Distance {
    double coarse = 0.0, fine = 0.0;  // defined in tolerance.hpp; infinite for images of different size
    int left = 0, top = 0;            // of the worst fine tile, pixels
    // The larger of both in units of its limit: above 1 the pictures differ.
    double score() const;
};
Distance distance(const Image& a, const Image& b);

// The difference times ten, on black; black where the sizes differ.
Image difference(const Image& a, const Image& b);

// The first lines in which two texts differ: golden ones after "-", actual ones after "+". Numbers may differ by the
// limits of tolerance.hpp. Empty if there is no difference.
std::string difference(std::string_view golden, std::string_view actual);

}  // namespace achilles::golden
