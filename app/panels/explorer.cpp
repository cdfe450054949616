// The frame: what stands where.
#include <algorithm>
#include <optional>
#include <sstream>

#include "panels/widgets.hpp"

namespace achilles {

namespace {

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus;
constexpr ImGuiWindowFlags still_window =
    fixed_window | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

constexpr float card_padding = 10.0F;

// A window that fills its part of the surface.
template <class Content>
void part(const char* name, const Rectangle& area, ImGuiWindowFlags flags, const Content& content) {
    ImGui::SetNextWindowPos({area.x, area.y});
    ImGui::SetNextWindowSize({std::max(area.width, 1.0F), std::max(area.height, 1.0F)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    if (ImGui::Begin(name, nullptr, flags)) content();
    ImGui::End();
    ImGui::PopStyleVar();
}

struct Parts {
    Rectangle controls, mechanism, timeline, plots, events, status, error;
};

// Everything from the size of the surface and of the text. The centre and the plots share what the controls leave; the
// events get what they need to be read, or more where there is room.
Parts lay_out(const Session& session) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float padding = ImGui::GetStyle().WindowPadding.y;
    const float status = ImGui::GetFrameHeight() + units(8.0F);
    const float left = std::floor(std::clamp(0.2F * size.x, units(288.0F), units(340.0F)));
    const float events = std::floor(std::max(units(180.0F), 0.27F * size.y));
    const float width = size.x - left, height = size.y - status - events;
    const float centre = std::floor(0.46F * width);
    const float timeline = timeline_height() + 2.0F * padding;
    Parts parts;
    parts.controls = {0.0F, 0.0F, left, size.y - status};
    const float error = session.error().empty() ? 0.0F : error_height(session, centre);
    parts.error = {left, 0.0F, centre, error};
    parts.mechanism = {left, error, centre, height - timeline - error};
    parts.timeline = {left, height - timeline, centre, timeline};
    parts.plots = {left + centre, 0.0F, width - centre, height};
    parts.events = {left, height, width, events};
    parts.status = {0.0F, size.y - status, size.x, status};
    return parts;
}

// A line of a message. One that quotes a file may have a caret below one of its letters.
struct MessageLine {
    std::string text;
    bool quoted = false;
    std::optional<std::size_t> caret;  // how many letters stand before it
};

std::vector<MessageLine> lines_of(const std::string& message) {
    std::vector<MessageLine> lines;
    std::istringstream stream(message);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t first = line.find_first_not_of(' ');
        if (!lines.empty() && lines.back().quoted && first != std::string::npos && line.substr(first) == "^")
            lines.back().caret = first;
        else
            lines.push_back({line, line.rfind("    ", 0) == 0, {}});
    }
    return lines;
}

float height_of(const MessageLine& line, float wrap) {
    if (line.quoted) return ImGui::GetTextLineHeight() * (line.caret ? 1.5F : 1.0F);
    return ImGui::CalcTextSize(line.text.c_str(), nullptr, false, wrap).y;
}

// Our letters differ in width, so the caret stands where the text before it ends.
void show_quoted(const MessageLine& line) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({1.0F, height_of(line, 0.0F)});
    ImGui::GetWindowDrawList()->AddText(at, packed(text_color()), line.text.c_str());
    if (!line.caret) return;
    const char* letter = line.text.c_str();
    const char* const end = letter + line.text.size();
    for (std::size_t i = 0; i < *line.caret && letter < end; ++i)
        for (++letter; letter < end && (static_cast<unsigned char>(*letter) & 0xC0) == 0x80;) ++letter;
    const float x = at.x + ImGui::CalcTextSize(line.text.c_str(), letter).x;
    ImGui::GetWindowDrawList()->AddText({x, at.y + 0.95F * ImGui::GetTextLineHeight()}, packed(error_color()), "^");
}

}  // namespace

float error_height(const Session& session, float width) {
    const float wrap = width - 2.0F * (ImGui::GetStyle().WindowPadding.x + units(card_padding));
    float height = ImGui::GetStyle().WindowPadding.y + 2.0F * units(card_padding);
    for (const MessageLine& line : lines_of(session.error()))
        height += ImGui::GetStyle().ItemSpacing.y + height_of(line, wrap);
    return height;
}

void show_error(const Session& session) {
    const Rectangle area = remaining();
    const ImVec2 low{area.x, area.y},
        high{area.x + area.width, area.y + area.height + ImGui::GetStyle().WindowPadding.y};
    ImGui::GetWindowDrawList()->AddRectFilled(low, high, IM_COL32(253, 236, 234, 255), units(4.0F));
    ImGui::GetWindowDrawList()->AddRect(low, high, packed(error_color(), 0.35F), units(4.0F));
    ImGui::SetCursorScreenPos({low.x + units(card_padding), low.y + units(card_padding)});
    ImGui::BeginGroup();
    for (const MessageLine& line : lines_of(session.error())) {
        if (line.quoted) {
            show_quoted(line);
            continue;
        }
        ImGui::PushStyleColor(ImGuiCol_Text, packed(error_color()));
        ImGui::PushTextWrapPos(ImGui::GetContentRegionMax().x - units(card_padding));
        ImGui::TextUnformatted(line.text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
    }
    ImGui::EndGroup();
}

std::vector<Command> explorer(const Session& session, PanelState& state) {
    Commands commands;
    const Parts parts = lay_out(session);
    part("controls", parts.controls, fixed_window, [&] { show_controls(session, state, commands); });
    if (parts.error.height > 0.0F) {
        part("error", parts.error, still_window, [&] { show_error(session); });
    }
    part("mechanism", parts.mechanism, still_window, [&] { show_mechanism(session); });
    part("timeline", parts.timeline, still_window, [&] { show_timeline(session, state, commands); });
    part("plots", parts.plots, still_window, [&] { show_plots(session, state, commands); });
    part("events", parts.events, still_window, [&] { show_events(session, state, commands); });
    part("status", parts.status, still_window, [&] { show_status(session, state); });
    return commands;
}

}  // namespace achilles
