// Golden files: the contents of a picture when it was last reviewed. Every picture has a folder with one file per
// layer.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "image/image.hpp"

namespace achilles::golden {

// One file of a picture: a text or an image.
struct Layer {
    std::string file;
    std::variant<std::string, Image> content;
};

struct GoldenPicture {
    std::string name;                          // name of its folder: "figure/ball_on_sine"
    std::function<std::vector<Layer>()> make;  // returns the layers in the order of comparison
};

struct GoldenFolders {
    std::filesystem::path goldens, report;
};
GoldenFolders place();  // goldens in tests/golden, report in "golden" of the build tree

// A layer that differs from its golden file.
struct Finding {
    std::string file, what;
};

// Makes the picture and compares it with its golden files. If it differs, the new files, the golden files and the
// differences are added to the report, whose index.html shows all failed pictures. Otherwise its entry is removed.
std::vector<Finding> check(const GoldenPicture& picture, const GoldenFolders& place);

// Golden files that belong to no picture.
std::vector<std::filesystem::path> orphans(const std::vector<GoldenPicture>& pictures, const GoldenFolders& place);

// Replaces golden files that differ and removes those without a layer. Returns a sentence for every file.
std::vector<std::string> bless(const GoldenPicture& picture, const GoldenFolders& place);

// Advice printed with a finding.
inline constexpr const char* how_to_bless = "look at the picture; if it is right: tests/run --bless";

}  // namespace achilles::golden
