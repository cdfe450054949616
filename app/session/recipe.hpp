// From files and a command line to a session, and back: as short a journal, as few words as will do.
#pragma once

#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

// What leads from files to what a session shows.

// Replayed anywhere, these commands lead to a session of the same text. What was done and undone on the way is not in
// it (`--record` keeps that).
std::vector<Command> recipe(const Session& session);

// The options that make of a system's file the run that was asked for: --set e=0.3 --end 30.
std::vector<std::string> run_options(const Session& session);
std::vector<std::string> run_options(const SystemDescription& description, const Run& file, const Run& run);
// One value or option of a run that is another in another run of the same system, as a person reads it.
struct Difference {
    std::string name, now, other;  // "x(0)", "2 m", "1 m"
    bool is_option = false;        // the name is the command that sets it
    Command back;                  // gives it the other's value
    std::string told() const { return name + (is_option ? " " : " = ") + now; }
};
std::vector<Difference> differences(const SystemDescription& description, const Run& run, const Run& other);
// After these options: what puts the pinned runs beside it, and leads to the plots.
std::vector<Command> figure_steps(const Session& session, const Plots& plots);
// The same, and everything else that is seen.
std::vector<Command> explorer_steps(const Session& session);

// A system's name for somebody who may stand in another folder: a path is made absolute.
std::string name_anywhere(const std::string& system);

// The session that a command line asks for.

class PictureJob;
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
