// Journals: text files of commands, one per line, with # comments. Used for replay, bug reports, tours and tests.
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
std::string journal_file(const std::filesystem::path& file);  // the text of the file
std::vector<Command> read_journal(const std::filesystem::path& file);

// What a journal may do with files. Journals may come from untrusted sources. Unless the user allows more, a journal
// opens and replays only assets, by their names.
struct FilePolicy {
    enum class Files {
        refused,       // no files except those in `named`
        allowed,       // reads and writes the paths it names, but replaces no existing file (--allow-files)
        virtual_only,  // files are read from the picture being reproduced; nothing is written
    };
    Files files = Files::refused;
    std::vector<std::filesystem::path> named;  // files named by the user, which may be read
    std::map<std::string, bool> answered{};    // the user's answers: "write /home/me/a.toml" -> allowed or not
    std::shared_ptr<Budget> budget{};          // limits of its work; null: no limits
};
// Has a budget unless `allow_files`. The budget allows the default memory and max_steps, or those of `typed` if larger.
// `how_to_allow`: what a message about its limits says to do.
FilePolicy trust_of(bool allow_files, std::vector<std::filesystem::path> named, const Options& typed = {},
                    const char* how_to_allow = "if you trust it: --allow-files");

// Maximum number of commands in all journals that one session replays. It stops a journal that replays itself.
constexpr std::size_t max_replayed = 10000;

// The question to the user about a file: "read /home/me/a.toml".
std::string access_request(const std::string& file, bool writes);
// Whether an untrusted journal may read this file; empty: ask the user.
std::optional<bool> may_read(const std::string& file, const FilePolicy& trust);

// parse_journal() for an untrusted journal. `overwrite` in it is ignored. Throws InputError as parse_journal() does,
// and Forbidden for file access or options that `trust` does not allow.
std::vector<Command> parse_trusted(std::string_view text, const std::string& name, const FilePolicy& trust);

// Parses the --do "seek 3.2" arguments of a command line. Each is one line; blank lines are ignored.
std::vector<Command> parse_steps(const std::vector<std::string>& lines);

std::string journal_text(const std::vector<Command>& commands);

// Throws InputError if recording a session to this file would replace an existing file.
void refuse_record(const std::filesystem::path& file);

// Records a session. Every line is on disk before its command runs, so that the journal shows what led to a crash.
class JournalFile {
 public:
    // Creates the file. Throws InputError if it cannot be written or exists already.
    explicit JournalFile(const std::filesystem::path& file);
    void append(const Command& command);
    // Removes the last command, which was refused and had no effect.
    void take_back();

 private:
    std::filesystem::path path_;
    std::ofstream stream_;
    std::streamoff before_ = 0;  // offset of the last command
};

// Replays a journal in real time: every `wait` takes its time, and playback continues meanwhile.
class Tour {
 public:
    Tour() = default;
    explicit Tour(const std::vector<Command>& journal) : left_(journal.begin(), journal.end()) {}

    bool runs() const { return !left_.empty(); }
    // Commands due after `seconds` more seconds. A `wait` that has partly elapsed is returned as a shorter `wait`. Thus
    // all waits add up to those of the journal, and the final state equals that of an immediate replay.
    std::vector<Command> advance(double seconds);
    // Skips the rest of the current wait.
    std::vector<Command> next();
    // The number of `say` captions shown so far, and the total as far as known.
    std::size_t captions_shown() const;
    std::size_t sentences() const;
    // Goes back to the previous caption. Returns the commands that lead there from the beginning; the later ones become
    // due again. Commands that write files, and `replay` commands already expanded, are left out. Empty if there is no
    // previous caption.
    std::vector<Command> back();
    void stop() { left_.clear(), done_.clear(); }
    // Inserts another journal, in place of the `replay` command that names it or before the rest of the running tour.
    void begin(const std::vector<Command>& journal);

 private:
    void keep(const Command& command);

    std::deque<Command> left_;
    std::vector<Command> done_;  // the parts of an interrupted wait are merged
};

// Tokens of one journal line. A word with spaces, # or quotes is written in "double quotes".

// The words of a line with their columns, for error messages. Keeps references to the text and the file name.
class JournalLine {
 public:
    // Throws InputError for an unclosed quote. A # outside quotes starts a comment.
    JournalLine(std::string_view text, const std::string& file, int number);

    struct Word {
        std::string text;
        int column = 1;
    };
    const Word& word(std::size_t i) const { return words_[i]; }
    std::size_t count() const { return words_.size(); }

    // Each parses a word, and throws InputError with its position if it has the wrong form.
    double number(std::size_t i) const;
    int whole_number(std::size_t i) const;
    // Throws InputError with the usage unless the number of words after the first is between `least` and `most`.
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

// The written form of a word: always quoted, or quoted only if necessary.
std::string quoted(const std::string& word);
std::string quoted_where_needed(const std::string& word);

// True for a line of only spaces and a comment.
bool is_blank(std::string_view line);

}  // namespace achilles
