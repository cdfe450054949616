#include "system/mechanism.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

TomlValue made(TomlValue::Kind kind, const Location& at, std::string text = {}) {
    TomlValue value;
    value.kind = kind;
    value.at = at;
    value.text = {std::move(text), at, false};
    return value;
}

}  // namespace

TomlValue made_string(std::string text, const Location& at) {
    return made(TomlValue::Kind::string, at, std::move(text));
}

TomlValue made_number(double number, const Location& at) {
    TomlValue value = made(TomlValue::Kind::number, at, fmt::format("{}", number));
    value.number = number;
    return value;
}

TomlValue made_boolean(bool boolean, const Location& at) {
    TomlValue value = made(TomlValue::Kind::boolean, at);
    value.boolean = boolean;
    return value;
}

TomlValue made_list(const Location& at) { return made(TomlValue::Kind::array, at); }

TomlValue made_point(const std::array<std::string, 2>& point, const Location& at) {
    TomlValue value = made_list(at);
    for (const std::string& text : point) value.items.push_back(made_string(text, at));
    return value;
}

TomlValue made_table(const Location& at) { return made(TomlValue::Kind::table, at); }

TomlValue* find_entry(TomlValue& table, std::string_view key) {
    for (TomlEntry& entry : table.entries)
        if (entry.key == key) return &entry.value;
    return nullptr;
}

TomlValue& set_entry(TomlValue& table, const std::string& key, TomlValue value) {
    if (TomlValue* known = find_entry(table, key)) return *known = std::move(value);
    const Location at = value.at;
    return table.entries.emplace_back(TomlEntry{key, at, std::move(value)}).value;
}

std::array<std::string, 2> world_point(const MechanismSymbols& symbols, const MovingPoint& point) {
    const auto [x, y] = components(point.position, {}, symbols.graph());
    return {symbols.text(x), symbols.text(y)};
}

namespace {

// Drawings are drawn in the order of their locations. Those of grounds, springs and bodies stand before the first line
// of the file, by layer; the marks of contacts, and surfaces of bodies, stand where they are typed.
enum class Layer { ground, connection, body };

constexpr const char *steel = "#7a8089", *pale = "#c3c8cf";

class MechanismPainter {
 public:
    MechanismPainter(const PlacedMechanism& mechanism, const std::vector<std::optional<ShapeContact>>& contacts)
        : mechanism_(mechanism), symbols_(mechanism.symbols()), contacts_(contacts), size_(extent()) {}

    MechanismDrawings draw() {
        MechanismDrawings result;
        result.of_contacts.resize(contacts_.size());
        for (const GroundSurface* ground : mechanism_.grounds()) {
            std::vector<std::size_t> touching;
            for (std::size_t i = 0; i < contacts_.size(); ++i)
                if (contacts_[i] && contacts_[i]->touched == ground) touching.push_back(i);
            std::vector<TomlValue>& drawings = touching.size() == 1 ? result.of_contacts[touching[0]] : result.free;
            if (is_surface_of_body(*ground))
                drawings.push_back(ground_drawing(*ground));
            else
                add(drawings, ground_drawing(*ground), Layer::ground);
        }
        for (std::size_t i = 0; i < mechanism_.springs.size(); ++i)
            if (!mechanism_.springs[i].is_hidden) draw_connection(i, result.free);
        for (const RigidBody* body : mechanism_.bodies()) {
            if (body->is_hidden) continue;
            if (auto drawing = body_drawing(*body)) add(result.free, std::move(*drawing), Layer::body);
            if (turns_visibly(*body)) add(result.free, spoke(*body), Layer::body);
            if (body->joint && body->shape != TouchShape::none) add(result.free, joint(*body), Layer::body);
        }
        for (std::size_t i = 0; i < contacts_.size(); ++i)
            if (contacts_[i]) mark_contact(*contacts_[i], result.of_contacts[i], result.free);
        return result;
    }

 private:
    // The size of the bodies, springs, strings and gaps at the start.
    double extent() const {
        double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
        const auto add = [&](const MovingPoint& point) {
            const auto place = components(point.position, {}, symbols_.graph());
            for (std::size_t k = 0; k < 2; ++k) {
                const double value = symbols_.at_start(place[k]);
                if (!std::isfinite(value)) continue;
                low[k] = std::min(low[k], value);
                high[k] = std::max(high[k], value);
            }
        };
        const Kinematics& kinematics = symbols_.kinematics();
        for (const RigidBody* body : mechanism_.bodies()) {
            add(body->frame.origin);
            for (const LocalPoint& corner : body->corners) add(kinematics.point_in(body->frame, corner.x, corner.y));
            if (body->radius.is_zero()) continue;
            add(kinematics.point_in(body->frame, body->radius, body->radius));
            add(kinematics.point_in(body->frame, -body->radius, -body->radius));
        }
        for (const SpringOrDamper& spring : mechanism_.springs)
            if (spring.between)
                for (const NamedPoint& end : *spring.between) add(end.point);
        double size = std::max(high[0] - low[0], high[1] - low[1]);
        for (const auto& contact : contacts_) {
            if (!contact) continue;
            const double apart = symbols_.at_start(contact->other ? contact->longest : contact->gap);
            if (std::isfinite(apart)) size = std::max(size, apart);
        }
        return std::isfinite(size) && size > 0.0 ? size : 1.0;
    }

    // A part of the size, with one digit.
    double part_of_size(double part) const { return read_number(fmt::format("{:.1g}", part * size_)).value; }

    // The same in hundredths; in millionths if that is 0.
    ProductSum length(double part) const {
        const long hundredths = std::lround(100.0 * part * size_);
        return hundredths != 0 ? symbols_.number(hundredths, 100)
                               : symbols_.number(std::lround(1e6 * part * size_), 1'000'000);
    }

    TomlValue shape(const char* name, const Location& at) const {
        TomlValue table = made_table(at);
        set_entry(table, "shape", made_string(name, at));
        return table;
    }
    static void add(std::vector<TomlValue>& drawings, TomlValue drawing, Layer layer) {
        drawing.at = {0, static_cast<int>(layer)};
        drawings.push_back(std::move(drawing));
    }
    void put(TomlValue& table, const char* key, const std::string& text) const {
        set_entry(table, key, made_string(text, table.at));
    }
    void put(TomlValue& table, const char* key, double number) const {
        set_entry(table, key, made_number(number, table.at));
    }
    void put_point(TomlValue& table, const char* key, const MovingPoint& point) const {
        set_entry(table, key, made_point(world_point(symbols_, point), table.at));
    }
    // The limits of a curve's parameter, which is called like the abscissa.
    ProductSum curve_parameter() const { return ProductSum::from(symbols_.graph().symbol(symbols_.abscissa())); }
    void put_over(TomlValue& curve, const std::array<std::string, 2>& limits) const {
        TomlValue over = made_point(limits, curve.at);
        over.items.insert(over.items.begin(), made_string(symbols_.text(curve_parameter()), curve.at));
        set_entry(curve, "over", std::move(over));
    }
    MovingPoint at(const PlacedShape& body, const LocalPoint& point) const {
        return symbols_.kinematics().point_in(body.frame, point.x, point.y);
    }
    void put_two(TomlValue& table, const PlacedShape& body) const {
        put_point(table, "from", at(body, body.corners[0]));
        put_point(table, "to", at(body, body.corners[1]));
    }

    // The surface of a body that is drawn needs no hatching.
    static bool is_surface_of_body(const GroundSurface& ground) {
        return ground.on != nullptr && ground.on->shape != TouchShape::none && !ground.on->is_hidden;
    }

    TomlValue ground_drawing(const GroundSurface& ground) const {
        if (ground.shape == TouchShape::line) {
            TomlValue drawing = shape(is_surface_of_body(ground) ? "segment" : "ground", ground.at);
            put_two(drawing, ground);
            return drawing;
        }
        if (ground.shape == TouchShape::curve) {
            TomlValue drawing = shape("curve", ground.at);
            put_point(drawing, "at", at(ground, {curve_parameter(), ProductSum::from(ground.height)}));
            put_over(drawing, {ground.over[0].text, ground.over[1].text});
            return drawing;
        }
        const bool is_disc = ground.shape == TouchShape::disc;
        TomlValue drawing = shape(is_disc ? "disc" : "circle", ground.at);
        put_point(drawing, "at", ground.frame.origin);
        put(drawing, "radius", symbols_.text(ground.radius));
        if (is_disc) put(drawing, "color", pale);
        return drawing;
    }

    // A disc with a spoke.
    static bool turns_visibly(const RigidBody& body) {
        return body.shape == TouchShape::disc && !body.frame.angle.is_zero() && !body.inertia.is_zero();
    }

    std::optional<TomlValue> body_drawing(const RigidBody& body) const {
        TomlValue drawing = made_table(body.at);
        switch (body.shape) {
            case TouchShape::rod:
                drawing = shape("segment", body.at);
                put_two(drawing, body);
                put(drawing, "width", rod_width);
                break;
            case TouchShape::disc:
            case TouchShape::ring:
                drawing = shape(body.shape == TouchShape::disc ? "disc" : "circle", body.at);
                put_point(drawing, "at", body.frame.origin);
                put(drawing, "radius", symbols_.text(body.radius));
                if (turns_visibly(body)) put(drawing, "color", pale);
                break;
            case TouchShape::box:
                drawing = shape("box", body.at);
                put(drawing, "color", steel);
                put_point(drawing, "at", body.frame.origin);
                set_entry(drawing, "size",
                          made_point({symbols_.text(body.size.x), symbols_.text(body.size.y)}, body.at));
                if (!body.frame.angle.is_zero()) put(drawing, "angle", symbols_.text(body.frame.angle));
                break;
            case TouchShape::polygon: {
                drawing = shape("polyline", body.at);
                put(drawing, "color", steel);
                set_entry(drawing, "fill", made_boolean(true, body.at));
                TomlValue points = made_list(body.at);
                for (std::size_t i = 0; i <= body.corners.size(); ++i)
                    points.items.push_back(
                        made_point(world_point(symbols_, at(body, body.corners[i % body.corners.size()])), body.at));
                set_entry(drawing, "points", std::move(points));
                break;
            }
            default:
                if (body.mass.is_zero()) return std::nullopt;  // a frame
                drawing = shape("disc", body.at);
                put_point(drawing, "at", at(body, body.center));
                put(drawing, "radius", part_of_size(0.03));
        }
        if (body.color.kind == TomlValue::Kind::string) set_entry(drawing, "color", body.color);
        if (body.width.kind != TomlValue::Kind::table) set_entry(drawing, "width", body.width);
        return drawing;
    }

    // Shows how a disc turns.
    TomlValue spoke(const RigidBody& body) const {
        TomlValue drawing = shape("segment", body.at);
        put_point(drawing, "from", body.frame.origin);
        put_point(drawing, "to", at(body, {body.radius, {}}));
        return drawing;
    }

    // The pin about which a body turns.
    TomlValue joint(const RigidBody& body) const {
        TomlValue drawing = shape("disc", body.at);
        put_point(drawing, "at", body.frame.origin);
        put(drawing, "radius", part_of_size(0.025));
        return drawing;
    }

    // A spring or damper; side by side if several have the same ends.
    void draw_connection(std::size_t index, std::vector<TomlValue>& drawings) const {
        const SpringOrDamper& spring = mechanism_.springs[index];
        if (!spring.between) return draw_torsion(spring, drawings);
        TomlValue drawing = shape(spring.is_damper ? "damper" : "spring", spring.at);
        const auto& [from, to] = *spring.between;
        long before = 0, all = 0;
        for (std::size_t i = 0; i < mechanism_.springs.size(); ++i) {
            const SpringOrDamper& other = mechanism_.springs[i];
            if (!other.between || other.is_hidden || (*other.between)[0].name != from.name ||
                (*other.between)[1].name != to.name)
                continue;
            before += i < index;
            ++all;
        }
        const PlanarVector aside = to_the_left(spring, 0.045 * static_cast<double>(all - 1 - 2 * before));
        for (const auto& [key, end] : {std::pair("from", &from), std::pair("to", &to)}) {
            NamedPoint here = *end;
            here.point.position = here.point.position + aside;
            put_point(drawing, key, here.point);
            draw_mount(here, spring.at, drawings);
        }
        put(drawing, "width", 1.5);
        add(drawings, std::move(drawing), Layer::connection);
    }

    // At the joint that turns by the angle: a spiral from the one body to the other, or a vane in a round housing. Nothing
    // if no joint does.
    void draw_torsion(const SpringOrDamper& spring, std::vector<TomlValue>& drawings) const {
        const auto turns_alike = [&](const ProductSum& turn) {
            return !symbols_.depends_on_coordinates(turn - spring.angle) ||
                   !symbols_.depends_on_coordinates(turn + spring.angle);
        };
        for (const RigidBody* body : mechanism_.bodies()) {
            if (!body->joint) continue;
            const ProductSum& angle = body->frame.angle;
            const bool is_of_joint = turns_alike(angle - *body->joint);
            if (!is_of_joint && !turns_alike(angle)) continue;
            const ProductSum s = curve_parameter(), pi = ProductSum::from(symbols_.graph().pi());
            const auto add_curve = [&](const ProductSum& direction, const ProductSum& distance) {
                TomlValue drawing = shape("curve", spring.at);
                MovingPoint place = body->frame.origin;
                place.position = place.position + PlanarVector(direction, distance, {});
                put_point(drawing, "at", place);
                put_over(drawing, {"0", "1"});
                put(drawing, "width", 1.5);
                add(drawings, std::move(drawing), Layer::connection);
            };
            if (spring.is_damper) {
                const ProductSum radius = length(0.055), two = symbols_.number(2);
                add_curve(angle + two * pi * s, radius);
                add_curve(angle + symbols_.number(1, 4) * pi, (two * s - symbols_.number(1)).packed() * radius);
            } else {
                const ProductSum base = is_of_joint ? *body->joint : ProductSum{};
                const ProductSum distance = (length(0.12) - s * length(0.055)).packed();
                add_curve(base + s * (angle - base + symbols_.number(6) * pi), distance);
            }
            return;
        }
    }

    // What holds an end that is on no body.
    void draw_mount(const NamedPoint& end, const Location& at, std::vector<TomlValue>& drawings) const {
        if (end.carrier != nullptr) return;
        for (const ProductSum& place : components(end.point.position, {}, symbols_.graph()))
            if (symbols_.depends_on_coordinates(place)) return;
        TomlValue drawing = shape("disc", at);
        put_point(drawing, "at", end.point);
        put(drawing, "radius", part_of_size(0.012));
        add(drawings, std::move(drawing), Layer::connection);
    }

    // The vector to the left of a spring whose length is this part of the size, with two digits.
    PlanarVector to_the_left(const SpringOrDamper& spring, double part) const {
        if (part == 0.0) return {};
        const ProductSum aside = length(part);
        const auto& [from, to] = *spring.between;
        const PlanarVector along = to.point.position - from.point.position;
        const PointDistance length = distance_between(mechanism_, from, to, true, spring.at);
        const auto apart = components(along, {}, symbols_.graph());
        if (apart[0].is_zero()) return {{}, symbols_.at_start(apart[1]) < 0.0 ? aside : -aside, {}};
        if (apart[1].is_zero()) return {{}, {}, symbols_.at_start(apart[0]) < 0.0 ? -aside : aside};
        PlanarVector left;
        for (const auto& [angle, x, y] : along.terms)
            left = left + PlanarVector(angle, -(aside * y.packed() / length.value), aside * x.packed() / length.value);
        return left;
    }

    // A string: a slack one sags by c sqrt(L^2 - d^2), where c = 0.43 makes it as long as it is for small sags.
    TomlValue string_drawing(const ShapeContact& contact) const {
        const Location at = contact.point.at;
        const MovingPoint &from = contact.point.point, &to = contact.other->point;
        const bool sags = !mechanism_.gravity[0].is_zero() || !mechanism_.gravity[1].is_zero();
        TomlValue drawing = shape(sags ? "curve" : "segment", at);
        put(drawing, "width", 1.5);
        if (!sags) {
            put_point(drawing, "from", from);
            put_point(drawing, "to", to);
            return drawing;
        }
        Graph& graph = symbols_.graph();
        const PlanarVector d = to.position - from.position;
        const ProductSum s = curve_parameter();
        const ProductSum &L = contact.longest, slack = power(L, 2) - dot(d, d, graph);
        // The tiny term keeps the root real where rounding makes the string a little too long.
        const ProductSum depth =
            square_root(square_root(power(slack, 2) + symbols_.number(1, 1'000'000'000'000) * power(L, 4)));
        const ProductSum sag = symbols_.number(172, 100) * s * (symbols_.number(1) - s).packed() * depth;
        PlanarVector place = from.position + PlanarVector({}, {}, -sag);
        for (const auto& [angle, x, y] : d.terms) place = place + PlanarVector(angle, s * x.packed(), s * y.packed());
        put_point(drawing, "at", {place, {}, {}});
        put_over(drawing, {"0", "1"});
        return drawing;
    }

    // What is touched, or the point that touches it.
    void mark_contact(const ShapeContact& contact, std::vector<TomlValue>& drawings,
                      std::vector<TomlValue>& free) const {
        const Location at = contact.point.at;
        if (contact.other) {
            for (const NamedPoint* end : {&contact.point, &*contact.other}) draw_mount(*end, at, free);
            add(drawings, string_drawing(contact), Layer::connection);
            return;
        }
        const PlacedShape* touched = contact.touched;
        if (touched != nullptr && !touched->is_ground) {
            const bool is_rod = touched->shape == TouchShape::rod;
            TomlValue outline = shape(is_rod ? "segment" : "circle", at);
            if (is_rod) {
                put_two(outline, *touched);
                put(outline, "width", rod_width);
                if (touched->width.kind != TomlValue::Kind::table) set_entry(outline, "width", touched->width);
            } else {
                put_point(outline, "at", touched->frame.origin);
                put(outline, "radius", symbols_.text(touched->radius));
            }
            drawings.push_back(std::move(outline));
        }
        const bool is_disc = contact.touches != nullptr && contact.point.is_whole;
        if (is_disc) return;
        TomlValue mark = shape("disc", at);
        put_point(mark, "at", contact.point.point);
        put(mark, "radius", part_of_size(0.015));
        drawings.push_back(std::move(mark));
    }

    static constexpr double rod_width = 5.0;  // pixels
    const PlacedMechanism& mechanism_;
    const MechanismSymbols& symbols_;
    const std::vector<std::optional<ShapeContact>>& contacts_;
    double size_;
};

}  // namespace

MechanismDrawings draw_mechanism(const PlacedMechanism& mechanism,
                                 const std::vector<std::optional<ShapeContact>>& contacts) {
    return MechanismPainter(mechanism, contacts).draw();
}

}  // namespace achilles
