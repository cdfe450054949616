// What a session gives away: its plots as a figure, its run as data, itself as a journal, and the command lines that
// make the same.
#pragma once

#include <string>

#include "figure/publication.hpp"
#include "session/session.hpp"

namespace achilles {

// The plots of a session for print, a pinned run behind them.
Figure figure_of(const Session& session, const PublicationStyle& style);

// Writes what the file's ending asks for: .svg or .png the plots, .json or .csv the run, .journal the session. Whole or
// not at all; over another file only with `overwrite`. Throws InputError.
void take_away(const Session& session, const std::string& file, bool overwrite);

// The line for a shell that makes it: "figure" the plots, "run" the data, "explorer" all that is seen.
std::string command_for(const Session& session, const std::string& what);

}  // namespace achilles
