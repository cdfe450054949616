// The text editor of the system. Changes take effect after a pause in typing; errors are shown below the text.
#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "session/replay_script.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr double pause = 0.4;            // s without a keystroke
constexpr float problem_padding = 8.0F;  // around the message, at scale 1
constexpr float gutter_padding = 6.0F;
constexpr const char* text_id = "##text";

// ImGui keeps text as 16-bit characters up to a zero, and is slow with very long texts. Text that it would change is
// shown read-only.
const char* reason_against_editing(const std::string& text) {
    if (text.size() > std::size_t{1} << 20) return "Too long to edit here: more than 1 MB.";
    for (const char c : text)
        if (c == '\0' || static_cast<unsigned char>(c) >= 0xF0)
            return "Cannot be edited here: the text contains characters (emoji, for example) that would be lost.";
    return nullptr;
}

// The first line, from 1, in which two texts differ.
int first_difference(const std::string& a, const std::string& b) {
    const auto at = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
    return 1 + static_cast<int>(std::count(a.begin(), at, '\n'));
}

// Takes over a text that was not typed: opened, new, from a journal, or after undo. Scrolls to the change if it is the
// same document, else to the beginning.
void follow_session(const Session& session, EditorState& editor) {
    const Document& document = session.document();
    const bool is_same = std::exchange(editor.document, document.name) == document.name;
    if (document.text == editor.known) return;
    editor.go_to = is_same ? first_difference(editor.known, document.text) : 0;
    if (!is_same) editor.scroll = 0.0F;
    editor.text = editor.known = document.text;
    editor.resting = 0.0;
    ++editor.revision;  // recreates the widget, whose cursor and undo history belong to the old text
    if (!document.problems.empty()) editor.go_to = document.problems.front().at.line;
}

// Geometry of the text on the screen.
struct TextPage {
    float left, top;      // position of the first letter, including scrolling
    float line, letter;   // height, width
    Rectangle text, all;  // visible text; text with line numbers
    float y(int number) const { return top + static_cast<float>(number - 1) * line; }
};

void paint_line_numbers(const TextPage& page, int lines, const std::vector<InputError>& problems, ImDrawList* list) {
    const int first = std::max(1, static_cast<int>((page.all.y - page.top) / page.line));
    const int last = std::min(lines, static_cast<int>((page.all.y + page.all.height - page.top) / page.line) + 1);
    const float right = page.text.x - units(gutter_padding);
    for (int number = first; number <= last; ++number) {
        // A partly visible line gets no number.
        if (page.y(number) + page.line > page.all.y + page.all.height + 1.0F) continue;
        const bool is_wrong = std::any_of(problems.begin(), problems.end(),
                                          [number](const InputError& problem) { return problem.at.line == number; });
        const std::string text = std::to_string(number);
        const float x = right - page.letter * static_cast<float>(text.size());
        list->AddText({x, page.y(number)}, packed(is_wrong ? error_color() : faint_color()), text.c_str());
    }
}

// A wavy line under the word at the error, and a tinted background from there to the end of the line.
void paint_problem(const TextPage& page, const std::string& text, Location at, ImDrawList* list) {
    if (at.line < 1) return;
    const float top = page.y(at.line), bottom = top + page.line;
    list->AddRectFilled({page.all.x, top}, {page.all.x + page.all.width, bottom}, packed(error_color(), 0.10F));
    if (at.column < 1) return;
    const std::string line = line_of(text, at.line);
    const std::size_t begin = byte_of_column(line, at.column);
    std::size_t end = begin;
    const auto is_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || static_cast<unsigned char>(c) >= 0x80;
    };
    while (end < line.size() && is_word(line[end])) ++end;
    const auto width = [&](std::size_t from, std::size_t to) {
        return ImGui::CalcTextSize(line.data() + from, line.data() + to).x;
    };
    const float left = page.left + width(0, begin);
    const float right = left + std::max(page.letter, width(begin, end));
    const float step = std::max(2.0F, units(2.5F)), y = bottom - units(1.5F);
    list->PushClipRect({page.text.x, page.text.y}, {page.text.x + page.text.width, page.text.y + page.text.height},
                       true);
    std::vector<ImVec2> wave;
    for (float x = left; x < right + 0.5F * step; x += step)
        wave.push_back({x, wave.size() % 2 == 0 ? y : y - units(2.0F)});
    stroke(list, wave, false, packed(error_color()), units(1.5F));
    list->PopClipRect();
}

// The scroll position that makes a line visible: unchanged if it is, else with the line in the upper half.
float scroll_to(int line, const EditorState& editor, float line_height, float height) {
    const float y = static_cast<float>(line - 1) * line_height;
    const bool is_seen = y >= editor.scroll && y + line_height <= editor.scroll + height;
    return is_seen ? editor.scroll : std::max(0.0F, y - std::floor(0.4F * height / line_height - 1.0F) * line_height);
}

// The text widget without a frame, since the page is drawn behind it. Returns true after typing. It handles undo itself
// while the text is valid; otherwise undo belongs to the session.
bool typed(EditorState& editor, ImVec2 size, ImGuiInputTextFlags more) {
    const ImGuiID id = ImGui::GetID(text_id);
    // Hide Escape from ImGui, which would revert all typing since the widget was activated.
    float& escape = time_held(key::escape);
    const float was = std::exchange(escape, ImGui::GetActiveID() == id ? -1.0F : escape);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, 0U);
    ImGui::InputTextMultiline(text_id, &editor.text, size, ImGuiInputTextFlags_AllowTabInput | more);
    ImGui::PopStyleColor();
    escape = was;
    return ImGui::IsItemEdited();
}

// Text, line numbers and error marks in the given height.
void show_text(const Session& session, PanelState& state, float height) {
    EditorState& editor = state.editor;
    push_font(monospace_font());
    ImGui::PushID(editor.revision);
    const int lines = 1 + static_cast<int>(std::count(editor.text.begin(), editor.text.end(), '\n'));
    const float letter = ImGui::CalcTextSize("0").x;
    const float digits = static_cast<float>(std::max<std::size_t>(2, std::to_string(lines).size()));
    const float gutter = std::floor(digits * letter + 2.0F * units(gutter_padding));
    Rectangle all = remaining();
    // Height of whole lines, so that the last one is not cut off before scrolling.
    const float paddings = ImGui::GetStyle().FramePadding.y + units(1.0F), font = ImGui::GetFontSize();
    height = std::max(std::floor((height - paddings) / font), 1.0F) * font + paddings;
    all.height = height;
    const ImVec2 padding = ImGui::GetStyle().FramePadding;
    // Draw the page first, since ImGui draws the scroll bar onto it.
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 low{all.x, all.y}, high{all.x + all.width, all.y + all.height};
    list->AddRectFilled(low, high, packed(session.theme().background), units(4.0F));
    list->AddRectFilled(low, {low.x + gutter - units(1.0F), high.y}, packed(faint_color(), 0.08F));
    ImGui::SetCursorScreenPos({all.x + gutter, all.y});
    ImGuiInputTextFlags more = ImGuiInputTextFlags_None;
    if (reason_against_editing(editor.text) != nullptr) more |= ImGuiInputTextFlags_ReadOnly;
    if (!session.document().problems.empty()) more |= ImGuiInputTextFlags_NoUndoRedo;
    // A recreated widget is a new ImGui window, which would start at the top.
    if (std::exchange(editor.shown_revision, editor.revision) != editor.revision)
        scroll_next_window(editor.scroll, static_cast<float>(lines) * font + 2.0F * ImGui::GetStyle().FramePadding.y);
    if (editor.takes_keys && !is_covered()) editor.takes_keys = false, ImGui::SetKeyboardFocusHere();
    const bool has_typed = typed(editor, {all.width - gutter, height}, more);
    remember(state, "text");
    const bool was_left = ImGui::IsItemDeactivated();
    editor.is_active = ImGui::IsItemActive();
    const ImGuiInputTextState* input = ImGui::GetInputTextState(ImGui::GetID(text_id));
    const float sideways = input != nullptr ? scrolled_sideways(*input) : 0.0F;
    // The widget scrolls in a child window.
    const std::string name =
        fmt::format("{}/{}_{:08X}", ImGui::GetCurrentWindow()->Name, text_id, ImGui::GetID(text_id));
    ImGuiWindow* child = ImGui::FindWindowByName(name.c_str());
    const float line = ImGui::GetFontSize();
    if (child != nullptr && editor.go_to > 0)
        ImGui::SetScrollY(child, scroll_to(std::exchange(editor.go_to, 0), editor, line, height));
    // A message that appears reduces the height: keep the cursor line visible.
    if (child != nullptr && input != nullptr && height < editor.height) {
        const float below = static_cast<float>(line_of_cursor(*input, editor.text)) * line + paddings - height;
        if (child->Scroll.y < below) ImGui::SetScrollY(child, below);
    }
    editor.height = height;
    const float scroll = child != nullptr ? child->Scroll.y : 0.0F;
    editor.scroll = scroll;
    const TextPage page{all.x + gutter + padding.x - sideways,
                        all.y + padding.y - scroll,
                        line,
                        letter,
                        {all.x + gutter, all.y, all.width - gutter, height},
                        all};
    list->PushClipRect(low, {high.x - (child != nullptr ? child->ScrollbarSizes.x : 0.0F), high.y}, true);
    // Errors refer to the text that was parsed, not to later edits.
    const bool is_known = editor.text == session.document().text;
    const std::vector<InputError> none;
    const auto& problems = is_known ? session.document().problems : none;
    for (const InputError& problem : problems) paint_problem(page, editor.text, problem.at, list);
    paint_line_numbers(page, lines, problems, list);
    list->PopClipRect();
    ImGui::PopID();
    ImGui::PopFont();
    editor.resting = has_typed ? 0.0 : editor.resting + double{ImGui::GetIO().DeltaTime};
    if (was_left) editor.resting = pause;
}

void show_problems(const Session& session, EditorState& editor, float height) {
    Rectangle area = remaining();
    area.height = height;
    paint_error_card(area);
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(problem_padding), units(problem_padding)});
    begin_padded_child("problems", {area.width, height});
    const float width = ImGui::GetContentRegionAvail().x;
    for (const InputError& problem : session.document().problems) {
        ImGui::BeginGroup();
        show_message(problem.what(), width);
        ImGui::EndGroup();
        tooltip(fmt::format("click to go to line {}; Ctrl+Z in the text: back to the last version that runs",
                            problem.at.line));
        if (problem.at.line > 0 && ImGui::IsItemClicked()) editor.go_to = problem.at.line;
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

// Height of the messages, at most a third of the panel.
float problems_height(const Session& session, float width, float room) {
    if (session.document().problems.empty()) return 0.0F;
    float height = 2.0F * units(problem_padding);
    for (const InputError& problem : session.document().problems)
        height += message_height(problem.what(), width - 2.0F * units(problem_padding));
    return std::floor(std::min(height, room / 3.0F));
}

void show_buttons(const Session& session, PanelState& state, Commands& commands) {
    constexpr int count = 4;
    const float space = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = std::floor((ImGui::GetContentRegionAvail().x - space * (count - 1)) / count);
    const auto button = [&](const char* name, const char* about) {
        const bool pressed = ImGui::Button(name, {width, 0.0F});
        remember(state, name);
        tooltip(about);
        return pressed;
    };
    if (button("New", "start from a short example (Ctrl+N)")) perform(action("New"), session, state, commands);
    ImGui::SameLine(0.0F, space);
    if (button("Open\u2026", "open a system file (Ctrl+O), or drop one on the window")) ask_to_open(state);
    ImGui::SameLine(0.0F, space);
    if (button("Save", "save to the same file (Ctrl+S)")) save_or_ask(session, state, commands);
    ImGui::SameLine(0.0F, space);
    if (button("Save as\u2026", "save to another file")) ask_to_save(session, state);
}

// In an invalid text: undo returns to the last valid text in one step; redo restores the invalid one.
void use_undo(const Session& session, EditorState& editor, Commands& commands) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!editor.is_active || session.document().problems.empty() || !session.can_undo() || !io.KeyCtrl || io.KeyShift ||
        !is_pressed('Z', false))
        return;
    hand_over_text(editor, commands);
    commands.emplace_back(command::Undo{});
}

// The file name, and whether the text has unsaved changes.
void show_file(const Session& session, const EditorState& editor) {
    const Document& document = session.document();
    const bool is_changed = editor.text != document.saved;
    const std::string status = is_changed ? "not saved" : "";
    const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(status.c_str()).x - units(16.0F);
    const bool is_new = document.file.empty() && document.name == document.source;
    const std::string name = is_new                  ? "a new system, not saved yet"
                             : document.file.empty() ? document.name + ", from the gallery"
                                                     : std::filesystem::path(document.file).filename().string();
    ImGui::TextUnformatted(fitted(name, room).c_str());
    tooltip(document.source);
    if (is_changed) {
        ImGui::SameLine(content_right() - ImGui::CalcTextSize(status.c_str()).x);
        ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
        ImGui::TextUnformatted(status.c_str());
        ImGui::PopStyleColor();
    }
}

// Values of the text that do not hold in the run because sliders or options changed them.
void show_run(const Session& session, PanelState& state, Commands& commands) {
    constexpr std::size_t lines = 4;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, units(3.0F)});
    show_changes(session, "text", lines, state, commands);
    const std::size_t all = differences(session.description(), session.run(), session.file_run()).size();
    if (all > lines) {
        const Rectangle row = remaining();
        if (ImGui::InvisibleButton("reset all", {std::max(row.width, 1.0F), ImGui::GetTextLineHeight()}))
            commands.emplace_back(command::Reset{});
        remember(state, "reset all");
        tooltip("reset every value to that of the text");
        cell({row.x, row.y}, fmt::format("and {} more: reset all", all - lines), row.width, current_theme().accent);
    }
    ImGui::PopStyleVar();
    if (all > 0) ImGui::Dummy({0.0F, units(1.0F)});
}

}  // namespace

bool is_typing(const PanelState& state) { return state.editor.text != state.editor.known; }

void hand_over_text(EditorState& editor, Commands& commands) {
    if (editor.text == editor.known) return;
    editor.known = editor.text;
    commands.emplace_back(command::SetText{editor.text});
}

void toggle_editor(const Session& session, PanelState& state, Commands& commands) {
    hand_over_text(state.editor, commands);
    state.editor.takes_keys = !session.shows_editor();
    commands.emplace_back(command::Show{"editor", !session.shows_editor()});
}

void show_editor(const Session& session, PanelState& state, Commands& commands) {
    EditorState& editor = state.editor;
    follow_session(session, editor);
    show_buttons(session, state, commands);
    show_file(session, editor);
    show_run(session, state, commands);
    const Rectangle room = remaining();
    const float below = problems_height(session, room.width, room.height);
    const char* against = reason_against_editing(editor.text);
    const float note = against == nullptr ? 0.0F : 2.0F * ImGui::GetTextLineHeightWithSpacing();
    const float space = ImGui::GetStyle().ItemSpacing.y;
    show_text(session, state, std::max(1.0F, room.height - (below > 0.0F ? below + space : 0.0F) - note));
    if (against != nullptr) {
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextDisabled("%s", against);
        ImGui::PopTextWrapPos();
    }
    if (below > 0.0F) {
        ImGui::SetCursorScreenPos({room.x, room.y + room.height - below});
        show_problems(session, editor, below);
    }
    if (editor.resting >= pause) hand_over_text(editor, commands);
    use_undo(session, editor, commands);
}

}  // namespace achilles
