// Where a picture comes from, carried by the picture itself: enough to make it again, and what a reader wants to know.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/inputs.hpp"
#include "image/notes.hpp"
#include "run/trajectory.hpp"

namespace achilles {

struct OptionOverrides;

struct Origin {
    std::string software;  // "Achilles 0.1.0"
    std::string command;   // as a shell reads it, without --out and what else does not change the picture
    std::string picture;   // which of the command's; "" where it makes one
    std::vector<Source> sources;
};

// A word as a shell reads it, quoted if need be.
std::string shell_word(const std::string& word);
// "achilles" and the words, as a shell reads them.
std::string shell_line(const std::vector<std::string>& words);
// The command line that proves the run of a system with these settings. It takes only the start and end time from the overrides.
std::string prove_line(const std::string& system, const std::vector<std::string>& settings,
                       const OptionOverrides& overrides);
// The words of a command without --out, --csv and other options that say where files go or how the work is done.
std::string command_line(const std::vector<std::string>& words);
// The words again. Throws std::runtime_error if the text is no such command line.
std::vector<std::string> words_of(std::string_view command_line);

// A run that a picture shows.
struct Shown {
    std::string system;  // by name or path
    const Trajectory* trajectory;
};
// The origin, the systems' titles and, for a reader, every run's parameters, start, options and certificates.
Notes notes(const Origin& origin, const std::vector<Shown>& runs);

// "png", "svg" or "pdf", by what the file holds; "" if it is none of them.
std::string picture_format(std::string_view file);
// What such a file carries. Throws std::runtime_error that says what is wrong: no such file, damaged, cut off.
Notes notes_of(std::string_view file);
// The origin among its notes. Throws std::runtime_error, also where there is none.
Origin origin_of(std::string_view file);

}  // namespace achilles
