// What the explorer's window remembers for the next one: the theme, the size of everything and of the panels, the files that
// were open last. A journal in $XDG_CONFIG_HOME/achilles; pictures and other commands without a window never read it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

class Preferences {
 public:
    // Reads them. What is no preference is passed over: a file that somebody spoilt keeps nobody from starting.
    Preferences();
    // What leads to a session that looks as the last one did.
    const std::vector<Command>& looks() const { return looks_; }
    // Paths of system files, the last first.
    const std::vector<std::string>& recent() const { return recent_; }
    // Writes what is to be remembered of this session, if that is not what the file has. Where it cannot be written nothing
    // is remembered.
    void keep(const Session& session);

 private:
    std::filesystem::path file_;  // empty: there is no home
    std::vector<Command> looks_;
    std::vector<std::string> recent_;
    std::string text_;  // of the file, as far as it is known
};

// The commands of a session's looks: theme, enlarge and size, where they are not as at first.
std::vector<Command> looks_of(const Session& session);

}  // namespace achilles
