#include "panels/print.hpp"

#include "panels/widgets.hpp"

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

}  // namespace achilles
