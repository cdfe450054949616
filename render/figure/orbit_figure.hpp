// Figures of a periodic run: one period as the system's views show it, and its branch.
#pragma once

#include "figure/publication.hpp"
#include "study/branch.hpp"

namespace achilles {

// Over the branch's parameter where the run is on its section, its period where that is free, what is left of a change, and the
// margin a_inf; solid where it is stable, dashed where it is not, with what happens along it marked. Then the first of the views
// over one period of the orbit. Throws InputError for a view that cannot be evaluated.
Figure compose_branch(const Orbit& orbit, const Branch& branch, std::span<const ViewDescription> views,
                      const PublicationStyle& style);

}  // namespace achilles
