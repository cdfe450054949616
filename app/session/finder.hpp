// Which commands a few letters mean: what the command palette lists.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace achilles {

// How well the letters of `typed` fit a text, less is better; negative where they do not stand in it in this order. Without
// regard to case: the text itself, its beginning, the beginning of a word in it, a part of it, letters apart.
int misfit(const std::string& typed, const std::string& text);

// The values that may follow a command's name, each with what else it may be found by: "open" of {"ball_on_sine", its title}.
struct Completions {
    std::string command;
    std::vector<std::pair<std::string, std::string>> values;
    bool is_last = true;  // nothing need follow the value
};

struct Found {
    std::string usage;  // how the command is written
    std::string line;   // what the line becomes when it is taken
    bool runs = false;  // and it can be run like this
};
// The best first. While the name is typed: the commands, by their usage. After it: values to complete the line with, where
// there are some. Empty: the line is to be run as it is.
std::vector<Found> find_commands(const std::string& typed, const std::vector<Completions>& completions);

// How the command that the line begins with is written; empty where there is none.
std::string usage_of(const std::string& line);

}  // namespace achilles
