// Reads the drawings and plots of a system file: [[drawing]] and [[view]].
#include <fmt/format.h>

#include <algorithm>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "system/fields.hpp"
#include "system/input_error.hpp"
#include "system/keys.hpp"

namespace achilles {

namespace {

using Shape = DrawingDescription::Shape;

struct NamedShape {
    std::string name;
    Shape shape;
};

const std::vector<NamedShape>& shapes() {
    static const std::vector<NamedShape> list{{"disc", Shape::disc},         {"circle", Shape::circle},
                                              {"box", Shape::box},           {"segment", Shape::segment},
                                              {"spring", Shape::spring},     {"damper", Shape::damper},
                                              {"ground", Shape::ground},     {"curve", Shape::curve},
                                              {"polyline", Shape::polyline}, {"text", Shape::text}};
    return list;
}

bool is_between_two(Shape shape) {
    return shape == Shape::segment || shape == Shape::spring || shape == Shape::damper || shape == Shape::ground;
}

// The shape. A misspelled one adds a mistake, and the nearest shape is used. Throws Mistake if there is none near.
const NamedShape& shape_of(const Fields& fields, ErrorCollector& mistakes) {
    const Text name = fields.string("shape");
    std::vector<std::string> names;
    for (const NamedShape& shape : shapes()) names.push_back(shape.name);
    const auto called = [&](const std::string& wanted) {
        return std::find_if(shapes().begin(), shapes().end(), [&](const NamedShape& s) { return s.name == wanted; });
    };
    if (const auto known = called(name.text); known != shapes().end()) return *known;
    const Mistake unknown{name.at,
                          fmt::format("unknown shape '{}'{}", shown(name.text), did_you_mean(name.text, names)),
                          fmt::format("shapes are: {}", listed(names))};
    const auto meant = called(nearest(name.text, names));
    if (meant == shapes().end()) throw unknown;
    mistakes.add(unknown);
    return *meant;
}

void read_over(const SystemDescription& system, const Fields& fields, DrawingDescription& drawing) {
    const TomlValue& over = fields.need("over");
    if (over.kind != TomlValue::Kind::array || over.items.size() != 3 ||
        over.items[0].kind != TomlValue::Kind::string) {
        throw Mistake{over.at, R"('over' in [[drawing]] must be ["name", low, high])", {}};
    }
    const Text& own = over.items[0].text;
    if (!is_name(own.text)) throw no_name(own);
    if (is_reserved(own.text)) throw Mistake{own.at, fmt::format("the name '{}' is reserved", own.text), {}};
    const auto same = [&](const auto& other) { return other.name == own.text; };
    if (std::any_of(system.coordinates.begin(), system.coordinates.end(), same) ||
        std::any_of(system.parameters.begin(), system.parameters.end(), same) ||
        std::any_of(system.derived.begin(), system.derived.end(), same)) {
        throw Mistake{own.at, fmt::format("the name '{}' is used twice", own.text),
                      "choose another name for the curve parameter"};
    }
    drawing.over = own.text;
    drawing.over_limits = {fields.expression("over", over.items[1]), fields.expression("over", over.items[2])};
}

void read_points(const Fields& fields, DrawingDescription& drawing, ErrorCollector& mistakes) {
    const TomlValue& points = fields.need("points");
    if (points.kind != TomlValue::Kind::array) throw fields.wrong_type("points", points, "an array of points");
    if (points.items.size() < 2) throw Mistake{points.at, "a polyline needs at least two points", {}};
    for (const TomlValue& item : points.items)
        mistakes.attempt([&] { drawing.points.push_back(fields.point("points", item)); });
}

// Reads the sizes of a shape besides its points. An omitted size is stored as 0: angle 0 for a box, and the default
// size for `coils` and `across`.
void read_sizes(const Fields& fields, DrawingDescription& drawing, ErrorCollector& mistakes) {
    const auto size = [&](const char* key) {
        mistakes.attempt([&] { drawing.sizes.push_back(fields.find(key) ? fields.expression(key) : Text{"0", {}}); });
    };
    if (drawing.shape == Shape::box) {
        mistakes.attempt([&] {
            for (const Text& text : fields.point("size")) drawing.sizes.push_back(text);
        });
        size("angle");
    }
    if (drawing.shape == Shape::spring) size("coils");
    if (drawing.shape == Shape::spring || drawing.shape == Shape::damper) size("across");
}

std::string read_color(const Fields& fields) {
    if (!fields.find("color")) return "";
    const Text color = fields.string("color");
    const bool hexadecimal = color.text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (color.text.size() == 7 && color.text[0] == '#' && hexadecimal) return color.text;
    throw Mistake{color.at, fmt::format("'{}' is not a color", shown(color.text)), "write a color as \"#rrggbb\""};
}

}  // namespace

DrawingDescription read_drawing(const SystemDescription& system, const Fields& fields, ErrorCollector& mistakes) {
    const NamedShape& shape = shape_of(fields, mistakes);
    std::vector<std::string> keys = keys_of("[[drawing]]"), own = keys_of(shape.name);
    keys.insert(keys.end(), own.begin(), own.end());
    Fields of_shape(fields.table(), fmt::format("[[drawing]] of shape {}", shape.name));
    of_shape.allow(keys, mistakes);

    DrawingDescription drawing;
    drawing.shape = shape.shape;
    drawing.at = fields.table().at;
    drawing.fill = shape.shape == Shape::disc || shape.shape == Shape::box;
    const auto point = [&](const char* key) {
        mistakes.attempt([&] { drawing.points.push_back(of_shape.point(key)); });
    };
    if (shape.shape == Shape::polyline) {
        mistakes.attempt([&] { read_points(of_shape, drawing, mistakes); });
    } else if (is_between_two(shape.shape)) {
        point("from");
        point("to");
    } else {
        point("at");
    }
    if (is_round(shape.shape)) mistakes.attempt([&] { drawing.radius = of_shape.expression("radius"); });
    read_sizes(of_shape, drawing, mistakes);
    if (shape.shape == Shape::curve) mistakes.attempt([&] { read_over(system, of_shape, drawing); });
    if (shape.shape == Shape::text) mistakes.attempt([&] { drawing.text = of_shape.string("text").text; });
    mistakes.attempt([&] { drawing.color = read_color(of_shape); });
    mistakes.attempt([&] {
        if (fields.find("width")) drawing.width = of_shape.expression("width");
    });
    mistakes.attempt([&] { drawing.fill = of_shape.flag_or("fill", drawing.fill); });
    return drawing;
}

ViewDescription read_view(Fields& fields, ErrorCollector& mistakes) {
    fields.allow(keys_of("[[view]]"), mistakes);
    ViewDescription view;
    mistakes.attempt([&] { view.x = fields.expression("x"); });
    const TomlValue& y = fields.need("y");
    if (y.kind != TomlValue::Kind::array) {
        view.y = {fields.expression("y")};
    } else {
        if (y.items.empty()) throw Mistake{y.at, "'y' in [[view]] is empty", "one expression for each curve"};
        for (const TomlValue& item : y.items) mistakes.attempt([&] { view.y.push_back(fields.expression("y", item)); });
    }
    mistakes.attempt([&] { view.label = fields.string_or("label", ""); });
    mistakes.attempt([&] { read_unit(fields, view.unit); });
    mistakes.attempt([&] { view.name = fields.string_or("name", view.y.empty() ? "" : view.y[0].text); });
    return view;
}

std::vector<ViewDescription> default_views(const SystemDescription& system) {
    std::vector<ViewDescription> views;
    const auto add = [&](const std::string& name, const std::string& x, const std::string& y) {
        ViewDescription& view = views.emplace_back();
        view.name = name;
        view.x.text = x;
        view.y.emplace_back().text = y;
    };
    const auto& coordinates = system.coordinates;
    for (const CoordinateDescription& coordinate : coordinates) add(coordinate.name, "t", coordinate.name);
    if (!system.constraints.empty())
        for (const std::string& gap : output_names(system, "gap")) add(gap, "t", gap);
    if (coordinates.size() < 2) return views;
    const auto called_plane = [](const CoordinateDescription& c) { return c.name == "plane"; };
    const bool taken = std::any_of(coordinates.begin(), coordinates.end(), called_plane);
    add(taken ? "the plane" : "plane", coordinates[0].name, coordinates[1].name);
    return views;
}

}  // namespace achilles
