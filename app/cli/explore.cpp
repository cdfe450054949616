// The explorer in a window, which runs in real time.
#include "cli/explore.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <future>
#include <optional>
#include <utility>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/file_watch.hpp"
#include "cli/inputs.hpp"
#include "cli/manual.hpp"
#include "journal/journal.hpp"
#include "journal/link.hpp"
#include "journal/preferences.hpp"
#include "journal/recovery.hpp"
#include "model/read_system.hpp"
#include "panels/panels.hpp"
#include "panels/widgets.hpp"
#include "pictures/icon.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/thumbnails.hpp"
#include "session/glossary.hpp"
#include "session/replay_script.hpp"
#include "surface/window.hpp"

namespace achilles {

namespace {

// Time a command waits for its run in a window, s: about a frame. Most runs are finished by then, so the curves follow
// the mouse; the others are shown when they are finished.
constexpr double frame_patience = 1.0 / 40.0;

constexpr const char *allow_here = "if you trust it: --allow-files",
                     *allow_in_window = "if you trust it, in a window: achilles explore --allow-files LINK";

}  // namespace

// The explorer in its window. It passes commands from the user, dropped files and tours to the session, the record file
// and the panels.
class ExplorerWindow::Explorer {
 public:
    Explorer(Session& session, Window& window, const ExploreOptions& options, CurrentFilmJob& film, PanelState state,
             FilePolicy trust)
        : session_(session),
          window_(window),
          film_(film),
          state_(std::move(state)),
          scale_(options.scale),
          trust_(std::move(trust)) {
        state_.on_page = options.page.has_value();
        if (options.page) state_.choose_file = options.page->choose_file;
        if (!options.record.empty()) record_.emplace(options.record);
        for (const Command& command : opening(session, options)) keep(command);
        for (const Command& command : preferences_.appearance()) {
            keep(command);
            session_.apply(command);
        }
        state_.recent = preferences_.recent();
        unsaved_ = left_unsaved();
        state_.thumbnails->on_ready(Window::wake);
    }

    // Starts the journals and --do commands of the command line, at the pace of a tour.
    void begin(const std::vector<Command>& journal) {
        tour_.begin(journal);
        session_.set_patience({});  // every run is waited for, since the result of a journal must not depend on timing
    }

    const PanelState& panels() const { return state_; }

    bool may_close() { return request_close(session_, state_); }

    void frame() {
        session_.update();
        state_.on_tour = tour_.runs();
        state_.tour_captions_shown = tour_.captions_shown(), state_.tour_captions = tour_.sentences();
        pass_time();
        std::vector<Command> commands = explorer(session_, state_);
        take_dropped(commands);
        follow_file(commands);
        if (!commands.empty()) {
            apply_tour_action(PanelState::TourAction::stop);  // user input ends the tour
            replayed_ = 0;
        }
        for (const Command& command : commands) take(command);
        take_answer();
        recover();
        if (film_.follow(session_, state_.film)) window_.draw_again();
        keep_text();
        if (commands.empty() && !tour_.runs()) remember_looks();
        if (const double size = session_.scene().text_scale(state_.width / scale_, state_.height / scale_);
            size != std::exchange(text_scale_, size))
            window_.restyle(std::min(scale_ * size, largest_scale), session_.theme().dark);
        window_.fill_screen(session_.scene().presents() && !tour_.runs());
        apply_tour_action(std::exchange(state_.tour_action, PanelState::TourAction::none));
        if (state_.editor.may_close) window_.close();
        // Redraw now and then to show the progress of a run.
        constexpr double progress_seconds = 0.25;
        const bool is_next = !dropped_.empty() && !is_asking();
        window_.keep_drawing(session_.is_moving() || tour_.runs() || is_typing(state_) || waits_for_click(state_) ||
                                 waits_for_tooltip(state_) || is_next,
                             session_.under_way() != nullptr || session_.has_coarse_curves() ||
                                     session_.proof_under_way() != nullptr || session_.sweep_job().is_busy() ||
                                     derives_equations(state_) || film_.is_busy() || state_.thumbnails->is_busy()
                                 ? progress_seconds
                                 : 0.0);
    }

    // The window was closed, so unsaved changes are discarded. Writes the last wait to the record.
    void finish() {
        recovery_.forget();
        keep_wait();
    }

 private:
    // Seconds since the last call; 0 at the first call.
    class FrameTimer {
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

    void pass_time() {
        if ((!session_.is_moving() && !tour_.runs()) || state_.file_question) return clock_.stop();
        const double seconds = clock_.elapsed();
        // Playback advances with the clock and is not recorded.
        if (!tour_.runs()) return play_on(session_, seconds);
        for (const Command& command : tour_.advance(seconds)) take_from_tour(command);
        if (!tour_.runs()) stop_tour();
    }

    // Performs a command. The lists of the current frame do not show its effect: they are made again.
    void take(const Command& command) {
        window_.draw_again();
        const auto* replay = std::get_if<command::Replay>(&command);
        if (replay == nullptr) {
            keep(command);  // recorded first, in case it crashes
            try {
                if (!session_.apply(command) && record_) record_->take_back();
            } catch (const PermissionDenied& problem) {
                if (record_) record_->take_back();
                give_up(problem);
            }
            return;
        }
        try {
            begin_replay(replay->journal);
        } catch (const InputError& problem) {
            give_up(problem);
        }
    }

    // A journal may not save a text that is not a valid system.
    void take_from_tour(const Command& command) {
        if (std::holds_alternative<command::Save>(command) && !session_.document().problems.empty())
            return give_up(session_.document().problems.front());
        take(command);
    }

    void give_up(const InputError& problem) {
        window_.draw_again();
        stop_tour();
        session_.refuse(problem);
    }

    bool is_asking() const {
        return state_.file_question || state_.editor.asking != EditorState::OpenDialog::nothing ||
               state_.editor.waiting;
    }

    // Handles dropped files one at a time, each after the questions and replay of the last one. Journals and pictures
    // are replayed. A system is opened after unsaved changes are saved or discarded. A drop ends a running tour.
    void take_dropped(std::vector<Command>& commands) {
        const std::vector<std::string> files = window_.dropped();
        dropped_.insert(dropped_.end(), files.begin(), files.end());
        if (dropped_.empty() || is_asking() || (tour_.runs() && files.empty())) return;
        const std::string file = dropped_.front();
        dropped_.pop_front();
        const bool replays = std::filesystem::path(file).extension() == ".journal" || is_picture(file);
        request(session_, state_, replays ? Command(command::Replay{file}) : Command(command::Open{file}), commands);
    }

    // Reads the file of the system again after another program has written it. A text with unsaved changes is asked for
    // first, as before any other text that replaces it.
    void follow_file(std::vector<Command>& commands) {
        watch_.follow(session_.document().file);
        if (is_asking() || tour_.runs() || !watch_.take_change()) return;
        try {
            if (read_text(session_.document().file) == session_.document().saved) return;  // it was saved from here
        } catch (const InputError&) {
            return;  // another change follows when the file is there again
        }
        request(session_, state_, command::Reload{}, commands);
        window_.draw_again();
    }

    // Replays a journal or the content of a picture. Asks once about every file it needs. If one answer is no, no
    // command of the journal runs. The same questions are asked for journals that this journal replays.
    void begin_replay(const std::string& name) {
        if (trust_.budget) trust_.budget->limit();
        try {
            const std::vector<Command> journal =
                is_picture(name) ? session_in(name, trust_)
                                 : parse_trusted(text_of_journal(name), name_in_messages(name), trust_);
            replayed_ += journal.size();
            if (replayed_ > max_replayed)
                throw PermissionDenied(name, {}, fmt::format("a session replays at most {} commands", max_replayed));
            begin(journal);
        } catch (const PermissionDenied& problem) {
            // If nothing is left to ask, or an answer was no, the error stays.
            const auto& requests = problem.requests;
            if (requests.empty() || std::any_of(requests.begin(), requests.end(), [&](const std::string& request) {
                    return trust_.answered.contains(request);
                }))
                throw;
            const std::string asker = is_picture(name) || is_link(name) ? name : find_journal(name).string();
            state_.file_question = FileQuestion{asker, requests.front(), requests.size() - 1, {}};
        }
    }

    void take_answer() {
        if (!state_.file_question || !state_.file_question->answer) return;
        const FileQuestion question = *std::exchange(state_.file_question, std::nullopt);
        trust_.answered[question.request] = *question.answer;
        take(command::Replay{question.asker});
    }

    // Saves the text while it is typed, so that it survives a signal, a crash or the loss of the display.
    void keep_text() {
        const bool typing = is_typing(state_);
        if (typing || session_.document().is_changed())
            recovery_.keep(session_.document(), typing ? state_.editor.text : session_.document().text);
        else
            recovery_.forget();
    }

    // Offers the texts left by earlier windows, one after the other.
    void recover() {
        using RecoveryChoice = RecoveryQuestion::RecoveryChoice;
        if (unsaved_.empty() || tour_.runs()) return;
        const RecoveredText& text = unsaved_.front();
        if (!state_.recovery_question) {
            const bool is_busy = is_typing(state_) || session_.document().is_changed();
            if (is_busy) return;
            state_.recovery_question = RecoveryQuestion{text.name, text.when, RecoveryChoice::none};
            return window_.draw_again();
        }
        const RecoveryChoice answer = state_.recovery_question->answer;
        if (answer == RecoveryChoice::none) return;
        state_.recovery_question.reset();
        if (answer == RecoveryChoice::recover) {
            take(text.steps[0]);
            if (!session_.error().empty()) take(command::New{});  // the file no longer exists
            take(text.steps[1]);
            take(command::Show{"editor", true});
            keep_text();
        }
        std::error_code ignored;
        if (answer != RecoveryChoice::later) std::filesystem::remove(text.file, ignored);
        unsaved_.erase(unsaved_.begin());
    }

    // Saves preferences when the user is idle. Changes made by a tour are not preferences.
    void remember_looks() {
        preferences_.keep(session_);
        state_.recent = preferences_.recent();
    }

    void apply_tour_action(PanelState::TourAction wanted) {
        if (wanted == PanelState::TourAction::next)
            for (const Command& command : tour_.next()) take_from_tour(command);
        if (wanted == PanelState::TourAction::back)
            for (const Command& command : tour_.back()) take_from_tour(command);
        if (wanted == PanelState::TourAction::stop && tour_.runs()) {
            stop_tour();
            take(command::Say{""});
        }
    }

    void stop_tour() {
        tour_.stop();
        if (trust_.budget) trust_.budget->lift();
        session_.set_patience(frame_patience);
    }

    // The record merges the parts of a wait.
    void keep(const Command& command) {
        if (const auto* wait = std::get_if<command::Wait>(&command)) {
            waited_ += wait->seconds;
            return;
        }
        keep_wait();
        if (record_) record_->append(command);
    }
    void keep_wait() {
        if (record_ && waited_ > 0.0) record_->append(command::Wait{waited_});
        waited_ = 0.0;
    }

    Session& session_;
    Window& window_;
    CurrentFilmJob& film_;
    PanelState state_;
    std::optional<JournalFile> record_;
    Tour tour_;
    Preferences preferences_;
    double scale_, text_scale_ = 1.0;  // scale of the command line; scale of the session
    Recovery recovery_;
    std::vector<RecoveredText> unsaved_;  // from earlier windows, not offered yet
    FilePolicy trust_;
    FileWatch watch_{Window::wake};
    std::deque<std::string> dropped_;  // dropped files not handled yet
    std::size_t replayed_ = 0;         // commands from journals since the last user input
    FrameTimer clock_;
    double waited_ = 0.0;
};

namespace {

// The icon in the sizes of title bars and task lists; none if the assets have none.
std::vector<Image> window_icons() {
    constexpr int largest = 128;
    std::vector<Image> icons;
    for (const int pixels : icon_sizes)
        if (const auto file = assets() / "icons" / fmt::format("{}.png", pixels);
            pixels <= largest && std::filesystem::exists(file))
            icons.push_back(read_png(file));
    return icons;
}

// If there is no display, the message names what works without one.
Window window_for(const ExploreOptions& options, const std::string& system) {
    try {
        return Window(surface_options(options), "Achilles");
    } catch (const std::runtime_error& problem) {
        throw std::runtime_error(fmt::format(
            "{}\nwithout a window: achilles simulate {system} prints the run, achilles figure {system} --out "
            "F.png draws it, achilles screenshot {system} --out F.png draws the explorer",
            problem.what(), fmt::arg("system", shell_word(system))));
    }
}

}  // namespace

// What the window refers to, in the order in which it is made.
struct ExplorerWindow::Implementation {
    explicit Implementation(const ExploreOptions& options)
        : journal(first_commands(options)),
          name(options.system ? *options.system : first_system()),
          trust(trust_of(options.allow_files, {options.system.value_or(""), options.journal},
                         work_options(options.overrides), options.page ? allow_in_window : allow_here)),
          // Opening the window takes time; read the gallery meanwhile.
          state(std::async(std::launch::async, panel_state, true)),
          session(open_session(name, read_system(find_system(name)), options.settings, options.overrides,
                               library(options), journal.empty() ? Timeout(frame_patience) : Timeout())),
          window(window_for(options, name)),
          // Created last, so that an existing record file is not lost if there is no display.
          explorer(session, window, options, film, state.get(), trust) {
        window.set_icons(window_icons());
    }

    static std::vector<Command> first_commands(const ExploreOptions& options) {
        std::vector<Command> journal = parse_steps(options.steps);
        if (!options.journal.empty()) {
            // Report errors before the window opens. A page is open already, and its explorer reports them.
            if (!options.page) parse_journal(text_of_journal(options.journal), name_in_messages(options.journal));
            journal.insert(journal.begin(), command::Replay{options.journal});
        }
        if (!options.record.empty()) refuse_record(options.record);
        return journal;
    }

    SystemSource library(const ExploreOptions& options) {
        SystemSource source;
        source.find = find_system;
        source.budget = trust.budget;
        source.copy_picture = copy_picture;
        source.film = [this](std::unique_ptr<FilmJob> begun) { film.begin(std::move(begun)); };
        std::error_code no_folder;
        if (options.page)
            source.after_writing = options.page->download;
        else
            source.folder = std::filesystem::current_path(no_folder).string();
        return source;
    }

    std::vector<Command> journal;
    std::string name;
    FilePolicy trust;
    CurrentFilmJob film;
    std::future<PanelState> state;
    Session session;
    Window window;
    Explorer explorer;
};

ExplorerWindow::ExplorerWindow(const ExploreOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
ExplorerWindow::~ExplorerWindow() = default;

void ExplorerWindow::run() {
    Implementation& self = *implementation_;
    self.session.set_patience(frame_patience);
    self.session.prove_behind();
    if (!self.journal.empty()) self.explorer.begin(self.journal);
    self.session.on_ready(Window::wake);
    self.window.on_close([&self] { return self.explorer.may_close(); });
    self.window.run([&self] { self.explorer.frame(); });
    self.explorer.finish();
}

const Session& ExplorerWindow::session() const { return implementation_->session; }
const PanelState& ExplorerWindow::panels() const { return implementation_->explorer.panels(); }

ExploreOptions with_link(ExploreOptions options) {
    if (!options.system || !is_link(*options.system)) return options;
    if (!options.journal.empty())
        throw InputError({}, {}, "a link is a journal itself, and only one journal can be given",
                         "leave out the link or --journal");
    options.journal = *std::exchange(options.system, std::nullopt);
    return options;
}

int explore(const ExploreOptions& options) {
    ExplorerWindow(with_link(options)).run();
    return reached_end;
}

void CurrentFilmJob::begin(std::unique_ptr<FilmJob> begun) {
    if (film_) throw InputError(begun->film(), {}, "another film is still being drawn", "wait for it, or stop it");
    film_ = std::move(begun);
}

bool CurrentFilmJob::follow(Session& session, std::optional<FilmProgress>& progress) {
    if (!film_) {
        progress.reset();
        return false;
    }
    const bool is_given_up = progress && progress->is_given_up;
    if (is_given_up) film_->cancel();
    const bool has_ended = film_->update();
    progress = FilmProgress{film_->film(), film_->progress(), film_->share(), false};
    if (!has_ended) return false;
    const std::unique_ptr<FilmJob> film = std::move(film_);
    progress.reset();
    if (is_given_up)
        session.tell("stopped the film " + film->film());
    else if (film->is_made())
        session.tell("wrote " + std::filesystem::absolute(film->film()).lexically_normal().string());
    else if (film->has_frames())
        session.tell(film->output());
    else
        session.refuse(InputError(film->film(), {}, film->output()));
    return true;
}

std::vector<SystemEntry> known_systems() {
    std::vector<SystemEntry> entries;
    for (const std::filesystem::path& file : system_files()) {
        const std::string name = file.stem().string();
        try {
            entries.push_back({name, read_system(file).title, std::string(group_of(name))});
        } catch (const InputError&) {
            // Keep it in the list: opening it shows the error.
            entries.push_back({name, name, std::string(group_of(name))});
        }
    }
    std::stable_sort(entries.begin(), entries.end(), [](const SystemEntry& a, const SystemEntry& b) {
        return place_in_gallery(a.name) < place_in_gallery(b.name);
    });
    return entries;
}

std::vector<SystemEntry> known_tours() {
    std::vector<SystemEntry> entries;
    for (const std::filesystem::path& file : journal_files()) {
        const std::string name = file.stem().string();
        try {
            const std::string text = journal_file(file);
            const std::string line = text.substr(0, text.find('\n'));
            entries.push_back({name, line.rfind("# ", 0) == 0 ? line.substr(2) : name});
        } catch (const InputError&) {
            entries.push_back({name, name});  // opening it shows the error
        }
    }
    // The tour of the window comes first; the others are about systems.
    std::stable_partition(entries.begin(), entries.end(),
                          [](const SystemEntry& entry) { return entry.name == "the_explorer"; });
    return entries;
}

std::vector<Command> opening(const Session& session, const ExploreOptions& options) {
    std::vector<Command> commands{command::Open{session.system()}};
    for (const auto group : options_by_command(session.description().options, session.run().options)) {
        const bool is_given = std::any_of(group.begin(), group.end(), [&](const Option& option) {
            return options.overrides.find(option) != nullptr;
        });
        if (is_given) commands.emplace_back(command::SetOption(group[0], session.run().options));
    }
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
    surface.figure_text_size = screen_text_size;
    surface.fonts = assets() / "fonts";
    return surface;
}

PanelState panel_state(bool in_window) {
    PanelState state;
    state.systems = known_systems();
    state.tours = known_tours();
    for (const ManualTopic& topic : manual_topics()) state.manual.push_back({topic.name, topic.title});
    state.manual_page = [](const std::string& topic) { return manual_page(topic); };
    state.in_window = state.reads_folders = in_window;
    state.thumbnails = std::make_shared<Thumbnails>(find_system, !in_window);
    return state;
}

}  // namespace achilles
