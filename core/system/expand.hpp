// Rewrites the tables of bodies, springs and contacts between shapes into energies, forces, gaps, slips and drawings.
#pragma once

#include <string>

#include "expression/parse.hpp"
#include "system/read_tables.hpp"
#include "system/toml_tree.hpp"

namespace achilles {

// Replaces these tables in the tree of a file, whose coordinates and parameters have been read. Every text that it makes
// has the location of its origin. Afterwards `has_failed` says whether a mistake was found; the energies and gaps of
// such a file are missing, and this is not a mistake of its own.
struct MechanismExpansion {
    bool has_mechanism = false, has_failed = false;
};
MechanismExpansion expand_mechanism(TomlValue& root, ParsedFile& reading);

// An expression as typed in a view or outside of the file, with values such as shank.end.x replaced as in the file; the
// names of `scope` come first. Throws Mistake for a wrong name of a body or point.
Text with_body_values(const SystemDescription& system, const Scope& scope, const Text& typed);

// The tree as TOML, in the style of the gallery. [extra] is left out.
std::string to_toml(const TomlValue& root);

}  // namespace achilles
