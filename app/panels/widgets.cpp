#include "panels/widgets.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "figure/label.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "session/event_text.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

Figure screen_style(const Theme& theme) {
    Figure style;
    style.background = theme.background;
    style.ink = theme.ink;
    style.grid = theme.grid;
    style.text_size = screen_text_size;
    return style;
}

void paragraph(const std::string& text, float width, const Color& color) {
    ImGui::PushStyleColor(ImGuiCol_Text, packed(color));
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

float units(float pixels) { return pixels * ImGui::GetFontSize() / 15.0F; }

ImU32 packed(const Color& color, float alpha) {
    return IM_COL32(color.r, color.g, color.b, static_cast<int>(std::lround(static_cast<float>(color.a) * alpha)));
}

Color text_color() { return current_theme().ink; }
Color faint_color() { return current_theme().faint; }
Color error_color() { return current_theme().error; }

std::string fitted(const std::string& text, float width) {
    const float size = ImGui::GetFontSize();
    return shortened(
        text, [&](const std::string& part) { return label_width(part, size) <= width; }, EllipsisMode::letters);
}

void cell(const ImVec2& at, const std::string& name, const std::string& value, float width, const Color& color) {
    const float size = ImGui::GetFontSize();
    const std::string whole = name + value;
    const bool is_cut = label_width(whole, size) > width;
    const float room = std::max(width - label_width(value, size), label_width("m\u2026", size));
    paint_label(ImGui::GetWindowDrawList(), at.x, at.y, is_cut ? fitted(fitted(name, room) + value, width) : whole,
                color, size);
    if (!is_cut) return;
    const ImVec2 before = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(at);
    ImGui::Dummy({width, ImGui::GetTextLineHeight()});
    tooltip(whole);
    ImGui::SetCursorScreenPos(before);
}

void cell(const ImVec2& at, const std::string& text, float width, const Color& color) {
    cell(at, text, "", width, color);
}

float width_of(const std::string& text) { return label_width(text, ImGui::GetFontSize()); }

LineTable::LineTable(const char* name, const std::vector<float>& widths) {
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {0.0F, 0.0F});
    is_open_ = ImGui::BeginTable(
        name, static_cast<int>(widths.size()),
        ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX | ImGuiTableFlags_NoSavedSettings);
    for (std::size_t i = 0; is_open_ && i < widths.size(); ++i)
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, widths[i]);
}

LineTable::~LineTable() {
    if (is_open_) ImGui::EndTable();
    // The rows have their spacing below them.
    if (is_open_) ImGui::SetCursorPosY(ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y);
    ImGui::PopStyleVar();
}

void LineTable::next_row() const {
    if (is_open_) ImGui::TableNextRow(ImGuiTableRowFlags_None, ImGui::GetTextLineHeightWithSpacing());
}

ImVec2 LineTable::put(const std::string& text, const Color& color, float sign) const {
    if (is_open_) ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (is_open_) cell({at.x + sign, at.y}, text, ImGui::GetContentRegionAvail().x - sign - units(6.0F), color);
    return at;
}

void label(const std::string& text, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({width, ImGui::GetFrameHeight()});
    paint_label(ImGui::GetWindowDrawList(), at.x, at.y + ImGui::GetStyle().FramePadding.y,
                fitted(text, width - units(4.0F)), text_color(), ImGui::GetFontSize());
}

void section(const char* title, float free) {
    ImGui::Dummy({0.0F, units(4.0F)});
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(title);
    ImGui::PopStyleColor();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float y = std::floor(0.5F * (low.y + high.y) + units(1.0F));
    const float right = ImGui::GetWindowPos().x + content_right() - free;
    ImGui::GetWindowDrawList()->AddLine({high.x + units(8.0F), y}, {right, y}, ImGui::GetColorU32(ImGuiCol_Border));
}

namespace {

// Most tooltips are one line; longer ones are wrapped.
float tooltip_width() { return std::min(units(560.0F), ImGui::GetIO().DisplaySize.x - units(24.0F)); }

bool wants_tooltip(const std::string& text) {
    // During a drag or typing a tooltip would cover what changes.
    return !text.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) && !ImGui::IsAnyMouseDown() &&
           !ImGui::IsItemActive() && !is_behind_dialog();
}

void show_tooltip(const std::string& text) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(tooltip_width());
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

ImVec2 tooltip_size(const std::string& text) {
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    // ImGui measures the wrap position from the window edge.
    const ImVec2 words = ImGui::CalcTextSize(text.c_str(), nullptr, false, tooltip_width() - padding.x);
    return {words.x + 2.0F * padding.x, words.y + 2.0F * padding.y};
}

// Sets the corner of the next tooltip, moved to fit on the surface.
void place_tooltip(const ImVec2& at, const ImVec2& size) {
    const ImVec2 all = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({std::floor(std::clamp(at.x, 0.0F, std::max(0.0F, all.x - size.x))),
                             std::floor(std::clamp(at.y, 0.0F, std::max(0.0F, all.y - size.y)))});
}

// Beside the current window; without room there, below or above the last item.
void show_beside_window(const std::string& text) {
    const ImVec2 size = tooltip_size(text), window = ImGui::GetWindowPos(), low = ImGui::GetItemRectMin();
    const float to_window = units(4.0F), right = window.x + ImGui::GetWindowWidth() + to_window;
    const bool fits_right = right + size.x <= ImGui::GetIO().DisplaySize.x, fits_left = window.x - to_window >= size.x;
    const float below = ImGui::GetItemRectMax().y + to_window;
    if (fits_right || fits_left)
        place_tooltip({fits_right ? right : window.x - to_window - size.x, low.y}, size);
    else
        place_tooltip({low.x, below + size.y <= ImGui::GetIO().DisplaySize.y ? below : low.y - to_window - size.y},
                      size);
    show_tooltip(text);
}

}  // namespace

void slow_tooltip(const std::string& id, const std::string& text, PanelState& state) {
    constexpr double pause = 1.0;  // s
    if (!wants_tooltip(text)) return;
    const int frame = ImGui::GetFrameCount();
    if (state.pointed.id != id || state.pointed.frame < frame - 1) state.pointed = {id, ImGui::GetTime(), frame};
    state.pointed.frame = frame;
    state.pointed.is_early = ImGui::GetTime() - state.pointed.since < pause;
    if (!state.pointed.is_early) show_beside_window(upright(text));
}

bool waits_for_tooltip(const PanelState& state) { return state.pointed.is_early; }

void tooltip(const std::string& label, const Rectangle& clear, bool prefers_above) {
    if (!wants_tooltip(label)) return;
    const std::string text = upright(label);
    const ImVec2 size = tooltip_size(text), all = ImGui::GetIO().DisplaySize;
    const float gap = units(4.0F), below = clear.y + clear.height + gap, above = clear.y - gap - size.y;
    const bool is_below = prefers_above ? above < 0.0F : below + size.y <= all.y;
    place_tooltip({clear.x, is_below ? below : above}, size);
    show_tooltip(text);
}

void tooltip(const std::string& label) {
    if (!wants_tooltip(label)) return;
    const std::string text = upright(label);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (high.y - low.y > units(40.0F)) return show_tooltip(text);  // at the mouse
    if (!is_covered()) return tooltip(text, {low.x, low.y, high.x - low.x, high.y - low.y});
    show_beside_window(text);  // a menu, of which it then covers no entry
}

bool is_covered() { return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel); }

bool take_escape(PanelState& state) { return std::exchange(state.escape, false); }

void close_by_escape(const PanelState& state) {
    if (takes_key(state, key::escape, false)) ImGui::CloseCurrentPopup();
}

Rectangle remaining() {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
    return {at.x, at.y, size.x, size.y};
}

void remember(PanelState& state, const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
    state.places[name] = {low.x, low.y, size.x, size.y};
    add_stop(state, name, state.places[name]);
}

void move_time(const Session& session, double time, Commands& commands) {
    if (session.selected() > 0 && !lens_is_open(session)) commands.emplace_back(command::Select{0});
    if (time != session.time()) commands.emplace_back(command::Seek{time});
}

void paint_play_sign(const ImVec2& center, bool is_playing) {
    const ImVec2 c = center;
    const float r = units(5.5F);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (!is_playing)
        return list->AddTriangleFilled({c.x - 0.7F * r, c.y - r}, {c.x - 0.7F * r, c.y + r}, {c.x + r, c.y},
                                       packed(text_color()));
    for (const float side : {-1.0F, 0.4F})
        list->AddRectFilled({c.x + side * r, c.y - r}, {c.x + (side + 0.6F) * r, c.y + r}, packed(text_color()));
}

void fade_beyond(const Session& session, const Rectangle& area, double start, double end, const Color& behind) {
    const std::optional<double> horizon = session.horizon();
    if (!horizon || !(*horizon < end)) return;
    constexpr float cover = 0.72F;
    const auto x = area.x + static_cast<float>((*horizon - start) / (end - start)) * area.width;
    ImGui::GetWindowDrawList()->AddRectFilled({x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(behind, cover));
}

bool dragged_to(double low, double high, float left, float width, double& value) {
    if (!ImGui::IsItemActive() || width <= 0.0F) return false;
    const double share = std::clamp((double{ImGui::GetIO().MousePos.x} - left) / width, 0.0, 1.0);
    value = low + share * (high - low);
    return true;
}

void NearestEvent::ask(int number, const Event& event, double x, double y) {
    const double distance = std::hypot(x - double{mouse_.x}, y - double{mouse_.y});
    if (!(distance <= reach_)) return;
    const bool is_under = !event.is_impact() && distance <= 0.75 * reach_;
    const double cost = is_under ? distance - reach_ : distance;
    if (found_ && cost >= least_) return;
    found_ = number;
    least_ = cost;
}

void name_event(const Session& session, int number) {
    if (is_behind_dialog()) return;
    const auto index = static_cast<std::size_t>(number - 1);
    const std::string text = fmt::format(
        "event {}, {}{}\n{}\nclick: select it", number, event_time_text(session, index),
        session.enclosed(index) != nullptr ? ", proved" : "", typeset_sentence(session.sentences().of(index)));
    const ImVec2 size = tooltip_size(text), mouse = ImGui::GetIO().MousePos;
    const float above = mouse.y - size.y - units(12.0F);
    place_tooltip({mouse.x + units(12.0F), above >= 0.0F ? above : mouse.y + units(20.0F)}, size);
    show_tooltip(text);
}

PlotCard paint_plot_card(const Rectangle& cell) {
    ImGui::GetWindowDrawList()->AddRectFilled({cell.x, cell.y}, {cell.x + cell.width, cell.y + cell.height},
                                              packed(current_theme().background), units(4.0F));
    const float edge = units(8.0F), head = ImGui::GetTextLineHeight() + units(4.0F);
    const Rectangle row{cell.x + edge, cell.y + units(4.0F), cell.width - 2.0F * edge, head};
    return {row, {row.x, row.y + head, row.width, cell.y + cell.height - edge - row.y - head}};
}

void paint_menu_arrow(float x, float y, bool lit) {
    ImGui::GetWindowDrawList()->AddTriangleFilled({x, y - units(2.0F)}, {x + units(7.0F), y - units(2.0F)},
                                                  {x + units(3.5F), y + units(3.0F)},
                                                  packed(lit ? text_color() : faint_color()));
}

float menu_button(const char* popup, const std::string& text, float x, const Rectangle& row, float right,
                  PanelState& state) {
    const float size = ImGui::GetFontSize(), arrow = units(14.0F);
    const std::string shown = fitted(text, std::max(units(20.0F), right - x - arrow));
    const float width = label_width(shown, size) + arrow;
    ImGui::SetCursorScreenPos({x, row.y});
    const bool pressed = ImGui::InvisibleButton(popup, {width, row.height});
    remember(state, popup);
    const bool lit = ImGui::IsItemHovered();
    ImDrawList* list = ImGui::GetWindowDrawList();
    paint_label(list, x, row.y + 0.5F * (row.height - 1.2F * size), shown, text_color(), size);
    const float at = x + width - arrow + units(4.0F), y = std::floor(row.y + 0.5F * row.height);
    paint_menu_arrow(at, y, lit);
    if (pressed) ImGui::OpenPopup(popup);
    return x + width + units(10.0F);
}

bool text_row(const char* name, const std::string& id, std::string& text, float width, PanelState& state,
              float name_width) {
    label(name, units(name_width));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(units(width));
    const bool entered = ImGui::InputText(("##" + id).c_str(), &text, ImGuiInputTextFlags_EnterReturnsTrue);
    remember(state, id);
    return entered;
}

bool expression_fields(std::string& x, std::string& y, bool focuses_y, const std::string& id, const std::string& more,
                       PanelState& state) {
    bool entered = false;
    for (const auto& [name, text] : {std::pair{"y", &y}, std::pair{"x", &x}}) {
        if (focuses_y && text == &y) ImGui::SetKeyboardFocusHere();
        entered = text_row(name, id + name, *text, 240.0F, state, 20.0F) || entered;
        tooltip("an expression in t, coordinates, rates x', parameters, gap, gap', gap'', lambda, energy" + more);
    }
    return entered;
}

// ---- error messages as on the command line: sentence, source line, caret, hint ----

namespace {

// A line of a message. A quoted source line may have a caret below one of its letters.
struct MessageLine {
    std::string text;
    bool quoted = false;
    std::optional<std::size_t> caret;  // number of letters before it
};

// "/home/me/a.toml:3:1: wrong" without the folder, since a panel has little room and the file is known.
std::string without_folder(const std::string& line) {
    const std::size_t end = line.find(':'), name = line.rfind('/', end);
    const bool has_path = end != std::string::npos && name != std::string::npos && line[0] == '/' && line[1] != ' ';
    return has_path ? line.substr(name + 1) : line;
}

std::vector<MessageLine> lines_of(const std::string& message) {
    std::vector<MessageLine> lines;
    std::istringstream stream(message);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t first = line.find_first_not_of(' ');
        if (!lines.empty() && lines.back().quoted && first != std::string::npos && line.substr(first) == "^")
            lines.back().caret = first;
        else
            lines.push_back({without_folder(line), line.rfind("    ", 0) == 0, {}});
    }
    return lines;
}

// The letters of a UTF-8 text.
std::vector<std::string> letters_of(const std::string& text) {
    std::vector<std::string> letters;
    for (const char byte : text) {
        if ((static_cast<unsigned char>(byte) & 0xC0) == 0x80 && !letters.empty())
            letters.back() += byte;
        else
            letters.emplace_back(1, byte);
    }
    return letters;
}

// The part of a quoted line that fits, with the caret well inside.
MessageLine fitted_line(const MessageLine& line, float width) {
    const auto room = static_cast<std::size_t>(std::max(width / ImGui::CalcTextSize("x").x, 8.0F));
    const std::vector<std::string> letters = letters_of(line.text);
    if (letters.size() <= room) return line;
    const std::size_t caret = line.caret.value_or(0);
    std::size_t first = caret > 2 * room / 3 ? caret - 2 * room / 3 : 0;
    first = std::min(first, letters.size() - std::min(letters.size(), room));
    const std::size_t last = std::min(first + room, letters.size());
    MessageLine part{"", true, {}};
    for (std::size_t i = first; i < last; ++i) {
        const bool is_cut = (i == first && first > 0) || (i + 1 == last && last < letters.size());
        part.text += is_cut ? "\u2026" : letters[i];
    }
    if (line.caret) part.caret = caret - first;
    return part;
}

float height_of(const MessageLine& line, float width) {
    if (!line.quoted) return ImGui::CalcTextSize(line.text.c_str(), nullptr, false, width).y;
    return size_of(monospace_font()) * (line.caret ? 1.7F : 1.0F);
}

void show_quoted(const MessageLine& whole, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    push_font(monospace_font());
    const MessageLine line = fitted_line(whole, width);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText(at, packed(text_color()), line.text.c_str());
    if (line.caret) {
        const float x = at.x + static_cast<float>(*line.caret) * ImGui::CalcTextSize("x").x;
        list->AddText({x, at.y + 0.9F * ImGui::GetFontSize()}, packed(error_color()), "^");
    }
    ImGui::PopFont();
    ImGui::Dummy({1.0F, height_of(whole, width)});
}

}  // namespace

float message_height(const std::string& message, float width) {
    float height = 0.0F;
    for (const MessageLine& line : lines_of(message))
        height += ImGui::GetStyle().ItemSpacing.y + height_of(line, width);
    return height;
}

void show_message(const std::string& message, float width) {
    for (const MessageLine& line : lines_of(message)) {
        if (line.quoted) {
            show_quoted(line, width);
            continue;
        }
        ImGui::PushStyleColor(ImGuiCol_Text, packed(error_color()));
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
        ImGui::TextUnformatted(line.text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
    }
}

void paint_error_card(const Rectangle& area) {
    const ImVec2 low{area.x, area.y}, high{area.x + area.width, area.y + area.height};
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(low, high, packed(current_theme().error_card), units(4.0F));
    list->AddRect(low, high, packed(error_color(), 0.35F), units(4.0F));
}

}  // namespace achilles
