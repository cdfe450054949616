// Falsified figures that a comparison of pixels must detect. A lie changes the sheet, so the normal pipeline draws it.
#pragma once

#include <string>
#include <vector>

#include "figure/layout.hpp"
#include "surface/offscreen.hpp"

namespace achilles::golden {

struct FigureMutation {
    enum class Kind { moved_right, moved_up, other_hue, thicker, no_marker, other_digit };
    Kind kind = Kind::moved_right;
    std::size_t item = 0;    // index in the sheet
    std::size_t letter = 0;  // index in a label
};

std::string to_text(const FigureMutation& lie, const Sheet& truth);

// All visible lies about a sheet: about every curve longer than a point, every marker that no other covers, every
// digit.
std::vector<FigureMutation> lies_about(const Sheet& truth);

Sheet told(const FigureMutation& lie, Sheet sheet);

// The golden figure of one gallery system, drawn as by `achilles figure`.
class Easel {
 public:
    explicit Easel(const std::string& system);
    const Sheet& truth() const { return truth_; }
    Image draw(const Sheet& sheet);

 private:
    Offscreen surface_;
    Sheet truth_;
};

}  // namespace achilles::golden
