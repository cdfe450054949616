// The event list, below the plots.

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/actions.hpp"
#include "panels/event_list.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr float list_padding = 4.0F, list_beside_card = 300.0F, min_card = 540.0F, min_with_header = 200.0F;

// Index of the selected event, for which a card is shown; or none.
std::optional<std::size_t> chosen(const Session& session) {
    if (session.selected() == 0) return std::nullopt;
    return static_cast<std::size_t>(session.selected() - 1);
}

// Whether a card is shown beside the list.
bool shows_runs(const Session& session) { return !session.pinned().empty() && session.scene().shows("runs"); }
bool has_card(const Session& session) { return chosen(session) || shows_runs(session); }

void show_card_of_event(const Session& session, std::size_t event, PanelState& state, Commands& commands) {
    switch (session.trajectory().events[event].kind) {
        case Event::Kind::impact:
            return show_impact(session, event, state, commands);
        case Event::Kind::zeno:
            return show_zeno(session, event, state, commands);
        case Event::Kind::release:
            return show_release(session, event, state, commands);
        case Event::Kind::stick:
        case Event::Kind::slip:
        case Event::Kind::reversal:
            return show_friction(session, event, state, commands);
        case Event::Kind::collapse:
            return show_collapse(session, event, state, commands);
        case Event::Kind::jump:
            return show_jump(session, event, state, commands);
        case Event::Kind::pass:
            return show_pass(session, event, state, commands);
    }
}

// Index of the last event up to the current time; -1: none.
int reached(const Session& session) {
    const auto& events = session.trajectory().events;
    const auto later = std::upper_bound(events.begin(), events.end(), session.time(),
                                        [](double t, const Event& event) { return t < event.t; });
    return static_cast<int>(later - events.begin()) - 1;
}

// "Zeno point" or, with several contacts, "Zeno knee", "wall opens knee".
std::string event_name(const Session& session, const Event& event) {
    const std::string contacts = event_contacts_text(session.trajectory(), event);
    if (event.is_impact() && !event.opened.empty())
        return contacts + " opens " + joined_names(*session.model(), event.opened);
    const EventNames& names = names_of(event);
    return contacts.empty() ? std::string(names.name) : fmt::format("{} {}", names.label, contacts);
}

constexpr const char* both_ways = "paper | sharp";
constexpr float button_gap = 6.0F;

float button_width(const char* text) { return ImGui::CalcTextSize(text).x + 2.0F * ImGui::GetStyle().FramePadding.x; }

// (Buttons are wider than their words, since short ones are hard to hit.)
float comparing_width() { return button_width(both_ways) + units(button_gap) + button_width("unpin"); }

// Buttons from x on: pin the current run, and compare the two sets of truncation conditions.
void show_comparing(float x, const Session& session, PanelState& state, Commands& commands) {
    const float pin_width = button_width("unpin");
    const bool has_friction = session.model()->has_friction();
    ImGui::SameLine(x + pin_width + units(button_gap));
    ImGui::BeginDisabled(has_friction);
    if (ImGui::Button(both_ways)) {
        using namespace command;
        commands.insert(commands.end(),
                        {SetConditions{Conditions::paper}, SetReinitialization{Reinitialization::euclidean}, Select{0},
                         Pin{}, SetConditions{Conditions::sharp}, SetReinitialization{Reinitialization::kinetic}});
    }
    remember(state, "compare");
    ImGui::EndDisabled();
    tooltip(has_friction ? "the paper's conditions and the Euclidean restart cannot be used with dry friction"
                         : "compare the paper's conditions and restart (pinned) with the sharp ones");
    ImGui::SameLine(x);
    if (ImGui::Button("pin", {pin_width, 0.0F})) commands.emplace_back(command::Pin{});
    remember(state, "pin");
    tooltip("keep the present run in the plots, to compare with later ones");
}

void show_header(const Session& session, PanelState& state, Commands& commands) {
    const float right = content_right();
    const float width =
        ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("impacts").x;
    const float copy_width = button_width("copy");
    const float buttons = right - width - units(16.0F) - copy_width - units(button_gap) - comparing_width();
    // On the line of the tabs, if there is room beside them; the actions are in the menus, too. Where all panels are
    // tabs: on a line of its own.
    if (state.front.empty()) {
        const Rectangle& last = state.places["tab proof"];
        if (buttons < last.x + last.width + units(16.0F) - ImGui::GetWindowPos().x) return;
        ImGui::SetCursorPosY(last.y - ImGui::GetWindowPos().y);
    } else if (ImGui::GetWindowHeight() < units(min_with_header) || buttons < 0.0F) {
        return;
    }
    ImGui::SetCursorPosX(right - width - units(4.0F));
    ImGui::Checkbox("impacts", &state.show_impacts);
    remember(state, "impacts");
    tooltip("list every impact on a line of its own");
    ImGui::SameLine(right - width - units(16.0F) - copy_width);
    if (ImGui::Button("copy")) perform(action("Copy events"), session, state, commands);
    remember(state, "copy events");
    tooltip("copy the selected event, or all, as a table with all digits (Ctrl+C)");
    show_comparing(buttons, session, state, commands);
}

void show_event(const Session& session, std::size_t index, int present, const EventTable& table, PanelState& state,
                Commands& commands) {
    const int event_number = static_cast<int>(index) + 1;
    const bool is_selected =
        session.selected() == event_number || (session.selected() == 0 && present == static_cast<int>(index));
    // A second click on the selected event deselects it.
    if (table.row(is_selected))
        commands.emplace_back(command::Select{session.selected() == event_number ? 0 : event_number});
    remember(state, "event " + std::to_string(event_number));
    const Event& event = session.trajectory().events[index];
    paint_marker(ImGui::GetWindowDrawList(), event_markers(session.theme(), event.kind), table.sign(), units(1.0F));
    table.number(index + 1);
    table.time(event_time(session, index).digits, text_color());
    // Beside a card, which has the details, only the name.
    const std::string name =
        has_card(session) ? event_name(session, event) : typeset_sentence(session.sentences().of(index));
    const std::string proved = has_card(session) || session.enclosed(index) == nullptr ? "" : "proved · ";
    table.words(proved + name, text_color());
    // At a Zeno point the loss of its whole impact sequence, as in the sentence.
    const double lost = is_zeno_point(event) ? bounce_sequence_of(session.trajectory(), index).loss
                                             : energy_lost(session.trajectory(), index);
    table.values(&event, lost, text_color());
}

// The triangle of a folded or unfolded row.
void paint_fold(const Point& center, bool is_open) {
    const auto at = [&](float x, float y) {
        return ImVec2{static_cast<float>(center.x) + units(4.0F) * x, static_cast<float>(center.y) + units(4.0F) * y};
    };
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (is_open)
        list->AddTriangleFilled(at(-1.0F, -0.6F), at(1.0F, -0.6F), at(0.0F, 1.0F), packed(faint_color()));
    else
        list->AddTriangleFilled(at(-0.6F, -1.0F), at(-0.6F, 1.0F), at(1.0F, 0.0F), packed(faint_color()));
}

// A folded row: "10 impacts", the time of the first, and their energy loss; in a faint color.
void show_impacts(const Session& session, const EventRows::EventRow& row, int present, const EventTable& table,
                  PanelState& state, Commands& commands) {
    const auto& events = session.trajectory().events;
    const std::size_t last = row.event + row.count - 1;
    const bool is_reached = !row.is_open && session.selected() == 0 && present >= static_cast<int>(row.event) &&
                            present <= static_cast<int>(last);
    if (table.row(is_reached)) {
        const int chosen = session.selected() - 1;
        if (!row.is_open)
            state.unfolded.insert(row.event);
        else
            state.unfolded.erase(row.event);
        if (row.is_open && chosen >= static_cast<int>(row.event) && chosen <= static_cast<int>(last))
            commands.emplace_back(command::Select{0});
    }
    remember(state, "impacts " + std::to_string(row.event + 1));
    const auto time = [&](std::size_t i) { return event_time(session, i).digits; };
    tooltip(fmt::format("events {} to {}, t = {} to {} s: click to {} them", row.event + 1, last + 1, time(row.event),
                        time(last), row.is_open ? "collapse" : "list"));
    paint_fold(table.sign(), row.is_open);
    const bool any_turn = std::any_of(events.begin() + static_cast<std::ptrdiff_t>(row.event),
                                      events.begin() + static_cast<std::ptrdiff_t>(row.event + row.count),
                                      [](const Event& event) { return !event.is_impact(); });
    table.time(time(row.event), faint_color());
    table.words(fmt::format("{} {}", row.count, any_turn ? "events" : "impacts"), text_color());
    table.values(nullptr, events[last].loss - (row.event > 0 ? events[row.event - 1].loss : 0.0), faint_color());
}

// The row of the start or the end of the run; a click goes there.
void show_end(const Session& session, bool is_start, const EventTable& table, PanelState& state, Commands& commands) {
    const double t = is_start ? session.trajectory().run.options.start_time : session.trajectory().end_time;
    const bool is_present = session.selected() == 0 && session.time() == t;
    if (table.row(is_present)) move_time(session, t, commands);
    remember(state, is_start ? "event start" : "event end");
    if (!is_start && session.shows_start()) return table.words("still under way", faint_color());
    table.time(number_with_decimals(t, 0.0, 9), faint_color());
    // The time is in its own column.
    std::string text = is_start ? session.sentences().start() : session.sentences().end();
    const std::size_t colon = text.find(": ");
    text = (is_start ? "start" : "end") + (has_card(session) ? "" : text.substr(colon));
    table.words(typeset_sentence(text), faint_color());
}

// Scrolls to the row of the current event when it changes.
void follow(const EventRows& all, int event, PanelState& state) {
    if (event == state.followed) return;
    state.followed = event;
    // Row 0 is the start, which is shown before the first event.
    const std::size_t row = event < 0 ? 0 : all.row_of(static_cast<std::size_t>(event)) + 1;
    const float y = static_cast<float>(row) * ImGui::GetTextLineHeightWithSpacing();
    const float line = ImGui::GetTextLineHeightWithSpacing(), height = ImGui::GetWindowHeight() - line;  // below titles
    // Scroll by whole lines.
    if (y < ImGui::GetScrollY() || y + 3.0F * line > ImGui::GetScrollY() + height)
        ImGui::SetScrollY(std::max(0.0F, std::floor((y - 0.3F * height) / line) * line));
}

void show_list(const Session& session, ImVec2 size, PanelState& state, Commands& commands) {
    begin_padded_child("list", size);
    const float line = ImGui::GetTextLineHeightWithSpacing();  // height of whole rows
    const ImVec2 room{0.0F, std::max(2.0F * line, std::floor(ImGui::GetContentRegionAvail().y / line) * line)};
    const EventRows all(session, state.show_impacts, state.unfolded);
    const int present = reached(session), seen = session.selected() > 0 ? session.selected() - 1 : present;
    // At the end of the run its last row is highlighted instead of an event.
    const bool is_over = session.selected() == 0 && session.time() >= session.trajectory().end_time;
    if (const EventTable table(session, room, !has_card(session)); table.is_open()) {
        table.choose_columns(state);
        follow(all, seen, state);
        ImGuiListClipper clipper;
        const int rows = static_cast<int>(all.size()) + 2;
        clipper.Begin(rows, line);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
                ImGui::PushID(i);  // not its address, which may belong to another row in the next frame
                if (i == 0 || i == rows - 1) {
                    show_end(session, i == 0, table, state, commands);
                } else {
                    const EventRows::EventRow row = all.at(static_cast<std::size_t>(i - 1));
                    const int reached = is_over ? -1 : present;
                    if (row.count > 0)
                        show_impacts(session, row, reached, table, state, commands);
                    else
                        show_event(session, row.event, reached, table, state, commands);
                }
                ImGui::PopID();
            }
    }
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
    // Height of whole lines.
    const float line = ImGui::GetTextLineHeightWithSpacing(), room = ImGui::GetContentRegionAvail().y - units(12.0F);
    const float height = std::max(1.0F, std::floor((room + ImGui::GetStyle().ItemSpacing.y) / line)) * line +
                         units(12.0F) - ImGui::GetStyle().ItemSpacing.y;
    const bool with_card = has_card(session);
    // A card needs a minimum width; if there is no room for both, the list is hidden until the card is closed.
    const float width = ImGui::GetContentRegionAvail().x, gap = units(8.0F);
    const float least = chosen(session) ? units(min_card) : std::max(units(min_card), comparison_width(session));
    const bool with_list = !with_card || width - units(list_beside_card) - gap >= least;
    if (with_list) show_list(session, {with_card ? units(list_beside_card) : 0.0F, height}, state, commands);
    if (with_list && with_card) ImGui::SameLine(0.0F, gap);
    if (with_card) show_card(session, {0.0F, height}, state, commands);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

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

EventTable::EventTable(const Session& session, const ImVec2& size, bool is_alone)
    : session_(session), states_(state_columns(session)), is_of_several_(session.model()->contacts() > 1) {
    // Widths at scale 1. The sentence has the rest, and at least this much before values are shown.
    constexpr float sign_width = 28.0F, number_width = 34.0F, time_width = 130.0F, words_width = 600.0F,
                    column_width = 112.0F;
    const float before = sign_width + number_width + time_width + words_width;
    const float rest = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize - units(before);
    const auto fitting = static_cast<std::size_t>(std::max(0.0F, rest / units(column_width)));
    values_ = is_alone ? std::min(fitting, 1 + (is_of_several_ ? 1 : 0) + states_.size()) : 0;
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {0.0F, std::floor(0.5F * ImGui::GetStyle().ItemSpacing.y)});
    // Another scale has other widths, and another system other columns.
    ImGui::PushID(fmt::format("{} {}", session.system(), units(1.0F)).c_str());
    is_open_ = ImGui::BeginTable("events", first_value + static_cast<int>(values_),
                                 ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_Hideable |
                                     ImGuiTableFlags_NoBordersInBody | ImGuiTableFlags_NoSavedSettings,
                                 size);
    if (!is_open_) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const float width : {sign_width, number_width, time_width})
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, units(width));
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
    for (std::size_t i = 0; i < values_; ++i)
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, units(column_width));
    ImGui::TableNextRow(ImGuiTableRowFlags_None, ImGui::GetTextLineHeightWithSpacing());
    title(number_column, "#"), title(time_column, "t (s)"), title(words_column, "event");
    if (is_alone) tooltip(precision_text());
    // A long unit, as of an energy divided by a mass, leaves room for one word.
    const std::string unit = typeset_unit(session.sentences().energy_unit());
    std::string lost = with_unit("energy lost", unit);
    if (width_of(lost) > units(column_width - 8.0F)) lost = with_unit("lost", unit);
    for (std::size_t i = 0; i < values_; ++i)
        title(column_of(i), i == 0 ? lost : is_held(i) ? "held" : state_of(i).title);
}

EventTable::~EventTable() {
    if (is_open_) ImGui::EndTable();
    ImGui::PopID();
    ImGui::PopStyleVar();
}

void EventTable::title(int column, const std::string& text) const {
    if (!ImGui::TableSetColumnIndex(column)) return;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{std::max(1.0F, ImGui::GetContentRegionAvail().x), ImGui::GetTextLineHeight()};
    ImGui::InvisibleButton(("##title" + std::to_string(column)).c_str(), size);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup("columns");
    if (column >= first_value) tooltip("right click: hide and show columns");
    ImGui::SetCursorScreenPos(at);
    if (column == words_column)
        words(text, faint_color());
    else
        put(column, text, faint_color());
}

void EventTable::choose_columns(PanelState& state) const {
    std::vector<bool> shown;
    for (std::size_t i = 0; i < values_; ++i)
        shown.push_back((ImGui::TableGetColumnFlags(column_of(i)) & ImGuiTableColumnFlags_IsEnabled) != 0);
    if (!ImGui::BeginPopup("columns")) return;
    close_by_escape(state);
    std::optional<std::size_t> chosen;
    for (std::size_t i = 0; i < values_; ++i) {
        const std::string name = i == 0 ? "energy lost" : is_held(i) ? "held" : state_of(i).name;
        if (ImGui::MenuItem(name.c_str(), nullptr, shown[i])) chosen = i;
        remember(state, "column " + name);
    }
    ImGui::EndPopup();
    if (chosen) ImGui::TableSetColumnEnabled(column_of(*chosen), !shown[*chosen]);
}

bool EventTable::row(bool is_marked) const {
    ImGui::TableNextRow(ImGuiTableRowFlags_None, ImGui::GetTextLineHeightWithSpacing());
    ImGui::TableSetColumnIndex(sign_column);
    return ImGui::Selectable("##row", is_marked, ImGuiSelectableFlags_SpanAllColumns);
}

Point EventTable::sign() const {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    return {double{low.x + units(14.0F)}, 0.5 * double{low.y + high.y}};
}

void EventTable::put(int column, const std::string& text, const Color& color, int decimals) const {
    if (!ImGui::TableSetColumnIndex(column)) return;
    const float font = ImGui::GetFontSize(), margin = units(column == time_column     ? 16.0F
                                                            : column == number_column ? 0.0F
                                                                                      : 8.0F);
    const std::size_t point = text.find('.'), behind = point == std::string::npos ? 0 : text.size() - point - 1;
    const bool is_plain = text.find_first_not_of("\u22120123456789.") == std::string::npos;
    const std::string missing =
        is_plain && behind < static_cast<std::size_t>(decimals)
            ? (behind == 0 ? "." : "") + std::string(static_cast<std::size_t>(decimals) - behind, '0')
            : "";
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x - margin, width = std::min(label_width(text, font), room);
    cell({std::floor(at.x + room - width - label_width(missing, font)), at.y}, text, width + 0.5F, color);
}

void EventTable::number(std::size_t number) const { put(number_column, std::to_string(number), faint_color()); }

void EventTable::time(const std::string& digits, const Color& color) const {
    put(time_column, digits, color, decimals_of_times(session_.trajectory()));
}

void EventTable::words(const std::string& text, const Color& color) const {
    if (!ImGui::TableSetColumnIndex(words_column)) return;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    cell({std::floor(at.x), at.y}, text, ImGui::GetContentRegionAvail().x - units(8.0F), color);
}

void EventTable::values(const Event* event, double lost, const Color& color) const {
    constexpr int loss_decimals = 4, state_decimals = 5;
    if (values_ == 0) return;
    // A smaller loss is rounding.
    const double whole = std::abs(session_.trajectory().loss);
    const double shown = flush_noise_to_zero(lost, 10.0 * std::max(whole, session_.sentences().energy_scale()));
    const Precision& precision = session_.precision();
    if (shown != 0.0)
        put(first_value,
            number_of_size(shown, whole, loss_decimals,
                           event == nullptr ? 0.0 : precision.of_energy(sample_at(session_.trajectory(), *event))),
            color, loss_decimals);
    if (event == nullptr) return;
    const State errors = precision.of_state(event->t);
    for (std::size_t i = 1; i < values_; ++i)
        put(column_of(i),
            is_held(i) ? joined_names(*session_.model(), event->mode.held())
                       : number_of_size(state_of(i).of(*event), state_of(i).size(session_.scale()), state_decimals,
                                        state_of(i).error(errors)),
            color, is_held(i) ? 0 : state_decimals);
}

}  // namespace achilles
