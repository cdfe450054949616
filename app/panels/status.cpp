// The last line: how the run went, and what the colours and signs mean.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "output/proof.hpp"
#include "paint/marker.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

constexpr float edge = 10.0F;  // left and right, as beside the panels

// A coloured sign and what it stands for, on the current line.
void legend_entry(const std::string& text, const std::function<void(ImDrawList*, ImVec2)>& sign) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({units(16.0F), ImGui::GetTextLineHeight()});
    sign(ImGui::GetWindowDrawList(), {at.x + units(8.0F), at.y + 0.5F * ImGui::GetTextLineHeight()});
    ImGui::SameLine(0.0F, units(2.0F));
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

constexpr Phase::Kind phases[] = {Phase::Kind::hybrid, Phase::Kind::constrained};

std::vector<Markers> legend_markers(const Session& session) {
    std::vector<Markers> events;
    for (const Event::Kind kind : {Event::Kind::impact, Event::Kind::zeno, Event::Kind::release})
        events.push_back(event_markers(session.theme(), kind));
    if (session.model()->contacts() > 1) events.push_back(opened_markers(session.theme()));
    return events;
}

float legend_gap() { return units(12.0F); }

float legend_width(const Session& session) {
    float width = 0.0F;
    const auto add = [&](const std::string& text) {
        width += ImGui::CalcTextSize(text.c_str()).x + units(18.0F) + legend_gap();
    };
    for (const Phase::Kind kind : phases) add(legend_text(kind));
    for (const Markers& markers : legend_markers(session)) add(markers.label);
    if (session.proof() != nullptr) add(proof_tube(session.theme()).label);
    return width;
}

void show_legend(const Session& session) {
    const std::vector<Markers> events = legend_markers(session);
    const float gap = legend_gap(), width = legend_width(session);
    const bool has_tube = session.proof() != nullptr;
    const Tube tube = proof_tube(session.theme());
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < width + units(edge)) return ImGui::NewLine();
    ImGui::SetCursorPosX(content_right() - units(edge) - width + gap);
    for (const Phase::Kind kind : phases) {
        legend_entry(legend_text(kind), [&](ImDrawList* list, ImVec2 c) {
            list->AddRectFilled({c.x - units(6.0F), c.y - units(3.0F)}, {c.x + units(6.0F), c.y + units(3.0F)},
                                packed(phase_color(session.theme(), kind), 0.85F));
        });
        ImGui::SameLine(0.0F, gap);
    }
    for (const Markers& markers : events) {
        legend_entry(markers.label, [&](ImDrawList* list, ImVec2 c) {
            paint_marker(list, markers, {c.x, c.y}, units(1.0F));
        });
        if (&markers != &events.back() || has_tube) ImGui::SameLine(0.0F, gap);
    }
    if (!has_tube) return;
    legend_entry(tube.label, [&](ImDrawList* list, ImVec2 c) {
        const ImVec2 low{c.x - units(6.0F), c.y - units(4.0F)}, high{c.x + units(6.0F), c.y + units(4.0F)};
        list->AddRectFilled(low, high, packed(tube.fill));
        stroke_rectangle(list, low, high, packed(tube.edge), 0.0F, units(1.0F));
    });
}

// How much is done of what is under way, along the upper edge.
void paint_share(double share) {
    const ImVec2 corner = ImGui::GetWindowPos();
    const float width = static_cast<float>(share) * ImGui::GetWindowWidth();
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + width, corner.y + units(3.0F)},
                                              ImGui::GetColorU32(ImGuiCol_SliderGrab));
}

// A run takes longer than a frame: how far it is, of its time or of the impacts it may have. What is shown meanwhile is
// the run before it or, of another system, its start.
void show_progress(const Session& session, const PanelState& state, const Watch& watch) {
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

// How far the proof of the run has come, or how far it goes.
void show_proof(const Session& session) {
    const Options& options = session.run().options;
    if (const ProofWatch* watch = session.proof_under_way()) {
        const double time = watch->time;
        paint_share(std::clamp((time - options.start_time) / (options.end_time - options.start_time), 0.0, 1.0));
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_SliderGrab));
        ImGui::TextUnformatted(fmt::format("proving: t = {:.6g} of {:.6g} s", time, options.end_time).c_str());
        ImGui::PopStyleColor();
        return ImGui::SameLine(0.0F, units(24.0F));
    }
    const Proof* const proof = session.proof();
    if (proof == nullptr) return;
    const Enclosure& enclosure = proof->enclosure;
    const std::string about = told(proof->spread), of = about.empty() ? "" : fmt::format(" ({})", about);
    ImGui::PushStyleColor(ImGuiCol_Text, packed(enclosure.end ? text_color() : error_color()));
    ImGui::TextUnformatted(
        fmt::format("proved to t = {} s{}{}", reach_text(enclosure), enclosure.end ? "" : ", then undecided", of)
            .c_str());
    ImGui::PopStyleColor();
    tooltip(
        enclosure.end
            ? "The exact motion lies in the tubes of the plots, and its events in the intervals shown. This assumes " +
                  enclosure.assumptions + "."
            : "Until then the exact motion lies in the tubes of the plots, and its events in the intervals shown. "
              "After that, nothing is proved: " +
                  enclosure.outcome.message + ".");
    ImGui::SameLine(0.0F, units(24.0F));
}

// What is estimated of the run's error, once that is known, behind what stands there. Nothing where there is none, and why is in the
// summary; nor where it would take the legend its place.
void show_estimate(const Session& session) {
    const ErrorEstimate* estimate = session.error_estimate();
    if (estimate == nullptr || !estimate->end || session.horizon()) return;  // a remark tells of the horizon
    const std::string text = fmt::format("   \u00b7   estimated error {}", number(estimate->end->size(), "{:.1g}"));
    const float room = ImGui::GetWindowPos().x + content_right() - ImGui::GetItemRectMax().x;
    const float needed = ImGui::CalcTextSize(text.c_str()).x + ImGui::GetStyle().ItemSpacing.x + legend_width(session);
    if (room < needed + units(edge)) return;
    ImGui::SameLine(0.0F, 0.0F);
    ImGui::TextUnformatted(text.c_str());
    tooltip(
        "Error of the state at the end, position and rates together: errors of steps,\nroots and cuts, propagated to "
        "first order, and rounding.\nAn estimate, not a proof.");
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

void show_status(const Session& session, const PanelState& state) {
    const Trajectory& trajectory = session.trajectory();
    const Statistics& s = trajectory.statistics;
    const ImVec2 corner = ImGui::GetWindowPos();
    ImGui::GetWindowDrawList()->AddLine(corner, {corner.x + ImGui::GetWindowWidth(), corner.y},
                                        ImGui::GetColorU32(ImGuiCol_Border));
    ImGui::SetCursorPos({units(edge), std::floor(0.5F * (ImGui::GetWindowHeight() - ImGui::GetTextLineHeight()))});
    if (const Watch* watch = session.under_way()) return show_progress(session, state, *watch);
    show_proof(session);
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
        ImGui::TextUnformatted(fmt::format("minimum tolerances: {}", least_tolerance).c_str());
        for (const std::string& warning : warned) tooltip(warning);
        ImGui::SameLine(0.0F, units(24.0F));
    }
    for (const Remark& remark : session.remarks()) {
        const bool is_horizon = session.horizon() && &remark == session.remarks().data();
        ImGui::PushStyleColor(ImGuiCol_Text, packed(is_horizon ? error_color() : text_color()));
        ImGui::TextUnformatted(remark.label.c_str());
        ImGui::PopStyleColor();
        tooltip(remark.sentence);
        ImGui::SameLine(0.0F, units(24.0F));
    }
    if (session.selected() > 0) {
        const auto event = static_cast<std::size_t>(session.selected() - 1);
        const std::string said = fmt::format("event {}: ", event + 1) + typeset_sentence(session.sentences().of(event));
        const float room = std::max(1.0F, content_right() - units(edge) - ImGui::GetCursorPosX());
        cell(ImGui::GetCursorScreenPos(), said, room, text_color());
        ImGui::Dummy({std::min(width_of(said), room), ImGui::GetTextLineHeight()});
        show_legend(session);
        return;
    }
    const std::string seconds = state.in_window ? fmt::format("{:.1f} ms   \u00b7   ", s.seconds * 1e3) : "";
    const std::string text =
        fmt::format("{}{}   \u00b7   {} steps   \u00b7   minimum gap {}   \u00b7   energy drift {}   \u00b7   {}",
                    seconds, session.sentences().impacts(), s.steps,
                    with_minus(least_gap_text(session.least_gap(), session.scale().q.maxCoeff())),
                    s.energy_drift < noise ? number(noise, "below {}") : number(s.energy_drift, "{:.2g}"),
                    to_text(trajectory.run.options.method));
    const float room = std::max(1.0F, content_right() - units(edge) - ImGui::GetCursorPosX());
    const bool is_cut = width_of(text) > room;
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(is_cut ? fitted(text, room).c_str() : text.c_str());
    if (is_cut) tooltip(text);
    show_estimate(session);
    ImGui::PopStyleColor();
    show_legend(session);
}

}  // namespace achilles
