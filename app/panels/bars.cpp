// The menu bar at the top and the status line at the bottom.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "output/proof.hpp"
#include "paint/paint.hpp"
#include "panels/actions.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

// ---- menu bar, with toggles for the panels and the theme at its right end ----

namespace {

template <class Content>
void menu(const char* name, PanelState& state, const Content& content) {
    const bool open = ImGui::BeginMenu(name);
    remember(state, std::string("bar ") + name);
    if (!open) return;
    content();
    close_by_escape(state);
    ImGui::EndMenu();
}

// A square button with a picture. Returns true if pressed; `area` is where to draw.
bool switch_button(const std::string& name, const std::string& about, PanelState& state, Rectangle& area) {
    const float size = ImGui::GetFrameHeight();
    const bool pressed = ImGui::InvisibleButton(name.c_str(), {size, size});
    remember(state, name);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (ImGui::IsItemHovered())
        ImGui::GetWindowDrawList()->AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_ButtonHovered), units(3.0F));
    tooltip(about);
    area = {std::floor(low.x + 0.5F * size - units(8.0F)), std::floor(low.y + 0.5F * size - units(6.5F)), units(16.0F),
            units(13.0F)};
    return pressed;
}

// A small window icon whose left, right or lower part is filled if the panel is shown.
void panel_switch(const Action& panel, const Session& session, PanelState& state, Commands& commands) {
    const bool shown = is_on(panel, session);
    Rectangle r;
    if (switch_button("switch " + std::string(panel.name),
                      fmt::format("{} {} ({})", shown ? "hide" : "show", panel.about, panel.keys), state, r))
        perform(panel, session, state, commands);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 ink = packed(shown ? text_color() : faint_color());
    stroke_rectangle(list, {r.x + 0.5F, r.y + 0.5F}, {r.x + r.width - 0.5F, r.y + r.height - 0.5F}, ink, units(2.0F),
                     units(1.2F));
    const float across = 0.38F * r.width, down = 0.4F * r.height, inset = units(2.5F);
    ImVec2 low{r.x + inset, r.y + inset}, high{r.x + r.width - inset, r.y + r.height - inset};
    if (panel.name == "Controls") high.x = r.x + across;
    if (panel.name == "Plots") low.x = r.x + r.width - across;
    if (panel.name == "Events") low.y = r.y + r.height - down;
    list->AddRectFilled(low, high, packed(shown ? text_color() : faint_color(), shown ? 1.0F : 0.35F));
}

void theme_switch(const Session& session, PanelState& state, Commands& commands) {
    const Action& theme = action("Dark theme");
    Rectangle r;
    if (switch_button("switch theme",
                      fmt::format("{} theme ({})", is_on(theme, session) ? "light" : "dark", theme.keys), state, r))
        perform(theme, session, state, commands);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 c{r.x + 0.5F * r.width, r.y + 0.5F * r.height};
    const float radius = units(6.5F);
    const ImU32 ink = packed(text_color());
    list->AddCircle(c, radius, ink, 32, units(1.2F));
    list->PathArcTo(c, radius - units(0.5F), -1.5707964F, 1.5707964F, 20);
    list->PathFillConvex(ink);
}

}  // namespace

void show_bar(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginMenuBar()) return;
    for (const char* name : {"File", "Edit", "View", "Time", "Plots", "Tours", "Help"})
        menu(name, state, [&] {
            show_menu_entries(name, session, state, commands);
            if (std::string_view(name) == "Tours") show_tour_items(session, state, commands);
            if (std::string_view(name) == "Help") show_help_items(state);
        });
    const float size = ImGui::GetFrameHeight(), space = units(4.0F), edge = units(10.0F);
    const bool has_tabs = !state.front.empty();
    const float width = has_tabs ? size + edge : 4.0F * size + 3.0F * space + edge;
    const float left = ImGui::GetWindowWidth() - width;
    const float title_at = ImGui::GetCursorPosX() + units(16.0F);
    // Show the system's title if no panel does.
    const bool has_title = session.scene().shows("controls") || session.shows_editor();
    if ((has_tabs ? state.front != "controls" : !has_title) && left - title_at > units(80.0F)) {
        ImGui::SetCursorPosX(title_at);
        label(session.description().title, left - title_at);
        ImGui::SameLine(0.0F, 0.0F);
    }
    if (left < title_at) return ImGui::EndMenuBar();
    ImGui::SetCursorPosX(left);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {space, 0.0F});
    if (!has_tabs)
        for (const char* panel : {"Controls", "Events", "Plots"}) panel_switch(action(panel), session, state, commands);
    theme_switch(session, state, commands);
    ImGui::PopStyleVar();
    ImGui::EndMenuBar();
}

// ---- status line: outcome of the run, legend of colors and markers ----

namespace {

constexpr float bar_margin = 10.0F;  // left and right, as for the panels

constexpr float sign_room = 16.0F, line_room = 22.0F;

// A colored marker and its meaning, on the current line.
void legend_entry(const std::string& text, const std::function<void(ImDrawList*, ImVec2)>& sign,
                  float room = sign_room) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({units(room), ImGui::GetTextLineHeight()});
    sign(ImGui::GetWindowDrawList(), {at.x + units(0.5F * sign_room), at.y + 0.5F * ImGui::GetTextLineHeight()});
    ImGui::SameLine(0.0F, units(2.0F));
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

std::vector<Markers> legend_markers(const Session& session) {
    std::vector<Markers> events;
    const std::size_t contacts = session.model()->contacts();
    const auto& all = session.trajectory().events;
    const bool collapses = std::any_of(all.begin(), all.end(), [](const Event& event) { return event.is_collapse(); });
    for (const EventNames& names : possible_events(*session.model())) {
        const EventBase kind{names.kind};
        if (kind.is_collapse() ? collapses : contacts > 0 || kind.is_friction() || kind.is_jump())
            events.push_back(event_markers(session.theme(), names.kind));
    }
    if (contacts > 1) events.push_back(opened_markers(session.theme()));
    return events;
}

float legend_gap() { return units(12.0F); }

// The pinned runs that are drawn. Beside them the present run is drawn in ink: only its dashes tell the phases apart.
std::vector<int> drawn_pinned(const Session& session) {
    std::vector<int> places;
    for (const PinnedRun& run : session.pinned())
        if (run.shown) places.push_back(run.place);
    return places;
}

// A piece of a curve as in the plots.
void paint_piece(ImDrawList* list, float from, float to, float y, const Stroke& stroke) {
    const float width = units(static_cast<float>(stroke.width));
    std::size_t part = 0;
    for (float x = from; x < to; ++part) {
        const float length =
            stroke.dash.empty() ? to - from : units(static_cast<float>(stroke.dash[part % stroke.dash.size()]));
        if (part % 2 == 0) list->AddLine({x, y}, {std::min(x + length, to), y}, packed(stroke.color), width);
        x += length;
    }
}

constexpr const char* pinned_label = "pinned";

float legend_width(const Session& session) {
    float width = 0.0F;
    const auto add = [&](const std::string& text) {
        width += ImGui::CalcTextSize(text.c_str()).x + units(18.0F) + legend_gap();
    };
    const std::vector<int> pinned = drawn_pinned(session);
    for (const PhaseLook look : possible_looks(*session.model())) {
        add(legend_text(look));
        if (!pinned.empty()) width += units(line_room);
    }
    if (!pinned.empty()) add(pinned_label), width += units(line_room);
    for (const Markers& markers : legend_markers(session)) add(markers.label);
    if (session.proof() != nullptr) add(proof_tube(session.theme()).label);
    return width;
}

void show_legend(const Session& session) {
    const std::vector<Markers> events = legend_markers(session);
    const float between = legend_gap(), width = legend_width(session);
    const bool has_tube = session.proof() != nullptr;
    const Tube tube = proof_tube(session.theme());
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < width + units(bar_margin)) return ImGui::NewLine();
    ImGui::SetCursorPosX(content_right() - units(bar_margin) - width + between);
    const std::vector<int> pinned = drawn_pinned(session);
    const float more = pinned.empty() ? 0.0F : line_room;
    for (const PhaseLook look : possible_looks(*session.model())) {
        const auto sign = [&](ImDrawList* list, ImVec2 c) {
            list->AddRectFilled({c.x - units(6.0F), c.y - units(3.0F)}, {c.x + units(6.0F), c.y + units(3.0F)},
                                packed(phase_color(session.theme(), look), 0.85F));
            Stroke stroke = phase_stroke(session.theme(), look, 0, 1);
            stroke.color = session.theme().ink;
            paint_piece(list, c.x + units(9.0F), c.x + units(9.0F + more), c.y, stroke);
        };
        legend_entry(legend_text(look), sign, sign_room + more);
        ImGui::SameLine(0.0F, between);
    }
    if (!pinned.empty()) {
        const auto sign = [&](ImDrawList* list, ImVec2 c) {
            const float from = c.x - units(6.0F), piece = units(line_room + 12.0F) / static_cast<float>(pinned.size());
            for (std::size_t i = 0; i < pinned.size(); ++i)
                paint_piece(list, from + piece * static_cast<float>(i), from + piece * static_cast<float>(i + 1), c.y,
                            pinned_stroke(session.theme(), {}, pinned[i]));
        };
        legend_entry(pinned_label, sign, sign_room + line_room);
        ImGui::SameLine(0.0F, between);
    }
    for (const Markers& markers : events) {
        legend_entry(markers.label, [&](ImDrawList* list, ImVec2 c) {
            paint_marker(list, markers, {c.x, c.y}, units(1.0F));
        });
        if (&markers != &events.back() || has_tube) ImGui::SameLine(0.0F, between);
    }
    if (!has_tube) return;
    legend_entry(tube.label, [&](ImDrawList* list, ImVec2 c) {
        const ImVec2 low{c.x - units(6.0F), c.y - units(4.0F)}, high{c.x + units(6.0F), c.y + units(4.0F)};
        list->AddRectFilled(low, high, packed(tube.fill));
        stroke_rectangle(list, low, high, packed(tube.edge), 0.0F, units(1.0F));
    });
}

// A progress bar along the upper edge.
void paint_share(double share) {
    const ImVec2 corner = ImGui::GetWindowPos();
    const float width = static_cast<float>(share) * ImGui::GetWindowWidth();
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + width, corner.y + units(3.0F)},
                                              ImGui::GetColorU32(ImGuiCol_SliderGrab));
}

// Progress of a run that takes longer than a frame: the larger of its fractions of the end time and of the impact
// limit. Meanwhile the previous run is shown or, for a new system, its start.
void show_progress(const Session& session, const PanelState& state, const RunMonitor& watch) {
    const Run& run = session.run();
    const double time = watch.time, impacts = static_cast<double>(watch.impacts);
    const double share =
        std::clamp(std::max((time - run.options.start_time) / (run.options.end_time - run.options.start_time),
                            impacts / run.options.max_impacts),
                   0.0, 1.0);
    paint_share(share);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_SliderGrab));
    const std::string left = state.in_window ? time_left(session.seconds_under_way(), share) : "";
    ImGui::TextUnformatted(fmt::format("running: t = {:.6g} of {:.6g} s   \u00b7   {:.0f} impacts{}{}", time,
                                       run.options.end_time, impacts, left.empty() ? "" : "   \u00b7   ", left)
                               .c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine(0.0F, units(24.0F));
    ImGui::TextDisabled(
        "%s", session.shows_start() ? "the start is shown until then" : "the previous run is shown until then");
}

// Progress or result of the proof.
void show_proof_status(const Session& session) {
    const Options& options = session.run().options;
    if (const ProofMonitor* watch = session.proof_under_way()) {
        const double time = watch->time;
        paint_share(std::clamp((time - options.start_time) / (options.end_time - options.start_time), 0.0, 1.0));
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_SliderGrab));
        ImGui::TextUnformatted(fmt::format("proving: t = {:.6g} of {:.6g} s", time, options.end_time).c_str());
        ImGui::PopStyleColor();
        return ImGui::SameLine(0.0F, units(24.0F));
    }
    const Proof* const proof = session.shown_proof();
    if (proof == nullptr) return;
    const Enclosure& enclosure = proof->enclosure;
    const std::string about = describe(proof->spread), of = about.empty() ? "" : fmt::format(" ({})", about);
    ImGui::PushStyleColor(ImGuiCol_Text, packed(enclosure.end ? text_color() : error_color()));
    ImGui::TextUnformatted(
        fmt::format("proved to t = {} s{}{}", reach_text(enclosure), enclosure.end ? "" : ", then undecided", of)
            .c_str());
    ImGui::PopStyleColor();
    tooltip(proof_sentence(session, *proof));
    ImGui::SameLine(0.0F, units(24.0F));
}

// The estimated error of the run at the end of the line, once known; left out if the legend needs the room. If there is
// no estimate, the summary says why.
void show_estimate(const Session& session) {
    const ErrorEstimate* estimate = session.error_estimate();
    if (estimate == nullptr || !estimate->end || session.horizon()) return;  // a remark states the horizon
    const std::string text = fmt::format("   \u00b7   estimated error {}", number(estimate->end->size(), "{:.1g}"));
    const float room = ImGui::GetWindowPos().x + content_right() - ImGui::GetItemRectMax().x;
    const float needed = ImGui::CalcTextSize(text.c_str()).x + ImGui::GetStyle().ItemSpacing.x + legend_width(session);
    if (room < needed + units(bar_margin)) return;
    ImGui::SameLine(0.0F, 0.0F);
    ImGui::TextUnformatted(text.c_str());
    tooltip("error of the state at the end, to first order: an estimate, not a proof");
}

}  // namespace

std::string time_left(double seconds, double share) {
    if (!(seconds >= 0.5) || !(share > 1e-3)) return {};  // too early to tell
    const double left = seconds * (1.0 - share) / share;
    if (left < 1.5) return "about 1 s left";
    if (left < 90.0) return fmt::format("about {:.0f} s left", left < 20.0 ? left : 10.0 * std::round(left / 10.0));
    if (left < 90.0 * 60.0) return fmt::format("about {:.0f} min left", left / 60.0);
    if (left < 36.0 * 3600.0) return fmt::format("about {:.0f} h left", left / 3600.0);
    return "more than a day left";
}

std::string proof_sentence(const Session& session, const Proof& proof) {
    const Enclosure& enclosure = proof.enclosure;
    if (&proof != session.proof())
        return fmt::format(
            "Proved by itself to t = {} s: the exact motion has these events, in the intervals shown. This assumes {}.",
            reach_text(enclosure), enclosure.assumptions);
    if (!enclosure.end)
        return fmt::format(
            "Proved to t = {} s: until then the exact motion lies in the tubes of the plots, and its "
            "events in the intervals shown. After that, nothing is proved: {}.",
            reach_text(enclosure), enclosure.outcome.message);
    return fmt::format(
        "Proved to t = {} s: the exact motion lies in the tubes of the plots, and its events in the "
        "intervals shown. This assumes {}.",
        reach_text(enclosure), enclosure.assumptions);
}

namespace {

constexpr const char* between_facts = "   \u00b7   ";

}  // namespace

void show_status(const Session& session, const PanelState& state) {
    const Trajectory& trajectory = session.trajectory();
    const Statistics& s = trajectory.statistics;
    const ImVec2 corner = ImGui::GetWindowPos();
    ImGui::GetWindowDrawList()->AddLine(corner, {corner.x + ImGui::GetWindowWidth(), corner.y},
                                        ImGui::GetColorU32(ImGuiCol_Border));
    ImGui::SetCursorPos(
        {units(bar_margin), std::floor(0.5F * (ImGui::GetWindowHeight() - ImGui::GetTextLineHeight()))});
    if (const RunMonitor* watch = session.under_way()) return show_progress(session, state, *watch);
    show_proof_status(session);
    if (trajectory.outcome.kind != Outcome::Kind::end_time) {
        const std::string early =
            fmt::format("stopped early at t = {:.6g}: {}", trajectory.end_time, to_text(trajectory.outcome.kind));
        ImGui::PushStyleColor(ImGuiCol_Text, packed(error_color()));
        ImGui::TextUnformatted(early.c_str());
        ImGui::PopStyleColor();
        tooltip(trajectory.outcome.message);
        ImGui::SameLine(0.0F, units(24.0F));
    }
    if (const auto warned = warnings(session.run().options); !warned.empty()) {
        ImGui::TextUnformatted(fmt::format("minimum tolerances: {}", min_tolerance).c_str());
        for (const std::string& warning : warned) tooltip(warning);
        ImGui::SameLine(0.0F, units(24.0F));
    }
    for (const RunWarning& remark : session.remarks()) {
        const bool is_horizon = session.horizon() && &remark == session.remarks().data();
        ImGui::PushStyleColor(ImGuiCol_Text, packed(is_horizon ? error_color() : text_color()));
        ImGui::TextUnformatted(remark.label.c_str());
        ImGui::PopStyleColor();
        tooltip(remark.sentence);
        ImGui::SameLine(0.0F, units(24.0F));
    }
    if (session.selected() > 0) {
        const auto event = static_cast<std::size_t>(session.selected() - 1);
        const std::string event_text =
            fmt::format("event {}: ", event + 1) + typeset_sentence(session.sentences().of(event));
        const float room = std::max(1.0F, content_right() - units(bar_margin) - ImGui::GetCursorPosX());
        cell(ImGui::GetCursorScreenPos(), event_text, room, text_color());
        ImGui::Dummy({std::min(width_of(event_text), room), ImGui::GetTextLineHeight()});
        show_legend(session);
        return;
    }
    const std::string seconds = state.in_window ? fmt::format("{:.1f} ms{}", s.seconds * 1e3, between_facts) : "";
    const std::string gap = session.model()->contacts() == 0
                                ? ""
                                : std::string(between_facts) + "minimum gap " +
                                      with_minus(least_gap_text(session.least_gap(), session.scale().q.maxCoeff()));
    const std::string text = fmt::format(
        "{}{}{}{} steps{}{}energy drift {}{}{}", seconds, session.sentences().impacts(), between_facts, s.steps, gap,
        between_facts, s.energy_drift < noise ? number(noise, "below {}") : number(s.energy_drift, "{:.2g}"),
        between_facts, to_text(trajectory.run.options.method));
    const float room = std::max(1.0F, content_right() - units(bar_margin) - ImGui::GetCursorPosX());
    // Whole facts are left out where there is no room; the tooltip has them.
    std::string shown = text;
    for (std::size_t end = shown.rfind(between_facts); width_of(shown) > room && end != std::string::npos;
         end = shown.rfind(between_facts))
        shown.resize(end);
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(fitted(shown, room).c_str());
    if (shown != text) tooltip(text);
    show_estimate(session);
    ImGui::PopStyleColor();
    show_legend(session);
}

}  // namespace achilles
