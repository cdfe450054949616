// The explorer's two surfaces: a window that lives by the clock, and a picture that knows no clock.
#include "explore.hpp"

#include <chrono>
#include <optional>

#include "assets.hpp"
#include "commands/commands.hpp"
#include "journal.hpp"
#include "panels/panels.hpp"
#include "surface/offscreen.hpp"
#include "surface/window.hpp"
#include "write_files.hpp"

namespace achilles {

namespace {

std::vector<SystemEntry> known_systems() {
    std::vector<SystemEntry> entries;
    for (const std::filesystem::path& file : system_files()) {
        const std::string name = file.stem().string();
        try {
            entries.push_back({name, read_system(file).title});
        } catch (const InputError&) {
            // It stays in the list: choosing it shows what is wrong with it.
            entries.push_back({name, name});
        }
    }
    return entries;
}

std::string first_system(const ExploreOptions& options) {
    if (options.system) return *options.system;
    const std::vector<std::string> names = system_names();
    if (names.empty()) throw InputError(assets().string(), {}, "there are no systems here");
    return names.front();
}

// The session that the command line asks for, its journal replayed.
Session open_session(const ExploreOptions& options) {
    const std::vector<Command> journal =
        options.journal.empty() ? std::vector<Command>{} : read_journal(options.journal);
    const std::string name = first_system(options);
    const Opener opener = [overrides = options.overrides](const std::string& system) {
        return open_system(find_system(system), {}, overrides);
    };
    Session session(name, open_system(find_system(name), options.settings, options.overrides), opener);
    for (const Command& command : journal) session.apply(command);
    return session;
}

SurfaceOptions surface_options(const ExploreOptions& options) {
    SurfaceOptions surface;
    surface.width = options.width;
    surface.height = options.height;
    surface.scale = options.scale;
    surface.figure_text_size = 13.0;
    surface.fonts = assets() / "fonts";
    return surface;
}

PanelState panel_state(bool in_window) {
    PanelState state;
    state.systems = known_systems();
    state.in_window = in_window;
    return state;
}

// Seconds since it was last asked, none the first time.
class Clock {
 public:
    double elapsed() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = last_ ? std::chrono::duration<double>(now - *last_).count() : 0.0;
        last_ = now;
        return seconds;
    }
    void stop() { last_.reset(); }

 private:
    std::optional<std::chrono::steady_clock::time_point> last_;
};

// Playing is seeking, by the clock; nothing a journal would keep.
void play_on(Session& session, Clock& clock) {
    if (!session.playing()) return clock.stop();
    session.apply(command::Seek{session.time() + clock.elapsed()});
    if (session.time() >= session.trajectory().end_time) session.apply(command::Pause{});
}

}  // namespace

int explore(const ExploreOptions& options) {
    Session session = open_session(options);
    std::optional<JournalFile> record;
    if (!options.record.empty()) record.emplace(options.record);
    const auto apply = [&](const Command& command) {
        if (record) record->append(command);
        session.apply(command);
    };
    PanelState state = panel_state(true);
    Window window(surface_options(options), "Achilles");
    Clock clock;
    window.run([&] {
        play_on(session, clock);
        for (const Command& command : explorer(session, state)) apply(command);
        for (const std::string& file : window.dropped()) apply(command::Open{file});
        window.keep_drawing(session.playing());
    });
    return reached_end;
}

int screenshot(const ScreenshotOptions& options) {
    OutputFiles files;
    files.add(options.out);
    const Session session = open_session(options);
    PanelState state = panel_state(false);
    Offscreen surface(surface_options(options));
    const Image image = surface.frame([&] { explorer(session, state); }, 3);
    files.put(options.out, png_bytes(image));
    files.commit();
    return session.trajectory().outcome.kind == Outcome::Kind::end_time ? reached_end : stopped_early;
}

}  // namespace achilles
