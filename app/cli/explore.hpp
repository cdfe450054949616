// The explorer: one session, shown in a window or drawn as an off-screen picture, and its command line options.
#pragma once

#include <functional>
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

// What a page in a browser does in place of a window that reads and writes the user's files. Its files are in memory.
struct PageFunctions {
    std::function<void(const std::string& file)> download;  // gives the user a file that was written
    std::function<void()> choose_file;                      // asks for a file, which is then dropped on the window
};

struct ExploreOptions {
    std::optional<std::string> system;  // path, name or link, as typed; empty: the first of the list
    std::vector<std::string> settings;  // --set NAME=VALUE, in the order given
    OptionOverrides overrides;          // --end and others; they apply to every system that is opened
    std::string journal;                // replayed at the start: path, name or link; empty: none
    std::vector<std::string> steps;     // --do COMMAND, after the journal
    bool allow_files = false;           // journals may access files without asking
    std::optional<PageFunctions> page;  // on a page in a browser
    std::string record;                 // file that records the session as a journal; empty: none
    int width = 1600, height = 1000;    // pixels
    double scale = 1.0;                 // scale of text and strokes
};

struct ScreenshotOptions : ExploreOptions {
    std::string out;  // the PNG file
};

// The explorer in a window.
class ExplorerWindow {
 public:
    // Opens the window. Throws InputError for bad input.
    explicit ExplorerWindow(const ExploreOptions& options);
    ~ExplorerWindow();
    ExplorerWindow(const ExplorerWindow&) = delete;
    ExplorerWindow& operator=(const ExplorerWindow&) = delete;
    // Draws frames until the user closes the window. On a page it returns at once, and the browser then calls for
    // frames; the object must stay.
    void run();
    const Session& session() const;
    const PanelState& panels() const;

 private:
    class Explorer;
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// A link given as the system is replayed as a journal. Throws InputError if there is a journal besides.
ExploreOptions with_link(ExploreOptions options);

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

// Puts a PNG on the clipboard. Throws InputError if that is not possible.
void copy_picture(const std::string& png);

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
