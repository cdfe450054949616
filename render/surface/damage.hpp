// Which part of the picture differs from the frame before. A software renderer takes some 60 ms for a whole window, but
// a pointer that moves changes little of it. Drawn again are only the parts that differ; their pixels are those that
// the whole frame would have.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "surface/curves.hpp"

struct ImDrawCmd;
struct ImDrawData;
struct ImDrawList;

namespace achilles {

// A copy of what one frame draws, as far as it is needed to compare it with the next.
class DrawnFrame {
 public:
    DrawnFrame() = default;
    explicit DrawnFrame(const ImDrawData& data);

    // Areas without overlap, inside a target of this size, outside of which both frames have the same pixels. Empty:
    // they are the same everywhere. Frames whose windows lie above one another in another order differ everywhere.
    std::vector<PixelArea> differences(const DrawnFrame& before, int width, int height) const;

    struct DrawnCommand {
        std::array<float, 4> clip{};  // as in the command
        PixelArea inside, area;       // the pixels inside `clip`, and those of them that the command can change
        unsigned texture = 0;
        enum class Kind { triangles, curve, tiles, other } kind = Kind::triangles;
        // The vertices of triangles in the order of their indices, or the content of a curve or of tiles.
        std::vector<unsigned char> content;
    };
    struct DrawnList {
        std::string name;
        std::vector<DrawnCommand> commands;
    };
    // In the order of the draw lists and of their commands.
    const std::vector<DrawnList>& lists() const { return lists_; }

 private:
    std::vector<DrawnList> lists_;
};

}  // namespace achilles
