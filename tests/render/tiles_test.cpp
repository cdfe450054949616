// Cells as they are painted, and as a picture inside an SVG.
#include <gtest/gtest.h>

#include "image/notes.hpp"
#include "paint/paint.hpp"
#include "paint/svg.hpp"
#include "render/support.hpp"

namespace achilles {
namespace {

constexpr Color red{200, 10, 20, 255}, green{0, 158, 115, 255}, blue{0, 0, 255, 255}, clear{0, 0, 0, 0};

Tiles tiles() {
    auto cells = std::make_shared<Cells>(Cells{2, 2, {red, green, blue, clear}});
    return {{100, 50, 200, 300}, {0, 0, 260, 400}, std::move(cells)};
}

Color at(const Image& image, int x, int y) {
    const std::uint8_t* rgb = &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                              static_cast<std::size_t>(x))];
    return {rgb[0], rgb[1], rgb[2], 255};
}

// Exact to the pixel, inside the clip rectangle, with strokes below and above.
TEST(TilesPainted, AreRectanglesOfTheirColors) {
    constexpr Color white{255, 255, 255, 255}, black{0, 0, 0, 255};
    Offscreen surface(support::options());
    const auto draw = [&](const Sheet& sheet) {
        return support::picture(surface, [&](ImDrawList* list) { paint(sheet, list); });
    };
    const Sheet sheet{Path{{{0, 60.5}, {500, 60.5}}, {black, 3.0, {}}, {0, 0, 600, 400}}, tiles(),
                      Path{{{0, 250.5}, {500, 250.5}}, {black, 3.0, {}}, {0, 0, 600, 400}},
                      Fill{{400, 300, 20, 20}, green}};
    const Image image = draw(sheet);
    EXPECT_EQ(at(image, 100, 50), red);
    EXPECT_EQ(at(image, 99, 50), white);
    EXPECT_EQ(at(image, 199, 199), red);
    EXPECT_EQ(at(image, 200, 199), green);
    EXPECT_EQ(at(image, 199, 200), blue);
    EXPECT_EQ(at(image, 259, 100), green);
    EXPECT_EQ(at(image, 260, 100), white) << "outside the clip";
    EXPECT_EQ(at(image, 220, 300), white) << "what is clear";
    EXPECT_EQ(at(image, 150, 60), red) << "over the first stroke";
    EXPECT_EQ(at(image, 150, 250), black) << "under the second";
    EXPECT_EQ(at(image, 410, 310), green) << "what follows is drawn as ever";
    EXPECT_EQ(draw(sheet), image);
}

TEST(TilesPainted, MayBeMany) {
    Offscreen surface(support::options(700, 700));
    auto cells = std::make_shared<Cells>(Cells{600, 600, std::vector<Color>(360000, red)});
    cells->colors[600 * 599 + 599] = blue;
    const Sheet sheet{Tiles{{0, 0, 600, 600}, {0, 0, 700, 700}, std::move(cells)}, Fill{{650, 650, 10, 10}, green}};
    const Image image = support::picture(surface, [&](ImDrawList* list) { paint(sheet, list); });
    EXPECT_EQ(at(image, 599, 599), blue);
    EXPECT_EQ(at(image, 598, 599), red);
    EXPECT_EQ(at(image, 655, 655), green);
}

TEST(TilesInSvg, AreAnEmbeddedPicture) {
    Figure figure;
    Panel panel;
    panel.raster = {tiles().cells, 0.0, 1.0, 0.0, 1.0};
    figure.panels.push_back(panel);
    const std::string text = svg(figure, {400, 300, 1.0}, ACHILLES_BINARY_DIR "/assets/fonts", {});
    EXPECT_NE(text.find("xmlns:xlink"), std::string::npos);
    EXPECT_NE(text.find("xlink:href=\"data:image/png;base64,iVBOR"), std::string::npos);
    figure.panels[0].raster = {};
    EXPECT_EQ(svg(figure, {400, 300, 1.0}, ACHILLES_BINARY_DIR "/assets/fonts", {}).find("xlink"), std::string::npos);
}

TEST(Base64, IsThatOfRFC4648) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace achilles
