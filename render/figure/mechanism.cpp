#include "figure/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace achilles {

namespace {

using Kind = DrawingDescription::Shape;

constexpr int curve_points = 400;

Color color_of(const std::string& text, const Color& otherwise) {
    if (text.empty()) return otherwise;
    const auto part = [&](std::size_t at) {
        return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
    };
    return {part(1), part(3), part(5), 255};
}

struct Box {
    double x_low = std::numeric_limits<double>::infinity(), x_high = -x_low, y_low = x_low, y_high = -x_low;
    void include(const Point& p, double radius = 0.0) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
        x_low = std::min(x_low, p.x - radius);
        x_high = std::max(x_high, p.x + radius);
        y_low = std::min(y_low, p.y - radius);
        y_high = std::max(y_high, p.y + radius);
    }
    bool empty() const { return x_low > x_high; }
};

}  // namespace

Mechanism::Mechanism(const Model& model) : model_(model) {
    const SystemDescription& description = model.description();
    std::vector<std::uint32_t> coordinates;
    for (const DrawingDescription& drawing : description.drawings) {
        Item item;
        item.description = drawing;
        std::vector<Text> texts;
        for (const auto& point : drawing.points) texts.insert(texts.end(), point.begin(), point.end());
        if (drawing.shape == Kind::disc) texts.push_back(drawing.radius);
        if (drawing.shape == Kind::curve)
            texts.insert(texts.end(), drawing.over_limits.begin(), drawing.over_limits.end());
        if (!drawing.width.text.empty()) texts.push_back(drawing.width);
        item.program = model.compile_drawing(texts, drawing.over);
        item.moves = drawing.shape != Kind::curve && drawing.shape != Kind::text;
        items_.push_back(std::move(item));
    }
    const auto named = [&](std::size_t i, const char* name) {
        return description.coordinates.size() == 2 && description.coordinates[i].name == name;
    };
    plane_ = items_.empty() && named(0, "x") && named(1, "y");
}

std::vector<Point> Mechanism::points(const Item& item, const State& state, std::span<const double> parameters) const {
    Evaluator<double> run = model_.evaluator(item.program, parameters);
    put(run, state);
    std::vector<Point> result;
    if (item.description.shape != Kind::curve) {
        run.run();
        for (std::size_t i = 0; i < item.description.points.size(); ++i)
            result.push_back({run.output(2 * i), run.output(2 * i + 1)});
        return result;
    }
    run.run();
    const double low = run.output(2), high = run.output(3);
    for (int i = 0; i <= curve_points; ++i) {
        run.input(model_.layout().own()) = low + (high - low) * i / curve_points;
        run.run();
        result.push_back({run.output(0), run.output(1)});
    }
    return result;
}

// The zero line of the gap over the window, by marching squares: segments, separated by NaN points.
std::vector<Point> Mechanism::zero_line(std::span<const double> parameters, const Drawing& limits) const {
    constexpr int columns = 160, rows = 120;
    Evaluator<double> gap = model_.evaluator(model_.gap(), parameters);
    const auto place = [&](int i, int j) {
        return Point{limits.x_low + (limits.x_high - limits.x_low) * i / columns,
                     limits.y_low + (limits.y_high - limits.y_low) * j / rows};
    };
    std::vector<double> h(static_cast<std::size_t>((columns + 1) * (rows + 1)));
    const auto index = [&](int i, int j) { return static_cast<std::size_t>(j * (columns + 1) + i); };
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const Point p = place(i, j);
            gap.input(0) = p.x;
            gap.input(1) = p.y;
            gap.run();
            h[index(i, j)] = gap.output(0);
        }
    }
    std::vector<Point> line;
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int corner[5][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}, {i, j}};
            std::vector<Point> crossings;
            for (int k = 0; k < 4; ++k) {
                const double a = h[index(corner[k][0], corner[k][1])], b = h[index(corner[k + 1][0], corner[k + 1][1])];
                if (!((a < 0.0) != (b < 0.0)) || !std::isfinite(a) || !std::isfinite(b)) continue;
                const Point p = place(corner[k][0], corner[k][1]), q = place(corner[k + 1][0], corner[k + 1][1]);
                const double s = a / (a - b);
                crossings.push_back({p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)});
            }
            if (crossings.size() < 2) continue;
            line.insert(line.end(), {crossings[0], crossings[1], {nothing, nothing}});
        }
    }
    return line;
}

Drawing Mechanism::draw(const State& state, std::span<const double> parameters, const Drawing& limits,
                        const Theme& theme) const {
    Drawing drawing = limits;
    drawing.shapes.clear();
    const auto add = [&](Shape::Kind kind, const Color& color, double width) -> Shape& {
        Shape& shape = drawing.shapes.emplace_back();
        shape.kind = kind;
        shape.stroke.color = shape.fill_color = color;
        shape.stroke.width = width;
        return shape;
    };
    for (const Item& item : items_) {
        const DrawingDescription& d = item.description;
        const Color color = color_of(d.color, item.moves ? theme.body : theme.surface);
        Evaluator<double> run = model_.evaluator(item.program, parameters);
        put(run, state);
        run.run();
        const double width = d.width.text.empty() ? 2.0 : run.output(run.output_count() - 1);
        const Shape::Kind kind = d.shape == Kind::disc   ? Shape::Kind::disc
                                 : d.shape == Kind::text ? Shape::Kind::text
                                                         : Shape::Kind::polyline;
        Shape& shape = add(kind, color, width);
        shape.points = points(item, state, parameters);
        shape.fill = d.fill;
        shape.closed = d.fill && d.shape == Kind::polyline;
        shape.text = d.text;
        if (d.shape == Kind::disc) shape.radius = run.output(2);
    }
    if (plane_) {
        add(Shape::Kind::polyline, theme.surface, 2.0).points = zero_line(parameters, limits);
        Shape& disc = add(Shape::Kind::disc, theme.body, 0.0);
        disc.points = {{state.q[0], state.q[1]}};
        disc.radius = 0.012 * (limits.x_high - limits.x_low + limits.y_high - limits.y_low);
        disc.fill = true;
    } else if (items_.empty()) {
        Shape& note = add(Shape::Kind::text, theme.surface, 1.0);
        note.points = {{0.5 * (limits.x_low + limits.x_high), 0.5 * (limits.y_low + limits.y_high)}};
        note.text = "this system has no [[drawing]]";
    }
    return drawing;
}

Drawing Mechanism::limits(const Trajectory& trajectory, std::span<const Sample> samples) const {
    const auto& parameters = trajectory.run.parameters;
    Box box;
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / 300);
    for (std::size_t i = 0; i < samples.size(); i += stride) {
        const State& state = samples[i].state;
        if (plane_) box.include({state.q[0], state.q[1]});
        for (const Item& item : items_) {
            if (!item.moves) continue;
            for (const Point& point : points(item, state, parameters)) box.include(point, 0.05);
        }
    }
    if (box.empty()) box.include({0.0, 0.0}, 1.0);
    // A curve, the surface mostly, counts where the motion is above it.
    Box all = box;
    for (const Item& item : items_) {
        if (item.description.shape != Kind::curve) continue;
        for (const Point& point : points(item, {trajectory.run.q, trajectory.run.v}, parameters))
            if (point.x >= box.x_low && point.x <= box.x_high && point.y >= box.y_low - (box.y_high - box.y_low) &&
                point.y <= box.y_high + (box.y_high - box.y_low))
                all.include(point);
    }
    const double room = 0.06 * std::max({all.x_high - all.x_low, all.y_high - all.y_low, 0.2});
    Drawing drawing;
    drawing.x_low = all.x_low - room;
    drawing.x_high = all.x_high + room;
    drawing.y_low = all.y_low - room;
    drawing.y_high = all.y_high + room;
    return drawing;
}

}  // namespace achilles
