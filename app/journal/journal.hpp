// Commands to and from a text file: a replay, a bug report, a tour, a test. One command a line, # comments.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "session/command.hpp"

namespace achilles {

// Throw InputError with file, line and column.
std::vector<Command> parse_journal(std::string_view text, const std::string& name = "<journal>");
std::string journal_file(const std::filesystem::path& file);  // its text
std::vector<Command> read_journal(const std::filesystem::path& file);

// Of a command line: --do "seek 3.2". Each is a line of its own; blank ones do nothing.
std::vector<Command> parse_steps(const std::vector<std::string>& lines);

std::string journal_text(const std::vector<Command>& commands);

// A journal that grows while things happen; every line is on disk before the next command runs, so that a journal tells
// what led to a crash.
class JournalFile {
 public:
    // Starts the file anew. Throws InputError if it cannot be written.
    explicit JournalFile(const std::filesystem::path& file);
    void append(const Command& command);

 private:
    std::filesystem::path path_;
    std::ofstream stream_;
};

}  // namespace achilles
