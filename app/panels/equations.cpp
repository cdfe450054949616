// Below, in place of the events: the equations, and what the Zeno conditions are now.
#include "panels/equations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "model/derived_values.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "paint/formula.hpp"
#include "paint/label.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr float page_padding = 12.0F;

// One of those that share the place; the one that is seen is underlined.
bool tab(const char* title, const char* place, const char* about, bool is_seen, PanelState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), text = ImGui::CalcTextSize(title);
    const bool is_pressed = ImGui::InvisibleButton(place, {text.x, ImGui::GetFrameHeight()});
    remember(state, place);
    const Color color = is_seen || ImGui::IsItemHovered() ? text_color() : faint_color();
    tooltip(about);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddText({at.x, at.y + ImGui::GetStyle().FramePadding.y}, packed(color), title);
    const float low = at.y + ImGui::GetFrameHeight();
    if (is_seen) list->AddRectFilled({at.x, low - units(2.0F)}, {at.x + text.x, low}, packed(current_theme().accent));
    return is_pressed && !is_seen;
}

// "m1 = 2 kg", "theta1 = 30° now", with what the file says about it.
std::string told(const Session& session, const std::string& name) {
    const SystemDescription& system = session.description();
    const auto value = [](double x, const std::string& unit, bool is_rate) {
        const bool is_angle = unit == "rad";
        const std::string shown = is_angle ? "\u00b0" : unit.empty() ? "" : "\u00a0" + unit;
        return number(is_angle ? degrees(x) : x) + shown + (is_rate && !unit.empty() ? "/s" : "");
    };
    for (std::size_t i = 0; i < system.parameters.size(); ++i)
        if (const ParameterDescription& p = system.parameters[i]; p.name == name)
            return fmt::format("{} = {}{}{}", name, value(session.run().parameters[i], p.unit, false),
                               p.about.empty() ? "" : "\n", p.about);
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
        const CoordinateDescription& c = system.coordinates[i];
        const State& now = session.now().state;
        const auto at = static_cast<Eigen::Index>(i);
        if (c.name == name) return fmt::format("{} = {} now", name, value(now.q[at], c.unit, false));
        if (c.name + "'" == name) return fmt::format("{} = {} now", name, value(now.v[at], c.unit, true));
    }
    return fmt::format("{} = {} now", name, value(session.now().t, "s", false));
}

// What a condition says of the present, and whether it applies.
struct Now {
    std::string text;
    bool applies = false;
};

Now now_of(const Session& session, EquationsView& view, const SheetCondition& condition, std::size_t index) {
    const Model& model = *session.model();
    const ContactSet held = session.now().held;
    const std::string contact =
        model.contacts() == 1 ? "the contact" : model.description().constraints[condition.contact].name;
    if (held.contains(condition.contact)) return {fmt::format("now {} is held", contact), false};
    if (held != condition.held)
        return {fmt::format("not now: {} is held", held.empty() ? "nothing" : joined_names(model, held)), false};
    const double value = view.value(index, model, session.trajectory().run, session.now().state, session.now().t);
    if (!std::isfinite(value)) return {"not defined now", true};
    const std::string shown = number(value, "{:.4g}");
    if (value < 0.0) {
        const double e = model.restitution(session.trajectory().run.parameters, condition.contact);
        return {fmt::format("now {} < 0: {}", shown,
                            e >= 1.0   ? "but with restitution 1 bounces never die out"
                            : e <= 0.0 ? "with restitution 0 an impact ends on the surface"
                                       : "bouncing would end at a Zeno point"),
                true};
    }
    return {fmt::format("now {} \u2265 0: bouncing would not end, the gap opens", shown), true};
}

class PageDrawing {
 public:
    PageDrawing(const Session& session, PanelState& state, const EquationSheet& sheet, const ImVec2& corner)
        : session_(session), state_(state), sheet_(sheet), corner_(corner), list_(ImGui::GetWindowDrawList()) {
        const ImVec2 low = list_->GetClipRectMin(), high = list_->GetClipRectMax();
        top_ = low.y;
        bottom_ = high.y;
    }

    void draw(const SetSheet& page) {
        for (const SetSheet::Line& line : page.lines)
            if (is_seen(line.y - line.box.ascent, line.y + line.box.descent)) mark(line);
        for (const SetSheet::Line& line : page.lines)
            if (is_seen(line.y - line.box.ascent, line.y + line.box.descent))
                paint_formula(list_, line.box, corner_.x + line.x, corner_.y + line.y, ink(line.ink));
    }

    void draw(const SetSheet::Now& place, EquationsView& view) {
        const float line = ImGui::GetTextLineHeight();
        if (!is_seen(place.y, place.y + 2.0F * line)) return;
        const Now now = now_of(session_, view, sheet_.conditions[place.condition], place.condition);
        const ImVec2 at{std::round(corner_.x + place.x), std::round(corner_.y + place.y)};
        const float r = units(3.0F), text = units(12.0F);
        if (now.applies) list_->AddCircleFilled({at.x + r, at.y + 0.5F * line}, r, packed(current_theme().accent), 16);
        cell({at.x + text, at.y}, now.text, place.width - text, now.applies ? text_color() : faint_color());
    }

 private:
    bool is_seen(float from, float to) const { return corner_.y + to >= top_ && corner_.y + from <= bottom_; }
    static Color ink(SetSheet::Ink ink) { return ink == SetSheet::Ink::caption ? faint_color() : text_color(); }

    // Behind a name that is pointed at, here or by its slider; and who it is.
    void mark(const SetSheet::Line& line) {
        for (const FormulaBox::Letters& one : line.box.letters) {
            if (one.name < 0) continue;
            const std::string& name = sheet_.symbols[static_cast<std::size_t>(one.name)].name;
            const float x = corner_.x + line.x + one.x, y = corner_.y + line.y + one.y;
            const ImVec2 low{x - units(1.0F), y - 0.8F * one.size},
                high{x + one.width + units(1.0F), y + 0.3F * one.size};
            state_.places.try_emplace("equation " + name, Rectangle{low.x, low.y, high.x - low.x, high.y - low.y});
            if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(low, high) && !ImGui::IsAnyMouseDown()) {
                state_.lights = name;
                const ImVec2 cursor = ImGui::GetCursorScreenPos();
                ImGui::SetCursorScreenPos(low);
                ImGui::Dummy({high.x - low.x, high.y - low.y});
                tooltip(told(session_, name));
                ImGui::SetCursorScreenPos(cursor);
            }
            if (name == state_.lit || name == state_.pointed_slider)
                list_->AddRectFilled(low, high, packed(current_theme().accent, 0.22F), units(2.0F));
        }
    }

    const Session& session_;
    PanelState& state_;
    const EquationSheet& sheet_;
    ImVec2 corner_;
    ImDrawList* list_;
    float top_ = 0.0F, bottom_ = 0.0F;
};

}  // namespace

void show_lower_tabs(const Session& session, PanelState& state, Commands& commands) {
    const std::string seen = session.scene().below();
    if (tab("Events", "tab events", "the events of the run", seen == "events", state)) {
        commands.emplace_back(command::Show{seen, false});
        if (!session.scene().shows("events")) commands.emplace_back(command::Show{"events", true});
    }
    ImGui::SameLine(0.0F, units(14.0F));
    if (tab("Equations", "tab equations", "the equations of motion and the Zeno condition", seen == "equations", state))
        commands.emplace_back(command::Show{"equations", true});
    const auto name_of = [&](const char* what, const char* title, const char* place, const char* about) {
        if (seen != what) return;
        ImGui::SameLine(0.0F, units(14.0F));
        tab(title, place, about, true, state);
    };
    name_of("depend", "Dependence", "tab depend", "derivatives of a quantity of the run");
    name_of("orbit", "Periodic run", "tab orbit", "a periodic run and its branch in a parameter");
}

bool derives_equations(const PanelState& state) {
    return state.equations != nullptr && state.equations->is_under_way();
}

void show_equations(const Session& session, PanelState& state, Commands& commands) {
    show_lower_tabs(session, state, commands);
    if (state.equations == nullptr) state.equations = std::make_shared<EquationsView>();
    EquationsView& view = *state.equations;
    // A picture waits for them; a window has other things to do.
    const EquationSheet* sheet =
        view.sheet(session.model(), session.run(), state.in_window ? Patience(0.0) : Patience());
    ImGui::PushStyleColor(ImGuiCol_ChildBg, packed(session.theme().background));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(page_padding), units(8.0F)});
    begin_padded_child("equations", {0.0F, std::max(1.0F, ImGui::GetContentRegionAvail().y)});
    if (sheet == nullptr) {
        ImGui::TextDisabled("The equations are being simplified\u2026");
    } else {
        const Rectangle room = remaining();
        // As wide with a scroll bar as without one: what appears must not set everything anew.
        const float bar = ImGui::GetStyle().ScrollbarSize;
        const float width = ImGui::GetWindowWidth() - 2.0F * units(page_padding) - bar;
        const SetSheet& page =
            view.set(ImGui::GetFontSize(), formula_font(), width, ImGui::GetWindowHeight() - 2.0F * units(8.0F));
        std::erase_if(state.places, [](const auto& place) { return place.first.starts_with("equation "); });
        PageDrawing drawing(session, state, *sheet, {room.x, room.y});
        drawing.draw(page);
        for (const SetSheet::Now& now : page.now) drawing.draw(now, view);
        ImGui::SetCursorScreenPos({room.x, room.y});
        ImGui::Dummy({page.width, page.height});
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

}  // namespace achilles
