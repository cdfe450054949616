// Typed access to one table of a system file, key by key. Errors are thrown as Mistake, with the key, the table and the
// location. Code that reads independent keys attempts each one (system/input_error.hpp).
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
    // `where` is the table's name in messages: "[[coordinate]]". Throws Mistake if the value is not a table.
    Fields(const TomlValue& table, std::string where);

    // Adds a mistake for every key that is not in `keys`, with the nearest of them.
    void allow(const std::vector<std::string>& keys, ErrorCollector& mistakes);

    const TomlValue* find(std::string_view key) const;  // null if absent
    // Throws if absent: ErrorAlreadyReported if allow() found a misspelling of this key, else Mistake.
    const TomlValue& need(std::string_view key) const;
    void need(std::string_view key, const Mistake& otherwise) const;  // the same with its own message

    // The checked value of a key. Throw Mistake if it is absent or has another type.
    Text string(std::string_view key) const;
    // Finite. A string is a constant expression, which may use deg if the unit is rad.
    double number(std::string_view key, std::string_view unit = {}) const;
    double positive(std::string_view key, std::string_view unit = {}) const;  // finite and > 0
    Text expression(std::string_view key) const;                              // a string or a finite number
    std::array<Text, 2> point(std::string_view key) const;
    // The same with a default for an absent key.
    Text expression_or_none(std::string_view key) const;  // default: an empty text
    std::string string_or(std::string_view key, std::string otherwise) const;
    double number_or(std::string_view key, double otherwise, std::string_view unit = {}) const;
    bool flag_or(std::string_view key, bool otherwise) const;
    std::array<double, 2> range_or(std::string_view key, std::array<double, 2> otherwise,
                                   std::string_view unit = {}) const;

    // The same for an item of a key's array.
    Text expression(std::string_view key, const TomlValue& value) const;
    std::array<Text, 2> point(std::string_view key, const TomlValue& value) const;
    double number(std::string_view key, const TomlValue& value, std::string_view unit) const;

    Mistake wrong_type(std::string_view key, const TomlValue& value, std::string_view expected) const;
    Mistake has_unit(std::string_view key, const TomlValue& value, std::string_view unit,
                     const ValueWithUnit& typed) const;

    const TomlValue& table() const { return table_; }
    const std::string& where() const { return where_; }

 private:
    const TomlValue& table_;
    std::string where_;
    std::vector<std::string> misspelt_;  // keys present under a misspelled name
};

// The mistake that a text is not a name. The advice spells out a Greek letter.
Mistake no_name(const Text& name);

// For a name that stands at another place already.
Mistake used_twice(const Text& name, const Location& other);

// Reads the unit of the quantity. Degrees are not allowed, because sines are evaluated in radians; after this mistake
// the unit is set to rad. Throws Mistake.
void read_unit(const Fields& fields, std::string& unit);

// The tables of an array of tables, at most 1000; empty if the key is absent. Anything else is a mistake and is left
// out.
std::vector<Fields> tables(const TomlValue& root, const std::string& key, ErrorCollector& mistakes);

// The names as a list for messages: "a, b, c".
std::string listed(const std::vector<std::string>& names);

// [[drawing]] and [[view]], and the views of a system without any. Parts with a mistake are left empty. The first two
// throw Mistake if the rest cannot be read.
DrawingDescription read_drawing(const SystemDescription& system, const Fields& fields, ErrorCollector& mistakes);
ViewDescription read_view(Fields& fields, ErrorCollector& mistakes);
std::vector<ViewDescription> default_views(const SystemDescription& system);

}  // namespace achilles
