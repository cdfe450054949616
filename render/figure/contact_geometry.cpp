#include "figure/contact_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "figure/body.hpp"

namespace achilles {

namespace {

constexpr double within = 0.15;  // fraction of a disc's radius: a line this close to a point passes through it

double distance_to(const Point& p, const Point& a, const Point& b) {
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const double s = square > 0.0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0, 1.0) : 0.0;
    return std::hypot(p.x - a.x - s * x, p.y - a.y - s * y);
}

// Distance to the nearest line of a shape.
double distance_to(const Point& p, const DrawnShape& shape) {
    double least = std::numeric_limits<double>::infinity();
    if (shape.kind == DrawnShape::Kind::disc)
        return std::abs(std::hypot(p.x - shape.points[0].x, p.y - shape.points[0].y) - shape.radius);
    for (std::size_t i = 1; i < shape.points.size(); ++i) {
        const double distance = distance_to(p, shape.points[i - 1], shape.points[i]);
        if (distance < least) least = distance;  // false at a break, where the distance is NaN
    }
    return least;
}

// The shape that passes through all of these points; null if none does.
const DrawnShape* line_through(const std::vector<DrawnShape>& shapes, const std::vector<Point>& places,
                               double tolerance) {
    for (const DrawnShape& shape : shapes) {
        const bool is_line = shape.kind == DrawnShape::Kind::polyline || shape.kind == DrawnShape::Kind::disc;
        if (!is_line || shape.moves || shape.points.empty()) continue;
        if (std::all_of(places.begin(), places.end(),
                        [&](const Point& place) { return distance_to(place, shape) <= tolerance; }))
            return &shape;
    }
    return nullptr;
}

}  // namespace

// It is found by relaxation, with a limit on the rounds because walls may leave no space.
Eigen::Vector3d min_way(const std::vector<std::pair<Eigen::Vector3d, double>>& wanted) {
    constexpr int rounds = 60;
    std::vector<double> pushes(wanted.size(), 0.0);
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    for (int round = 0; round < (wanted.size() == 1 ? 1 : rounds); ++round)
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const auto& [away, length] = wanted[i];
            const double push = std::max(0.0, pushes[i] + length - away.dot(way));
            way += (push - pushes[i]) * away;
            pushes[i] = push;
        }
    return way;
}

std::optional<Nearness> ContactGeometry::nearness(AnchorPoint& grip, std::size_t contact, double t,
                                                  const State& state) const {
    const auto body = Body::of(grip, t, state);
    if (!body) return std::nullopt;
    auto& terms = model_->lazily(terms_[contact], model_->programs_of(contact).contact_terms, parameters_);
    State here = state;
    here.t = t;
    set_state(terms, here);
    terms.run();
    Vector gradient(state.q.size());
    for (Eigen::Index i = 0; i < gradient.size(); ++i) gradient[i] = terms.gradient(static_cast<std::size_t>(i));
    const auto steepest = body->force(gradient);  // J'(dh/dp) = dh/dq
    if (!steepest) return std::nullopt;
    const double slope = std::hypot(steepest->x, steepest->y), h = terms.h();
    if (!(slope > 0.0) || !std::isfinite(slope) || !std::isfinite(h)) return std::nullopt;
    Nearness near;
    near.distance = h / slope;
    near.away = {steepest->x / slope, steepest->y / slope};
    near.foot = {body->at().x - near.distance * near.away.x, body->at().y - near.distance * near.away.y};
    return near;
}

std::optional<Nearness> ContactGeometry::ground_below(AnchorPoint& grip, std::size_t contact, double t,
                                                      const State& state) const {
    auto near = nearness(grip, contact, t, state);
    const auto solid =
        std::find_if(solids_.begin(), solids_.end(), [&](const Solid& one) { return one.contact == contact; });
    if (!near || (solid == solids_.end() && !tips_[contact])) return std::nullopt;
    if (solid == solids_.end()) return near;
    near->foot.x -= solid->skin * near->away.x;
    near->foot.y -= solid->skin * near->away.y;
    return near;
}

ContactGeometry::ContactGeometry(const Mechanism& mechanism, const Trajectory& trajectory, double size)
    : model_(trajectory.model.get()),
      parameters_(trajectory.run.parameters),
      terms_(model_->contacts()),
      tips_(model_->contacts()) {
    for (const DrawingDescription& drawing : drawings_of(model_->description()))
        if (drawing.contact) drawn_ = drawn_.with(*drawing.contact);
    const State start{trajectory.run.q, trajectory.run.v, trajectory.run.options.start_time};
    const Drawing all = mechanism.draw(start.t, start, parameters_, Drawing(), light_theme());
    find_discs(mechanism, trajectory, all.shapes);
    find_tips(mechanism, trajectory, all.shapes, size);
}

// The two coordinates that are the x and y of a point. nullopt if they are not coordinates.
std::optional<std::array<std::size_t, 2>> ContactGeometry::plane_of(AnchorPoint& grip, const State& start) const {
    std::array<std::size_t, 2> pair{};
    const auto n = static_cast<std::size_t>(start.q.size());
    const Point here = grip.at(start.t, start).at;
    std::array<bool, 2> found{};
    for (std::size_t i = 0; i < n; ++i) {
        State moved = start;
        moved.q[static_cast<Eigen::Index>(i)] += 0.25;
        const Point there = grip.at(start.t + 0.125, moved).at;
        const double x = there.x - here.x, y = there.y - here.y;
        const double q = start.q[static_cast<Eigen::Index>(i)];
        const bool is_x = std::abs(x - 0.25) < 1e-9 && y == 0.0 && here.x == q;
        const bool is_y = std::abs(y - 0.25) < 1e-9 && x == 0.0 && here.y == q;
        if (!is_x && !is_y && (x != 0.0 || y != 0.0)) return std::nullopt;
        if (is_x) pair[0] = i, found[0] = true;
        if (is_y) pair[1] = i, found[1] = true;
    }
    return found[0] && found[1] ? std::optional(pair) : std::nullopt;
}

bool ContactGeometry::gap_depends_only_on(std::size_t contact, const std::array<std::size_t, 2>& pair) const {
    std::vector<std::uint32_t> others;
    for (std::size_t i = 0; i < model_->layout().dof; ++i)
        if (i != pair[0] && i != pair[1]) others.push_back(static_cast<std::uint32_t>(model_->layout().q(i)));
    return !depends_on(model_->equations().gaps[contact], others);
}

namespace {

// States with the center of a disc on h = 0 or close to it: straight ahead of its position, and slightly to either
// side.
std::vector<Nearness> probes(const ContactGeometry& touch, AnchorPoint& grip, std::size_t contact, const State& start,
                             double radius) {
    std::vector<Nearness> found;
    State state = start;
    for (const double side : {0.0, 2.0, -4.0}) {
        constexpr int rounds = 12;
        for (int round = 0; round <= rounds; ++round) {
            const auto near = touch.nearness(grip, contact, start.t, state);
            if (!near) return {};
            if (round == rounds || std::abs(near->distance) < 1e-3 * radius) {
                if (!(std::abs(near->distance) < within * radius)) return {};
                found.push_back(*near);
                break;
            }
            const auto q = held_at(grip, start.t, state, near->foot);
            if (!q) return {};
            state.q = *q;
        }
        if (side == -4.0) break;
        const Nearness& last = found.back();
        const double way = (side == 0.0 ? 2.0 : -4.0) * radius;
        const auto q =
            held_at(grip, start.t, state, {last.foot.x - way * last.away.y, last.foot.y + way * last.away.x});
        if (!q) return {};
        state.q = *q;
    }
    return found;
}

// Where the gap of a contact is examined: at the start and, if its line is not drawn there, where it first closes. A
// contact that counts only sometimes is no ground beyond its line.
std::vector<State> examined(const Trajectory& trajectory, std::size_t contact) {
    std::vector<State> states{trajectory.run.start()};
    if (trajectory.model->is_conditional(contact)) return states;
    for (const Event& event : trajectory.events)
        if (event.contacts.contains(contact)) {
            states.push_back({event.q, event.v_after, event.t});
            break;
        }
    return states;
}

}  // namespace

void ContactGeometry::find_tips(const Mechanism& mechanism, const Trajectory& trajectory,
                                const std::vector<DrawnShape>& shapes, double size) {
    const State start{trajectory.run.q, trajectory.run.v, trajectory.run.options.start_time};
    constexpr double step = 0.02;  // fraction of the world, between probes
    auto grips = mechanism.grips(parameters_);
    for (std::size_t contact = 0; contact < model_->contacts(); ++contact)
        for (std::size_t i = 0; i < grips.size() && !tips_[contact]; ++i) {
            std::vector<Point> feet;
            for (const Nearness& near : probes(*this, grips[i], contact, start, step * size)) feet.push_back(near.foot);
            if (!feet.empty() && line_through(shapes, feet, within * step * size) != nullptr) tips_[contact] = i;
        }
}

void ContactGeometry::find_discs(const Mechanism& mechanism, const Trajectory& trajectory,
                                 const std::vector<DrawnShape>& shapes) {
    const State start{trajectory.run.q, trajectory.run.v, trajectory.run.options.start_time};
    std::vector<bool> known(model_->contacts(), false);
    for (auto& [item, grip] : mechanism.discs(parameters_)) {
        const double radius = grip.at(start.t, start).radius;
        if (!(radius > 0.0)) continue;
        Disc disc{item, grip, {}};
        const auto pair = plane_of(disc.grip, start);
        for (std::size_t contact = 0; contact < model_->contacts(); ++contact) {
            std::vector<Nearness> near;
            const DrawnShape *of_center = nullptr, *line = nullptr;
            const auto places = [&](double depth) {
                std::vector<Point> points;
                for (const Nearness& one : near)
                    points.push_back({one.foot.x - depth * one.away.x, one.foot.y - depth * one.away.y});
                return points;
            };
            for (const State& state : examined(trajectory, contact)) {
                near = probes(*this, disc.grip, contact, state, radius);
                if (near.empty()) continue;
                of_center = line_through(shapes, places(0.0), within * radius);
                line = of_center != nullptr ? of_center : line_through(shapes, places(radius), within * radius);
                if (line != nullptr) break;
            }
            if (of_center != nullptr) disc.contacts.push_back(contact);
            if (line == nullptr || known[contact]) continue;
            Solid solid{contact, of_center != nullptr ? 0.0 : radius};
            if (pair && gap_depends_only_on(contact, *pair)) {
                solid.pair = *pair;
                const std::uint32_t clock = model_->layout().t();
                solid.stands_still = !depends_on(model_->equations().gaps[contact], {&clock, 1});
            } else if (line->kind == DrawnShape::Kind::disc) {
                const Point& center = line->points[0];
                const Nearness& one = near[0];
                solid.center = center;
                solid.radius = line->radius;
                solid.sign =
                    (one.foot.x - center.x) * one.away.x + (one.foot.y - center.y) * one.away.y > 0.0 ? 1.0 : -1.0;
            } else {
                continue;
            }
            known[contact] = true;
            solids_.push_back(solid);
        }
        if (!disc.contacts.empty()) discs_.push_back(std::move(disc));
    }
}

void ContactGeometry::rest(Drawing& drawing, double t, const State& state) const {
    for (const Disc& disc : discs_) {
        AnchorPoint grip = disc.grip;
        const double radius = grip.at(t, state).radius;
        std::vector<std::pair<Eigen::Vector3d, double>> wanted;
        for (const std::size_t contact : disc.contacts)
            if (const auto near = nearness(grip, contact, t, state)) {
                const double far = std::max(0.0, near->distance) / (2.0 * radius);
                wanted.emplace_back(Eigen::Vector3d(near->away.x, near->away.y, 0.0), radius * std::exp(-far * far));
            }
        const Eigen::Vector3d way = min_way(wanted);
        for (DrawnShape& shape : drawing.shapes)
            if (shape.item == disc.item && shape.kind == DrawnShape::Kind::disc)
                shape.points[0] = {shape.points[0].x + way.x(), shape.points[0].y + way.y()};
    }
}

PlaneFunction ContactGeometry::function_of(const Solid& solid, double t, const State& state) const {
    if (solid.center)
        return [center = *solid.center, radius = solid.radius, sign = solid.sign](const Point& p) {
            return sign * (std::hypot(p.x - center.x, p.y - center.y) - radius);
        };
    auto gap = model_->evaluator(model_->gap(solid.contact), parameters_);
    State here = state;
    here.t = t;
    set_state(gap, here);
    auto h = [gap, pair = solid.pair](const Point& p) mutable {
        gap.input(pair[0]) = p.x;
        gap.input(pair[1]) = p.y;
        gap.run();
        return gap.output(0);
    };
    if (solid.skin == 0.0) return h;
    // The solid is smaller by the radius, by which the center of the disc stays away.
    return [h, skin = solid.skin](const Point& p) mutable {
        const double step = 1e-4 * skin;
        const double x = h({p.x + step, p.y}) - h({p.x - step, p.y}), y = h({p.x, p.y + step}) - h({p.x, p.y - step});
        const double slope = 0.5 * std::hypot(x, y) / step;
        return h({p.x + skin * (slope > 0.0 ? x / (2.0 * step * slope) : 0.0),
                  p.y + skin * (slope > 0.0 ? y / (2.0 * step * slope) : 0.0)});
    };
}

const ContactGeometry::CachedGround& ContactGeometry::cached_ground(std::size_t which, const Drawing& drawing, double t,
                                                                    const State& state) const {
    seen_.resize(solids_.size());
    auto& seen = seen_[which];
    const auto same = [](const Drawing& a, const Drawing& b) {
        return a.x_low == b.x_low && a.x_high == b.x_high && a.y_low == b.y_low && a.y_high == b.y_high;
    };
    if (seen && same(seen->limits, drawing) && (solids_[which].stands_still || seen->t == t)) return *seen;
    seen.emplace();
    seen->limits = drawing;
    seen->limits.shapes.clear();
    seen->t = t;
    const PlaneFunction gap = function_of(solids_[which], t, state);
    const ScalarField field(seen->limits, [&](const Point& p) { return -gap(p); });
    constexpr double end = std::numeric_limits<double>::quiet_NaN();
    for (const std::vector<Point>& part : field.not_negative()) {
        seen->area.insert(seen->area.end(), part.begin(), part.end());
        seen->area.push_back({end, end});
    }
    seen->line = field.zero_line();
    return *seen;
}

void ContactGeometry::add_ground(Drawing& drawing, double t, const State& state, Mode mode, const Theme& theme) const {
    std::vector<DrawnShape> ground, lit;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
        const CachedGround& seen = cached_ground(i, drawing, t, state);
        DrawnShape& shape = ground.emplace_back();
        shape.kind = DrawnShape::Kind::area;
        shape.fill_color = theme.ground;
        shape.points = seen.area;
        const std::size_t contact = solids_[i].contact;
        if (!mode.is_held(contact) || drawn_.contains(contact)) continue;
        DrawnShape& line = lit.emplace_back();
        line.points = seen.line;
        line.stroke.color = phase_color(theme, look_of(*model_, ContactSet::of(contact), mode));
        line.stroke.width = 2.75;
    }
    drawing.shapes.insert(drawing.shapes.begin(), ground.begin(), ground.end());
    const auto first =
        std::find_if(drawing.shapes.begin(), drawing.shapes.end(), [](const DrawnShape& shape) { return shape.moves; });
    drawing.shapes.insert(first, lit.begin(), lit.end());
}

}  // namespace achilles
