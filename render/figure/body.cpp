#include "figure/body.hpp"

#include <algorithm>
#include <cmath>

#include "figure/trace.hpp"
#include "number/dense.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {

namespace {

// Solves A x = b for a symmetric positive semidefinite 2 x 2 matrix A, in the range of A only: for a body that moves on
// a line, only that direction counts.
Eigen::Vector2d solved(const Eigen::Matrix2d& A, const Eigen::Vector2d& b) {
    const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(0, 1);
    const double largest = (A(0, 0) + A(1, 1)) / 2.0 + std::hypot((A(0, 0) - A(1, 1)) / 2.0, A(0, 1));
    if (!(largest > 0.0)) return Eigen::Vector2d::Zero();
    const double smallest = det / largest;
    if (smallest > 1e-9 * largest)
        return Eigen::Vector2d(A(1, 1) * b[0] - A(0, 1) * b[1], A(0, 0) * b[1] - A(0, 1) * b[0]) / det;
    const int column = A(0, 0) >= A(1, 1) ? 0 : 1;
    const Eigen::Vector2d direction = A.col(column).normalized();
    return direction * direction.dot(b) / largest;
}

Eigen::Matrix2d gram(const Vector& jx, const Vector& jy) {
    Eigen::Matrix2d A;
    A << jx.dot(jx), jx.dot(jy), jx.dot(jy), jy.dot(jy);
    return A;
}

}  // namespace

std::optional<Body> Body::of(AnchorPoint& grip, double t, const State& state) {
    const AnchorPoint::Hold here = grip.at(t, state);
    if (!std::isfinite(here.at.x) || !std::isfinite(here.at.y)) return std::nullopt;
    Body body;
    body.at_ = here.at;
    body.radius_ = here.radius;
    const auto n = state.q.size();
    body.jx_ = body.jy_ = Vector::Zero(n);
    if (here.depth) body.jz_ = body.jx_;
    for (Eigen::Index i = 0; i < n; ++i) {
        State moved = state;
        const double step = 1e-6 * std::max(1.0, std::abs(state.q[i]));
        moved.q[i] = state.q[i] + step;
        const AnchorPoint::Hold after = grip.at(t, moved);
        moved.q[i] = state.q[i] - step;
        const AnchorPoint::Hold before = grip.at(t, moved);
        body.jx_[i] = (after.at.x - before.at.x) / (2.0 * step);
        body.jy_[i] = (after.at.y - before.at.y) / (2.0 * step);
        if (here.depth) body.jz_[i] = (*after.depth - *before.depth) / (2.0 * step);
    }
    if (!body.jx_.allFinite() || !body.jy_.allFinite()) return std::nullopt;
    return body;
}

Point Body::velocity(const Vector& v) const { return {jx_.dot(v), jy_.dot(v)}; }

std::optional<Point> Body::force(const Vector& Q) const {
    if (jz_.size() > 0) {
        Eigen::MatrixXd slope(Q.size(), 3);
        slope << jx_, jy_, jz_;
        const Eigen::VectorXd F = least_solution(slope, Eigen::VectorXd(Q));
        return F.allFinite() ? std::optional(Point{F[0], F[1]}) : std::nullopt;
    }
    const Eigen::Vector2d F = solved(gram(jx_, jy_), {jx_.dot(Q), jy_.dot(Q)});
    const Vector rest = Q - F[0] * jx_ - F[1] * jy_;
    if (!(rest.norm() <= 1e-5 * Q.norm())) return std::nullopt;
    return Point{F[0], F[1]};
}

std::optional<Vector> Body::rates(const Vector& v, const Point& velocity) const {
    const Point now = this->velocity(v);
    const Eigen::Vector2d missing(velocity.x - now.x, velocity.y - now.y);
    const Eigen::Vector2d u = solved(gram(jx_, jy_), missing);
    const Vector result = v + u[0] * jx_ + u[1] * jy_;
    if (!result.allFinite()) return std::nullopt;
    return result;
}

namespace {

// The part of a direction along which the kept functions do not change.
Vector along(const KeptFunctions& kept, const Vector& direction) {
    if (kept.values.size() == 0) return direction;
    return direction - least_solution(kept.gradients, Eigen::VectorXd(kept.gradients * direction));
}

// Coordinates near q at which the kept functions are 0 (Newton).
Vector returned(const KeptFunctionsAt& kept, Vector q) {
    constexpr int rounds = 10;
    for (int round = 0; kept && round < rounds; ++round) {
        const KeptFunctions now = kept(q);
        if (now.values.size() == 0) break;
        const Eigen::VectorXd step = least_solution(now.gradients, Eigen::VectorXd(-now.values));
        q += step;
        if (!(step.norm() > 1e-14 * (1.0 + q.norm()))) break;
    }
    return q;
}

}  // namespace

void Body::keep(const KeptFunctions& kept) {
    jx_ = along(kept, jx_);
    jy_ = along(kept, jy_);
}

std::optional<Vector> held_at(AnchorPoint& grip, double t, const State& state, const Point& place,
                              const KeptFunctionsAt& kept) {
    constexpr int rounds = 30, max_halvings = 20;
    State now = state, next = state;
    const auto distance_at = [&](const State& there) {
        const Point at = grip.at(t, there).at;
        return std::hypot(place.x - at.x, place.y - at.y);
    };
    now.q = returned(kept, state.q);
    double distance = distance_at(now);
    for (int round = 0; round < rounds; ++round) {
        auto body = Body::of(grip, t, now);
        if (!body) return std::nullopt;
        if (distance < 1e-12) break;
        if (kept) body->keep(kept(now.q));
        const Vector zero = Vector::Zero(now.q.size());
        const auto step = body->rates(zero, {place.x - body->at().x, place.y - body->at().y});
        if (!step) return std::nullopt;
        // At most one unit (radian) per step, because the linearization of an angle is useless beyond that. The step of
        // a point that cannot reach the place, such as a pendulum pulled away from its pivot, may lead too far.
        double share = 1.0 / std::max(1.0, step->norm()), reached = distance;
        for (int halving = 0; halving < max_halvings && !(reached < distance); ++halving, share *= 0.5) {
            next.q = returned(kept, now.q + share * *step);
            reached = distance_at(next);
        }
        if (!(reached < distance)) break;
        const bool is_there = distance - reached < 1e-12 * (1.0 + distance);
        now.q = next.q;
        distance = reached;
        if (is_there) break;
    }
    return now.q;
}

Vector contact_force(const Trajectory& trajectory, const Sample& sample) {
    ContactForces forces(*trajectory.model, trajectory.run.parameters);
    forces.set(sample);
    return forces.generalized_force();
}

std::vector<WayPoint> way_of(const Trajectory& trajectory, double from, double to, const Drawing& seen,
                             const PlaceOf& place, std::span<const Sample> through) {
    Panel world;
    world.x.low = seen.x_low, world.x.high = seen.x_high;
    world.y.low = seen.y_low, world.y.high = seen.y_high;
    TraceRequest request;
    request.from = from, request.to = to;
    request.shown = {0};
    request.over_time = false;
    const double shape = (seen.y_high - seen.y_low) / (seen.x_high - seen.x_low);
    (shape < 1.0 ? request.size.height : request.size.width) = request.size.width * (shape < 1.0 ? shape : 1.0 / shape);
    if (shape >= 1.0) request.size.height = Resolution{}.width;
    request.through = through;
    const PanelMap map(world,
                       {0.0F, 0.0F, static_cast<float>(request.size.width), static_cast<float>(request.size.height)});
    request.map = &map;
    const Trace traced = trace(trajectory, request, [&](const Sample& sample, std::span<double> values) {
        const Point at = place(sample);
        values[0] = at.x, values[1] = at.y;
    });
    std::vector<WayPoint> way;
    for (std::size_t k = 0; k < traced.courses.size(); ++k) {
        const PhaseCurve& course = traced.courses[k];
        const PhaseLook look = phase_looks[k];
        if (!way.empty() && !course.points.empty()) way.push_back({to, look, break_of_curve});
        for (std::size_t i = 0; i < course.points.size(); ++i) way.push_back({course.times[i], look, course.points[i]});
    }
    return way;
}

void add_present(std::vector<WayPoint>& way, const WayPoint& now) {
    const auto is_there = [](const WayPoint& point) { return std::isfinite(point.at.x) && std::isfinite(point.at.y); };
    for (std::size_t i = 1; i < way.size(); ++i) {
        const WayPoint &a = way[i - 1], &b = way[i];
        if (b.look != now.look || !is_there(a) || !is_there(b) || !(a.t < now.t && now.t < b.t)) continue;
        way.insert(way.begin() + static_cast<std::ptrdiff_t>(i), now);
        return;
    }
}

Trail trail_of(const Mechanism& mechanism, const Trajectory& trajectory, std::span<const Sample> samples,
               const Drawing& limits, bool is_coarse) {
    Trail trail;
    auto grip = mechanism.grip(trajectory.run.parameters);
    if (!grip) return trail;
    trail.way = way_of(
        trajectory, trajectory.run.options.start_time, trajectory.end_time, limits,
        [&](const Sample& sample) { return grip->at(sample.t, sample.state).at; },
        is_coarse ? samples : std::span<const Sample>());
    const std::size_t stride = 1 + samples.size() / 300;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t = samples[i].t;
        const State& state = samples[i].state;
        trail.points.push_back(grip->at(t, state).at);
        if (i % stride != 0) continue;
        const auto body = Body::of(*grip, t, state);
        if (!body) continue;
        const Point v = body->velocity(state.v);
        const auto F = body->force(contact_force(trajectory, samples[i]));
        trail.arrows.push_back({body->at(), v, F.value_or(Point{})});
        trail.fastest = std::max(trail.fastest, std::hypot(v.x, v.y));
        if (F) trail.strongest = std::max(trail.strongest, std::hypot(F->x, F->y));
    }
    const auto divide = [](Point& p, double largest) { p = largest > 0.0 ? Point{p.x / largest, p.y / largest} : p; };
    for (Trail::Arrows& arrows : trail.arrows) {
        divide(arrows.velocity, trail.fastest);
        divide(arrows.force, trail.strongest);
    }
    return trail;
}

void add_body_trail(std::vector<DrawnShape>& shapes, std::span<const WayPoint> way, double t, const Theme& theme) {
    constexpr std::uint8_t passed = 150, to_come = 60;
    std::vector<DrawnShape> lines;
    const WayPoint* before = nullptr;  // null after a break
    for (const WayPoint& here : way) {
        const bool is_passed = here.t <= t;
        if (!std::isfinite(here.at.x) || !std::isfinite(here.at.y)) {
            before = nullptr;
            continue;
        }
        if (before == nullptr || here.look != before->look || is_passed != (before->t <= t)) {
            DrawnShape& line = lines.emplace_back();
            line.stroke = phase_stroke(theme, here.look, 0, 1);
            const bool in_contact = here.look != PhaseLook::flight;
            // In contact it lies on the line of the surface, which must not shine through.
            line.stroke.color.a = !is_passed ? to_come : in_contact ? 255 : passed;
            if (in_contact) line.stroke.width = 3.0, line.stroke.dash.clear();
            if (before != nullptr) line.points.push_back(before->at);
        }
        lines.back().points.push_back(here.at);
        before = &here;
    }
    // The future part lies below the past part.
    std::stable_partition(lines.begin(), lines.end(),
                          [&](const DrawnShape& line) { return line.stroke.color.a == to_come; });
    const auto first = std::find_if(shapes.begin(), shapes.end(), [](const DrawnShape& shape) { return shape.moves; });
    shapes.insert(first, lines.begin(), lines.end());
}

}  // namespace achilles
