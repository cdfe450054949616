#include "system/read_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <climits>
#include <limits>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "number/float_environment.hpp"
#include "run/contact_set.hpp"
#include "system/expand.hpp"
#include "system/fields.hpp"
#include "system/input_error.hpp"
#include "system/keys.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// A mistake without a line: something is missing.
Mistake missing_part(const std::string& part) {
    return {{1, 1}, fmt::format("missing {}", part), "assets/systems has complete examples", false};
}

// "mine" for some/folder/mine.toml: the default title of a system.
std::string name_without_folder(const std::string& file) {
    const std::string name = file.substr(file.find_last_of('/') + 1);
    return name.ends_with(".toml") && name.size() > 5 ? name.substr(0, name.size() - 5) : name;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Default range of a slider: 0 to twice the value, or -1 to 1 if the value is 0.
std::array<double, 2> range_around(double value) {
    if (value == 0.0) return {-1.0, 1.0};
    return {std::min(0.0, 2.0 * value), std::max(0.0, 2.0 * value)};
}

// A file while it is read.
struct FileReader {
    SystemDescription& system;
    const TomlValue& root;
    ErrorCollector& mistakes;
    Names& names;  // of coordinates and parameters, including invalid ones
    MechanismExpansion expansion = {};
    std::vector<Fields> constraints = {};                // the tables of system.constraints
    std::map<std::string, Location> contact_names = {};  // and of [[friction]]
};

// Reads a name that is not used yet. Throws Mistake.
Text read_name(Names& names, const Fields& fields) {
    const bool was_complete = std::exchange(names.complete, false);  // until this name is read
    const Text name = fields.string("name");
    if (!is_name(name.text)) throw no_name(name);
    if (const std::string_view why = names.why_reserved(name.text); !why.empty()) {
        names.complete = was_complete;
        names.reported.insert(name.text);
        throw Mistake{name.at, fmt::format("the name '{}' is reserved", shown(name.text)),
                      fmt::format("{} are reserved: choose another name", why)};
    }
    const auto [other, is_new] = names.places.try_emplace(name.text, name.at);
    if (!is_new) throw used_twice(name, other->second);
    names.complete = was_complete;
    return name;
}

// The tables of coordinates or parameters. If they contain a mistake, their names are incomplete.
std::vector<Fields> named_tables(FileReader& reading, const std::string& key) {
    const std::size_t before = reading.mistakes.count();
    std::vector<Fields> list = tables(reading.root, key, reading.mistakes);
    if (reading.mistakes.count() > before) reading.names.complete = false;
    return list;
}

void read_coordinates(FileReader& reading, const Fields& root) {
    root.need("coordinate", missing_part("[[coordinate]]: a system needs at least one"));
    const std::size_t before = reading.mistakes.count();
    for (Fields& fields : named_tables(reading, "coordinate")) {
        ErrorCollector& mistakes = reading.mistakes;
        fields.allow(keys_of("[[coordinate]]"), mistakes);
        CoordinateDescription coordinate;
        const bool is_named = mistakes.attempt([&] {
            const Text name = read_name(reading.names, fields);
            coordinate.name = name.text;
            coordinate.at = name.at;
        });
        const auto place = [&](const char* key) { return fields.find(key) ? fields.find(key)->at : coordinate.at; };
        coordinate.start_at = place("start");
        coordinate.rate_at = place("rate");
        const std::string& unit = coordinate.unit;
        mistakes.attempt([&] { read_unit(fields, coordinate.unit); });
        mistakes.attempt([&] { coordinate.start = fields.number_or("start", 0.0, unit); });
        mistakes.attempt([&] { coordinate.rate = fields.number_or("rate", 0.0, rate_unit(unit)); });
        mistakes.attempt([&] { coordinate.force = fields.expression_or_none("force"); });
        coordinate.has_range = fields.find("range") != nullptr;
        coordinate.has_rate_range = fields.find("rate_range") != nullptr;
        mistakes.attempt([&] { coordinate.range = fields.range_or("range", range_around(coordinate.start), unit); });
        mistakes.attempt([&] {
            coordinate.rate_range = fields.range_or("rate_range", range_around(coordinate.rate), rate_unit(unit));
        });
        if (!is_named) continue;
        if (reading.system.coordinates.size() == max_coordinates) {
            mistakes.add({coordinate.at, fmt::format("more than {} coordinates", max_coordinates), {}});
            reading.names.complete = false;
            return;
        }
        reading.system.coordinates.push_back(coordinate);
    }
    if (reading.system.coordinates.empty() && reading.mistakes.count() == before)  // coordinate = []
        throw missing_part("[[coordinate]]: a system needs at least one");
}

// A parameter defined by an expression in other parameters.
void read_derived(FileReader& reading, const Fields& fields, DerivedDescription derived) {
    reading.mistakes.attempt([&] { derived.definition = fields.expression("value"); });
    reading.system.derived.push_back(std::move(derived));
    if (const TomlValue* range = fields.find("range"))
        reading.mistakes.add({range->at,
                              fmt::format("'{}' is a derived parameter: it has no slider and no range",
                                          reading.system.derived.back().name),
                              {}});
}

// The restitutions of all constraints, as text.
std::vector<std::string> texts_of_restitutions(const TomlValue& root) {
    std::vector<std::string> texts;
    for (const TomlEntry& entry : root.entries)
        if (entry.key == "constraint")
            for (const TomlValue& table : entry.value.items)
                for (const TomlEntry& key : table.entries)
                    if (key.key == "restitution") texts.push_back(key.value.text.text);
    return texts;
}

// True if all names in the expression are parameters, so that "2*m" is twice the mass m and not two meters.
bool has_parameters_alone(const std::string& expression, const TomlValue& root) {
    std::vector<std::string> known;
    for (const TomlEntry& entry : root.entries)
        if (entry.key == "parameter")
            for (const TomlValue& table : entry.value.items)
                for (const TomlEntry& key : table.entries)
                    if (key.key == "name") known.push_back(key.value.text.text);
    const std::vector<std::string> names = names_in(expression);
    return std::all_of(names.begin(), names.end(), [&](const std::string& name) { return contains(known, name); });
}

void read_parameters(FileReader& reading) {
    const std::vector<std::string> restitutions =
        texts_of_restitutions(reading.root);  // their sliders have their own range
    for (Fields& fields : named_tables(reading, "parameter")) {
        ErrorCollector& mistakes = reading.mistakes;
        fields.allow(keys_of("[[parameter]]"), mistakes);
        ParameterDescription parameter;
        const bool is_named = mistakes.attempt([&] { parameter.name = read_name(reading.names, fields).text; });
        mistakes.attempt([&] { read_unit(fields, parameter.unit); });
        mistakes.attempt([&] { parameter.about = fields.string_or("about", ""); });
        const TomlValue* value = fields.find("value");
        if (value != nullptr && value->kind == TomlValue::Kind::string && has_names(value->text.text) &&
            (!measured(value->text.text) || has_parameters_alone(value->text.text, reading.root))) {
            if (is_named) read_derived(reading, fields, {parameter.name, parameter.unit, parameter.about, {}});
            continue;
        }
        const bool has_value = mistakes.attempt([&] {
            parameter.value = fields.number("value", parameter.unit);
            parameter.at = fields.need("value").at;
        });
        if (!has_value) parameter.value = std::numeric_limits<double>::quiet_NaN();  // so that nothing is said of it
        const bool is_restitution = contains(restitutions, parameter.name);
        const std::array<double, 2> usual = is_restitution ? std::array{0.0, 1.0} : range_around(parameter.value);
        parameter.has_range = fields.find("range") != nullptr;
        mistakes.attempt([&] { parameter.range = fields.range_or("range", usual, parameter.unit); });
        if (is_named) reading.system.parameters.push_back(parameter);
    }
}

void read_lagrangian(FileReader& reading, const Fields& root) {
    if (reading.expansion.has_failed && !root.find("lagrangian")) return;
    root.need("lagrangian", missing_part("[lagrangian]"));
    Fields fields(*root.find("lagrangian"), "[lagrangian]");
    fields.allow(keys_of("[lagrangian]"), reading.mistakes);
    const bool is_derived = reading.expansion.has_failed;  // then a missing energy follows from other mistakes
    for (const auto& energy :
         {std::pair("kinetic", &reading.system.kinetic), std::pair("potential", &reading.system.potential)})
        if (!is_derived || fields.find(energy.first))
            reading.mistakes.attempt([&] { *energy.second = fields.expression(energy.first); });
    reading.mistakes.attempt([&] { reading.system.dissipation = fields.expression_or_none("dissipation"); });
}

// The name of a constraint or a [[friction]] in outputs, as in gap_knee. Throws Mistake.
std::string read_contact_name(const Fields& fields, const char* why_needed, std::map<std::string, Location>& places) {
    fields.need("name", {fields.table().at, fmt::format("missing key 'name' in {}", fields.where()), why_needed});
    const Text text = fields.string("name");
    if (!is_name(text.text)) throw no_name(text);
    const auto [other, is_new] = places.try_emplace(text.text, text.at);
    if (!is_new) throw used_twice(text, other->second);
    return text.text;
}

// The tables of this key, at most `most`. If they have a mistake, the names of their outputs are incomplete.
std::vector<Fields> limited_tables(FileReader& reading, const std::string& key, std::size_t most) {
    std::vector<Fields> list = named_tables(reading, key);
    if (list.size() > most) {
        reading.mistakes.add({list[most].table().at, fmt::format("more than {} [[{}]]", most, key), {}});
        while (list.size() > most) list.pop_back();
    }
    return list;
}

// ---- friction ----

// The sliding velocity. Throws Mistake.
Text read_slip(const Fields& fields) {
    const TomlValue& slip = fields.need("slip");
    if (slip.kind == TomlValue::Kind::array)
        throw Mistake{slip.at, fmt::format("two slips in one {}: friction is planar", fields.where()),
                      "write one expression, the sliding velocity along the tangent; friction in space is not covered"};
    return fields.expression("slip");
}

// True for the word inf, or the number inf of TOML.
bool is_infinite(const TomlValue& value) {
    const std::string& text = value.text.text;
    const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
    return value.kind == TomlValue::Kind::number ? value.number > DBL_MAX
                                                 : text.substr(first, text.find_last_not_of(' ') + 1 - first) == "inf";
}

// The friction of a contact, whose slip is given unless the file's bodies have mistakes. Throws Mistake.
void read_friction(const Fields& fields, ConstraintDescription& constraint) {
    const TomlValue *friction = fields.find("friction"), *static_friction = fields.find("static_friction");
    if (friction == nullptr) {
        if (static_friction != nullptr)
            fields.need("friction", {static_friction->at, "'static_friction' in [[constraint]] goes with 'friction'",
                                     "add friction, the coefficient while sliding"});
        return;
    }
    fields.need("slip", {friction->at, "friction needs the sliding velocity: 'slip' is missing",
                         "add slip, scaled like the gap: for gap = \"y - r\" it is \"x' + r*phi'\", or \"x'\" for a "
                         "point; with 'between' in place of 'gap' it is derived"});
    constraint.never_slides = is_infinite(*friction);
    if (const std::string_view word = friction->text.text; word == "Inf" || word == "INF" || word == "infinity")
        throw Mistake{friction->text.at, fmt::format("unknown name '{}'", word),
                      "write friction = \"inf\" for a contact that never slides"};
    if (constraint.never_slides && static_friction != nullptr)
        throw Mistake{static_friction->at, "'static_friction' together with friction = \"inf\"",
                      "leave it out: a contact that never slides has no limit"};
    if (static_friction != nullptr) constraint.static_friction = fields.expression("static_friction");
    constraint.friction = constraint.never_slides ? friction->text : fields.expression("friction");
}

void read_frictions(FileReader& reading) {
    ErrorCollector& mistakes = reading.mistakes;
    for (Fields& fields : limited_tables(reading, "friction", max_frictions)) {
        fields.allow(keys_of("[[friction]]"), mistakes);
        FrictionDescription& friction = reading.system.frictions.emplace_back();
        friction.at = fields.table().at;
        const bool is_named = mistakes.attempt([&] {
            friction.name =
                read_contact_name(fields, "it is the name in outputs, as in slip_NAME", reading.contact_names);
        });
        if (!is_named) reading.names.complete = false;  // nor are the names of its slip and force
        mistakes.attempt([&] { friction.slip = read_slip(fields); });
        mistakes.attempt([&] {
            if (const TomlValue& level = fields.need("level"); is_infinite(level))
                throw Mistake{level.at, "'level' in [[friction]] must be finite",
                              "what never slides needs no coordinate: leave that coordinate out"};
            friction.level = fields.expression("level");
        });
        mistakes.attempt([&] {
            if (fields.find("static_level")) friction.static_level = fields.expression("static_level");
        });
    }
}

void read_constraints(FileReader& reading) {
    ErrorCollector& mistakes = reading.mistakes;
    std::vector<Fields>& list = reading.constraints = limited_tables(reading, "constraint", max_contacts);
    for (Fields& fields : list) {
        fields.allow(keys_of("[[constraint]]"), mistakes);
        ConstraintDescription& constraint = reading.system.constraints.emplace_back();
        constraint.at = fields.table().at;
        const bool is_named = mistakes.attempt([&] {
            if (list.size() == 1 && !fields.find("name")) {
                constraint.name = "contact";
                reading.contact_names.emplace(constraint.name, constraint.at);
            } else {
                constraint.name = read_contact_name(fields, "with several constraints each needs its own name",
                                                    reading.contact_names);
            }
        });
        if (!is_named) reading.names.complete = false;  // nor are the names of its gap and force
        const bool has_gap = !reading.expansion.has_failed || fields.find("gap");
        if (has_gap) mistakes.attempt([&] { constraint.gap = fields.expression("gap"); });
        mistakes.attempt([&] {
            if (fields.find("slip")) constraint.slip = read_slip(fields);
        });
        if (has_gap) mistakes.attempt([&] { read_friction(fields, constraint); });
        mistakes.attempt([&] { constraint.restitution = fields.expression("restitution"); });
        mistakes.attempt([&] { constraint.when = fields.expression_or_none("when"); });
        mistakes.attempt([&] { constraint.begins = fields.string_or("begins", ""); });
        mistakes.attempt([&] { constraint.ends = fields.string_or("ends", ""); });
    }
}

// The value of an option. Throws Mistake; for an unknown word it suggests the nearest.
OptionValue read_option(const Option& option, const Fields& fields) {
    const OptionValue usual = option.get({});
    if (!option.words.empty()) {
        const Text text = fields.string(option.key);
        const auto known = std::find(option.words.begin(), option.words.end(), text.text);
        if (known != option.words.end()) return *known;
        std::vector<std::string> names{to_text(usual)};
        for (const std::string_view word : option.words)
            if (word != names[0]) names.emplace_back(word);
        throw Mistake{text.at,
                      fmt::format("unknown {} '{}'{}", option.key, shown(text.text), did_you_mean(text.text, names)),
                      fmt::format("known: {}", listed(names))};
    }
    const double number =
        option.any_sign ? fields.number(option.key, option.unit) : fields.positive(option.key, option.unit);
    if (std::holds_alternative<double>(usual)) return number;
    const TomlValue& value = fields.need(option.key);
    if (!value.integer || number > INT_MAX)
        throw Mistake{value.at, fmt::format("'{}' in [run] must be a whole number up to {}", option.key, INT_MAX), {}};
    return static_cast<int>(number);
}

// [run] or [truncation]: every key has a default.
void read_options(const TomlValue& table, const std::string& name, Options& options, ErrorCollector& mistakes) {
    Fields fields(table, "[" + name + "]");
    std::vector<std::string> keys;
    for (const Option& option : all_options())
        if (option.table == name) keys.emplace_back(option.key);
    fields.allow(keys, mistakes);
    const std::size_t before = mistakes.count();
    for (const Option& option : all_options())
        if (option.table == name && fields.find(option.key))
            mistakes.attempt([&] { option.set(options, read_option(option, fields)); });
    const TomlValue* end = fields.find("end_time");
    if (end == nullptr) end = fields.find("start_time");
    const auto fault = end_time_error(options);
    if (fault && end != nullptr && mistakes.count() == before) mistakes.add({end->at, *fault, {}});
}

// Reads one item per coordinate.
template <class Read>
void read_by_coordinate(const FileReader& reading, const Fields& fields, std::string_view key, const Read& read) {
    const TomlValue& value = fields.need(key);
    const std::size_t n = reading.system.coordinates.size();
    if (value.kind != TomlValue::Kind::array || value.items.size() != n)
        throw Mistake{
            value.at,
            fmt::format("'{}' in [orbit] must have a value for each of {} coordinate{}", key, n, n == 1 ? "" : "s"),
            "in the order of the file"};
    for (std::size_t i = 0; i < n; ++i) read(i, value.items[i]);
}

void read_orbit(FileReader& reading, const TomlValue& table) {
    ErrorCollector& mistakes = reading.mistakes;
    Fields fields(table, "[orbit]");
    fields.allow(keys_of("[orbit]"), mistakes);
    OrbitDescription orbit;
    orbit.at = table.at;
    const auto& coordinates = reading.system.coordinates;
    mistakes.attempt([&] {
        read_by_coordinate(reading, fields, "q", [&](std::size_t i, const TomlValue& value) {
            orbit.q.push_back(fields.number("q", value, coordinates[i].unit));
        });
    });
    mistakes.attempt([&] {
        read_by_coordinate(reading, fields, "v", [&](std::size_t i, const TomlValue& value) {
            orbit.v.push_back(fields.number("v", value, rate_unit(coordinates[i].unit)));
        });
    });
    mistakes.attempt([&] {
        if (fields.find("t")) orbit.t = fields.number("t", "s");
    });
    mistakes.attempt([&] { orbit.period = fields.expression_or_none("period"); });
    if (fields.find("shift"))
        mistakes.attempt([&] {
            read_by_coordinate(reading, fields, "shift", [&](std::size_t, const TomlValue& value) {
                orbit.shift.push_back(fields.expression("shift", value));
            });
        });
    if (const TomlValue* list = fields.find("inactive"))
        mistakes.attempt([&] {
            if (list->kind != TomlValue::Kind::array)
                throw fields.wrong_type("inactive", *list, "a list of names, as [\"foot\"]");
            orbit.inactive = ContactSet();
            const std::vector<std::string> names = names_of_contacts(reading.system);
            for (const TomlValue& item : list->items) {
                const auto found = std::find(names.begin(), names.end(), item.text.text);
                if (item.kind != TomlValue::Kind::string || found == names.end())
                    throw Mistake{item.at,
                                  fmt::format("no [[constraint]] is named '{}'{}", shown(item.text.text),
                                              did_you_mean(item.text.text, names)),
                                  {}};
                const auto i = static_cast<std::size_t>(found - names.begin());
                if (reading.system.constraints[i].when.text.empty())
                    throw Mistake{item.at, fmt::format("'{}' always counts: it has no 'when'", *found),
                                  "only a contact with when can be inactive"};
                orbit.inactive = orbit.inactive->with(i);
            }
        });
    reading.system.orbit = std::move(orbit);
}

void read_pictures(FileReader& reading) {
    SystemDescription& system = reading.system;
    ErrorCollector& mistakes = reading.mistakes;
    const auto read_drawings = [&](const TomlValue& table, std::vector<DrawingDescription>& drawings) {
        for (const Fields& fields : tables(table, "drawing", mistakes))
            mistakes.attempt([&] { drawings.push_back(read_drawing(system, fields, mistakes)); });
    };
    read_drawings(reading.root, system.drawings);
    for (std::size_t i = 0; i < reading.constraints.size(); ++i) {
        std::vector<DrawingDescription>& touched = system.constraints[i].drawings;
        read_drawings(reading.constraints[i].table(), touched);
        for (DrawingDescription& drawing : touched) drawing.contact = i;
    }
    std::set<std::string> names;
    for (Fields& fields : tables(reading.root, "view", mistakes)) {
        mistakes.attempt([&] {
            const ViewDescription view = read_view(fields, mistakes);
            system.views.push_back(view);
            if (view.name.empty() || names.insert(view.name).second) return;
            const Location at = fields.find("name") ? fields.string("name").at : fields.table().at;
            throw Mistake{at, fmt::format("the name '{}' is used twice", shown(view.name)),
                          "each [[view]] needs its own name"};
        });
    }
    if (system.views.empty()) system.views = default_views(system);
}

bool is_title(const TomlEntry& entry) { return entry.key == "title"; }
// Notes which names are reserved in this file, before any name is read.
void note_reserved_names(const Fields& root, Names& names) {
    const TomlValue *constraints = root.find("constraint"), *frictions = root.find("friction");
    const std::size_t gaps = constraints ? constraints->items.size() : 0;
    const bool is_list = frictions != nullptr && frictions->kind == TomlValue::Kind::array;
    const std::size_t bearings = is_list ? frictions->items.size() : frictions != nullptr ? 1 : 0;
    names.has_several_gaps = gaps > 1;
    names.has_friction = bearings > 0;
    for (std::size_t i = 0; i < gaps; ++i)
        for (const TomlEntry& entry : constraints->items[i].entries)
            names.has_friction = names.has_friction || entry.key == "friction";
    names.has_several_slips = names.has_friction && gaps + bearings > 1;
}

// The title comes first, and a file without one is named after itself.
TomlValue with_title(TomlValue root, const std::string& title) {
    std::erase_if(root.entries, is_title);
    TomlValue value;
    value.kind = TomlValue::Kind::string;
    value.text.text = title;
    root.entries.insert(root.entries.begin(), TomlEntry{"title", {}, std::move(value)});
    return root;
}

}  // namespace

std::string titled_text(const SystemDescription& system) {
    const TomlValue root = read_toml(system.source_text, system.file);
    if (std::any_of(root.entries.begin(), root.entries.end(), is_title)) return system.source_text;
    const std::string_view mark = "\xef\xbb\xbf",
                           text = system.source_text;  // a byte order mark stands first or not at all
    return to_toml(with_title({}, system.title)).append(text.starts_with(mark) ? text.substr(mark.size()) : text);
}

std::string_view Names::why_reserved(std::string_view name) const {
    const auto begins = [&](std::string_view first, std::string_view second) {
        return name.starts_with(first) || name.starts_with(second);
    };
    if (is_reserved(name)) return "functions, t, pi, gap, lambda, energy, work, loss, power and deg";
    if (has_several_gaps && begins("gap_", "lambda_")) return "with several constraints gap_NAME and lambda_NAME";
    if (has_friction && has_word("slip friction_force heat inf", name))
        return "with friction slip, friction_force, heat and inf";
    if (has_several_slips && begins("slip_", "friction_force_"))
        return "with friction slip_NAME and friction_force_NAME";
    return {};
}

ParsedFile read_tables(std::string text, std::string name, std::string* expanded) {
    const FloatEnvironmentGuard ground;  // decimals are rounded to nearest
    if (text.size() > largest_file)
        throw InputError(name, {}, fmt::format("the file is larger than {} MB", largest_file >> 20));
    refuse_other_files(text, name);
    ParsedFile read;
    SystemDescription& system = read.system;
    system.file = std::move(name);
    system.source_text = std::move(text);
    TomlValue root = read_toml(system.source_text, system.file);
    ErrorCollector& mistakes = read.mistakes;
    FileReader reading{system, root, mistakes, read.names};
    Fields fields(root, "a system file");
    const std::vector<std::string> keys = keys_of("");
    fields.allow(keys, mistakes);
    for (const TomlEntry& entry : root.entries)  // an unknown table may hold names
        if (entry.value.kind == TomlValue::Kind::array || entry.value.kind == TomlValue::Kind::table)
            reading.names.complete = reading.names.complete && contains(keys, entry.key);
    mistakes.attempt([&] { system.title = fields.string_or("title", name_without_folder(system.file)); });
    mistakes.attempt([&] { system.source = fields.string_or("source", ""); });
    note_reserved_names(fields, read.names);
    mistakes.attempt([&] { read_coordinates(reading, fields); });
    read_parameters(reading);
    for (const char* key : {"run", "truncation"})
        if (const TomlValue* table = fields.find(key))
            mistakes.attempt([&] {
                read_options(*table, key, system.options, mistakes);
                if (const TomlValue* word = Fields(*table, key).find("reinitialization"))
                    system.reinitialization_at = word->at;
            });
    rewrite(read);
    TomlValue typed;
    for (const TomlEntry& entry : root.entries)
        if (entry.key == "view") typed.entries.push_back(entry);
    reading.expansion = expand_mechanism(root, read);
    if (expanded != nullptr) *expanded = to_toml(with_title(root, system.title));
    mistakes.attempt([&] { read_lagrangian(reading, fields); });
    read_constraints(reading);
    read_frictions(reading);
    read_latches(reading.constraints, system, read.names, mistakes);
    read_jumps(limited_tables(reading, "jump", max_jumps), system, read.names, mistakes);
    if (const TomlValue* table = fields.find("orbit")) mistakes.attempt([&] { read_orbit(reading, *table); });
    read.has_system = mistakes.count() == 0;
    read_pictures(reading);
    ErrorCollector reported;
    for (Fields& view : tables(typed, "view", reported))
        reported.attempt([&] { read.typed_views.push_back(read_view(view, reported)); });
    return read;
}

}  // namespace achilles
