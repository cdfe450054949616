#include "system/mechanism.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace achilles {

namespace {

// The other side of what is touched, for a start that is there.
struct FreeSide {
    TouchShape shape;
    const char *other, *hint;
};
constexpr FreeSide free_sides[] = {
    {TouchShape::line, "behind", "a line is free on the left of from-to; swap its ends?"},
    {TouchShape::rod, "behind", "a rod is free on the left of from-to; swap its ends?"},
    {TouchShape::disc, "inside", "choose a start outside: a disc is touched from outside; a ring from inside"},
    {TouchShape::ring, "outside", "choose a start inside: a ring is touched from inside; a disc from outside"},
    {TouchShape::curve, "below", "a curve is free above"}};

// For two points, which do not touch each other.
constexpr std::string_view join_advice =
    "for a string between two points add longest = its length; two points that stay together are a closed loop: choose "
    "coordinates that close the loop, or use a stiff spring";

class ContactReader {
 public:
    ContactReader(PlacedMechanism& mechanism, const Fields& fields)
        : mechanism_(mechanism),
          symbols_(mechanism.symbols()),
          kinematics_(symbols_.kinematics()),
          graph_(symbols_.graph()),
          fields_(fields),
          between_(fields.need("between")) {}

    ShapeContact read() {
        two_items(fields_, "between", between_, "[what touches, what is touched]");
        const TomlValue* longest = fields_.find("longest");
        if (longest != nullptr) {
            read_string(*longest);
        } else {
            read_touching(between_.items[0]);
            read_touched(between_.items[1]);
            touch();
        }
        const TomlValue* normal = fields_.find("normal");
        const bool is_curve = result_.touched != nullptr && result_.touched->shape == TouchShape::curve;
        if (normal != nullptr && (longest != nullptr || !is_curve))
            throw Mistake{normal->at, "'normal' goes with a curve only: every other gap is a distance", "leave it out"};
        if (!symbols_.depends_on_coordinates(result_.gap))
            throw Mistake{between_.at,
                          fmt::format("the gap of {} depends on no coordinate: h = {}", result_.name,
                                      shown(symbols_.text(result_.gap))),
                          "what touches or what is touched must move with a coordinate"};
        return std::move(result_);
    }

 private:
    void read_string(const TomlValue& longest) {
        const NamedPoint from = mechanism_.read_point(between_.items[0], fields_, "between", nullptr);
        const NamedPoint to = mechanism_.read_point(between_.items[1], fields_, "between", nullptr);
        if (mechanism_.is_rigid(from, to)) refuse_one_body(from.carrier);
        if (fields_.find("friction"))
            throw Mistake{fields_.find("friction")->at, "a string has no friction", "leave out 'friction'"};
        const ProductSum length =
            mechanism_.read(fields_.expression("longest", longest), MechanismSymbols::Allowed::constants_and_time);
        if (symbols_.at_start(length) <= 0.0)
            throw Mistake{longest.at, fmt::format("'longest' must be positive, not {}", symbols_.at_start(length)), {}};
        result_.gap = length - distance_between(mechanism_, from, to, false, between_.at).value;
        result_.longest = length;
        result_.has_slip = false;
        result_.name = fmt::format("string from {} to {}", from.name, to.name);
        result_.force = "lambda is the tension";
        result_.behind =
            fmt::format("'{}' and '{}' start {{:.4g}} farther apart than the string is long", from.name, to.name);
        result_.hint = "choose a nearer start or a longer string";
        result_.point = from;
        result_.other = to;
        result_.touches = from.carrier;
    }

    [[noreturn]] void refuse_one_body(const PlacedShape* body) const {
        throw Mistake{between_.at,
                      fmt::format("both ends are on one body, {}: their distance does not change",
                                  body ? "'" + body->name + "'" : "the world"),
                      "a contact is between two bodies, or a body and a ground"};
    }

    // What touches: a point, or a body with a disc.
    void read_touching(const TomlValue& value) {
        result_.point = mechanism_.read_point(value, fields_, "between", nullptr);
        const NamedPoint& point = result_.point;
        result_.touches = point.carrier;
        if (point.carrier == nullptr || !point.is_whole) return;
        const PlacedShape& shape = *point.carrier;
        if (shape.is_ground)
            throw Mistake{point.at, fmt::format("'{}' is a ground: it is what is touched", shape.name),
                          fmt::format("write between = [what touches, \"{}\"]", shape.name)};
        if (shape.shape == TouchShape::disc) {
            radius_ = shape.radius;
            result_.point.point = shape.frame.origin;
            return;
        }
        if (shape.shape == TouchShape::none) return;
        std::vector<std::string> corners;
        for (const auto& [name, at] : shape.points)
            if (name != "center") corners.push_back(shape.name + "." + name);
        throw Mistake{point.at, fmt::format("'{}' cannot touch as a whole: only a point or a disc touches", shape.name),
                      shape.shape == TouchShape::ring
                          ? fmt::format("a hoop is disc = r, inertia = \"m*r^2\"")
                          : fmt::format("name a corner, one [[constraint]] for each: {}", listed(corners))};
    }

    void read_touched(const TomlValue& value) {
        if (value.kind != TomlValue::Kind::string)
            throw Mistake{value.at, "nothing can be touched at a point",
                          fmt::format("name a ground or a body; {}", join_advice)};
        const NamedPoint named = mechanism_.find_point(value.text, nullptr);
        const PlacedShape* shape = named.carrier;
        const bool can_be_touched = shape != nullptr && named.is_whole &&
                                    (shape->is_ground || shape->shape == TouchShape::rod ||
                                     shape->shape == TouchShape::disc || shape->shape == TouchShape::ring);
        if (!can_be_touched)
            throw Mistake{value.text.at, fmt::format("'{}' has nothing that can be touched", shown(value.text.text)),
                          fmt::format("a ground, or a body with a rod, a disc or a ring can; {}", join_advice)};
        if (result_.point.carrier == shape) refuse_one_body(shape);
        result_.touched = shape;
    }

    void touch() {
        const PlacedShape& touched = *result_.touched;
        const bool is_curve = touched.shape == TouchShape::curve;
        const auto* side = std::find_if(std::begin(free_sides), std::end(free_sides),
                                        [&](const FreeSide& each) { return each.shape == touched.shape; });
        result_.name = fmt::format("{} {} {}", result_.point.name, touched.shape == TouchShape::ring ? "inside" : "on",
                                   touched.name);
        result_.force = "a distance: lambda is the force";
        result_.behind = fmt::format("'{}' starts {{:.4g}} {} '{}'", result_.point.name, side->other, touched.name);
        result_.hint = side->hint;
        if (touched.is_ground) speed_ = static_cast<const GroundSurface&>(touched).speed;
        turning_ = touched.frame.turning();
        if (result_.touches != nullptr) spin_ = result_.touches->frame.turning();
        const bool is_body = result_.touches != nullptr && !result_.touches->is_ground && result_.point.is_whole;
        const auto* body = is_body ? static_cast<const RigidBody*>(result_.touches) : nullptr;
        if (body != nullptr && body->on == &touched && !(is_curve && radius_.is_zero())) return touch_carrier(*body);
        if (is_curve) return touch_curve(static_cast<const GroundSurface&>(touched));
        if (touched.radius.is_zero()) return touch_line(touched);
        touch_round(touched);
    }

    // A body on the ground that it touches, at [s, d]: h = d - r.
    void touch_carrier(const RigidBody& body) {
        result_.gap = body.height - radius_;
        result_.slip = body.along + radius_ * (spin_ - turning_) - speed_;
        if (result_.touched->shape == TouchShape::curve)
            result_.force = "a distance while it is below the radius of curvature of every valley: lambda is the force";
    }

    // The place and the velocity of what touches relative to a point of the touched body, as vectors.
    struct RelativeMotion {
        PlanarVector place, velocity;
    };
    RelativeMotion relative_to(const MovingPoint& origin) const {
        const MovingPoint& p = result_.point.point;
        return {p.position - origin.position, p.motion() - origin.motion()};
    }

    // h = n.(p - a) - r, slip = e.(v_p - v_a) - W e.J(p - a) + r (w - W) - speed, with the tangent e and J a quarter turn.
    void touch_line(const PlacedShape& line) {
        mechanism_.check_direction(line, between_.items[1].text.at);
        const LocalPoint e = symbols_.direction(line), &a = line.corners[0];
        const ProductSum& axes = line.frame.angle;
        const PlanarVector tangent(axes, e.x, e.y), normal(axes, -e.y, e.x);
        const RelativeMotion motion = relative_to(kinematics_.point_in(line.frame, a.x, a.y));
        const ProductSum height = dot(normal, motion.place, graph_);
        result_.gap = height - radius_;
        result_.slip = dot(tangent, motion.velocity, graph_) + turning_.packed() * height.packed() +
                       radius_ * (spin_ - turning_) - speed_;
    }

    // With the distance |d| of the centers: outside h = |d| - r - R, slip = -d x v/|d| + r w + R W - speed;
    // inside a ring h = R - r - |d|, slip = d x v/|d| + r w - R W - speed.
    void touch_round(const PlacedShape& round) {
        const bool is_inside = round.shape == TouchShape::ring;
        NamedPoint center;
        center.point = round.frame.origin;
        center.name = round.name;
        const RelativeMotion motion = relative_to(center.point);
        const ProductSum distance = distance_between(mechanism_, center, result_.point, false, between_.at).value;
        const ProductSum turning = cross(motion.place, motion.velocity, graph_).packed() / distance;
        const ProductSum& R = round.radius;
        result_.gap = is_inside ? R - radius_ - distance : distance - radius_ - R;
        result_.slip = is_inside ? turning + radius_ * spin_ - R * turning_ - speed_
                                 : radius_ * spin_ + R * turning_ - turning - speed_;
    }

    // In the axes of the curve h = y - f(x), slip = x' + f' (y' - f_t) - sqrt(1 + f'^2) speed.
    void touch_curve(const GroundSurface& curve) {
        const bool is_normal = fields_.flag_or("normal", false);
        if (!radius_.is_zero()) refuse_disc_on_curve(curve);
        const RelativeMotion motion = relative_to(curve.frame.origin);
        const auto [x, y] = components(motion.place, curve.frame.angle, graph_);
        auto [x_rate, y_rate] = components(motion.velocity, curve.frame.angle, graph_);
        x_rate = x_rate + turning_.packed() * y.packed();
        y_rate = y_rate - turning_.packed() * x.packed();
        const std::uint32_t slots[] = {symbols_.abscissa()};
        const Expression at[] = {x.expression(graph_)};
        const auto at_x = [&](Expression of_x) { return ProductSum::from(substitute(of_x, slots, at)); };
        const ProductSum slope = at_x(derivative(curve.height, symbols_.abscissa()));
        const ProductSum f_t = at_x(derivative(curve.height, kinematics_.time()));
        const ProductSum stretch = square_root(symbols_.number(1) + power(slope, 2));
        result_.gap = y - at_x(curve.height);
        result_.slip = x_rate + slope.packed() * (y_rate - f_t) - stretch * speed_;
        if (slope.is_zero()) return;
        if (is_normal) {
            result_.gap = result_.gap.packed() / stretch;
            result_.slip = result_.slip.packed() / stretch;
            result_.force = "scaled to a distance at contact: lambda is the force";
        } else {
            result_.scale = stretch;
            result_.force = fmt::format("a height: the force is {}*lambda", symbols_.text(stretch));
        }
    }

    [[noreturn]] void refuse_disc_on_curve(const GroundSurface& curve) const {
        const std::string& disc = result_.touches->name;
        throw Mistake{
            between_.at,
            fmt::format("the distance of the disc '{}' from the curve '{}' has no closed form", disc, curve.name),
            fmt::format("use coordinates s, along the curve, and d: place the body with on = \"{}\", at = [\"s\", "
                        "\"{} + d\"]; then between = [\"{}\", \"{}\"] gives the gap d, exact while {} + d is "
                        "below the radius of curvature of every valley",
                        curve.name, symbols_.text(radius_), disc, curve.name, symbols_.text(radius_))};
    }

    PlacedMechanism& mechanism_;
    const MechanismSymbols& symbols_;
    const Kinematics& kinematics_;
    Graph& graph_;
    const Fields& fields_;
    const TomlValue& between_;
    ProductSum radius_, spin_, turning_, speed_;
    ShapeContact result_;
};

}  // namespace

ShapeContact read_contact(PlacedMechanism& mechanism, const Fields& fields) {
    return ContactReader(mechanism, fields).read();
}

}  // namespace achilles
