#include "model/description.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "expression/nearest.hpp"
#include "expression/parse.hpp"
#include "model/read_toml.hpp"

namespace achilles {

namespace {

class SystemReader {
 public:
    explicit SystemReader(SystemDescription& description) : d_(description) {}

    void read(const toml::table& root) {
        const TableReader file(d_, root, "a system file",
                               {"title", "source", "coordinate", "parameter", "lagrangian", "constraint", "run",
                                "truncation", "drawing", "view", "extra"});
        d_.title = file.string("title");
        d_.source = file.string("source", "");
        for (const toml::table* table : file.tables("coordinate")) read_coordinate(*table);
        if (d_.coordinates.empty()) file.fail(Location{1, 1}, "a system needs at least one [[coordinate]]");
        for (const toml::table* table : file.tables("parameter")) read_parameter(*table);
        read_lagrangian(file);
        read_constraint(file);
        read_run(file);
        for (const toml::table* table : file.tables("drawing")) read_drawing(*table);
        for (const toml::table* table : file.tables("view")) read_view(*table);
        if (d_.views.empty()) default_views();
    }

 private:
    std::string read_name(const TableReader& reader) {
        const std::string name = reader.string("name");
        const toml::node& node = reader.require("name");
        const Location at = inside_quotes(node, d_.source_text);
        if (!is_name(name))
            reader.fail(at, fmt::format("'{}' is no name", name),
                        "a name is a letter, then letters, digits and underscores");
        if (is_reserved(name))
            reader.fail(at, fmt::format("the name '{}' is taken: it has a meaning of its own in expressions", name));
        if (!names_.insert(name).second) reader.fail(at, fmt::format("the name '{}' is used twice", name));
        return name;
    }

    static std::array<double, 2> default_range(double value) {
        if (value == 0.0) return {-1.0, 1.0};
        return {std::min(0.0, 2.0 * value), std::max(0.0, 2.0 * value)};
    }

    Location at_value(const TableReader& reader, const char* key) {
        const toml::node* node = reader.find(key);
        return node == nullptr ? reader.at() : location_of(*node);
    }

    void read_coordinate(const toml::table& table) {
        const TableReader reader(d_, table, "[[coordinate]]", {"name", "start", "rate", "unit", "range", "rate_range"});
        if (d_.coordinates.size() == static_cast<std::size_t>(max_coordinates))
            reader.fail(reader.at(), fmt::format("a system may have at most {} coordinates", max_coordinates));
        CoordinateDescription c;
        c.name = read_name(reader);
        c.unit = reader.string("unit", "");
        c.start = reader.number("start", 0.0);
        c.rate = reader.number("rate", 0.0);
        c.range = reader.range("range", default_range(c.start));
        c.rate_range = reader.range("rate_range", default_range(c.rate));
        c.at = reader.at();
        c.start_at = at_value(reader, "start");
        c.rate_at = at_value(reader, "rate");
        d_.coordinates.push_back(c);
    }

    void read_parameter(const toml::table& table) {
        const TableReader reader(d_, table, "[[parameter]]", {"name", "value", "range", "unit", "about"});
        ParameterDescription p;
        p.name = read_name(reader);
        reader.require("value");
        p.value = reader.number("value", 0.0);
        p.unit = reader.string("unit", "");
        p.about = reader.string("about", "");
        p.range = reader.range("range", default_range(p.value));
        p.at = at_value(reader, "value");
        d_.parameters.push_back(p);
    }

    void read_lagrangian(const TableReader& file) {
        const toml::node& node = file.require("lagrangian");
        if (!node.is_table()) file.fail(node, "'lagrangian' must be a table: write [lagrangian]");
        const TableReader reader(d_, *node.as_table(), "[lagrangian]", {"kinetic", "potential"});
        d_.kinetic = reader.text("kinetic");
        d_.potential = reader.text("potential");
    }

    void read_constraint(const TableReader& file) {
        const auto tables = file.tables("constraint");
        if (tables.empty()) file.fail(Location{1, 1}, "a system needs one [[constraint]]");
        if (tables.size() > 1)
            file.fail(location_of(*tables[1]), "more than one constraint: only one is supported for now");
        const TableReader reader(d_, *tables[0], "[[constraint]]", {"gap", "restitution"});
        d_.gap = reader.text("gap");
        d_.restitution = reader.text("restitution");
        const toml::node& restitution = reader.require("restitution");
        if (restitution.is_number()) {
            const double e = reader.number("restitution", 0.0);
            if (!(e >= 0.0 && e <= 1.0))
                reader.fail(restitution, fmt::format("the restitution must lie in [0, 1], but it is {}", e));
            // The parameter's slider range is [0, 1] where the restitution is a parameter.
        }
        for (ParameterDescription& p : d_.parameters)
            if (p.name == d_.restitution.text && p.range == default_range(p.value)) p.range = {0.0, 1.0};
    }

    template <class Value>
    Value word(const TableReader& reader, const char* key, Value otherwise,
               std::optional<Value> (*from)(std::string_view), const std::vector<std::string>& choices) {
        if (reader.find(key) == nullptr) return otherwise;
        const std::string text = reader.string(key);
        const auto value = from(text);
        if (!value)
            reader.fail(inside_quotes(reader.require(key), d_.source_text),
                        fmt::format("unknown {} '{}'{}", key, text, did_you_mean(text, choices)),
                        fmt::format("{} is \"{}\" or \"{}\"", key, choices[0], choices[1]));
        return *value;
    }

    void read_run(const TableReader& file) {
        Options& o = d_.options;
        if (const toml::node* node = file.find("run")) {
            if (!node->is_table()) file.fail(*node, "'run' must be a table: write [run]");
            const TableReader reader(d_, *node->as_table(), "[run]",
                                     {"end_time", "tolerance", "method", "max_impacts"});
            o.end_time = reader.positive("end_time", o.end_time);
            o.tolerance = reader.positive("tolerance", o.tolerance);
            o.method = word<Method>(reader, "method", o.method, method_from, {"taylor", "dopri5"});
            const double impacts = reader.positive("max_impacts", o.max_impacts);
            if (impacts != std::floor(impacts) || impacts > 1e9)
                reader.fail(*reader.find("max_impacts"), "'max_impacts' must be a whole number up to 1000000000");
            o.max_impacts = static_cast<int>(impacts);
        }
        const toml::node* node = file.find("truncation");
        if (node == nullptr) return;
        if (!node->is_table()) file.fail(*node, "'truncation' must be a table: write [truncation]");
        const TableReader reader(d_, *node->as_table(), "[truncation]",
                                 {"eps_q", "eps_v", "eps_t", "conditions", "reinitialization"});
        Truncation& t = o.truncation;
        t.eps_q = reader.positive("eps_q", t.eps_q);
        t.eps_v = reader.positive("eps_v", t.eps_v);
        t.eps_t = reader.positive("eps_t", t.eps_t);
        t.conditions = word<Conditions>(reader, "conditions", t.conditions, conditions_from, {"paper", "sharp"});
        t.reinitialization = word<Reinitialization>(reader, "reinitialization", t.reinitialization,
                                                    reinitialization_from, {"euclidean", "kinetic"});
    }

    void read_drawing(const toml::table& table) {
        using Shape = DrawingDescription::Shape;
        const TableReader reader(
            d_, table, "[[drawing]]",
            {"shape", "at", "radius", "from", "to", "over", "points", "text", "color", "width", "fill"});
        DrawingDescription drawing;
        drawing.at = reader.at();
        const std::string shape = reader.string("shape");
        const std::vector<std::string> shapes{"disc", "segment", "curve", "polyline", "text"};
        const auto found = std::find(shapes.begin(), shapes.end(), shape);
        if (found == shapes.end())
            reader.fail(inside_quotes(reader.require("shape"), d_.source_text),
                        fmt::format("unknown shape '{}'{}", shape, did_you_mean(shape, shapes)),
                        "shape is one of: disc, segment, curve, polyline, text");
        drawing.shape = static_cast<Shape>(found - shapes.begin());
        const auto point = [&](const char* key) { drawing.points.push_back(reader.pair(reader.require(key), key)); };
        switch (drawing.shape) {
            case Shape::disc:
                point("at");
                drawing.radius = reader.text("radius");
                break;
            case Shape::segment:
                point("from");
                point("to");
                break;
            case Shape::curve:
                read_curve(reader, drawing);
                break;
            case Shape::polyline:
                read_points(reader, drawing);
                break;
            case Shape::text:
                point("at");
                drawing.text = reader.string("text");
                break;
        }
        drawing.color = reader.string("color", "");
        if (!drawing.color.empty() && !is_color(drawing.color))
            reader.fail(inside_quotes(reader.require("color"), d_.source_text),
                        fmt::format("'{}' is no colour", drawing.color), "a colour is written \"#rrggbb\"");
        if (reader.find("width") != nullptr) drawing.width = reader.text("width");
        drawing.fill = reader.boolean("fill", drawing.shape == Shape::disc);
        d_.drawings.push_back(drawing);
    }

    static bool is_color(const std::string& text) {
        return text.size() == 7 && text[0] == '#' &&
               text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    }

    void read_curve(const TableReader& reader, DrawingDescription& drawing) {
        const toml::node& node = reader.require("over");
        const toml::array* over = node.as_array();
        if (over == nullptr || over->size() != 3 || !over->at(0).is_string())
            reader.fail(node, "'over' must be a name and two limits, as in [\"s\", -10.0, 30.0]");
        drawing.over = over->at(0).as_string()->get();
        const Location at = inside_quotes(over->at(0), d_.source_text);
        if (!is_name(drawing.over) || is_reserved(drawing.over))
            reader.fail(at, fmt::format("'{}' is no name for the curve's own parameter", drawing.over));
        if (names_.count(drawing.over) > 0) reader.fail(at, fmt::format("the name '{}' is used twice", drawing.over));
        drawing.over_limits = {reader.text_of(over->at(1), "over"), reader.text_of(over->at(2), "over")};
        drawing.points.push_back(reader.pair(reader.require("at"), "at"));
    }

    static void read_points(const TableReader& reader, DrawingDescription& drawing) {
        const toml::node& node = reader.require("points");
        const toml::array* points = node.as_array();
        if (points == nullptr || points->size() < 2)
            reader.fail(node,
                        "'points' must be an array of at least two points, as in [[\"0\", \"0\"], [\"x\", \"y\"]]");
        for (const toml::node& entry : *points) drawing.points.push_back(reader.pair(entry, "points"));
    }

    void read_view(const toml::table& table) {
        const TableReader reader(d_, table, "[[view]]", {"name", "x", "y"});
        ViewDescription view;
        view.x = reader.text("x");
        const toml::node& y = reader.require("y");
        if (const toml::array* several = y.as_array()) {
            for (const toml::node& entry : *several) view.y.push_back(reader.text_of(entry, "y"));
        } else {
            view.y.push_back(reader.text_of(y, "y"));
        }
        if (view.y.empty()) reader.fail(y, "'y' needs at least one expression");
        view.name = reader.string("name", view.y[0].text);
        d_.views.push_back(view);
    }

    // Every coordinate and the gap against t, and the plane of the first two coordinates.
    void default_views() {
        const auto add = [&](const std::string& name, const std::string& x, const std::string& y) {
            ViewDescription& view = d_.views.emplace_back();
            view.name = name;
            view.x.text = x;
            view.y.emplace_back().text = y;
        };
        for (const CoordinateDescription& c : d_.coordinates) add(c.name, "t", c.name);
        add("gap", "t", "gap");
        if (d_.coordinates.size() >= 2) add("plane", d_.coordinates[0].name, d_.coordinates[1].name);
    }

    SystemDescription& d_;
    std::set<std::string> names_;
};

}  // namespace

SystemDescription parse_system(std::string text, std::string name) {
    SystemDescription description;
    description.file = std::move(name);
    description.source_text = std::move(text);
    try {
        const toml::table root = toml::parse(description.source_text, description.file);
        SystemReader(description).read(root);
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw description.error({static_cast<int>(at.line), static_cast<int>(at.column)},
                                fmt::format("this is no valid TOML: {}", error.description()));
    }
    return description;
}

SystemDescription read_system(const std::filesystem::path& file) {
    std::error_code problem;
    if (!std::filesystem::exists(file, problem)) throw InputError(file.string(), {}, "there is no such file");
    if (std::filesystem::is_directory(file, problem))
        throw InputError(file.string(), {}, "this is a folder, not a system file");
    if (std::filesystem::file_size(file, problem) > (8u << 20))
        throw InputError(file.string(), {}, "a system file may not be larger than 8 MiB");
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) throw InputError(file.string(), {}, "the file cannot be read");
    return parse_system(text.str(), file.string());
}

void assign(SystemDescription& description, std::string_view name_value) {
    const auto fail = [&](const std::string& message, const std::string& hint = {}) {
        throw InputError("--set " + std::string(name_value), {}, message, hint);
    };
    const std::size_t equals = name_value.find('=');
    if (equals == std::string_view::npos)
        fail("a value is missing", "write --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5");
    const std::string name(name_value.substr(0, equals)), written(name_value.substr(equals + 1));
    double value = 0.0;
    const auto [end, problem] = std::from_chars(written.data(), written.data() + written.size(), value);
    if (problem != std::errc() || end != written.data() + written.size() || !std::isfinite(value))
        fail(fmt::format("'{}' is not a finite number", written));
    std::vector<std::string> known;
    for (CoordinateDescription& c : description.coordinates) {
        if (c.name == name) c.start = value;
        if (c.name + "'" == name) c.rate = value;
        known.push_back(c.name);
        known.push_back(c.name + "'");
    }
    for (ParameterDescription& p : description.parameters) {
        if (p.name == name) p.value = value;
        known.push_back(p.name);
    }
    if (std::find(known.begin(), known.end(), name) == known.end())
        fail(fmt::format("'{}' is no parameter, coordinate or rate of this system{}", name, did_you_mean(name, known)));
}

}  // namespace achilles
