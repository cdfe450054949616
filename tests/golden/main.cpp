// Runs the golden tests. With --bless [PICTURE...] replaces the golden files of these pictures, or of all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "golden/pictures.hpp"

namespace achilles::golden {

namespace {

int bless_all(const std::vector<std::string>& names) {
    const std::vector<GoldenPicture> all = pictures();
    for (const std::string& name : names) {
        if (std::any_of(all.begin(), all.end(), [&](const GoldenPicture& picture) { return picture.name == name; }))
            continue;
        std::string known;
        for (const GoldenPicture& picture : all) known += "\n  " + picture.name;
        fmt::print(stderr, "there is no picture '{}'; they are:{}\n", name, known);
        return 2;
    }
    std::size_t changed = 0;
    for (const GoldenPicture& picture : all) {
        if (!names.empty() && std::find(names.begin(), names.end(), picture.name) == names.end()) continue;
        const std::vector<std::string> sentences = bless(picture, place());
        for (const std::string& sentence : sentences) fmt::print("{}", sentence);
        std::fflush(stdout);
        changed += sentences.size();
    }
    for (const std::filesystem::path& file : orphans(all, place())) {
        if (!names.empty()) break;
        std::filesystem::remove(file);
        fmt::print("{}: removed, it belonged to no picture\n", file.string());
        ++changed;
    }
    fmt::print("{} golden files changed\n", changed);
    return 0;
}

}  // namespace

}  // namespace achilles::golden

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "--bless") {
        try {
            return achilles::golden::bless_all({argv + 2, argv + argc});
        } catch (const std::exception& error) {
            fmt::print(stderr, "{}\n", error.what());
            return 2;
        }
    }
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
