// What a session gives away: its plots as a figure, its run as data, itself as a journal, and the command lines that
// make the same.
#pragma once

#include <string>

#include "figure/publication.hpp"
#include "session/session.hpp"

namespace achilles {

// Plots of a session (all, or those of them that `plots` has) for print, the pinned runs that are shown behind them.
Figure figure_of(const Session& session, const PublicationStyle& style);
Figure figure_of(const Session& session, const Plots& plots, const PublicationStyle& style);

// Writes what the file's ending asks for: .svg, .png or .pdf the plots, or one of them; .json or .csv the run; .journal the
// session. Whole or not at all; over another file only with `overwrite`. Throws InputError.
void take_away(const Session& session, const command::Export& what);

// The line for a shell that makes it: "figure" the plots, "run" the data, "explorer" all that is seen.
std::string command_for(const Session& session, const std::string& what);

}  // namespace achilles
