// Below: what happened, event by event, and what is proved of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "paint/label.hpp"
#include "paint/marker.hpp"
#include "panels/event_rows.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// Where the columns of the list are, at scale 1, from its left edge: signs and words begin there, numbers end there.
constexpr float sign_at = 14.0F, number_at = 62.0F, kind_at = 76.0F, time_at = 274.0F, proof_at = 366.0F,
                speed_at = 462.0F, kind_width = 104.0F, state_width = 112.0F, list_padding = 4.0F;
constexpr float list_beside_card = 300.0F, least_card = 540.0F;

// The index of the event that the user chose, which is shown with its reasons; or none.
std::optional<std::size_t> chosen(const Session& session) {
    if (session.selected() == 0) return std::nullopt;
    return static_cast<std::size_t>(session.selected() - 1);
}

// Whether something stands beside the list.
bool has_card(const Session& session) { return chosen(session) || session.pinned() != nullptr; }

void show_card_of_event(const Session& session, std::size_t event, PanelState& state, Commands& commands) {
    switch (session.trajectory().events[event].kind) {
        case Event::Kind::impact:
            return show_impact(session, event, state, commands);
        case Event::Kind::zeno:
            return show_zeno(session, event, state, commands);
        case Event::Kind::release:
            return show_release(session, event, state, commands);
    }
}

// The last event that the present has reached, or none.
int reached(const Session& session) {
    const auto& events = session.trajectory().events;
    const auto later = std::upper_bound(events.begin(), events.end(), session.time(),
                                        [](double t, const Event& event) { return t < event.t; });
    return static_cast<int>(later - events.begin()) - 1;
}

// A column of the state after an event: a coordinate or its rate.
struct StateColumn {
    std::string name, title;
    Eigen::Index coordinate = 0;
    bool is_rate = false;
    double factor = 1.0;
    double of(const Event& event) const { return (is_rate ? event.v_after : event.q)[coordinate] * factor; }
    double size(const State& scale) const { return (is_rate ? scale.v : scale.q)[coordinate] * factor; }
    // Rounding noise is shown as 0.
    double shown(const Event& event, const State& scale) const { return without_noise(of(event), size(scale)); }
};

std::vector<StateColumn> state_columns(const Session& session) {
    std::vector<StateColumn> columns;
    const auto& coordinates = session.description().coordinates;
    for (const bool is_rate : {false, true})
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            const bool is_angle = coordinates[i].unit == "rad";
            std::string unit = is_angle ? "\u00b0" : typeset_unit(coordinates[i].unit);
            if (is_rate && !unit.empty()) unit += "/s";
            const std::string name = coordinates[i].name + (is_rate ? "'" : "");
            columns.push_back({name, with_unit(typeset_name(name), unit), static_cast<Eigen::Index>(i), is_rate,
                               is_angle ? degrees(1.0) : 1.0});
        }
    return columns;
}

// The speed of the first impact, about as large as any.
double fastest_gap(const Session& session) {
    const auto& events = session.trajectory().events;
    const auto first = std::find_if(events.begin(), events.end(),
                                    [](const Event& event) { return event.kind == Event::Kind::impact; });
    return first == events.end() ? 0.0 : first->impact_speed;
}

bool is_of_several(const Session& session) { return session.model()->contacts() > 1; }

// "Zeno point", and where there are several contacts "Zeno knee", "wall opens knee".
std::string event_name(const Session& session, const Event& event) {
    const std::string contacts = contacts_told(session.trajectory(), event);
    if (!event.opened.empty()) return contacts + " opens " + joined_names(*session.model(), event.opened);
    if (is_plastic_landing(event)) return contacts.empty() ? "landing" : "landing " + contacts;
    if (contacts.empty()) return event_name(event);
    return fmt::format("{} {}", event.kind == Event::Kind::zeno ? "Zeno" : to_text(event.kind), contacts);
}

// The events for a spreadsheet, every digit: the chosen one, or all. In the units of the list.
std::string table(const Session& session) {
    const std::vector<StateColumn> columns = state_columns(session);
    const bool several = is_of_several(session);
    std::string text = several ? "#\tevent\tcontacts\topened\theld\tt\timpact speed" : "#\tevent\tt\timpact speed";
    for (const StateColumn& column : columns) text += "\t" + column.name;
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i) {
        if (chosen(session).value_or(i) != i) continue;
        const Event& event = events[i];
        const bool is_impact = event.kind == Event::Kind::impact;
        text += fmt::format("\n{}\t{}", i + 1, event_name(event));
        for (const ContactSet& set : {event.contacts, event.opened, event.held})
            if (several) text += "\t" + joined_names(*session.model(), set, "+");
        text += fmt::format("\t{}\t{}", event.t, is_impact ? fmt::format("{}", event.impact_speed) : "");
        for (const StateColumn& column : columns) text += fmt::format("\t{}", column.of(event));
    }
    return text + "\n";
}

constexpr const char* both_ways = "paper | sharp";
constexpr float button_gap = 6.0F;

float button_width(const char* text) { return ImGui::CalcTextSize(text).x + 2.0F * ImGui::GetStyle().FramePadding.x; }

float comparing_width() { return button_width(both_ways) + units(button_gap) + button_width("unpin"); }

// Its left end at x: pin the present run, and the comparison of the two ways to cut a bouncing.
void show_comparing(const Session& session, float x, PanelState& state, Commands& commands) {
    const float pin_width = button_width("unpin");
    ImGui::SameLine(x + pin_width + units(button_gap));
    if (ImGui::Button(both_ways)) {
        using namespace command;
        commands.insert(commands.end(),
                        {UseConditions{Conditions::paper}, UseReinitialization{Reinitialization::euclidean}, Select{0},
                         Pin{true}, UseConditions{Conditions::sharp}, UseReinitialization{Reinitialization::kinetic}});
    }
    remember(state, "compare");
    tooltip(
        "compare the paper's conditions with the Euclidean restart (pinned) and the sharp ones with the kinetic "
        "restart");
    ImGui::SameLine(x);
    if (ImGui::Button(session.pinned() != nullptr ? "unpin" : "pin", {pin_width, 0.0F}))
        commands.emplace_back(command::Pin{session.pinned() == nullptr});
    remember(state, "pin");
    tooltip("keep the present run in the plots, in grey, beside those that follow");
}

// A number, or a word over numbers, that ends at x; a long word is cut.
void number_cell(ImVec2 at, float x, const std::string& text, const Color& color) {
    const float room = units(state_width - 8.0F), width = std::min(label_width(text, ImGui::GetFontSize()), room);
    cell({std::floor(at.x + units(x) - width), at.y}, text, width + 0.5F, color);
}

// Where the first column of the state ends: before it stands what is held, where there are several contacts.
float first_column(const Session& session) { return speed_at + state_width * (is_of_several(session) ? 2.0F : 1.0F); }

// How many columns of the state have room.
std::size_t columns_shown(const Session& session, float width) {
    const float room = width - units(first_column(session) - state_width + 12.0F);
    const auto fitting = static_cast<std::size_t>(std::max(0.0F, room / units(state_width)));
    return has_card(session) ? 0 : std::min(fitting, 2 * session.description().coordinates.size());
}

void paint_titles(const Session& session, ImVec2 at, float width) {
    const bool alone = !has_card(session);
    const auto title = [&](float x, const std::string& text) {
        if (units(x) <= width) number_cell(at, x, text, faint_color());
    };
    title(number_at, "#");
    ImGui::GetWindowDrawList()->AddText({std::floor(at.x + units(kind_at)), at.y}, packed(faint_color()), "event");
    title(time_at, "t (s)");
    if (!alone) return;
    title(proof_at, "\u00b1 from cut");
    title(speed_at, "gap speed");
    const float first = first_column(session);
    if (is_of_several(session)) title(first - state_width, "held");
    const std::vector<StateColumn> columns = state_columns(session);
    for (std::size_t i = 0; i < columns_shown(session, width); ++i)
        title(first + state_width * static_cast<float>(i), columns[i].title);
}

void show_header(const Session& session, PanelState& state, Commands& commands) {
    const float right = content_right();
    const float width =
        ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("impacts").x;
    const float copy_width = button_width("copy");
    const float buttons = right - width - units(16.0F) - copy_width - units(button_gap) - comparing_width();
    show_lower_tabs(session, state, commands);
    ImGui::SameLine(right - width - units(4.0F));
    ImGui::Checkbox("impacts", &state.show_impacts);
    remember(state, "impacts");
    tooltip("list every impact; without, those in a row are one line, which a click opens");
    ImGui::SameLine(right - width - units(16.0F) - copy_width);
    const bool by_key = !ImGui::GetIO().WantTextInput && ImGui::GetIO().KeyCtrl && is_pressed('C', false);
    if (ImGui::Button("copy") || by_key) ImGui::SetClipboardText(table(session).c_str());
    remember(state, "copy events");
    tooltip("the chosen event, or all, as a table with every digit, for a spreadsheet (Ctrl+C)");
    show_comparing(session, buttons, state, commands);
}

void paint_event(const Session& session, std::size_t index, ImVec2 at, float width) {
    const Event& event = session.trajectory().events[index];
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Markers markers = event_markers(session.theme(), event.kind);
    paint_marker(list, markers, {at.x + units(sign_at), at.y + 0.5F * ImGui::GetTextLineHeight()}, units(1.0F));
    number_cell(at, number_at, std::to_string(index + 1), faint_color());
    std::string name = event_name(session, event);
    if (!event.opened.empty() && ImGui::CalcTextSize(name.c_str()).x > units(kind_width))
        name = "opens " + joined_names(*session.model(), event.opened);
    cell({std::floor(at.x + units(kind_at)), at.y}, name, units(kind_width), text_color());
    number_cell(at, time_at, number(event.t, "{:.9f}"), text_color());
    if (has_card(session)) return;
    const std::string proof = event.kind == Event::Kind::zeno ? time_text(session.trajectory(), index) : "";
    if (const std::size_t sign = proof.find("\u00b1 "); sign != std::string::npos)
        number_cell(at, proof_at, proof.substr(sign + 3), text_color());
    if (event.kind == Event::Kind::impact)
        number_cell(at, speed_at, number_of_size(event.impact_speed, fastest_gap(session), 6), text_color());
    const float first = first_column(session);
    if (is_of_several(session) && units(first - state_width) <= width)
        number_cell(at, first - state_width, joined_names(*session.model(), event.held), text_color());
    const std::vector<StateColumn> columns = state_columns(session);
    for (std::size_t i = 0; i < columns_shown(session, width); ++i)
        number_cell(at, first + state_width * static_cast<float>(i),
                    number_of_size(columns[i].shown(event, session.scale()), columns[i].size(session.scale()), 5),
                    text_color());
}

// "10 impacts", and when the first and the last of them were.
void paint_impacts(const Session& session, const EventRows::Row& row, ImVec2 at) {
    const auto& events = session.trajectory().events;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 c{at.x + units(sign_at), at.y + 0.5F * ImGui::GetTextLineHeight()};
    const float r = units(4.0F);
    if (row.is_open)
        list->AddTriangleFilled({c.x - r, c.y - 0.6F * r}, {c.x + r, c.y - 0.6F * r}, {c.x, c.y + r},
                                packed(faint_color()));
    else
        list->AddTriangleFilled({c.x - 0.6F * r, c.y - r}, {c.x - 0.6F * r, c.y + r}, {c.x + r, c.y},
                                packed(faint_color()));
    const auto end = events.begin() + static_cast<std::ptrdiff_t>(row.event + row.count);
    const bool any_turn = std::any_of(events.begin() + static_cast<std::ptrdiff_t>(row.event), end,
                                      [](const Event& event) { return event.kind != Event::Kind::impact; });
    list->AddText({std::floor(at.x + units(kind_at)), at.y}, packed(text_color()),
                  fmt::format("{} {}", row.count, any_turn ? "events" : "impacts").c_str());
    number_cell(at, time_at, number(events[row.event].t, "{:.9f}"), faint_color());
}

void show_impacts(const Session& session, const EventRows::Row& row, int present, PanelState& state,
                  Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const auto& events = session.trajectory().events;
    const std::size_t last = row.event + row.count - 1;
    const bool is_reached = !row.is_open && session.selected() == 0 && present >= static_cast<int>(row.event) &&
                            present <= static_cast<int>(last);
    if (ImGui::Selectable("##row", is_reached)) {
        const int chosen = session.selected() - 1;
        if (!row.is_open)
            state.unfolded.insert(row.event);
        else
            state.unfolded.erase(row.event);
        if (row.is_open && chosen >= static_cast<int>(row.event) && chosen <= static_cast<int>(last))
            commands.emplace_back(command::Select{0});
    }
    remember(state, "impacts " + std::to_string(row.event + 1));
    tooltip(fmt::format("events {} to {}, t = {:.9g} to {:.9g} s: a click {} them", row.event + 1, last + 1,
                        events[row.event].t, events[last].t, row.is_open ? "folds" : "lists"));
    paint_impacts(session, row, at);
}

void show_event(const Session& session, std::size_t event, int present, PanelState& state, Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetWindowWidth() - ImGui::GetStyle().ScrollbarSize;
    const int event_number = static_cast<int>(event) + 1;
    const bool is_selected =
        session.selected() == event_number || (session.selected() == 0 && present == static_cast<int>(event));
    // Another click on the chosen event lets go of it.
    if (ImGui::Selectable("##row", is_selected))
        commands.emplace_back(command::Select{session.selected() == event_number ? 0 : event_number});
    remember(state, "event " + std::to_string(event_number));
    paint_event(session, event, at, width);
}

// Scrolls so that the row is seen, once whenever another row is the one to see.
void follow(const EventRows& all, int event, PanelState& state) {
    if (event == state.followed) return;
    state.followed = event;
    const float y =
        static_cast<float>(all.row_of(static_cast<std::size_t>(event))) * ImGui::GetTextLineHeightWithSpacing();
    const float height = ImGui::GetWindowHeight(), line = ImGui::GetTextLineHeightWithSpacing();
    // By whole lines: none is cut at the top.
    if (y < ImGui::GetScrollY() || y + 3.0F * line > ImGui::GetScrollY() + height)
        ImGui::SetScrollY(std::max(0.0F, std::floor((y - 0.3F * height) / line) * line));
}

}  // namespace

namespace {

void show_list(const Session& session, ImVec2 size, PanelState& state, Commands& commands) {
    begin_padded_child("list", size);
    // As wide as the rows are where they can be scrolled.
    paint_titles(session, ImGui::GetCursorScreenPos(),
                 ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize);
    const ImVec2 head = ImGui::GetCursorPos();
    ImGui::SetCursorPosX(head.x + units(proof_at - state_width));
    ImGui::Dummy({units(state_width), ImGui::GetTextLineHeight()});
    if (!has_card(session)) tooltip(precision_text());
    ImGui::SetCursorPos(head);
    ImGui::Dummy({1.0F, ImGui::GetTextLineHeight()});
    const float line = ImGui::GetTextLineHeightWithSpacing();  // none is cut at the bottom
    const float room = std::max(line, std::floor(ImGui::GetContentRegionAvail().y / line) * line);
    ImGui::BeginChild("rows", {0.0F, room}, false);
    const EventRows all(session, state);
    const int present = reached(session);
    ImGui::SetCursorPosY(
        std::floor(0.5F * ImGui::GetStyle().ItemSpacing.y));  // the first line is marked as high as the others
    if (all.size() == 0) ImGui::TextDisabled("  nothing happens in this run");
    if (all.size() > 0) follow(all, session.selected() > 0 ? session.selected() - 1 : std::max(present, 0), state);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(all.size()), ImGui::GetTextLineHeightWithSpacing());
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const EventRows::Row row = all.at(static_cast<std::size_t>(i));
            ImGui::PushID(i);  // not its address, which another frame gives to another row
            if (row.count > 0)
                show_impacts(session, row, present, state, commands);
            else
                show_event(session, row.event, present, state, commands);
            ImGui::PopID();
        }
    ImGui::EndChild();
    ImGui::EndChild();
}

void show_card(const Session& session, ImVec2 size, PanelState& state, Commands& commands) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(12.0F), units(5.0F)});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, units(2.0F)});
    begin_padded_child("card", size);
    if (const auto event = chosen(session))
        show_card_of_event(session, *event, state, commands);
    else
        show_comparison(session, state, commands);
    ImGui::EndChild();
    ImGui::PopStyleVar(2);
}

}  // namespace

void show_events(const Session& session, PanelState& state, Commands& commands) {
    show_header(session, state, commands);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, packed(session.theme().background));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(list_padding), units(6.0F)});
    // As high as whole lines are.
    const float line = ImGui::GetTextLineHeightWithSpacing(), room = ImGui::GetContentRegionAvail().y - units(12.0F);
    const float height = std::max(1.0F, std::floor((room + ImGui::GetStyle().ItemSpacing.y) / line)) * line +
                         units(12.0F) - ImGui::GetStyle().ItemSpacing.y;
    const bool with_card = has_card(session);
    // A card needs its width; where there is none for both it stands alone, until it is closed.
    const float width = ImGui::GetContentRegionAvail().x, gap = units(8.0F);
    const bool with_list = !with_card || width - units(list_beside_card) - gap >= units(least_card);
    if (with_list) show_list(session, {with_card ? units(list_beside_card) : 0.0F, height}, state, commands);
    if (with_list && with_card) ImGui::SameLine(0.0F, gap);
    if (with_card) show_card(session, {0.0F, height}, state, commands);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

}  // namespace achilles
