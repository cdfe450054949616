// The icon: the files in assets/icons are what the program draws, in every size.
#include "pictures/icon.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/program.hpp"
#include "image/comparison.hpp"

namespace achilles::test {
namespace {

const std::filesystem::path icon_files = ACHILLES_SOURCE_DIR "/assets/icons";

TEST(Icon, TheFilesAreWhatTheProgramDraws) {
    const Folder folder;
    ASSERT_EQ(folder.run("icon --out drawn").status, 0);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(icon_files)) {
        EXPECT_TRUE(std::filesystem::exists(folder.path() / "drawn" / entry.path().filename())) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, std::size(icon_sizes) + 1);
    for (const int size : icon_sizes) {
        const std::string name = std::to_string(size) + ".png";
        const Image kept = read_png(icon_files / name), drawn = read_png(folder.path() / "drawn" / name);
        EXPECT_EQ(kept.width, size);
        EXPECT_EQ(kept.height, size);
        EXPECT_LE(distance(kept, drawn).score(), 1.0) << name << ": run achilles icon --out assets/icons";
    }
    EXPECT_EQ(content(icon_files / "achilles.svg"), content(folder.path() / "drawn/achilles.svg"));
}

// A card with round corners, the ball at rest at the right, the path above it.
TEST(Icon, IsTransparentOutsideAndHasTheBallAtRest) {
    for (const int size : icon_sizes) {
        const Image image = read_png(icon_files / (std::to_string(size) + ".png"));
        const auto at = [&](double x, double y) {
            return static_cast<std::size_t>((1.0 - y) * size) * static_cast<std::size_t>(size) +
                   static_cast<std::size_t>(x * size);
        };
        ASSERT_FALSE(image.alpha.empty()) << size;
        EXPECT_LT(image.alpha[0], 64) << size;  // at 16 pixels the corner has a trace of the card
        EXPECT_EQ(image.alpha[at(0.5, 0.5)], 255) << size;
        const std::size_t ball = 3 * at(0.83, 0.3), card = 3 * at(0.75, 0.75);
        EXPECT_GT(image.rgb[ball], 180) << size;
        EXPECT_LT(image.rgb[ball + 2], 80) << size;
        EXPECT_LT(image.rgb[card], 80) << size;
        bool has_white = false;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3) has_white |= image.rgb[i + 2] > 190;
        EXPECT_TRUE(has_white) << size;
    }
}

TEST(DesktopEntry, IsValidAndNamesTheIcon) {
    const std::string file = ACHILLES_SOURCE_DIR "/app/release/achilles.desktop";
    EXPECT_NE(content(file).find("\nIcon=achilles\n"), std::string::npos);
    EXPECT_NE(content(file).find("\nStartupWMClass=achilles\n"), std::string::npos);
    if (std::system("command -v desktop-file-validate >/dev/null") != 0)
        GTEST_SKIP() << "desktop-file-utils is missing";
    EXPECT_EQ(std::system(("desktop-file-validate '" + file + "'").c_str()), 0);
}

}  // namespace
}  // namespace achilles::test
