// Rewrites a description from the form convenient for users to the terms of the equations of motion, before its
// expressions are interpreted. All later code sees only these terms.
#pragma once

#include "system/read_tables.hpp"

namespace achilles {

// Applies the rewritings of rewrite.cpp in turn, each to the result of the previous one. A text created by a rewriting
// has the location of the value or table it is made from, and is_written = false, so that messages about it point there
// (place_in). Adds a mistake if a description cannot be rewritten.
void rewrite(ParsedFile& reading);

}  // namespace achilles
