#include "system/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "system/input_error.hpp"
#include "system/keys.hpp"
#include "system/units.hpp"

namespace achilles {

Fields::Fields(const TomlValue& table, std::string where) : table_(table), where_(std::move(where)) {
    if (table.kind != TomlValue::Kind::table)
        throw Mistake{table.at, fmt::format("{} must be a table, not {}", where_, kind_name(table.kind)),
                      fmt::format("write {}{}, and its keys below", where_, where_.starts_with("[[") ? "" : " once")};
}

namespace {

bool is_array_of_tables(const std::string& key) {
    const auto all = file_tables();
    return std::any_of(all.begin(), all.end(),
                       [&](const FileTable& table) { return table.heading == "[[" + key + "]]"; });
}

}  // namespace

void Fields::allow(const std::vector<std::string>& keys, ErrorCollector& mistakes) {
    for (const TomlEntry& entry : table_.entries) {
        if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
        const std::string other = other_key(entry.key, keys), meant = other.empty() ? nearest(entry.key, keys) : other;
        misspelt_.push_back(meant);
        const std::string question =
            other.empty() ? did_you_mean(entry.key, keys) : fmt::format("; did you mean '{}'?", other);
        const std::string_view instead = other.empty() ? instead_of_key(entry.key, where_) : "";
        mistakes.add(
            {entry.at,
             fmt::format("unknown key '{}' in {}{}", shown(entry.key), where_, instead.empty() ? question : ""),
             !instead.empty() ? std::string(instead)
             : entry.value.kind == TomlValue::Kind::table && is_array_of_tables(meant)
                 ? fmt::format("write one [[{}]] for each", meant)
                 : fmt::format("known keys: {}", listed(keys))});
    }
}

const TomlValue* Fields::find(std::string_view key) const { return find_entry(table_, key); }

const TomlValue& Fields::need(std::string_view key) const {
    need(key, {table_.at, fmt::format("missing key '{}' in {}", key, where_), {}});
    return *find(key);
}

void Fields::need(std::string_view key, const Mistake& otherwise) const {
    if (find(key)) return;
    if (std::find(misspelt_.begin(), misspelt_.end(), key) != misspelt_.end()) throw ErrorAlreadyReported{};
    throw otherwise;
}

Text Fields::string(std::string_view key) const {
    const TomlValue& value = need(key);
    if (value.kind != TomlValue::Kind::string) throw wrong_type(key, value, "a string");
    return value.text;
}

double Fields::number(std::string_view key, std::string_view unit) const { return number(key, need(key), unit); }

double Fields::number(std::string_view key, const TomlValue& value, std::string_view unit) const {
    if (value.kind == TomlValue::Kind::string) {
        try {
            return read_number(value.text.text, unit).value;
        } catch (const ParseError& error) {
            if (const auto apart = measured(value.text.text)) throw has_unit(key, value, unit, *apart);
            throw Mistake{place_in(value.text, error.offset), fmt::format("'{}' in {}: {}", key, where_, error.what()),
                          error.hint};
        }
    }
    if (value.kind != TomlValue::Kind::number) throw wrong_type(key, value, "a number");
    if (!std::isfinite(value.number)) {
        throw Mistake{value.at, fmt::format("'{}' in {} must be finite, not {}", key, where_, value.text.text), {}};
    }
    return value.number;
}

double Fields::positive(std::string_view key, std::string_view unit) const {
    const double x = number(key, unit);
    if (x > 0.0) return x;
    const TomlValue& value = need(key);
    throw Mistake{value.at, fmt::format("'{}' in {} must be positive, not {}", key, where_, value.text.text), {}};
}

Text Fields::expression(std::string_view key) const { return expression(key, need(key)); }

Text Fields::expression(std::string_view key, const TomlValue& value) const {
    const bool number = value.kind == TomlValue::Kind::number;
    if (!number && value.kind != TomlValue::Kind::string) {
        throw wrong_type(key, value, "an expression (a string or a number)");
    }
    if (number && !std::isfinite(value.number)) {
        throw Mistake{value.at, fmt::format("'{}' in {} must be finite, not {}", key, where_, value.text.text), {}};
    }
    if (value.text.text.find_first_not_of(" \t\r\n") == std::string::npos) {
        throw Mistake{value.text.at, fmt::format("'{}' in {} is empty", key, where_), "an expression is expected"};
    }
    return value.text;
}

std::array<Text, 2> Fields::point(std::string_view key) const { return point(key, need(key)); }

std::array<Text, 2> Fields::point(std::string_view key, const TomlValue& value) const {
    if (value.kind != TomlValue::Kind::array) throw wrong_type(key, value, "a point [x, y]");
    if (value.items.size() != 2) {
        throw Mistake{
            value.at,
            fmt::format("a point of '{}' in {} must have two coordinates, not {}", key, where_, value.items.size()),
            {}};
    }
    return {expression(key, value.items[0]), expression(key, value.items[1])};
}

Text Fields::expression_or_none(std::string_view key) const { return find(key) ? expression(key) : Text{}; }

std::string Fields::string_or(std::string_view key, std::string otherwise) const {
    return find(key) ? string(key).text : std::move(otherwise);
}

double Fields::number_or(std::string_view key, double otherwise, std::string_view unit) const {
    return find(key) ? number(key, unit) : otherwise;
}

bool Fields::flag_or(std::string_view key, bool otherwise) const {
    const TomlValue* value = find(key);
    if (value == nullptr) return otherwise;
    if (value->kind != TomlValue::Kind::boolean) throw wrong_type(key, *value, "true or false");
    return value->boolean;
}

std::array<double, 2> Fields::range_or(std::string_view key, std::array<double, 2> otherwise,
                                       std::string_view unit) const {
    const TomlValue* value = find(key);
    if (!value) return otherwise;
    const auto is_number = [](const TomlValue& item) {
        return item.kind == TomlValue::Kind::number || item.kind == TomlValue::Kind::string;
    };
    if (value->kind != TomlValue::Kind::array || value->items.size() != 2 || !is_number(value->items[0]) ||
        !is_number(value->items[1])) {
        throw Mistake{value->at, fmt::format("'{}' in {} must be two numbers, [low, high]", key, where_), {}};
    }
    const auto end = [&](std::size_t i) {
        const TomlValue& item = value->items[i];
        return item.kind == TomlValue::Kind::string ? number(key, item, unit) : item.number;
    };
    const std::array<double, 2> range{end(0), end(1)};
    if (!std::isfinite(range[0]) || !std::isfinite(range[1]) || !(range[0] < range[1])) {
        throw Mistake{value->at, fmt::format("'{}' in {} must be finite with low < high", key, where_), {}};
    }
    return range;
}

Mistake Fields::has_unit(std::string_view key, const TomlValue& value, std::string_view unit,
                         const ValueWithUnit& typed) const {
    const bool is_in_list = &value != find(key), is_inline = value.at.line == table_.at.line;
    const std::string right = is_in_list ? typed.number : fmt::format("{} = {}", key, typed.number);
    std::string hint = without_unit(typed, key, unit, right);
    if (unit.empty() && (key == "value" || key == "start"))
        hint = fmt::format("write {}, {}unit = \"{}\"{}", right, is_inline ? "" : "and ", typed.unit,
                           is_inline ? "" : " on a separate line");
    return {value.text.at, fmt::format("'{}' in {} must be a number without a unit", key, where_), hint};
}

Mistake Fields::wrong_type(std::string_view key, const TomlValue& value, std::string_view expected) const {
    return {value.at, fmt::format("'{}' in {} must be {}, not {}", key, where_, expected, kind_name(value.kind)), {}};
}

Mistake no_name(const Text& name) {
    const std::string latin = spelled_out(name.text);
    return {name.at, fmt::format("'{}' is not a name", shown(name.text)),
            is_name(latin) ? "spell out Greek letters: write " + latin
                           : "a name is a letter followed by letters, digits and underscores"};
}

Mistake used_twice(const Text& name, const Location& other) {
    return {name.at, fmt::format("the name '{}' is used twice", shown(name.text)),
            fmt::format("it is already the name at line {}", other.line)};
}

void read_unit(const Fields& fields, std::string& unit) {
    unit = fields.string_or("unit", "");
    for (std::size_t at = 0; at < unit.size(); ++at) {
        const std::size_t end = std::min(unit.find_first_of(" */^().", at), unit.size());
        const std::string word = unit.substr(at, end - at);
        at = end;
        const bool is_radian = word == "radian" || word == "radians";
        if (!is_radian && word != "deg" && word != "degree" && word != "degrees" && word != "\u00b0") continue;
        const std::string right = std::string(unit).replace(end - word.size(), word.size(), "rad");
        const Mistake mistake{fields.string("unit").at,
                              fmt::format("the unit '{}' is not {}", shown(unit), is_radian ? "known" : "allowed"),
                              fmt::format("write unit = \"{}\", and values in degrees as \"30 deg\"", right)};
        unit = right;
        throw mistake;
    }
}

std::vector<Fields> tables(const TomlValue& root, const std::string& key, ErrorCollector& mistakes) {
    std::vector<Fields> list;
    const std::string where = fmt::format("[[{}]]", key);
    for (const TomlEntry& entry : root.entries) {
        if (entry.key != key) continue;
        if (entry.value.kind != TomlValue::Kind::array) {
            mistakes.add({entry.at,
                          fmt::format("'{}' must be an array of tables, not {}", key, kind_name(entry.value.kind)),
                          fmt::format("write one {} for each", where)});
            continue;
        }
        constexpr std::size_t max_tables = 1000;
        const std::vector<TomlValue>& items = entry.value.items;
        if (items.size() > max_tables)
            mistakes.add({items[max_tables].at, fmt::format("more than {} {}", max_tables, where), {}});
        for (std::size_t i = 0; i < std::min(items.size(), max_tables); ++i)
            mistakes.attempt([&] { list.emplace_back(items[i], where); });
    }
    return list;
}

std::string listed(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

}  // namespace achilles
