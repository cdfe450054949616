// Commands to and from a text file: a replay, a bug report, a tour, a test. One command a line, # comments.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "journal/budget.hpp"
#include "session/command.hpp"
#include "system/description.hpp"

namespace achilles {

// Throw InputError with file, line and column.
std::vector<Command> parse_journal(std::string_view text, const std::string& name = "<journal>");
std::string journal_file(const std::filesystem::path& file);  // its text
std::vector<Command> read_journal(const std::filesystem::path& file);

// What a journal may do with files. Journals are passed on, and a stranger's is no program: unless the user says
// otherwise it opens and replays the assets alone, by their names.
struct Trust {
    enum class Files {
        refused,   // but those that are `named`
        allowed,   // it reads and writes where it says (--allow-files), but over nothing that is there
        imagined,  // in a picture that is made again, which carries what is read and writes nothing
    };
    Files files = Files::refused;
    std::vector<std::filesystem::path> named;  // by the user: these may be read
    std::map<std::string, bool> answered{};    // "write /home/me/a.toml": whether it may, where the user was asked
    std::shared_ptr<Budget> budget{};          // of its work; null: it has no limits
};
// With a budget, unless it is trusted with files: memory and max_steps may be the defaults, or more where these options say so.
Trust trust_of(bool allow_files, std::vector<std::filesystem::path> named, const Options& typed = {});

// The commands of all journals that one session replays are counted: one that replays itself ends.
constexpr std::size_t most_replayed = 10000;

// What is asked about a file: "read /home/me/a.toml".
std::string want(const std::string& file, bool writes);
// Whether what comes from anybody may read this file; nothing: the user is to be asked.
std::optional<bool> may_read(const std::string& file, const Trust& trust);

// parse_journal() of a journal that may come from anybody. `overwrite` in it counts for nothing. Throws Forbidden, also for
// an option that its budget refuses, and InputError as there.
std::vector<Command> parse_trusted(std::string_view text, const std::string& name, const Trust& trust);

// Of a command line: --do "seek 3.2". Each is a line of its own; blank ones do nothing.
std::vector<Command> parse_steps(const std::vector<std::string>& lines);

std::string journal_text(const std::vector<Command>& commands);

// Throws InputError where a record of a session would take the place of a file.
void refuse_record(const std::filesystem::path& file);

// A journal that grows while things happen; every line is on disk before the next command runs, so that a journal tells
// what led to a crash.
class JournalFile {
 public:
    // Begins a file. Throws InputError if it cannot be written, or there is one.
    explicit JournalFile(const std::filesystem::path& file);
    void append(const Command& command);
    // The last command was refused: nothing has been done.
    void take_back();

 private:
    std::filesystem::path path_;
    std::ofstream stream_;
    std::streamoff before_ = 0;  // the last command
};

// A journal replayed at a person's pace: every `wait` takes its time, and what plays goes on meanwhile.
class Tour {
 public:
    Tour() = default;
    explicit Tour(const std::vector<Command>& journal) : left_(journal.begin(), journal.end()) {}

    bool runs() const { return !left_.empty(); }
    // What is due when so many seconds have passed: commands, and of a wait what has passed of it, so that the waits
    // add up to those of the journal and the end is that of a replay at once.
    std::vector<Command> advance(double seconds);
    // The rest of the present wait at once.
    std::vector<Command> next();
    // Of the sentences that it says: the how manieth is said, and how many there are, as far as is known.
    std::size_t said() const;
    std::size_t sentences() const;
    // Back to the sentence before: what leads there from the beginning, at once; what follows is due again. Commands that
    // write files, or replay journals whose commands have been done, are not among them. Nothing where there is none before.
    std::vector<Command> back();
    void stop() { left_.clear(), done_.clear(); }
    // Another journal, in place of a command that names it, or of the tour that runs.
    void begin(const std::vector<Command>& journal);

 private:
    void keep(const Command& command);

    std::deque<Command> left_;
    std::vector<Command> done_;  // a wait as one, however many pieces it passed in
};

// The words of one line of a journal. A word that holds spaces, # or quotes stands in "double quotes".

// The words of a line and where they stand, to complain about. Refers to the text and the file's name.
class Line {
 public:
    // Throws InputError where quotes are not closed. What follows a # outside quotes is a comment.
    Line(std::string_view text, const std::string& file, int number);

    struct Word {
        std::string text;
        int column = 1;
    };
    const Word& word(std::size_t i) const { return words_[i]; }
    std::size_t count() const { return words_.size(); }

    // Each reads a word and throws an InputError that names its place where it is something else.
    double number(std::size_t i) const;
    int whole_number(std::size_t i) const;
    // So many words follow the first, or else an error that shows the usage.
    void expect_arguments(std::size_t least, std::size_t most, const std::string& usage) const;
    InputError error(int column, const std::string& message, const std::string& hint = {}) const;

 private:
    std::string plain(std::size_t& at) const;
    std::string quoted(std::size_t& at) const;

    std::string_view text_;
    const std::string& file_;
    int number_;
    std::vector<Word> words_;
};

// A word as it is written in a line: in quotes, or plain where it may stand so.
std::string quoted(const std::string& word);
std::string quoted_where_needed(const std::string& word);

// Whether a line holds nothing but space and a comment.
bool is_blank(std::string_view line);

}  // namespace achilles
