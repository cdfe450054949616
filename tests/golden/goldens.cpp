#include "golden/goldens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>

#include "golden/comparer.hpp"
#include "golden/report.hpp"
#include "image/comparison.hpp"

namespace achilles::golden {

namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const Layer& layer, const fs::path& file) {
    fs::create_directories(file.parent_path());
    if (const auto* image = std::get_if<Image>(&layer.content)) return write_png(*image, file);
    std::ofstream stream(file, std::ios::binary);
    stream << std::get<std::string>(layer.content);
    stream.close();
    if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

// The golden file as a layer; nullopt if it is missing.
std::optional<Layer> golden_of(const Layer& made, const fs::path& folder) {
    const fs::path file = folder / made.file;
    if (!fs::exists(file)) return {};
    if (std::holds_alternative<Image>(made.content)) return Layer{made.file, read_png(file)};
    return Layer{made.file, content(file)};
}

std::string told(const ImageDistance& distance, const Image& golden, const Image& made) {
    if (golden.width != made.width || golden.height != made.height)
        return fmt::format("{} x {} pixels, not {} x {}\n", made.width, made.height, golden.width, golden.height);
    return fmt::format("{:.3g} times what is allowed, worst at ({}, {}); coarse {:.4f}, fine {:.4f}\n",
                       distance.score(), distance.left, distance.top, distance.coarse, distance.fine);
}

// Result of the comparison of a picture.
struct Comparison {
    std::vector<Layer> made, golden;
    std::vector<Finding> findings;
    double score = 0.0;  // of its worst image
};

Comparison compare(const GoldenPicture& picture, const GoldenFolders& place) {
    Comparison result{picture.make(), {}, {}, 0.0};
    const fs::path folder = place.goldens / picture.name;
    std::set<std::string> known;
    for (const Layer& layer : result.made) {
        known.insert(layer.file);
        const std::optional<Layer> golden = golden_of(layer, folder);
        if (!golden) {
            result.findings.push_back({layer.file, "there is no golden file yet\n"});
            result.score = std::numeric_limits<double>::infinity();
            continue;
        }
        result.golden.push_back(*golden);
        if (const auto* image = std::get_if<Image>(&layer.content)) {
            const auto& before = std::get<Image>(golden->content);
            const ImageDistance apart = distance(before, *image);
            result.score = std::max(result.score, apart.score());
            if (apart.score() > 1.0) result.findings.push_back({layer.file, told(apart, before, *image)});
        } else {
            const std::string what =
                difference(std::get<std::string>(golden->content), std::get<std::string>(layer.content));
            if (!what.empty()) result.findings.push_back({layer.file, what});
        }
    }
    if (fs::exists(folder))
        for (const auto& entry : fs::directory_iterator(folder))
            if (const std::string file = entry.path().filename(); !known.contains(file))
                result.findings.push_back({file, "nothing makes this any more\n"});
    return result;
}

// Writes the new file, the golden file and ten times the difference.
void write_failure(const Comparison& comparison, const fs::path& folder) {
    const auto variant = [&](const std::string& file, const std::string& kind) {
        const fs::path path(file);
        return folder / (path.stem().string() + "." + kind + path.extension().string());
    };
    for (const Layer& made : comparison.made) {
        write(made, variant(made.file, "actual"));
        for (const Layer& golden : comparison.golden) {
            if (golden.file != made.file) continue;
            write(golden, variant(made.file, "golden"));
            if (const auto* image = std::get_if<Image>(&made.content))
                write_png(difference(std::get<Image>(golden.content), *image), variant(made.file, "difference"));
        }
    }
}

}  // namespace

GoldenFolders place() { return {ACHILLES_SOURCE_DIR "/tests/golden", ACHILLES_BINARY_DIR "/golden"}; }

std::vector<Finding> check(const GoldenPicture& picture, const GoldenFolders& place) {
    const Comparison comparison = compare(picture, place);
    const fs::path folder = place.report / picture.name;
    if (comparison.findings.empty() && !fs::exists(folder)) return {};
    const ReportLock lock(place.report);
    fs::remove_all(folder);
    if (!comparison.findings.empty()) {
        write_failure(comparison, folder);
        write_entry(folder, picture.name, comparison.score, comparison.findings);
    }
    write_page(place.report);
    return comparison.findings;
}

std::vector<fs::path> orphans(const std::vector<GoldenPicture>& pictures, const GoldenFolders& place) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(place.goldens)) {
        const std::string kind = entry.path().extension();
        const std::string folder = fs::relative(entry.path().parent_path(), place.goldens);
        // Skips the source files in this folder, and journals, which are inputs of pictures.
        if (!entry.is_regular_file() || folder == "." || (kind != ".png" && kind != ".txt")) continue;
        if (std::none_of(pictures.begin(), pictures.end(),
                         [&](const GoldenPicture& one) { return one.name == folder; }))
            found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<std::string> bless(const GoldenPicture& picture, const GoldenFolders& place) {
    const Comparison comparison = compare(picture, place);
    std::vector<std::string> sentences;
    for (const Finding& finding : comparison.findings) {
        const fs::path file = place.goldens / picture.name / finding.file;
        const auto made = std::find_if(comparison.made.begin(), comparison.made.end(),
                                       [&](const Layer& layer) { return layer.file == finding.file; });
        sentences.push_back(fmt::format("{}/{}: {}", picture.name, finding.file, finding.what));
        if (made == comparison.made.end())
            fs::remove(file);
        else
            write(*made, file);
    }
    return sentences;
}

}  // namespace achilles::golden
