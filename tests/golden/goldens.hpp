// Golden files: what a picture was when somebody last looked at it and found it right. Every picture has a folder of
// them, a file a layer.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "image/image.hpp"

namespace achilles::golden {

// A file of a picture: a text or an image.
struct Layer {
    std::string file;
    std::variant<std::string, Image> content;
};

struct Picture {
    std::string name;                          // of its folder: "figure/ball_on_sine"
    std::function<std::vector<Layer>()> make;  // in the order in which layers are compared
};

struct Place {
    std::filesystem::path goldens, report;
};
Place place();  // tests/golden, and "golden" in the build tree

// A layer that is not as it was.
struct Finding {
    std::string file, what;
};

// Makes the picture and compares it with its golden files. Where it differs, the report gets what was made, the golden
// files, the difference, and index.html, a page with all pictures that failed; where it does not, the report forgets
// it.
std::vector<Finding> check(const Picture& picture, const Place& place);

// Golden files that belong to no picture.
std::vector<std::filesystem::path> orphans(const std::vector<Picture>& pictures, const Place& place);

// Makes the golden files anew where they differ and removes those that nothing makes. A sentence for every file.
std::vector<std::string> bless(const Picture& picture, const Place& place);

// What a person does about a finding.
inline constexpr const char* how_to_bless = "look at the picture; if it is right: tests/run --bless";

}  // namespace achilles::golden
