// From files and a command line to a session, and back to the shortest journal or command line that reproduces it.
#pragma once

#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

// From a session to commands.

// Commands that lead to a session with the same text form when replayed. Undone changes are not included (`--record`
// keeps them).
std::vector<Command> recipe(const Session& session);

// Command line options that turn the file's run into the session's run: --set e=0.3 --end 30.
std::vector<std::string> run_options(const Session& session);
std::vector<std::string> run_options(const SystemDescription& description, const Run& file, const Run& run);
// One value or option that differs between two runs of a system, in display form.
struct RunDifference {
    std::string name, now, other;  // "x(0)", "2 m", "1 m"
    bool is_option = false;        // `name` is then the command that sets it
    Command back;                  // sets the value of the other run
    std::string text() const { return name + (is_option ? " " : " = ") + now; }
};
std::vector<RunDifference> differences(const SystemDescription& description, const Run& run, const Run& other);
// Commands, after these options, that pin the pinned runs and restore the plots.
std::vector<Command> figure_steps(const Session& session, const Plots& plots);
// The same, plus everything else that is visible.
std::vector<Command> explorer_steps(const Session& session);

// The name of a system, valid in any working directory: a path is made absolute.
std::string name_anywhere(const std::string& system);

// From a command line to a session.

class PictureJob;
struct OptionOverrides;

// The system opened by default: the paper's first example or, if that is missing, the first available one.
std::string first_system();

// Opens a session on a system. `settings` apply to the run of this system, `overrides` to every system opened later
// too. Throws InputError.
Session open_session(const std::string& name, const SystemDescription& first, const std::vector<std::string>& settings,
                     const OptionOverrides& overrides, SystemSource library, Timeout patience);

// Applies the commands of a journal or command line in order, without a window. A refused command throws InputError;
// warnings are printed to standard error, each once.
void apply_all(Session& session, const std::vector<Command>& commands);

// Source of systems and journals for a picture. What its journal writes is written only on the first rendering.
SystemSource source_of(PictureJob& job);

}  // namespace achilles
