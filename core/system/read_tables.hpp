// The first step of reading a system file: its tables, keys and names. What its expressions mean is the second
// (model/read_expressions.hpp); model/read_system.hpp does both.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

// The names of the coordinates and parameters of a file that may have mistakes.
struct Names {
    std::map<std::string, Location> places;
    bool complete = true;           // false: there may be names that could not be read, so none can be called unknown
    bool has_several_gaps = false;  // then names that begin with gap_ or lambda_ are theirs
    std::set<std::string> excused;  // refused or unknown, and told once: they may stand for anything
};

// What was read, and what was wrong with it so far.
struct FileReading {
    SystemDescription system;
    Names names;
    Mistakes mistakes;
    bool has_system = false;  // what is wrong so far is wrong with drawings and views alone
};

// Reads the tables of a system file from its text; `name` stands for the file in messages. Throws InputError where
// there is nothing to read (it is no TOML, or too large).
FileReading read_tables(std::string text, std::string name);

// What a file holds that is no system file: a picture, a result, another encoding.

// Throws InputError, about `name`, where the first bytes show that a text is no TOML: a picture, an archive, JSON, a table,
// UTF-16, a program in another language, nothing at all.
void refuse_other_files(std::string_view text, const std::string& name);

}  // namespace achilles
