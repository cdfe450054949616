// The explorer: one window (or one offscreen picture) on one session. What the command line may tell it.
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

// The film that is drawn beside a window: one at a time.
class FilmInHand {
 public:
    // Throws InputError while another one is drawn.
    void begin(std::unique_ptr<FilmJob> begun);
    bool is_busy() const { return film_ != nullptr; }
    // Tells how far it is, takes from there whether it is given up, and tells the session what became of it: then true.
    bool follow(Session& session, std::optional<FilmProgress>& progress);

 private:
    std::unique_ptr<FilmJob> film_;
};

// What the explorer's lists have to choose from.

// The systems of the assets by their titles, in the order of the gallery.
std::vector<SystemEntry> known_systems();
// The tours: "The paper's ball" for a journal that begins with the comment "# The paper's ball".
std::vector<SystemEntry> known_tours();

// What an explorer is made from, in a window or in a picture.

inline constexpr double largest_scale = 20.0;  // that a surface takes

// What leads from the file alone to the session just opened: with it in front, a recorded journal needs no command
// line.
std::vector<Command> opening(const Session& session, const ExploreOptions& options);
SurfaceOptions surface_options(const ExploreOptions& options);
PanelState panel_state(bool in_window);

}  // namespace achilles
