// The Help menu, the manual, and the card of keys and terms (F1).
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "figure/label.hpp"
#include "paint/paint.hpp"
#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "session/glossary.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

// ---- the card, while the scene shows "help" ----

namespace {

constexpr const char* help_title = "Keys and words";
constexpr float keys_width = 340.0F, keys_column = 142.0F, word_column = 158.0F, narrow_indent = 16.0F,
                narrow_words = 380.0F, widest_help = 1240.0F, highest_help = 1500.0F;

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
        text.replace(at, what.size(), with);
    return text;
}

void heading(const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::Dummy({0.0F, units(2.0F)});
}

// The keys that the window has: a page lacks some.
std::vector<Shortcut> shown_keys(const PanelState& state) {
    std::vector<Shortcut> keys;
    for (const Shortcut& shortcut : shortcuts())
        if (!shortcut.is_for_desktop || !state.on_page) keys.push_back(shortcut);
    return keys;
}

void show_keys(std::span<const Shortcut> all) {
    std::string_view group;
    for (const Shortcut& shortcut : all) {
        if (shortcut.group != group) {
            if (!group.empty()) ImGui::Dummy({0.0F, units(6.0F)});
            group = shortcut.group;
            heading(std::string(group).c_str());
        }
        const float left = ImGui::GetCursorPosX();
        ImGui::TextUnformatted(shortcut.keys.data(), shortcut.keys.data() + shortcut.keys.size());
        ImGui::SameLine(left + units(keys_column));
        paragraph(std::string(shortcut.does), ImGui::GetContentRegionAvail().x, text_color());
    }
}

// Replaces ">=" and "<=" by single signs.
std::string formula_label(std::string_view formula) {
    return replaced(replaced(typeset(formula), ">=", "\u2265"), "<=", "\u2264");
}

// Whether there is room for every formula beside the words.
bool has_word_column() {
    float widest = 0.0F;
    for (const GlossaryTerm& term : glossary())
        widest = std::max(widest, label_width(formula_label(term.formula), ImGui::GetFontSize()));
    return units(word_column) + widest <= ImGui::GetContentRegionAvail().x;
}

// A term with its formula, its meaning and its source: beside the word or, in a narrow card, below it. The source is at
// the right end of the first line or, without room, below.
void show_term(const GlossaryTerm& term, bool is_beside) {
    const float size = ImGui::GetFontSize();
    const float column = ImGui::GetCursorPosX() + units(is_beside ? word_column : narrow_indent);
    const std::string formula = formula_label(term.formula), source(term.source);
    ImGui::TextUnformatted(term.word.data(), term.word.data() + term.word.size());
    if (is_beside) ImGui::SameLine();
    ImGui::SetCursorPosX(column);
    const Rectangle beside = remaining();
    const float space = units(16.0F), source_width = ImGui::CalcTextSize(source.c_str()).x;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool fits = formula.empty() || label_width(formula, size) + space + source_width <= beside.width;
    if (fits)
        list->AddText({std::floor(beside.x + beside.width - source_width), beside.y}, packed(faint_color()),
                      source.c_str());
    if (!formula.empty()) {
        paint_label(list, beside.x, beside.y, formula, text_color(), size);
        ImGui::Dummy({beside.width, ImGui::GetTextLineHeight()});
        ImGui::SetCursorPosX(column);
    }
    paragraph(std::string(term.meaning), beside.width - (formula.empty() ? source_width + space : 0.0F), text_color());
    if (!fits) {
        ImGui::SetCursorPosX(column);
        paragraph(source, beside.width, faint_color());
    }
    ImGui::Dummy({0.0F, units(3.0F)});
}

void show_words() {
    heading("Words");
    const bool is_beside = has_word_column();
    for (const GlossaryTerm& term : glossary()) show_term(term, is_beside);
}

// A scrollable part of the card.
template <class Content>
void column(const char* name, const ImVec2& size, const Content& content) {
    ImGui::BeginChild(name, size);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, units(3.0F)});
    content();
    ImGui::PopStyleVar();
    ImGui::EndChild();
}

}  // namespace

void show_help(const Session& session, PanelState& state, Commands& commands) {
    const bool shown = session.scene().shows("help");
    if (shown && !is_covered()) ImGui::OpenPopup(help_title);
    const ImVec2 all = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({std::floor(0.5F * all.x), std::floor(0.5F * all.y)}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize(
        {std::min(units(widest_help), all.x - units(48.0F)), std::min(units(highest_help), all.y - units(48.0F))});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(18.0F), units(14.0F)});
    const bool open = ImGui::BeginPopupModal(help_title, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
    ImGui::PopStyleVar();
    if (!open) return;
    if (!shown) ImGui::CloseCurrentPopup();
    const float height = ImGui::GetContentRegionAvail().y - ImGui::GetFrameHeightWithSpacing();
    // In a low window the keys have a second column.
    const std::vector<Shortcut> visible = shown_keys(state);
    const std::span<const Shortcut> keys(visible);
    const float space = units(24.0F), line = ImGui::GetTextLineHeight() + units(3.0F);
    const bool is_low =
        static_cast<float>(keys.size() + 8) * line > height &&
        ImGui::GetContentRegionAvail().x >= 2.0F * units(keys_width) + units(narrow_words) + 2.0F * space;
    const auto first = std::min(keys.size(), static_cast<std::size_t>(std::max(1.0F, height / line - 2.0F)));
    column("keys", {units(keys_width), height}, [&] { show_keys(is_low ? keys.first(first) : keys); });
    ImGui::SameLine(0.0F, space);
    if (is_low) {
        column("more keys", {units(keys_width), height}, [&] { show_keys(keys.subspan(first)); });
        ImGui::SameLine(0.0F, space);
    }
    column("words", {0.0F, height}, show_words);
    const bool is_closed = takes_key(state, key::escape, false) || takes_key_of(action("Keys and words"), state);
    if (ImGui::Button("Close", {units(96.0F), 0.0F}) || is_closed) commands.emplace_back(command::Show{"help", false});
    remember(state, "Close the help");
    if (takes_key_of(action("Find\u2026"), state)) commands.emplace_back(command::Show{"palette", true});
    ImGui::EndPopup();
}

// ---- the menu, and the window with a page of the manual ----

namespace {

constexpr const char* manual_title = "Manual";

void show_page(PanelState& state) {
    const Rectangle all{0.0F, 0.0F, ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
    const float margin = units(40.0F);
    ImGui::SetNextWindowPos({margin, margin});
    ImGui::SetNextWindowSize({all.width - 2.0F * margin, all.height - 2.0F * margin});
    if (!ImGui::BeginPopupModal(manual_title, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) return;
    const float button_row = ImGui::GetFrameHeightWithSpacing();
    // Tables need a monospace font.
    ImGui::BeginChild("page", {0.0F, -button_row}, false, ImGuiWindowFlags_HorizontalScrollbar);
    push_font(monospace_font());
    ImGui::TextUnformatted(state.manual_text.data(), state.manual_text.data() + state.manual_text.size());
    ImGui::PopFont();
    ImGui::EndChild();
    const bool escape = takes_key(state, key::escape, false);
    if (ImGui::Button("Close") || escape) ImGui::CloseCurrentPopup();
    remember(state, "Close the manual");
    ImGui::EndPopup();
}

}  // namespace

void show_help_items(PanelState& state) {
    ImGui::Separator();
    // Shown even without pages, so that a picture does not depend on the location of the assets.
    if (state.manual.empty()) ImGui::MenuItem("The manual is missing", nullptr, false, false);
    for (const SystemEntry& page : state.manual) {
        const bool chosen = ImGui::MenuItem(page.title.c_str());
        remember(state, "menu " + page.name);
        if (chosen) open_manual(state, page.name);
    }
}

void open_manual(PanelState& state, const std::string& page) {
    state.manual_text = state.manual_page(page);
    state.opens_manual = true;
}

void show_manual(PanelState& state) {
    if (std::exchange(state.opens_manual, false)) ImGui::OpenPopup(manual_title);
    show_page(state);
}

}  // namespace achilles
