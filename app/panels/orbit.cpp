// The orbit panel, in place of the events: a periodic orbit near the current run. "Make periodic" searches for it and
// lets the run start on it. If a branch is followed, a slider and the mouse in its plots select a point.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "figure/axes.hpp"
#include "figure/label.hpp"
#include "figure/publication.hpp"
#include "output/output.hpp"
#include "paint/paint.hpp"
#include "panels/panels.hpp"
#include "panels/widgets.hpp"
#include "session/study_jobs.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

// The request being edited, and the plots of the result.
struct OrbitView {
    OrbitOptions typed;
    const Model* of = nullptr;  // the system of the request
    const OrbitJobResult* seen = nullptr;
    std::string low, high, shift;  // as typed
    bool goes = false;             // the run starts on the orbit when it is found
    bool dark = false;
    std::vector<BranchPanel> panels;
};

namespace {

// The initial request: the file's [orbit] table while the run is the file's, else a search from the start of the run.
OrbitOptions usual(const Session& session) {
    OrbitOptions typed;
    const Run &now = session.run(), &file = session.file_run();
    if (!session.description().orbit || now.q != file.q || now.v != file.v) typed.from = "start";
    return typed;
}

OrbitView& view_of(const Session& session, PanelState& state) {
    if (!state.orbit) state.orbit = std::make_shared<OrbitView>();
    OrbitView& view = *state.orbit;
    const auto found = session.orbit();
    if (view.of != session.model().get()) {
        view = {};
        view.of = session.model().get();
        view.typed = usual(session);
    }
    if (view.seen == found.get() && view.dark == session.theme().dark) return view;
    if (found && view.seen != found.get()) {
        view.typed = read_orbit(found->text);
        // The next search starts from the run, which is then on the orbit.
        if (found->answer.orbit) view.typed.from = "start";
    }
    view.seen = found.get();
    view.dark = session.theme().dark;
    view.panels.clear();
    if (found && found->answer.branch)
        view.panels = branch_panels(*found->answer.orbit, *found->answer.branch, session.theme());
    for (BranchPanel& one : view.panels) one.panel.title.clear();  // the axis label says it
    return view;
}

// ---- request ----

void show_from(const Session& session, OrbitView& view, PanelState& state) {
    if (!ImGui::BeginPopup("orbit from")) return;
    const auto choice = [&](const char* name, const std::string& from, const char* about) {
        if (ImGui::Selectable(name, view.typed.from == from)) view.typed.from = from;
        remember(state, std::string("orbit ") + name);
        tooltip(about);
    };
    choice("from the start", "start", "begin the search at the start of the present run");
    choice("from the end", "end", "begin at the end of the present run, which may be close to an attractor");
    if (session.description().orbit)
        choice("from the file's guess", "", "begin at the guess in [orbit] of the system file");
    close_by_escape(state);
    ImGui::EndPopup();
}

void show_closing(const Session& session, OrbitView& view, PanelState& state) {
    if (!ImGui::BeginPopup("orbit closing")) return;
    if (text_row("period", "orbit period", view.typed.period, 150.0F, state)) ImGui::CloseCurrentPopup();
    tooltip(
        "period in s, an expression in the parameters such as 2*pi/om: of the drive, or a guess. Empty: from the file");
    const std::string& first = session.description().coordinates.front().name;
    if (text_row("shift", "orbit shift", view.shift, 150.0F, state)) ImGui::CloseCurrentPopup();
    tooltip(fmt::format("shift of a coordinate after one period, such as {}=2*pi. Empty: from the file", first));
    view.typed.shifts.clear();
    if (!view.shift.empty()) view.typed.shifts.push_back(view.shift);
    close_by_escape(state);
    ImGui::EndPopup();
}

// Searches for what is typed. The run starts on the orbit when it is found.
void search(OrbitView& view, Commands& commands) {
    view.goes = true;
    commands.emplace_back(command::FindOrbit{to_text(view.typed)});
}

// Menu for the parameter of the branch; its default range is that of the slider. A choice starts the search.
void show_along(const Session& session, OrbitView& view, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup("orbit along")) return;
    const std::size_t equals = view.typed.along.find('=');
    const std::string present = equals == std::string::npos ? "" : view.typed.along.substr(0, equals);
    if (ImGui::Selectable("none", present.empty())) view.typed.along.clear();
    remember(state, "orbit along none");
    for (const ParameterDescription& parameter : session.description().parameters) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        if (ImGui::Selectable(("##" + parameter.name).c_str(), present == parameter.name, 0, {units(200.0F), 0.0F})) {
            const double value = *session.value(parameter.name);
            view.low = fmt::format("{}", std::min(parameter.range[0], value));
            view.high = fmt::format("{}", std::max(parameter.range[1], value));
            view.typed.along = fmt::format("{}={}:{}", parameter.name, view.low, view.high);
            search(view, commands);
        }
        remember(state, "orbit along " + parameter.name);
        cell(at, typeset(parameter.name), units(200.0F), text_color());
    }
    if (!present.empty()) {
        const std::size_t colon = view.typed.along.find(':');
        if (view.low.empty() && colon != std::string::npos) {
            view.low = view.typed.along.substr(equals + 1, colon - equals - 1);
            view.high = view.typed.along.substr(colon + 1);
        }
        ImGui::Separator();
        const bool is_low = text_row("from", "orbit along from", view.low, 120.0F, state);
        const bool is_high = text_row("to", "orbit along to", view.high, 120.0F, state);
        view.typed.along = fmt::format("{}={}:{}", present, view.low, view.high);
        if (is_low || is_high) search(view, commands), ImGui::CloseCurrentPopup();
    }
    close_by_escape(state);
    ImGui::EndPopup();
}

std::string from_text(const OrbitOptions& typed) {
    return typed.from.empty() ? "from the file's guess" : "from the " + typed.from;
}

// Status text of the search.
std::string remark_on_orbit(const Session& session) {
    if (const OrbitMonitor* const watch = session.orbit_under_way())
        return fmt::format("searching: {} runs tried", watch->runs.load());
    const auto found = session.orbit();
    if (!found || !found->answer.orbit) return "";
    return session.orbit_point() ? "run is on the orbit" : "run is off the orbit";
}

void show_head(const Session& session, OrbitView& view, PanelState& state, Commands& commands) {
    const bool is_busy = session.orbit_under_way() != nullptr;
    if (ImGui::Button(is_busy ? "Stop" : "Make periodic")) {
        view.goes = false;
        if (is_busy)
            commands.emplace_back(command::StopOrbit{});
        else
            search(view, commands);
    }
    remember(state, "make periodic");
    tooltip(is_busy ? "stop the search" : "find a periodic run near this one, and start the run there");
    ImGui::SameLine(0.0F, units(14.0F));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const Rectangle row{at.x, at.y, 0.0F, ImGui::GetFrameHeight()};
    const float right = ImGui::GetWindowPos().x + content_right();
    float x = menu_button("orbit from", from_text(view.typed), at.x, row, right, state);
    tooltip("where the search begins");
    show_from(session, view, state);
    x = menu_button("orbit along", view.typed.along.empty() ? "no branch" : "branch over " + typeset(view.typed.along),
                    x, row, right, state);
    tooltip("follow the periodic run in a parameter");
    show_along(session, view, state, commands);
    if (right - x > units(60.0F)) {
        x = menu_button("orbit closing", "period and shift", x, row, right, state);
        tooltip("period of the drive, and shift of the coordinates after one period");
        show_closing(session, view, state);
    }
    const std::string remark_text = remark_on_orbit(session);
    const float width = std::min(width_of(remark_text), right - x);
    if (width > units(40.0F))
        cell({std::floor(right - width), at.y + ImGui::GetStyle().FramePadding.y}, remark_text, width, faint_color());
    ImGui::SetCursorScreenPos(at);
    ImGui::Dummy({0.0F, row.height});
}

// ---- result ----

// Index of the point to describe: that of the run or, without one, the first found.
std::size_t described_point(const Session& session, const OrbitJobResult& found) {
    return session.orbit_point().value_or(found.first());
}

// "b = 0.0667"
std::string value_text(const OrbitJobResult& found, const OrbitPoint& point) {
    const Branch& branch = *found.answer.branch;
    const std::string& name = found.answer.orbit->run.model->description().parameters[branch.parameter].name;
    return typeset(name) + " = " + number(branch.value(point), "{:.8g}");
}

// "period doubling at b = 0.0667": a click goes to the nearest point.
void show_happenings(const OrbitJobResult& found, PanelState& state, Commands& commands) {
    const Branch& branch = *found.answer.branch;
    const auto each = [&](const char* what, const std::vector<OrbitPoint>& all) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double value = branch.value(all[i]);
            std::size_t nearest = 0;
            const auto away = [&](std::size_t k) {
                return std::abs(branch.value(branch.points[k]) - value) +
                       (branch.points[k].state.q - all[i].state.q).norm();
            };
            for (std::size_t k = 1; k < branch.points.size(); ++k)
                if (away(k) < away(nearest)) nearest = k;
            const std::string id = fmt::format("orbit {} {}", what, i + 1);
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const float width = remaining().width;
            if (ImGui::InvisibleButton(id.c_str(), {width, ImGui::GetTextLineHeight()}))
                commands.emplace_back(command::SelectBranchPoint{static_cast<int>(nearest) + 1});
            remember(state, id);
            const bool lit = ImGui::IsItemHovered();
            tooltip("click to go to the nearest point of the branch");
            cell(at, fmt::format("{} at {}", what, value_text(found, all[i])), width,
                 lit ? text_color() : faint_color());
        }
    };
    each("fold", branch.folds);
    each("period doubling", branch.flips);
    each("Neimark-Sacker", branch.neimark_sacker);
    each("Zeno point lost", branch.zeno_lost);
    each("other events", branch.changes);
}

void show_slider(const Session& session, const OrbitJobResult& found, PanelState& state, Commands& commands) {
    const std::size_t now = described_point(session, found);
    int point = static_cast<int>(now) + 1;
    const float width = remaining().width;
    ImGui::Dummy({0.0F, units(2.0F)});
    label(fmt::format("point {} of {}: {}", point, found.count(), value_text(found, found.point(now))), width);
    ImGui::SetNextItemWidth(width);
    if (ImGui::SliderInt("##branch", &point, 1, static_cast<int>(found.count()), "", ImGuiSliderFlags_AlwaysClamp))
        commands.emplace_back(command::SelectBranchPoint{point});
    remember(state, "branch");
    tooltip("move along the branch: the run starts at this point, with its parameters");
}

void show_numbers(const Session& session, const OrbitJobResult& found, PanelState& state, Commands& commands) {
    const float width = remaining().width;
    const OrbitPoint& point = found.point(described_point(session, found));
    const auto line = [&](const std::string& text, const Color& color) { paragraph(with_minus(text), width, color); };
    if (found.answer.branch) {
        show_slider(session, found, state, commands);
        show_happenings(found, state, commands);
    }
    line(fmt::format("period {:.10g} s, from {}", point.period,
                     found.answer.orbit->is_at_release ? "release to release" : "flight to flight"),
         text_color());
    line(stability_text(point), text_color());
    line("\u03bc: " + multipliers_text(point, 7), text_color());
    if (const std::string margins = margins_text(point); !margins.empty())
        line(typeset_sentence(margins.substr(0, margins.size() - 1)), faint_color());
    if (!found.answer.branch) return;
    const Branch& branch = *found.answer.branch;
    const auto tell_end = [&](const OrbitPoint& end, const std::string& why) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        cell(at, fmt::format("ends at {}: {}", value_text(found, end), typeset_sentence(why)), width, faint_color());
        ImGui::Dummy({0.0F, ImGui::GetTextLineHeight()});
    };
    tell_end(branch.points.front(), branch.ends[0]);
    tell_end(branch.points.back(), branch.ends[1]);
}

// The point of the branch nearest to the mouse.
std::optional<std::size_t> point_at(const OrbitJobResult& found, const BranchPanel& panel, const PanelMap& map) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<std::size_t> nearest;
    double least = 0.0;
    for (std::size_t i = 0; i < panel.values.size(); ++i) {
        if (!std::isfinite(panel.values[i])) continue;
        const double away = std::hypot(map.x(found.answer.branch->value(found.point(i))) - double{mouse.x},
                                       map.y(panel.values[i]) - double{mouse.y});
        if (!nearest || away < least) nearest = i, least = away;
    }
    return nearest;
}

void show_panel(const Session& session, const OrbitJobResult& found, const BranchPanel& shown, const Rectangle& cell,
                const std::string& name, PanelState& state, Commands& commands) {
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const Rectangle area = paint(shown.panel, screen_style(session.theme()), list, cell, units(1.0F));
    if (area.width < 2.0F || area.height < 2.0F) return;
    const PanelMap map(shown.panel, area);
    ImGui::SetCursorScreenPos({area.x, area.y});
    ImGui::InvisibleButton(name.c_str(), {area.width, area.height});
    remember(state, name);
    const std::optional<std::size_t> under = point_at(found, shown, map);
    const auto on = session.orbit_point();
    if (under && ImGui::IsItemActive() && under != on)
        commands.emplace_back(command::SelectBranchPoint{static_cast<int>(*under) + 1});
    tooltip("click or drag to move along the branch: solid is stable, dashed is unstable");
    if (!on || !std::isfinite(shown.values[*on])) return;
    const ImVec2 at{static_cast<float>(map.x(found.answer.branch->value(found.point(*on)))),
                    static_cast<float>(map.y(shown.values[*on]))};
    list->AddCircleFilled(at, units(5.0F), packed(session.theme().background), 20);
    list->AddCircleFilled(at, units(3.5F), packed(text_color()), 20);
}

void show_branch(const Session& session, const OrbitJobResult& found, const OrbitView& view, const Rectangle& room,
                 PanelState& state, Commands& commands) {
    constexpr float least = 190.0F;
    const auto fit = static_cast<std::size_t>(std::max(room.width / units(least), 1.0F));
    const std::size_t count = std::min(fit, view.panels.size());
    const float width = room.width / static_cast<float>(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Rectangle cell{room.x + width * static_cast<float>(i), room.y, width - units(8.0F), room.height};
        show_panel(session, found, view.panels[i], cell, fmt::format("branch plot {}", i + 1), state, commands);
    }
}

void show_found(const Session& session, const OrbitView& view, PanelState& state, Commands& commands) {
    const Rectangle room = remaining();
    const auto found = session.orbit();
    if (!session.error().empty() && !found) return paragraph(session.error(), room.width, error_color());
    if (!found) {
        if (session.orbit_under_way() == nullptr)
            paragraph(
                "A periodic run returns to its start after one period, possibly moved by a shift. The search begins "
                "near the present run; a branch follows the periodic run in a parameter.",
                std::min(room.width, units(560.0F)), faint_color());
        return;
    }
    if (!found->answer.orbit)
        return paragraph("no periodic run found: " + typeset_sentence(found->answer.reason), room.width, error_color());
    const float numbers = view.panels.empty() ? room.width : std::min(units(330.0F), 0.4F * room.width);
    begin_padded_child("orbit numbers", {numbers, room.height});
    show_numbers(session, *found, state, commands);
    ImGui::EndChild();
    if (view.panels.empty()) return;
    const float left = room.x + numbers + units(12.0F);
    show_branch(session, *found, view, {left, room.y, room.x + room.width - left, room.height}, state, commands);
}

}  // namespace

void show_orbit(const Session& session, PanelState& state, Commands& commands) {
    OrbitView& view = view_of(session, state);
    if (const auto found = session.orbit(); view.goes && found) {
        view.goes = false;
        if (found->count() > 0) commands.emplace_back(command::SelectBranchPoint{static_cast<int>(found->first()) + 1});
    }
    begin_study("orbit");
    show_head(session, view, state, commands);
    show_found(session, view, state, commands);
    ImGui::EndChild();
}

}  // namespace achilles
