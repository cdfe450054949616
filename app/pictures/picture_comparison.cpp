#include "pictures/picture_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "output/json_parts.hpp"
#include "output/output.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr double infinitely_different = std::numeric_limits<double>::infinity();

std::vector<std::string> png_names(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".png")
            names.push_back(entry.path().lexically_relative(folder).generic_string());
    return names;
}

ComparedPicture compare_files(const std::string& name, const fs::path& before, const fs::path& after) {
    const Image a = read_png(before), b = read_png(after);
    ComparedPicture result{name, distance(a, b), {}};
    if (a.width != b.width || a.height != b.height)
        result.mismatch = fmt::format("{} x {} and {} x {} pixels", a.width, a.height, b.width, b.height);
    return result;
}

// "difference 7.84, threshold 1, worst in the 10-pixel tile at (30, 40)".
std::string measured(const ComparedPicture& picture, double threshold) {
    if (!picture.mismatch.empty()) return picture.mismatch;
    const ImageDistance& apart = picture.distance;
    const double score = apart.score();
    // Enough digits to show on which side of the threshold the difference is.
    std::string number = fmt::format("{:.3g}", score);
    if ((std::stod(number) > threshold) != (score > threshold)) number = fmt::format("{:.17g}", score);
    const std::string sentence = fmt::format("difference {}, threshold {:g}", number, threshold);
    if (score == 0.0) return sentence;
    return fmt::format("{}, worst in the {}-pixel tile at ({}, {})", sentence, apart.tile, apart.left, apart.top);
}

std::vector<ComparedPicture> worst_first(std::vector<ComparedPicture> pictures) {
    std::stable_sort(pictures.begin(), pictures.end(), [](const ComparedPicture& a, const ComparedPicture& b) {
        return a.distance.score() > b.distance.score();
    });
    return pictures;
}

}  // namespace

PictureComparison compare_pictures(const std::string& before, const std::string& after) {
    PictureComparison result{before, after, fs::is_directory(before), {}};
    if (fs::is_directory(after) != result.are_folders && fs::exists(before) && fs::exists(after))
        throw InputError(result.are_folders ? after : before, {}, "this is a file, but the other path is a folder",
                         "write two files, or two folders");
    if (!result.are_folders) {
        result.pictures.push_back(compare_files("", before, after));
        return result;
    }
    std::map<std::string, int> sides;  // 1: before, 2: after, 3: both
    for (const std::string& name : png_names(before)) sides[name] |= 1;
    for (const std::string& name : png_names(after)) sides[name] |= 2;
    if (sides.empty()) throw InputError(before, {}, fmt::format("there is no PNG file in this folder or in {}", after));
    for (const auto& [name, side] : sides) {
        if (side == 3)
            result.pictures.push_back(compare_files(name, fs::path(before) / name, fs::path(after) / name));
        else
            result.pictures.push_back({name,
                                       {infinitely_different, infinitely_different},
                                       fmt::format("only in {}", shown(side == 1 ? before : after))});
    }
    return result;
}

std::string difference_png(const PictureComparison& comparison, const ComparedPicture& picture) {
    const auto read = [&](const fs::path& side) {
        const fs::path file = comparison.are_folders ? side / picture.name : side;
        return comparison.are_folders && !fs::exists(file) ? Image{} : read_png(file);
    };
    return png_bytes(difference(read(comparison.before), read(comparison.after)));
}

bool is_same(const PictureComparison& comparison, double threshold) {
    return std::all_of(comparison.pictures.begin(), comparison.pictures.end(),
                       [&](const ComparedPicture& picture) { return picture.is_same(threshold); });
}

std::string comparison_text(const PictureComparison& comparison, double threshold) {
    const std::vector<ComparedPicture> pictures = worst_first(comparison.pictures);
    const ComparedPicture& worst = pictures.front();
    const std::string both = fmt::format("{} and {}", shown(comparison.before), shown(comparison.after));
    if (!comparison.are_folders)
        return fmt::format("{} {}: {}\n", both, worst.is_same(threshold) ? "are the same" : "differ",
                           measured(worst, threshold));
    if (worst.is_same(threshold))
        return fmt::format("{} have the same {} pictures: largest difference in {}: {}\n", both, pictures.size(),
                           shown(worst.name), measured(worst, threshold));
    const auto differ = [&](const ComparedPicture& picture) { return !picture.is_same(threshold); };
    std::string text = fmt::format("{} differ in {} of {} pictures\n", both,
                                   std::count_if(pictures.begin(), pictures.end(), differ), pictures.size());
    for (const ComparedPicture& picture : pictures)
        if (differ(picture)) text += fmt::format("  {}: {}\n", picture.name, measured(picture, threshold));
    return text;
}

std::string comparison_json(const PictureComparison& comparison, double threshold) {
    Json json = {{"achilles", version()},
                 {"before", comparison.before},
                 {"after", comparison.after},
                 {"threshold", number_json(threshold)},
                 {"same", is_same(comparison, threshold)},
                 {"pictures", Json::array()}};
    for (const ComparedPicture& picture : comparison.pictures) {
        Json one = Json::object();
        if (comparison.are_folders) one["name"] = picture.name;
        one["same"] = picture.is_same(threshold);
        one["difference"] = number_json(picture.distance.score());
        if (picture.mismatch.empty())
            one["worst_tile"] = {
                {"left", picture.distance.left}, {"top", picture.distance.top}, {"size", picture.distance.tile}};
        else
            one["mismatch"] = picture.mismatch;
        json["pictures"].push_back(std::move(one));
    }
    return printable_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace achilles
