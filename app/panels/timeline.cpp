// The timeline below the mechanism: phases as bands, event markers, and the player.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/axes.hpp"
#include "paint/paint.hpp"
#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "session/event_rows.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// Heights of the timeline's parts, from the top, at scale 1.
constexpr float marks = 18.0F, band = 12.0F, axis = 24.0F, space = 6.0F;

// Maps time to pixels.
struct Track {
    float left, width, top;
    double start, end;
    float x(double t) const { return left + static_cast<float>((t - start) / (end - start)) * width; }
    double time(float x) const { return start + double{(x - left) / width} * (end - start); }
};

void paint_phases(const Session& session, const Track& track, ImDrawList* list) {
    const float top = track.top + units(marks), bottom = top + units(band);
    for (const Phase& phase : session.trajectory().phases)
        list->AddRectFilled(
            {track.x(phase.start), top}, {std::max(track.x(phase.end), track.x(phase.start) + 1.0F), bottom},
            packed(phase_color(session.theme(), look_of(*session.model(), phase.kind, phase.mode)), 0.85F));
    // The part after an early stop.
    const float done = track.x(session.trajectory().end_time);
    list->AddRect({done, top}, {track.left + track.width, bottom}, ImGui::GetColorU32(ImGuiCol_Border));
}

void paint_events(const Session& session, const Track& track, ImDrawList* list) {
    const float top = track.top + units(marks);
    const double scale = units(1.0F);
    const ImU32 ink = packed(phase_color(session.theme(), Phase::Kind::hybrid));
    // Impacts closer than a pixel share one tick; skip to the next pixel.
    const auto& events = session.trajectory().events;
    for (auto event = events.begin(); event != events.end();) {
        if (!event->is_impact()) {
            ++event;
            continue;
        }
        const float pixel = std::floor(track.x(event->t)), x = pixel + 0.5F;
        list->AddLine({x, top - units(7.0F)}, {x, top - units(1.0F)}, ink, std::max(1.0F, std::floor(units(1.0F))));
        event = std::partition_point(event, events.end(),
                                     [&](const Event& e) { return std::floor(track.x(e.t)) <= pixel; });
    }
    // At most one marker in a few pixels, of Zeno points first.
    std::vector<float> taken;
    const std::vector<std::size_t> all = turns(session.trajectory());
    for (const bool of_zeno : {true, false})
        for (const std::size_t turn : all) {
            const float x = track.x(events[turn].t), least = units(static_cast<float>(event_marker_distance));
            if (events[turn].is_zeno() != of_zeno ||
                std::any_of(taken.begin(), taken.end(), [&](float other) { return std::abs(x - other) < least; }))
                continue;
            taken.push_back(x);
            paint_marker(list, event_markers(session.theme(), events[turn].kind), {x, top - units(8.0F)}, scale);
        }
}

void paint_axis(const Session& session, const Track& track, ImDrawList* list) {
    Axis time;
    set_ticks(time, track.start, track.end, 0.0, static_cast<int>(track.width / units(70.0F)));
    const float top = track.top + units(marks + band);
    for (const Tick& tick : time.ticks) {
        if (tick.label.empty()) continue;
        const float x = std::floor(track.x(tick.value)) + 0.5F;
        list->AddLine({x, top}, {x, top + units(4.0F)}, packed(faint_color()));
        const float width = ImGui::CalcTextSize(tick.label.c_str()).x;
        const float at = std::clamp(x - 0.5F * width, track.left - units(4.0F), track.left + track.width - width);
        list->AddText({std::floor(at), top + units(5.0F)}, packed(faint_color()), tick.label.c_str());
    }
    // The current time: a vertical line with a handle.
    const float x = std::floor(track.x(session.time())) + 0.5F;
    const float head = units(5.0F);
    list->AddLine({x, track.top + units(1.0F)}, {x, top + units(4.0F)}, packed(text_color()), units(1.5F));
    list->AddTriangleFilled({x - head, track.top - units(4.0F)}, {x + head, track.top - units(4.0F)},
                            {x, track.top + units(5.0F)}, packed(text_color()));
}

// Shows the tooltip of the last item above it, since a tooltip below it would cover the timeline.
void tooltip_above(const std::string& text) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    tooltip(text, {low.x, low.y, high.x - low.x, high.y - low.y}, true);
}

void play_button(const Session& session, PanelState& state, Commands& commands) {
    const ImVec2 size{units(40.0F), ImGui::GetFrameHeight()};
    if (ImGui::Button("##play", size)) perform(action("Play"), session, state, commands);
    remember(state, "play");
    tooltip_above(session.playing() ? "pause (space)" : "play (space)");
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    paint_play_sign({0.5F * (low.x + high.x), 0.5F * (low.y + high.y)}, session.playing());
}

// A small button with a triangle and a bar.
bool step_button(const char* name, float side, const char* about, PanelState& state) {
    const ImVec2 size{units(28.0F), ImGui::GetFrameHeight()};
    const bool pressed = ImGui::Button((std::string("##") + name).c_str(), size);
    remember(state, name);
    tooltip_above(about);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 c{0.5F * (low.x + high.x), 0.5F * (low.y + high.y)};
    const float r = units(4.5F) * side;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddTriangleFilled({c.x - r, c.y - units(4.5F)}, {c.x - r, c.y + units(4.5F)}, {c.x + 0.7F * r, c.y},
                            packed(text_color()));
    const float bar = c.x + r, width = units(2.0F);
    list->AddRectFilled({bar - 0.5F * width, c.y - units(4.5F)}, {bar + 0.5F * width, c.y + units(4.5F)},
                        packed(text_color()));
    return pressed;
}

// Playback speed, 1/1000 to 10, logarithmic.
void speed_slider(const Session& session, PanelState& state, Commands& commands) {
    auto speed = static_cast<float>(session.scene().speed());
    // Leave room for the number.
    const float room = ImGui::GetContentRegionAvail().x - units(56.0F);
    if (room < units(24.0F)) return ImGui::NewLine();
    ImGui::SetNextItemWidth(std::min(units(84.0F), room));
    const auto low = static_cast<float>(command::slowest), high = static_cast<float>(command::fastest);
    if (ImGui::SliderFloat("##speed", &speed, low, high, "",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
        // Round to two digits, and snap to 1.
        const double unit = std::pow(10.0, std::floor(std::log10(double{speed})) - 1.0);
        double rounded = std::round(double{speed} / unit) * unit;
        if (std::abs(std::log(rounded)) < 0.12) rounded = 1.0;
        commands.emplace_back(command::Speed{std::clamp(rounded, command::slowest, command::fastest)});
    }
    remember(state, "speed");
    if (owns_keys(state, "speed")) {
        const int steps = (is_pressed(key::right) ? 1 : 0) - (is_pressed(key::left) ? 1 : 0);
        state.focus.is_owned = steps != 0;  // other keys move the focus
        const double next = std::pow(10.0, 0.1 * std::round(10.0 * std::log10(session.scene().speed()) + steps));
        if (steps != 0) commands.emplace_back(command::Speed{std::clamp(next, command::slowest, command::fastest)});
    }
    tooltip_above("playback speed; right click: real time");
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) commands.emplace_back(command::Speed{1.0});
    const std::string text = fmt::format("{:.3g}\u00d7", session.scene().speed());
    ImGui::SameLine(0.0F, units(6.0F));
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
}

// At the right end of the line, if there is room.
void loop_box(const Session& session, PanelState& state, Commands& commands) {
    const float width = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("loop").x;
    ImGui::SameLine();
    const float left = content_right() - width - units(4.0F);
    if (left < ImGui::GetCursorPosX()) return ImGui::NewLine();
    ImGui::SetCursorPosX(left);
    bool loops = session.scene().loops();
    if (ImGui::Checkbox("loop", &loops)) commands.emplace_back(command::Loop{loops});
    remember(state, "loop");
    tooltip_above("start again at the end of the run");
}

// The event whose marker is under the mouse.
std::optional<int> event_at(const Session& session, const Track& track) {
    const auto& events = session.trajectory().events;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float top = track.top + units(marks), reach = units(marker_reach);
    NearestEvent nearest(mouse, reach);
    const auto at = [&](float x) {
        return std::lower_bound(events.begin(), events.end(), track.time(x),
                                [](const Event& event, double t) { return event.t < t; });
    };
    // For impacts, whose marker is a tick, test the nearest ones.
    const float tick = std::clamp(mouse.y, top - units(7.0F), top - units(1.0F));
    const auto here = at(mouse.x);
    for (auto event = here, end = at(mouse.x + reach); event < end; ++event)
        if (event->is_impact()) {
            nearest.ask(static_cast<int>(event - events.begin()) + 1, *event, track.x(event->t), tick);
            break;
        }
    for (auto event = here, end = at(mouse.x - reach); event > end;)
        if ((--event)->is_impact()) {
            nearest.ask(static_cast<int>(event - events.begin()) + 1, *event, track.x(event->t), tick);
            break;
        }
    for (const std::size_t turn : turns(session.trajectory()))
        nearest.ask(static_cast<int>(turn) + 1, events[turn], track.x(events[turn].t), top - units(8.0F));
    return nearest.found();
}

// A press on an event marker selects the event; dragging moves the time, as elsewhere.
void use_events(const Session& session, const Track& track, PanelState& state, Commands& commands) {
    constexpr float slip = 4.0F;
    const bool is_hovered = ImGui::IsItemHovered();
    if (is_hovered && !ImGui::IsAnyMouseDown())
        if (const auto event = event_at(session, track)) name_event(session, *event);
    if (ImGui::IsItemActivated()) {
        const auto event = event_at(session, track);
        state.on_marker = event.has_value();
        if (event) commands.emplace_back(command::Select{*event});
    }
    const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0.0F);
    if (!ImGui::IsItemActive() || std::hypot(moved.x, moved.y) > slip) state.on_marker = false;
}

}  // namespace

float timeline_height() {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y + units(space + marks + band + axis);
}

void show_timeline(const Session& session, PanelState& state, Commands& commands) {
    const float between = units(4.0F);
    play_button(session, state, commands);
    ImGui::SameLine(0.0F, between);
    if (step_button("step back", -1.0F, "previous event (left arrow)", state))
        perform(action("Previous event"), session, state, commands);
    ImGui::SameLine(0.0F, between);
    if (step_button("step on", 1.0F, "next event (right arrow)", state))
        perform(action("Next event"), session, state, commands);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    // Reserve the maximum width, so that the following items do not move.
    const float clock_at = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(fmt::format("t = {:.3f} s", session.time()).c_str());
    ImGui::SameLine(
        clock_at +
        ImGui::CalcTextSize(fmt::format("t = {:.3f} s", 8.0 + 10.0 * session.run().options.end_time).c_str()).x);
    speed_slider(session, state, commands);
    loop_box(session, state, commands);

    const Rectangle area = remaining();
    const float inset = units(8.0F);
    const Options& options = session.trajectory().run.options;
    const Track track{area.x + inset, std::max(1.0F, area.width - 2.0F * inset), area.y + units(space),
                      options.start_time, std::max(options.end_time, session.trajectory().end_time)};
    ImGui::InvisibleButton("timeline", {area.width, units(space + marks + band + axis)});
    remember(state, "timeline");
    use_events(session, track, state, commands);
    double time = 0.0;
    if (!state.on_marker && dragged_to(track.start, track.end, track.left, track.width, time) && time != session.time())
        move_time(session, time, commands);
    ImDrawList* list = ImGui::GetWindowDrawList();
    paint_phases(session, track, list);
    paint_events(session, track, list);
    fade_beyond(session, {track.left, track.top, track.width, units(marks + band)}, track.start, track.end,
                session.theme().page);
    paint_axis(session, track, list);
}

}  // namespace achilles
