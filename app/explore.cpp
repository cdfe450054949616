// The explorer's two surfaces: a window that lives by the clock, and a picture that knows no clock.
#include "explore.hpp"

#include <algorithm>
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

// The system that is asked for; else the paper's first example, or whatever there is.
std::string first_system(const ExploreOptions& options) {
    if (options.system) return *options.system;
    const std::vector<std::string> names = system_names();
    if (names.empty()) throw InputError(assets().string(), {}, "there are no systems here");
    const std::string usual = "ball_on_sine";
    return std::find(names.begin(), names.end(), usual) != names.end() ? usual : names.front();
}

std::vector<Command> journal_of(const ExploreOptions& options) {
    return options.journal.empty() ? std::vector<Command>{} : read_journal(options.journal);
}

// What a command waits for its run in a window: about a frame. Most runs are done by then, and the curves follow the
// hand; the others are shown when they are there.
constexpr double frame_patience = 1.0 / 40.0;

// The session that the command line asks for.
Session open_session(const ExploreOptions& options, Patience patience) {
    const std::string name = first_system(options);
    const auto finish = [overrides = options.overrides](SystemDescription& description) {
        apply(overrides, description.options);
    };
    return {name, open_system(find_system(name), options.settings, options.overrides),
            Library{[](const std::string& system) { return find_system(system); }, finish}, patience};
}

// What leads from the file alone to the session just opened: with it in front, a recorded journal needs no command
// line.
std::vector<Command> opening(const Session& session, const ExploreOptions& options) {
    std::vector<Command> commands{command::Open{session.system()}};
    const Options& run = session.run().options;
    const OptionOverrides& given = options.overrides;
    if (given.end_time) commands.emplace_back(command::End{run.end_time});
    if (given.tolerance) commands.emplace_back(command::Tolerance{run.tolerance});
    if (given.eps || given.eps_q || given.eps_v || given.eps_t)
        commands.emplace_back(command::Eps{run.truncation.eps_q, run.truncation.eps_v, run.truncation.eps_t});
    if (given.conditions) commands.emplace_back(command::UseConditions{*given.conditions});
    if (given.reinitialization) commands.emplace_back(command::UseReinitialization{*given.reinitialization});
    for (const std::string& setting : options.settings) {
        std::string name = setting.substr(0, setting.find('='));
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        if (const auto value = session.value(name)) commands.emplace_back(command::Set{name, *value});
    }
    return commands;
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

// What the files dropped on the window ask for: a journal is replayed; a system is opened, once changes of the text are
// saved or given up.
std::vector<Command> dropped(Window& window, Session& session, PanelState& state) {
    std::vector<Command> commands;
    for (const std::string& file : window.dropped()) {
        try {
            if (std::filesystem::path(file).extension() == ".journal") {
                const std::vector<Command> journal = read_journal(file);
                commands.insert(commands.end(), journal.begin(), journal.end());
            } else {
                request(session, state, command::Open{file}, commands);
            }
        } catch (const InputError& problem) {
            session.refuse(problem);
        }
    }
    return commands;
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

}  // namespace

int explore(const ExploreOptions& options) {
    const std::vector<Command> journal = journal_of(options);
    // A journal tells what was done after each run: then every run is waited for.
    Session session = open_session(options, journal.empty() ? Patience(frame_patience) : Patience());
    PanelState state = panel_state(true);
    Window window(surface_options(options), "Achilles");
    // After everything that can fail: a journal that is there already is not lost to a missing display.
    std::optional<JournalFile> record;
    if (!options.record.empty()) record.emplace(options.record);
    const auto keep = [&](const Command& command) {
        if (record) record->append(command);
    };
    const auto apply = [&](const Command& command) {
        keep(command);
        session.apply(command);
    };
    for (const Command& command : opening(session, options)) keep(command);
    for (const Command& command : journal) apply(command);
    session.set_patience(frame_patience);
    session.on_ready(Window::wake);
    window.on_close([&] { return request_close(session, state); });
    Clock clock;
    window.run([&] {
        session.update();
        // Playing is seeking, by the clock; nothing a journal would keep.
        if (session.playing())
            play_on(session, clock.elapsed());
        else
            clock.stop();
        for (const Command& command : explorer(session, state)) apply(command);
        for (const Command& command : dropped(window, session, state)) apply(command);
        if (state.editor.may_close) window.close();
        window.keep_drawing(session.playing() || is_typing(state));
    });
    return reached_end;
}

int screenshot(const ScreenshotOptions& options) {
    OutputFiles files;
    files.add(options.out);
    const std::vector<Command> journal = journal_of(options);
    Session session = open_session(options, {});
    for (const Command& command : journal) session.apply(command);
    PanelState state = panel_state(false);
    Offscreen surface(surface_options(options));
    const Image image = surface.frame([&] { explorer(session, state); }, 3);
    files.put(options.out, png_bytes(image));
    files.commit();
    return session.trajectory().outcome.kind == Outcome::Kind::end_time ? reached_end : stopped_early;
}

}  // namespace achilles
