// Cards beside the event list that explain the selected event.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "figure/axes.hpp"
#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"
#include "session/event_text.hpp"
#include "session/results_text.hpp"
#include "simulate/explain.hpp"
#include "surface/imgui_version.hpp"
#include "system/units.hpp"

namespace achilles {

// ---- impacts and releases ----

namespace {

constexpr float value_at = 150.0F, second_at = 270.0F;

// Names and their values, row by row.
class CardRows {
 public:
    void operator()(const std::string& name, const std::string& first, const std::string& second = {}) const {
        table_.next_row();
        table_.put(name, faint_color());
        table_.put(first, text_color());
        if (!second.empty()) table_.put(second, text_color());
    }

 private:
    LineTable table_{"values", {units(value_at), units(second_at - value_at), units(90.0F)}};
};

// The rates before and after, in display units.
void show_rates(const Session& session, const Event& event, const CardRows& row) {
    row("", "before", "after");
    const State errors = session.precision().of_state(event.t);
    const auto& coordinates = session.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? degrees(1.0) : 1.0;
        const auto at = static_cast<Eigen::Index>(i);
        row(typeset_name(coordinates[i].name + "'") + (is_angle ? " [\u00b0/s]" : ""),
            number(event.v_before[at] * factor, errors.v[at] * factor, 6),
            number(event.v_after[at] * factor, errors.v[at] * factor, 6));
    }
}

// Lambda during contact until it reaches zero, and dotted its extrapolation.
Panel force_panel(const Theme& theme, const Event& event, const ReleaseReason& reason) {
    const std::string time = "t (s)", lambda_name = "\u03bb";
    Panel panel;
    panel.x.label = time;
    panel.y.label = lambda_name;
    const Stroke contact = phase_stroke(theme, Phase::Kind::constrained, 0, 1);
    Curve force{"", contact, {}}, pull{"", contact, {}};
    double most = 0.0;
    for (const auto& [t, lambda] : reason.force) {
        force.points.push_back({t, lambda});
        most = std::max(most, lambda);
    }
    const double start = reason.force.front().first, beyond = 0.15 * (event.t - start);
    pull.stroke.dash = {2.0, 2.5};
    pull.points = {{event.t, reason.lambda}, {event.t + beyond, reason.lambda + beyond * reason.lambda_rate}};
    Markers release = event_markers(theme, Event::Kind::release);
    release.points = {{event.t, reason.lambda}};
    set_ticks(panel.x, start, event.t + beyond, 0.0, 4);
    set_ticks(panel.y, std::min(pull.points.back().y, 0.0), most, 0.08, 3);
    panel.curves = {force, pull};
    panel.markers = {release};
    return panel;
}

// Whether the time in the title is proved.
void show_proved(const Session& session, std::size_t event) {
    if (session.enclosed(event) != nullptr) ImGui::TextUnformatted("The time is proved.");
}

}  // namespace

void show_impact(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(event_title("Impact", session, event, index), event_time_text(session, index), state))
        commands.emplace_back(command::Select{0});
    const ImpactReason reason = explain_impact(session.trajectory(), index);
    const SystemDescription& description = session.description();
    // In the file's units; with several contacts in that of the first impacting one.
    std::size_t first = 0;
    while (first + 1 < session.model()->contacts() && !event.contacts.contains(first)) ++first;
    const auto with = [&](const std::string& value, const std::string& of) {
        const std::string unit = typeset_unit(unit_of_expression(description, of));
        return unit.empty() ? value : value + " " + unit;
    };
    const bool several = session.model()->contacts() > 1, has_friction = session.model()->has_friction();
    {
        const CardRows row;
        show_rates(session, event, row);
        const ShownUnit rate = shown_unit(unit_of_expression(description, output_names(description, "gap'")[first]));
        row("gap speed |h\u0307|", number_with_unit(number(event.impact_speed * rate.factor,
                                                           session.precision().of_gap_speed(index) * rate.factor, 9),
                                                    rate.text));
        const double error = session.precision().of_energy(sample_at(session.trajectory(), event));
        row(with_unit("energy", typeset_unit(unit_of_expression(description, "energy"))),
            number(reason.energy_before, error, 6), number(reason.energy_after, error, 6));
        const auto energy_row = [&](const char* name, double value) {
            row(name, with(number(flush_noise_to_zero(value, std::abs(reason.energy_before)), error, 6), "energy"));
        };
        const double heat = has_friction ? Slips(session.trajectory()).heat_of_impact(event) : 0.0;
        energy_row("energy lost", reason.energy_before - reason.energy_after - heat);
        if (has_friction) energy_row("heat of friction", heat);
    }
    show_proved(session, index);
    std::string words =
        has_friction && !reason.cut
            ? "Not cut: with friction a cut needs a proof that all further impacts slide, or that all stick, and "
              "errors within the tolerances."
            : why_not_cut(reason, reason.attempt ? &*reason.attempt : nullptr, several, event.joint != nullptr,
                          shown_unit(unit_of_expression(description, output_names(description, "gap''")[first])));
    if (several) {
        const CardRows row;
        for (const auto& [contact, impulse] : Impulses(session.trajectory()).of(index))
            row("impulse on " + description.constraints[contact].name,
                with(number(impulse), output_names(description, "lambda")[contact] + "*t"));
        words = what_is_held(session, event, reason) + words;
    }
    paragraph(words, remaining().width, text_color());
}

void show_release(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(event_title("Release", session, event, index), event_time_text(session, index), state))
        commands.emplace_back(command::Select{0});
    if (event.ends_latch) {
        show_proved(session, index);
        return paragraph(
            "The latch ends here, and the forces do not press: the contact opens at once. Its acceleration need not be "
            "zero.",
            remaining().width, text_color());
    }
    const ReleaseReason reason = explain_release(session.trajectory(), index);
    const Rectangle room = remaining();
    const float words = std::max(units(second_at), 0.45F * room.width);
    if (room.width - words > units(160.0F) && !reason.force.empty())
        paint(force_panel(session.theme(), event, reason), screen_style(session.theme()), ImGui::GetWindowDrawList(),
              {room.x + words, room.y, room.width - words, room.height}, units(1.0F));
    double most = 0.0;
    for (const auto& [t, lambda] : reason.force) most = std::max(most, std::abs(lambda));
    {
        const CardRows row;
        row("\u03bb", number(flush_noise_to_zero(reason.lambda, most), "{:.2g}"));
        row("\u03bb\u0307", number(reason.lambda_rate));
        row("h\u2034", number(reason.jerk));
    }
    show_proved(session, index);
    paragraph(
        "The contact force \u03bb falls through zero: from here on the surface would have to pull. The gap and its "
        "first two derivatives are zero and the third, h\u2034, is positive, so the body leaves the surface.",
        words - units(16.0F), text_color());
}

void show_jump(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Trajectory& run = session.trajectory();
    const Event& event = run.events[index];
    if (show_card_title(event_title("Jump", session, event, index), event_time_text(session, index), state))
        commands.emplace_back(command::Select{0});
    const SystemDescription& description = session.description();
    const State errors = session.precision().of_state(event.t);
    const auto rows = [&](const CardRows& row, const char* prime, const Vector& before, const Vector& after,
                          const Vector& error, const char* unit) {
        for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(i);
            if (before[at] == after[at]) continue;
            const bool is_angle = description.coordinates[i].unit == "rad";
            const double factor = is_angle ? degrees(1.0) : 1.0;
            row(typeset_name(description.coordinates[i].name + prime) + (is_angle ? unit : ""),
                number(before[at] * factor, error[at] * factor, 6), number(after[at] * factor, error[at] * factor, 6));
        }
    };
    {
        const CardRows row;
        row("", "before", "after");
        rows(row, "", event.q_before(), event.q, errors.q, " [\u00b0]");
        rows(row, "'", event.v_before, event.v_after, errors.v, " [\u00b0/s]");
    }
    paragraph(session.sentences().of(index) + ".", remaining().width, text_color());
}

void show_pass(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(event_title("Pass", session, event, index), event_time_text(session, index), state))
        commands.emplace_back(command::Select{0});
    paragraph(
        "The gap falls through zero where 'when' of this contact is not positive: no impact. The contact does not "
        "count until its gap has risen above zero again.",
        remaining().width, text_color());
}

void show_friction(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Trajectory& run = session.trajectory();
    const Event& event = run.events[index];
    const char* const kind = event.kind == Event::Kind::stick  ? "Stick"
                             : event.kind == Event::Kind::slip ? "Start of slip"
                                                               : "Reversal of slip";
    if (show_card_title(event_title(kind, session, event, index), event_time_text(session, index), state))
        commands.emplace_back(command::Select{0});
    const SystemDescription& description = session.description();
    const std::vector<SlidingPlace> places = sliding_places(description);
    const std::vector<std::string> names = sliding_names(description, "friction_force");
    const Mode before = mode_before(run, index);
    {
        const CardRows row;
        row("", "before", "after");
        for (std::size_t i = 0; i < places.size(); ++i) {
            const std::size_t which = places[i].number;
            if (!event.contacts.contains(which)) continue;
            const FrictionShare first = friction_share(run, which, before, {event.q, event.v_before, event.t}),
                                then = friction_share(run, which, event.mode, {event.q, event.v_after, event.t});
            const double size = std::max(first.limit, then.limit);
            const auto shown = [&](double value) { return number(flush_noise_to_zero(value, size), "{:.5g}"); };
            const std::string unit = typeset_unit(unit_of_expression(description, names[i]));
            row(with_unit(places.size() > 1 ? "friction of " + places[i].name : "friction force", unit),
                shown(first.force), shown(then.force));
            if (!places[i].never_slides) row(with_unit("its limit", unit), shown(first.limit), shown(then.limit));
        }
    }
    const std::string words = session.sentences().of(index);
    paragraph(has_several_places(*session.model()) ? words + "." : "It " + words + ".", remaining().width,
              text_color());
}

// ---- Zeno points: the certificate, and the margin of each inequality ----

namespace {

void quiet(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

// A bar for the used share of a limit. The one nearest to its limit is marked.
void show_share(double share, bool is_nearest) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), width = std::min(remaining().width, units(180.0F));
    ImGui::Dummy({std::max(width, 1.0F), line});
    tooltip(is_nearest ? "nearest to its limit" : "share of what is allowed");
    if (width < units(12.0F)) return;
    const float top = at.y + 0.35F * line, bottom = at.y + 0.7F * line;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({at.x, top}, {at.x + width, bottom}, packed(faint_color(), 0.25F), units(2.0F));
    const float used = std::max(units(2.0F), width * static_cast<float>(share));
    list->AddRectFilled({at.x, top}, {at.x + used, bottom},
                        is_nearest ? ImGui::GetColorU32(ImGuiCol_SliderGrabActive) : packed(faint_color()),
                        units(2.0F));
}

}  // namespace

bool show_card_title(const std::string& title, const std::string& more, PanelState& state, float margin) {
    ImGui::TextUnformatted(title.c_str());
    ImGui::SameLine();
    quiet(more);
    const float width = ImGui::GetTextLineHeight();
    ImGui::SameLine(content_right() - width - margin);
    const bool pressed = ImGui::InvisibleButton("close", {width, width}), close = take_escape(state) || pressed;
    remember(state, "close card");
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float inset = 0.28F * width;
    const ImU32 color = packed(ImGui::IsItemHovered() ? text_color() : faint_color());
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddLine({low.x + inset, low.y + inset}, {high.x - inset, high.y - inset}, color, units(1.5F));
    list->AddLine({low.x + inset, high.y - inset}, {high.x - inset, low.y + inset}, color, units(1.5F));
    tooltip("close (Escape)");
    return close;
}

namespace {

// An underlined text button.
bool link_button(const char* name, const std::string& place, const char* about, PanelState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::CalcTextSize(name);
    const bool pressed = ImGui::InvisibleButton(place.c_str(), size);
    remember(state, place);
    const ImU32 color = ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_SliderGrab);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText(at, color, name);
    list->AddLine({at.x, at.y + size.y}, {at.x + size.x, at.y + size.y}, color, units(1.0F));
    tooltip(about);
    return pressed;
}

void lens_button(const Session& session, PanelState& state, Commands& commands) {
    const bool open = session.scene().shows("lens");
    if (link_button(open ? "close the Zeno lens" : "open the Zeno lens", "open lens",
                    "the bouncing before this Zeno point in logarithmic time, in place of the plots", state))
        commands.emplace_back(command::Show{"lens", !open});
}

// The table error | bound | allowed, with a bar for the used share of each limit; below it the details.
void show_certificate(const CertificateText& text, const Event& event) {
    if (!text.rows.empty() && ImGui::BeginTable("certificate", 4, ImGuiTableFlags_SizingFixedFit)) {
        ImGui::TableSetupColumn("error");
        ImGui::TableSetupColumn("bound");
        ImGui::TableSetupColumn("allowed");
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
        ImGui::TableNextRow();
        for (const char* title : {"error", "bound", "allowed"}) ImGui::TableNextColumn(), quiet(title);
        for (const CertificateText::Row& row : text.rows) {
            ImGui::TableNextRow();
            const Color color = row.is_nearest ? text_color() : faint_color();
            for (const std::string* words : {&row.error, &row.bound, &row.allowed}) {
                ImGui::TableNextColumn();
                paragraph(*words, units(400.0F), color);
            }
            ImGui::TableNextColumn();
            show_share(row.share, row.is_nearest);
        }
        ImGui::EndTable();
    }
    for (const std::string& line : certificate_lines(event)) quiet(line);
    for (const Inequality& inequality : event.certificate->assumptions)
        quiet(with_minus(fmt::format("{}: {:.3g} < {:.3g}", inequality.name, inequality.left, inequality.right)));
}

}  // namespace

void show_zeno(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    const Certificate& certificate = *event.certificate;
    const CertificateText text = certificate_text(session, index);
    const std::string time = event_time(session, index).text();
    const std::string verdict = text.verdict.empty() ? "" : ", " + text.verdict;
    if (show_card_title(fmt::format("{}, time {} s{}", text.title, time, verdict), "", state))
        commands.emplace_back(command::Select{0});
    const float width = remaining().width;
    if (const auto horizon = session.horizon(); horizon && event.t > *horizon)
        return paragraph(fmt::format("The run is not trusted after t = {:.6g} s: this certificate is about the "
                                     "computed motion, which no longer follows the motion of this system.",
                                     *horizon),
                         width, text_color());
    if (!text.sentence.empty()) paragraph(text.sentence, width, text_color());
    paragraph(text.not_covered, width, faint_color());
    if (!is_plastic_landing(event)) lens_button(session, state, commands);
    const bool can_prove = !first_unproved(session.model()->description()) && session.shown_proof() == nullptr;
    if (can_prove && session.proof_under_way() == nullptr) {
        if (!is_plastic_landing(event)) ImGui::SameLine(0.0F, units(24.0F));
        if (link_button("Prove this run", "prove run", "prove bounds on the exact motion of the whole run", state))
            commands.emplace_back(command::Prove{});
    }
    show_certificate(text, event);
    quiet(fmt::format("{} conditions, {} restart", to_text(certificate.conditions),
                      to_text(certificate.reinitialization)));
    const auto& others = certificate.others;
    const std::string other_contacts = others ? other_contacts_text(*session.model(), *others) : "";
    if (!other_contacts.empty()) paragraph("Until then " + other_contacts + ".", width, text_color());
}

void show_collapse(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(event_title("Collapse", session, event, index), event_time_text(session, index), state))
        commands.emplace_back(command::Select{0});
    if (event.collapse_info) {
        const auto& constraints = session.description().constraints;
        const CardRows row;
        for (const auto& [contact, impulse] : event.collapse_info->impulses)
            row("impulse of " + constraints[contact].name, number(impulse, "{:.5g}"));
    }
    paragraph(
        "Each impact of one contact drives the other one toward its surface, so the two impact in turn, ever "
        "faster, until both have lost their speeds. The limit is a plastic impact on both. " +
            typeset_sentence(session.sentences().of(index)) + ".",
        remaining().width, text_color());
    if (event.truncation && event.certificate) show_certificate(certificate_text(session, index), event);
}

}  // namespace achilles
