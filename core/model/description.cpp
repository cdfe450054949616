#include "model/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <climits>
#include <cmath>
#include <set>

#include "expression/nearest.hpp"
#include "expression/parse.hpp"
#include "model/fields.hpp"
#include "model/input_error.hpp"

namespace achilles {

namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

// The whole text as one finite or infinite number; nothing where it is anything else.
std::optional<double> plain_number(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// The slider's default: 0 to twice the value, -1 to 1 at 0 (INTERFACE section 5).
std::array<double, 2> range_around(double value) {
    if (value == 0.0) return {-1.0, 1.0};
    return {std::min(0.0, 2.0 * value), std::max(0.0, 2.0 * value)};
}

// A name that nothing else has. Throws InputError.
Text read_name(const SystemDescription& system, const Fields& fields) {
    const Text name = fields.string("name");
    if (!is_name(name.text)) {
        throw fields.error(name.at, fmt::format("'{}' is not a name", shown(name.text)),
                           "a name is a letter, then letters, digits and underscores");
    }
    if (is_reserved(name.text)) {
        throw fields.error(name.at, fmt::format("the name '{}' is reserved", name.text),
                           "functions, t, pi, gap, lambda and energy keep their meaning: choose another name");
    }
    const auto refuse_twice = [&](const auto& others) {
        for (const auto& other : others) {
            if (other.name != name.text) continue;
            throw fields.error(name.at, fmt::format("the name '{}' is used twice", shown(name.text)));
        }
    };
    refuse_twice(system.coordinates);
    refuse_twice(system.parameters);
    return name;
}

void read_coordinates(SystemDescription& system, const TomlValue& root) {
    for (const Fields& fields : tables(system, root, "coordinate")) {
        fields.allow({"name", "start", "rate", "unit", "range", "rate_range"});
        const Text name = read_name(system, fields);
        if (system.coordinates.size() == max_coordinates) {
            throw fields.error(name.at, fmt::format("more than {} coordinates", max_coordinates));
        }
        CoordinateDescription coordinate;
        coordinate.name = name.text;
        coordinate.at = name.at;
        const auto place = [&](const char* key) { return fields.find(key) ? fields.need(key).at : name.at; };
        coordinate.start = fields.number_or("start", 0.0);
        coordinate.start_at = place("start");
        coordinate.rate = fields.number_or("rate", 0.0);
        coordinate.rate_at = place("rate");
        coordinate.unit = fields.string_or("unit", "");
        coordinate.range = fields.range_or("range", range_around(coordinate.start));
        coordinate.rate_range = fields.range_or("rate_range", range_around(coordinate.rate));
        system.coordinates.push_back(coordinate);
    }
}

void read_parameters(SystemDescription& system, const TomlValue& root) {
    for (const Fields& fields : tables(system, root, "parameter")) {
        fields.allow({"name", "value", "unit", "about", "range"});
        const Text name = read_name(system, fields);
        ParameterDescription parameter;
        parameter.name = name.text;
        parameter.value = fields.number("value");
        parameter.at = fields.need("value").at;
        parameter.unit = fields.string_or("unit", "");
        parameter.about = fields.string_or("about", "");
        const bool restitution = system.restitution.text == name.text;
        parameter.range = fields.range_or("range", restitution ? std::array{0.0, 1.0} : range_around(parameter.value));
        system.parameters.push_back(parameter);
    }
}

void read_constraint(SystemDescription& system, const std::vector<Fields>& constraints) {
    if (constraints.size() > 1) {
        throw constraints[1].error(constraints[1].table().at, "more than one [[constraint]]",
                                   "Achilles simulates systems with exactly one unilateral constraint");
    }
    const Fields& fields = constraints[0];
    fields.allow({"gap", "restitution"});
    system.gap = fields.expression("gap");
    system.restitution = fields.expression("restitution");
    const std::optional<double> e = plain_number(system.restitution.text);
    if (e && !(*e >= 0.0 && *e <= 1.0)) {
        throw fields.error(system.restitution.at,
                           fmt::format("restitution must be in [0, 1], not {}", shown(system.restitution.text)),
                           "0 is plastic, 1 is elastic");
    }
}

void read_run(Options& options, const Fields& fields) {
    fields.allow({"end_time", "tolerance", "method", "max_impacts"});
    if (fields.find("end_time")) options.end_time = fields.positive("end_time");
    if (fields.find("tolerance")) options.tolerance = fields.positive("tolerance");
    if (const TomlValue* most = fields.find("max_impacts")) {
        const double impacts = fields.positive("max_impacts");
        if (!most->integer || impacts > INT_MAX) {
            throw fields.error(most->at,
                               fmt::format("'max_impacts' in [run] must be a whole number up to {}", INT_MAX));
        }
        options.max_impacts = static_cast<int>(impacts);
    }
}

// Reads one of a few names. Throws InputError with the nearest.
template <class Value>
void read_choice(Value& value, const Fields& fields, const std::string& key, const std::vector<std::string>& names,
                 std::optional<Value> (*from)(std::string_view)) {
    if (!fields.find(key)) return;
    const Text text = fields.string(key);
    const std::optional<Value> found = from(text.text);
    if (!found) {
        throw fields.error(text.at,
                           fmt::format("unknown {} '{}'{}", key, shown(text.text), did_you_mean(text.text, names)),
                           fmt::format("known: {}", listed(names)));
    }
    value = *found;
}

void read_options(SystemDescription& system, const Fields& root) {
    Options& options = system.options;
    if (const TomlValue* run = root.find("run")) {
        const Fields fields(system, *run, "[run]");
        read_run(options, fields);
        read_choice(options.method, fields, "method", {"taylor", "dopri5"}, method_from);
    }
    if (const TomlValue* truncation = root.find("truncation")) {
        const Fields fields(system, *truncation, "[truncation]");
        fields.allow({"eps_q", "eps_v", "eps_t", "conditions", "reinitialization"});
        if (fields.find("eps_q")) options.truncation.eps_q = fields.positive("eps_q");
        if (fields.find("eps_v")) options.truncation.eps_v = fields.positive("eps_v");
        if (fields.find("eps_t")) options.truncation.eps_t = fields.positive("eps_t");
        read_choice(options.truncation.conditions, fields, "conditions", {"sharp", "paper"}, conditions_from);
        read_choice(options.truncation.reinitialization, fields, "reinitialization", {"kinetic", "euclidean"},
                    reinitialization_from);
    }
}

void read_pictures(SystemDescription& system, const TomlValue& root) {
    for (const Fields& fields : tables(system, root, "drawing")) {
        system.drawings.push_back(read_drawing(system, fields));
    }
    std::set<std::string> names;
    for (const Fields& fields : tables(system, root, "view")) {
        system.views.push_back(read_view(fields));
        if (!names.insert(system.views.back().name).second) {
            const Text name = fields.string("name");
            throw fields.error(name.at, fmt::format("the name '{}' is used twice", shown(name.text)),
                               "each [[view]] needs a name of its own");
        }
    }
    if (system.views.empty()) system.views = default_views(system);
}

// A part that no place in the file can be blamed for.
InputError missing(const SystemDescription& system, const std::string& part) {
    return {system.file, {1, 1}, fmt::format("missing {}", part), "assets/systems has complete examples"};
}

}  // namespace

InputError SystemDescription::error(Location at, const std::string& message, const std::string& hint) const {
    return {file, at, message, hint, line_of(source_text, at.line)};
}

SystemDescription parse_system(std::string text, std::string name) {
    if (text.size() > largest_file)
        throw InputError(name, {}, fmt::format("it is larger than {} MB", largest_file >> 20));
    SystemDescription system;
    system.file = std::move(name);
    system.source_text = std::move(text);
    const TomlValue root = read_toml(system.source_text, system.file);
    const Fields fields(system, root, "a system file");
    fields.allow({"title", "source", "coordinate", "parameter", "lagrangian", "constraint", "run", "truncation",
                  "drawing", "view", "extra"});
    system.source = fields.string_or("source", "");
    if (fields.find("title")) system.title = fields.string("title").text;

    read_coordinates(system, root);
    if (system.coordinates.empty()) throw missing(system, "[[coordinate]]: a system needs at least one");
    const TomlValue* lagrangian = fields.find("lagrangian");
    if (!lagrangian) throw missing(system, "[lagrangian]");
    const Fields energies(system, *lagrangian, "[lagrangian]");
    energies.allow({"kinetic", "potential"});
    system.kinetic = energies.expression("kinetic");
    system.potential = energies.expression("potential");
    const std::vector<Fields> constraints = tables(system, root, "constraint");
    if (constraints.empty()) throw missing(system, "[[constraint]]");
    read_constraint(system, constraints);
    read_parameters(system, root);  // after the constraint: the restitution's slider has a range of its own
    read_options(system, fields);
    read_pictures(system, root);
    if (!fields.find("title")) throw missing(system, "title");
    return system;
}

void assign(SystemDescription& description, std::string_view name_value) {
    const auto refuse = [&](const std::string& why, const std::string& hint = {}) {
        return InputError("--set " + shown(name_value), {}, why, hint);
    };
    const std::size_t equals = name_value.find('=');
    if (equals == name_value.npos) {
        throw refuse("a value is missing", "write --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5");
    }
    const std::string name(trimmed(name_value.substr(0, equals))), written(name_value.substr(equals + 1));
    const std::optional<double> value = plain_number(written);
    if (!value || !std::isfinite(*value)) throw refuse(fmt::format("'{}' is not a finite number", shown(written)));

    std::vector<std::string> names;
    for (CoordinateDescription& coordinate : description.coordinates) {
        if (coordinate.name == name) return void(coordinate.start = *value);
        if (coordinate.name + "'" == name) return void(coordinate.rate = *value);
        names.insert(names.end(), {coordinate.name, coordinate.name + "'"});
    }
    for (ParameterDescription& parameter : description.parameters) {
        if (parameter.name == name) return void(parameter.value = *value);
        names.push_back(parameter.name);
    }
    throw refuse(fmt::format("'{}' is no parameter, coordinate or rate of this system{}", shown(name),
                             did_you_mean(name, names)));
}

std::vector<Text> texts_of(const DrawingDescription& drawing) {
    using Shape = DrawingDescription::Shape;
    std::vector<Text> texts;
    for (const auto& point : drawing.points) texts.insert(texts.end(), point.begin(), point.end());
    if (drawing.shape == Shape::disc) texts.push_back(drawing.radius);
    if (drawing.shape == Shape::curve)
        texts.insert(texts.end(), drawing.over_limits.begin(), drawing.over_limits.end());
    if (!drawing.width.text.empty()) texts.push_back(drawing.width);
    return texts;
}

}  // namespace achilles
