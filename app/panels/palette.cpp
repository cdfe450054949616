// The command palette (Ctrl+Shift+P), which finds commands by a few letters, while the scene shows it.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "panels/widgets.hpp"
#include "session/command_search.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr const char* palette_title = "Command";
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
        (session.scene().shows(thing) ? hide : show).values.emplace_back(thing, "");
    return {std::move(open), std::move(replay), std::move(set), std::move(show), std::move(hide)};
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

// Chooses a row of the list: executes it, or completes the line with it.
void take(const CommandMatch& found, const Session& session, PanelState& state, Commands& commands) {
    if (found.runs) {
        write_line(state.palette, found.line);
        run(found.line, session, state, commands);
    } else {
        write_line(state.palette, found.line);
    }
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
    const bool entered = ImGui::InputTextWithHint("##command", "a command, or a few letters of it", &palette.text,
                                                  flags, put_cursor, &palette);
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
        // The name is brighter than the rest.
        const std::string name = row.usage.substr(0, row.usage.find(' '));
        const float name_width = ImGui::CalcTextSize((name + " ").c_str()).x;
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddText(at, packed(text_color()), name.c_str());
        if (name.size() < row.usage.size())
            list->AddText({at.x + name_width, at.y}, packed(faint_color()),
                          fitted(row.usage.substr(name.size() + 1), width - name_width).c_str());
    }
    return clicked;
}

// The error of the last command. Otherwise the usage of the current one, if the list does not show it, and the effect
// of Enter.
void show_answer(const std::vector<CommandMatch>& found, const PaletteState& palette) {
    const float width = ImGui::GetContentRegionAvail().x;
    if (!palette.wrong.empty()) return show_message(palette.wrong, width);
    if (found.empty()) {
        const std::string usage = usage_of(palette.text);
        return paragraph(usage.empty() ? "no matching command" : usage, width, faint_color());
    }
    const CommandMatch& chosen = found[static_cast<std::size_t>(palette.chosen)];
    if (ImGui::CalcTextSize(chosen.usage.c_str()).x > width) paragraph(chosen.usage, width, faint_color());
    paragraph(chosen.runs ? "Enter runs it" : "Enter or Tab completes it", width, faint_color());
}

// Also works on the card of keys and in the gallery, which the palette replaces.
bool is_shortcut(const PanelState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool is_card = ImGui::IsPopupOpen("Keys and words") || ImGui::IsPopupOpen("Gallery");
    return io.KeyCtrl && io.KeyShift && is_pressed('P', false) && (is_card || is_in_front(state));
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
    const std::vector<CommandMatch> found = find_commands(palette.text, completions(session, state));
    choose(state, static_cast<int>(found.size()));
    const int clicked = show_rows(found, state);
    ImGui::Separator();
    show_answer(found, palette);
    const bool completes = std::exchange(palette.completes, false) && !found.empty();
    if (clicked >= 0)
        take(found[static_cast<std::size_t>(clicked)], session, state, commands);
    else if (completes)
        write_line(palette, found[static_cast<std::size_t>(palette.chosen)].line);
    else if (entered && !found.empty())
        take(found[static_cast<std::size_t>(palette.chosen)], session, state, commands);
    else if (entered)
        run(palette.text, session, state, commands);
    else if (takes_key(state, key::escape, false) || is_shortcut(state))
        commands.emplace_back(command::Show{"palette", false});
}

}  // namespace

void show_palette(const Session& session, PanelState& state, Commands& commands) {
    const bool shown = session.scene().shows("palette");
    const ImGuiIO& io = ImGui::GetIO();
    if (!shown && is_shortcut(state)) commands.emplace_back(command::Show{"palette", true});
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
