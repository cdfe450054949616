// The gallery (Ctrl+G): pictures of the example systems in groups; a click or Enter opens a system.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "paint/paint.hpp"
#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "pictures/thumbnails.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr const char* gallery_title = "Gallery";
constexpr float card_width = 190.0F, picture_height = 104.0F, card_spacing = 12.0F, widest_gallery = 1260.0F;

bool card(const SystemEntry& entry, bool is_open, float width, const Session& session, PanelState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), high = units(picture_height);
    const bool pressed = ImGui::InvisibleButton(("##" + entry.name).c_str(), {width, high + line + units(12.0F)});
    remember(state, "gallery " + entry.name);
    if (!ImGui::IsItemVisible()) return pressed;
    const bool lit = ImGui::IsItemHovered();
    tooltip(entry.title);
    const Theme& theme = session.theme();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 high_corner{at.x + width, at.y + high};
    list->AddRectFilled(at, high_corner, packed(theme.page), units(4.0F));
    if (const Thumbnail* thumbnail = state.thumbnails ? state.thumbnails->find(entry.name) : nullptr) {
        const Drawing& drawing = theme.dark ? thumbnail->dark : thumbnail->light;
        const float room = units(8.0F);
        if (!drawing.shapes.empty())
            paint(drawing, list, {at.x + room, at.y + room, width - 2.0F * room, high - 2.0F * room}, units(0.8F));
    }
    stroke_rectangle(list, at, high_corner, packed(lit || is_open ? theme.accent : theme.border), units(4.0F),
                     units(is_open ? 2.0F : 1.0F));
    std::string name = entry.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    list->AddText({at.x + units(2.0F), high_corner.y + units(4.0F)}, packed(lit ? theme.accent : text_color()),
                  fitted(name, width - units(4.0F)).c_str());
    return pressed;
}

void show_cards(const Session& session, PanelState& state, Commands& commands) {
    const float room = ImGui::GetContentRegionAvail().x, between = units(card_spacing);
    const int columns = std::max(1, static_cast<int>((room + between) / (units(card_width) + between)));
    const float width = std::floor((room - between * static_cast<float>(columns - 1)) / static_cast<float>(columns));
    std::string group;
    int column = 0;
    for (const SystemEntry& entry : state.systems) {
        if (entry.group != group) {
            group = entry.group;
            column = 0;
            section(group.c_str());
        }
        if (column > 0) ImGui::SameLine(0.0F, between);
        column = (column + 1) % columns;
        if (!card(entry, entry.name == session.system(), width, session, state)) continue;
        commands.emplace_back(command::Show{"gallery", false});
        request(session, state, command::Open{entry.name}, commands);
    }
}

}  // namespace

void show_gallery(const Session& session, PanelState& state, Commands& commands) {
    const bool shown = session.scene().shows("gallery");
    const ImGuiIO& io = ImGui::GetIO();
    if (shown && !is_covered()) {
        ImGui::OpenPopup(gallery_title);
        state.focus.at = "gallery " + session.system();  // arrow keys start here
        state.focus.scrolls = true;
    }
    const float width = std::min(units(widest_gallery), io.DisplaySize.x - units(48.0F));
    const float height = io.DisplaySize.y - units(64.0F);
    ImGui::SetNextWindowPos({std::floor(0.5F * (io.DisplaySize.x - width)), units(32.0F)});
    ImGui::SetNextWindowSize({std::floor(width), std::floor(height)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(16.0F), units(12.0F)});
    if (ImGui::BeginPopupModal(gallery_title, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
        if (!shown)
            ImGui::CloseCurrentPopup();
        else
            show_cards(session, state, commands);
        if (shown && (takes_key(state, key::escape, false) || takes_key_of(action("Gallery\u2026"), state)))
            commands.emplace_back(command::Show{"gallery", false});
        if (shown && takes_key_of(action("Find\u2026"), state)) commands.emplace_back(command::Show{"palette", true});
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
    if (state.thumbnails) state.thumbnails->update();
}

}  // namespace achilles
