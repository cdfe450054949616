// The session that a command line asks for.
#pragma once

#include <string>
#include <vector>

#include "pictures/picture_job.hpp"
#include "session/session.hpp"

namespace achilles {

struct OptionOverrides;

// Where none is asked for: the paper's first example, or whatever there is.
std::string first_system();

// A session on a system, its run as the command line changes it: `settings` for this one, `overrides` for every one that is
// opened. Throws InputError.
Session open_session(const std::string& name, const SystemDescription& first, const std::vector<std::string>& settings,
                     const OptionOverrides& overrides, SystemSource library, Patience patience);

// What a journal or a command line asks for, in this order, where no window tells what became of it: what the session
// refuses is bad input, what it warns of stands on standard error, each once. Throws InputError.
void apply_all(Session& session, const std::vector<Command>& commands);

// A picture's systems and journals. What its journal writes is written only when it is made for the first time.
SystemSource source_of(PictureJob& job);

}  // namespace achilles
