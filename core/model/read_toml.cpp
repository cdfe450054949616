#include "model/read_toml.hpp"

#include <fmt/format.h>

#include <cmath>

#include "expression/nearest.hpp"

namespace achilles {

namespace {

Location location_of(const toml::source_region& region) {
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        default:
            return "a date or time";
    }
}

bool is_number(const toml::node& node) { return node.is_number(); }

double number_of(const toml::node& node) {
    return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
}

}  // namespace

Location location_of(const toml::node& node) { return location_of(node.source()); }

Location inside_quotes(const toml::node& node, const std::string& source) {
    Location at = location_of(node);
    std::size_t begin = 0;
    for (int line = 1; line < at.line; ++line) begin = source.find('\n', begin) + 1;
    // toml++ counts columns in code points; messages and carets count bytes.
    std::size_t byte = begin;
    for (int column = 1; column < at.column && byte < source.size(); ++column) {
        ++byte;
        while (byte < source.size() && (static_cast<unsigned char>(source[byte]) & 0xC0) == 0x80) ++byte;
    }
    const std::string_view quotes = std::string_view(source).substr(std::min(byte, source.size()), 3);
    const bool triple = quotes == "\"\"\"" || quotes == "'''";
    at.column = static_cast<int>(byte - begin) + 1 + (triple ? 3 : 1);
    return at;
}

TableReader::TableReader(const SystemDescription& description, const toml::table& table, std::string name,
                         std::initializer_list<std::string_view> known)
    : description_(description), table_(table), name_(std::move(name)) {
    const std::vector<std::string> names(known.begin(), known.end());
    for (const auto& [key, value] : table) {
        if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
        std::string list;
        for (const std::string& word : names) list += (list.empty() ? "" : ", ") + word;
        fail(location_of(key.source()),
             fmt::format("unknown key '{}' in {}{}", key.str(), name_, did_you_mean(key.str(), names)),
             fmt::format("{} takes: {}", name_, list));
    }
}

Location TableReader::at() const { return location_of(table_); }

void TableReader::fail(Location at, const std::string& message, const std::string& hint) const {
    throw description_.error(at, message, hint);
}
void TableReader::fail(const toml::node& node, const std::string& message, const std::string& hint) const {
    fail(location_of(node), message, hint);
}

const toml::node& TableReader::require(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) fail(at(), fmt::format("{} needs the key '{}'", name_, key));
    return *node;
}

std::string TableReader::string(std::string_view key) const {
    const toml::node& node = require(key);
    if (!node.is_string()) fail(node, fmt::format("'{}' must be a string, but it is {}", key, kind_of(node)));
    return node.as_string()->get();
}

std::string TableReader::string(std::string_view key, const std::string& otherwise) const {
    return find(key) == nullptr ? otherwise : string(key);
}

double TableReader::number(std::string_view key, double otherwise) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    if (!is_number(*node)) fail(*node, fmt::format("'{}' must be a number, but it is {}", key, kind_of(*node)));
    const double value = number_of(*node);
    if (!std::isfinite(value)) fail(*node, fmt::format("'{}' must be finite", key));
    return value;
}

double TableReader::positive(std::string_view key, double otherwise) const {
    const double value = number(key, otherwise);
    if (!(value > 0.0)) fail(*find(key), fmt::format("'{}' must be positive, but it is {}", key, value));
    return value;
}

bool TableReader::boolean(std::string_view key, bool otherwise) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    if (!node->is_boolean()) fail(*node, fmt::format("'{}' must be true or false, but it is {}", key, kind_of(*node)));
    return node->as_boolean()->get();
}

std::array<double, 2> TableReader::range(std::string_view key, std::array<double, 2> otherwise) const {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != 2 || !is_number(array->at(0)) || !is_number(array->at(1)))
        fail(*node, fmt::format("'{}' must be two numbers, as in [0.0, 1.0]", key));
    const std::array<double, 2> range{number_of(array->at(0)), number_of(array->at(1))};
    if (!(range[0] < range[1]) || !std::isfinite(range[0]) || !std::isfinite(range[1]))
        fail(*node, fmt::format("'{}' must rise: its first number is the lower end", key));
    return range;
}

Text TableReader::text_of(const toml::node& node, std::string_view key) const {
    if (node.is_string()) return {node.as_string()->get(), inside_quotes(node, description_.source_text)};
    if (!is_number(node))
        fail(node, fmt::format("'{}' must be an expression in quotes, or a number, but it is {}", key, kind_of(node)));
    if (!std::isfinite(number_of(node))) fail(node, fmt::format("'{}' must be finite", key));
    return {fmt::format("{}", number_of(node)), location_of(node)};
}

Text TableReader::text(std::string_view key) const { return text_of(require(key), key); }

std::array<Text, 2> TableReader::pair(const toml::node& node, std::string_view key) const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != 2)
        fail(node, fmt::format("'{}' must be a point: two expressions, as in [\"x\", \"y\"]", key));
    return {text_of(array->at(0), key), text_of(array->at(1), key)};
}

std::vector<const toml::table*> TableReader::tables(std::string_view key) const {
    std::vector<const toml::table*> result;
    const toml::node* node = find(key);
    if (node == nullptr) return result;
    const toml::array* array = node->as_array();
    if (array == nullptr) fail(*node, fmt::format("'{0}' must be an array of tables: write [[{0}]]", key));
    for (const toml::node& entry : *array) {
        if (!entry.is_table()) fail(entry, fmt::format("'{0}' must be an array of tables: write [[{0}]]", key));
        result.push_back(entry.as_table());
    }
    return result;
}

}  // namespace achilles
