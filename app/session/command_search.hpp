// Fuzzy search for commands: the list in the command palette.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace achilles {

// How well `typed` matches a text, ignoring case: smaller is better, negative if it is not a subsequence. In order of
// rank: the text itself, a prefix, the start of a word, a substring, separate letters.
int match_rank(const std::string& typed, const std::string& text);

// Possible arguments of a command, each with additional search text, e.g. "open" with {"ball_on_sine", its title}.
struct Completions {
    std::string command;
    std::vector<std::pair<std::string, std::string>> values;
    bool is_last = true;  // true if no further argument is required
};

struct CommandMatch {
    std::string usage;  // usage of the command
    std::string line;   // the command line after this match is chosen
    bool runs = false;  // the line is complete and can be executed
};
// Matches, best first. While the name is being typed: commands, matched by their usage. After the name: arguments that
// complete the line, if there are any. Empty: execute the line as it is.
std::vector<CommandMatch> find_commands(const std::string& typed, const std::vector<Completions>& completions);

// Usage of the command at the start of the line; empty if it is unknown.
std::string usage_of(const std::string& line);

}  // namespace achilles
