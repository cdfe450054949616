// The lower panel: the events and the studies of the run, as tabs; and the study that proves the run.
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>

#include "output/proof.hpp"
#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "session/event_rows.hpp"
#include "session/study_jobs.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// A tab: what the scene shows, its title, the action of the View menu that shows it, too, and a study's content.
struct PanelTab {
    const char *what, *title, *action;
    void (*show)(const Session& session, PanelState& state, Commands& commands);
};
constexpr PanelTab panel_tabs[] = {{"mechanism", "Mechanism", "", nullptr},
                                   {"controls", "Controls", "Controls", nullptr},
                                   {"plots", "Plots", "Plots", nullptr},
                                   {"events", "Events", "Events", show_events},
                                   {"equations", "Equations", "Equations", show_equations},
                                   {"depend", "Sensitivities", "Sensitivities", show_dependence},
                                   {"sweep", "Sweep", "Sweep", show_sweep},
                                   {"orbit", "Periodic", "Periodic run", show_orbit},
                                   {"proof", "Proof", "Proof", show_proof}};
constexpr std::span<const PanelTab> study_tabs = std::span(panel_tabs).subspan(3);

void choose(const PanelTab& tab, const Session& session, Commands& commands) {
    const std::string below = session.scene().below();
    if (std::string_view(tab.what) == "events" && below != "events" && !below.empty())
        commands.emplace_back(command::Show{below, false});
    commands.emplace_back(command::Show{tab.what, true});
}

// One of the tabs; the current one is underlined. Returns true if it was pressed.
bool show_tab(const PanelTab& tab, float width, bool is_seen, PanelState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool is_pressed = ImGui::InvisibleButton(tab.title, {width, ImGui::GetFrameHeight()});
    remember(state, std::string("tab ") + tab.what);
    const Color color = is_seen || ImGui::IsItemHovered() ? text_color() : faint_color();
    if (tab.show != nullptr) tooltip(fmt::format("{} ({})", action(tab.action).about, action(tab.action).keys));
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText({at.x, at.y + ImGui::GetStyle().FramePadding.y}, packed(color), fitted(tab.title, width).c_str());
    const float low = at.y + ImGui::GetFrameHeight();
    if (is_seen) list->AddRectFilled({at.x, low - units(2.0F)}, {at.x + width, low}, packed(current_theme().accent));
    return is_pressed && !is_seen;
}

// Without room for every title: a menu of the tabs.
void show_tab_menu(std::span<const PanelTab> tabs, const std::string& seen, const Session& session, PanelState& state,
                   Commands& commands) {
    const Rectangle row{remaining().x, remaining().y, 0.0F, ImGui::GetFrameHeight()};
    for (const PanelTab& one : tabs)
        if (one.what == seen) menu_button("tabs", one.title, row.x, row, row.x + remaining().width, state);
    if (!ImGui::BeginPopup("tabs")) return;
    for (const PanelTab& one : tabs) {
        if (ImGui::MenuItem(one.title, nullptr, one.what == seen)) choose(one, session, commands);
        remember(state, std::string("tab ") + one.what);
    }
    close_by_escape(state);
    ImGui::EndPopup();
}

// The tabs always have the same places.
void show_tabs(std::span<const PanelTab> tabs, const std::string& seen, const Session& session, PanelState& state,
               Commands& commands) {
    const float room = ImGui::GetContentRegionAvail().x, count = static_cast<float>(tabs.size());
    float width = 0.0F;
    for (const PanelTab& one : tabs) width += ImGui::CalcTextSize(one.title).x;
    if (width + units(6.0F) * count > room) return show_tab_menu(tabs, seen, session, state, commands);
    for (const PanelTab& one : tabs) {
        if (show_tab(one, ImGui::CalcTextSize(one.title).x, one.what == seen, state)) choose(one, session, commands);
        ImGui::SameLine(0.0F, std::min((room - width) / count, units(16.0F)));
    }
    ImGui::NewLine();
}

// Menu of the half-widths of the start interval.
void show_spreads(PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup("spreads")) return;
    for (const double width : {0.0, 1e-8, 1e-6, 1e-4}) {
        const std::string name = width == 0.0 ? "this start only" : fmt::format("\u00b1 {:g}", width);
        if (ImGui::MenuItem(name.c_str())) commands.emplace_back(command::Prove{width, {}});
        remember(state, fmt::format("prove {:g}", width));
    }
    close_by_escape(state);
    ImGui::EndPopup();
}

// The events that change the contacts, with the proved intervals of their times; a click selects one. A run with impacts
// alone has those.
void show_proved_events(const Session& session, PanelState& state, Commands& commands) {
    const auto& events = session.trajectory().events;
    std::vector<std::size_t> rows = turns(session.trajectory(), true);
    for (std::size_t i = 0; rows.empty() && i < events.size(); ++i) rows.push_back(i);
    constexpr float name_width = 150.0F;
    begin_padded_child("proved events", {0.0F, std::max(1.0F, ImGui::GetContentRegionAvail().y)});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows.size()), ImGui::GetTextLineHeightWithSpacing());
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const std::size_t event = rows[static_cast<std::size_t>(i)];
            const int event_number = static_cast<int>(event) + 1;
            ImGui::PushID(i);
            if (ImGui::Selectable("##proved", session.selected() == event_number))
                commands.emplace_back(command::Select{session.selected() == event_number ? 0 : event_number});
            ImGui::PopID();
            remember(state, fmt::format("proved {}", event_number));
            const std::string text = proved_text(session, event);
            cell({at.x + units(4.0F), at.y}, fmt::format("{} {}", event_number, names_of(events[event]).name),
                 units(name_width), text_color());
            cell({at.x + units(name_width + 12.0F), at.y}, text.empty() ? "not proved" : text,
                 remaining().width - units(name_width + 16.0F), text.empty() ? faint_color() : text_color());
        }
    ImGui::EndChild();
}

}  // namespace

void show_panel_tabs(const Session& session, PanelState& state, Commands& commands) {
    show_tabs(std::span(panel_tabs).subspan(state.is_alone ? 0 : 1), state.front, session, state, commands);
}

void show_lower_panel(const Session& session, PanelState& state, Commands& commands) {
    const std::string seen = session.scene().below();
    if (state.front.empty()) show_tabs(study_tabs, seen, session, state, commands);
    for (const PanelTab& tab : study_tabs)
        if (tab.what == seen) tab.show(session, state, commands);
}

void begin_study(const char* name) {
    ImGui::PushStyleColor(ImGuiCol_ChildBg, packed(current_theme().background));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(12.0F), units(6.0F)});
    begin_padded_child(name, {0.0F, std::max(1.0F, ImGui::GetContentRegionAvail().y)});
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

void show_proof(const Session& session, PanelState& state, Commands& commands) {
    begin_study("proof");
    const std::optional<UnprovedFeature> unproved = first_unproved(session.model()->description());
    const bool is_under_way = session.proof_under_way() != nullptr, is_there = session.proof() != nullptr;
    // A run that is proved by itself has no tubes yet.
    const char* const request = session.shown_proof() != nullptr ? "Show tubes" : "Prove this run";
    ImGui::BeginDisabled(unproved.has_value());
    if (ImGui::Button(is_under_way ? "Stop proving" : is_there ? "Forget proof" : request))
        commands.push_back(is_under_way || is_there ? Command(command::StopProof{}) : Command(command::Prove{}));
    remember(state, "prove");
    ImGui::SameLine(0.0F, units(14.0F));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const Rectangle row{at.x, at.y, 0.0F, ImGui::GetFrameHeight()};
    menu_button("spreads", "for all starts within", at.x, row, ImGui::GetWindowPos().x + content_right(), state);
    tooltip("prove more than the present run: all starts in a box around its start");
    show_spreads(state, commands);
    ImGui::EndDisabled();
    ImGui::SetCursorScreenPos({remaining().x, row.y + row.height + ImGui::GetStyle().ItemSpacing.y});
    const float width = std::min(remaining().width, units(640.0F));
    if (unproved)
        paragraph(
            fmt::format("Runs with {} cannot be proved; the status line has the estimated error.", unproved->what),
            width, text_color());
    else if (const Proof* const proof = session.shown_proof())
        paragraph(proof_sentence(session, *proof), remaining().width, text_color());
    else
        paragraph(
            is_under_way
                ? "The proof is under way; the status line has its progress."
                : "A proof encloses the exact motion from its start: through every impact and every Zeno point, with "
                  "all errors of integration, cuts and rounding. Events then have the intervals of their times.",
            width, faint_color());
    if (session.shown_proof() != nullptr) show_proved_events(session, state, commands);
    ImGui::EndChild();
}

}  // namespace achilles
