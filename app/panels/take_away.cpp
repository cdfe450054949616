// Menus: what can be taken away from a session, and the tours that can be taken; and what a tour says on the way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

bool item(const char* name, const char* about, PanelState& state, bool enabled = true) {
    const bool chosen = ImGui::MenuItem(name, nullptr, false, enabled);
    remember(state, std::string("menu ") + name);
    tooltip(about);
    return chosen;
}

constexpr float padding = 12.0F, accent_width = 4.0F, buttons_width = 76.0F, close_width = 26.0F;

// The caption's text in its width, a little larger than the interface's.
float text_width(const PanelState& state, float width) {
    return width - 2.0F * units(padding) - units(accent_width) - units(state.on_tour ? buttons_width : close_width);
}

// A word to press in the caption's corner.
bool word_button(const char* word, const char* about, PanelState& state, bool enabled = true) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::CalcTextSize(word);
    const bool pressed = ImGui::InvisibleButton(word, size);
    remember(state, std::string("tour ") + word);
    const bool lit = enabled && ImGui::IsItemHovered();
    ImGui::GetWindowDrawList()->AddText(at, packed(lit ? text_color() : faint_color(), enabled ? 1.0F : 0.4F), word);
    tooltip(about);
    return pressed && enabled;
}

}  // namespace

void show_take_away_items(const Session& session, PanelState& state, Commands& commands) {
    struct Kind {
        const char *name, *ending, *about;
    };
    constexpr Kind kinds[] = {
        {"Film as MP4\u2026", "mp4", "the mechanism in motion beside the plots (needs ffmpeg)"},
        {"Figure as SVG\u2026", "svg", "the plots for print; achilles reproduce can make them again"},
        {"Figure as PNG\u2026", "png", "the plots as an image in pixels"},
        {"Run as JSON\u2026", "json", "phases, events and certificates"},
        {"Run as CSV\u2026", "csv", "one row per instant"},
        {"Session as journal\u2026", "journal", "the commands that lead here, to replay anywhere"}};
    const bool is_there = session.under_way() == nullptr;
    for (const Kind& kind : kinds)
        if (item(kind.name, kind.about, state, is_there)) ask_to_take_away(session, state, kind.ending);
    ImGui::Separator();
    constexpr std::pair<const char*, const char*> lines[] = {
        {"Copy explorer command", "explorer"}, {"Copy figure command", "figure"}, {"Copy run command", "run"}};
    for (const auto& [name, what] : lines)
        if (item(name, "shell command that reproduces this", state)) commands.emplace_back(command::Copy{what});
}

void show_tour_items(const Session& session, PanelState& state, Commands& commands) {
    if (state.tours.empty()) ImGui::TextDisabled("no tours are installed");
    for (const SystemEntry& tour : state.tours) {
        if (ImGui::MenuItem((tour.title + "##" + tour.name).c_str()))
            request(session, state, command::Replay{tour.name}, commands);
        remember(state, "tour " + tour.name);
    }
}

float caption_height(const Session& session, const PanelState& state, float width) {
    const std::string& caption = session.scene().caption();
    if (caption.empty()) return 0.0F;
    const float room = text_width(state, width);
    const float text = ImGui::CalcTextSize(caption.c_str(), nullptr, false, room).y;
    // Room for four lines: from caption to caption nothing jumps.
    return std::max(text, 4.0F * ImGui::GetTextLineHeight()) + 2.0F * units(padding) - units(4.0F);
}

void show_caption(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 low{area.x, area.y}, high{area.x + area.width, area.y + area.height};
    list->AddRectFilled(low, high, packed(session.theme().background), units(4.0F));
    list->AddRectFilled(low, {low.x + units(accent_width), high.y}, ImGui::GetColorU32(ImGuiCol_SliderGrab),
                        units(2.0F));
    const float left = area.x + units(accent_width + padding), top = area.y + units(padding - 2.0F);
    ImGui::SetCursorScreenPos({left, top});
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + text_width(state, area.width));
    ImGui::TextUnformatted(session.scene().caption().c_str());
    ImGui::PopTextWrapPos();
    if (!state.on_tour) {
        ImGui::SetCursorScreenPos({high.x - units(close_width), top});
        if (word_button("\u00d7", "close", state)) commands.emplace_back(command::Say{""});
        return;
    }
    ImGui::SetCursorScreenPos({high.x - units(buttons_width), top});
    const bool keys = !ImGui::GetIO().WantTextInput, has_before = state.tour_said > 1;
    if (word_button("next", "go on now (Enter)", state) ||
        (keys && !has_keys(state) && takes_key(state, key::enter, false)))
        state.tour_wants = PanelState::OnTour::next;
    ImGui::SameLine(0.0F, units(10.0F));
    if (word_button("stop", "end the tour here (Escape); any other action also ends it", state) || take_escape(state))
        state.tour_wants = PanelState::OnTour::stop;
    // Below the others: beside them the words would have less room.
    ImGui::SetCursorScreenPos({high.x - units(buttons_width), top + ImGui::GetTextLineHeight()});
    if (word_button("back", "previous step (Backspace)", state, has_before) ||
        (keys && has_before && !has_keys(state) && takes_key(state, key::backspace, false)))
        state.tour_wants = PanelState::OnTour::back;
    if (state.tour_said == 0) return;
    const std::string how_far = fmt::format("{}/{}", state.tour_said, state.tour_sentences);
    list->AddText({std::floor(high.x - units(padding) - ImGui::CalcTextSize(how_far.c_str()).x),
                   std::floor(high.y - units(padding - 2.0F) - ImGui::GetTextLineHeight())},
                  packed(faint_color()), how_far.c_str());
}

}  // namespace achilles
