#include "figure/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "expression/parse.hpp"
#include "figure/field.hpp"
#include "figure/parts.hpp"

namespace achilles {

namespace {

constexpr int max_halvings = 56;
constexpr std::size_t max_curve_points = 20000;  // limit for a curve that never ends inside the picture

struct CurveSample {
    double s;
    Point p;
};

// Whether a chord, or the part of the curve between its ends, may be visible: it is within its own length of the
// picture.
bool is_near(const Point& a, const Point& b, const Drawing& seen) {
    const double reach = std::hypot(b.x - a.x, b.y - a.y);
    return std::max(a.x, b.x) + reach >= seen.x_low && std::min(a.x, b.x) - reach <= seen.x_high &&
           std::max(a.y, b.y) + reach >= seen.y_low && std::min(a.y, b.y) - reach <= seen.y_high;
}

double distance_to_line(const Point& p, const Point& a, const Point& b) {
    const double x = b.x - a.x, y = b.y - a.y, length = std::hypot(x, y);
    if (!(length > 0.0)) return std::hypot(p.x - a.x, p.y - a.y);
    return std::abs(x * (p.y - a.y) - y * (p.x - a.x)) / length;
}

class Refiner {
 public:
    Refiner(const ParametricCurve& curve, const Drawing& seen)
        : curve_(curve), seen_(seen), size_(std::hypot(seen.x_high - seen.x_low, seen.y_high - seen.y_low)) {}

    // Adds the points between a and b, including b but not a.
    void add(const CurveSample& a, const CurveSample& b, int halvings) {
        const bool is_short = std::hypot(b.p.x - a.p.x, b.p.y - a.p.y) <= 0.1 * size_;
        if (halvings < max_halvings && points_.size() < max_curve_points && is_near(a.p, b.p, seen_)) {
            const double s = 0.5 * (a.s + b.s);
            const CurveSample middle{s, curve_(s)};
            constexpr double flat = 5e-5;  // of the diagonal: a twentieth of a pixel
            if (s != a.s && s != b.s && !(is_short && distance_to_line(middle.p, a.p, b.p) <= flat * size_)) {
                add(a, middle, halvings + 1);
                return add(middle, b, halvings + 1);
            }
        }
        points_.push_back(b.p);
    }
    std::vector<Point> points_;

 private:
    const ParametricCurve& curve_;
    const Drawing& seen_;
    double size_;
};

}  // namespace

std::vector<Point> refined(const ParametricCurve& curve, double low, double high, int pieces, const Drawing& seen) {
    Refiner refiner(curve, seen);
    CurveSample before{low, curve(low)};
    refiner.points_.push_back(before.p);
    for (int i = 1; i <= pieces; ++i) {
        const double s = low + (high - low) * i / pieces;
        const CurveSample here{s, curve(s)};
        refiner.add(before, here, 0);
        before = here;
    }
    return std::move(refiner.points_);
}

namespace {

using DrawingShape = DrawingDescription::Shape;

constexpr int curve_points = 400;
constexpr double hatch_of_world = 0.022;  // fraction of the world, between hatch strokes of a ground

// Color from text like "#8f96a0", which the file reader has checked.
Color color_of(const std::string& text) {
    const auto part = [&](std::size_t at) {
        return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
    };
    return {part(1), part(3), part(5), 255};
}

struct BoundingBox {
    double x_low = std::numeric_limits<double>::infinity(), x_high = -x_low, y_low = x_low, y_high = -x_low;
    void include(const Point& p, double radius = 0.0) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
        x_low = std::min(x_low, p.x - radius);
        x_high = std::max(x_high, p.x + radius);
        y_low = std::min(y_low, p.y - radius);
        y_high = std::max(y_high, p.y + radius);
    }
    template <class EvaluatedDrawing>
    void include(const EvaluatedDrawing& placed) {
        for (const Point& point : placed.points) include(point, std::max(0.0, placed.radius));
    }
    void include(const BoundingBox& other) {
        x_low = std::min(x_low, other.x_low);
        x_high = std::max(x_high, other.x_high);
        y_low = std::min(y_low, other.y_low);
        y_high = std::max(y_high, other.y_high);
    }
    bool empty() const { return x_low > x_high; }
    double size() const { return std::max(x_high - x_low, y_high - y_low); }
    // Distance of a point from the box, in the maximum norm.
    double distance(const Point& p) const {
        return std::max({x_low - p.x, p.x - x_high, y_low - p.y, p.y - y_high, 0.0});
    }
};

// Includes a static curve. Of a ground, the part below the motion counts; an object not much larger than the motion (a
// bowl, a ring) is shown entirely.
void include_under(BoundingBox& all, const BoundingBox& motion, const std::vector<Point>& curve) {
    BoundingBox whole;
    for (const Point& p : curve) whole.include(p);
    const bool near =
        std::any_of(curve.begin(), curve.end(), [&](const Point& p) { return motion.distance(p) <= motion.size(); });
    if (near && whole.size() <= 2.0 * motion.size()) return all.include(whole);
    const double height = std::max(motion.y_high - motion.y_low, 0.2 * (motion.x_high - motion.x_low));
    for (const Point& p : curve)
        if (p.x >= motion.x_low && p.x <= motion.x_high && p.y >= motion.y_low - height &&
            p.y <= motion.y_high + height)
            all.include(p);
}

// Whether a wall with hatching, or a block, is shown entirely because it is near and not much larger than the motion.
bool is_shown_whole(DrawingShape shape, const BoundingBox& motion, const std::vector<Point>& points) {
    BoundingBox whole;
    for (const Point& p : points) whole.include(p);
    const auto is_near = [&](const Point& p) { return motion.distance(p) <= motion.size(); };
    return (shape == DrawingShape::ground || shape == DrawingShape::box) && whole.size() <= 2.0 * motion.size() &&
           std::any_of(points.begin(), points.end(), is_near);
}

// Includes the point of a floor, wall or pivot that is nearest to the motion, unless it is far away.
template <class EvaluatedDrawing>
void include_nearest(BoundingBox& all, const BoundingBox& motion, const EvaluatedDrawing& placed) {
    constexpr int parts = 100;
    const double reach = motion.size();
    double least = std::numeric_limits<double>::infinity();
    Point nearest;
    for (std::size_t i = 0; i < placed.points.size(); ++i) {
        const Point &a = placed.points[i], &b = placed.points[std::min(i + 1, placed.points.size() - 1)];
        for (int k = 0; k < parts; ++k) {
            const double s = static_cast<double>(k) / parts;
            const Point p{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
            if (!(motion.distance(p) < least)) continue;
            least = motion.distance(p);
            nearest = p;
        }
    }
    if (least <= reach) all.include(nearest, std::max(0.0, placed.radius));
}

// Highlights a surface while a contact is held on it: lines get the color of the phase and become bolder. Filled shapes
// keep their color and get such an outline.
void light(DrawnShape& shape, const Color& color) {
    shape.stroke.color = color;
    if (shape.stroke.width > 0.0) shape.stroke.width += shape.fill ? 1.5 : 0.75;
}

double diagonal(const Drawing& seen) { return std::hypot(seen.x_high - seen.x_low, seen.y_high - seen.y_low); }

// Whether a ground crosses the whole picture. Then everything behind it is solid, not only a strip.
bool ends_are_outside(const Drawing& seen, const std::vector<Point>& line) {
    return std::all_of(line.begin(), line.end(), [&](const Point& p) {
        return p.x < seen.x_low || p.x > seen.x_high || p.y < seen.y_low || p.y > seen.y_high;
    });
}

// Whether an expression names a coordinate or t.
bool names_what_moves(const SystemDescription& description, std::string_view text) {
    const std::vector<std::string> all = names_in(text);
    return std::any_of(all.begin(), all.end(), [&](const std::string& name) {
        return name == "t" || std::any_of(description.coordinates.begin(), description.coordinates.end(),
                                          [&](const CoordinateDescription& c) { return c.name == name; });
    });
}

}  // namespace

Mechanism::Mechanism(const Model& model, const std::optional<ViewAngles>& direction)
    : model_(model), start_(model.default_run()) {
    const SystemDescription& description = model.description();
    for (const DrawingDescription& drawing : drawings_of(description)) {
        Item item;
        item.description = drawing;
        const std::vector<Text> texts = texts_of(drawing);
        item.program = model.compile_drawing(texts, drawing.over);
        item.moves = std::any_of(texts.begin(), texts.end(),
                                 [&](const Text& text) { return names_what_moves(description, text.text); });
        items_.push_back(std::move(item));
    }
    const auto named = [&](std::size_t i, const char* name) {
        return description.coordinates.size() == 2 && description.coordinates[i].name == name;
    };
    plane_ = items_.empty() && named(0, "x") && named(1, "y");
    if ((!direction && !items_.empty()) || !SpaceView::shows(model)) return;
    space_.emplace(model, direction.value_or(ViewAngles{}));
    if (const Item* held = body(); held != nullptr && is_round(held->description.shape)) ball_ = *held;
    items_.clear();
}

Mechanism::EvaluatedDrawing Mechanism::place(const Item& item, Evaluator<double>& run, double t, const State& state,
                                             const Drawing* seen) const {
    set_state(run, state);
    run.input(model_.layout().t()) = t;
    run.run();
    const DrawingDescription& d = item.description;
    EvaluatedDrawing placed;
    if (is_round(d.shape)) placed.radius = run.output(2);
    if (!d.width.text.empty()) placed.width = run.output(run.output_count() - 1);
    for (std::size_t i = 0; i < d.sizes.size(); ++i) placed.sizes.push_back(run.output(2 * d.points.size() + i));
    if (d.shape == DrawingShape::box) {
        placed.points = box_corners({run.output(0), run.output(1)}, placed.sizes[0], placed.sizes[1], placed.sizes[2]);
        return placed;
    }
    if (d.shape != DrawingShape::curve) {
        for (std::size_t i = 0; i < d.points.size(); ++i)
            placed.points.push_back({run.output(2 * i), run.output(2 * i + 1)});
        return placed;
    }
    const double low = run.output(2), high = run.output(3);
    const auto at = [&](double parameter) {
        run.input(model_.layout().own()) = parameter;
        run.run();
        return Point{run.output(0), run.output(1)};
    };
    if (seen != nullptr) {
        placed.points = refined(at, low, high, curve_points, *seen);
        return placed;
    }
    for (int i = 0; i <= curve_points; ++i) placed.points.push_back(at(low + (high - low) * i / curve_points));
    return placed;
}

// A spring, a damper, or the hatching of a ground, in a world of this size. A size that the file does not give is
// chosen from the initial state, so that it is constant while the part moves.
std::vector<Point> Mechanism::line_between(const Item& item, Evaluator<double>& run, const EvaluatedDrawing& placed,
                                           double world) const {
    const Point &from = placed.points.front(), &to = placed.points.back();
    const DrawingShape shape = item.description.shape;
    if (shape == DrawingShape::ground) return hatching(from, to, hatch_of_world * world);
    const EvaluatedDrawing at_rest = place(item, run, start_.options.start_time, {start_.q, start_.v});
    const Point &a = at_rest.points.front(), &b = at_rest.points.back();
    PartSize size{std::hypot(b.x - a.x, b.y - a.y), placed.sizes.back()};
    if (!(size.across > 0.0)) size.across = fitting_across(size.rest, world);
    if (shape == DrawingShape::damper) return damper_line(from, to, size);
    constexpr double max_coils = 1000.0;
    const double coils = std::min(std::round(placed.sizes.front()), max_coils);
    return spring_line(from, to, coils >= 1.0 ? static_cast<int>(coils) : fitting_coils(size), size);
}

AnchorPoint::Hold AnchorPoint::at(double t, const State& state) {
    if (space_) {
        const SpaceView::Place seen = space_->seen(space_->place(state.q));
        return {{seen.x(), seen.y()}, radius_, seen.z()};
    }
    if (!run_) return {{state.q[0], state.q[1]}, 0.0, {}};
    set_state(*run_, state);
    run_->input(t_) = t;
    run_->run();
    if (material_) {
        const auto corner = [&](std::size_t i) -> Point {
            if (sizes_ == 0) return {run_->output(2 * i), run_->output(2 * i + 1)};
            return box_corners({run_->output(0), run_->output(1)}, run_->output(2), run_->output(3),
                               run_->output(4))[i];
        };
        const Point from = corner(material_->corner), a = corner(material_->ends[0]), b = corner(material_->ends[1]);
        const auto [s, u] = material_->shares;
        return {{from.x + s * (a.x - from.x) + u * (b.x - from.x), from.y + s * (a.y - from.y) + u * (b.y - from.y)},
                0.0,
                {}};
    }
    double radius = sizes_ > 0 ? run_->output(2) : 0.0;
    if (sizes_ > 1) radius = 0.5 * std::min(radius, run_->output(3));
    return {{run_->output(first_), run_->output(first_ + 1)}, radius, {}};
}

// The body, which the mouse drags first; null if only texts, curves and connecting parts move. The drawing of a contact
// comes last.
const Mechanism::Item* Mechanism::body() const {
    const Item *body = nullptr, *line = nullptr;
    for (const Item& item : items_) {
        if (!item.moves) continue;
        const bool is_of_contact = item.description.contact.has_value();
        if (is_body(item.description.shape) && (body == nullptr || body->description.contact || !is_of_contact))
            body = &item;
        if (item.description.shape == DrawingShape::segment || item.description.shape == DrawingShape::polyline)
            line = &item;
    }
    return body != nullptr ? body : line;
}

std::optional<AnchorPoint> Mechanism::grip(std::span<const double> parameters) const {
    if (plane_) return AnchorPoint();
    if (space_) {
        AnchorPoint grip;
        grip.space_ = space_;
        grip.radius_ = ball_radius(parameters);
        return grip;
    }
    const Item* held = body();
    if (held == nullptr) return std::nullopt;
    return grip_of(*held, held->description.points.size() - 1, parameters);
}

AnchorPoint Mechanism::grip_of(const Item& item, std::size_t point, std::span<const double> parameters) const {
    AnchorPoint grip;
    grip.run_ = model_.evaluator(item.program, parameters);
    const DrawingShape shape = item.description.shape;
    grip.sizes_ = is_round(shape) ? 1 : is_body(shape) ? 2 : 0;
    grip.t_ = model_.layout().t();
    grip.first_ = 2 * point;
    return grip;
}

std::vector<AnchorPoint> Mechanism::grips(std::span<const double> parameters) const {
    std::vector<AnchorPoint> all;
    if (auto first = grip(parameters)) all.push_back(std::move(*first));
    for (const Item& item : items_) {
        const DrawingShape shape = item.description.shape;
        if (!item.moves || (!is_body(shape) && shape != DrawingShape::segment && shape != DrawingShape::polyline))
            continue;
        const std::size_t last = item.description.points.size() - 1;
        all.push_back(grip_of(item, last, parameters));
        if (last > 0) all.push_back(grip_of(item, 0, parameters));
    }
    return all;
}

namespace {

bool is_line(DrawingShape shape) { return shape == DrawingShape::segment || shape == DrawingShape::polyline; }

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether a point is inside a polygon (even-odd rule).
bool is_inside(const Point& p, const std::vector<Point>& polygon) {
    bool is_in = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Point &a = polygon[i], &b = polygon[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) is_in = !is_in;
    }
    return is_in;
}

// A point in terms of the first two edges of a polygon that are not parallel.
std::optional<MaterialPoint> in_polygon(const Point& p, const std::vector<Point>& corners) {
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const Point &from = corners[i], &a = corners[i + 1], &b = corners[i + 2];
        const double area = cross(from, a, b);
        if (std::abs(area) > 1e-9 * std::hypot(a.x - from.x, a.y - from.y) * std::hypot(b.x - from.x, b.y - from.y))
            return MaterialPoint{0, i, {i + 1, i + 2}, {cross(from, p, b) / area, cross(from, a, p) / area}};
    }
    return std::nullopt;
}

}  // namespace

std::optional<MaterialPoint> Mechanism::material_point(const Point& at, double reach, double t, const State& state,
                                                       std::span<const double> parameters) const {
    std::optional<MaterialPoint> found;
    double least = reach;
    // What is drawn later lies above.
    const auto offer = [&](std::size_t drawing, double distance, MaterialPoint point) {
        if (!(distance <= least)) return;
        least = distance;
        found = point;
        found->drawing = drawing;
    };
    for (std::size_t i = 0; i < items_.size(); ++i) {
        const bool is_box = items_[i].description.shape == DrawingShape::box;
        if (!items_[i].moves || (!is_box && !is_line(items_[i].description.shape))) continue;
        Evaluator<double> run = model_.evaluator(items_[i].program, parameters);
        const std::vector<Point> corners = place(items_[i], run, t, state).points;
        const Point &first = corners.front(), &last = corners.back();
        // A line above or beside an area is easier to hit where it counts as nearer than the inside.
        const bool is_area = is_box || items_[i].description.fill || (first.x == last.x && first.y == last.y);
        if (is_area && is_inside(at, corners))
            if (const auto inside = in_polygon(at, corners)) offer(i, 0.5 * reach, *inside);
        for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
            const Point &a = corners[k], &b = corners[k + 1];
            const double x = b.x - a.x, y = b.y - a.y, length = x * x + y * y;
            const double s = length > 0.0 ? std::clamp(((at.x - a.x) * x + (at.y - a.y) * y) / length, 0.0, 1.0) : 0.0;
            offer(i, std::hypot(at.x - a.x - s * x, at.y - a.y - s * y), {0, k, {k + 1, k}, {s, 0.0}});
        }
    }
    return found;
}

std::optional<AnchorPoint> Mechanism::grip(const MaterialPoint& point, std::span<const double> parameters) const {
    if (point.drawing >= items_.size()) return std::nullopt;
    const Item& item = items_[point.drawing];
    const bool is_box = item.description.shape == DrawingShape::box;
    const std::size_t corners = is_box ? 4 : is_line(item.description.shape) ? item.description.points.size() : 0;
    if (std::max({point.corner, point.ends[0], point.ends[1]}) >= corners) return std::nullopt;
    AnchorPoint grip = grip_of(item, 0, parameters);
    grip.material_ = point;
    return grip;
}

std::vector<std::pair<std::size_t, AnchorPoint>> Mechanism::discs(std::span<const double> parameters) const {
    std::vector<std::pair<std::size_t, AnchorPoint>> all;
    for (std::size_t i = 0; i < items_.size(); ++i)
        if (items_[i].moves && is_round(items_[i].description.shape) && !items_[i].description.contact)
            all.emplace_back(i, grip_of(items_[i], 0, parameters));
    return all;
}

namespace {

DrawnShape& add(Drawing& drawing, DrawnShape::Kind kind, const Color& color, double width) {
    DrawnShape& shape = drawing.shapes.emplace_back();
    shape.kind = kind;
    shape.stroke.color = shape.fill_color = color;
    shape.stroke.width = width;
    return shape;
}

}  // namespace

// Draws a system without a drawing whose coordinates are x and y: the border of the region where all gaps are open, and
// the point.
void Mechanism::add_plane(Drawing& drawing, double t, const State& state, std::span<const double> parameters,
                          const Theme& theme) const {
    std::vector<PlaneFunction> gaps;
    for (std::size_t i = 0; i < model_.contacts(); ++i) {
        Evaluator<double> gap = model_.evaluator(model_.gap(i), parameters);
        gap.input(model_.layout().t()) = t;
        gaps.emplace_back([gap](const Point& p) mutable {
            gap.input(0) = p.x;
            gap.input(1) = p.y;
            gap.run();
            return gap.output(0);
        });
    }
    add(drawing, DrawnShape::Kind::polyline, theme.surface, 2.0).points = border(drawing, gaps);
    DrawnShape& disc = add(drawing, DrawnShape::Kind::disc, theme.body, 0.0);
    disc.moves = true;
    disc.points = {{state.q[0], state.q[1]}};
    disc.radius = 0.012 * (drawing.x_high - drawing.x_low + drawing.y_high - drawing.y_low);
    disc.fill = true;
}

// The radius of the ball at the start: a drawing may change it with the height, to suggest a depth that it lacks.
double Mechanism::ball_radius(std::span<const double> parameters) const {
    if (!ball_) return 0.0;
    Evaluator<double> run = model_.evaluator(ball_->program, parameters);
    return place(*ball_, run, start_.options.start_time, {start_.q, start_.v}).radius;
}

void Mechanism::add_ball(Drawing& drawing, const State& state, std::span<const double> parameters, const Theme& theme,
                         Mode mode) const {
    const bool has_color = ball_ && !ball_->description.color.empty();
    const Color color = has_color ? on_theme(color_of(ball_->description.color), theme) : theme.body;
    const SpaceView::Place seen = space_->seen(space_->place(state.q));
    const double radius = ball_radius(parameters);
    DrawnShape& ball = add(drawing, DrawnShape::Kind::disc, color, 2.0);
    ball.moves = true;
    ball.points = {{seen.x(), seen.y()}};
    ball.radius = radius > 0.0 ? radius : 0.02 * drawing.size;
    ball.fill = !ball_ || ball_->description.fill;
    if (!mode.held().empty()) light(ball, phase_color(theme, look_of(model_, mode.held(), mode)));
}

Drawing Mechanism::draw(double t, const State& state, std::span<const double> parameters, const Drawing& limits,
                        const Theme& theme, Mode mode, DrawnPart part) const {
    Drawing drawing = limits;
    drawing.shapes.clear();
    const bool all = part == DrawnPart::all;
    ContactSet of_body = mode.held();
    for (const Item& item : items_)
        if (item.description.contact) of_body = of_body.without(*item.description.contact);
    for (const Item& item : items_) {
        if (!all && !item.moves) continue;
        const DrawingDescription& d = item.description;
        const Color own = item.moves && d.shape != DrawingShape::ground ? theme.body : theme.surface;
        const Color color = d.color.empty() ? own : on_theme(color_of(d.color), theme);
        Evaluator<double> run = model_.evaluator(item.program, parameters);
        EvaluatedDrawing placed = place(item, run, t, state, &limits);
        const DrawnShape::Kind kind = is_round(d.shape)               ? DrawnShape::Kind::disc
                                      : d.shape == DrawingShape::text ? DrawnShape::Kind::text
                                                                      : DrawnShape::Kind::polyline;
        const bool is_part = d.shape == DrawingShape::spring || d.shape == DrawingShape::damper;
        const bool is_lit = d.contact ? mode.is_held(*d.contact) : !of_body.empty() && &item == body();
        const ContactSet lit = d.contact ? ContactSet::of(*d.contact) : of_body;
        const Color light_color = phase_color(theme, look_of(model_, lit, mode));
        if (d.shape == DrawingShape::ground) {
            DrawnShape& earth = add(drawing, DrawnShape::Kind::area, theme.ground, 0.0);
            earth.points = strip_right_of(
                placed.points.front(), placed.points.back(),
                ends_are_outside(limits, placed.points) ? 2.0 * diagonal(limits) : hatch_of_world * limits.size);
            earth.moves = item.moves;
            DrawnShape& hatches = add(drawing, kind, color, 0.5 * placed.width);
            hatches.points = line_between(item, run, placed, limits.size);
            hatches.moves = item.moves;
            if (is_lit) light(hatches, light_color);
        }
        if (is_part) placed.points = line_between(item, run, placed, limits.size);
        DrawnShape& shape = add(drawing, kind, color, placed.width);
        shape.item = static_cast<std::size_t>(&item - items_.data());
        shape.moves = item.moves;
        shape.points = std::move(placed.points);
        shape.fill = d.fill;
        shape.closed = d.shape == DrawingShape::box || (d.fill && d.shape == DrawingShape::polyline);
        if (is_lit) light(shape, light_color);
        shape.text = d.text;
        shape.radius = placed.radius;
    }
    if (space_) {
        add_ball(drawing, state, parameters, theme, mode);
    } else if (plane_) {
        add_plane(drawing, t, state, parameters, theme);
    } else if (items_.empty() && all) {
        DrawnShape& note = add(drawing, DrawnShape::Kind::text, theme.surface, 1.0);
        note.points = {{0.5 * (limits.x_low + limits.x_high), 0.5 * (limits.y_low + limits.y_high)}};
        note.text = "this system has no [[drawing]]";
    }
    return drawing;
}

// A square that holds the run whatever the direction, so that nothing grows or shrinks while it is turned.
Drawing Mechanism::limits_in_space(std::span<const Sample> samples) const {
    const SpaceBox box(*space_, samples);
    const SpaceView::Place middle = space_->seen(box.middle);
    constexpr double room = 1.05;
    const double reach = room * box.half.norm();
    Drawing drawing;
    drawing.size = box.size();
    drawing.x_low = middle.x() - reach, drawing.x_high = middle.x() + reach;
    drawing.y_low = middle.y() - reach, drawing.y_high = middle.y() + reach;
    return drawing;
}

Drawing Mechanism::limits(const Trajectory& trajectory, std::span<const Sample> samples) const {
    if (space_) return limits_in_space(samples);
    BoundingBox box;
    const std::size_t stride = 1 + samples.size() / 1000;
    if (plane_)
        for (std::size_t i = 0; i < samples.size(); i += stride)
            box.include(Point{samples[i].state.q[0], samples[i].state.q[1]});
    for (const Item& item : items_) {
        if (!item.moves) continue;
        Evaluator<double> run = model_.evaluator(item.program, trajectory.run.parameters);
        for (std::size_t i = 0; i < samples.size(); i += stride)
            box.include(place(item, run, samples[i].t, samples[i].state));
    }
    const bool still = box.empty();  // then all static shapes must be visible
    BoundingBox all = box;
    for (const Item& item : items_) {
        if (item.moves) continue;
        Evaluator<double> run = model_.evaluator(item.program, trajectory.run.parameters);
        const EvaluatedDrawing placed =
            place(item, run, trajectory.run.options.start_time, {trajectory.run.q, trajectory.run.v});
        if (still || is_shown_whole(item.description.shape, box, placed.points))
            all.include(placed);
        else if (item.description.shape == DrawingShape::curve)
            include_under(all, box, placed.points);
        else
            include_nearest(all, box, placed);
    }
    if (all.empty()) all.include(Point{0.0, 0.0}, 1.0);
    const double size = all.size();
    const double room = size > 0.0 ? 0.06 * size : 1.0;
    Drawing drawing;
    drawing.size = 0.5 * (all.x_high - all.x_low + all.y_high - all.y_low);
    drawing.x_low = all.x_low - room;
    drawing.x_high = all.x_high + room;
    drawing.y_low = all.y_low - room;
    drawing.y_high = all.y_high + room;
    return drawing;
}

}  // namespace achilles
