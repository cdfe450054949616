// Settings that the explorer keeps between windows: theme, interface scale, panel sizes and recent files. They are
// stored as a journal in $XDG_CONFIG_HOME/achilles. Pictures and other commands without a window never read it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

class Preferences {
 public:
    // Reads the file. Lines that are not preferences are ignored, so a damaged file does not prevent startup.
    Preferences();
    // Commands that restore the appearance of the last session.
    const std::vector<Command>& appearance() const { return appearance_; }
    // Paths of system files, most recent first.
    const std::vector<std::string>& recent() const { return recent_; }
    // Writes the preferences of this session if they differ from the file. Write errors are ignored.
    void keep(const Session& session);

 private:
    std::filesystem::path file_;  // empty: no home folder
    std::vector<Command> appearance_;
    std::vector<std::string> recent_;
    std::string text_;  // last known content of the file
};

// The commands for theme, scale and panel sizes that differ from the defaults.
std::vector<Command> appearance_of(const Session& session);

}  // namespace achilles
