// What leads from files to what a session shows: as short a journal, as few words of a command line as will do.
#pragma once

#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

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

}  // namespace achilles
