// What the reader understood of a mechanism: masses, inertias, lengths and the meaning of contact forces.
#pragma once

#include "model/model.hpp"
#include "output/page.hpp"

namespace achilles {

// Headings Bodies, Springs and Contacts, with values at the start of the run; nothing for a system typed as energies.
// The last cell of a row of text is a sentence (Block::Kind::lines).
void put_mechanism(Page& page, const Model& model, const Run& run);

}  // namespace achilles
