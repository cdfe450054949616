// The state and the energies at the current time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "figure/label.hpp"
#include "figure/mechanism_scene.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"
#include "session/energy_course.hpp"

namespace achilles {

// ---- above the mechanism: phase, coordinates, and rates below them ----

namespace {

constexpr float edge_of_state = 12.0F, above_state = 8.0F, below_state = 8.0F, phase_width = 130.0F,
                state_width = 130.0F;

// In a narrow panel each coordinate has its own line, with its rate beside it.
bool is_narrow(float width) { return width < units(390.0F); }

// A coordinate or rate in display form.
struct StateValue {
    std::string name, value;
    float width = 0.0F;  // of the longest value that the run may need, with its name
};

StateValue value_of(const Session& session, std::size_t i, bool is_rate) {
    const CoordinateDescription& c = session.description().coordinates[i];
    const bool is_angle = c.unit == "rad";
    const double factor = is_angle ? degrees(1.0) : 1.0;
    const auto at = static_cast<Eigen::Index>(i);
    std::string unit = is_angle ? "\u00b0" : c.unit.empty() ? "" : " " + c.unit;
    if (is_rate && !unit.empty()) unit += "/s";
    const double scale = (is_rate ? session.scale().v : session.scale().q)[at] * factor;
    const State errors = session.precision().of_state(session.now().t);
    const double error = (is_rate ? errors.v : errors.q)[at] * factor;
    const auto text = [&](double value) { return " = " + number_of_size(value, scale, 3, error) + unit; };
    StateValue shown{typeset_name(c.name + (is_rate ? "'" : "")),
                     text((is_rate ? session.now().state.v : session.now().state.q)[at] * factor), 0.0F};
    shown.width = label_width(shown.name + " = " + number_of_size(-scale, scale, 3) + unit, ImGui::GetFontSize());
    return shown;
}

// Column width of the wide layout: as the values need, if at least two columns fit.
float column_of_state(const Session& session, float width) {
    float wanted = units(state_width);
    for (std::size_t i = 0; i < session.description().coordinates.size(); ++i)
        for (const bool is_rate : {false, true})
            wanted = std::max(wanted, value_of(session, i, is_rate).width + units(14.0F));
    return std::min(wanted, std::max(units(state_width), 0.5F * (width - units(phase_width))));
}

std::size_t columns_of_state(const Session& session, float width) {
    return static_cast<std::size_t>(
        std::max(1.0F, (width - units(phase_width)) / column_of_state(session, width) + 1e-3F));
}

}  // namespace

float state_height(const Session& session, float panel_width) {
    const float width = panel_width - 2.0F * units(edge_of_state);
    const std::size_t count = session.description().coordinates.size(), columns = columns_of_state(session, width);
    const std::size_t lines =
        is_narrow(width) ? count + 1 : 2 * std::max<std::size_t>((count + columns - 1) / columns, 1);
    return ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(lines) + units(below_state);
}

void show_state(const Session& session, const Rectangle& panel) {
    const ImVec2 at{panel.x + units(edge_of_state), panel.y + units(above_state)};
    const float width = panel.width - 2.0F * units(edge_of_state);
    const bool narrow = is_narrow(width);
    const float bottom = panel.y + panel.height;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing();
    const PhaseLabel phase = phase_label(*session.model(), session.now());
    const Color color = phase_color(session.theme(), phase.color);
    list->AddRectFilled({at.x, at.y + 0.25F * size}, {at.x + units(10.0F), at.y + 0.25F * size + units(10.0F)},
                        packed(color), units(2.0F));
    paint_label(list, at.x + units(16.0F), at.y, phase.text, text_color(), size);
    const std::size_t count = session.description().coordinates.size(), columns = columns_of_state(session, width);
    const float column = narrow ? 0.5F * (width - units(16.0F)) : column_of_state(session, width);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = at.x + (narrow ? units(16.0F) : units(phase_width) + column * static_cast<float>(i % columns));
        const float y = at.y + line * static_cast<float>(narrow ? i + 1 : 2 * (i / columns));
        for (const bool is_rate : {false, true}) {
            const StateValue shown = value_of(session, i, is_rate);
            const ImVec2 corner{is_rate && narrow ? x + column : x, is_rate && !narrow ? y + line : y};
            if (corner.y + size > bottom) continue;  // the panel is too low for all values
            cell(corner, shown.name, shown.value, column - units(8.0F), is_rate ? faint_color() : text_color());
        }
    }
}

// The energy panel between results and player: current energies as a bar and in numbers, and their history on the time
// axis of the player. Kinetic energy has the color of the velocity arrow, impact losses that of the impact markers, and
// heat that of phases that slip.

namespace {

constexpr float energy_padding = 6.0F, gap = 4.0F, bar_height = 9.0F, course_height = 40.0F, inset = 8.0F;

struct EnergyPart {
    const char *name, *about;
    Color color;
    float alpha;
};
// The last part is striped, to distinguish its gray from the other.
constexpr std::size_t striped = 4;

std::array<EnergyPart, 5> parts(const Theme& theme) {
    return {{{"kinetic", "kinetic energy", theme.ink, 0.85F},
             {"potential", "potential energy; the bar shows the part above the minimum of this run", theme.ink, 0.3F},
             {"impact loss", "energy lost in all impacts and in the restarts at Zeno points",
              phase_color(theme, Phase::Kind::hybrid), 0.75F},
             {"friction heat", "heat of dry friction, in contact and at impacts", phase_color(theme, PhaseLook::slip),
              0.85F},
             {"work done",
              "work of forces and of moving surfaces: energy removed is part of the bar, energy added extends beyond "
              "the line, which marks the initial energy",
              theme.faint, 0.8F}}};
}

void fill(const EnergyPart& part, bool stripes, ImVec2 low, ImVec2 high) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (!stripes) return list->AddRectFilled(low, high, packed(part.color, part.alpha));
    const float step = std::max(2.0F, std::floor(units(2.0F)));
    list->AddRectFilled(low, high, packed(part.color, 0.15F));
    for (float x = low.x; x < high.x; x += 2.0F * step)
        list->AddRectFilled({x, low.y}, {std::min(x + step, high.x), high.y}, packed(part.color, 0.8F));
}

std::string valued(const Session& session, double value, double error) {
    const std::string unit = typeset_unit(session.sentences().energy_unit());
    const double size = 10.0 * std::max(session.sentences().energy_scale(), std::abs(session.trajectory().loss));
    const std::string text = std::isfinite(value) ? number(flush_noise_to_zero(value, size), error, 4) : "\u2013";
    return unit.empty() ? text : text + " " + unit;
}

bool has_forces(const Session& session) { return session.model()->equations().has_power(); }

std::array<double, 5> values(const Energies& now) { return {now.kinetic, now.potential, now.loss, now.heat, now.work}; }

// The parts that a system has: heat with friction, work with forces.
std::vector<std::size_t> shown_parts(const Session& session) {
    std::vector<std::size_t> shown{0, 1, 2};
    if (session.model()->has_friction()) shown.push_back(3);
    if (has_forces(session)) shown.push_back(4);
    return shown;
}

// Each name above its value, in columns.
void show_numbers(const Session& session, const Energies& now, const Rectangle& area) {
    const std::vector<std::size_t> shown = shown_parts(session);
    const float width = area.width / static_cast<float>(shown.size()), line = ImGui::GetTextLineHeight();
    const auto all = parts(session.theme());
    const auto its = values(now);
    const double error = session.precision().of_energy(session.now());
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const std::size_t i = shown[k];
        const ImVec2 at{area.x + static_cast<float>(k) * width, area.y};
        const float sign = units(9.0F), words = units(14.0F);
        const float top = std::floor(at.y + 0.5F * (line - sign));
        fill(all[i], i == striped, {at.x, top}, {at.x + sign, top + sign});
        cell({std::floor(at.x + words), at.y}, all[i].name, width - words - units(4.0F), faint_color());
        cell({std::floor(at.x + words), at.y + ImGui::GetTextLineHeightWithSpacing()}, valued(session, its[i], error),
             width - words - units(4.0F), text_color());
        ImGui::SetCursorScreenPos(at);
        ImGui::Dummy({width, 2.0F * ImGui::GetTextLineHeightWithSpacing()});
        tooltip(all[i].about);
    }
}

// Length of a value in proportion to the whole.
float length(double value, double full, float whole) {
    return full > 0.0 && std::isfinite(value) ? static_cast<float>(std::clamp(value / full, 0.0, 1.0)) * whole : 0.0F;
}

void show_bar_of(const Session& session, const EnergyCourse& course, const Energies& now, const Rectangle& area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto all = parts(session.theme());
    const auto ends = course.stack(now);
    const auto x = area.x, width = area.width;
    const auto top = area.y, bottom = area.y + area.height;
    list->AddRectFilled({x, top}, {x + width, bottom}, packed(session.theme().grid, 0.5F));
    float from = x;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const float to = std::max(from, x + length(ends[i], course.full(), width));
        if (to > from) fill(all[i], i == striped, {from, top}, {to, bottom});
        from = to;
    }
    if (!has_forces(session)) return;
    const float start = std::floor(x + length(course.at_start(), course.full(), width)) + 0.5F;
    list->AddLine({start, top - units(2.0F)}, {start, bottom + units(2.0F)}, packed(text_color()), units(1.5F));
}

// The energies over the run, one pixel column at a time, with a line at the current time.
void paint_course(const Session& session, const EnergyCourse& course, const Rectangle& area, double start, double end) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto all = parts(session.theme());
    const auto left = area.x, width = area.width;
    const auto top = area.y, height = area.height, bottom = top + height;
    const double reached = session.trajectory().end_time;
    std::array<ImU32, 5> colors{};
    for (std::size_t i = 0; i < all.size(); ++i) colors[i] = packed(all[i].color, all[i].alpha);
    const float stripe = std::max(2.0F, std::floor(units(2.0F)));
    const ImU32 between = packed(all[striped].color, 0.15F);
    for (float x = 0.0F; x + 1.0F <= width; x += 1.0F) {
        const double t = start + double{(x + 1.0F) / width} * (end - start);
        if (t > reached + (end - start) / width) break;
        const auto ends = course.stack(course.before(t));
        float from = bottom;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const float to = std::min(from, bottom - length(ends[i], course.full(), height));
            const ImU32 color = i == striped && std::fmod(x, 2.0F * stripe) >= stripe ? between : colors[i];
            if (to < from) list->AddRectFilled({left + x, to}, {left + x + 1.0F, from}, color);
            from = to;
        }
    }
    fade_beyond(session, {left, top, width, height}, start, end, session.theme().background);
    const float now = std::floor(left + static_cast<float>((session.time() - start) / (end - start)) * width) + 0.5F;
    list->AddLine({now, top}, {now, bottom}, packed(session.theme().background), units(4.0F));
    list->AddLine({now, top}, {now, bottom}, packed(text_color()), units(1.5F));
}

// Tooltip: the energies at the time under the mouse, and the loss of the last event before it.
std::string energy_tooltip(const Session& session, const EnergyCourse& course, double t) {
    const auto its = values(course.before(t));
    const auto all = parts(session.theme());
    std::string text = fmt::format("t = {:.6g} s", t);
    const double error = session.precision().of_energy(session.at(t));
    for (const std::size_t i : shown_parts(session))
        text += fmt::format("\n{} {}", all[i].name, valued(session, its[i], error));
    const auto& events = session.trajectory().events;
    const auto after =
        std::upper_bound(events.begin(), events.end(), t, [](double at, const Event& event) { return at < event.t; });
    if (after == events.begin()) return text;
    const auto event = static_cast<std::size_t>(after - events.begin()) - 1;
    return text + fmt::format("\nevent {}: {}", event + 1, typeset_sentence(session.sentences().of(event)));
}

}  // namespace

float energy_height(bool with_course) {
    const float numbers = 2.0F * ImGui::GetTextLineHeightWithSpacing();
    return std::floor(2.0F * units(energy_padding) + numbers + units(gap + bar_height) +
                      (with_course ? units(gap + course_height) : 0.0F));
}

void show_energy(const Session& session, PanelState& state, Commands& commands) {
    if (state.energy == nullptr || !state.energy->is_of(session))
        state.energy = std::make_shared<EnergyCourse>(session);
    EnergyCourse& course = *state.energy;
    const Rectangle area = remaining();
    ImGui::GetWindowDrawList()->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                              packed(session.theme().background), units(4.0F));
    if (course.empty()) return;
    const Energies now = course.at(session.now());
    const float edge = units(inset), line = ImGui::GetTextLineHeightWithSpacing();
    Rectangle rest{area.x + edge, area.y + units(energy_padding), area.width - 2.0F * edge, 2.0F * line};
    show_numbers(session, now, rest);
    rest.y += rest.height + units(gap), rest.height = units(bar_height);
    show_bar_of(session, course, now, rest);
    ImGui::SetCursorScreenPos({rest.x, rest.y});
    ImGui::Dummy({rest.width, rest.height});
    remember(state, "energy bar");
    rest.y += rest.height + units(gap), rest.height = area.y + area.height - units(energy_padding) - rest.y;
    if (rest.height < 0.5F * units(course_height)) return;
    const Options& options = session.trajectory().run.options;
    const double start = options.start_time, end = std::max(options.end_time, session.trajectory().end_time);
    ImGui::SetCursorScreenPos({rest.x, rest.y});
    ImGui::InvisibleButton("course", {rest.width, rest.height});
    remember(state, "energy course");
    paint_course(session, course, rest, start, end);
    const double share = (double{ImGui::GetIO().MousePos.x} - double{rest.x}) / double{rest.width};
    if (ImGui::IsItemHovered())
        tooltip(energy_tooltip(session, course,
                               std::clamp(start + share * (end - start), start, session.trajectory().end_time)),
                area);
    double time = 0.0;
    if (dragged_to(start, end, rest.x, rest.width, time) && time != session.time()) move_time(session, time, commands);
}

}  // namespace achilles
