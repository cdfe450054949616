#include "panels/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
    // While the hand works it would cover what changes.
    if (ImGui::IsAnyMouseDown()) return;
    constexpr float wrap = 360.0F;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(),
                 padding = ImGui::GetStyle().WindowPadding;
    const ImVec2 all = ImGui::GetIO().DisplaySize;
    // Over a line of a panel: below all of it, or above, so that the value beside stays in sight. Over a line of a menu:
    // beside the menu.
    if (high.y - low.y < units(40.0F)) {
        const ImVec2 words = ImGui::CalcTextSize(text.c_str(), nullptr, false, units(wrap));
        const ImVec2 size{words.x + 2.0F * padding.x, words.y + 2.0F * padding.y};
        const float gap = units(4.0F);
        const bool in_menu = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
        ImVec2 at{low.x, high.y + gap};
        if (in_menu) at = {ImGui::GetWindowPos().x + ImGui::GetWindowWidth() + gap, low.y};
        if (at.y + size.y > all.y) at.y = std::max(0.0F, (in_menu ? all.y : low.y - gap) - size.y);
        at.x = std::clamp(at.x, 0.0F, std::max(0.0F, all.x - size.x));
        ImGui::SetNextWindowPos({std::floor(at.x), std::floor(at.y)});
    }
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(units(wrap));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool take_escape(PanelState& state) { return std::exchange(state.escape, false); }

void close_by_escape() {
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false)) ImGui::CloseCurrentPopup();
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

void NearestEvent::ask(int number, Event::Kind kind, double x, double y) {
    const double distance = std::hypot(x - double{mouse_.x}, y - double{mouse_.y});
    if (!(distance <= reach_)) return;
    const bool is_under = kind != Event::Kind::impact && distance <= 0.75 * reach_;
    const double cost = is_under ? distance - reach_ : distance;
    if (found_ && cost >= least_) return;
    found_ = number;
    least_ = cost;
}

void name_event(const Session& session, int number) {
    const Event& event = session.trajectory().events[static_cast<std::size_t>(number - 1)];
    ImGui::SetTooltip("%s, event %d, t = %s s\nclick: select it",
                      event_markers(session.theme(), event.kind).label.c_str(), number,
                      achilles::number(event.t, "{:.9g}").c_str());
}

std::string number(double value, const char* format) {
    std::string text = fmt::format(fmt::runtime(format), value + 0.0);
    // What is rounded to zero has no sign.
    if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
    for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at + 1))
        text.replace(at, 1, "\u2212");
    return text;
}

}  // namespace achilles
