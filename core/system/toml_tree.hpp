// A TOML file as a plain tree in which everything knows its place. Its .cpp is the only file that includes toml++.
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
    Location at;           // where it starts: the quote of a string, the bracket of a [table]
    Text text;             // string: its first character's place is inside the quotes; number: shortest form
    double number = 0.0;   // integers too
    bool integer = false;  // a number without point or exponent
    bool boolean = false;
    std::vector<TomlValue> items;    // array
    std::vector<TomlEntry> entries;  // table, in the order of the file
};

struct TomlEntry {
    std::string key;
    Location at;
    TomlValue value;
};

// "a string", "a number", "an array", ...
std::string_view kind_name(TomlValue::Kind kind);

// Reads TOML. Throws InputError at the place of a syntax error; `name` stands for the file.
TomlValue read_toml(const std::string& text, const std::string& name);

}  // namespace achilles
