// Between the tables of a file and the meaning of its expressions: a description that says something in a form convenient for
// people is rewritten in the terms of the equations of motion. Whatever stands behind the reader knows only these terms.
#pragma once

#include "system/read_tables.hpp"

namespace achilles {

// Applies all rewritings in turn (rewrite.cpp lists them); each takes the description as those before it left it. A text that a
// rewriting makes has the location of the value or table from which it is made, and is_written = false: then every message about
// it points there (place_in). Adds a mistake where a description cannot be rewritten.
void rewrite(FileReading& reading);

}  // namespace achilles
