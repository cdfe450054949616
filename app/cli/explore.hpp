// The explorer: one session, shown in a window or drawn as an off-screen picture, and its command line options.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/overrides.hpp"
#include "panels/panels.hpp"
#include "pictures/film.hpp"
#include "pictures/picture_job.hpp"
#include "session/session.hpp"
#include "surface/frame.hpp"

namespace achilles {

struct ExploreOptions {
    std::optional<std::string> system;  // path or name, as typed; empty: the first of the list
    std::vector<std::string> settings;  // --set NAME=VALUE, in the order given
    OptionOverrides overrides;          // --end and others; they apply to every system that is opened
    std::string journal;                // replayed at the start, path or name; empty: none
    std::vector<std::string> steps;     // --do COMMAND, after the journal
    bool allow_files = false;           // journals may access files without asking
    std::string record;                 // file that records the session as a journal; empty: none
    int width = 1600, height = 1000;    // pixels
    double scale = 1.0;                 // scale of text and strokes
};

struct ScreenshotOptions : ExploreOptions {
    std::string out;  // the PNG file
};

// Both return the exit status. Throw InputError for bad input.
int explore(const ExploreOptions& options);
int screenshot(const ScreenshotOptions& options, PictureJob& job);

// The animation being drawn while the window is open; at most one.
class CurrentFilmJob {
 public:
    // Throws InputError if another one is in progress.
    void begin(std::unique_ptr<FilmJob> begun);
    bool is_busy() const { return film_ != nullptr; }
    // Updates `progress` and cancels the animation if the user asked for it there. When it has ended, reports the
    // result to the session and returns true.
    bool follow(Session& session, std::optional<FilmProgress>& progress);

 private:
    std::unique_ptr<FilmJob> film_;
};

// Entries of the lists in the explorer.

// The systems of the assets by title, in the order of the gallery.
std::vector<SystemEntry> known_systems();
// The tours. The title of a journal is its first comment: "# The paper's ball".
std::vector<SystemEntry> known_tours();

// Setup shared by the window and the off-screen picture.

inline constexpr double largest_scale = 20.0;  // maximum scale of a surface

// Commands from the system's file alone to the session just opened. A recorded journal starts with them, so that it can
// be replayed without a command line.
std::vector<Command> opening(const Session& session, const ExploreOptions& options);
SurfaceOptions surface_options(const ExploreOptions& options);
PanelState panel_state(bool in_window);

}  // namespace achilles
