// Grounds, bodies placed on grounds, springs and loads of a mechanism.
#include <fmt/format.h>

#include <algorithm>

#include "system/keys.hpp"
#include "system/mechanism.hpp"

namespace achilles {

void PlacedMechanism::place_ground(GroundSurface& ground, const Fields& fields) {
    PlacedShape* on = on_of(fields);
    if (on != nullptr && on->is_ground)
        throw Mistake{fields.string("on").at, fmt::format("'{}' is a ground: a ground stands on a body", on->name),
                      "leave out 'on', or make a body that carries both"};
    const Kinematics& kinematics = symbols_.kinematics();
    ground.frame = on ? on->frame : world_.frame;
    ground.on = on;
    read_shape(ground, fields);
    if (ground.shape == TouchShape::none)
        fields.need("line", {ground.at, fmt::format("the ground '{}' has no shape", ground.name),
                             "write one of: line = [from, to], curve = \"f(x)\", disc = r, ring = r"});
    const bool is_round = ground.shape == TouchShape::disc || ground.shape == TouchShape::ring;
    if (const TomlValue* at = fields.find("at")) {
        if (!is_round)
            throw Mistake{at->at, "'at' belongs to a disc or a ring",
                          "write the place into line or curve, or put the ground on a body without mass"};
        ground.frame = kinematics.frame_at(read_point(*at, fields, "at", on).point, ground.frame, {});
    }
    if (const TomlValue* speed = fields.find("speed"))
        ground.speed = read(fields.expression("speed", *speed), Allowed::constants_and_time);
    if (ground.shape == TouchShape::line) check_direction(ground, fields.need("line").at);
    if (const TomlValue* over = fields.find("over"); over != nullptr && ground.shape != TouchShape::curve)
        throw Mistake{over->at, "'over' belongs to a curve", "leave it out: a line is infinite"};
    if (ground.shape != TouchShape::curve) return;
    ground.height = read(fields.expression("curve"), Allowed::curve).expression(symbols_.graph());
    fields.need("over", {ground.at, fmt::format("missing key 'over' in {}", fields.where()),
                         "write over = [low, high], where the curve is drawn"});
    const TomlValue& over = *fields.find("over");
    const std::vector<TomlValue>& limits = two_items(fields, "over", over, "where the curve is drawn, [low, high]");
    ground.over = {substituted(fields.expression("over", limits[0])),
                   substituted(fields.expression("over", limits[1]))};
}

// Places a body at [s, d], and finds the velocity of its origin along the tangent, in the axes of the ground.
void PlacedMechanism::place_on_ground(RigidBody& body, const Fields& fields, const GroundSurface& ground) {
    const Kinematics& kinematics = symbols_.kinematics();
    const TomlValue* at = fields.find("at");
    if (at == nullptr || at->kind != TomlValue::Kind::array)
        throw Mistake{at ? at->at : body.at,
                      fmt::format("'{}' is on the ground '{}': 'at' must be [s, d]", body.name, ground.name),
                      "s is the place along the ground, d the distance from it to the free side"};
    const LocalPoint place = read_local(*at, fields, "at", Allowed::positions);
    const ProductSum &s = place.x, &d = place.y, s_rate = kinematics.change_of(s);
    body.height = d;
    body.placement = fmt::format("on {} at `{}`, `{}` from it", ground.name, symbols_.text(s), symbols_.text(d));
    const MovingFrame& base = ground.frame;
    if (ground.shape == TouchShape::curve) return place_on_curve(body, place, ground);
    if (ground.shape == TouchShape::line) {
        const LocalPoint& from = ground.corners[0];
        body.frame = kinematics.frame_at(kinematics.point_in(base, from.x, from.y), base,
                                         symbols_.angle_of(symbols_.direction(ground)));
        body.frame.origin = kinematics.point_in(body.frame, s, d);
        body.along = s_rate;
        return;
    }
    // The tangent is the normal turned right: clockwise around a disc, counterclockwise in a ring.
    const ProductSum side = symbols_.number(ground.shape == TouchShape::disc ? 1 : -1);
    const ProductSum distance = ground.radius + side * d;
    body.frame = kinematics.frame_at(base.origin, base, s);
    body.frame.origin = kinematics.point_in(body.frame, distance, {});
    body.frame.angle = body.frame.angle - side * symbols_.number(1, 2) * ProductSum::from(symbols_.graph().pi());
    body.along = -(side * distance.packed() * s_rate);
}

// The velocity along the curve is s' times S - d f''/S^2 with S = sqrt(1 + f'^2), in the axes of its tangent.
void PlacedMechanism::place_on_curve(RigidBody& body, const LocalPoint& place, const GroundSurface& curve) {
    const Kinematics& kinematics = symbols_.kinematics();
    Graph& graph = symbols_.graph();
    const ProductSum &s = place.x, &d = place.y, one = symbols_.number(1), height = d.packed();
    const MovingFrame& base = curve.frame;
    const std::uint32_t x = symbols_.abscissa(), slots[] = {x};
    const Expression place_on_x[] = {s.expression(graph)};
    const auto at_s = [&](Expression of_x) { return ProductSum::from(substitute(of_x, slots, place_on_x)); };
    const Expression slope = derivative(curve.height, x);
    const ProductSum f = at_s(curve.height), fx = at_s(slope), fxx = at_s(derivative(slope, x));
    const ProductSum f_t = at_s(derivative(curve.height, kinematics.time()));
    const ProductSum stretch = square_root(one + power(fx, 2)), tilt = ProductSum::function(Operation::atan, fx, graph);
    const ProductSum tangent = base.angle + tilt;
    const ProductSum tilt_rate = fxx / power(stretch, 2) * kinematics.rate_of(s),
                     tilt_drift = kinematics.drift_of(fx) / power(stretch, 2);
    const ProductSum factor = (stretch - height * fxx / power(stretch, 2)).packed();
    const ProductSum along = factor * kinematics.rate_of(s),
                     drift_along = stretch * kinematics.drift_of(s) - height * tilt_drift;
    MovingPoint& origin = body.frame.origin;
    origin.position = base.origin.position + PlanarVector(base.angle, s, f) + PlanarVector(tangent, {}, height);
    const auto turning = [&](const ProductSum& rate) {
        return PlanarVector(base.angle, -(rate * f), rate * s) + PlanarVector(tangent, -(rate * height), {});
    };
    origin.velocity = base.origin.velocity + turning(base.rate) + PlanarVector(tangent, along, kinematics.rate_of(d));
    origin.drift = base.origin.drift + turning(base.drift) + PlanarVector(base.angle, {}, f_t) +
                   PlanarVector(tangent, drift_along, kinematics.drift_of(d));
    body.frame.angle = tangent;
    body.frame.rate = base.rate + tilt_rate;
    body.frame.drift = base.drift + tilt_drift;
    body.along = along + drift_along;
}

void PlacedMechanism::check_direction(const PlacedShape& shape, const Location& at) const {
    const LocalPoint &from = shape.corners[0], &to = shape.corners[1];
    if (symbols_.is_constant(to.x - from.x) && symbols_.is_constant(to.y - from.y)) return;
    throw Mistake{at,
                  fmt::format("the direction of the {} '{}', which is touched, must not change",
                              shape.is_ground ? "line" : "rod", shape.name),
                  "turn the axes that it is in: put it on a body without mass that turns"};
}

bool PlacedMechanism::is_rigid(const NamedPoint& a, const NamedPoint& b) const {
    if (a.carrier != b.carrier) return false;
    const ProductSum axes = a.carrier ? a.carrier->frame.angle : ProductSum{};
    const auto apart = components(b.point.position - a.point.position, axes, symbols_.graph());
    return symbols_.is_constant(apart[0]) && symbols_.is_constant(apart[1]);
}

void PlacedMechanism::read_springs(const TomlValue& root, const char* key) {
    for (Fields& fields : tables(root, key, mistakes_)) {
        fields.allow(keys_of(fields.where()), mistakes_);
        mistakes_.attempt([&] {
            SpringOrDamper spring;
            spring.at = fields.table().at;
            spring.is_damper = fields.where() == "[[damper]]";
            const TomlValue *between = fields.find("between"), *angle = fields.find("angle");
            if ((between == nullptr) == (angle == nullptr))
                fields.need("between", {angle ? angle->at : spring.at,
                                        fmt::format("{} needs either 'between' or 'angle'", fields.where()),
                                        "between = [point, point], or angle = \"an expression\""});
            if (between != nullptr && angle != nullptr)
                throw Mistake{angle->at, fmt::format("{} needs either 'between' or 'angle'", fields.where()), {}};
            if (between != nullptr) {
                const std::vector<TomlValue>& ends = two_items(fields, "between", *between, "two points");
                spring.between = {read_point(ends[0], fields, "between", nullptr),
                                  read_point(ends[1], fields, "between", nullptr)};
                if (is_rigid((*spring.between)[0], (*spring.between)[1]))
                    throw Mistake{
                        between->at,
                        fmt::format("both ends are on one body, {}",
                                    (*spring.between)[0].carrier ? (*spring.between)[0].carrier->name : "world"),
                        "an end belongs to another body, or to the world"};
            } else {
                spring.angle = read(fields.expression("angle"), Allowed::positions);
            }
            const char* const coefficient = spring.is_damper ? "damping" : "stiffness";
            spring.coefficient =
                read(fields.expression(coefficient), spring.is_damper ? Allowed::rates : Allowed::positions).packed();
            const auto check_sign = [&](const char* key_of_value, const char* what, const ProductSum& value) {
                const double number = symbols_.at_start(value);
                if (number < 0.0)
                    throw Mistake{fields.need(key_of_value).at,
                                  fmt::format("the {} is negative at the start: {}", what, number),
                                  {}};
            };
            if (!spring.is_damper) {
                if (between != nullptr)
                    fields.need("rest", {spring.at, "missing key 'rest' in [[spring]]: its length without force",
                                         "write rest = 0 for a spring that pulls its ends together"});
                if (fields.find("rest")) spring.rest = read(fields.expression("rest"), Allowed::positions);
                if (between != nullptr) check_sign("rest", "rest length", spring.rest);
            }
            check_sign(coefficient, coefficient, spring.coefficient);
            spring.is_hidden = fields.flag_or("hidden", false);
            springs.push_back(std::move(spring));
        });
    }
}

void PlacedMechanism::read_loads(const TomlValue& root, const char* key) {
    for (Fields& fields : tables(root, key, mistakes_)) {
        fields.allow(keys_of(fields.where()), mistakes_);
        mistakes_.attempt([&] {
            AppliedLoad load;
            load.at = fields.table().at;
            if (fields.where() == "[[force]]")
                read_force(load, fields);
            else
                read_torque(load, fields);
            loads.push_back(std::move(load));
        });
    }
}

void PlacedMechanism::read_force(AppliedLoad& load, const Fields& fields) {
    PlacedShape* on = on_of(fields);
    load.axes = on ? on->frame : world_.frame;
    load.point = read_point(fields.need("at"), fields, "at", on);
    load.force = read_local(fields.need("value"), fields, "value", Allowed::rates);
    if (const TomlValue* against = fields.find("against"))
        load.against_point = read_point(*against, fields, "against", nullptr);
}

void PlacedMechanism::read_torque(AppliedLoad& load, const Fields& fields) {
    const auto body_of = [&](const char* key) {
        const Text name = fields.string(key);
        const PlacedShape* shape = find(name);
        if (shape == nullptr && std::string(key) == "on")
            throw Mistake{name.at, "a torque acts on a body, not on the world", {}};
        if (shape != nullptr && shape->is_ground)
            throw Mistake{name.at, fmt::format("'{}' is a ground: a torque acts on a body", name.text), {}};
        return static_cast<const RigidBody*>(shape);
    };
    load.body = body_of("on");
    if (fields.find("against")) load.against = body_of("against");
    load.torque = read(fields.expression("value"), Allowed::rates);
}

}  // namespace achilles
