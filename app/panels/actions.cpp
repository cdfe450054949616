#include "panels/actions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// The next interface scale; the same steps as in browsers.
double next_size(double now, int step) {
    constexpr std::array sizes{0.5, 0.67, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0};
    if (step > 0) {
        const auto* const larger = std::upper_bound(sizes.begin(), sizes.end(), now);
        return larger == sizes.end() ? now : *larger;
    }
    const auto* const here = std::lower_bound(sizes.begin(), sizes.end(), now);
    return here == sizes.begin() ? now : *(here - 1);
}

template <int step>
void enlarge(const Session& session, PanelState&, Commands& commands) {
    const double now = session.scene().enlarged(), next = step == 0 ? 1.0 : next_size(now, step);
    if (next != now) commands.emplace_back(command::Enlarge{next});
}

void toggle_play(const Session& session, PanelState&, Commands& commands) {
    // A pause also seeks to its time, so that a replayed journal stops at the same picture.
    if (session.playing())
        commands.insert(commands.end(), {command::Pause{}, command::Seek{session.time()}});
    else {
        if (session.selected() > 0 && !lens_is_open(session)) commands.emplace_back(command::Select{0});
        commands.emplace_back(command::Play{});
    }
}

void size_automatically(const Session& session, PanelState&, Commands& commands) {
    for (const std::string& panel : command::sized_panels)
        if (session.scene().share(panel) > 0.0) commands.emplace_back(command::SetPanelSize{panel, 0.0});
}

void open_file(const Session&, PanelState& state, Commands&) { ask_to_open(state); }
void save_as(const Session& session, PanelState& state, Commands&) { ask_to_save(session, state); }
void begin_system(const Session& session, PanelState& state, Commands& commands) {
    state.editor.takes_keys = true;
    if (!session.shows_editor()) commands.emplace_back(command::Show{"editor", true});
    request(session, state, command::New{}, commands);
}

// The file that was open last and is not open now. Without one, any file can be chosen.
void reopen_file(const Session& session, PanelState& state, Commands& commands) {
    const auto last = std::find_if(state.recent.begin(), state.recent.end(),
                                   [&](const std::string& path) { return path != session.document().file; });
    if (last == state.recent.end()) return ask_to_open(state);
    request(session, state, command::Open{*last}, commands);
}

void export_figure(const Session& session, PanelState& state, Commands&) { ask_to_export(session, state, "svg"); }
void export_film(const Session& session, PanelState& state, Commands&) { ask_to_export(session, state, "mp4"); }
void export_data(const Session& session, PanelState& state, Commands&) { ask_to_export(session, state, "csv"); }
void save_session(const Session& session, PanelState& state, Commands&) { ask_to_export(session, state, "journal"); }

// Hides a panel that is seen. Where the panels are tabs, it goes behind the mechanism.
command::Show toggled_panel(const std::string& panel, bool is_seen, const PanelState& state) {
    if (state.front.empty()) return {panel, !is_seen};
    return {state.front == panel ? "mechanism" : panel, true};
}

// Events that a study hides are shown; events that are seen are hidden.
void toggle_events(const Session& session, PanelState& state, Commands& commands) {
    const std::string seen = session.scene().below();
    if (seen != "events" && !seen.empty()) commands.emplace_back(command::Show{seen, false});
    commands.emplace_back(toggled_panel("events", seen == "events", state));
}

void quit(const Session& session, PanelState& state, Commands&) {
    if (request_close(session, state)) state.editor.may_close = true;
}

void seek_start(const Session& session, PanelState&, Commands& commands) {
    if (session.playing()) commands.emplace_back(command::Pause{});
    move_time(session, session.run().options.start_time, commands);
}
void seek_end(const Session& session, PanelState&, Commands& commands) {
    move_time(session, session.trajectory().end_time, commands);
}

template <int step>
void go_to_view(const Session& session, PanelState& state, Commands& commands) {
    achilles::go_to_view(session, state, step, commands);
}

void fit_all(const Session& session, PanelState&, Commands& commands) {
    for (std::size_t i = 0; i < session.plotted().list().size(); ++i)
        commands.emplace_back(command::Fit{static_cast<int>(i) + 1});
}

void show_recent(const Session& session, PanelState& state, Commands& commands) {
    for (const std::string& path : state.recent) {
        const std::string name = std::filesystem::path(path).filename().string();
        if (ImGui::MenuItem(fmt::format("{}##{}", name, path).c_str()))
            request(session, state, command::Open{path}, commands);
        remember(state, "menu " + path);
        tooltip(path);
    }
}

void show_command_lines(const Session&, PanelState& state, Commands& commands) {
    for (const char* what : {"explorer", "figure", "run", "sweep"}) {
        if (ImGui::MenuItem(fmt::format("of the {}", what).c_str())) commands.emplace_back(command::Copy{what});
        remember(state, std::string("menu copy ") + what);
        tooltip("shell command that reproduces this");
    }
}

// In the order of the gallery.
template <int step>
void next_system(const Session& session, PanelState& state, Commands& commands) {
    const auto& all = state.systems;
    const auto here =
        std::find_if(all.begin(), all.end(), [&](const SystemEntry& one) { return one.name == session.system(); });
    const auto count = static_cast<std::ptrdiff_t>(all.size());
    if (count == 0) return;
    const std::ptrdiff_t next = here == all.end() ? 0 : (here - all.begin() + step + count) % count;
    request(session, state, command::Open{all[static_cast<std::size_t>(next)].name}, commands);
}

bool is_lecture(const Session& session) { return session.scene().presents(); }
bool is_idle(const Session& session) { return session.under_way() == nullptr; }
bool can_undo(const Session& session) { return session.can_undo(); }
bool can_redo(const Session& session) { return session.can_redo(); }
bool has_look(const Session& session) { return session.scene().look().has_value(); }
bool is_turned(const Session& session) { return session.scene().direction().has_value(); }

constexpr unsigned new_group = Action::group, not_in_text = Action::not_typing, of_player = Action::player,
                   held_too = Action::repeats, as_submenu = Action::submenu, on_desktop = Action::desktop;

// clang-format off: one line each, so that the table can be read as one.
constexpr Action all_actions[] = {
    {"File", "New", "Ctrl+N", "a new system", begin_system},
    {"File", "Open\u2026", "Ctrl+O", "open a file", open_file},
    {"File", "Open recent", "", "", show_recent, as_submenu | on_desktop},
    {"File", "Open last file", "Ctrl+Shift+T", "the last file again", reopen_file, on_desktop},
    {"File", "Gallery\u2026", "Ctrl+G", "the gallery", "show gallery"},
    {"File", "Save", "Ctrl+S", "save the text", save_or_ask, new_group},
    {"File", "Save as\u2026", "", "save to another file", save_as},
    {"File", "Export figure\u2026", "Ctrl+P", "export a figure: SVG, PDF, PNG", export_figure, new_group, is_idle},
    {"File", "Export film\u2026", "Ctrl+M", "export a film (needs ffmpeg)", export_film, on_desktop, is_idle},
    {"File", "Export data\u2026", "", "the run as CSV, one row per instant, or as JSON", export_data, 0, is_idle},
    {"File", "Save session\u2026", "", "the commands that lead here, to replay anywhere", save_session, 0, is_idle},
    {"File", "Copy link", "", "it opens this session in a browser", "copy link", new_group},
    {"File", "Copy command", "", "", show_command_lines, as_submenu},
    {"File", "Copy picture", "", "the plots, to paste into a document", "copy picture", 0, is_idle},
    {"File", "Copy data", "", "the run as a table, for a spreadsheet", "copy data", 0, is_idle},
    {"File", "Quit", "Ctrl+Q", "close the window", quit, new_group | on_desktop},

    {"Edit", "Undo", "Ctrl+Z", "undo", "undo", not_in_text | held_too, can_undo},
    {"Edit", "Redo", "Ctrl+Shift+Z, Ctrl+Y", "redo", "redo", not_in_text | held_too, can_redo},
    {"Edit", "Reset all values", "", "every value as in the file", "reset", new_group},
    {"Edit", "Pin this run", "", "keep it beside later ones, to compare", "pin"},
    {"Edit", "Find\u2026", "Ctrl+Shift+P", "find anything by its name", "show palette", new_group},
    {"Edit", "Edit System File", "Ctrl+E", "edit the system file", toggle_editor},

    {"View", "Controls", "Ctrl+1", "the sliders", "show controls"},
    {"View", "Plots", "Ctrl+2", "the plots", "show plots"},
    {"View", "Events", "Ctrl+3", "the events", toggle_events},
    {"View", "Equations", "Ctrl+7", "the equations of motion", "show equations", new_group},
    {"View", "Sensitivities", "Ctrl+5", "sensitivities", "show depend"},
    {"View", "Sweep", "Ctrl+4", "sweep: many runs", "show sweep"},
    {"View", "Periodic run", "Ctrl+6", "periodic run and branch", "show orbit"},
    {"View", "Proof", "Ctrl+8", "the proof of the run", "show proof"},
    {"View", "Automatic panel sizes", "", "forget the sizes set by hand", size_automatically, new_group},
    {"View", "Trail", "", "the path of the body", "show trail", new_group},
    {"View", "Velocity", "", "the arrow of the velocity", "show velocity"},
    {"View", "Contact force", "", "the arrows of the contact forces", "show force"},
    {"View", "Poses at events", "", "the mechanism at every event", "show strobe"},
    {"View", "Configuration plane", "", "two quantities in place of the mechanism", "show plane"},
    {"View", "Energy", "", "where the energy is and where it went", "show energy"},
    {"View", "Fit whole run", "", "the camera shows the whole run", "look all", 0, has_look},
    {"View", "Standard direction", "", "a system in space as its file draws it", "turn default", 0, is_turned},
    {"View", "Lecture", "F11", "a lecture: for a class", "present on", new_group},
    {"View", "Next system", "Down", "next system in a lecture", next_system<1>, of_player, is_lecture},
    {"View", "Previous system", "Up", "next system in a lecture", next_system<-1>, of_player, is_lecture},
    {"View", "Larger", "Ctrl+Plus", "everything larger", enlarge<1>, new_group},
    {"View", "Smaller", "Ctrl+Minus", "everything smaller", enlarge<-1>},
    {"View", "Reset Zoom", "Ctrl+0", "reset zoom", enlarge<0>},
    {"View", "Dark theme", "Ctrl+D", "light or dark", "theme dark"},

    {"Time", "Play", "Space", "play, pause", toggle_play, of_player},
    {"Time", "Loop playback", "", "start again at the end", "loop on"},
    {"Time", "Previous event", "Left", "previous, next event", "step -1 event", new_group | of_player | held_too},
    {"Time", "Next event", "Right", "previous, next event", "step 1 event", of_player | held_too},
    {"Time", "Previous Zeno point", "Page Up", "Zeno point before, after", "step -1 zeno", of_player | held_too},
    {"Time", "Next Zeno point", "Page Down", "Zeno point before, after", "step 1 zeno", of_player | held_too},
    {"Time", "Back by a frame", "Comma", "back, on by one frame", "step -1 frame", of_player | held_too},
    {"Time", "On by a frame", "Period", "back, on by one frame", "step 1 frame", of_player | held_too},
    {"Time", "Start of the run", "Home", "start, end of the run", seek_start, new_group | of_player},
    {"Time", "End of the run", "End", "start, end of the run", seek_end, of_player},

    {"Plots", "Back", "Alt+Left", "plots as before", go_to_view<-1>, held_too},
    {"Plots", "Forward", "Alt+Right", "plots as after", go_to_view<1>, held_too},
    {"Plots", "Fit all", "", "every plot shows all of its data", fit_all},
    {"Plots", "Link time", "", "one time axis for all plots over time", "link on", new_group},
    {"Plots", "Copy plotted data", "", "every plot as a table, for a spreadsheet", "copy plots", new_group, is_idle},
    {"Plots", "Copy events", "Ctrl+C", "copy the chosen event", "copy events", not_in_text, is_idle},

    {"Help", "Keys and words", "F1", "this card", "show help"},
};
// clang-format on

// What the mouse does, and the keys of single panels.
const Shortcut gestures[] = {
    {"Keys", "Tab, arrows", "to another control; Enter clicks"},
    {"Keys", "Escape", "close what is open"},
    {"Keys", "Enter", "next step of a tour"},
    {"Keys", "Backspace", "previous step of a tour"},
    {"Sliders", "click the number", "type a slider's value"},
    {"Sliders", "Shift+drag", "a slider in fine steps"},
    {"Sliders", "right click", "the file's value"},
    {"Plots", "wheel", "zoom; over an axis along it"},
    {"Plots", "drag", "move the axes"},
    {"Plots", "right, Shift+drag", "zoom to a box"},
    {"Plots", "double click", "fit the data"},
    {"Plots", "click", "go to that event or time"},
    {"Mechanism", "wheel", "zoom at the mouse"},
    {"Mechanism", "drag a body", "set its start"},
    {"Mechanism", "drag the tip", "set the start's velocity"},
    {"Mechanism", "drag beside", "pan; turn a system in space"},
    {"Mechanism", "right drag", "move the camera"},
    {"Mechanism", "double click", "the whole run"},
    {"Events", "click", "choose it and open its card"},
    {"Events", "right click", "on a title: the columns"},
};

// A command that turns something on, if it is on, becomes the one that turns it off.
Command toggled(const Action& action, const Session& session, const PanelState& state) {
    Command command = parse_command(action.effect.command);
    const bool on = is_on(action, session);
    if (auto* const show = std::get_if<command::Show>(&command)) {
        const auto& tabs = command::tabs;
        const bool is_tab = std::find(tabs.begin(), tabs.end(), show->what) != tabs.end();
        *show = is_tab ? toggled_panel(show->what, on, state) : command::Show{show->what, !on};
    }
    if (auto* const present = std::get_if<command::Present>(&command)) present->on = !on;
    if (auto* const loop = std::get_if<command::Loop>(&command)) loop->on = !on;
    if (auto* const link = std::get_if<command::Link>(&command)) link->on = !on;
    if (auto* const theme = std::get_if<command::SetTheme>(&command)) theme->dark = !on;
    return command;
}

// ---- keys ----

struct KeyChord {
    bool control = false, shift = false, alt = false;
    int code = 0;
};

int code_of(std::string_view name) {
    constexpr std::pair<std::string_view, int> named[] = {{"F1", key::f1},
                                                          {"F11", key::f11},
                                                          {"Left", key::left},
                                                          {"Right", key::right},
                                                          {"Home", key::home},
                                                          {"End", key::end},
                                                          {"Space", ' '},
                                                          {"Comma", ','},
                                                          {"Period", '.'},
                                                          {"Plus", '='},
                                                          {"Minus", '-'},
                                                          {"Up", key::up},
                                                          {"Down", key::down},
                                                          {"Page Up", key::page_up},
                                                          {"Page Down", key::page_down}};
    for (const auto& [word, code] : named)
        if (word == name) return code;
    return static_cast<unsigned char>(name.front());  // a letter, a digit or a sign
}

KeyChord chord_of(std::string_view keys) {
    KeyChord chord;
    for (std::size_t plus = keys.find('+'); plus != std::string_view::npos; plus = keys.find('+')) {
        const std::string_view held = keys.substr(0, plus);
        (held == "Ctrl" ? chord.control : held == "Shift" ? chord.shift : chord.alt) = true;
        keys.remove_prefix(plus + 1);
    }
    chord.code = code_of(keys);
    return chord;
}

bool takes_chord(const KeyChord& chord, const PanelState& state, bool repeats) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool any_shift = chord.code == '=';  // Plus is Shift and = on many keyboards
    return io.KeyCtrl == chord.control && io.KeyAlt == chord.alt && (any_shift || io.KeyShift == chord.shift) &&
           takes_key(state, chord.code, repeats);
}

}  // namespace

std::span<const Action> actions() { return all_actions; }

const Action& action(std::string_view name) {
    const auto* const found = std::find_if(std::begin(all_actions), std::end(all_actions),
                                           [&](const Action& one) { return one.name == name; });
    if (found == std::end(all_actions)) std::abort();  // a name in the code that is not in the table
    return *found;
}

bool is_on(const Action& action, const Session& session) {
    const Scene& scene = session.scene();
    const std::string_view line = action.effect.command;
    constexpr std::string_view show = "show ";
    if (line.starts_with(show)) return scene.shows(std::string(line.substr(show.size())));
    return (line == "present on" && scene.presents()) || (line == "loop on" && scene.loops()) ||
           (line == "link on" && session.plotted().linked()) || (line == "theme dark" && session.theme().dark) ||
           (action.name == "Events" && scene.below() == "events") || (action.name == "Play" && session.playing()) ||
           (action.name == "Edit System File" && scene.shows("editor"));
}

bool is_offered(const Action& action, const PanelState& state) {
    return !state.on_page || (action.flags & on_desktop) == 0;
}

bool is_enabled(const Action& action, const Session& session) { return action.can == nullptr || action.can(session); }

void perform(const Action& action, const Session& session, PanelState& state, Commands& commands) {
    if (action.effect.run != nullptr) return action.effect.run(session, state, commands);
    const Command command = toggled(action, session, state);
    // A step ends the playback where it is now, in a replayed journal, too.
    if (session.playing() && std::holds_alternative<command::StepEvents>(command))
        commands.insert(commands.end(), {Command(command::Pause{}), Command(command::Seek{session.time()})});
    commands.push_back(command);
}

bool takes_key_of(const Action& action, const PanelState& state) {
    const bool may_repeat = (action.flags & held_too) != 0;
    for (std::string_view keys = action.keys; !keys.empty();) {
        const std::size_t comma = std::min(keys.find(", "), keys.size());
        if (takes_chord(chord_of(keys.substr(0, comma)), state, may_repeat)) return true;
        keys.remove_prefix(std::min(comma + 2, keys.size()));
    }
    return false;
}

void use_action_keys(const Session& session, PanelState& state, Commands& commands) {
    const bool types = ImGui::GetIO().WantTextInput, is_owned = types || has_keys(state) || ImGui::IsAnyItemActive();
    for (const Action& action : all_actions) {
        // A dialog that a key has opened in this frame is not drawn yet, and has the next keys.
        if (state.editor.asking != EditorState::OpenDialog::nothing) return;
        const bool is_kept =
            ((action.flags & not_in_text) != 0 && types) || ((action.flags & of_player) != 0 && is_owned);
        if (!is_kept && is_offered(action, state) && is_enabled(action, session) && takes_key_of(action, state))
            perform(action, session, state, commands);
    }
}

void show_menu_entries(std::string_view menu, const Session& session, PanelState& state, Commands& commands) {
    for (const Action& action : all_actions) {
        if (action.menu != menu || !is_offered(action, state)) continue;
        if ((action.flags & new_group) != 0) ImGui::Separator();
        const std::string name(action.name), keys(action.keys.substr(0, action.keys.find(", ")));
        const bool is_submenu = (action.flags & as_submenu) != 0;
        const bool has_entries = action.effect.run != show_recent || !state.recent.empty();
        const bool chosen = is_submenu ? ImGui::BeginMenu(name.c_str(), has_entries)
                                       : ImGui::MenuItem(name.c_str(), keys.c_str(), is_on(action, session),
                                                         is_enabled(action, session));
        remember(state, "menu " + name);
        if (keys.empty()) tooltip(std::string(action.about));
        if (chosen) perform(action, session, state, commands);
        if (chosen && is_submenu) ImGui::EndMenu();
    }
}

const std::vector<Shortcut>& shortcuts() {
    static const std::vector<Shortcut> all = [] {
        std::vector<Shortcut> list;
        for (const Action& action : all_actions) {
            if (action.keys.empty()) continue;
            const std::string keys(action.keys.substr(0, action.keys.find(", ")));
            if (!list.empty() && list.back().does == action.about)
                list.back().keys += ", " + keys;
            else
                list.push_back({"Keys", keys, action.about, (action.flags & on_desktop) != 0});
        }
        list.insert(list.end(), std::begin(gestures), std::end(gestures));
        return list;
    }();
    return all;
}

}  // namespace achilles
