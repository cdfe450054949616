// The palette (Ctrl+Shift+P), which finds actions, systems, values, plots, pages and commands by a few letters, while
// the scene shows it.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "session/command_search.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr const char* palette_title = "Find";
constexpr float wide = 620.0F;
constexpr int max_rows = 10;

std::vector<std::pair<std::string, std::string>> names_of(const std::vector<SystemEntry>& entries) {
    std::vector<std::pair<std::string, std::string>> names;
    for (const SystemEntry& entry : entries) names.emplace_back(entry.name, entry.title);
    return names;
}

// Possible arguments of commands in this session.
std::vector<Completions> completions(const Session& session, const PanelState& state) {
    Completions open{"open", names_of(state.systems)}, replay{"replay", names_of(state.tours)};
    Completions set{"set", {}, false}, show{"show", {}}, hide{"hide", {}};
    for (const ParameterDescription& parameter : session.description().parameters)
        set.values.emplace_back(parameter.name, parameter.about);
    for (const CoordinateDescription& coordinate : session.description().coordinates)
        for (const char* prime : {"", "'"}) set.values.emplace_back(coordinate.name + prime, "");
    for (const std::string& thing : command::shown_things)
        (session.scene().shows(thing) && thing != "mechanism" ? hide : show).values.emplace_back(thing, "");
    return {std::move(open), std::move(replay), std::move(set), std::move(show), std::move(hide)};
}

// "ball_on_sine" is also found as "ball on sine".
std::string spaced(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

// "Save as" for "Save as\u2026".
std::string plain_name(const Action& action) {
    const std::string name(action.name);
    return name.substr(0, name.find("\u2026"));
}

// "e = 0.3" sets e; "e" alone is completed to "e = ".
void add_values(const std::string& typed, const Session& session, std::vector<NamedEntry>& entries) {
    const SystemDescription& system = session.description();
    const std::size_t equals = typed.find('=');
    const auto trimmed = [](std::string text) {
        text.erase(0, text.find_first_not_of(' '));
        return text.erase(text.find_last_not_of(' ') + 1);
    };
    const std::string name = trimmed(typed.substr(0, equals));
    const std::string value = equals == std::string::npos ? "" : trimmed(typed.substr(equals + 1));
    for (const std::string& known : settable_names(system)) {
        const auto parameter = std::find_if(system.parameters.begin(), system.parameters.end(),
                                            [&](const ParameterDescription& one) { return one.name == known; });
        const std::string about = parameter == system.parameters.end() ? "start of the run" : parameter->about;
        if (!value.empty() && name == known) {
            const std::string line = fmt::format("set {} {}", known, value);
            entries.insert(entries.begin(), {typed, "", line, line});
        } else if (value.empty()) {
            entries.push_back({fmt::format("{} = {:.6g}", known, *session.value(known)), about,
                               "set " + known + " VALUE", known + " = ", false});
        }
    }
}

// "play e from 0.2 to 0.9" animates e.
void add_animation(const std::string& typed, const Session& session, std::vector<NamedEntry>& entries) {
    std::istringstream words(typed);
    std::string play, name, from, to, first, last;
    if (!(words >> play >> name >> from >> first >> to >> last) || play != "play" || from != "from" || to != "to")
        return;
    if (!session.value(name)) return;
    const std::string line = fmt::format("animate {} {} {}", name, first, last);
    entries.insert(entries.begin(), {typed, "", line, line});
}

// What is found by words, in this order: actions, values, systems, tours, plots, pages. The first `actions().size()`
// entries are the actions, the last ones the pages.
std::vector<NamedEntry> named_entries(const std::string& typed, const Session& session, const PanelState& state) {
    std::vector<NamedEntry> entries;
    for (const Action& action : actions())
        if (is_offered(action, state) && is_enabled(action, session) && (action.flags & Action::submenu) == 0)
            entries.push_back({plain_name(action), std::string(action.about),
                               action.keys.empty() ? std::string(action.effect.command) : std::string(action.keys),
                               "action " + std::string(action.name)});
    add_values(typed, session, entries);
    add_animation(typed, session, entries);
    for (const SystemEntry& system : state.systems)
        entries.push_back({system.title, spaced(system.name), "open " + system.name, "open " + system.name});
    for (const SystemEntry& tour : state.tours)
        entries.push_back({tour.title, "tour " + spaced(tour.name), "replay " + tour.name, "replay " + tour.name});
    for (const ViewDescription& view : session.plotted().choices()) {
        command::PlotView plot{1, view.x.text, {}};
        for (const Text& y : view.y) plot.y.push_back(y.text);
        entries.push_back({"Plot: " + view.name, "curve over " + view.x.text, to_text(plot), to_text(plot)});
    }
    for (const SystemEntry& page : state.manual)
        entries.push_back({"Manual: " + page.title, "help " + page.name, "help " + page.name, "page " + page.name});
    return entries;
}

// ImGui callback, the only way to change the field while it is active: puts the cursor at the end of a completed line.
int put_cursor(ImGuiInputTextCallbackData* data) {
    auto& palette = *static_cast<PaletteState*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) palette.completes = true;
    if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways && std::exchange(palette.to_end, false)) {
        data->CursorPos = data->BufTextLen;
        data->SelectionStart = data->SelectionEnd = data->CursorPos;
    }
    return 0;
}

// Gives the field the keyboard again, with this line.
void write_line(PaletteState& palette, const std::string& line) {
    palette.text = line;
    palette.chosen = 0;
    palette.wrong.clear();
    ++palette.revision;
    palette.focuses = palette.to_end = true;
}

void run(const std::string& line, const Session& session, PanelState& state, Commands& commands) {
    PaletteState& palette = state.palette;
    try {
        const Command command = parse_command(line, "command");
        const bool replaces =
            std::holds_alternative<command::Open>(command) || std::holds_alternative<command::New>(command);
        // Close the palette first, so that the question about unsaved changes is in front.
        if (replaces && (session.document().is_changed() || is_typing(state))) {
            commands.emplace_back(command::Show{"palette", false});
            return request(session, state, command, commands);
        }
        commands.push_back(command);
        palette.has_run = true;
    } catch (const InputError& problem) {
        palette.wrong = problem.what();
    }
    palette.focuses = palette.to_end = true;
}

// Chooses a row of the list: does it, or completes the line with it.
void take(const CommandMatch& found, const Session& session, PanelState& state, Commands& commands) {
    constexpr std::string_view act = "action ", page = "page ";
    const auto close = [&] { commands.emplace_back(command::Show{"palette", false}); };
    if (found.entry >= 0 && found.line.starts_with(act)) {
        close();
        return perform(action(found.line.substr(act.size())), session, state, commands);
    }
    if (found.entry >= 0 && found.line.starts_with(page)) {
        close();
        return open_manual(state, found.line.substr(page.size()));
    }
    write_line(state.palette, found.line);
    if (found.runs) run(found.line, session, state, commands);
}

void choose(PanelState& state, int count) {
    PaletteState& palette = state.palette;
    if (takes_key(state, key::down)) ++palette.chosen;
    if (takes_key(state, key::up)) --palette.chosen;
    if (takes_key(state, key::page_down)) palette.chosen = std::min(palette.chosen + max_rows, count - 1);
    if (takes_key(state, key::page_up)) palette.chosen = std::max(palette.chosen - max_rows, 0);
    if (count > 0) palette.chosen = (palette.chosen + count) % count;
}

// Returns true if Enter was pressed.
bool show_line(PanelState& state) {
    PaletteState& palette = state.palette;
    if (ImGui::IsWindowAppearing() || std::exchange(palette.focuses, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0F);
    constexpr ImGuiInputTextFlags flags = ImGuiInputTextFlags_EnterReturnsTrue |
                                          ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackAlways;
    ImGui::PushID(palette.revision);
    const bool entered =
        ImGui::InputTextWithHint("##command", "words of a menu, a system, a value (e = 0.3), a plot, a page, a command",
                                 &palette.text, flags, put_cursor, &palette);
    if (ImGui::IsItemEdited()) {
        palette.chosen = 0;
        palette.wrong.clear();
    }
    ImGui::PopID();
    remember(state, "command");
    return entered;
}

// Returns the row that was clicked; -1: none.
int show_rows(const std::vector<CommandMatch>& found, PanelState& state) {
    PaletteState& palette = state.palette;
    int clicked = -1;
    const int count = static_cast<int>(found.size()), first = std::clamp(palette.chosen - max_rows + 1, 0, count);
    for (int i = first; i < std::min(count, first + max_rows); ++i) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        ImGui::PushID(i);
        if (ImGui::Selectable("##row", i == palette.chosen, ImGuiSelectableFlags_DontClosePopups)) clicked = i;
        ImGui::PopID();
        const CommandMatch& row = found[static_cast<std::size_t>(i)];
        remember(state, "command " + row.line);
        // What it is at the left; the command or key that does the same, fainter, at the right.
        const std::string label = row.label.empty() ? row.usage.substr(0, row.usage.find(' ')) : row.label;
        const std::string syntax = row.label.empty() || row.label != row.usage ? row.usage : "";
        const float half = std::min(0.6F * width, width_of(label));
        cell(at, label, half + 1.0F, text_color());
        const float room = width - half - units(24.0F), syntax_width = std::min(width_of(syntax), room);
        cell({std::floor(at.x + width - syntax_width), at.y}, syntax, syntax_width + 1.0F, faint_color());
    }
    return clicked;
}

// The error of the last command. Otherwise the usage of the current one, if the list does not show it, and the effect
// of Enter.
void show_answer(const std::vector<CommandMatch>& found, const PaletteState& palette) {
    const float width = ImGui::GetContentRegionAvail().x;
    if (!palette.wrong.empty()) return show_message(palette.wrong, width);
    const std::string usage = usage_of(palette.text);
    if (found.empty() && !usage.empty()) return paragraph(usage, width, faint_color());
    if (found.empty())
        return paragraph(
            "Nothing found. Type words of a menu (energy), a system (ball on sine), a value (e = 0.3), a plot, a page "
            "of the manual, or a command (seek 3.2).",
            width, faint_color());
    const CommandMatch& chosen = found[static_cast<std::size_t>(palette.chosen)];
    if (ImGui::CalcTextSize(chosen.usage.c_str()).x > 0.6F * width) paragraph(chosen.usage, width, faint_color());
    paragraph(chosen.runs ? "Enter runs it" : "Enter or Tab completes it", width, faint_color());
}

void show_content(const Session& session, PanelState& state, Commands& commands) {
    PaletteState& palette = state.palette;
    if (ImGui::IsWindowAppearing()) {
        const int revision = palette.revision + 1;
        palette = {};
        palette.text = session.scene().finds();
        palette.revision = revision;
        palette.to_end = true;
    }
    // The command has been executed by now: show its error, or close the palette.
    if (std::exchange(palette.has_run, false)) {
        palette.wrong = session.error();
        if (palette.wrong.empty()) commands.emplace_back(command::Show{"palette", false});
    }
    const bool entered = show_line(state);
    const std::vector<CommandMatch> found =
        find_anything(palette.text, named_entries(palette.text, session, state), completions(session, state));
    choose(state, static_cast<int>(found.size()));
    const int clicked = show_rows(found, state);
    ImGui::Separator();
    show_answer(found, palette);
    const bool completes = std::exchange(palette.completes, false) && !found.empty();
    if (clicked >= 0)
        take(found[static_cast<std::size_t>(clicked)], session, state, commands);
    else if (completes && found[static_cast<std::size_t>(palette.chosen)].entry < 0)
        write_line(palette, found[static_cast<std::size_t>(palette.chosen)].line);
    else if (completes || (entered && !found.empty()))
        take(found[static_cast<std::size_t>(palette.chosen)], session, state, commands);
    else if (entered)
        run(palette.text, session, state, commands);
    else if (takes_key(state, key::escape, false) || takes_key_of(action("Find\u2026"), state))
        commands.emplace_back(command::Show{"palette", false});
}

}  // namespace

void show_palette(const Session& session, PanelState& state, Commands& commands) {
    const bool shown = session.scene().shows("palette");
    const ImGuiIO& io = ImGui::GetIO();
    if (shown && !is_covered()) ImGui::OpenPopup(palette_title);
    const float width = std::min(units(wide), io.DisplaySize.x - units(24.0F));
    ImGui::SetNextWindowPos({std::floor(0.5F * (io.DisplaySize.x - width)), std::floor(0.1F * io.DisplaySize.y)});
    ImGui::SetNextWindowSize({width, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(12.0F), units(12.0F)});
    constexpr ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove;
    const bool open = ImGui::BeginPopupModal(palette_title, nullptr, flags);
    ImGui::PopStyleVar();
    if (!open) return;
    if (shown)
        show_content(session, state, commands);
    else
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace achilles
