// What the reader understood of a mechanism: masses, inertias, lengths, the meaning of contact forces, and friction.
#pragma once

#include "model/model.hpp"
#include "output/page.hpp"

namespace achilles {

// Headings Bodies, Springs, Contacts and Friction, with values at the start of the run. For a system typed as energies
// only the last, for a system without friction all but the last. The last cell of a row of text is a sentence
// (Block::Kind::lines).
void put_mechanism(Page& page, const Model& model, const Run& run);

}  // namespace achilles
