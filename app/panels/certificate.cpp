// Beside the list of events: what is proved at the chosen Zeno point, and by how much each inequality holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/bounds.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "panels/print.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

// The share of the right-hand side that the left one uses up: 0 is a wide margin, 1 none. An inequality whose right
// side is 0 (a sign) has none.
double share_of(const Inequality& inequality) {
    return inequality.right > 0.0 ? std::clamp(inequality.left / inequality.right, 0.0, 1.0) : 0.0;
}

void quiet(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, packed(faint_color()));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

// One row: name, left < right, and a bar of how much of the right side is used. The one that decided is set off.
void show_inequality(const Inequality& inequality, bool decisive) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Color color = decisive ? text_color() : faint_color();
    std::string name(inequality.name);
    if (const std::size_t at_power = name.find("^2"); at_power != std::string::npos)
        name.replace(at_power, 2, "\u00b2");
    list->AddText(at, packed(color), name.c_str());
    const std::string sides = with_minus(fmt::format("{:.3g} < {:.3g}", inequality.left, inequality.right));
    const ImVec2 middle{std::floor(at.x + units(138.0F)), at.y};
    cell(middle, sides, std::min(units(150.0F), at.x + width + units(6.0F) - middle.x), color);  // into the margin
    const float left = std::floor(at.x + units(292.0F)), room = std::min(at.x + width - left, units(180.0F));
    const float top = at.y + 0.35F * line, bottom = at.y + 0.7F * line;
    if (room > units(12.0F) && inequality.right > 0.0) {
        list->AddRectFilled({left, top}, {left + room, bottom}, packed(faint_color(), 0.25F), units(2.0F));
        const float used = std::max(units(2.0F), room * static_cast<float>(share_of(inequality)));
        list->AddRectFilled({left, top}, {left + used, bottom},
                            decisive ? ImGui::GetColorU32(ImGuiCol_SliderGrabActive) : packed(faint_color()),
                            units(2.0F));
    }
    ImGui::Dummy({width, line});
    tooltip(decisive ? inequality.left < inequality.right ? "the tightest of these inequalities"
                                                          : "this does not hold: shorter flights cannot be resolved"
                     : "the bar shows the left side as a share of the right side");
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

std::vector<std::string> certificate_lines(const Event& event) {
    constexpr int digits = 6;
    const Certificate& c = *event.certificate;
    std::vector<std::string> lines;
    if (is_plastic_landing(event)) {
        lines.emplace_back("stays in contact without a bounce");
        lines.push_back(
            with_minus("gap'' from " + rounded_down(-c.a_max, digits) + " to " + rounded_up(-c.a_min, digits)));
        return lines;
    }
    lines.push_back("Zeno time \u03c4\u221e in " + interval_text(c.zeno_low, c.zeno_high));
    lines.push_back(fmt::format("cut to \u03c4\u221e: q moves < {}, v < {}", bound_text(c.position_bound),
                                bound_text(c.velocity_bound)));
    if (c.uniform_position)
        lines.push_back(fmt::format("error until \u03c4\u221e: q \u2264 {}", bound_text(*c.uniform_position)));
    if (c.shadowing_position)
        lines.push_back(fmt::format("error at \u03c4\u221e: q \u2264 {}, v \u2264 {}",
                                    bound_text(*c.shadowing_position), bound_text(*c.shadowing_velocity)));
    lines.push_back("gap'' from " + rounded_down(-c.a_max, digits) + " to " + rounded_up(-c.a_min, digits));
    if (c.below_rounding) lines.emplace_back("cut below rounding: no shorter flight is resolved");
    for (std::string& line : lines) line = with_minus(std::move(line));
    return lines;
}

namespace {

// A word that opens the lens in place of the plots, and closes it.
void lens_button(const Session& session, PanelState& state, Commands& commands) {
    const bool open = session.scene().shows("lens");
    const char* const name = open ? "close the Zeno lens" : "open the Zeno lens";
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::CalcTextSize(name);
    if (ImGui::InvisibleButton("lens", size)) commands.emplace_back(command::Show{"lens", !open});
    remember(state, "open lens");
    const ImU32 color = ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_SliderGrab);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText(at, color, name);
    list->AddLine({at.x, at.y + size.y}, {at.x + size.x, at.y + size.y}, color, units(1.0F));
    tooltip("show the bouncing before this Zeno point in logarithmic time, in place of the plots");
}

}  // namespace

// "; q in rad, v in rad/s": of what stands below.
std::string units_told(const SystemDescription& description) {
    const NormUnits unit = norm_units(description);
    return unit.position.empty() ? "" : fmt::format("; q in{}, v in{}", unit.position, unit.velocity);
}

void show_zeno(const Session& session, std::size_t index, PanelState& state, Commands& commands) {
    const Event& event = session.trajectory().events[index];
    const Certificate& certificate = *event.certificate;
    const bool is_plastic = is_plastic_landing(event);
    const std::string contacts = contacts_told(session.trajectory(), event);
    const bool close =
        show_card_title(fmt::format("{}{}{}, event {}: {}", is_plastic ? "Landing" : "Zeno point",
                                    contacts.empty() ? "" : " of ", contacts, index + 1,
                                    is_plastic              ? "plastic"
                                    : certificate.certified ? "certified"
                                                            : "not certified"),
                        fmt::format("{} conditions, {} restart{}", to_text(certificate.conditions),
                                    to_text(certificate.reinitialization), units_told(session.description())),
                        state);
    if (close) commands.emplace_back(command::Select{0});
    if (!is_plastic) lens_button(session, state, commands);
    if (const std::string proved = proved_text(session, index); !proved.empty()) {
        if (!is_plastic) ImGui::SameLine(0.0F, units(24.0F));
        ImGui::TextUnformatted(proved.c_str());
        tooltip(
            "covers the whole run from its start, with integration and all cuts; the bounds below cover this cut "
            "alone");
    }
    if (const auto horizon = session.horizon(); horizon && event.t > *horizon)
        return paragraph(fmt::format("The run is not trusted after t = {:.6g} s: this certificate is about the "
                                     "computed motion, which no longer follows the motion of this system.",
                                     *horizon),
                         remaining().width, text_color());
    show_certificate(event);
    const auto& others = certificate.others;
    const std::string told = others ? others_told(*session.model(), *others) : "";
    if (!told.empty()) paragraph("Until then " + told + ".", remaining().width, text_color());
}

void show_certificate(const Event& event) {
    const std::vector<std::string> lines = certificate_lines(event);
    float half = 0.44F * ImGui::GetContentRegionAvail().x;
    for (const std::string& line : lines) half = std::max(half, ImGui::CalcTextSize(line.c_str()).x + units(14.0F));
    half = std::floor(half);
    const float top = ImGui::GetCursorPosY(), left = ImGui::GetCursorPosX();
    for (const std::string& line : lines) ImGui::TextUnformatted(line.c_str());
    const float below = ImGui::GetCursorPosY();
    ImGui::SetCursorPos({left + half, top});
    ImGui::BeginGroup();
    for (const Inequality& inequality : event.certificate->inequalities())
        show_inequality(inequality, inequality.name == event.certificate->decisive);
    ImGui::EndGroup();
    ImGui::SetCursorPosY(std::max(below, ImGui::GetCursorPosY()));
    ImGui::PushTextWrapPos(0.0F);
    quiet(is_plastic_landing(event) ? "Not covered: integration and rounding errors before it."
                                    : "For the exact motion from the computed state at the cut. Not covered: "
                                      "integration and rounding errors, and the combined effect of several cuts.");
    ImGui::PopTextWrapPos();
}

}  // namespace achilles
