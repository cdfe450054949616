// Falsified figures: what a comparison of pixels must notice. A lie is told on the sheet, so the real pipeline draws
// it.
#pragma once

#include <string>
#include <vector>

#include "figure/layout.hpp"
#include "surface/offscreen.hpp"

namespace achilles::golden {

struct Lie {
    enum class Kind { moved_right, moved_up, other_hue, thicker, no_marker, other_digit };
    Kind kind = Kind::moved_right;
    std::size_t item = 0;    // of the sheet
    std::size_t letter = 0;  // of a label
};

std::string to_text(const Lie& lie, const Sheet& truth);

// Every lie of these kinds that can be told about a sheet and that shows: of every curve that is more than a point,
// every marker that stands alone, every digit.
std::vector<Lie> lies_about(const Sheet& truth);

Sheet told(const Lie& lie, Sheet sheet);

// The golden figure of one system of the gallery, and an easel to draw it on as `achilles figure` does.
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
