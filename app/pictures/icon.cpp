#include "pictures/icon.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "cli/assets.hpp"
#include "cli/overrides.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

// The layout. Lengths are fractions of the icon's width, from its lower left corner.
struct IconLayout {
    double margin = 0.03, corner = 0.2;            // of the card; the margin is a whole number of pixels
    double floor = 0.2, radius = 0.1;              // of the ball
    double left = 0.14, right = 0.83, top = 0.83;  // of the path of the ball's center
    double stroke = 0.04, thinnest = 1.15;         // of the path; in pixels at least
    Color card{22, 50, 79, 255}, ground{126, 152, 178, 255};
    Color path{255, 255, 255, 255}, ball{230, 159, 0, 255};
};
constexpr IconLayout icon_layout;

// A square with round corners.
DrawnShape icon_card(double margin) {
    DrawnShape shape;
    shape.stroke.width = 0.0;
    shape.kind = DrawnShape::Kind::polyline;
    shape.closed = shape.fill = true;
    shape.fill_color = icon_layout.card;
    constexpr int steps = 24;  // of a corner
    for (int quarter = 0; quarter < 4; ++quarter) {
        const double inner = margin + icon_layout.corner;
        const double x = quarter == 0 || quarter == 3 ? 1.0 - inner : inner, y = quarter < 2 ? 1.0 - inner : inner;
        for (int i = 0; i <= steps; ++i) {
            const double angle = (quarter + double{1} * i / steps) * std::numbers::pi / 2.0;
            shape.points.push_back(
                {x + icon_layout.corner * std::cos(angle), y + icon_layout.corner * std::sin(angle)});
        }
    }
    return shape;
}

DrawnShape icon_line(std::vector<Point> points, Color color, double width) {
    DrawnShape shape;
    shape.points = std::move(points);
    shape.stroke.color = color;
    shape.stroke.width = width;
    return shape;
}

// The height of a ball on the floor over time, until it rests.
std::vector<Point> icon_path() {
    const auto model = std::make_shared<const Model>(read_system(find_system("ball_on_floor")));
    const Run run = requested_run(model->description(), {"e=0.74", "r=0", "y=1"}, {});
    const Trajectory trajectory = simulate(model, run);
    const double end = trajectory.end_time;
    constexpr double low = icon_layout.floor + icon_layout.radius;  // of the center of the ball at rest
    constexpr int samples = 1500;
    std::vector<Point> points;
    for (const Sample& sample : samples_at(trajectory, equidistant(samples, 0.0, end)))
        points.push_back({icon_layout.left + (icon_layout.right - icon_layout.left) * sample.t / end,
                          low + (icon_layout.top - low) * sample.state.q[1]});
    return points;
}

}  // namespace

Drawing icon(int pixels) {
    const double width = std::max(icon_layout.thinnest, icon_layout.stroke * pixels);
    Drawing world;
    world.x_low = world.y_low = 0.0;
    world.x_high = world.y_high = 1.0;
    world.size = 1.0;
    const std::vector<Point> path = icon_path();
    DrawnShape ball;
    ball.kind = DrawnShape::Kind::disc;
    ball.points = {path.back()};
    ball.radius = icon_layout.radius;
    ball.stroke.width = 0.0;
    ball.fill = true;
    ball.fill_color = icon_layout.ball;
    // The painter softens an edge by half a pixel on both sides.
    const double margin = (std::round(icon_layout.margin * pixels) + 0.5) / pixels, edge = icon_layout.margin + 0.07;
    world.shapes = {
        icon_card(margin),
        icon_line({{edge, icon_layout.floor}, {1.0 - edge, icon_layout.floor}}, icon_layout.ground, 0.7 * width),
        icon_line(path, icon_layout.path, width), ball};
    return world;
}

}  // namespace achilles
