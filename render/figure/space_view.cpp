#include "figure/space_view.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "figure/body.hpp"
#include "figure/camera.hpp"
#include "figure/contact_geometry.hpp"
#include "figure/field.hpp"

namespace achilles {

namespace {

using Place = SpaceView::Place;

constexpr double degree = std::numbers::pi / 180.0;

// Whether the coordinates have these names.
bool are_named(const Model& model, const std::array<std::string_view, 3>& names) {
    const auto& coordinates = model.description().coordinates;
    return std::equal(names.begin(), names.end(), coordinates.begin(), coordinates.end(),
                      [](std::string_view name, const CoordinateDescription& one) { return one.name == name; });
}

bool is_cylindrical(const Model& model) { return are_named(model, {"r", "phi", "z"}); }

// The slope of the place in a picture, by the coordinates: two rows. nullopt without a body that moves.
std::optional<Eigen::Matrix<double, 2, 3>> slope_of(const Mechanism& mechanism, const Run& run) {
    auto grip = mechanism.grip(run.parameters);
    const auto body = grip ? Body::of(*grip, run.options.start_time, run.start()) : std::nullopt;
    if (!body) return std::nullopt;
    Eigen::Matrix<double, 2, 3> slope;
    for (int i = 0; i < 3; ++i) {
        const Point moved = body->velocity(Vector(Eigen::Vector3d::Unit(i)));
        slope.col(i) << moved.x, moved.y;
    }
    return slope;
}

Point in_picture(const Place& seen) { return {seen.x(), seen.y()}; }

}  // namespace

ViewAngles rounded(const ViewAngles& angles) {
    const double about = std::round(angles.about), tilt = std::round(angles.tilt);
    return {about - 360.0 * std::round(about / 360.0), std::clamp(tilt, -90.0, 90.0)};
}

bool SpaceView::shows(const Model& model) {
    if (!are_named(model, {"x", "y", "z"}) && !is_cylindrical(model)) return false;
    const Run run = model.default_run();
    const Eigen::Matrix3d slope = SpaceView(model, {}).slope(run.q);
    auto energy = model.evaluator(model.energy(), run.parameters);
    const auto kinetic = [&](const Eigen::Vector3d& rates) {
        set_state(energy, {run.q, Vector(rates), run.options.start_time});
        energy.run();
        return energy.kinetic() / (slope * rates).squaredNorm();
    };
    const double all = kinetic({1.0, 1.0, 1.0});
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(kinetic(Eigen::Vector3d::Unit(i)) - all) < 1e-9 * all)) return false;
    return true;
}

SpaceView::SpaceView(const Model& model, const ViewAngles& angles) : is_cylindrical_(is_cylindrical(model)) {
    // The cosine of 90 degrees is 0, so that a view from above has no trace of the height.
    const auto cosine = [](double of) { return std::abs(of) == 90.0 ? 0.0 : std::cos(of * degree); };
    const double ca = cosine(angles.about), sa = std::sin(angles.about * degree);
    const double cb = cosine(angles.tilt), sb = std::sin(angles.tilt * degree);
    axes_ << ca, -sa, 0.0, sb * sa, sb * ca, cb, -sa * cb, -ca * cb, sb;
}

Place SpaceView::place(const Vector& q) const {
    if (!is_cylindrical_) return {q[0], q[1], q[2]};
    return {q[0] * std::cos(q[1]), q[0] * std::sin(q[1]), q[2]};
}

Eigen::Matrix3d SpaceView::slope(const Vector& q) const {
    Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();
    if (is_cylindrical_)
        slope << std::cos(q[1]), -q[0] * std::sin(q[1]), 0.0, std::sin(q[1]), q[0] * std::cos(q[1]), 0.0, 0.0, 0.0, 1.0;
    return slope;
}

Eigen::Vector3d SpaceView::coordinates(const Place& place) const {
    if (!is_cylindrical_) return place;
    return {std::hypot(place.x(), place.y()), std::atan2(place.y(), place.x()), place.z()};
}

ViewAngles drawn_angles(const Mechanism& mechanism, const Model& model) {
    const Run run = model.default_run();
    const auto drawn = slope_of(mechanism, run);
    if (!drawn) return {};
    const Eigen::Matrix<double, 2, 3> slope = *drawn * SpaceView(model, {}).slope(run.q).inverse();
    if (!slope.allFinite() || !(std::hypot(slope(0, 0), slope(0, 1)) > 1e-6 * slope.norm())) return {};
    const double about = std::atan2(-slope(0, 1), slope(0, 0));
    const double tilt = std::atan2(std::sin(about) * slope(1, 0) + std::cos(about) * slope(1, 1), slope(1, 2));
    return rounded({about / degree, tilt / degree});
}

SpaceBox::SpaceBox(const SpaceView& view, std::span<const Sample> samples) : middle(0.0, 0.0, 0.0), half(middle) {
    Place low = Place::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Sample& sample : samples)
        if (const Place place = view.place(sample.state.q); place.allFinite())
            low = low.cwiseMin(place), high = high.cwiseMax(place);
    if (!low.allFinite()) low = high = Place::Zero();
    middle = 0.5 * (low + high), half = 0.5 * (high - low);
    if (!(half.maxCoeff() > 0.0)) half = Place::Ones();
}

// ---- surfaces ----

SpaceSurfaces::SpaceSurfaces(const Model& model, std::span<const double> parameters, const SpaceView& view,
                             std::span<const Sample> samples)
    : model_(&model),
      parameters_(parameters.begin(), parameters.end()),
      view_(view),
      box_(view, samples),
      nets_(model.contacts()) {}

SpaceSurfaces::Gap SpaceSurfaces::gap(std::size_t contact, double t, const State& state) const {
    auto program = model_->evaluator(model_->gap(contact), parameters_);
    State here = state;
    here.t = t;
    set_state(program, here);
    return [program, view = view_](const Place& place) mutable {
        const Eigen::Vector3d q = view.coordinates(place);
        for (int i = 0; i < 3; ++i) program.input(static_cast<std::size_t>(i)) = q[i];
        program.run();
        return program.output(0);
    };
}

namespace {

template <class Gap>
Place slope_at(Gap& gap, const Place& place, double step) {
    Place slope;
    for (int i = 0; i < 3; ++i) {
        const Place way = step * Place::Unit(i);
        slope[i] = (gap(place + way) - gap(place - way)) / (2.0 * step);
    }
    return slope;
}

// The axis along which a gap changes most in a box. The surface is best drawn by its cuts with planes across the other
// two: of a floor, those are lines to the right and lines into the depth.
template <class Gap>
int steepest_axis(Gap& gap, const Place& middle, const Place& half) {
    Place sum = Place::Zero();
    constexpr std::array steps{-1.0, -0.4, 0.3, 0.9};
    for (const double x : steps)
        for (const double y : steps)
            for (const double z : steps) {
                const Place slope = slope_at(gap, middle + half.cwiseProduct(Place(x, y, z)), 1e-6 * half.maxCoeff());
                if (slope.allFinite() && slope.norm() > 0.0) sum += slope.cwiseAbs() / slope.norm();
            }
    int most = 2;
    for (const int axis : {1, 0})
        if (sum[axis] > 1.001 * sum[most]) most = axis;
    return most;
}

}  // namespace

const SpaceSurfaces::Net& SpaceSurfaces::net(std::size_t contact, const Sample& now) const {
    auto& known = nets_[contact];
    const std::uint32_t clock = model_->layout().t();
    if (known && (known->t == now.t || !depends_on(model_->equations().gaps[contact], {&clock, 1}))) return *known;
    known.emplace().t = now.t;
    // Lines are apart by a round length, about an eighth of the run, and reach half that far beyond it.
    const double apart = round_length(box_.size() / 8.0), beyond = 0.3 * box_.size();
    const Place half = box_.half + Place::Constant(beyond), low = box_.middle - half, high = box_.middle + half;
    Gap gap = this->gap(contact, now.t, now.state);
    const int steepest = steepest_axis(gap, box_.middle, half);
    for (const int across : {0, 1, 2}) {
        if (across == steepest) continue;
        const int right = across == 0 ? 1 : 0, up = across == 2 ? 1 : 2;
        Drawing plane;
        plane.x_low = low[right], plane.x_high = high[right], plane.y_low = low[up], plane.y_high = high[up];
        for (double at = apart * std::ceil(low[across] / apart); at <= high[across]; at += apart) {
            const auto in_space = [&](const Point& p) {
                Place place;
                place[across] = at, place[right] = p.x, place[up] = p.y;
                return place;
            };
            constexpr int cells = 40;
            const ScalarField cut(
                plane, [&](const Point& p) { return gap(in_space(p)); }, cells, cells);
            Line line;
            for (const Point& p : joined(cut.zero_line())) line.push_back(in_space(p));
            if (!line.empty()) known->lines.push_back(std::move(line));
        }
    }
    return *known;
}

void SpaceSurfaces::add(Drawing& drawing, const Sample& now, const Theme& theme) const {
    std::vector<DrawnShape> shapes;
    for (std::size_t contact = 0; contact < model_->contacts(); ++contact) {
        Color color = theme.surface;
        color.a = now.mode.is_held(contact) ? 200 : 110;  // the body has the color of the phase, and the trail
        for (const Line& line : net(contact, now).lines) {
            DrawnShape& shape = shapes.emplace_back();
            shape.stroke = {color, 1.0, {}};
            for (const Place& place : line) shape.points.push_back(in_picture(view_.seen(place)));
        }
    }
    drawing.shapes.insert(drawing.shapes.begin(), shapes.begin(), shapes.end());
}

void SpaceSurfaces::rest(Drawing& drawing, double t, const State& state) const {
    for (DrawnShape& shape : drawing.shapes) {
        if (shape.kind != DrawnShape::Kind::disc || !shape.moves) continue;
        const Place here = view_.place(state.q);
        std::vector<std::pair<Eigen::Vector3d, double>> wanted;
        for (std::size_t contact = 0; contact < model_->contacts(); ++contact) {
            Gap gap = this->gap(contact, t, state);
            const Place slope = slope_at(gap, here, 1e-6 * box_.size());
            if (!slope.allFinite() || !(slope.norm() > 0.0)) continue;
            const double far = std::max(0.0, gap(here) / slope.norm()) / (2.0 * shape.radius);
            wanted.emplace_back(slope / slope.norm(), shape.radius * std::exp(-far * far));
        }
        shape.points[0] = in_picture(view_.seen(here + min_way(wanted)));
    }
}

void SpaceSurfaces::add_axes(Drawing& drawing, const Theme& theme) const {
    const double side = std::min(drawing.x_high - drawing.x_low, drawing.y_high - drawing.y_low);
    const double length = 0.1 * side;
    const Point from{drawing.x_low + 1.7 * length, drawing.y_low + 1.7 * length};
    for (int i = 0; i < 3; ++i) {
        constexpr std::array names{"x", "y", "z"};
        const Point way = in_picture(view_.seen(length * Place::Unit(i)));
        if (!(std::hypot(way.x, way.y) > 0.2 * length)) continue;  // toward the viewer
        DrawnShape& line = drawing.shapes.emplace_back();
        line.points = {from, {from.x + way.x, from.y + way.y}};
        line.stroke = {theme.faint, 1.5, {}};
        DrawnShape& name = drawing.shapes.emplace_back();
        name.kind = DrawnShape::Kind::text;
        const double beyond = 1.0 + 0.45 * length / std::hypot(way.x, way.y);
        name.points = {{from.x + beyond * way.x, from.y + beyond * way.y}};
        name.text = names[static_cast<std::size_t>(i)];
        name.stroke.color = theme.faint;
    }
}

}  // namespace achilles
