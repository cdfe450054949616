// The centre: the mechanism as it is now, and the timeline below it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "figure/ticks.hpp"
#include "paint/marker.hpp"
#include "paint/mechanism.hpp"
#include "panels/widgets.hpp"

namespace achilles {

namespace {

// The heights of the timeline's parts, from the top, at scale 1.
constexpr float marks = 18.0F, band = 12.0F, axis = 24.0F, space = 6.0F;

// Time to pixels along the band.
struct Track {
    float left, width, top;
    double end;
    float x(double t) const { return left + static_cast<float>(t / end) * width; }
};

void paint_phases(const Session& session, const Track& track, ImDrawList* list) {
    const float top = track.top + units(marks), bottom = top + units(band);
    for (const Phase& phase : session.trajectory().phases)
        list->AddRectFilled({track.x(phase.start), top},
                            {std::max(track.x(phase.end), track.x(phase.start) + 1.0F), bottom},
                            packed(phase_color(session.theme(), phase.kind), 0.85F));
    // What an early stop left undone.
    const float done = track.x(session.trajectory().end_time);
    list->AddRect({done, top}, {track.left + track.width, bottom}, ImGui::GetColorU32(ImGuiCol_Border));
}

void paint_events(const Session& session, const Track& track, ImDrawList* list) {
    const float top = track.top + units(marks);
    const double scale = units(1.0F);
    const ImU32 ink = packed(phase_color(session.theme(), Phase::Kind::hybrid));
    float last = -10.0F;
    for (const Event& event : session.trajectory().events) {
        // Impacts closer than a pixel are one tick.
        const float x = std::floor(track.x(event.t)) + 0.5F;
        if (event.kind != Event::Kind::impact || x == last) continue;
        list->AddLine({x, top - units(7.0F)}, {x, top - units(1.0F)}, ink, std::max(1.0F, std::floor(units(1.0F))));
        last = x;
    }
    for (const Event& event : session.trajectory().events) {
        if (event.kind == Event::Kind::impact) continue;
        paint_marker(list, event_markers(session.theme(), event.kind), {track.x(event.t), top - units(8.0F)}, scale);
    }
}

void paint_axis(const Session& session, const Track& track, ImDrawList* list) {
    Axis time;
    set_ticks(time, 0.0, track.end, 0.0, static_cast<int>(track.width / units(70.0F)));
    const float top = track.top + units(marks + band);
    for (const Tick& tick : time.ticks) {
        if (tick.label.empty()) continue;
        const float x = std::floor(track.x(tick.value)) + 0.5F;
        list->AddLine({x, top}, {x, top + units(4.0F)}, packed(faint_color()));
        const float width = ImGui::CalcTextSize(tick.label.c_str()).x;
        const float at = std::clamp(x - 0.5F * width, track.left - units(4.0F), track.left + track.width - width);
        list->AddText({std::floor(at), top + units(5.0F)}, packed(faint_color()), tick.label.c_str());
    }
    // The present: a line through everything, with a head to hold.
    const float x = std::floor(track.x(session.time())) + 0.5F;
    const float head = units(5.0F);
    list->AddLine({x, track.top + units(1.0F)}, {x, top + units(4.0F)}, packed(text_color()), units(1.5F));
    list->AddTriangleFilled({x - head, track.top - units(4.0F)}, {x + head, track.top - units(4.0F)},
                            {x, track.top + units(5.0F)}, packed(text_color()));
}

// Play or pause. A pause names its instant, so that a replayed journal stops at the same picture.
void play_button(const Session& session, PanelState& state, Commands& commands) {
    const ImVec2 size{units(40.0F), ImGui::GetFrameHeight()};
    const bool pressed = ImGui::Button("##play", size);
    remember(state, "play");
    tooltip(session.playing() ? "pause (space)" : "play (space)");
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 c{0.5F * (low.x + high.x), 0.5F * (low.y + high.y)};
    const float r = units(5.5F);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (session.playing()) {
        for (const float side : {-1.0F, 0.4F})
            list->AddRectFilled({c.x + side * r, c.y - r}, {c.x + (side + 0.6F) * r, c.y + r}, packed(text_color()));
    } else {
        list->AddTriangleFilled({c.x - 0.7F * r, c.y - r}, {c.x - 0.7F * r, c.y + r}, {c.x + r, c.y},
                                packed(text_color()));
    }
    const bool space_pressed = !ImGui::GetIO().WantTextInput && ImGui::IsKeyPressed(' ', false);
    if (!pressed && !space_pressed) return;
    if (session.playing())
        commands.insert(commands.end(), {command::Pause{}, command::Seek{session.time()}});
    else
        commands.emplace_back(command::Play{});
}

// At the right end of the line.
void loop_box(PanelState& state) {
    const float width = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("loop").x;
    ImGui::SameLine(std::max(ImGui::GetContentRegionMax().x - width - units(4.0F), units(160.0F)));
    ImGui::Checkbox("loop", &state.loop);
    remember(state, "loop");
    tooltip("begin again at the end of the run");
}

// The state at this instant in numbers, above the picture: the phase and the coordinates, their rates below. Returns
// the height it took.
float show_state(const Session& session, ImVec2 at, float width) {
    constexpr float first = 130.0F, column = 130.0F;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing();
    const Phase::Kind phase = session.now().phase;
    const Color color = phase_color(session.theme(), phase);
    list->AddRectFilled({at.x, at.y + 0.25F * size}, {at.x + units(10.0F), at.y + 0.25F * size + units(10.0F)},
                        packed(color), units(2.0F));
    paint_label(list, at.x + units(16.0F), at.y, legend_text(phase), text_color(), size);
    const auto& coordinates = session.description().coordinates;
    const auto columns = static_cast<std::size_t>(std::max(1.0F, (width - units(first)) / units(column)));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? 57.29577951308232 : 1.0;
        const auto index = static_cast<Eigen::Index>(i);
        const std::string unit = is_angle ? "\u00b0" : coordinates[i].unit.empty() ? "" : " " + coordinates[i].unit;
        const std::string rate_unit = unit.empty() ? "" : unit + "/s";
        const float x = at.x + units(first + column * static_cast<float>(i % columns));
        const float y = at.y + 2.0F * line * static_cast<float>(i / columns);
        const auto text = [&](const std::string& name, double value, const std::string& of) {
            return typeset_name(name) + " = " + number(value * factor, "{:.3f}") + of;
        };
        paint_label(list, x, y, text(coordinates[i].name, session.now().state.q[index], unit), text_color(), size);
        paint_label(list, x, y + line, text(coordinates[i].name + "'", session.now().state.v[index], rate_unit),
                    faint_color(), size);
    }
    const std::size_t rows = (coordinates.size() + columns - 1) / columns;
    return 2.0F * line * static_cast<float>(std::max<std::size_t>(rows, 1)) + units(8.0F);
}

}  // namespace

void show_mechanism(const Session& session) {
    const Rectangle area = remaining();
    if (area.width < 2.0F || area.height < 2.0F) return;
    ImGui::GetWindowDrawList()->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(session.theme().background), units(4.0F));
    const float strip = show_state(session, {area.x + units(12.0F), area.y + units(8.0F)}, area.width - units(24.0F));
    const Drawing drawing = session.mechanism().draw(session.now().state, session.trajectory().run.parameters,
                                                     session.limits(), session.theme());
    paint(drawing, ImGui::GetWindowDrawList(), {area.x, area.y + strip, area.width, area.height - strip}, units(1.0F));
}

float timeline_height() {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y + units(space + marks + band + axis);
}

void show_timeline(const Session& session, PanelState& state, Commands& commands) {
    play_button(session, state, commands);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(fmt::format("t = {:.3f} s", session.time()).c_str());
    loop_box(state);

    const Rectangle area = remaining();
    const float inset = units(8.0F);
    const Track track{area.x + inset, std::max(1.0F, area.width - 2.0F * inset), area.y + units(space),
                      std::max(session.trajectory().run.options.end_time, session.trajectory().end_time)};
    ImGui::InvisibleButton("timeline", {area.width, units(space + marks + band + axis)});
    remember(state, "timeline");
    double time = 0.0;
    if (dragged_to(0.0, track.end, track.left, track.width, time) && time != session.time())
        commands.emplace_back(command::Seek{time});
    ImDrawList* list = ImGui::GetWindowDrawList();
    paint_phases(session, track, list);
    paint_events(session, track, list);
    paint_axis(session, track, list);
}

}  // namespace achilles
