// Why an event is what it is: the cards of impacts and releases beside the list.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "figure/shown_unit.hpp"
#include "figure/ticks.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "output/precision.hpp"
#include "paint/label.hpp"
#include "panels/print.hpp"
#include "panels/widgets.hpp"
#include "simulate/explain.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr float value_at = 150.0F, second_at = 270.0F;

ImVec2 at_right(const ImVec2& at, float by) { return {at.x + units(by), at.y}; }

// A name and its values in columns.
void row(const std::string& name, const std::string& first, const std::string& second = {}) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    cell(at, name, units(value_at - 8.0F), faint_color());
    cell(at_right(at, value_at), first, units((second.empty() ? second_at + 90.0F : second_at) - value_at - 8.0F),
         text_color());
    if (!second.empty()) cell(at_right(at, second_at), second, units(90.0F), text_color());
    ImGui::Dummy({units(second_at + 90.0F), ImGui::GetTextLineHeight()});
}

// The rates before and after, in the units that are shown.
void show_rates(const Session& session, const Event& event) {
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

// The first inequality that does not hold, if any.
std::optional<Inequality> failed(const Certificate& certificate) {
    for (const Inequality& inequality : certificate.inequalities())
        if (!(inequality.left < inequality.right)) return inequality;
    return std::nullopt;
}

std::string why_not_cut(const ImpactReason& reason, const Certificate* attempt, bool several, bool all_at_once,
                        const ShownUnit& acceleration) {
    if (reason.cut)
        return "Cut here: the error of the motion that follows is certified to be within the tolerances. The next "
               "event, the Zeno point, shows the bounds.";
    if (!reason.contact || all_at_once)
        return "Not cut: several contacts take part in this impact, which Moreau's law resolves together.";
    if (reason.normal_acceleration == 0.0) return "Not cut: nothing presses the body onto the surface here.";
    if (!(reason.normal_acceleration < 0.0))
        return fmt::format(
            "Not cut: the surface falls away here; the gap would open with acceleration {}.",
            number_with_unit(number(reason.normal_acceleration * acceleration.factor), acceleration.text));
    if (attempt == nullptr)
        return fmt::format(
            "Not cut: nothing can be certified yet; the gap's acceleration may change sign{} before the Zeno point.",
            several ? ", or another contact may open or close," : "");
    const std::optional<Inequality> inequality = failed(*attempt);
    if (!inequality) return "Not cut: this impact came before the conditions were checked.";
    if (!(inequality->right > 0.0)) return fmt::format("Not cut: the {} does not hold.", inequality->name);
    return fmt::format("Not cut: the {} requires {} < {}; the left side is {} times too large.", inequality->name,
                       number(inequality->left, "{:.3g}"), number(inequality->right, "{:.3g}"),
                       number(inequality->left / inequality->right, "{:.3g}"));
}

// Lambda during the contact, down to zero, and dotted how it would go on.
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

// When the proof of the run has it.
void show_proved(const Session& session, std::size_t event) {
    if (session.enclosed(event) != nullptr) ImGui::TextUnformatted(proved_text(session, event).c_str());
}

// "Impact of wall, event 7"; without the contact where there is one.
std::string title(const char* kind, const Session& session, const Event& event, std::size_t index) {
    const std::string contacts = contacts_told(session.trajectory(), event);
    return fmt::format("{}{}{}, event {}", kind, contacts.empty() ? "" : " of ", contacts, index + 1);
}

std::string time_of(const Session& session, std::size_t event) {
    return fmt::format("t = {} s",
                       number(session.trajectory().events[event].t, session.precision().of_event(event), 10));
}

// Where there are several contacts.
std::string what_is_held(const Session& session, const Event& event, const ImpactReason& reason) {
    const Model& model = *session.model();
    std::string text =
        reason.held.empty() ? "No contact is held. " : fmt::format("Held: {}. ", joined_names(model, reason.held));
    if (!event.opened.empty())
        text += fmt::format("It opens {}, where the impulse would have to pull. ", joined_names(model, event.opened));
    if (event.joint && event.joint->order_matters)
        text += "The order of the impacts matters but is unknown: they are resolved together. ";
    if (event.joint && event.joint->not_unique) text += "The impulses are not unique; this is one choice. ";
    return text;
}

}  // namespace

void show_impact(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(title("Impact", session, event, index), time_of(session, index), state))
        commands.emplace_back(command::Select{0});
    const ImpactReason reason = explain_impact(session.trajectory(), index);
    show_rates(session, event);
    const SystemDescription& description = session.description();
    // In the units of the file; of several contacts that of the first that lands.
    std::size_t first = 0;
    while (first + 1 < session.model()->contacts() && !event.contacts.contains(first)) ++first;
    const auto with = [&](const std::string& value, const std::string& of) {
        const std::string unit = typeset_unit(unit_of_expression(description, of));
        return unit.empty() ? value : value + " " + unit;
    };
    const ShownUnit rate = shown_unit(unit_of_expression(description, output_names(description, "gap'")[first]));
    row("gap speed |h\u0307|", number_with_unit(number(event.impact_speed * rate.factor,
                                                       session.precision().of_gap_speed(index) * rate.factor, 9),
                                                rate.text));
    const double error = session.precision().of_energy(sample_at(session.trajectory(), event));
    row(with_unit("energy", typeset_unit(unit_of_expression(description, "energy"))),
        number(reason.energy_before, error, 6), number(reason.energy_after, error, 6));
    row("energy lost",
        with(
            number(without_noise(reason.energy_before - reason.energy_after, std::abs(reason.energy_before)), error, 6),
            "energy"));
    const bool several = session.model()->contacts() > 1;
    show_proved(session, index);
    std::string words =
        why_not_cut(reason, reason.attempt ? &*reason.attempt : nullptr, several, event.joint != nullptr,
                    shown_unit(unit_of_expression(description, output_names(description, "gap''")[first])));
    if (several) {
        for (const auto& [contact, impulse] : Impulses(session.trajectory()).of(index))
            row("impulse on " + description.constraints[contact].name,
                with(number(impulse), output_names(description, "lambda")[contact] + "*t"));
        words = what_is_held(session, event, reason) + words;
    }
    paragraph(words, remaining().width, text_color());
}

void show_release(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(title("Release", session, event, index), time_of(session, index), state))
        commands.emplace_back(command::Select{0});
    const ReleaseReason reason = explain_release(session.trajectory(), index);
    const Rectangle room = remaining();
    const float words = std::max(units(second_at), 0.45F * room.width);
    if (room.width - words > units(160.0F) && !reason.force.empty())
        paint(force_panel(session.theme(), event, reason), screen_style(session.theme()), ImGui::GetWindowDrawList(),
              {room.x + words, room.y, room.width - words, room.height}, units(1.0F));
    double most = 0.0;
    for (const auto& [t, lambda] : reason.force) most = std::max(most, std::abs(lambda));
    row("\u03bb", number(without_noise(reason.lambda, most), "{:.2g}"));
    row("\u03bb\u0307", number(reason.lambda_rate));
    row("h\u2034", number(reason.jerk));
    show_proved(session, index);
    paragraph(
        "The contact force \u03bb falls through zero: from here on the surface would have to pull. The gap and its "
        "first two derivatives are zero and the third, h\u2034, is positive, so the body leaves the surface.",
        words - units(16.0F), text_color());
}

}  // namespace achilles
