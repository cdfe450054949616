// Inputs of a picture, by the names used to request them: system files, journals, data files. They are read from the
// disk and remembered, or taken only from a picture in which they are stored.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "journal/journal.hpp"
#include "session/command.hpp"
#include "system/description.hpp"

namespace achilles {

// Maximum number of commands that start a new run, in a picture's journals. It is lower than the limit for a session,
// since pictures may come from untrusted sources.
constexpr std::size_t max_changes = 1000;

struct InputSource {
    enum class Kind { system, journal };
    Kind kind = Kind::system;
    std::string name, text;
    friend bool operator==(const InputSource&, const InputSource&) = default;
};

class Inputs {
 public:
    Inputs() = default;
    // Reads the inputs stored in a picture; `command` is the command that made it.
    Inputs(std::vector<InputSource> stored, const std::string& command);

    // What the journals may do with files; by default nothing. Ignored for a picture, whose journals access no files.
    void trust(const FilePolicy& trust) {
        if (!from_picture_) trust_ = trust;
    }

    // Limits of the work done with these inputs; null: no limits. For a picture they apply at once, with the time
    // limit; else from the first untrusted journal on.
    const std::shared_ptr<Budget>& budget() const { return trust_.budget; }
    // Stops the time limit before a short final step that must not be interrupted.
    void end_time_limit() { time_limit_.disarm(); }

    // The text of a system by path or name, and its description. Each request is recorded separately, since a journal
    // may save a file and so change what a name refers to. Throw InputError.
    std::string text(const std::string& name);
    SystemDescription system(const std::string& name);
    // The text of a data file, by its path.
    std::string data(const std::string& path);
    // The commands of a journal. Throws PermissionDenied if it does something without permission, or if all journals
    // together have too many commands.
    std::vector<Command> journal(const std::string& path);
    // Commands from a command line; for a picture they count toward the limits, too.
    std::vector<Command> steps(const std::vector<std::string>& lines);
    // The first system requested: the default for a command line, stored in a picture, that names none.
    std::string first_system() const;
    const std::vector<InputSource>& stored_sources() const { return stored_; }
    // Files read from the disk.
    const std::vector<std::filesystem::path>& files_read() const { return files_read_; }

 private:
    const InputSource& next(const std::string& name, bool is_journal);
    std::string journal_text(const std::string& path);
    void count(const std::string& name, const std::vector<Command>& commands);

    std::vector<InputSource> stored_;
    std::vector<std::filesystem::path> files_read_;
    bool from_picture_ = false;
    FilePolicy trust_;
    TimeLimit time_limit_;
    std::size_t replayed_ = 0, changes_ = 0;  // commands, and how many of them start a new run
    // Number of requests of each input of a picture.
    std::map<std::pair<std::string, bool>, std::size_t> request_counts_;
};

// Files dropped on the window, as commands.

// True if the extension is .png or .svg.
bool is_picture(const std::string& path);

// Commands that restore the session shown in a picture, from what is stored in it. Its system is opened from the file
// with the stored name if that file may be read and its text has not changed; otherwise as a new, unsaved text.
// Commands of the journal that write files are left out. Throws PermissionDenied, with the questions to ask, before it
// reads a file that the user has not named. Throws InputError if the file is not a picture of Achilles, or shows no
// session.
std::vector<Command> session_in(const std::string& picture, const FilePolicy& trust);

}  // namespace achilles
