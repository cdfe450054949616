// The grid of plots at the right, each with the current time and the time under the mouse. The wheel zooms at the
// mouse, over an axis only along it. Dragging pans, and the right button, or Shift, draws a zoom box. A double click
// fits; a click on a plot over time goes to that time.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "figure/axes.hpp"
#include "figure/difference.hpp"
#include "figure/label.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"
#include "simulate/sampler.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

constexpr double click = 4.0;  // click tolerance, pixels

Color color_of(const Session& session, std::size_t plot, std::size_t curve) {
    const Panel& panel = session.plots()[plot];
    const Sample& now = session.now();
    return panel.curves.size() == panel.courses
               ? phase_color(session.theme(), look_of(*session.model(), now.phase, now.mode))
               : panel.curves[panel.courses * curve].stroke.color;
}

struct PlotPlace {
    std::size_t plot;
    Rectangle area;  // inside the axes
    Rectangle cell;  // the whole card
    bool over_time;
    PanelMap map;
};

// Marks a time, the current one or that under the mouse: a line in plots over time, else a dot on every curve.
void paint_instant(const Session& session, const PlotPlace& place, const Sample& sample, float strength) {
    const PanelMap& map = place.map;
    const std::vector<double> values = session.values(place.plot, sample);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Rectangle& area = place.area;
    list->PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    const double x = map.x(values[0]);
    if (place.over_time && std::isfinite(x)) {
        const float at = std::floor(static_cast<float>(x)) + 0.5F;
        list->AddLine({at, area.y}, {at, area.y + area.height}, packed(text_color(), 0.45F * strength), units(1.0F));
    }
    const auto& hidden = session.plotted().list()[place.plot].framing.hidden;
    // At an event a ring, in which its marker is seen.
    const auto& events = session.trajectory().events;
    const auto event =
        std::lower_bound(events.begin(), events.end(), sample.t, [](const Event& one, double t) { return one.t < t; });
    const bool is_at_event = event != events.end() && event->t == sample.t;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double y = map.y(values[i]);
        if (hidden.contains(i - 1) || !std::isfinite(x) || !std::isfinite(y)) continue;
        const ImVec2 center{static_cast<float>(x), static_cast<float>(y)};
        if (is_at_event) {
            list->AddCircle(center, units(8.0F), packed(text_color(), strength), 24, units(1.5F));
            continue;
        }
        list->AddCircleFilled(center, units(5.0F), packed(session.theme().background), 20);
        list->AddCircleFilled(center, units(3.5F), packed(text_color(), strength), 20);
    }
    list->PopClipRect();
}

// Lines of text in the corner farthest from a time at pixel x.
void paint_lines(const Session& session, const PlotPlace& place, double x, const std::vector<std::string>& lines) {
    const float size = 0.87F * ImGui::GetFontSize(), line = 1.15F * size, padding = units(5.0F);
    float width = 0.0F;
    for (const std::string& text : lines) width = std::max(width, label_width(text, size));
    const bool at_left = x > place.area.x + 0.5 * place.area.width;
    const float left =
        std::floor(at_left ? place.area.x + padding : place.area.x + place.area.width - width - 3.0F * padding);
    const float top = place.area.y + padding;
    const float height = line * static_cast<float>(lines.size()) + padding;
    if (width + 4.0F * padding > place.area.width || height + padding > place.area.height) return;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({left, top}, {left + width + 2.0F * padding, top + height},
                        packed(session.theme().background, 0.92F), units(3.0F));
    list->AddRect({left, top}, {left + width + 2.0F * padding, top + height}, packed(session.theme().grid),
                  units(3.0F));
    for (std::size_t i = 0; i < lines.size(); ++i)
        paint_label(list, left + padding, top + 0.5F * padding + line * static_cast<float>(i), lines[i],
                    i == 0 ? faint_color() : text_color(), size);
}

// The values at the time under the mouse, in the corner farthest from it.
void paint_values(const Session& session, const PlotPlace& place, const Sample& sample) {
    const auto& quantities = session.plotted().list()[place.plot].prepared->quantities();
    const auto& hidden = session.plotted().list()[place.plot].framing.hidden;
    const std::vector<double> values = session.values(place.plot, sample), errors = session.errors(place.plot, sample);
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && hidden.contains(i - 1)) continue;
        const std::string unit = quantities[i].unit.empty() ? "" : " " + quantities[i].unit;
        lines.push_back(quantities[i].label + " = " +
                        (std::isfinite(values[i]) ? number(values[i], errors[i], 6) + unit : "\u2013"));
    }
    paint_lines(session, place, place.map.x(values[0]), lines);
}

// The same for a plot of differences, in which a line marks the time.
void paint_differences(const Session& session, const PlotPlace& place, double t, float strength, bool with_values) {
    const Plot& plot = session.plotted().list()[place.plot];
    const Rectangle& area = place.area;
    const float at = std::floor(static_cast<float>(place.map.x(t))) + 0.5F;
    if (!(at >= area.x && at <= area.x + area.width)) return;
    ImGui::GetWindowDrawList()->AddLine({at, area.y}, {at, area.y + area.height},
                                        packed(text_color(), 0.45F * strength), units(1.0F));
    if (!with_values) return;
    const auto& quantities = plot.prepared->quantities();
    const Sample now = session.at(t);
    const std::vector<double> here = session.values(place.plot, now), errors = session.errors(place.plot, now);
    std::vector<std::string> lines{"\U0001D461 = " + number(t, "{:.6g}") + " s"};
    for (const PinnedRun& run : session.pinned()) {
        if (!run.shown || t > run.trajectory->end_time) continue;
        const Sample then = run.sampler->at(t);
        const std::vector<double> there = values_at(*run.trajectory, then, *plot.prepared),
                                  doubts =
                                      errors_at(*run.trajectory, then, *plot.prepared,
                                                Precision(*run.trajectory, *run.estimate ? &**run.estimate : nullptr));
        for (const std::size_t i : compared_quantities(*plot.prepared, plot.framing))
            lines.push_back(fmt::format("|\u0394{}| = {} {} ({})", quantities[i].label,
                                        number(std::abs(there[i] - here[i]), errors[i] + doubts[i], 3),
                                        quantities[i].unit, run.name.empty() ? "pinned" : run.name));
    }
    paint_lines(session, place, double{at}, lines);
}

// The limits that put these pixels at the ends of the axes.
command::Zoom zoom_to(const PanelMap& map, std::size_t plot, double left, double right, double top, double bottom) {
    return {static_cast<int>(plot) + 1, map.x.value(left), map.x.value(right), map.y.value(bottom), map.y.value(top)};
}

void use_wheel(const PlotPlace& place, bool along_x, bool along_y, Commands& commands) {
    const float wheel = ImGui::GetIO().MouseWheel;
    if (wheel == 0.0F) return;
    const PanelMap& map = place.map;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double factor = std::pow(0.85, double{wheel});
    const auto about = [&](double pixel, double at, bool along) { return along ? at + (pixel - at) * factor : pixel; };
    const Rectangle& a = place.area;
    commands.emplace_back(zoom_to(map, place.plot, about(a.x, mouse.x, along_x), about(a.x + a.width, mouse.x, along_x),
                                  about(a.y, mouse.y, along_y), about(a.y + a.height, mouse.y, along_y)));
}

// Pans with the mouse.
void use_drag(const PlotPlace& place, Commands& commands) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, static_cast<float>(click)) || (delta.x == 0 && delta.y == 0))
        return;
    const PanelMap& map = place.map;
    const Rectangle& a = place.area;
    commands.emplace_back(
        zoom_to(map, place.plot, a.x - delta.x, a.x + a.width - delta.x, a.y - delta.y, a.y + a.height - delta.y));
}

// Right button, or left button with Shift: draws a box and zooms to it on release.
void use_box(const PlotPlace& place, PanelState& state, Commands& commands) {
    const int number = static_cast<int>(place.plot);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Rectangle& a = place.area;
    const Point corner{std::clamp<double>(mouse.x, a.x, a.x + a.width),
                       std::clamp<double>(mouse.y, a.y, a.y + a.height)};
    const bool is_left = ImGui::GetIO().KeyShift && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    if (ImGui::IsItemHovered() && (is_left || ImGui::IsMouseClicked(ImGuiMouseButton_Right)))
        state.box = {number, corner, is_left ? ImGuiMouseButton_Left : ImGuiMouseButton_Right};
    if (state.box.plot != number) return;
    const Point from = state.box.from;
    const auto [left, right] = std::minmax(from.x, corner.x);
    const auto [top, bottom] = std::minmax(from.y, corner.y);
    if (ImGui::IsMouseDown(state.box.button)) {
        const ImVec2 low{static_cast<float>(left), static_cast<float>(top)};
        const ImVec2 high{static_cast<float>(right), static_cast<float>(bottom)};
        ImGui::GetWindowDrawList()->AddRectFilled(low, high, packed(text_color(), 0.08F));
        ImGui::GetWindowDrawList()->AddRect(low, high, packed(text_color(), 0.6F));
        return;
    }
    state.box.plot = -1;
    if (right - left < click || bottom - top < click) return;
    commands.emplace_back(zoom_to(place.map, place.plot, left, right, top, bottom));
}

// Number of the event whose marker is within reach of the mouse; empty if none. In a plot over time only events near
// that time are tested, else all events of a run with not too many.
std::optional<int> event_at(const Session& session, const PlotPlace& place) {
    constexpr std::size_t most = 3000;
    const auto& events = session.trajectory().events;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double reach = units(marker_reach);
    auto first = events.begin(), last = events.end();
    if (place.over_time) {
        const auto at = [&](double x) {
            return std::lower_bound(events.begin(), events.end(), place.map.x.value(x),
                                    [](const Event& event, double t) { return event.t < t; });
        };
        first = at(mouse.x - reach), last = at(mouse.x + reach);
    }
    const auto& hidden = session.plotted().list()[place.plot].framing.hidden;
    const bool too_many = static_cast<std::size_t>(last - first) > most;
    if (session.plotted().list()[place.plot].framing.difference) return std::nullopt;  // it has no markers
    NearestEvent nearest(mouse, reach);
    for (auto event = first; event < last; ++event) {
        if (too_many && event->is_impact()) continue;
        const std::vector<double> values = session.values(place.plot, sample_at(session.trajectory(), *event));
        for (std::size_t i = 1; i < values.size(); ++i)
            if (!hidden.contains(i - 1))
                nearest.ask(static_cast<int>(event - events.begin()) + 1, *event, place.map.x(values[0]),
                            place.map.y(values[i]));
    }
    return nearest.found();
}

// A click selects the event or goes to the time under it, unless it becomes a double click, which fits the plot.
void use_click(const Session& session, const PlotPlace& place, PanelState& state, Commands& commands) {
    const int number = static_cast<int>(place.plot) + 1;
    const ImGuiIO& io = ImGui::GetIO();
    PlotClick& waiting = state.plot_click;
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        waiting = {};
        commands.emplace_back(command::Fit{number});
        return;
    }
    const bool is_late = ImGui::GetTime() - waiting.since > double{io.MouseDoubleClickTime};
    if (waiting.plot == number && (is_late || ImGui::IsMouseClicked(ImGuiMouseButton_Left))) {
        if (waiting.event > 0)
            commands.emplace_back(command::Select{waiting.event});
        else if (waiting.time != session.time())
            move_time(session, waiting.time, commands);
        waiting = {};
    }
    // The left button was released where it was pressed, and not in a double click.
    const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0.0F);
    if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(ImGuiMouseButton_Left) ||
        io.MouseClickedLastCount[ImGuiMouseButton_Left] > 1 || std::hypot(moved.x, moved.y) > click)
        return;
    const std::optional<int> event = event_at(session, place);
    if (!event && !place.over_time) return;
    waiting = {number, event.value_or(0), place.map.x.value(io.MousePos.x), io.MouseClickedTime[ImGuiMouseButton_Left]};
}

// A part of the card that reacts to the mouse. It uses the wheel, so that no panel scrolls.
bool hoverable_area(const std::string& name, const Rectangle& area) {
    if (area.width < 1.0F || area.height < 1.0F) return false;
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton(name.c_str(), {area.width, area.height},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    return ImGui::IsItemHovered();
}

void use_mouse(const Session& session, const PlotPlace& place, PanelState& state, Commands& commands) {
    const Rectangle &a = place.area, &c = place.cell;
    const std::string name = "plot " + std::to_string(place.plot);
    if (hoverable_area("x axis of " + name, {a.x, a.y + a.height, a.width, c.y + c.height - a.y - a.height}))
        use_wheel(place, true, false, commands);
    if (hoverable_area("y axis of " + name, {c.x, a.y, a.x - c.x, a.height})) use_wheel(place, false, true, commands);
    const bool hovered = hoverable_area(name, a);
    remember(state, name);
    if (hovered) use_wheel(place, true, true, commands);
    const bool was_box = state.box.plot == static_cast<int>(place.plot);
    use_box(place, state, commands);
    if (!was_box && state.box.plot < 0) {
        if (ImGui::IsItemActive()) use_drag(place, commands);
        use_click(session, place, state, commands);
    }
    // Markers are only near the axes' area, and not tested while a button is down.
    if (hovered && !ImGui::IsAnyMouseDown())
        if (const auto event = event_at(session, place)) name_event(session, *event);
    if (hovered && place.over_time) state.pointed_at = place.map.x.value(ImGui::GetIO().MousePos.x);
}

// Names of the curves, clickable, if there are several. Returns their left end.
float show_legend(const Session& session, std::size_t plot, const Rectangle& row, PanelState& state,
                  Commands& commands) {
    const Plot& shown = session.plotted().list()[plot];
    const auto& quantities = shown.prepared->quantities();
    float right = row.x + row.width;
    if (quantities.size() < 3) return right;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = 0.87F * ImGui::GetFontSize(), line = units(16.0F), space = units(5.0F);
    const float room = 0.7F * row.width, around = line + 3.0F * space;  // reserves room for the title
    // If not all names fit, each is shortened.
    constexpr float longest = 110.0F, shortest = 14.0F;
    float wanted = 0.0F;
    for (std::size_t i = 1; i < quantities.size(); ++i)
        wanted += around + label_width(fitted(quantities[i].label, units(longest)), size);
    const float share = room / static_cast<float>(quantities.size() - 1) - around,
                widest = wanted > room && share > units(shortest) ? share / 0.87F : units(longest);
    for (std::size_t i = quantities.size() - 1; i >= 1; --i) {
        const bool hidden = shown.framing.hidden.contains(i - 1);
        const std::string name = fitted(quantities[i].label, widest);
        const float width = line + space + label_width(name, size) + 2.0F * space;
        if (right - width < row.x + row.width - room - 0.5F) break;
        right -= width;
        ImGui::SetCursorScreenPos({right, row.y});
        const std::string id = "curve " + std::to_string(plot + 1) + " " + std::to_string(i);
        if (ImGui::InvisibleButton(id.c_str(), {width, row.height}))
            commands.emplace_back(command::ShowCurve{static_cast<int>(plot) + 1, static_cast<int>(i), hidden});
        remember(state, id);
        if (ImGui::IsItemHovered())
            list->AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), packed(text_color(), 0.06F),
                                units(3.0F));
        tooltip((name == quantities[i].label ? "" : shown.view.y[i - 1].text + "\n") +
                (hidden ? "show this curve" : "hide this curve"));
        const float middle = std::floor(row.y + 0.5F * row.height) + 0.5F;
        list->AddLine({right + space, middle}, {right + space + line, middle},
                      packed(color_of(session, plot, i - 1), hidden ? 0.25F : 1.0F), units(2.0F));
        paint_label(list, right + 2.0F * space + line, row.y + 0.5F * (row.height - 1.2F * size), name,
                    hidden ? faint_color() : text_color(), size);
    }
    return right;
}

// The title, which opens the plot's menu, with the legend at its right.
void show_head(const Session& session, std::size_t plot, const Rectangle& row, PanelState& state, Commands& commands) {
    float right = show_legend(session, plot, row, state, commands);
    if (plot == 0) right = name_runs(session, row, right);
    const float arrow = units(14.0F), width = right - row.x - units(4.0F), size = ImGui::GetFontSize();
    const Plot& shown = session.plotted().list()[plot];
    const std::string whole = (shown.framing.difference ? "difference: " : "") + title_of(shown.view),
                      title = fitted(whole, width - arrow);
    ImGui::SetCursorScreenPos({row.x, row.y});
    const std::string id = "menu of plot " + std::to_string(plot + 1);
    const bool pressed = ImGui::InvisibleButton(id.c_str(), {label_width(title, size) + arrow, row.height});
    remember(state, id);
    const bool lit = ImGui::IsItemHovered();
    tooltip((title == whole ? "" : session.plotted().list()[plot].view.name + "\n") +
            "choose what is plotted, or save this plot as a figure");
    ImDrawList* list = ImGui::GetWindowDrawList();
    paint_label(list, row.x, row.y + 0.5F * (row.height - 1.2F * size), title, text_color(), size);
    const float x = row.x + label_width(title, size) + units(5.0F), y = std::floor(row.y + 0.5F * row.height);
    paint_menu_arrow(x, y, lit);
    if (pressed) open_plot_menu(session, plot, state);
    show_plot_menu(session, plot, state, commands);
}

void show_plot(const Session& session, std::size_t plot, const Rectangle& cell, PanelState& state, Commands& commands) {
    const auto [row, inner] = paint_plot_card(cell);
    if (inner.width < 2.0F || inner.height < 2.0F) return;
    const Panel& panel = session.drawn(plot);
    const Rectangle area = paint(panel, screen_style(session.theme()), ImGui::GetWindowDrawList(), inner, units(1.0F));
    show_head(session, plot, row, state, commands);
    if (area.width < 2.0F || area.height < 2.0F) return;
    const PlotPlace place{plot, area, cell, session.plotted().list()[plot].over_time(), PanelMap(panel, area)};
    if (session.plotted().list()[plot].framing.difference) {
        if (session.pinned().empty()) paint_lines(session, place, double{area.x}, {"no run is pinned"});
        paint_differences(session, place, session.time(), 1.0F, false);
        if (state.pointed_before) paint_differences(session, place, *state.pointed_before, 0.6F, true);
        return use_mouse(session, place, state, commands);
    }
    paint_instant(session, place, session.now(), 1.0F);
    if (state.pointed_before) {
        const Sample sample = session.at(*state.pointed_before);
        paint_instant(session, place, sample, 0.6F);
        paint_values(session, place, sample);
    }
    use_mouse(session, place, state, commands);
}

}  // namespace

void show_plots(const Session& session, PanelState& state, Commands& commands) {
    state.pointed_before = state.pointed_at;  // from the last frame, since a later plot may set it in this one
    state.pointed_at.reset();
    const bool is_alone = session.scene().presents();  // presentation mode shows only the first
    if (!is_alone) show_grid_bar(session, state, commands);
    const Rectangle area = remaining();
    const Plots& plots = session.plotted();
    if (is_alone) {
        if (!session.plots().empty()) show_plot(session, 0, area, state, commands);
        return;
    }
    const float gap = units(8.0F);
    const auto columns = static_cast<float>(plots.columns()), rows = static_cast<float>(plots.rows());
    const float width = std::floor((area.width - gap * (columns - 1.0F)) / columns);
    const float height = std::floor((area.height - gap * (rows - 1.0F)) / rows);
    for (int i = 0; i < static_cast<int>(session.plots().size()); ++i) {
        const int column = i % plots.columns(), row = i / plots.columns();
        const Rectangle cell{area.x + static_cast<float>(column) * (width + gap),
                             area.y + static_cast<float>(row) * (height + gap), width, height};
        show_plot(session, static_cast<std::size_t>(i), cell, state, commands);
    }
}

// ---- choice of what is plotted: the row above the plots, and the menu of each ----

namespace {

constexpr std::array<std::pair<int, int>, 6> grids{{{1, 1}, {1, 2}, {2, 2}, {2, 3}, {3, 2}, {3, 3}}};
constexpr const char* plot_popup = "plot menu";

std::string joined(const std::vector<Text>& texts) {
    std::string text;
    for (const Text& part : texts) text += (text.empty() ? "" : ", ") + part.text;
    return text;
}

// Splits expressions at commas outside parentheses.
std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (const char c : text) {
        if (c == '(') ++depth;
        if (c == ')') --depth;
        if (c == ',' && depth == 0)
            parts.emplace_back();
        else if (c != ' ' || !parts.back().empty())
            parts.back() += c;
    }
    return parts;
}

// A button with a picture of the grid.
bool grid_button(int columns, int rows, bool chosen, PanelState& state) {
    const float size = ImGui::GetFrameHeight(), edge = units(5.0F), gap = units(2.0F);
    const std::string id = "grid " + std::to_string(columns) + " " + std::to_string(rows);
    const bool pressed = ImGui::InvisibleButton(id.c_str(), {size, size});
    remember(state, id);
    const ImVec2 at = ImGui::GetItemRectMin();
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (chosen || ImGui::IsItemHovered())
        list->AddRectFilled(at, ImGui::GetItemRectMax(),
                            ImGui::GetColorU32(chosen ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg), units(3.0F));
    const float width = (size - 2.0F * edge - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
    const float height = (size - 2.0F * edge - gap * static_cast<float>(rows - 1)) / static_cast<float>(rows);
    for (int i = 0; i < columns * rows; ++i) {
        const int column = i % columns, row = i / columns;
        const ImVec2 low{at.x + edge + static_cast<float>(column) * (width + gap),
                         at.y + edge + static_cast<float>(row) * (height + gap)};
        list->AddRectFilled(low, {low.x + width, low.y + height}, packed(chosen ? text_color() : faint_color()));
    }
    tooltip(std::to_string(columns * rows) + (columns * rows == 1 ? " plot" : " plots"));
    return pressed;
}

// Menu of the file's views and the generic ones.
void show_choices(const Session& session, std::size_t plot, Commands& commands) {
    for (std::size_t i = 0; i < session.plotted().choices().size(); ++i) {
        const ViewDescription& view = session.plotted().choices()[i];
        ImGui::PushID(static_cast<int>(i));
        const bool chosen = view.name == session.plotted().list()[plot].view.name;
        if (ImGui::Selectable(view.name.c_str(), chosen)) {
            command::PlotView command{static_cast<int>(plot) + 1, view.x.text, {}};
            for (const Text& y : view.y) command.y.push_back(y.text);
            commands.emplace_back(command);
        }
        ImGui::PopID();
    }
}

}  // namespace

void show_grid_bar(const Session& session, PanelState& state, Commands& commands) {
    const Plots& plots = session.plotted();
    const float y = ImGui::GetCursorPosY();
    for (const auto& [columns, rows] : grids) {
        if (grid_button(columns, rows, plots.columns() == columns && plots.rows() == rows, state))
            commands.emplace_back(command::SetGrid{columns, rows});
        ImGui::SameLine(0.0F, units(2.0F));
    }
    const char* text = "link time";
    const float width = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(text).x;
    // What the mouse does in a plot, while it is over one.
    const char* const hint = "right drag: zoom box";
    const float free = content_right() - width - units(8.0F) - ImGui::GetCursorPosX() - units(8.0F);
    if (ImGui::IsWindowHovered() && ImGui::CalcTextSize(hint).x <= free) {
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + units(8.0F));
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", hint);
    }
    ImGui::SetCursorPos({content_right() - width, y});
    bool linked = plots.linked();
    if (ImGui::Checkbox(text, &linked)) commands.emplace_back(command::Link{linked});
    remember(state, "link");
    tooltip("one time range for all plots over time");
}

// Changes in quick succession, such as turns of the wheel, are one entry.
void follow_views(const Session& session, PanelState& state) {
    constexpr double pause = 0.5;  // s
    ViewHistory& history = state.views;
    const Plots& now = session.plotted();
    if (history.views.empty() || history.views.front().model() != now.model()) history = {{now}, 0, -1e9};
    if (history.views[history.at] == now) return;
    const double time = ImGui::GetTime();
    if (time - std::exchange(history.changed, time) > pause || history.at == 0) ++history.at;
    history.views.resize(history.at, now);
    history.views.push_back(now);
}

void go_to_view(const Session& session, PanelState& state, int step, Commands& commands) {
    ViewHistory& history = state.views;
    const std::size_t last = history.views.empty() ? 0 : history.views.size() - 1;
    if (step < 0 ? history.at == 0 : history.at >= last) return;
    history.at = step < 0 ? history.at - 1 : history.at + 1;
    history.changed = -1e9;
    for (Command& command : steps_between(session.plotted(), history.views[history.at]))
        commands.push_back(std::move(command));
}

void open_plot_menu(const Session& session, std::size_t plot, PanelState& state) {
    const ViewDescription& view = session.plotted().list()[plot].view;
    state.plot_menu = {static_cast<int>(plot), view.x.text, joined(view.y)};
    ImGui::OpenPopup(plot_popup);
}

void show_plot_menu(const Session& session, std::size_t plot, PanelState& state, Commands& commands) {
    PlotMenu& menu = state.plot_menu;
    if (menu.plot != static_cast<int>(plot) || !ImGui::BeginPopup(plot_popup)) return;
    const int number = static_cast<int>(plot) + 1;
    const Framing& framing = session.plotted().list()[plot].framing;
    show_choices(session, plot, commands);
    ImGui::Separator();
    const bool was_entered = std::exchange(menu.was_entered, false);
    if (was_entered) menu.is_wrong = !session.error().empty();
    const bool typed = expression_fields(menu.x, menu.y, was_entered && menu.is_wrong, "expression ",
                                         "; separate several curves by commas. Press Enter to plot", state);
    if (menu.is_wrong && !session.error().empty()) show_message(session.error(), units(264.0F));
    if (typed) commands.emplace_back(command::PlotView{number, menu.x, split(menu.y)});
    menu.was_entered = typed;
    for (const bool is_x : {true, false}) {
        bool on = is_x ? framing.log_x : framing.log_y;
        const char* name = is_x ? "logarithmic x" : "logarithmic y";
        if (ImGui::Checkbox(name, &on)) commands.emplace_back(command::AxisScale{number, is_x, on});
        remember(state, name);
        ImGui::SameLine();
    }
    if (ImGui::Button("fit")) commands.emplace_back(command::Fit{number});
    remember(state, "fit");
    if (!session.pinned().empty() || framing.difference) {
        bool on = framing.difference;
        if (ImGui::Checkbox("difference from the pinned runs", &on))
            commands.emplace_back(command::PlotDifference{number, on});
        remember(state, "difference");
        tooltip("difference of each pinned run from the present one over time, on a logarithmic axis");
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Save figure\u2026", nullptr, false, session.under_way() == nullptr))
        ask_to_export(session, state, "svg", number);
    remember(state, "menu Save figure\u2026");
    tooltip("save this plot alone, for print, as SVG, PNG or PDF");
    if (ImGui::MenuItem("Copy data", nullptr, false, session.under_way() == nullptr))
        commands.emplace_back(command::Copy{"plots", number});
    remember(state, "menu Copy data of plot");
    if (was_entered && !menu.is_wrong) ImGui::CloseCurrentPopup();
    close_by_escape(state);
    ImGui::EndPopup();
}

}  // namespace achilles
