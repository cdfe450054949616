// Provenance stored in a picture: what is needed to reproduce it, and notes for the reader.
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
    std::string command;   // shell syntax, without --out and other options that do not change the picture
    std::string picture;   // which picture of the command; "" if it makes only one
    std::vector<InputSource> sources;
};

// Quotes a word for the shell if needed.
std::string shell_word(const std::string& word);
// "achilles" and the words, in shell syntax.
std::string shell_line(const std::vector<std::string>& words);
// The command line that proves the run of a system with these settings. Of the overrides only the start and end times
// are used.
std::string prove_line(const std::string& system, const std::vector<std::string>& settings,
                       const OptionOverrides& overrides);
// The words of a command without --out, --csv and other options that do not change the picture.
std::string command_line(const std::vector<std::string>& words);
// Inverse of command_line(). Throws std::runtime_error if the text is not such a command line.
std::vector<std::string> words_of(std::string_view command_line);

// A run shown in a picture.
struct PictureRun {
    std::string system;  // name or path
    const Trajectory* trajectory;
};
// The origin, the titles of the systems, and every run's parameters, start, options and certificates.
Notes notes(const Origin& origin, const std::vector<PictureRun>& runs);

// "png", "svg" or "pdf", detected from the content; "" for other content.
std::string picture_format(std::string_view file);
// The notes stored in a picture. Throws std::runtime_error if the file has another format or is damaged or truncated.
Notes notes_of(std::string_view file);
// The origin stored in a picture. Throws std::runtime_error, also if there is none.
Origin origin_of(std::string_view file);

}  // namespace achilles
