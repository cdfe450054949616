#include "figure/mechanism_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/model.hpp"

namespace achilles {

namespace {

constexpr std::size_t max_poses = 40;
constexpr double min_pose_spacing = 0.035;  // fraction of the world: closer poses would merge into a blot
constexpr std::uint8_t pose = 55;

// The moving shapes of a drawing with this opacity. Texts are left out, because they would be unreadable.
std::vector<DrawnShape> paled(std::vector<DrawnShape> shapes, std::uint8_t alpha) {
    std::erase_if(shapes, [](const DrawnShape& shape) { return !shape.moves || shape.kind == DrawnShape::Kind::text; });
    for (DrawnShape& shape : shapes) shape.stroke.color.a = shape.fill_color.a = alpha;
    return shapes;
}

void put_under_what_moves(std::vector<DrawnShape>& shapes, const std::vector<DrawnShape>& more) {
    const auto first = std::find_if(shapes.begin(), shapes.end(), [](const DrawnShape& shape) { return shape.moves; });
    shapes.insert(first, more.begin(), more.end());
}

// The radius of a disc; of a box or polygon, that of a disc as wide and high on average.
double radius_of(const DrawnShape& shape) {
    if (shape.kind == DrawnShape::Kind::disc) return shape.radius;
    const auto [left, right] = std::minmax_element(shape.points.begin(), shape.points.end(),
                                                   [](const Point& a, const Point& b) { return a.x < b.x; });
    const auto [low, high] = std::minmax_element(shape.points.begin(), shape.points.end(),
                                                 [](const Point& a, const Point& b) { return a.y < b.y; });
    return shape.points.empty() ? 0.0 : 0.25 * (right->x - left->x + high->y - low->y);
}

// Makes a body as large as the picture transparent: the closer the view, the more of it is only its outline.
void thin_out_large(std::vector<DrawnShape>& shapes, const Drawing& seen) {
    constexpr double large = 0.4, huge = 1.2;  // radius as a fraction of the picture's smaller side
    constexpr double least = 26.0, rim = 2.0;
    const double size = std::min(seen.x_high - seen.x_low, seen.y_high - seen.y_low);
    for (DrawnShape& shape : shapes) {
        const bool is_filled = shape.kind == DrawnShape::Kind::disc || shape.closed;
        const double radius = is_filled && shape.moves && shape.fill ? radius_of(shape) : 0.0;
        if (!(radius > large * size)) continue;
        const double s = std::min(1.0, (radius / size - large) / (huge - large));
        shape.fill_color.a = static_cast<std::uint8_t>(255.0 + s * (least - 255.0));
        shape.stroke.width = std::max(shape.stroke.width, rim);
    }
}

}  // namespace

MechanismScene::MechanismScene(const Mechanism& mechanism, const Trajectory& trajectory,
                               std::span<const Sample> samples, bool has_coarse_trail)
    : mechanism_(mechanism),
      trajectory_(trajectory),
      sampler_(trajectory),
      limits_(mechanism.limits(trajectory, samples)),
      trail_(trail_of(mechanism, trajectory, samples, limits_, has_coarse_trail)),
      touch_(mechanism, trajectory, limits_.size),
      camera_(mechanism, touch_, trajectory, samples, trail_, limits_),
      unit_(length_unit(trajectory.model->description())) {
    if (mechanism.space() != nullptr)
        surfaces_.emplace(*trajectory.model, trajectory.run.parameters, *mechanism.space(), samples);
    else if (trajectory.model->has_friction())
        friction_.emplace(mechanism, trajectory, touch_, samples);
    find_poses();
}

// Selects the strobe poses: the start, and each event at which some point of the mechanism is far enough from its
// position in every pose kept so far. The impacts that accumulate before a Zeno point give one or two poses. Of very
// many impacts only some are examined.
void MechanismScene::find_poses() {
    auto grips = mechanism_.grips(trajectory_.run.parameters);
    std::vector<std::vector<Point>> kept;
    const auto keep = [&](double t, const State& state) {
        if (kept.size() >= max_poses) return;
        std::vector<Point> places;
        for (AnchorPoint& grip : grips) places.push_back(grip.at(t, state).at);
        const auto is_near = [&](const std::vector<Point>& other) {
            for (std::size_t i = 0; i < places.size(); ++i)
                if (std::hypot(places[i].x - other[i].x, places[i].y - other[i].y) > min_pose_spacing * limits_.size)
                    return false;
            return true;
        };
        if (std::any_of(kept.begin(), kept.end(), is_near)) return;
        kept.push_back(std::move(places));
        poses_.push_back(sampler_.at(t));
    };
    if (grips.empty()) return;
    const Run& run = trajectory_.run;
    keep(run.options.start_time, {run.q, run.v, run.options.start_time});
    const auto& events = trajectory_.events;
    const std::size_t stride = 1 + events.size() / 2000;
    for (std::size_t i = 0; i < events.size(); ++i)
        if (i % stride == 0 || !events[i].is_impact()) keep(events[i].t, {events[i].q, events[i].v_after, events[i].t});
}

std::vector<double> MechanismScene::poses() const {
    std::vector<double> times;
    for (const Sample& sample : poses_) times.push_back(sample.t);
    return times;
}

// The trail at the resolution of the run's picture. If a small part of the world is visible, the trail around the
// present has the resolution of that part.
std::vector<WayPoint> MechanismScene::way(const Sample& now, const Drawing& seen) {
    auto grip = mechanism_.grip(trajectory_.run.parameters);
    if (trail_.way.empty() || !grip) return {};
    const auto body = Body::of(*grip, now.t, now.state);
    std::vector<WayPoint> all;
    if (const auto part = close_part(now, seen, body)) {
        const auto [low, high] = *part;
        const PlaceOf place = [&](const Sample& sample) { return grip->at(sample.t, sample.state).at; };
        for (const WayPoint& point : trail_.way) {
            const bool is_near = point.t > low && point.t < high;
            if (!is_near || all.empty() || std::isfinite(all.back().at.x)) all.push_back(point);
            if (is_near) all.back().at = break_of_curve;
        }
        for (const auto& [from, to] : {std::pair{low, now.t}, std::pair{now.t, high}}) {
            all.push_back({from, PhaseLook::flight, break_of_curve});
            const std::vector<WayPoint> fine = way_of(trajectory_, from, to, seen, place);
            all.insert(all.end(), fine.begin(), fine.end());
        }
    } else {
        all = trail_.way;
        add_present(all, {now.t, look_of(*trajectory_.model, now.phase, now.mode), grip->at(now.t, now.state).at});
    }
    const Point aside = rest_below(now, seen, *grip, body);
    for (WayPoint& point : all) point.at = {point.at.x + aside.x, point.at.y + aside.y};
    return all;
}

PhaseLabel phase_label(const Model& model, const Sample& now) {
    const bool is_cut = now.contact && now.phase == Phase::Kind::hybrid;
    const PhaseLook look = look_of(model, is_cut ? Phase::Kind::constrained : now.phase, now.mode);
    return {look, (is_cut ? "cut, " : "") + legend_text(look)};
}

// Time interval around the present in which the visible part is much smaller than the world that the run needs, limited
// to a number of steps.
std::optional<std::pair<double, double>> MechanismScene::close_part(const Sample& now, const Drawing& seen,
                                                                    const std::optional<Body>& body) const {
    constexpr double close = 0.3;
    constexpr std::ptrdiff_t most_steps = 300;
    const double size = std::hypot(seen.x_high - seen.x_low, seen.y_high - seen.y_low);
    if (!body || !(size < close * limits_.size)) return std::nullopt;
    const Point v = body->velocity(now.state.v);
    const double start = trajectory_.run.options.start_time, run = trajectory_.end_time - start;
    const double reach = std::min(0.02 * run, 2.0 * size / std::max(std::hypot(v.x, v.y), 1e-3 * trail_.fastest));
    double low = std::max(start, now.t - reach), high = std::min(trajectory_.end_time, now.t + reach);
    const auto& pieces = trajectory_.pieces;
    const auto here = std::upper_bound(pieces.begin(), pieces.end(), now.t,
                                       [](double t, const DenseSegment& piece) { return t < piece.start; });
    if (here - pieces.begin() > most_steps) low = std::max(low, (here - most_steps)->start);
    if (pieces.end() - here > most_steps) high = std::min(high, (here + most_steps)->start);
    return std::pair{low, high};
}

// Offset of the trail if the view is smaller than the radius of the body's disc: from the center, which is far outside,
// to the lowest point. Otherwise zero.
Point MechanismScene::rest_below(const Sample& now, const Drawing& seen, AnchorPoint& grip,
                                 const std::optional<Body>& body) const {
    Point aside;
    const double size = std::hypot(seen.x_high - seen.x_low, seen.y_high - seen.y_low);
    if (!body || !(size < body->radius())) return aside;
    for (std::size_t contact = 0; contact < trajectory_.model->contacts(); ++contact) {
        const auto ground = touch_.ground_below(grip, contact, now.t, now.state);
        const auto near = touch_.nearness(grip, contact, now.t, now.state);
        if (ground && near && near->distance < size)
            aside = {ground->foot.x - near->foot.x, ground->foot.y - near->foot.y};
    }
    return aside;
}

void MechanismScene::rest(Drawing& drawing, double t, const State& state) const {
    surfaces_ ? surfaces_->rest(drawing, t, state) : touch_.rest(drawing, t, state);
}

Drawing MechanismScene::draw(const Sample& now, const Drawing& seen, const Theme& theme, const Layers& layers) {
    const auto& parameters = trajectory_.run.parameters;
    Drawing drawing = mechanism_.draw(now.t, now.state, parameters, seen, theme, now.mode);
    rest(drawing, now.t, now.state);
    thin_out_large(drawing.shapes, seen);
    touch_.add_ground(drawing, now.t, now.state, now.mode, theme);
    if (surfaces_) surfaces_->add(drawing, now, theme);
    if (layers.way) add_body_trail(drawing.shapes, way(now, seen), now.t, theme);
    if (layers.strobe)
        for (const Sample& then : poses_)
            if (then.t < now.t) {
                Drawing there =
                    mechanism_.draw(then.t, then.state, parameters, seen, theme, {}, Mechanism::DrawnPart::moving);
                rest(there, then.t, then.state);
                put_under_what_moves(drawing.shapes, paled(std::move(there.shapes), pose));
            }
    if (layers.friction && friction_) friction_->add(drawing, now, theme);
    if (surfaces_) surfaces_->add_axes(drawing, theme);
    return drawing;
}

// ---- a system in space in two views ----

namespace {

Point projected(const State& state, const std::array<std::size_t, 2>& pair) {
    return {state.q[static_cast<Eigen::Index>(pair[0])], state.q[static_cast<Eigen::Index>(pair[1])]};
}

// Unit vector out of the solid, in the plane; zero if the gap does not change in the plane.
Point away(const PlaneFunction& gap, const Point& p, double step) {
    const double x = gap({p.x + step, p.y}) - gap({p.x - step, p.y}),
                 y = gap({p.x, p.y + step}) - gap({p.x, p.y - step});
    const double length = std::hypot(x, y);
    return length > 0.0 && std::isfinite(length) ? Point{x / length, y / length} : Point{};
}

}  // namespace

TwoViews::TwoViews(const Trajectory& trajectory, std::span<const Sample> samples)
    : trajectory_(trajectory), samples_(samples) {
    const auto& coordinates = trajectory.model->description().coordinates;
    const auto is = [&](std::size_t i, const char* name) { return coordinates[i].name == name; };
    exist_ = coordinates.size() == 3 && is(0, "x") && is(1, "y") && is(2, "z");
}

std::array<TwoViews::Side, 2> TwoViews::all() { return {Side{"x", {0, 2}}, Side{"y", {1, 2}}}; }

std::array<Drawing, 2> TwoViews::limits() const {
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

Drawing TwoViews::draw(std::size_t side, const Sample& now, const Drawing& seen, const Theme& theme,
                       bool with_way) const {
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
        const ScalarField field(seen, [&](const Point& p) { return -gap(p); });
        DrawnShape& ground = drawing.shapes.emplace_back();
        ground.kind = DrawnShape::Kind::area;
        ground.fill_color = theme.ground;
        constexpr double end = std::numeric_limits<double>::quiet_NaN();
        for (const std::vector<Point>& part : field.not_negative()) {
            ground.points.insert(ground.points.end(), part.begin(), part.end());
            ground.points.push_back({end, end});
        }
        DrawnShape& line = drawing.shapes.emplace_back();
        line.points = field.zero_line();
        const bool is_held = now.mode.is_held(contact);
        line.stroke.color =
            is_held ? phase_color(theme, look_of(model, ContactSet::of(contact), now.mode)) : theme.surface;
        line.stroke.width = is_held ? 2.75 : 2.0;
        const Point out = away(gap, here, 1e-6 * seen.size);
        rests.x += radius * out.x, rests.y += radius * out.y;
    }
    if (model.contacts() > 1) rests = {};
    DrawnShape& disc = drawing.shapes.emplace_back();
    disc.kind = DrawnShape::Kind::disc;
    disc.moves = disc.fill = true;
    disc.points = {{here.x + rests.x, here.y + rests.y}};
    disc.radius = radius;
    disc.stroke.width = 0.0;
    disc.fill_color = theme.body;
    if (!with_way) return drawing;
    // This is computed in every frame. For a run with very many steps, its samples are used instead.
    constexpr std::size_t most_steps = 2000;
    std::vector<WayPoint> way;
    if (trajectory_.pieces.size() <= most_steps)
        way = way_of(trajectory_, trajectory_.run.options.start_time, trajectory_.end_time, seen,
                     [&](const Sample& sample) { return projected(sample.state, pair); });
    else
        for (const Sample& sample : samples_)
            way.push_back({sample.t, look_of(model, sample.phase, sample.mode), projected(sample.state, pair)});
    add_present(way, {now.t, look_of(model, now.phase, now.mode), here});
    add_body_trail(drawing.shapes, way, now.t, theme);
    return drawing;
}

}  // namespace achilles
