// Below: what happened, event by event, and what is proved of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/output.hpp"
#include "paint/label.hpp"
#include "paint/marker.hpp"
#include "panels/turns.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

// Where the columns of the list begin, at scale 1, from its left edge.
constexpr float sign_at = 14.0F, number_at = 34.0F, kind_at = 78.0F, time_at = 174.0F, speed_at = 300.0F,
                state_at = 410.0F, list_padding = 4.0F;

// A line of the list: an event, or one line of what its certificate says.
struct Row {
    std::size_t event;
    std::string certificate;
};

// Text broken into lines of at most this width.
std::vector<std::string> wrapped(const std::string& text, float width) {
    std::vector<std::string> lines;
    const char* at = text.c_str();
    const char* const end = at + text.size();
    while (at < end) {
        const char* stop = ImGui::GetFont()->CalcWordWrapPositionA(1.0F, at, end, width);
        if (stop == at) stop = end;
        lines.emplace_back(at, stop);
        for (at = stop; at < end && *at == ' ';) ++at;
    }
    return lines;
}

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

// A certificate in its symbols; the sentence itself is plain text, for terminals.
std::string typeset_sentence(const Certificate& certificate) {
    std::string text = sentence(certificate);
    for (const auto& [plain, symbol] :
         {std::pair{"tau_inf", "\u03c4\u221e"}, std::pair{"_inf", "\u221e"}, std::pair{" - ", " \u2212 "},
          std::pair{"e-0", "e\u22120"}, std::pair{"e-1", "e\u22121"}})
        for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at + 1))
            text.replace(at, std::string_view(plain).size(), symbol);
    return text;
}

// The lines of the list: every event, or only those that are no impacts, each certificate in as many lines as it needs.
// A run may have a hundred thousand impacts: only what is seen is made.
class Rows {
 public:
    Rows(const Session& session, bool impacts, float width) : impacts_(impacts) {
        turns_ = turns(session.trajectory());
        const auto& events = session.trajectory().events;
        count_ = impacts ? events.size() : turns_.size();
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            const Event& event = events[turns_[i]];
            if (!event.certificate || has_card(session)) continue;
            const std::size_t row = impacts ? turns_[i] : i;
            notes_.push_back({row + added_, wrapped(typeset_sentence(*event.certificate), width)});
            added_ += notes_.back().lines.size();
        }
    }
    std::size_t size() const { return count_ + added_; }
    Row at(std::size_t index) const {
        std::size_t before = 0;  // lines of certificates above
        for (const Note& note : notes_) {
            if (index <= note.row) break;
            const std::size_t line = index - note.row - 1;
            if (line < note.lines.size()) return {event_of(note.row - before), note.lines[line]};
            before += note.lines.size();
        }
        return {event_of(index - before), ""};
    }
    // The first row of this event, or of the next one that has a row.
    std::size_t row_of(std::size_t event) const {
        const auto turn = std::lower_bound(turns_.begin(), turns_.end(), event);
        std::size_t row = impacts_ ? event : static_cast<std::size_t>(turn - turns_.begin());
        for (const Note& note : notes_)
            if (note.row < row) row += note.lines.size();
        return row;
    }

 private:
    struct Note {
        std::size_t row;  // of its event
        std::vector<std::string> lines;
    };
    std::size_t event_of(std::size_t plain_row) const { return impacts_ ? plain_row : turns_[plain_row]; }

    bool impacts_;
    std::vector<std::size_t> turns_;
    std::vector<Note> notes_;
    std::size_t count_ = 0, added_ = 0;
};

// The last event that the present has reached, or none.
int reached(const Session& session) {
    const auto& events = session.trajectory().events;
    const auto later = std::upper_bound(events.begin(), events.end(), session.time(),
                                        [](double t, const Event& event) { return t < event.t; });
    return static_cast<int>(later - events.begin()) - 1;
}

// The coordinates after an event, and the rates where they fit too.
std::string state_text(const Session& session, const Event& event, float width) {
    const auto& coordinates = session.description().coordinates;
    const State& scale = session.scale();
    std::string positions, rates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? degrees(1.0) : 1.0;
        const auto at = static_cast<Eigen::Index>(i);
        positions +=
            fmt::format("{}{} = {}{}", i == 0 ? "" : ",  ", typeset_name(coordinates[i].name),
                        number(without_noise(event.q[at], scale.q[at]) * factor, "{:.5g}"), is_angle ? "\u00b0" : "");
        rates += fmt::format(",  {} = {}{}", typeset_name(coordinates[i].name + "'"),
                             number(without_noise(event.v_after[at], scale.v[at]) * factor, "{:.5g}"),
                             is_angle ? "\u00b0/s" : "");
    }
    const std::string all = positions + rates;
    return fitted(label_width(all, ImGui::GetFontSize()) <= width ? all : positions, width);
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

void show_header(const Session& session, PanelState& state, Commands& commands) {
    const bool with_state = !has_card(session);
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    const float left = ImGui::GetCursorPosX() + units(list_padding);
    const float right = ImGui::GetContentRegionMax().x;
    const float width =
        ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("impacts").x;
    const float buttons = right - width - units(16.0F) - comparing_width();
    ImGui::AlignTextToFramePadding();
    for (const auto& [at, text] : {std::pair{number_at, "#"}, std::pair{kind_at, "event"}, std::pair{time_at, "t (s)"},
                                   std::pair{speed_at, "gap speed"}, std::pair{state_at, "state after it"}}) {
        if (!with_state && at >= speed_at) continue;  // a certificate stands there
        if (left + units(at) + ImGui::CalcTextSize(text).x > buttons) break;
        if (at != number_at) ImGui::SameLine();
        ImGui::SetCursorPosX(left + units(at));
        ImGui::TextUnformatted(text);
    }
    ImGui::PopStyleColor();
    ImGui::SameLine(right - width - units(4.0F));
    ImGui::Checkbox("impacts", &state.show_impacts);
    remember(state, "impacts");
    tooltip("list the impacts, or only Zeno points and releases");
    show_comparing(session, buttons, state, commands);
}

void paint_event(const Session& session, std::size_t index, ImVec2 at) {
    const float right = ImGui::GetContentRegionAvail().x;
    const Event& event = session.trajectory().events[index];
    ImDrawList* list = ImGui::GetWindowDrawList();
    Markers markers = event_markers(session.theme(), event.kind);
    paint_marker(list, markers, {at.x + units(sign_at), at.y + 0.5F * ImGui::GetTextLineHeight()}, units(1.0F));
    const auto cell = [&](float x, const std::string& text, const Color& color) {
        list->AddText({std::floor(at.x + units(x)), at.y}, packed(color), text.c_str());
    };
    cell(number_at, std::to_string(index + 1), faint_color());
    cell(kind_at, is_plastic_landing(event) ? "landing" : markers.label, text_color());
    cell(time_at, number(event.t, "{:.9f}"), text_color());
    if (has_card(session)) return;
    cell(speed_at, event.kind == Event::Kind::impact ? number(event.impact_speed) : "\u2013", text_color());
    paint_label(list, std::floor(at.x + units(state_at)), at.y,
                state_text(session, event, right - units(state_at + 20.0F)), text_color(), ImGui::GetFontSize());
}

void show_row(const Session& session, const Row& row, int index, bool is_reached, PanelState& state,
              Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const int event_number = static_cast<int>(row.event) + 1;
    const bool is_event = row.certificate.empty();
    const bool is_selected = session.selected() == event_number || (session.selected() == 0 && is_reached);
    ImGui::PushID(index);  // not its address, which another frame gives to another row
    // Another click on the chosen event lets go of it.
    if (ImGui::Selectable("##row", is_selected))
        commands.emplace_back(command::Select{session.selected() == event_number ? 0 : event_number});
    ImGui::PopID();
    if (is_event) remember(state, "event " + std::to_string(event_number));
    if (is_event)
        paint_event(session, row.event, at);
    else
        ImGui::GetWindowDrawList()->AddText({std::floor(at.x + units(kind_at)), at.y},
                                            packed(is_selected ? text_color() : faint_color()),
                                            row.certificate.c_str());
}

// Scrolls so that the row is seen, once whenever another row is the one to see.
void follow(const Rows& all, int event, PanelState& state) {
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

void show_events(const Session& session, PanelState& state, Commands& commands) {
    show_header(session, state, commands);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, packed(session.theme().background));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(list_padding), units(6.0F)});
    // As high as whole lines are.
    const float line = ImGui::GetTextLineHeightWithSpacing(), room = ImGui::GetContentRegionAvail().y - units(12.0F);
    const float height = std::max(1.0F, std::floor((room + ImGui::GetStyle().ItemSpacing.y) / line)) * line +
                         units(12.0F) - ImGui::GetStyle().ItemSpacing.y;
    const auto event = chosen(session);
    const float list_width = has_card(session) ? units(speed_at) : 0.0F;
    ImGui::BeginChild("list", {list_width, height}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    const float width = ImGui::GetContentRegionAvail().x - units(kind_at + 16.0F);
    const Rows all(session, state.show_impacts, width);
    const int present = reached(session);
    if (all.size() == 0) ImGui::TextDisabled("  nothing happens in this run");
    follow(all, session.selected() > 0 ? session.selected() - 1 : std::max(present, 0), state);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(all.size()), ImGui::GetTextLineHeightWithSpacing());
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const Row row = all.at(static_cast<std::size_t>(i));
            show_row(session, row, i, static_cast<int>(row.event) == present, state, commands);
        }
    ImGui::EndChild();
    if (has_card(session)) {
        ImGui::SameLine(0.0F, units(8.0F));
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(12.0F), units(5.0F)});
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, units(2.0F)});
        ImGui::BeginChild("card", {0.0F, height}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
        if (event)
            show_card_of_event(session, *event, state, commands);
        else
            show_comparison(session, state, commands);
        ImGui::EndChild();
        ImGui::PopStyleVar(2);
    }
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

}  // namespace achilles
