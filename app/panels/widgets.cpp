#include "panels/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "paint/label.hpp"
#include "surface/interface.hpp"

namespace achilles {

float units(float pixels) { return pixels * ImGui::GetFontSize() / 15.0F; }

ImU32 packed(const Color& color, float alpha) {
    return IM_COL32(color.r, color.g, color.b, static_cast<int>(static_cast<float>(color.a) * alpha + 0.5F));
}

Color text_color() { return current_theme().ink; }
Color faint_color() { return current_theme().faint; }
Color error_color() { return current_theme().error; }

std::string fitted(const std::string& text, float width) {
    const float size = ImGui::GetFontSize();
    if (label_width(text, size) <= width) return text;
    std::string shorter = text;
    while (!shorter.empty() && label_width(shorter + "\u2026", size) > width) {
        // A letter may be several bytes.
        while (shorter.size() > 1 && (static_cast<unsigned char>(shorter.back()) & 0xC0) == 0x80) shorter.pop_back();
        shorter.pop_back();
    }
    return shorter + "\u2026";
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
    const float right = ImGui::GetWindowPos().x + ImGui::GetContentRegionMax().x - free;
    ImGui::GetWindowDrawList()->AddLine({high.x + units(8.0F), y}, {right, y}, ImGui::GetColorU32(ImGuiCol_Border));
}

void tooltip(const std::string& text) {
    if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(units(360.0F));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

Rectangle remaining() {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
    return {at.x, at.y, size.x, size.y};
}

void remember(PanelState& state, const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
    state.places[name] = {low.x, low.y, size.x, size.y};
}

bool dragged_to(double low, double high, float left, float width, double& value) {
    if (!ImGui::IsItemActive() || width <= 0.0F) return false;
    const double share = std::clamp((double{ImGui::GetIO().MousePos.x} - left) / width, 0.0, 1.0);
    value = low + share * (high - low);
    return true;
}

std::string number(double value, const char* format) {
    std::string text = fmt::format(fmt::runtime(format), value + 0.0);
    for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at + 1))
        text.replace(at, 1, "\u2212");
    return text;
}

}  // namespace achilles
