// How far a picture or a text is from its golden one.
#pragma once

#include <string>
#include <string_view>

#include "image/image.hpp"

namespace achilles::golden {

struct Distance {
    double coarse = 0.0, fine = 0.0;  // as tolerance.hpp describes them; infinite between images of different size
    int left = 0, top = 0;            // of the worst fine tile, pixels
    // In units of what is allowed: above 1 the pictures differ.
    double score() const;
};
Distance distance(const Image& a, const Image& b);

// The difference ten times as strong, on black; nothing of it where the sizes differ.
Image difference(const Image& a, const Image& b);

// What distinguishes two texts whose numbers may be off by what tolerance.hpp allows: the lines that differ, the golden
// ones after "-", the others after "+", the first of them. Empty: nothing does.
std::string difference(std::string_view golden, std::string_view actual);

}  // namespace achilles::golden
