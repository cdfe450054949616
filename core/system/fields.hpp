// One table of a system file, read key by key; every complaint names the key, the table and the place. What is wrong is
// thrown as a Mistake: who reads several independent keys attempts each (system/input_error.hpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "system/description.hpp"
#include "system/input_error.hpp"
#include "system/toml_tree.hpp"
#include "system/units.hpp"

namespace achilles {

class Fields {
 public:
    // `where` is how messages call the table: "[[coordinate]]". Throws if the value is no table.
    Fields(const TomlValue& table, std::string where);

    // Adds a mistake for every key that is none of these, with the nearest of them.
    void allow(const std::vector<std::string>& keys, Mistakes& mistakes);

    const TomlValue* find(std::string_view key) const;  // null where absent
    // Throws where absent: AlreadyTold if allow() took another key for a misspelling of this one.
    const TomlValue& need(std::string_view key) const;
    void need(std::string_view key, const Mistake& otherwise) const;  // the same with a message of one's own

    // The value of a key, checked. Throw where it is absent or of another type.
    Text string(std::string_view key) const;
    // Finite; a string is a constant expression, in which deg may stand where the unit is rad.
    double number(std::string_view key, std::string_view unit = {}) const;
    double positive(std::string_view key, std::string_view unit = {}) const;  // finite and > 0
    Text expression(std::string_view key) const;                              // a string or a finite number
    std::array<Text, 2> point(std::string_view key) const;
    // The same with a value for absence.
    Text expression_or_none(std::string_view key) const;  // an empty text
    std::string string_or(std::string_view key, std::string otherwise) const;
    double number_or(std::string_view key, double otherwise, std::string_view unit = {}) const;
    std::array<double, 2> range_or(std::string_view key, std::array<double, 2> otherwise,
                                   std::string_view unit = {}) const;

    // The same for a value that is an item of a key's array.
    Text expression(std::string_view key, const TomlValue& value) const;
    std::array<Text, 2> point(std::string_view key, const TomlValue& value) const;
    double number(std::string_view key, const TomlValue& value, std::string_view unit) const;

    Mistake wrong_type(std::string_view key, const TomlValue& value, std::string_view expected) const;
    Mistake has_unit(std::string_view key, const TomlValue& value, std::string_view unit, const Measured& typed) const;

    const TomlValue& table() const { return table_; }
    const std::string& where() const { return where_; }

 private:
    const TomlValue& table_;
    std::string where_;
    std::vector<std::string> misspelt_;  // keys that are there under another name
};

// The unit of what a table tells of. Degrees are none: what is evaluated is the sine of radians. After such a mistake it
// is rad, as was meant. Throws Mistake.
void read_unit(const Fields& fields, std::string& unit);

// The tables of an array of tables, at most 1000; none where the key is absent. What is something else is a mistake,
// and left out.
std::vector<Fields> tables(const TomlValue& root, const std::string& key, Mistakes& mistakes);

// The names of these entries as a list for a person: "a, b, c".
std::string listed(const std::vector<std::string>& names);

// [[drawing]] and [[view]], and the views of a system that brings none.
// Parts with a mistake are left empty; the first two throw where the rest cannot be read.
DrawingDescription read_drawing(const SystemDescription& system, const Fields& fields, Mistakes& mistakes);
ViewDescription read_view(Fields& fields, Mistakes& mistakes);
std::vector<ViewDescription> default_views(const SystemDescription& system);

}  // namespace achilles
