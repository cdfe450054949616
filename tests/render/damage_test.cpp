// Frames of which only the changed part is drawn: the part is small, and the pixels are those of the whole frame.
#include "surface/damage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "render/support.hpp"
#include "surface/interface.hpp"

namespace achilles {
namespace {

using Draw = std::function<void(ImDrawList*)>;

constexpr ImU32 red = IM_COL32(200, 0, 0, 255), haze = IM_COL32(0, 0, 200, 90);

std::vector<Point> wave(double phase, double width = 560.0) {
    std::vector<Point> points;
    for (int i = 0; i <= 400; ++i)
        points.push_back({20.0 + width * i / 400.0, 200.3 + 90.0 * std::sin(i * 0.05 + phase)});
    return points;
}

// The differences between two frames of 600 x 400 pixels.
std::vector<PixelArea> differences(const std::function<void()>& first, const std::function<void()>& second) {
    Interface interface(support::options());
    const Interface::Active active(interface);
    apply(Input{});
    const DrawnFrame before(interface.frame(first, 600, 400, 1.0 / 60.0));
    return DrawnFrame(interface.frame(second, 600, 400, 1.0 / 60.0)).differences(before, 600, 400);
}

std::function<void()> on_background(const Draw& draw) {
    return [draw] { draw(ImGui::GetBackgroundDrawList()); };
}

bool covers(const std::vector<PixelArea>& areas, int x, int y) {
    for (const PixelArea& a : areas)
        if (x >= a.x && y >= a.y && x < a.x + a.width && y < a.y + a.height) return true;
    return false;
}

long pixels(const std::vector<PixelArea>& areas) {
    long sum = 0;
    for (const PixelArea& area : areas) sum += long{area.width} * area.height;
    return sum;
}

TEST(Damage, EqualFramesDifferNowhere) {
    const auto draw = on_background([](ImDrawList* list) {
        list->AddRectFilled({10, 10}, {90, 90}, red);
        add_curve(list, wave(0.0), {{0, 0, 0, 255}, 2.0, {}});
        list->AddText({50, 50}, haze, "words");
    });
    EXPECT_TRUE(differences(draw, draw).empty());
}

// Both places of something that moves, and hardly more.
TEST(Damage, IsWhereSomethingMoved) {
    const auto with_square_at = [](float x) {
        return on_background([x](ImDrawList* list) {
            list->AddRectFilled({0, 0}, {600, 400}, IM_COL32_WHITE);
            list->AddText({50, 20}, red, "before");
            list->AddRectFilled({x, 100}, {x + 20, 120}, red);
            list->AddText({50, 300}, red, "after");
        });
    };
    const auto areas = differences(with_square_at(100), with_square_at(300));
    EXPECT_TRUE(covers(areas, 110, 110));
    EXPECT_TRUE(covers(areas, 310, 110));
    EXPECT_FALSE(covers(areas, 200, 110));
    EXPECT_FALSE(covers(areas, 60, 25));
    EXPECT_LT(pixels(areas), 3 * 22 * 22);
}

TEST(Damage, KnowsCurvesTilesAndClipRectangles) {
    const auto curve = [](double phase) {
        return on_background([phase](ImDrawList* list) {
            add_curve(list, wave(phase, 100.0), {{0, 0, 0, 255}, 2.0, {}});
            list->AddRectFilled({500, 300}, {510, 310}, red);
        });
    };
    const auto of_curve = differences(curve(0.0), curve(0.1));
    EXPECT_TRUE(covers(of_curve, 70, 200));
    EXPECT_FALSE(covers(of_curve, 505, 305));
    const auto tiles = [](std::uint8_t shade) {
        return on_background([shade](ImDrawList* list) {
            add_tiles(list, {300.0F, 50.0F, 40.0F, 30.0F}, {2, 1, {Color{shade, 0, 0, 255}, Color{0, shade, 0, 255}}});
        });
    };
    const auto of_tiles = differences(tiles(10), tiles(11));
    EXPECT_TRUE(covers(of_tiles, 320, 60));
    EXPECT_FALSE(covers(of_tiles, 200, 60));
    const auto clipped = [](float right) {
        return on_background([right](ImDrawList* list) {
            list->PushClipRect({0, 0}, {right, 400});
            list->AddRectFilled({10, 10}, {200, 30}, red);
            list->PopClipRect();
        });
    };
    EXPECT_TRUE(covers(differences(clipped(100), clipped(150)), 120, 20));
}

// A window that appears, such as a tooltip, and one that disappears.
TEST(Damage, IsWhereAWindowAppearsOrDisappears) {
    const auto window = [](bool is_there) {
        return [is_there] {
            ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, {600, 400}, IM_COL32_WHITE);
            ImGui::GetForegroundDrawList()->AddRectFilled({400, 300}, {410, 310}, red);
            if (!is_there) return;
            ImGui::SetNextWindowPos({100, 100});
            ImGui::SetNextWindowSize({80, 60});
            ImGui::Begin("tip", nullptr, ImGuiWindowFlags_NoDecoration);
            ImGui::End();
        };
    };
    Interface interface(support::options());
    const Interface::Active active(interface);
    apply(Input{});
    std::vector<DrawnFrame> frames;
    for (const bool is_there : {false, true, true, true, false})
        frames.emplace_back(interface.frame(window(is_there), 600, 400, 1.0 / 60.0));
    for (const auto& [before, after] : {std::pair{0, 3}, {3, 4}}) {
        const auto areas =
            frames[static_cast<std::size_t>(after)].differences(frames[static_cast<std::size_t>(before)], 600, 400);
        EXPECT_TRUE(covers(areas, 140, 130)) << after;
        EXPECT_FALSE(covers(areas, 405, 305)) << after;
        EXPECT_LT(pixels(areas), 10000) << after;
    }
}

TEST(Damage, AreasDoNotOverlapAndAreFew) {
    const auto squares = [](float by) {
        return on_background([by](ImDrawList* list) {
            for (int i = 0; i < 60; ++i) {
                const float x = static_cast<float>(37 * i % 560), y = static_cast<float>(53 * i % 360);
                list->PushClipRect({x, y}, {x + 40, y + 40});
                list->AddRectFilled({x + by, y}, {x + by + 9, y + 9}, red);
                list->PopClipRect();
            }
        });
    };
    const auto areas = differences(squares(0), squares(3));
    EXPECT_LE(areas.size(), 12U);
    ASSERT_GT(areas.size(), 0U);
    for (std::size_t i = 0; i < areas.size(); ++i)
        for (std::size_t k = i + 1; k < areas.size(); ++k) {
            const PixelArea both = common(areas[i], areas[k]);
            EXPECT_TRUE(both.width <= 0 || both.height <= 0) << i << " " << k;
        }
}

// A scene of translucent shapes, letters, curves and tiles that lie over one another.
void draw_scene(ImDrawList* list, unsigned seed, unsigned changed) {
    std::mt19937 random(seed), other(seed + 1000U * changed + 1U);
    for (unsigned i = 0; i < 40; ++i) {
        std::mt19937& from = i % 10 == changed ? other : random;
        const auto number = [&](float most) {
            if (&from != &random) random();  // the scenes differ in these shapes alone
            return most * static_cast<float>(from()) / static_cast<float>(std::mt19937::max());
        };
        const float x = number(560), y = number(360), size = 5.0F + number(120);
        const auto shade = static_cast<std::uint8_t>(number(255));
        const ImU32 color = IM_COL32(shade, 90, 255 - shade, 120);
        if (i % 4 == 0) list->AddRectFilled({x, y}, {x + size, y + size}, color, 5.0F);
        if (i % 4 == 1) list->AddText({std::floor(x), std::floor(y)}, color, "letters and numbers 0123");
        if (i % 4 == 2)
            add_curve(list, {{x, y}, {x + 1.3 * size, y + 30.0}, {x, y + size}}, {{shade, 0, 0, 130}, 2.5, {7.0, 4.0}});
        if (i % 4 == 3) list->AddCircle({x, y}, size, color, 24, 1.5F);
    }
}

TEST(Damage, APictureAfterAnotherIsThatOfAFreshSurface) {
    for (const bool is_fine : {false, true}) {
        SurfaceOptions options = support::options();
        options.curve_fineness = is_fine ? 2 : 1;
        Offscreen used(options);
        for (unsigned seed = 0; seed < 6; ++seed)
            for (unsigned changed = 0; changed < 4; ++changed) {
                const auto draw = [&](ImDrawList* list) { draw_scene(list, seed, changed); };
                Offscreen fresh(options);
                ASSERT_EQ(support::picture(used, draw), support::picture(fresh, draw)) << seed << " " << changed;
            }
    }
}

// Of a long edge only the part near what moves is drawn. The distances from it are those of the whole picture to the
// last digit: rounded otherwise, a few pixels would get another shade.
TEST(Damage, APartOfALongEdgeHasThePixelsOfTheWhole) {
    const SurfaceOptions options = support::options(1500, 1500);
    std::vector<Point> edges;
    for (int i = 0; i < 40; ++i) {
        edges.push_back({20.3 + 13.875 * i, 11.7 + 19.5 * i});
        edges.push_back({1482.1 - 13.875 * i, 1486.6 - 16.5 * i});
        edges.push_back(gap_point());
    }
    const auto draw_with_bar_at = [&](float x) {
        return [&edges, x](ImDrawList* list) {
            add_curve(list, edges, {{0, 0, 0, 255}, 1.3, {}});
            list->AddRectFilled({x, 0.0F}, {x + 150.0F, 1500.0F}, haze);
        };
    };
    Offscreen used(options), fresh(options);
    support::picture(used, draw_with_bar_at(225.0F));
    EXPECT_TRUE(support::picture(used, draw_with_bar_at(1125.0F)) ==
                support::picture(fresh, draw_with_bar_at(1125.0F)));
}

// A large opaque rectangle is not drawn as triangles. It has the pixels whose centers are inside, and keeps its place
// between what is drawn before and after it.
TEST(Damage, ALargeRectangleHasThePixelsOfTriangles) {
    Offscreen surface(support::options());
    const double x_low = 10.3, x_high = 190.5, y_low = 20.5, y_high = 70.49;
    const Image image = support::picture(surface, [&](ImDrawList* list) {
        const auto rectangle = [list](double left, double top, double right, double bottom, ImU32 color) {
            list->AddRectFilled({static_cast<float>(left), static_cast<float>(top)},
                                {static_cast<float>(right), static_cast<float>(bottom)}, color);
        };
        rectangle(30.0, 30.0, 40.0, 40.0, IM_COL32(0, 200, 0, 255));  // below it
        rectangle(x_low, y_low, x_high, y_high, red);
        rectangle(100.0, 30.0, 110.0, 40.0, IM_COL32(0, 200, 0, 255));    // above it
        rectangle(300.0, 100.0, 500.0, 200.0, IM_COL32(200, 0, 0, 128));  // translucent, so it is blended
        list->PushClipRect({20, 220}, {60, 300}, true);
        rectangle(0.0, 200.0, 400.0, 400.0, red);
        list->PopClipRect();
    });
    const auto color = [&](int x, int y) {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * 600 + static_cast<std::size_t>(x));
        return std::array<int, 3>{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
    };
    const std::array<int, 3> filled{200, 0, 0}, green{0, 200, 0}, white{255, 255, 255};
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 220; ++x) {
            const bool is_above = x >= 100 && x < 110 && y >= 30 && y < 40;
            const bool is_inside = x + 0.5 >= x_low && x + 0.5 < x_high && y + 0.5 >= y_low && y + 0.5 < y_high;
            ASSERT_EQ(color(x, y), is_above ? green : is_inside ? filled : white) << x << " " << y;
        }
    EXPECT_EQ(color(400, 150)[1], 127);
    for (int y = 205; y < 400; y += 5)
        for (int x = 5; x < 100; x += 5)
            ASSERT_EQ(color(x, y), x >= 20 && x < 60 && y >= 220 && y < 300 ? filled : white) << x << " " << y;
}

// Another background, another size of the letters: everything is drawn.
TEST(Damage, AnotherStyleIsDrawnEverywhere) {
    Offscreen used(support::options()), fresh(support::options());
    const auto draw = [](ImDrawList* list) { list->AddText({50, 50}, red, "words"); };
    const Image first = support::picture(used, draw);
    used.restyle(2.0, false);
    support::picture(used, draw);
    used.restyle(1.0, false);
    EXPECT_EQ(support::picture(used, draw), first);
    EXPECT_EQ(support::picture(fresh, draw), first);
}

}  // namespace
}  // namespace achilles
