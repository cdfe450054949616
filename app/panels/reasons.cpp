// Why an event is what it is: the cards of impacts and releases beside the list.
#include <fmt/format.h>

#include <cmath>

#include "figure/label.hpp"
#include "output/output.hpp"
#include "paint/label.hpp"
#include "panels/widgets.hpp"
#include "simulate/explain.hpp"

namespace achilles {

namespace {

constexpr float value_at = 150.0F, second_at = 270.0F;

// A name and its values in columns.
void row(const std::string& name, const std::string& first, const std::string& second = {}) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize();
    paint_label(list, at.x, at.y, name, faint_color(), size);
    paint_label(list, at.x + units(value_at), at.y, first, text_color(), size);
    if (!second.empty()) paint_label(list, at.x + units(second_at), at.y, second, text_color(), size);
    ImGui::Dummy({units(second_at + 90.0F), ImGui::GetTextLineHeight()});
}

// The rates before and after, in the units that are shown.
void show_rates(const Session& session, const Event& event) {
    row("", "before", "after");
    const auto& coordinates = session.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const bool is_angle = coordinates[i].unit == "rad";
        const double factor = is_angle ? 57.29577951308232 : 1.0;
        const auto at = static_cast<Eigen::Index>(i);
        row(typeset_name(coordinates[i].name + "'") + (is_angle ? " [\u00b0/s]" : ""),
            number(event.v_before[at] * factor), number(event.v_after[at] * factor));
    }
}

// The first inequality that does not hold, if any.
const Inequality* failed(const Certificate& certificate) {
    for (const Inequality& inequality : certificate.inequalities)
        if (!(inequality.left < inequality.right)) return &inequality;
    return nullptr;
}

std::string why_not_cut(const ImpactReason& reason, const Certificate* attempt) {
    if (!(reason.normal_acceleration < 0.0))
        return fmt::format("Not cut: the surface falls away here, h\u0308 = {}.", number(reason.normal_acceleration));
    if (attempt == nullptr) return "Not cut: nothing can be proved yet, h\u0308 may change its sign on the way.";
    const Inequality* inequality = failed(*attempt);
    if (inequality == nullptr) return "Not cut: an impact before the conditions were asked.";
    if (!(inequality->right > 0.0)) return fmt::format("Not cut: the {} is not proved.", inequality->name);
    return fmt::format("Not cut: the {} asks for {} < {}; it is {} times too large.", inequality->name,
                       number(inequality->left, "{:.3g}"), number(inequality->right, "{:.3g}"),
                       number(inequality->left / inequality->right, "{:.3g}"));
}

void wrapped(const std::string& text) {
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace

void show_impact(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(fmt::format("Impact, event {}", index + 1), fmt::format("t = {:.10g} s", event.t), state))
        commands.emplace_back(command::Select{0});
    const ImpactReason reason = explain_impact(session.trajectory(), index);
    show_rates(session, event);
    row("impact speed", number(event.impact_speed, "{:.9g}"));
    const double lost = reason.energy_before - reason.energy_after;
    row("energy lost", number(lost, "{:.6g}"), "of " + number(reason.energy_before));
    wrapped(why_not_cut(reason, reason.attempt ? &*reason.attempt : nullptr));
}

void show_release(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    if (show_card_title(fmt::format("Release, event {}", index + 1), fmt::format("t = {:.10g} s", event.t), state))
        commands.emplace_back(command::Select{0});
    const ReleaseReason reason = explain_release(session.trajectory(), index);
    row("\u03bb", number(reason.lambda, "{:.2g}"));
    row("\u03bb\u0307", number(reason.lambda_rate));
    row("h\u2034", number(reason.jerk));
    wrapped(
        "The contact force crosses zero; h, h\u0307 and h\u0308 vanish and the third rate of the gap is positive: the "
        "body leaves the surface.");
}

}  // namespace achilles
