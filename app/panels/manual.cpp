// The Help menu: the pages of the manual, in a window of their own above everything else.
#include <imgui.h>

#include <utility>

#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr const char* manual_title = "Manual";

void show_page(PanelState& state) {
    const Rectangle all{0.0F, 0.0F, ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
    const float margin = units(40.0F);
    ImGui::SetNextWindowPos({margin, margin});
    ImGui::SetNextWindowSize({all.width - 2.0F * margin, all.height - 2.0F * margin});
    if (!ImGui::BeginPopupModal(manual_title, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) return;
    const float button_row = ImGui::GetFrameHeightWithSpacing();
    // Tables need letters of one width.
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

void show_help_items(PanelState& state, Commands& commands) {
    if (menu_item("Keys and words", state)) commands.emplace_back(command::Show{"help", true});
    ImGui::Separator();
    // The menu is there in any case: a picture must not depend on where the assets are.
    if (state.manual.empty()) ImGui::MenuItem("The manual is missing", nullptr, false, false);
    for (const SystemEntry& page : state.manual) {
        const bool chosen = ImGui::MenuItem(page.title.c_str());
        remember(state, "menu " + page.name);
        if (!chosen) continue;
        state.manual_text = state.manual_page(page.name);
        state.opens_manual = true;
    }
}

void show_manual(PanelState& state) {
    if (std::exchange(state.opens_manual, false)) ImGui::OpenPopup(manual_title);
    show_page(state);
}

}  // namespace achilles
