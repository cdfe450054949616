// What a picture is made from: system files and journals, by the names they were asked for. From the disk, and then
// they are remembered; or from a picture that remembers them, and then from nowhere else.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "journal/journal.hpp"
#include "session/command.hpp"
#include "system/description.hpp"

namespace achilles {

// A change may make another run: those of a stranger's picture are fewer than what a session may replay.
constexpr std::size_t most_changes = 1000;

struct Source {
    enum class Kind { system, journal };
    Kind kind = Kind::system;
    std::string name, text;
    friend bool operator==(const Source&, const Source&) = default;
};

class Inputs {
 public:
    Inputs() = default;
    // Reads the inputs that are kept in a picture; `command` is the command that made it.
    Inputs(std::vector<Source> kept, const std::string& command);

    // What the journals may do with files: nothing, until this is said. A picture's have no file to lose.
    void trust(const Trust& trust) {
        if (!from_picture_) trust_ = trust;
    }

    // Limits the work done with these inputs; null means no limits. The budget of a picture begins at once, with the
    // time limit; any other begins with the first journal that is not trusted.
    const std::shared_ptr<Budget>& budget() const { return trust_.budget; }
    // What follows is short, and must not be ended in the middle.
    void end_time_limit() { time_limit_.disarm(); }

    // The text of a system by path or name, and read. What a name stands for may change while a journal saves files:
    // every time it is asked for counts. Throw InputError.
    std::string text(const std::string& name);
    SystemDescription system(const std::string& name);
    // The text of a file of data, by its path.
    std::string data(const std::string& path);
    // The commands of a journal. Throws Forbidden for what it may not, and where all of them together are too many.
    std::vector<Command> journal(const std::string& path);
    // Commands that are no journal's; those of a picture count, too.
    std::vector<Command> steps(const std::vector<std::string>& lines);
    // The first that was asked for: where a command line names none, a picture tells.
    std::string first_system() const;
    const std::vector<Source>& kept() const { return kept_; }
    // From the disk.
    const std::vector<std::filesystem::path>& files_read() const { return files_read_; }

 private:
    const Source& next(const std::string& name, bool is_journal);
    std::string journal_text(const std::string& path);
    void count(const std::string& name, const std::vector<Command>& commands);

    std::vector<Source> kept_;
    std::vector<std::filesystem::path> files_read_;
    bool from_picture_ = false;
    Trust trust_;
    TimeLimit time_limit_;
    std::size_t replayed_ = 0, changes_ = 0;                     // commands, and those of them that make another run
    std::map<std::pair<std::string, bool>, std::size_t> asked_;  // how often, of a picture
};

// What a file that is dropped on the window stands for, as commands.

// Whether a path names a picture by its ending: .png or .svg.
bool is_picture(const std::string& path);

// The commands that lead to the session a picture shows, from what it carries: its system as the file of that name if
// that still holds the same text and may be read, else as a new text that belongs to no file. What its journal would write
// is left out. Throws Forbidden, with what is to be asked, before it looks into a file that nobody named; InputError for a
// file that is no picture of Achilles, or shows no session.
std::vector<Command> session_in(const std::string& picture, const Trust& trust);

}  // namespace achilles
