// The frame: layout and the drawing of all parts.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "session/arrangement.hpp"
#include "session/history.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus |
                                          // an error message must not close a menu
                                          ImGuiWindowFlags_NoFocusOnAppearing;
constexpr ImGuiWindowFlags still_window =
    fixed_window | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

constexpr float card_padding = 10.0F;

// A window that fills its rectangle, if that is not empty.
template <class Content>
void part(const char* name, const Rectangle& area, ImGuiWindowFlags flags, const Content& content) {
    if (area.width < 1.0F || area.height < 1.0F) return;
    ImGui::SetNextWindowPos({area.x, area.y});
    ImGui::SetNextWindowSize({area.width, area.height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0F, 1.0F});
    const bool is_seen = ImGui::Begin(name, nullptr, flags);
    ImGui::PopStyleVar(3);  // menus and lists opened from here have their own style
    if (is_seen) content();
    ImGui::End();
}

float card_height(const std::string& message, float width) {
    if (message.empty()) return 0.0F;
    return 2.0F * units(card_padding) + message_height(message, width - 2.0F * units(card_padding));
}

Arrangement arrange(const Session& session, const PanelState& state, const std::string& message) {
    Measures measures;
    measures.width = ImGui::GetIO().DisplaySize.x;
    measures.height = ImGui::GetIO().DisplaySize.y;
    measures.unit = units(1.0F);
    measures.bar = ImGui::GetFrameHeight() + units(12.0F);
    measures.status = ImGui::GetFrameHeight() + units(6.0F);
    measures.tabs = ImGui::GetFrameHeight();
    measures.timeline = timeline_height();
    measures.results = [&](float) { return results_height(session); };
    if (session.scene().shows("energy")) {
        measures.energy = energy_height(true);
        measures.min_energy = energy_height(false);
    }
    if (session.scene().presents()) {
        measures.title = lecture_title_height();
        measures.sliders = lecture_sliders(session).empty() ? 0.0F : ImGui::GetFrameHeight();
    }
    measures.state = [&](float width) { return state_height(session, width); };
    measures.error = [&](float width) { return card_height(message, width); };
    measures.caption = [&](float width) { return caption_height(session, state, width); };
    return achilles::arrange(session.scene(), measures);
}

// The gap beside a panel: a drag resizes the panel, a double click restores the automatic size.
void show_splitter(const Arrangement::Splitter& splitter, PanelState& state, Commands& commands) {
    const ImVec2 size{splitter.area.width, splitter.area.height};
    ImGui::InvisibleButton("splitter", size);
    remember(state, "splitter " + splitter.panel);
    const bool is_held = ImGui::IsItemActive();
    if (!is_held && !ImGui::IsItemHovered()) return;
    ImGui::SetMouseCursor(splitter.moves_sideways ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    const ImVec2 low = ImGui::GetItemRectMin();
    const float half = units(1.0F);
    const ImVec2 middle{low.x + 0.5F * size.x, low.y + 0.5F * size.y};
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 color = packed(current_theme().accent, is_held ? 1.0F : 0.6F);
    if (splitter.moves_sideways)
        list->AddRectFilled({middle.x - half, low.y}, {middle.x + half, low.y + size.y}, color, half);
    else
        list->AddRectFilled({low.x, middle.y - half}, {low.x + size.x, middle.y + half}, color, half);
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        commands.emplace_back(command::SetPanelSize{splitter.panel, 0.0});
        return;
    }
    const ImVec2 delta = ImGui::GetIO().MouseDelta, mouse = ImGui::GetIO().MousePos;
    if (!is_held || (splitter.moves_sideways ? delta.x : delta.y) == 0.0F) return;
    const double share = std::clamp(splitter.share_at(mouse.x, mouse.y), 0.01, 0.99);
    commands.emplace_back(command::SetPanelSize{splitter.panel, std::round(share * 1e4) / 1e4});
}

// The error of the last command or, without the editor, of an invalid text.
std::string card_text(const Session& session) {
    const auto& problems = session.document().problems;
    if (!session.error().empty()) return session.error();
    if (session.shows_editor() || problems.empty()) return session.notice();
    return problems.front().what();
}

void show_card(const Session& session, const std::string& message) {
    const Rectangle area = remaining();
    const float width = area.width - 2.0F * units(card_padding);
    const bool is_good = message == session.notice();
    const ImVec2 low{area.x, area.y}, high{area.x + area.width, area.y + area.height};
    if (!is_good) paint_error_card(area);
    ImGui::GetWindowDrawList()->AddRect(low, high, ImGui::GetColorU32(ImGuiCol_Border), units(4.0F));
    ImGui::SetCursorScreenPos({area.x + units(card_padding), area.y + units(card_padding)});
    ImGui::BeginGroup();
    if (is_good)
        paragraph(message, width, text_color());
    else
        show_message(message, width);
    ImGui::EndGroup();
    if (!is_good && message[0] == '/') tooltip(message);  // with the folder of the file
}

// Copies the text of the last `copy` command to the clipboard, once.
void copy(const Session& session, PanelState& state) {
    if (session.copies() == state.copies) return;
    state.copies = session.copies();
    ImGui::SetClipboardText(session.copied().c_str());
}

// A new mouse press starts a new change, even of the same slider. A double click belongs to its first press.
void begin_change(PanelState& state, Commands& commands) {
    const auto& clicked = ImGui::GetIO().MouseClickedCount;
    if (!state.changing || (clicked[ImGuiMouseButton_Left] != 1 && clicked[ImGuiMouseButton_Right] != 1)) return;
    state.changing = false;
    commands.emplace_back(command::EndEdit{});
}

// Escape for the panels; anything in front of them uses it first.
bool escape_pressed(const PanelState& state) {
    return takes_key(state, key::escape, false) && !ImGui::GetIO().WantTextInput;
}

// A frame around the panel that a tour refers to.
void show_highlight(const Scene& scene, const std::string& panel, const Arrangement& parts) {
    if ((panel == "sweep" || panel == "events") && scene.below() != panel) return;  // another study is shown there
    const std::pair<const char*, const Rectangle*> all[] = {
        {"bar", &parts.bar},          {"controls", &parts.controls},   {"energy", &parts.energy},
        {"events", &parts.events},    {"mechanism", &parts.mechanism}, {"plots", &parts.plots},
        {"results", &parts.results},  {"status", &parts.status},       {"sweep", &parts.events},
        {"timeline", &parts.timeline}};
    for (const auto& [name, area] : all) {
        if (panel != name || area->width < 1.0F || area->height < 1.0F || is_covered()) continue;
        // Within the surface, in the gap between panels if possible.
        const ImVec2 whole = ImGui::GetIO().DisplaySize;
        const float out = units(3.0F), half = units(1.25F);
        const ImVec2 low{std::max(area->x - out, half), std::max(area->y - out, half)};
        const ImVec2 high{std::min(area->x + area->width + out, whole.x - half),
                          std::min(area->y + area->height + out, whole.y - half)};
        stroke_rectangle(ImGui::GetForegroundDrawList(), low, high, packed(current_theme().accent), units(5.0F),
                         units(2.5F));
    }
}

bool is_part_of_change(const Command& command) { return continues_edit(command, command); }

}  // namespace

std::vector<Command> explorer(const Session& session, PanelState& state) {
    Commands commands;
    use_theme(session.theme().dark);
    state.width = double{ImGui::GetIO().DisplaySize.x}, state.height = double{ImGui::GetIO().DisplaySize.y};
    begin_change(state, commands);
    state.escape = escape_pressed(state);
    begin_focus(state);
    follow_views(session, state);
    use_action_keys(session, state, commands);
    state.lit = std::exchange(state.lights, {});
    state.pointed_slider.clear();
    state.pointed.is_early = false;
    // Discard a click on a slider or plot that is no longer shown.
    if (ImGui::GetTime() - state.plot_click.since > 1.0) state.plot_click = {};
    if (ImGui::GetTime() - state.pressed.clicked_since > 1.0) state.pressed.clicked.clear();
    const std::string message = card_text(session);
    const Arrangement parts = arrange(session, state, message);
    state.front = parts.front, state.is_alone = parts.is_alone;
    // In front of the panels, since its window is made before theirs: see NoBringToFrontOnFocus.
    const bool has_message = !message.empty();
    part("error", has_message ? parts.error : Rectangle{-2.0F, -2.0F, 1.0F, 1.0F}, still_window, [&] {
        if (has_message) show_card(session, message);
    });
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {units(8.0F), units(8.0F)});
    part("bar", parts.bar, still_window | ImGuiWindowFlags_MenuBar, [&] { show_bar(session, state, commands); });
    ImGui::PopStyleVar();
    part("controls", parts.controls, session.shows_editor() ? still_window : fixed_window, [&] {
        show_system(session, state, commands);
        if (session.shows_editor())
            show_editor(session, state, commands);
        else
            show_controls(session, state, commands);
    });
    show_dialogs(session, state, commands);
    show_manual(state);
    show_help(session, state, commands);
    show_palette(session, state, commands);
    show_gallery(session, state, commands);
    show_film(state);
    part("title", parts.title, still_window, [&] { show_lecture_title(session); });
    part("sliders", parts.sliders, still_window, [&] { show_lecture_sliders(session, state, commands); });
    part("tabs", parts.tabs, still_window, [&] { show_panel_tabs(session, state, commands); });
    part("caption", parts.caption, still_window, [&] { show_caption(session, state, commands); });
    part("mechanism", parts.mechanism, still_window, [&] { show_mechanism(session, state, commands); });
    part("results", parts.results, still_window, [&] { show_results(session, state, commands); });
    part("energy", parts.energy, still_window, [&] { show_energy(session, state, commands); });
    part("timeline", parts.timeline, still_window, [&] { show_timeline(session, state, commands); });
    part("plots", parts.plots, still_window, [&] {
        if (lens_is_open(session))
            show_lens(session, state, commands);
        else
            show_plots(session, state, commands);
    });
    part("sweep", parts.sweep, still_window, [&] { show_sweep(session, state, commands); });
    part("events", parts.events, still_window, [&] { show_lower_panel(session, state, commands); });
    part("status", parts.status, still_window, [&] { show_status(session, state); });
    for (const Arrangement::Splitter& splitter : parts.splitters)
        part(("splitter " + splitter.panel).c_str(), splitter.area, still_window,
             [&] { show_splitter(splitter, state, commands); });
    show_highlight(session.scene(), session.scene().highlight(), parts);
    use_focus(state);
    if (session.scene().presents() && take_escape(state)) commands.emplace_back(command::Present{false});
    state.changing = state.changing || std::any_of(commands.begin(), commands.end(), is_part_of_change);
    copy(session, state);
    state.focus.front = front_popup();
    return commands;
}

}  // namespace achilles
