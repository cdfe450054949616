#include "paint/paint.hpp"

#include <gtest/gtest.h>

#include "figure/axes.hpp"
#include "render/samples.hpp"
#include "render/support.hpp"

namespace achilles {
namespace {

constexpr Color black{0, 0, 0, 255};

// Bounding box of all pixels that are not white: left, top, right, bottom; right and bottom are one past the last
// pixel.
std::array<int, 4> inked(const Image& image) {
    std::array<int, 4> box{image.width, image.height, 0, 0};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (support::darkness(image, x, y) > 0)
                box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x + 1), std::max(box[3], y + 1)};
    return box;
}

TEST(Label, DotsTakeNoWidth) {
    Offscreen surface(support::options());
    surface.step([] {
        EXPECT_EQ(label_width("\u03b8\u0307\u2081", 14.0F), label_width("\u03b8\u2081", 14.0F));
        EXPECT_EQ(label_width("q\u0308", 14.0F), label_width("q", 14.0F));
        EXPECT_EQ(label_width("", 14.0F), 0.0F);
        EXPECT_GT(label_width("ww", 14.0F), label_width("w", 14.0F));
        EXPECT_GT(label_width("\xff\xce", 14.0F), 0.0F);  // invalid UTF-8 does no harm
    });
}

TEST(Label, TheWidthIsTheOneThatIsPainted) {
    Offscreen surface(support::options());
    for (const float size : {10.0F, 14.0F, 15.0F, 31.0F}) {
        float promised = 0.0F, painted = 0.0F;
        const Image image = support::picture(surface, [&](ImDrawList* list) {
            promised = label_width("H\u03b8\u0307\u2081 [\u00b0/s] H", size);
            painted = paint_label(list, 50.0F, 50.0F, "H\u03b8\u0307\u2081 [\u00b0/s] H", black, size);
        });
        EXPECT_EQ(promised, painted);
        const auto box = inked(image);
        EXPECT_NEAR(box[2] - box[0], promised, 0.25F * size);
        EXPECT_GE(static_cast<float>(box[1]), 50.0F - 0.2F * size);  // the dot may extend slightly
        EXPECT_LE(static_cast<float>(box[3]), 50.0F + size);
    }
}

TEST(Label, AnUprightLabelIsTheTurnedOne) {
    Offscreen surface(support::options());
    const Image flat =
        support::picture(surface, [](ImDrawList* list) { paint_label(list, 50, 50, "q\u0308 [m]", black, 14); });
    const Image turned =
        support::picture(surface, [](ImDrawList* list) { paint_label(list, 50, 300, "q\u0308 [m]", black, 14, 90); });
    const auto a = inked(flat), b = inked(turned);
    EXPECT_NEAR(a[2] - a[0], b[3] - b[1], 1);
    EXPECT_NEAR(a[3] - a[1], b[2] - b[0], 1);
    EXPECT_LE(b[3], 300);
}

TEST(Paint, LeavesAMarginAtEverySize) {
    for (const double scale : {0.7, 1.0, 1.6, 2.0})
        for (const int panels : {1, 2, 6}) {
            Offscreen surface(support::options(900, 600, scale));
            const Image image = surface.frame([&] {
                paint(samples::figure(panels), ImGui::GetBackgroundDrawList(), {0, 0, 900, 600}, scale);
            });
            const auto box = inked(image);
            EXPECT_GE(box[0], 3) << panels << " panels at scale " << scale;
            EXPECT_GE(box[1], 3);
            EXPECT_LE(box[2], 897);
            EXPECT_LE(box[3], 597);
            EXPECT_GT(box[2] - box[0], 800);
        }
}

TEST(Paint, SurvivesFiguresThatMakeNoSense) {
    Offscreen surface(support::options(300, 200));
    Figure nothing, empty = samples::figure(2), narrow = samples::figure(6);
    nothing.columns = 0;
    empty.panels[0].x.low = empty.panels[0].x.high = 1.0;
    empty.panels[1].y.low = std::numeric_limits<double>::quiet_NaN();
    for (const Figure& figure : {nothing, empty, narrow})
        for (const float size : {0.0F, 5.0F, 60.0F, 300.0F})
            surface.frame([&] {
                paint(figure, ImGui::GetBackgroundDrawList(), {0, 0, size, size});
                if (!figure.panels.empty())
                    paint(figure.panels[0], figure, ImGui::GetBackgroundDrawList(), Rectangle{0, 0, size, size});
            });
}

TEST(Paint, TellsWhereThePlotAreaIs) {
    Offscreen surface(support::options());
    surface.step([] {
        const Figure figure = samples::figure(2);
        const Rectangle area{20, 10, 500, 300};
        const Rectangle plot = paint(figure.panels[1], figure, ImGui::GetBackgroundDrawList(), area);
        EXPECT_GT(plot.x, area.x);
        EXPECT_LT(plot.x + plot.width, area.x + area.width);
        EXPECT_LT(plot.y + plot.height, area.y + area.height);
        // 4 by 3 units with equal axes.
        EXPECT_NEAR(plot.width / plot.height, 4.0F / 3.0F, 0.01F);
    });
}

TEST(Paint, MapsDataToPixelsAndBack) {
    for (const Panel& panel : {samples::bouncing(), samples::decay()}) {
        const PanelMap map(panel, {10, 20, 300, 200});
        EXPECT_NEAR(map({panel.x.low, panel.y.low}).y, 220.0, 1e-9);
        EXPECT_NEAR(map({panel.x.high, panel.y.high}).x, 310.0, 1e-9);
        EXPECT_NEAR(map.data(map({2.0, 0.01})).y, 0.01, 1e-9);
    }
}

// Each of these changes must be detected.
TEST(Paint, ChangesAreNoticed) {
    Offscreen surface(support::options(900, 600));
    const auto draw = [&](const Figure& figure) {
        return surface.frame([&] { paint(figure, ImGui::GetBackgroundDrawList(), {0, 0, 900, 600}); });
    };
    const Figure figure = samples::figure(2);
    const Image truth = draw(figure);
    EXPECT_EQ(worst_tile(truth, draw(figure)), 0.0);
    Figure lie = figure;
    lie.panels[0].markers[1].points.erase(lie.panels[0].markers[1].points.begin());
    EXPECT_GT(worst_tile(truth, draw(lie)), worst_tile_allowed);
    lie = figure;
    lie.panels[0].curves[0].stroke.color = {60, 90, 130, 255};
    EXPECT_GT(worst_tile(truth, draw(lie)), worst_tile_allowed);
    lie = figure;
    for (Point& p : lie.panels[0].curves[0].points) p.y += 0.01;
    EXPECT_GT(worst_tile(truth, draw(lie)), worst_tile_allowed);
    lie = figure;
    // A letter. A subscript alone scores 0.0049; the comparison of the figure's text detects it.
    lie.panels[1].x.label = "\u03c6\u2081 [\u00b0]";
    EXPECT_GT(worst_tile(truth, draw(lie)), worst_tile_allowed);
}

TEST(Mechanism, IsPlacedInTheMiddleWithEqualAxes) {
    const Placement placement = place(samples::mechanism(), {100, 50, 400, 400});
    EXPECT_DOUBLE_EQ(placement.unit, 100.0);
    const Point middle = placement.pixel({0.0, 0.0});
    EXPECT_DOUBLE_EQ(middle.x, 300.0);
    EXPECT_DOUBLE_EQ(middle.y, 250.0);
    EXPECT_DOUBLE_EQ(placement.world(placement.pixel({0.3, -0.7})).y, -0.7);
}

TEST(Mechanism, SurvivesShapesThatMakeNoSense) {
    Offscreen surface(support::options(300, 200));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Drawing drawing = samples::mechanism();
    for (DrawnShape shape : samples::mechanism().shapes) {
        shape.radius = nan;
        drawing.shapes.push_back(shape);
        shape.radius = 1e30;
        drawing.shapes.push_back(shape);
        shape.points.front() = {nan, 1.0};
        drawing.shapes.push_back(shape);
        shape.points.assign(3, {1.0, 1.0});
        drawing.shapes.push_back(shape);
        shape.points.clear();
        drawing.shapes.push_back(shape);
    }
    DrawnShape comb;
    for (int i = 0; i < 5000; ++i) comb.points.push_back({-1.0 + i * 4e-4, i % 2 == 0 ? 0.0 : 1.0});
    comb.closed = comb.fill = true;
    drawing.shapes.push_back(comb);
    for (const double low : {-2.0, 2.0, nan, -1e300}) {
        drawing.x_low = low;
        surface.frame([&] { paint(drawing, ImGui::GetBackgroundDrawList(), {0, 0, 300, 200}); });
    }
}

TEST(Mechanism, FillsAPolygonWithADent) {
    Offscreen surface(support::options());
    Drawing drawing;
    DrawnShape arrow;
    arrow.points = {{-0.9, -0.9}, {0.0, 0.0}, {0.9, -0.9}, {0.0, 0.9}};
    arrow.closed = arrow.fill = true;
    arrow.fill_color = black;
    arrow.stroke.width = 0.0;
    drawing.shapes = {arrow};
    for (int turn = 0; turn < 2; ++turn) {
        const Image image = support::picture(surface, [&](ImDrawList* list) {
            paint(drawing, list, {0, 0, 400, 400});
        });
        EXPECT_EQ(support::darkness(image, 200, 150), 255);
        EXPECT_EQ(support::darkness(image, 200, 300), 0);
        std::reverse(drawing.shapes[0].points.begin(), drawing.shapes[0].points.end());
    }
}

// Every point of a circle inside the picture is within 0.02 pixels of a chord, also in pictures so large that most of a
// circle of 2000 pixels is visible.
TEST(Outline, OfADiscFollowsTheCircleWhereItIsVisible) {
    for (const auto& [width, height] :
         {std::pair(300.0F, 200.0F), std::pair(1920.0F, 1080.0F), std::pair(16384.0F, 16384.0F)})
        for (const double radius : {20.0, 1999.0, 2001.0, 9000.0, 1e6})
            for (const Point center : {Point{0.5 * width, 0.5 * height}, Point{0.5 * width, 0.9 * height + radius}}) {
                DrawnShape disc;
                disc.kind = DrawnShape::Kind::disc;
                disc.points = {{0.0, 0.0}};
                disc.radius = radius;
                const std::vector<Point> corners =
                    outline(disc, {center.x, center.y, 1.0}, Rectangle{0.0F, 0.0F, width, height});
                double largest = 0.0;
                for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
                    const Point a = corners[i], b = corners[i + 1], m{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
                    const double off = radius - std::hypot(m.x - center.x, m.y - center.y);
                    // The point of the circle above the middle of the chord.
                    const double s = radius / (radius - off), x = center.x + s * (m.x - center.x),
                                 y = center.y + s * (m.y - center.y);
                    if (x >= 0.0 && x <= width && y >= 0.0 && y <= height) largest = std::max(largest, off);
                }
                EXPECT_LT(largest, 0.0201) << width << " " << radius << " " << center.y;
            }
}

}  // namespace
}  // namespace achilles
