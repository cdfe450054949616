#include "system/mechanism_drawings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace achilles {

TomlValue made_string(std::string text, const Location& at) {
    TomlValue value;
    value.kind = TomlValue::Kind::string;
    value.at = at;
    value.text = {std::move(text), at, false};
    return value;
}

TomlValue made_number(double number, const Location& at) {
    TomlValue value;
    value.kind = TomlValue::Kind::number;
    value.at = at;
    value.number = number;
    value.text = {fmt::format("{}", number), at, false};
    return value;
}

TomlValue made_point(const std::array<std::string, 2>& point, const Location& at) {
    TomlValue value;
    value.kind = TomlValue::Kind::array;
    value.at = at;
    for (const std::string& text : point) value.items.push_back(made_string(text, at));
    return value;
}

TomlValue made_table(const Location& at) {
    TomlValue value;
    value.at = at;
    return value;
}

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
            (touching.size() == 1 ? result.of_contacts[touching[0]] : result.free).push_back(ground_drawing(*ground));
        }
        for (std::size_t i = 0; i < mechanism_.springs.size(); ++i)
            if (mechanism_.springs[i].between && !mechanism_.springs[i].is_hidden)
                result.free.push_back(spring_drawing(i));
        for (const RigidBody* body : mechanism_.bodies()) {
            if (body->is_hidden) continue;
            if (auto drawing = body_drawing(*body)) result.free.push_back(std::move(*drawing));
            if (body->shape == TouchShape::disc && !body->frame.angle.is_zero() && !body->inertia.is_zero())
                result.free.push_back(spoke(*body));
        }
        for (std::size_t i = 0; i < contacts_.size(); ++i)
            if (contacts_[i]) mark_contact(*contacts_[i], result.of_contacts[i]);
        return result;
    }

 private:
    // The size of the bodies and springs at the start.
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
        const double size = std::max(high[0] - low[0], high[1] - low[1]);
        return std::isfinite(size) && size > 0.0 ? size : 1.0;
    }

    // A part of the size, with one digit.
    double part_of_size(double part) const { return read_number(fmt::format("{:.1g}", part * size_)).value; }

    TomlValue shape(const char* name, const Location& at) const {
        TomlValue table = made_table(at);
        set_entry(table, "shape", made_string(name, at));
        return table;
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
    MovingPoint at(const PlacedShape& body, const LocalPoint& point) const {
        return symbols_.kinematics().point_in(body.frame, point.x, point.y);
    }
    void put_two(TomlValue& table, const PlacedShape& body) const {
        put_point(table, "from", at(body, body.corners[0]));
        put_point(table, "to", at(body, body.corners[1]));
    }

    TomlValue ground_drawing(const GroundSurface& ground) const {
        if (ground.shape == TouchShape::line) {
            TomlValue drawing = shape("ground", ground.at);
            put_two(drawing, ground);
            return drawing;
        }
        if (ground.shape == TouchShape::curve) {
            TomlValue drawing = shape("curve", ground.at);
            const ProductSum x = ProductSum::from(symbols_.graph().symbol(symbols_.abscissa()));
            put_point(drawing, "at", at(ground, {x, ProductSum::from(ground.height)}));
            TomlValue over = made_point({ground.over[0].text, ground.over[1].text}, ground.at);
            over.items.insert(over.items.begin(), made_string(symbols_.text(x), ground.at));
            set_entry(drawing, "over", std::move(over));
            return drawing;
        }
        TomlValue drawing = shape(ground.shape == TouchShape::disc ? "disc" : "circle", ground.at);
        put_point(drawing, "at", ground.frame.origin);
        put(drawing, "radius", symbols_.text(ground.radius));
        return drawing;
    }

    std::optional<TomlValue> body_drawing(const RigidBody& body) const {
        TomlValue drawing = made_table(body.at);
        switch (body.shape) {
            case TouchShape::rod:
                drawing = shape("segment", body.at);
                put_two(drawing, body);
                put(drawing, "width", 5.0);
                break;
            case TouchShape::disc:
            case TouchShape::ring:
                drawing = shape(body.shape == TouchShape::disc ? "disc" : "circle", body.at);
                put_point(drawing, "at", body.frame.origin);
                put(drawing, "radius", symbols_.text(body.radius));
                break;
            case TouchShape::box:
                drawing = shape("box", body.at);
                put_point(drawing, "at", body.frame.origin);
                set_entry(drawing, "size",
                          made_point({symbols_.text(body.size.x), symbols_.text(body.size.y)}, body.at));
                if (!body.frame.angle.is_zero()) put(drawing, "angle", symbols_.text(body.frame.angle));
                break;
            case TouchShape::polygon: {
                drawing = shape("polyline", body.at);
                TomlValue points = made_point({}, body.at);
                points.items.clear();
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
        put(drawing, "color", "#3a4048");
        return drawing;
    }

    // A spring or damper; one beside another if both have the same ends on one vertical or horizontal line.
    TomlValue spring_drawing(std::size_t index) const {
        const SpringOrDamper& spring = mechanism_.springs[index];
        TomlValue drawing = shape(spring.is_damper ? "damper" : "spring", spring.at);
        std::array<MovingPoint, 2> ends{(*spring.between)[0].point, (*spring.between)[1].point};
        long before = 0;
        for (std::size_t i = 0; i < index; ++i) {
            const auto& other = mechanism_.springs[i].between;
            before +=
                other && (*other)[0].name == (*spring.between)[0].name && (*other)[1].name == (*spring.between)[1].name;
        }
        const auto along = components(ends[1].position - ends[0].position, {}, symbols_.graph());
        if (before > 0 && (along[0].is_zero() || along[1].is_zero())) {
            const long hundredths = std::max(1L, std::lround(10.0 * size_ * static_cast<double>(before)));
            const ProductSum aside = symbols_.number(hundredths, 100);
            for (MovingPoint& end : ends)
                end.position =
                    end.position + (along[0].is_zero() ? PlanarVector({}, aside, {}) : PlanarVector({}, {}, aside));
        }
        put_point(drawing, "from", ends[0]);
        put_point(drawing, "to", ends[1]);
        return drawing;
    }

    // What is touched, or the point that touches it.
    void mark_contact(const ShapeContact& contact, std::vector<TomlValue>& drawings) const {
        const Location at = contact.point.at;
        if (contact.other) {
            TomlValue string = shape("segment", at);
            put_point(string, "from", contact.point.point);
            put_point(string, "to", contact.other->point);
            put(string, "width", 1.5);
            drawings.push_back(std::move(string));
            return;
        }
        const PlacedShape* touched = contact.touched;
        if (touched != nullptr && !touched->is_ground) {
            TomlValue outline = shape(touched->shape == TouchShape::rod ? "segment" : "circle", at);
            if (touched->shape == TouchShape::rod) {
                put_two(outline, *touched);
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
