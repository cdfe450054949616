// Fuzzy search for what a user can do: the list in the palette. It finds actions, systems, values, plots and pages by
// their words, and commands by their letters.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace achilles {

// How well `typed` matches a text, ignoring case: smaller is better, negative if it is not a subsequence. In order of
// rank: the text itself, a prefix, the start of a word, a substring, separate letters.
int match_rank(const std::string& typed, const std::string& text);
// How well the words of `typed`, in any order, begin words of the text: 0 if the text begins with them. Negative: some
// word is missing.
int words_rank(const std::string& typed, const std::string& text);

// Possible arguments of a command, each with additional search text, e.g. "open" with {"ball_on_sine", its title}.
struct Completions {
    std::string command;
    std::vector<std::pair<std::string, std::string>> values;
    bool is_last = true;  // true if no further argument is required
};

// Something that is found by its words: an action, a system, a page.
struct NamedEntry {
    std::string label;   // "Ball bouncing on a sinusoidal surface"
    std::string words;   // more words to find it by, "ball on sine"
    std::string syntax;  // the command that does the same, "open ball_on_sine"; or the key
    std::string line;    // the line to run; empty: the owner of the entry does it
    bool runs = true;    // false: choosing it completes the line
};

struct CommandMatch {
    std::string usage;  // usage of the command
    std::string line;   // the command line after this match is chosen
    bool runs = false;  // the line is complete and can be executed
    std::string label = {};
    int entry = -1;  // index of the entry that was found by its words; -1: a command
};
// Matches, best first. While the name is being typed: commands, matched by their usage. After the name: arguments that
// complete the line, if there are any. Empty: execute the line as it is.
std::vector<CommandMatch> find_commands(const std::string& typed, const std::vector<Completions>& completions);
// The same among commands and entries. Of a line with arguments: the arguments that complete it, the entries whose label
// it begins ("save as"), the line itself if it is a command, other entries. Of a single word: entries by how well it
// begins their words, then commands.
std::vector<CommandMatch> find_anything(const std::string& typed, const std::vector<NamedEntry>& entries,
                                        const std::vector<Completions>& completions);

// Usage of the command at the start of the line; empty if it is unknown.
std::string usage_of(const std::string& line);

}  // namespace achilles
