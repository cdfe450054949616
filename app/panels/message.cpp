// What is wrong with an input, as the command line says it: the sentence, the line it is about, a caret, a hint.
#include <algorithm>
#include <optional>
#include <sstream>

#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// A line of a message. One that quotes a file may have a caret below one of its letters.
struct MessageLine {
    std::string text;
    bool quoted = false;
    std::optional<std::size_t> caret;  // how many letters stand before it
};

// "/home/me/a.toml:3:1: wrong" without the folder: a panel has no room for it, and knows which file is meant.
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

// The letters of a text, each a few bytes.
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

// As much of a quoted line as fits, with the caret well inside.
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
