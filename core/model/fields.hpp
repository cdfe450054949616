// One table of a system file, read key by key; every complaint names the key, the table and the place.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/description.hpp"
#include "model/toml_tree.hpp"

namespace achilles {

class Fields {
 public:
    // `where` is how messages call the table: "[[coordinate]]". Throws InputError if the value is no table.
    Fields(const SystemDescription& system, const TomlValue& table, std::string where);

    // Throws for the first key that is none of these, with the nearest of them.
    void allow(const std::vector<std::string>& keys) const;

    const TomlValue* find(std::string_view key) const;  // null where absent
    const TomlValue& need(std::string_view key) const;  // throws where absent

    // The value of a key, checked. Throw where it is absent or of another type.
    Text string(std::string_view key) const;
    double number(std::string_view key) const;    // finite
    double positive(std::string_view key) const;  // finite and > 0
    Text expression(std::string_view key) const;  // a string or a finite number
    std::array<Text, 2> point(std::string_view key) const;
    // The same with a value for absence.
    std::string string_or(std::string_view key, std::string otherwise) const;
    double number_or(std::string_view key, double otherwise) const;
    std::array<double, 2> range_or(std::string_view key, std::array<double, 2> otherwise) const;

    // The same for a value that is an item of a key's array.
    Text expression(std::string_view key, const TomlValue& value) const;
    std::array<Text, 2> point(std::string_view key, const TomlValue& value) const;

    InputError wrong_type(std::string_view key, const TomlValue& value, std::string_view expected) const;
    InputError error(Location at, const std::string& message, const std::string& hint = {}) const;

    const TomlValue& table() const { return table_; }
    const std::string& where() const { return where_; }

 private:
    const SystemDescription& system_;
    const TomlValue& table_;
    std::string where_;
};

// The tables of an array of tables; none where the key is absent. Throws InputError if it is something else, or has
// more than 1000.
std::vector<Fields> tables(const SystemDescription& system, const TomlValue& root, const std::string& key);

// The names of these entries as a list for a person: "a, b, c".
std::string listed(const std::vector<std::string>& names);

// [[drawing]] and [[view]] (INTERFACE section 3), and the views of a system that brings none (section 5).
DrawingDescription read_drawing(const SystemDescription& system, const Fields& fields);
ViewDescription read_view(const Fields& fields);
std::vector<ViewDescription> default_views(const SystemDescription& system);

}  // namespace achilles
