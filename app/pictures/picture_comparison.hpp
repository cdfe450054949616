// Two PNG files, or two folders of them, compared as in screenshot regression tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/comparison.hpp"

namespace achilles {

// One picture on both sides, or on one side only.
struct ComparedPicture {
    std::string name;        // path in the folders; "" for two files
    ImageDistance distance;  // infinite if the sizes differ or one picture is missing
    std::string mismatch;    // "only in 'after'", "840 x 560 and 420 x 280 pixels"; "" if the pixels were compared
    bool is_same(double threshold) const { return distance.score() <= threshold; }
};

struct PictureComparison {
    std::string before, after;
    bool are_folders = false;
    std::vector<ComparedPicture> pictures;  // ordered by name
};

// Compares two PNG files, or all PNG files in two folders and in their folders, by name. Throws InputError if the paths
// are a file and a folder, or if there is nothing to compare; std::runtime_error if a file cannot be read.
PictureComparison compare_pictures(const std::string& before, const std::string& after);

// The difference of one compared pair as PNG bytes. A missing picture has no pixels.
std::string difference_png(const PictureComparison& comparison, const ComparedPicture& picture);

// Whether no picture differs by more than the threshold. The unit of the difference is the limit of the golden tests.
bool is_same(const PictureComparison& comparison, double threshold);

// The answer in a sentence; for folders followed by a line for every picture that differs, the worst first.
std::string comparison_text(const PictureComparison& comparison, double threshold);
std::string comparison_json(const PictureComparison& comparison, double threshold);

}  // namespace achilles
