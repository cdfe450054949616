// The explorer: one window (or one offscreen picture) on one session. What the command line may tell it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/overrides.hpp"
#include "pictures/picture_job.hpp"

namespace achilles {

struct ExploreOptions {
    std::optional<std::string> system;  // a path or a name, as typed; absent: the first of the list
    std::vector<std::string> settings;  // --set NAME=VALUE, in the order given
    OptionOverrides overrides;          // --end and its kin; they hold for every system that is opened
    std::string journal;                // replayed at the start, a path or a name; empty: none
    std::vector<std::string> steps;     // --do COMMAND, after the journal
    bool allow_files = false;           // journals may use files unasked
    std::string record;                 // where the session is written as a journal; empty: nowhere
    int width = 1600, height = 1000;    // pixels
    double scale = 1.0;                 // of text and strokes
};

struct ScreenshotOptions : ExploreOptions {
    std::string out;  // the PNG
};

// Both return the exit status. Throw InputError for bad input.
int explore(const ExploreOptions& options);
int screenshot(const ScreenshotOptions& options, PictureJob& job);

}  // namespace achilles
