// The sensitivity panel, in place of the events. A bar for every slider shows how much the quantity would change over
// the slider's whole range according to its derivative.
#include "panels/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "figure/label.hpp"
#include "panels/slider.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

std::string formatted_quantity(const Sensitivities& known, double value, const char* format = "{:.4g}") {
    const ShownUnit unit = shown_unit(known.unit);
    return number_with_unit(number(value * unit.factor, format), unit.text);
}

double share_of(const Sensitivities& known, const Sensitivities::Sensitivity& by) {
    const double most = known.largest();
    return most > 0.0 ? by.change_over_slider / most : 0.0;
}

bool is_start(const SystemDescription& system, const std::string& name) {
    return std::none_of(system.parameters.begin(), system.parameters.end(),
                        [&](const ParameterDescription& p) { return p.name == name; });
}

std::string slider_name(const SystemDescription& system, const std::string& name) {
    return typeset(name) + (is_start(system, name) ? "(0)" : "");
}

std::string no_derivative(const std::string& reason) { return "no derivative here: " + typeset_sentence(reason); }

std::string explanation(const Session& session, const Sensitivities& known, const Sensitivities::Sensitivity& by) {
    if (!by.reason.empty()) return no_derivative(by.reason);
    const SystemDescription& system = session.description();
    return fmt::format("derivative of {}: {}, {} over the whole slider", typeset(known.quantity.expression),
                       derivative_text(system, known, by),
                       (by.change_over_slider > 0.0 ? "+" : "") + formatted_quantity(known, by.change_over_slider));
}

// ---- the quantity ----

// Quantities offered in the menu.
std::vector<std::string> offered_quantities(const Session& session) {
    constexpr int most = 6;
    std::vector<std::string> all;
    std::array<int, event_names.size()> counts{};
    for (const Event& event : session.trajectory().events) {
        const int k = ++counts[static_cast<std::size_t>(event.kind)];
        if (!event.is_impact() && k <= most) all.push_back(fmt::format("{}_time({})", names_of(event.kind).word, k));
    }
    for (const CoordinateDescription& coordinate : session.description().coordinates)
        all.insert(all.end(), {coordinate.name, coordinate.name + "'"});
    all.emplace_back("energy");
    return all;
}

void show_quantities(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginPopup("depend quantity")) return;
    for (const std::string& quantity : offered_quantities(session)) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        if (ImGui::Selectable(("##" + quantity).c_str(), session.depend_text() == quantity, 0, {units(230.0F), 0.0F}))
            commands.emplace_back(command::ShowSensitivity{quantity});
        remember(state, "depend quantity " + quantity);
        cell(at, typeset(quantity), units(230.0F), text_color());
    }
    if (text_row("other", "depend expression", state.depend, 150.0F, state) && !state.depend.empty())
        commands.emplace_back(command::ShowSensitivity{state.depend});
    tooltip("an expression at the end, also with zeno_time(k), impact_time(k), impact_speed(k), release_time(k)");
    if (!session.error().empty()) show_message(session.error(), units(240.0F));
    close_by_escape(state);
    ImGui::EndPopup();
}

// Status text: which run the values belong to, and what the bars mean.
std::string remark_on_dependence(const Session& session) {
    if (session.sensitivities() == nullptr) return session.sensitivities_job().is_busy() ? "computing\u2026" : "";
    if (!session.sensitivities_are_current()) return "from the previous run; this run is being computed";
    if (!session.sensitivities()->quantity.refused.empty()) return "";
    return "bars: its linear change over each whole slider";
}

void show_head(const Session& session, PanelState& state, Commands& commands) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const Rectangle row{at.x, at.y, 0.0F, ImGui::GetFrameHeight()};
    const float right = ImGui::GetWindowPos().x + content_right(), y = at.y + ImGui::GetStyle().FramePadding.y;
    float x =
        menu_button("depend quantity", typeset(session.depend_text()), at.x, row, at.x + 0.4F * (right - at.x), state);
    tooltip("quantity to differentiate; certificates do not cover derivatives");
    show_quantities(session, state, commands);
    if (const Sensitivities* const known = session.sensitivities(); known != nullptr) {
        const std::string value = "= " + formatted_quantity(*known, known->quantity.value, "{:.9g}");
        const bool is_there = std::isfinite(known->quantity.value), is_old = !session.sensitivities_are_current();
        const float width = is_there ? std::min(width_of(value), std::max(0.0F, right - x)) : 0.0F;
        if (is_there) cell({x, y}, value, width, is_old ? faint_color() : text_color());
        x += width + units(16.0F);
    }
    const std::string remark_text = remark_on_dependence(session);
    const float width = std::min(width_of(remark_text), right - x);
    if (width > units(60.0F)) cell({std::floor(right - width), y}, remark_text, width, faint_color());
    ImGui::SetCursorScreenPos(at);
    ImGui::Dummy({0.0F, row.height});
}

// ---- the bars ----

// Widths of the parts of a line: name, bar, derivative.
constexpr float slider_name_width = 62.0F, number_width = 140.0F, bar_spacing = 28.0F, min_bar = 120.0F,
                max_bar = 560.0F;

struct Lines {
    Lines(std::size_t count, const Rectangle& room, float high) : height(high) {
        const auto fit = std::max<std::size_t>(static_cast<std::size_t>(std::max(0.0F, room.height / high - 1.0F)), 1);
        const float least = units(slider_name_width + min_bar + number_width + bar_spacing);
        const auto most = std::max<std::size_t>(static_cast<std::size_t>(room.width / least), 1);
        const std::size_t columns = std::clamp<std::size_t>((count + fit - 1) / fit, 1, most);
        each = (count + columns - 1) / columns;
        // Limit the length of bars; longer ones are not easier to read.
        const float others = units(slider_name_width + number_width + bar_spacing);
        width = std::min((room.width + units(bar_spacing)) / static_cast<float>(columns), others + units(max_bar));
        bar = std::max(units(8.0F), width - others);
        corner = {room.x, room.y};
    }
    std::size_t each = 0;  // lines per column
    float width = 0.0F, bar = 0.0F, height = 0.0F;
    ImVec2 corner;
    ImVec2 at(std::size_t i) const {
        const std::size_t column = i / each, row = i % each + 1;
        return {std::floor(corner.x + width * static_cast<float>(column)),
                std::floor(corner.y + height * static_cast<float>(row))};
    }
    // Middle of the bars in the column of line i.
    float middle(std::size_t i) const { return std::floor(at(i).x + units(slider_name_width) + 0.5F * bar); }
    float half() const { return 0.5F * bar - units(4.0F); }
};

// The scale above each column: zero, and plus and minus the largest value.
void paint_scale(const Sensitivities& known, const Lines& lines, std::size_t first) {
    const float middle = lines.middle(first);
    const auto put = [&](const std::string& text, float x, float share) {
        const float width = width_of(text);
        cell({std::floor(x - share * width), lines.corner.y}, text, width, faint_color());
    };
    const std::string end = formatted_quantity(known, known.largest(), "{:.3g}");
    put("\u2212" + end, middle - lines.half(), 0.0F);
    put("0", middle, 0.5F);
    put("+" + end, middle + lines.half(), 1.0F);
}

void paint_line(const Session& session, const Sensitivities& known, const Sensitivities::Sensitivity& by,
                const Lines& lines, std::size_t i) {
    const ImVec2 at = lines.at(i);
    const bool is_old = !session.sensitivities_are_current();
    const Color ink = is_old ? faint_color() : text_color();
    cell(at, slider_name(session.description(), by.name), units(slider_name_width - 6.0F), ink);
    const float middle = lines.middle(i), low = at.y, high = at.y + ImGui::GetTextLineHeight();
    const float left = middle - 0.5F * lines.bar;
    if (!by.reason.empty())
        return cell({left + units(4.0F), at.y}, no_derivative(by.reason), lines.bar + units(number_width) - units(8.0F),
                    faint_color());
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({middle, low}, {middle + units(1.0F), low + lines.height}, packed(current_theme().border));
    const float inset = 0.2F * (high - low), end = middle + static_cast<float>(share_of(known, by)) * lines.half();
    if (end != middle)
        list->AddRectFilled({std::min(middle, end), low + inset}, {std::max(middle, end), high - inset},
                            packed(is_old ? faint_color() : current_theme().accent, is_old ? 0.5F : 0.85F),
                            units(2.0F));
    const std::string text = derivative_text(session.description(), known, by);
    cell({left + lines.bar + units(8.0F), at.y}, text, units(number_width - 8.0F), ink);
}

void show_line(const Session& session, const Sensitivities& known, const Sensitivities::Sensitivity& by,
               const Lines& lines, std::size_t i, PanelState& state, Commands& commands) {
    const ImVec2 at = lines.at(i), size{lines.width - units(bar_spacing), ImGui::GetTextLineHeight()};
    ImGui::SetCursorScreenPos(at);
    if (ImGui::InvisibleButton(by.name.c_str(), size))
        commands.push_back(sweep_over(session, by.name, known.quantity.expression));
    remember(state, "depend " + by.name);
    const bool is_hovered = ImGui::IsItemHovered();
    if (is_hovered) state.lights = by.name;
    tooltip(explanation(session, known, by) + "; click to sweep " + slider_name(session.description(), by.name));
    if (is_hovered || by.name == state.lit || by.name == state.pointed_slider)
        ImGui::GetWindowDrawList()->AddRectFilled({at.x - units(4.0F), at.y}, {at.x + size.x, at.y + size.y},
                                                  packed(current_theme().accent, 0.16F), units(3.0F));
    paint_line(session, known, by, lines, i);
}

void show_bars(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle room = remaining();
    const std::string& problem = session.sensitivities_job().problem();
    const Sensitivities* const known = session.sensitivities();
    if (!problem.empty()) return paragraph(no_derivative(problem), room.width, text_color());
    if (known == nullptr) return;
    if (!known->quantity.refused.empty())
        return paragraph(no_derivative(known->quantity.refused), room.width, text_color());
    const Lines lines(known->all.size(), room, ImGui::GetTextLineHeightWithSpacing());
    for (std::size_t i = 0; i < known->all.size(); ++i) {
        if (i % lines.each == 0) paint_scale(*known, lines, i);
        show_line(session, *known, known->all[i], lines, i, state, commands);
    }
}

}  // namespace

std::string derivative_text(const SystemDescription& system, const Sensitivities& known,
                            const Sensitivities::Sensitivity& by) {
    if (!by.reason.empty()) return "none";
    const ShownUnit unit = shown_unit_of_setting(system, by.name);
    const std::string text = formatted_quantity(known, by.derivative / unit.factor);
    return unit.text.empty() ? text : text + " per " + unit.text;
}

command::ShowSweep sweep_over(const Session& session, const std::string& name, const std::string& quantity) {
    SweepSpec sweep;
    SweepAxis axis = *axis_for(session, name);
    axis.logarithmic = has_log_scale(axis.low, axis.high);
    sweep.axes = {axis};
    sweep.prints = {quantity};
    return showing(sweep, session.description());
}

void put_bar(const Session& session, Slider& slider) {
    const Sensitivities* const known = session.sensitivities();
    const Sensitivities::Sensitivity* const by = known == nullptr ? nullptr : known->find(slider.varies);
    if (by == nullptr) return;
    slider.bar_about = explanation(session, *known, *by);
    slider.bar_is_old = !session.sensitivities_are_current();
    if (slider.bar_is_old) slider.bar_about += " (from the previous run)";
    if (by->reason.empty()) slider.bar = static_cast<float>(share_of(*known, *by));
}

void show_dependence(const Session& session, PanelState& state, Commands& commands) {
    begin_study("dependence");
    show_head(session, state, commands);
    show_bars(session, state, commands);
    ImGui::EndChild();
}

}  // namespace achilles
