#include "figure/sides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/model.hpp"

namespace achilles {

namespace {

Point projected(const State& state, const std::array<std::size_t, 2>& pair) {
    return {state.q[static_cast<Eigen::Index>(pair[0])], state.q[static_cast<Eigen::Index>(pair[1])]};
}

// The unit vector out of what is solid, in the plane; none where the gap does not change there.
Point away(const PlaneFunction& gap, const Point& p, double step) {
    const double x = gap({p.x + step, p.y}) - gap({p.x - step, p.y}),
                 y = gap({p.x, p.y + step}) - gap({p.x, p.y - step});
    const double length = std::hypot(x, y);
    return length > 0.0 && std::isfinite(length) ? Point{x / length, y / length} : Point{};
}

}  // namespace

Sides::Sides(const Trajectory& trajectory, std::span<const Sample> samples)
    : trajectory_(trajectory), samples_(samples) {
    const auto& coordinates = trajectory.model->description().coordinates;
    const auto is = [&](std::size_t i, const char* name) { return coordinates[i].name == name; };
    exist_ = coordinates.size() == 3 && is(0, "x") && is(1, "y") && is(2, "z");
}

std::array<Sides::Side, 2> Sides::all() { return {Side{"x", {0, 2}}, Side{"y", {1, 2}}}; }

std::array<Drawing, 2> Sides::limits() const {
    std::array<Drawing, 2> found;
    double width = 0.0, height = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
        constexpr double nothing = std::numeric_limits<double>::infinity();
        Drawing& d = found[side];
        d.x_low = d.y_low = nothing, d.x_high = d.y_high = -nothing;
        for (const Sample& sample : samples_) {
            const Point p = projected(sample.state, all()[side].pair);
            d.x_low = std::min(d.x_low, p.x), d.x_high = std::max(d.x_high, p.x);
            d.y_low = std::min(d.y_low, p.y), d.y_high = std::max(d.y_high, p.y);
        }
        width = std::max(width, d.x_high - d.x_low), height = std::max(height, d.y_high - d.y_low);
    }
    constexpr double room = 0.12;
    const double size = std::max(width, height) > 0.0 ? std::max(width, height) : 1.0;
    for (Drawing& d : found) {
        const double x = 0.5 * (d.x_low + d.x_high), y = 0.5 * (d.y_low + d.y_high);
        d.x_low = x - 0.5 * width - room * size, d.x_high = x + 0.5 * width + room * size;
        d.y_low = y - 0.5 * height - room * size, d.y_high = y + 0.5 * height + room * size;
        d.size = size;
    }
    return found;
}

Drawing Sides::draw(std::size_t side, const Sample& now, const Drawing& seen, const Theme& theme, bool with_way) const {
    const auto pair = all()[side].pair;
    const Model& model = *trajectory_.model;
    const Point here = projected(now.state, pair);
    const double radius = 0.02 * seen.size;
    Drawing drawing = seen;
    drawing.shapes.clear();
    Point rests{};
    for (std::size_t contact = 0; contact < model.contacts(); ++contact) {
        auto program = model.evaluator(model.gap(contact), trajectory_.run.parameters);
        State state = now.state;
        state.t = now.t;
        set_state(program, state);
        const PlaneFunction gap = [program, pair](const Point& p) mutable {
            program.input(pair[0]) = p.x;
            program.input(pair[1]) = p.y;
            program.run();
            return program.output(0);
        };
        const Field field(seen, [&](const Point& p) { return -gap(p); });
        Shape& ground = drawing.shapes.emplace_back();
        ground.kind = Shape::Kind::area;
        ground.fill_color = theme.ground;
        constexpr double end = std::numeric_limits<double>::quiet_NaN();
        for (const std::vector<Point>& part : field.not_negative()) {
            ground.points.insert(ground.points.end(), part.begin(), part.end());
            ground.points.push_back({end, end});
        }
        Shape& line = drawing.shapes.emplace_back();
        line.points = field.zero_line();
        const bool is_held = now.held.contains(contact);
        line.stroke.color = is_held ? phase_color(theme, Phase::Kind::constrained) : theme.surface;
        line.stroke.width = is_held ? 2.75 : 2.0;
        const Point out = away(gap, here, 1e-6 * seen.size);
        rests.x += radius * out.x, rests.y += radius * out.y;
    }
    if (model.contacts() > 1) rests = {};
    Shape& disc = drawing.shapes.emplace_back();
    disc.kind = Shape::Kind::disc;
    disc.moves = disc.fill = true;
    disc.points = {{here.x + rests.x, here.y + rests.y}};
    disc.radius = radius;
    disc.stroke.width = 0.0;
    disc.fill_color = theme.body;
    if (!with_way) return drawing;
    // Every frame asks for it: of a run of very many steps the samples will do.
    constexpr std::size_t most_steps = 2000;
    std::vector<WayPoint> way;
    if (trajectory_.pieces.size() <= most_steps)
        way = way_of(trajectory_, trajectory_.run.options.start_time, trajectory_.end_time, seen,
                     [&](const Sample& sample) { return projected(sample.state, pair); });
    else
        for (const Sample& sample : samples_) way.push_back({sample.t, sample.phase, projected(sample.state, pair)});
    add_present(way, {now.t, now.phase, here});
    add_way(drawing.shapes, way, now.t, theme);
    return drawing;
}

}  // namespace achilles
