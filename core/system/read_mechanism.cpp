// Reads the tables of bodies, grounds, springs and forces, and places the bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expression/name_suggestions.hpp"
#include "system/keys.hpp"
#include "system/mechanism.hpp"

namespace achilles {

namespace {

constexpr std::size_t max_shapes = 200;    // bodies and grounds
constexpr std::size_t max_text = 1000000;  // characters of an expression with the values of bodies

}  // namespace

const std::vector<TomlValue>& two_items(const Fields& fields, std::string_view key, const TomlValue& value,
                                        std::string_view expected) {
    if (value.kind != TomlValue::Kind::array) throw fields.wrong_type(key, value, expected);
    const std::size_t n = value.items.size();
    if (n != 2)
        throw Mistake{
            value.at,
            fmt::format("'{}' in {} must be {}, not {} item{}", key, fields.where(), expected, n, n == 1 ? "" : "s"),
            {}};
    return value.items;
}

std::vector<std::string_view> dotted_names_in(std::string_view text) {
    std::vector<std::string_view> names;
    for (std::size_t at = 0; at < text.size();) {
        const auto letter_at = [&](std::size_t i) { return i < text.size() && is_name(text.substr(i, 1)); };
        const auto is_part = [&](std::size_t i) {
            return letter_at(i) || (i < text.size() && ((text[i] >= '0' && text[i] <= '9') || text[i] == '_'));
        };
        std::size_t end = at;
        while (is_part(end) || (end < text.size() && text[end] == '.' && letter_at(end + 1))) ++end;
        while (end > at && end < text.size() && text[end] == '\'') ++end;
        if (letter_at(at)) names.push_back(text.substr(at, end - at));
        at = std::max(end, at + 1);
    }
    return names;
}

namespace {

std::vector<std::string> split_at_dots(const std::string& name) {
    std::vector<std::string> parts(1);
    for (const char c : name) {
        if (c == '.')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::vector<std::string> point_names(const PlacedShape& shape) {
    std::vector<std::string> names{"origin"};
    for (const auto& [name, point] : shape.points) names.push_back(name);
    return names;
}

Mistake unknown_point(const Text& name, const std::string& point, const PlacedShape& shape) {
    const std::vector<std::string> known = point_names(shape);
    return {name.at, fmt::format("unknown point '{}' of '{}'{}", shown(point), shape.name, did_you_mean(point, known)),
            fmt::format("points of '{}' are: {}", shape.name, listed(known))};
}

// The names of the contacts, before their tables are read.
std::vector<std::string> contacts_named_in(const TomlValue& root) {
    std::vector<std::string> names;
    ErrorCollector reported_later;
    const std::vector<Fields> list = tables(root, "constraint", reported_later);
    for (const Fields& fields : list) {
        const TomlValue* const name = fields.find("name");
        if (name != nullptr && name->kind == TomlValue::Kind::string) names.push_back(name->text.text);
        if (name == nullptr && list.size() == 1) names.emplace_back("contact");
    }
    return names;
}

}  // namespace

PlacedMechanism::PlacedMechanism(const TomlValue& root, const SystemDescription& system, Names& names,
                                 ErrorCollector& mistakes)
    : symbols_(system, contacts_named_in(root)), names_(names), mistakes_(mistakes), system_(system) {
    world_.name = "world";
    list_names(root, "ground");
    list_names(root, "body");
    mistakes_.attempt([&] { read_world(root); });
    for (Entry& entry : entries_) mistakes_.attempt([&] { place(entry); });
    for (const char* key : {"spring", "damper"}) read_springs(root, key);
    for (const char* key : {"force", "torque"}) read_loads(root, key);
}

// The names of all bodies and grounds, before any of them is placed.
void PlacedMechanism::list_names(const TomlValue& root, const char* key) {
    const std::size_t before_tables = mistakes_.count();
    std::vector<Fields> list = tables(root, key, mistakes_);
    are_names_complete_ = are_names_complete_ && names_.complete && mistakes_.count() == before_tables;
    for (Fields& fields : list) {
        const std::size_t before = mistakes_.count();
        fields.allow(keys_of(fields.where()), mistakes_);
        const bool has_unknown_keys = mistakes_.count() > before;
        const bool is_ground = fields.where() == "[[ground]]";
        const bool is_listed = mistakes_.attempt([&] {
            const Text name = fields.string("name");
            if (!is_name(name.text)) throw no_name(name);
            if (is_world(name.text)) throw Mistake{name.at, "the name 'world' is reserved", "choose another name"};
            if (Entry* other = entry_of(name.text)) {
                other->state = Entry::State::failed;  // either of the two may be meant
                throw Mistake{name.at, fmt::format("the name '{}' is used twice", name.text),
                              fmt::format("it is already the name at line {}: bodies and grounds need different names",
                                          other->shape().name_at.line)};
            }
            if (entries_.size() == max_shapes)
                throw Mistake{fields.table().at, fmt::format("more than {} bodies and grounds", max_shapes), {}};
            Entry entry{fields, nullptr, nullptr, has_unknown_keys};
            if (is_ground)
                entry.ground = std::make_unique<GroundSurface>();
            else
                entry.body = std::make_unique<RigidBody>();
            PlacedShape& shape = entry.shape();
            shape.name = name.text;
            shape.is_ground = is_ground;
            shape.name_at = name.at;
            shape.at = fields.table().at;
            entries_.push_back(std::move(entry));
        });
        are_names_complete_ = are_names_complete_ && is_listed;
    }
}

PlacedMechanism::Entry* PlacedMechanism::entry_of(const std::string& name) {
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.shape().name == name; });
    return entry == entries_.end() ? nullptr : &*entry;
}

void PlacedMechanism::refuse_unknown(const Text& name) const {
    if (!are_names_complete_) throw ErrorAlreadyReported{};
    std::vector<std::string> known{"world"};
    for (const Entry& entry : entries_) known.push_back(entry.shape().name);
    throw Mistake{name.at,
                  fmt::format("unknown body or ground '{}'{}", shown(name.text), did_you_mean(name.text, known)),
                  world_.points.contains(name.text) ? fmt::format("write \"world.{}\"", name.text)
                                                    : fmt::format("bodies and grounds are: {}", listed(known))};
}

PlacedShape* PlacedMechanism::find(const Text& name) {
    if (is_world(name.text)) return nullptr;
    Entry* entry = entry_of(name.text);
    if (entry == nullptr) refuse_unknown(name);
    place(*entry);
    return &entry->shape();
}

NamedPoint PlacedMechanism::find_point(const Text& name, PlacedShape* on) {
    const std::vector<std::string> parts = split_at_dots(name.text);
    if (parts.size() > 2)
        throw Mistake{name.at, fmt::format("'{}' is not a point", shown(name.text)),
                      "a point is [x, y], a body, or a body and a point, as in \"thigh.end\""};
    const bool is_alone = parts.size() == 1;
    const bool is_of_on = is_alone && on != nullptr && (on->points.contains(name.text) || name.text == "origin");
    if (is_alone && on != nullptr && !is_of_on && !entry_of(name.text) && !is_world(name.text))
        throw unknown_point(name, name.text, *on);
    NamedPoint result;
    result.carrier = is_of_on ? on : find({parts[0], name.at, name.is_written});
    result.name = is_of_on ? on->name + "." + name.text : name.text;
    result.is_whole = is_alone && !is_of_on;
    result.at = name.at;
    const PlacedShape& shape = result.carrier ? *result.carrier : world_;
    const std::string& point_name = parts.back();
    const auto point = shape.points.find(point_name);
    if (result.is_whole || point_name == "origin")
        result.point = shape.frame.origin;
    else if (point != shape.points.end())
        result.point = symbols_.kinematics().point_in(shape.frame, point->second.x, point->second.y);
    else
        throw unknown_point(name, point_name, shape);
    return result;
}

NamedPoint PlacedMechanism::read_point(const TomlValue& value, const Fields& fields, std::string_view key,
                                       PlacedShape* on, const std::string& own) {
    if (value.kind == TomlValue::Kind::string) return find_point(value.text, on);
    if (value.kind != TomlValue::Kind::array)
        throw fields.wrong_type(key, value, "a point, [x, y] or a name such as \"thigh.end\"");
    const LocalPoint local = read_local(value, fields, key, Allowed::positions, own);
    NamedPoint result;
    result.point = symbols_.kinematics().point_in(on ? on->frame : world_.frame, local.x, local.y);
    result.carrier = on;
    result.at = value.at;
    result.name = fmt::format("[{}, {}]", symbols_.text(local.x), symbols_.text(local.y));
    if (on != nullptr) result.name += " of " + on->name;
    return result;
}

LocalPoint PlacedMechanism::read_local(const TomlValue& value, const Fields& fields, std::string_view key,
                                       Allowed allowed, const std::string& own) {
    const std::array<Text, 2> texts = fields.point(key, value);
    return {read(texts[0], allowed, own), read(texts[1], allowed, own)};
}

// A value such as thigh.end.x' or thigh.angle, for the name of it.
ProductSum PlacedMechanism::value_of(const std::string& token, const Location& at) {
    const std::string name = token.substr(0, token.find('\''));
    const bool is_rate = name.size() < token.size();
    std::vector<std::string> parts = split_at_dots(name);
    const std::string last = parts.back();
    const Kinematics& kinematics = symbols_.kinematics();
    if (token.size() > name.size() + 1)
        throw Mistake{at, fmt::format("{} is an acceleration", token), "it follows from the equations of motion"};
    const bool is_number = parts.size() > 1 && (last == "x" || last == "y" || last == "angle");
    if (!is_number) {
        if (parts.size() > 1) find_point({parts[0] + "." + parts[1], at}, nullptr);  // reports unknown names
        if (parts.size() > 2)
            throw Mistake{at, fmt::format("'{}' is not a coordinate of a point", name),
                          fmt::format("write {0}.{1}.x or {0}.{1}.y", parts[0], parts[1])};
        const Entry* entry = entry_of(parts[0]);
        const char* what = parts.size() > 1 ? "point" : entry == nullptr ? "place" : entry->ground ? "ground" : "body";
        throw Mistake{
            at, fmt::format("'{}' is a {}, and a number is needed here", name, what),
            fmt::format("write {0}.x or {0}.y{1}", name, parts.size() > 1 ? "" : fmt::format(", or {}.angle", name))};
    }
    parts.pop_back();
    if (last == "angle") {
        if (parts.size() > 1)
            throw Mistake{at, fmt::format("the point '{}.{}' has no angle", parts[0], parts[1]),
                          fmt::format("write {}.angle", parts[0])};
        const PlacedShape* shape = find({parts[0], at});
        const MovingFrame& frame = shape ? shape->frame : world_.frame;
        return is_rate ? frame.turning() : frame.angle;
    }
    const NamedPoint point = find_point({name.substr(0, name.size() - last.size() - 1), at}, nullptr);
    const PlanarVector vector = is_rate ? point.point.motion() : point.point.position;
    return components(vector, {}, kinematics.graph())[last == "x" ? 0 : 1];
}

Text PlacedMechanism::substituted(const Text& text, const std::string& own, const std::string& own_value) {
    Text result = text;
    result.text.clear();
    const auto has_meaning = [&](const std::string& name) {
        return names_.places.contains(name) || !names_.why_reserved(name).empty() || name == own;
    };
    std::size_t done = 0;  // of the original
    for (const std::string_view token : dotted_names_in(text.text)) {
        const auto begin = static_cast<std::size_t>(token.data() - text.text.data()), end = begin + token.size();
        const std::string bare(token.substr(0, token.find('\''))), first = bare.substr(0, bare.find('.'));
        const bool is_known = entry_of(first) != nullptr || is_world(first);
        const std::size_t next = std::min(text.text.find_first_not_of(' ', end), text.text.size());
        const bool is_own = token == own && !own_value.empty();
        if (!is_own && (first == bare ? !is_known || has_meaning(bare)
                                      : !is_known && text.text.compare(next, 1, "(") == 0))  // np.sin(x)
            continue;
        std::string value = own_value;
        try {
            if (!is_own) value = symbols_.text(value_of(std::string(token), place_in(text, begin)));
        } catch (const ExpressionTooLarge& problem) {
            throw Mistake{place_in(text, begin), fmt::format("{} is too large: {}", token, problem.what()), {}};
        }
        const bool is_alone = begin == text.text.find_first_not_of(' ') && next == text.text.size();
        result.text += text.text.substr(done, begin - done);
        result.pieces.push_back({result.text.size(), place_in(text, begin), false});
        result.text += is_alone || is_name(value) ? value : "(" + value + ")";
        result.pieces.push_back({result.text.size(), place_in(text, end), text.is_written});
        if (result.text.size() > max_text)
            throw Mistake{text.at, "this expression is too large with the values of bodies", {}};
        done = end;
    }
    result.text += text.text.substr(done);
    return result;
}

ProductSum PlacedMechanism::read(const Text& text, Allowed allowed, const std::string& own) {
    const Text plain = substituted(text, own);
    try {
        if (own.empty()) return ProductSum::from(parse(plain.text, symbols_.scope(allowed), symbols_.graph()));
        Scope scope = symbols_.scope(allowed);
        scope.allowed.insert_or_assign(own, symbols_.graph().symbol(symbols_.abscissa()));
        return ProductSum::from(parse(plain.text, scope, symbols_.graph()));
    } catch (const ParseError& error) {
        const std::string bare = error.name.substr(0, error.name.find('\''));
        const bool is_unknown = !error.name.empty() && !symbols_.scope(allowed).forbidden.contains(error.name);
        if (is_unknown && !is_reserved(bare)) {
            if (!names_.complete || names_.reported.contains(bare)) throw ErrorAlreadyReported{};
            names_.reported.insert(bare);
        }
        const auto apart = measured(text.text);
        const bool has_unit = apart && !symbols_.scope(allowed).allowed.contains(apart->unit);
        throw Mistake{place_in(plain, error.offset), error.what(),
                      has_unit ? "write the number alone, in kg, m, s, rad and N" : error.hint};
    } catch (const std::domain_error& error) {
        throw Mistake{text.at, error.what(), {}};
    }
}

PlacedShape* PlacedMechanism::on_of(const Fields& fields) {
    return fields.find("on") ? find(fields.string("on")) : nullptr;
}

// A length or another size that is positive, or may be 0, at the start.
ProductSum PlacedMechanism::read_positive(const Fields& fields, std::string_view key, const TomlValue& value,
                                          bool may_be_zero) {
    const ProductSum size = read(fields.expression(key, value), Allowed::constants);
    const double number = symbols_.at_start(size);
    if (may_be_zero ? number < 0.0 : number <= 0.0)
        throw Mistake{value.kind == TomlValue::Kind::string ? value.text.at : value.at,
                      fmt::format("'{}' in {} must {}, not {}", key, fields.where(),
                                  may_be_zero ? "not be negative" : "be positive", number),
                      {}};
    return size;
}

void PlacedMechanism::place(Entry& entry) {
    using enum Entry::State;
    PlacedShape& shape = entry.shape();
    if (entry.state == done) return;
    if (entry.state == failed) throw ErrorAlreadyReported{};
    if (entry.state == on_the_way) {
        std::vector<std::string> circle(std::find(way_.begin(), way_.end(), shape.name), way_.end());
        circle.push_back(shape.name);
        throw Mistake{shape.name_at,
                      fmt::format("the bodies are placed on each other in a circle: {}", fmt::join(circle, " -> ")),
                      fmt::format("place one of them by coordinates; {}", closed_loop_advice)};
    }
    entry.state = on_the_way;
    way_.push_back(shape.name);
    const bool is_placed = attempt_part(mistakes_, shape.at, fmt::format("the place of '{}'", shape.name), [&] {
        if (entry.body)
            place_body(*entry.body, entry.fields);
        else
            place_ground(*entry.ground, entry.fields);
    });
    way_.pop_back();
    entry.state = is_placed && !entry.has_unknown_keys ? done : failed;
    if (entry.state == failed) throw ErrorAlreadyReported{};
}

void PlacedMechanism::read_world(const TomlValue& root) {
    const TomlValue* table = find_entry(root, "world");
    if (table == nullptr) return;
    Fields fields(*table, "[world]");
    fields.allow(keys_of("[world]"), mistakes_);
    mistakes_.attempt([&] { read_points(world_, fields); });
    if (const TomlValue* value = fields.find("gravity")) {
        gravity_at = value->at;
        const bool is_string = value->kind == TomlValue::Kind::string;
        if (is_string || value->kind == TomlValue::Kind::number)
            throw Mistake{
                value->at, "'gravity' in [world] must be a vector [gx, gy]",
                fmt::format("write gravity = [0, {0}{1}{0}]", is_string ? "\"" : "", shown(value->text.text))};
        const LocalPoint g = read_local(*value, fields, "gravity", Allowed::constants_and_time);
        gravity = {g.x, g.y};
    }
}

void PlacedMechanism::place_body(RigidBody& body, const Fields& fields) {
    const Kinematics& kinematics = symbols_.kinematics();
    PlacedShape* on = on_of(fields);
    body.on = on;
    const TomlValue* angle = fields.find("angle");
    const ProductSum turn = angle ? read(fields.expression("angle"), Allowed::positions) : ProductSum{};
    if (on != nullptr && on->is_ground) {
        place_on_ground(body, fields, static_cast<GroundSurface&>(*on));
        body.frame = kinematics.frame_at(body.frame.origin, body.frame, turn);
    } else {
        const MovingFrame& axes = on ? on->frame : world_.frame;
        const TomlValue* at = fields.find("at");
        NamedPoint origin;
        origin.point = axes.origin;
        origin.name = on ? on->name : "the origin";
        if (at != nullptr) origin = read_point(*at, fields, "at", on);
        body.frame = kinematics.frame_at(origin.point, axes, turn);
        if (at == nullptr) origin.carrier = on;
        body.joint = joint_of(body, origin);
        body.placement = "at " + origin.name;
    }
    if (angle != nullptr) body.placement += fmt::format(", rotated by `{}`", symbols_.text(turn));
    if (angle != nullptr && on != nullptr) body.placement += " against " + on->name;
    read_shape(body, fields);
    read_mass(body, fields);
    body.points.insert_or_assign("center", body.center);
    read_points(body, fields);
    body.is_hidden = fields.flag_or("hidden", false);
    if (const TomlValue* color = fields.find("color")) body.color = *color;
    if (const TomlValue* width = fields.find("width")) body.width = *width;
}

std::optional<ProductSum> PlacedMechanism::joint_of(const RigidBody& body, const NamedPoint& origin) const {
    const MovingFrame& base = origin.carrier ? origin.carrier->frame : world_.frame;
    const auto place = components(origin.point.position - base.origin.position, base.angle, symbols_.graph());
    const bool turns = symbols_.depends_on_coordinates(body.frame.angle - base.angle);
    if (!turns || symbols_.depends_on_coordinates(place[0]) || symbols_.depends_on_coordinates(place[1])) return {};
    return base.angle;
}

void PlacedMechanism::read_points(PlacedShape& shape, const Fields& fields) {
    const TomlValue* points = fields.find("points");
    if (points == nullptr) return;
    if (points->kind != TomlValue::Kind::table)
        throw fields.wrong_type("points", *points, "a table of points, as in {grip = [0, 1]}");
    for (const TomlEntry& entry : points->entries)
        mistakes_.attempt([&] {
            constexpr std::string_view of_every_body = "x y angle origin center";
            const bool is_reserved_name = has_word(of_every_body, entry.key) || shape.points.contains(entry.key);
            if (!is_name(entry.key)) throw no_name({entry.key, entry.at});
            if (is_reserved_name)
                throw Mistake{entry.at, fmt::format("the point name '{}' is reserved", entry.key),
                              "choose another name"};
            LocalPoint& point = shape.points[entry.key];  // also after a mistake, so that the name is known
            point = read_local(entry.value, fields, "points", Allowed::positions);
        });
}

namespace {

struct ShapeKey {
    const char* key;
    TouchShape shape;
};
constexpr ShapeKey shape_keys[] = {
    {"rod", TouchShape::rod},         {"disc", TouchShape::disc}, {"ring", TouchShape::ring},  {"box", TouchShape::box},
    {"polygon", TouchShape::polygon}, {"line", TouchShape::line}, {"curve", TouchShape::curve}};

}  // namespace

// True if a vector is 0 for the parameters of the file.
bool PlacedMechanism::is_zero_at_start(const LocalPoint& vector) const {
    const auto is_nothing = [&](const ProductSum& part) {
        return part.is_zero() || (symbols_.is_constant(part) && symbols_.at_start(part) == 0.0);
    };
    return is_nothing(vector.x) && is_nothing(vector.y);
}

void PlacedMechanism::read_shape(PlacedShape& shape, const Fields& fields) {
    const ShapeKey* found = nullptr;
    for (const ShapeKey& each : shape_keys) {
        const TomlValue* value = fields.find(each.key);
        if (value == nullptr) continue;
        if (found != nullptr)
            throw Mistake{value->at, fmt::format("'{}' has two shapes: {} and {}", shape.name, found->key, each.key),
                          shape.is_ground ? "write one [[ground]] for each"
                                          : "write one [[body]] for each, the second with on = \"" + shape.name + "\""};
        found = &each;
    }
    if (found == nullptr) return;
    const TomlValue& value = *fields.find(found->key);
    shape.shape = found->shape;
    const auto read_corners = [&](const std::vector<std::string>& names) {
        for (std::size_t i = 0; i < value.items.size(); ++i) {
            if (value.items[i].kind == TomlValue::Kind::string)
                throw Mistake{
                    value.items[i].text.at,
                    fmt::format("'{}' in {} is described in axes of its own, by [x, y]", found->key, fields.where()),
                    fmt::format("place its start with at, and turn it with angle; {}", closed_loop_advice)};
            shape.corners.push_back(read_local(value.items[i], fields, found->key, Allowed::positions));
            shape.points.emplace(i < names.size() ? names[i] : fmt::format("corner{}", i + 1), shape.corners[i]);
        }
    };
    switch (found->shape) {
        case TouchShape::disc:
        case TouchShape::ring:
            shape.radius = read_positive(fields, found->key, value, false);
            break;
        case TouchShape::rod:
        case TouchShape::line:
            two_items(fields, found->key, value, "two points, [from, to]");
            read_corners({"start", "end"});
            if (is_zero_at_start({shape.corners[1].x - shape.corners[0].x, shape.corners[1].y - shape.corners[0].y}))
                throw Mistake{
                    value.at, fmt::format("'{}' in {}: its ends are one point", found->key, fields.where()), {}};
            break;
        case TouchShape::polygon:
            if (value.kind != TomlValue::Kind::array || value.items.size() < 3)
                throw Mistake{
                    value.at, fmt::format("'polygon' in {} must be at least three points", fields.where()), {}};
            read_corners({});
            break;
        case TouchShape::box: {
            two_items(fields, "box", value, "its width and height, [w, h]");
            shape.size = {read_positive(fields, "box", value.items[0], false),
                          read_positive(fields, "box", value.items[1], false)};
            const ProductSum half = symbols_.number(1, 2), x = half * shape.size.x, y = half * shape.size.y;
            shape.corners = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
            const char* const names[] = {"lower_left", "lower_right", "upper_right", "upper_left"};
            for (std::size_t i = 0; i < 4; ++i) shape.points.emplace(names[i], shape.corners[i]);
            break;
        }
        default:
            break;
    }
}

namespace {

ProductSum local_cross(const LocalPoint& a, const LocalPoint& b) { return a.x * b.y - a.y * b.x; }
ProductSum local_dot(const LocalPoint& a, const LocalPoint& b) { return a.x * b.x + a.y * b.y; }

}  // namespace

void PlacedMechanism::read_mass(RigidBody& body, const Fields& fields) {
    const TomlValue *mass = fields.find("mass"), *inertia = fields.find("inertia"), *center = fields.find("center");
    if (mass) body.mass = read_positive(fields, "mass", *mass, true).packed();
    const ProductSum& m = body.mass;
    if (center) body.center = read_local(*center, fields, "center", Allowed::positions);
    if (inertia) body.inertia = read_positive(fields, "inertia", *inertia, true);
    if (m.is_zero() || body.shape == TouchShape::none) return;
    if (center && !inertia)
        throw Mistake{
            center->at,
            fmt::format("'{}' has a center of its own, so its mass is not spread evenly: 'inertia' is missing",
                        body.name),
            "add inertia, about the center of mass"};
    if (inertia && center) return;
    if (!std::all_of(body.corners.begin(), body.corners.end(),
                     [&](const LocalPoint& p) { return symbols_.is_constant(p.x) && symbols_.is_constant(p.y); }))
        throw Mistake{body.at, fmt::format("the shape of '{}', which carries mass, must not change", body.name),
                      "use only parameters in it; a body without mass may have any shape"};
    const ProductSum spread = spread_mass(body);
    if (!inertia) body.inertia = spread;
    if (inertia) body.how.clear();
}

// Spreads the mass evenly over the shape: sets the center of mass, and returns the inertia about it.
ProductSum PlacedMechanism::spread_mass(RigidBody& body) const {
    const auto number = [&](long top, long bottom) { return symbols_.number(top, bottom); };
    const ProductSum& m = body.mass;
    const std::vector<LocalPoint>& p = body.corners;
    switch (body.shape) {
        case TouchShape::rod: {
            const LocalPoint along{p[1].x - p[0].x, p[1].y - p[0].y};
            body.center = {number(1, 2) * (p[0].x + p[1].x), number(1, 2) * (p[0].y + p[1].y)};
            body.how = "uniform rod";
            return m * local_dot(along, along).without_squares() * number(1, 12);
        }
        case TouchShape::disc:
            body.how = "uniform disc";
            return m * body.radius * body.radius * number(1, 2);
        case TouchShape::ring:
            body.how = "thin ring";
            return m * body.radius * body.radius;
        case TouchShape::box:
            body.how = "uniform box";
            return m * local_dot(body.size, body.size) * number(1, 12);
        default:
            break;
    }
    // A polygon: sums over the triangles between the origin and each side.
    ProductSum area, polar;
    LocalPoint moment;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const LocalPoint &a = p[i], &b = p[(i + 1) % p.size()];
        const ProductSum part = local_cross(a, b);
        area = area + part;
        moment = {moment.x + part * (a.x + b.x), moment.y + part * (a.y + b.y)};
        polar = polar + part * (local_dot(a, a) + local_dot(a, b) + local_dot(b, b));
    }
    if (area.is_zero() || symbols_.at_start(area) == 0.0)
        throw Mistake{body.at, fmt::format("the polygon of '{}' has no area", body.name), {}};
    body.center = {moment.x / area * number(1, 3), moment.y / area * number(1, 3)};
    body.how = "uniform polygon";
    return m * (polar / area * number(1, 6) - local_dot(body.center, body.center));
}

}  // namespace achilles
