// First step of reading a system file: its tables, keys and names. The second interprets its expressions
// (model/read_expressions.hpp). model/read_system.hpp does both.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "system/description.hpp"
#include "system/fields.hpp"
#include "system/input_error.hpp"

namespace achilles {

// The names of the coordinates and parameters in a file, which may contain mistakes.
struct Names {
    std::map<std::string, Location> places;
    bool complete = true;            // false: some names could not be read, so no name is reported as unknown
    bool has_several_gaps = false;   // names that start with gap_ or lambda_ are then reserved
    bool has_friction = false;       // slip, friction_force, heat and inf are then reserved,
    bool has_several_slips = false;  // and if true, names that start with slip_ or friction_force_
    std::set<std::string> reported;  // rejected or unknown names, reported once; they may stand for anything

    // Why a name is reserved in this file, for a message; "" if it is not.
    std::string_view why_reserved(std::string_view name) const;
};

// The contents of a file and its mistakes so far.
struct ParsedFile {
    SystemDescription system;
    Names names;
    ErrorCollector mistakes;
    std::vector<ViewDescription> typed_views;  // with names such as thigh.end.x as typed
    bool has_system = false;                   // any mistakes so far are in drawings and views only
};

// Reads the tables of a system file from its text; `name` is the file's name in messages. Throws InputError if nothing
// can be read (the text is not TOML, or too large). `expanded` returns the file with energies and gaps in place of
// bodies.
ParsedFile read_tables(std::string text, std::string name, std::string* expanded = nullptr);

// The contacts by name, for messages and look-ups.
std::vector<std::string> names_of_contacts(const SystemDescription& system);
// Reads the tables of [[jump]]; coordinates, parameters and constraints must be there. Adds to the mistakes.
void read_jumps(std::vector<Fields> tables, SystemDescription& system, const Names& known, ErrorCollector& mistakes);
// Reads the latches of the contacts, whose tables these are. The contacts must be there.
void read_latches(const std::vector<Fields>& tables, SystemDescription& system, const Names& known,
                  ErrorCollector& mistakes);

// The text of a system file with its title. A file without one is named after itself; its title is then put into the
// first line, so that the text describes the same system under any name.
std::string titled_text(const SystemDescription& system);

// Throws InputError, with the file's `name`, if the first bytes show that the text is not TOML: a picture, an archive,
// JSON, a table, UTF-16, another programming language, or nothing.
void refuse_other_files(std::string_view text, const std::string& name);

// Rewrites a description from the form convenient for users to the terms of the equations of motion, before its
// expressions are interpreted. All later code sees only these terms. Applies the rewritings of rewrite.cpp in turn, each
// to the result of the previous one. A text created by a rewriting has the location of the value or table it is made
// from, and is_written = false, so that messages about it point there (place_in). Adds a mistake if a description cannot
// be rewritten.
void rewrite(ParsedFile& reading);

}  // namespace achilles
