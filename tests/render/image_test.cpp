#include "image/image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "render/support.hpp"

namespace achilles {
namespace {

Image gradient(int width, int height) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int value : {x * 7, y * 5, x + y}) image.rgb.push_back(static_cast<std::uint8_t>(value));
    return image;
}

std::filesystem::path scratch(const std::string& name) { return std::filesystem::path(testing::TempDir()) / name; }

TEST(Image, APngReadsBackAsItWasWritten) {
    const Image image = gradient(61, 47);
    write_png(image, scratch("achilles_round_trip.png"));
    EXPECT_EQ(read_png(scratch("achilles_round_trip.png")), image);
}

TEST(Image, ErrorsNameTheFile) {
    const auto says = [](const auto& action, const std::string& words) {
        try {
            action();
            ADD_FAILURE() << "nothing was thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    says([] { read_png("/nowhere/a.png"); }, "/nowhere/a.png: No such file");
    says([] { write_png(gradient(2, 2), "/nowhere/a.png"); }, "/nowhere/a.png: No such file");
    says([] { write_png(Image{}, scratch("achilles_empty.png")); }, "without pixels");
    std::ofstream(scratch("achilles_no.png")) << "no picture";
    says([] { read_png(scratch("achilles_no.png")); }, "not a readable PNG");
}

TEST(Image, EqualImagesAreAtDistanceZero) { EXPECT_EQ(worst_tile(gradient(100, 80), gradient(100, 80)), 0.0); }

TEST(Image, ImagesOfDifferentSizeAreInfinitelyFarApart) {
    EXPECT_TRUE(std::isinf(worst_tile(gradient(100, 80), gradient(80, 100))));
}

TEST(Image, BlackAndWhiteAreAtDistanceOne) {
    Image dark{60, 60, std::vector<std::uint8_t>(3 * 60 * 60, 0)}, white = dark;
    white.rgb.assign(white.rgb.size(), 255);
    EXPECT_DOUBLE_EQ(worst_tile(dark, white), 1.0);
}

}  // namespace
}  // namespace achilles
