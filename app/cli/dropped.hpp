// What a file that is dropped on the window stands for, as commands.
#pragma once

#include <string>
#include <vector>

#include "journal/journal.hpp"
#include "session/command.hpp"

namespace achilles {

// Whether a path names a picture by its ending: .png or .svg.
bool is_picture(const std::string& path);

// The commands that lead to the session a picture shows, from what it carries: its system as the file of that name if
// that still holds the same text and may be read, else as a new text that belongs to no file. What its journal would write
// is left out. Throws Forbidden, with what is to be asked, before it looks into a file that nobody named; InputError for a
// file that is no picture of Achilles, or shows no session.
std::vector<Command> session_in(const std::string& picture, const Trust& trust);

}  // namespace achilles
