// A TOML file as a tree of values with their locations. Only its .cpp file includes toml++.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "system/description.hpp"

namespace achilles {

struct TomlEntry;

struct TomlValue {
    enum class Kind { string, number, boolean, date, array, table };
    Kind kind = Kind::table;
    Location at;           // of its start: the quote of a string, the bracket of a [table]
    Text text;             // string: located inside the quotes; number: in shortest form
    double number = 0.0;   // integers too
    bool integer = false;  // a number without decimal point or exponent
    bool boolean = false;
    std::vector<TomlValue> items;    // array
    std::vector<TomlEntry> entries;  // table, in the order of the file
};

struct TomlEntry {
    std::string key;
    Location at;
    TomlValue value;
};

// The value of a key of a table; null if there is none.
const TomlValue* find_entry(const TomlValue& table, std::string_view key);

// "a string", "a number", "an array", ...
std::string_view kind_name(TomlValue::Kind kind);

// Parses TOML. Throws InputError at the location of a syntax error; `name` is the file's name in messages.
TomlValue read_toml(const std::string& text, const std::string& name);

}  // namespace achilles
