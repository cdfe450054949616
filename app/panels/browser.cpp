#include "panels/browser.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr int shown_rows = 8;
constexpr double reread_seconds = 1.0;

void use(BrowserState& browser, std::string line) {
    browser.line = std::move(line);
    browser.rewrites = browser.focuses = true;
    browser.chosen = -1;
}

// Key handling of the field: Tab completes; Backspace after a slash goes up a folder. ImGui owns the text while
// editing.
int take_field_keys(ImGuiInputTextCallbackData* data) {
    auto& browser = *static_cast<BrowserState*>(data->UserData);
    const std::string text(data->Buf, static_cast<std::size_t>(data->BufTextLen));
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
        const std::string more = completed(text, browser.all);
        browser.tab = more == text;
        if (more != text) use(browser, more);
    }
    if (data->EventFlag == ImGuiInputTextFlags_CallbackEdit) {
        browser.chosen = -1;
        const std::string before = browser.folder + browser.letters;
        if (before.ends_with('/') && text + "/" == before) use(browser, one_up(before));
    }
    if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways && browser.rewrites) {
        data->DeleteChars(0, data->BufTextLen);
        data->InsertChars(0, browser.line.c_str());
        data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
        browser.rewrites = browser.focuses = browser.selects = false;
    }
    if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways && std::exchange(browser.selects, false))
        data->SelectAll();
    return 0;
}

// Updates the rows for the path in the field. Rereads the folder at intervals, since other programs may change it.
void list(BrowserState& browser, const std::string& path, const std::vector<std::string>& endings) {
    const PathParts parts = parts_of(path);
    const bool is_hidden = parts.name.starts_with('.'), is_late = ImGui::GetTime() - browser.read_at > reread_seconds;
    if (browser.read_at < 0.0 || is_late || browser.folder != parts.folder || browser.is_hidden != is_hidden ||
        browser.endings != endings) {
        browser.all = entries_of(expanded(parts.folder), endings, is_hidden);
        browser.read_at = ImGui::GetTime();
    }
    browser.folder = parts.folder;
    browser.letters = parts.name;
    browser.endings = endings;
    browser.is_hidden = is_hidden;
    // The name of an existing entry, or a proposed one, does not filter the list.
    const bool is_whole = std::any_of(browser.all.begin(), browser.all.end(),
                                      [&](const FolderEntry& entry) { return entry.name == parts.name; });
    browser.rows = is_whole || path == browser.line ? browser.all : filtered(browser.all, parts.name);
    browser.chosen = std::min(browser.chosen, static_cast<int>(browser.rows.size()) - 1);
}

// Arrow keys select a row. If no control of the dialog has the keys, letters return to the field.
void choose(PanelState& state) {
    BrowserState& browser = state.browser;
    const int count = static_cast<int>(browser.rows.size()), before = browser.chosen;
    const bool is_free = !has_keys(state) && !ImGui::GetIO().WantTextInput;
    if (count == 0 || !(state.browser_has_field || is_free)) return;
    if (takes_key(state, key::down)) browser.chosen = std::min(browser.chosen + 1, count - 1);
    if (takes_key(state, key::up)) browser.chosen = std::max(browser.chosen - 1, -1);
    if (takes_key(state, key::page_down)) browser.chosen = std::min(browser.chosen + shown_rows, count - 1);
    if (takes_key(state, key::page_up)) browser.chosen = std::max(browser.chosen - shown_rows, 0);
    if (browser.chosen == before) return;
    browser.scrolls = true;
    browser.focuses = !state.browser_has_field;
}

// Returns the row that was clicked; -1: none.
int show_rows(BrowserState& browser, PanelState& state) {
    int clicked = -1;
    const float height = static_cast<float>(shown_rows) * ImGui::GetTextLineHeightWithSpacing() + units(8.0F);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, ImGui::GetColorU32(ImGuiCol_FrameBg));
    begin_padded_child("folder", {0.0F, height});
    if (browser.rows.empty()) ImGui::TextDisabled("nothing here to choose");
    for (int i = 0; i < static_cast<int>(browser.rows.size()); ++i) {
        const FolderEntry& entry = browser.rows[static_cast<std::size_t>(i)];
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::PushID(i);
        if (ImGui::Selectable("##row", i == browser.chosen, ImGuiSelectableFlags_DontClosePopups)) clicked = i;
        ImGui::PopID();
        if (ImGui::IsItemVisible()) {
            remember(state, "file " + entry.name);
            const std::string name = entry.name + (entry.is_folder ? "/" : "");
            ImGui::GetWindowDrawList()->AddText(at, packed(entry.is_folder ? text_color() : faint_color()),
                                                fitted(name, ImGui::GetContentRegionAvail().x).c_str());
        }
        if (i == browser.chosen && browser.scrolls) ImGui::SetScrollHereY(0.5F);
    }
    browser.scrolls = false;
    ImGui::EndChild();
    ImGui::PopStyleColor();
    return clicked;
}

}  // namespace

bool path_line(PanelState& state, bool focuses) {
    BrowserState& browser = state.browser;
    std::string& path = state.editor.path;
    if (ImGui::IsWindowAppearing()) {
        browser.line = path;  // the proposed path
        browser.selects = true;
        browser.rewrites = false;
        browser.chosen = -1;  // selected in another dialog
    }
    if (focuses || browser.focuses) ImGui::SetKeyboardFocusHere();
    // Without the keyboard, the field's text can be set here; when it gets the keyboard, the cursor goes to the end.
    if (browser.rewrites && !state.browser_has_field) path = browser.line;
    browser.focuses = browser.tab = false;
    ImGui::SetNextItemWidth(-1.0F);
    constexpr ImGuiInputTextFlags flags = ImGuiInputTextFlags_EnterReturnsTrue |
                                          ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackEdit |
                                          ImGuiInputTextFlags_CallbackAlways;
    const bool entered = ImGui::InputText("##path", &path, flags, take_field_keys, &browser);
    state.browser_has_field = ImGui::IsItemActive();
    remember(state, "path");
    return entered;
}

BrowseResult browse(PanelState& state, const std::vector<std::string>& endings, bool entered) {
    BrowserState& browser = state.browser;
    const std::string& path = state.editor.path;
    if (!state.reads_folders) return {};
    list(browser, path, endings);
    choose(state);
    const int clicked = show_rows(browser, state), taken = clicked >= 0 ? clicked : entered ? browser.chosen : -1;
    std::error_code ignored;
    if (taken < 0) {
        const bool is_folder =
            entered && !path.empty() && !path.ends_with('/') && fs::is_directory(expanded(path), ignored);
        if (is_folder) use(browser, path + "/");
        return {is_folder, false};
    }
    const FolderEntry entry = browser.rows[static_cast<std::size_t>(taken)];
    use(browser, with_entry(path, entry));
    if (!state.browser_has_field) state.editor.path = browser.line;
    return {true, !entry.is_folder && (entered || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))};
}

}  // namespace achilles
