// Pictures of runs with several contacts and of moving surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/systems.hpp"
#include "figure/compose.hpp"
#include "figure/field.hpp"
#include "figure/layout.hpp"
#include "figure/lens.hpp"
#include "figure/plane.hpp"
#include "figure/publication.hpp"

namespace achilles {
namespace {

// A reference system, simulated once.
const Trajectory& run_of(const std::string& name) {
    static std::map<std::string, Trajectory> known;
    const auto found = known.find(name);
    if (found != known.end()) return found->second;
    const auto model =
        std::make_shared<const Model>(read_system(test::source_file("tests/reference/gaps/" + name + ".toml")));
    return known.emplace(name, simulate(model, model->default_run())).first->second;
}

Panel panel_of(const Trajectory& trajectory, const std::string& x, const std::string& y, bool for_print = true) {
    ViewDescription view;
    view.x.text = x;
    view.y.push_back({y, {}});
    Framing framing;
    framing.for_print = for_print;
    return compose(trajectory, plot_samples(trajectory), PreparedView(*trajectory.model, view), light_theme(), framing);
}

const Color held = phase_color(light_theme(), Phase::Kind::constrained),
            struck = phase_color(light_theme(), Phase::Kind::hybrid);

TEST(TimeBars, AreFilledWhileAContactIsHeldAndTickedAtItsImpacts) {
    const Trajectory& trajectory = run_of("pendulum_two_stops");
    const Panel panel = panel_of(trajectory, "t", "th2");
    ASSERT_EQ(panel.time_bars.size(), 2u);
    const TimeBar &knee = panel.time_bars[0], &wall = panel.time_bars[1];
    EXPECT_EQ(knee.label, "knee");
    EXPECT_EQ(wall.label, "wall");
    std::vector<TimeBar::TimeMark> filled;
    for (const TimeBar::TimeMark& mark : knee.marks)
        if (mark.high > mark.low) filled.push_back(mark);
    ASSERT_EQ(filled.size(), 2u);  // Zeno points, opening and release of the reference
    EXPECT_NEAR(filled[0].low, 4.850414795914218, 1e-8);
    EXPECT_NEAR(filled[0].high, 6.648636034206552, 1e-8);
    EXPECT_NEAR(filled[1].low, 10.476602100186066, 1e-8);
    EXPECT_NEAR(filled[1].high, 12.670936299916242, 1e-8);
    EXPECT_EQ(filled[0].color, held);
    const auto opening = [](const TimeBar::TimeMark& mark) {
        return mark.low == mark.high && std::abs(mark.low - 6.648636034206552) < 1e-8 && mark.color == struck;
    };
    EXPECT_TRUE(std::any_of(wall.marks.begin(), wall.marks.end(), opening));
    EXPECT_FALSE(std::any_of(knee.marks.begin(), knee.marks.end(), opening));
    EXPECT_TRUE(std::none_of(wall.marks.begin(), wall.marks.end(),
                             [](const TimeBar::TimeMark& mark) { return mark.high > mark.low; }));
    // A bouncing sequence is not drawn as ticks too dense to be distinguished.
    for (std::size_t i = 1; i < wall.marks.size(); ++i)
        EXPECT_GT(wall.marks[i].low - wall.marks[i - 1].low, (panel.x.high - panel.x.low) / 5000.0);
}

TEST(TimeBars, AreUnderPlotsOverTimeOfSeveralContactsAlone) {
    EXPECT_TRUE(panel_of(run_of("pendulum_two_stops"), "th1", "th2").time_bars.empty());
    const Panel one = panel_of(run_of("travelling_wave"), "t", "y");
    EXPECT_TRUE(one.time_bars.empty());
    EXPECT_EQ(one.markers.size(), 3u);
}

TEST(Plots, OverTimeBeginWhereTheRunDoes) {
    const auto model = test::load("ball_on_floor");
    auto run = model->default_run();
    run.options.start_time = -2.0;
    run.options.end_time = 1.0;
    const Panel panel = panel_of(simulate(model, run), "t", "y");
    EXPECT_EQ(panel.x.low, -2.0);
    EXPECT_EQ(panel.x.high, 1.0);
}

// The fills of a color in a sheet, from left to right.
std::vector<Rectangle> fills(const Sheet& sheet, const Color& color) {
    std::vector<Rectangle> found;
    for (const auto& item : sheet)
        if (const Fill* fill = std::get_if<Fill>(&item))
            if (fill->color == color) found.push_back(fill->area);
    return found;
}

TEST(TimeBars, StandBetweenThePlotAndTheNumbersOfItsAxis) {
    const Panel panel = panel_of(run_of("pendulum_two_stops"), "t", "th2");
    Panel without = panel;
    without.time_bars.clear();
    Figure style;
    const auto width = [](const std::string& label, float size) {
        return 0.6F * size * static_cast<float>(label.size());
    };
    for (const Rectangle area : {Rectangle{10, 20, 600, 300}, Rectangle{10, 20, 300, 120}}) {
        Sheet sheet, plain;
        const Rectangle plot = layout(panel, style, width, area, 1.0, sheet);
        const Rectangle before = layout(without, style, width, area, 1.0, plain);
        const float bottom = before.y + before.height;
        EXPECT_LT(plot.y + plot.height, bottom);
        EXPECT_GE(plot.height, 0.55F * before.height);
        const std::vector<Rectangle> bars = fills(sheet, held);
        ASSERT_EQ(bars.size(), 2u);
        for (const Rectangle& bar : bars) {
            EXPECT_GT(bar.y, plot.y + plot.height);
            EXPECT_LT(bar.y + bar.height, bottom);
        }
        const double unit = double{plot.width} / (panel.x.high - panel.x.low);
        EXPECT_NEAR(bars[0].x, plot.x + unit * 4.850414795914218, 1.0);
        EXPECT_NEAR(bars[0].width, unit * (6.648636034206552 - 4.850414795914218), 1.5);
        const auto named = [](const std::string& name) {
            return [name](const auto& item) {
                const TextRun* text = std::get_if<TextRun>(&item);
                return text != nullptr && text->label == name;
            };
        };
        const auto name = std::find_if(sheet.begin(), sheet.end(), named("knee"));
        ASSERT_NE(name, sheet.end());
        EXPECT_LT(std::get<TextRun>(*name).x, plot.x);
        EXPECT_EQ(std::get<TextRun>(*name).anchor, 1.0F);
        // The labels are where they are without bars.
        const auto number = std::find_if(sheet.begin(), sheet.end(), named("10"));
        const auto same = std::find_if(plain.begin(), plain.end(), named("10"));
        ASSERT_TRUE(number != sheet.end() && same != plain.end());
        EXPECT_EQ(std::get<TextRun>(*number).y, std::get<TextRun>(*same).y);
    }
}

// Sixteen bars leave space for the plot.
TEST(TimeBars, TakeLessThanHalfOfAPanel) {
    Panel panel = panel_of(run_of("pendulum_two_stops"), "t", "th2");
    panel.time_bars.resize(16, panel.time_bars.front());
    Sheet sheet;
    const auto width = [](const std::string& label, float size) {
        return 0.6F * size * static_cast<float>(label.size());
    };
    const Rectangle plot = layout(panel, Figure(), width, {0, 0, 400, 160}, 1.0, sheet);
    EXPECT_GT(plot.height, 0.5F * (160.0F - 60.0F));
    for (const Rectangle& bar : fills(sheet, held)) EXPECT_LE(bar.y + bar.height, 160.0F);
}

TEST(Openings, AreHollowTrianglesAboveTheImpact) {
    const Trajectory& trajectory = run_of("pendulum_two_stops");
    const Panel panel = panel_of(trajectory, "t", "th2");
    ASSERT_EQ(panel.markers.size(), 4u);
    const Markers& opened = panel.markers[3];
    EXPECT_EQ(opened.shape, Markers::MarkerShape::triangle);
    EXPECT_EQ(opened.fill, light_theme().background);
    EXPECT_EQ(opened.edge, event_markers(light_theme(), Event::Kind::release).fill);
    EXPECT_GT(opened.lift, 0.0);
    ASSERT_EQ(opened.points.size(), 1u);
    EXPECT_NEAR(opened.points[0].x, 6.648636034206552, 1e-8);
    const ViewDescription& view = trajectory.model->description().views.front();
    const Figure figure = publication(trajectory, {&view, 1}, {});
    std::vector<std::string> keys;
    for (const Key& key : figure.keys) keys.push_back(key.label);
    EXPECT_EQ(keys, (std::vector<std::string>{"in flight: no contact held",
                                              "in contact: the bars name the contacts held", "impact",
                                              "Zeno point, \U0001D70F_{\u221E}", "release", "opened by an impact"}));
    EXPECT_EQ(publication(run_of("travelling_wave"), {&run_of("travelling_wave").model->description().views[0], 1}, {})
                  .keys[0]
                  .label,
              "in flight");
}

TEST(Boundaries, OfSeveralGapsAreDrawnWhereNoOtherIsNegative) {
    const Trajectory& trajectory = run_of("ball_in_box");
    const Panel panel = panel_of(trajectory, "x", "y");
    const auto floor = [](const Point& p) { return p.y - p.x * p.x / 4.0; };
    const auto left = [](const Point& p) { return p.x + 0.3 * p.y + 1.0; };
    const auto right = [](const Point& p) { return 1.2 - p.x + 0.3 * p.y; };
    std::array<int, 3> count{};
    for (const Point& p : panel.boundary.points) {
        if (std::isnan(p.x)) continue;
        const std::array<double, 3> gaps{floor(p), left(p), right(p)};
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_GT(gaps[i], -0.02) << p.x << " " << p.y;
            count[i] += std::abs(gaps[i]) < 1e-3 ? 1 : 0;
        }
    }
    EXPECT_GT(count[0], 100);
    EXPECT_GT(count[1], 10);
    EXPECT_EQ(count[2], 0);  // it meets the floor outside the panel, and would be below it
}

TEST(Boundaries, ThatMoveAreDrawnAsTheyAreAtAnInstant) {
    const Trajectory& trajectory = run_of("travelling_wave");
    EXPECT_TRUE(has_moving_gap(*trajectory.model));
    EXPECT_FALSE(has_moving_gap(*run_of("ball_in_box").model));
    EXPECT_TRUE(panel_of(trajectory, "x", "y").boundary.points.empty());
    ViewDescription view;
    view.x.text = "x";
    view.y.push_back({"y", {}});
    const PreparedView prepared(*trajectory.model, view);
    const auto samples = plot_samples(trajectory);
    const Panel panel = compose(trajectory, samples, prepared, light_theme());
    for (const double t : {0.0, 2.0}) {
        int points = 0;
        for (const Point& p : boundary(trajectory, samples, prepared, panel, t)) {
            if (std::isnan(p.x)) continue;
            EXPECT_NEAR(p.y, 0.25 * std::sin(p.x - 1.1 * t) + 0.1 * p.x * p.x, 2e-3);
            ++points;
        }
        EXPECT_GT(points, 100);
    }
}

// Two equal gaps must not remove each other's line.
TEST(Boundaries, OfGapsThatAreTheSameAreThere) {
    Drawing limits;
    const PlaneFunction circle = [](const Point& p) { return p.x * p.x + p.y * p.y - 0.25; };
    const std::array<PlaneFunction, 1> once{circle};
    const std::array<PlaneFunction, 2> twice{circle, [&](const Point& p) { return 3.0 * circle(p); }};
    EXPECT_EQ(border(limits, twice).size(), 2 * border(limits, once).size());
}

// Every row is even, and its arcs have the height of their limit, also while another contact is held and on a moving
// surface.
TEST(ZenoLens, LooksAtTheContactThatBounces) {
    int rows = 0, with_others = 0;
    for (const std::string name : {"bowl_and_post", "pendulum_two_stops", "ball_in_box", "travelling_wave"}) {
        const Trajectory& trajectory = run_of(name);
        for (std::size_t i = 0; i < trajectory.events.size(); ++i) {
            const Event& event = trajectory.events[i];
            const auto lens = Lens::at(trajectory, i);
            if (event.kind != Event::Kind::zeno) {
                EXPECT_FALSE(lens);
                continue;
            }
            ASSERT_TRUE(lens) << name << i;
            ++rows;
            with_others += event.mode.held().count() > 1 ? 1 : 0;
            const Panel panel = lens->panel(lens->cut() - 1.0, lens->cut() + 1.0, light_theme());
            const auto& impacts = panel.markers[0].points;
            for (std::size_t k = 1; k < impacts.size(); ++k)
                EXPECT_NEAR(impacts[k].x - impacts[k - 1].x, lens->spacing(), 1e-2) << name << i;
            double own = 0.0, limit = 0.0;
            for (const Point& point : panel.curves[0].points)
                if (point.x > lens->cut() - 0.7) own = std::max(own, point.y);
            for (const Point& point : panel.curves[1].points) limit = std::max(limit, point.y);
            EXPECT_NEAR(own, limit, 2e-2 * limit) << name << i;
        }
    }
    EXPECT_GE(rows, 7);
    EXPECT_GE(with_others, 1);
}

}  // namespace
}  // namespace achilles
