// The equations panel, in place of the events, with the current state of the Zeno conditions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "model/model.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "paint/paint.hpp"
#include "panels/widgets.hpp"
#include "session/equations_view.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

constexpr float study_padding = 12.0F;

// "m1 = 2 kg", "theta1 = 30° now", with the description from the file.
std::string value_description(const Session& session, const std::string& name) {
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

// The current state of a condition, and whether it applies now.
struct ConditionValue {
    std::string text;
    bool applies = false;
};

ConditionValue now_of(const Session& session, EquationsView& view, const SheetCondition& condition, std::size_t index) {
    const Model& model = *session.model();
    const Mode mode = session.now().mode;
    const std::string contact =
        model.contacts() == 1 ? "the contact" : model.description().constraints[condition.contact].name;
    if (mode.is_held(condition.contact)) return {fmt::format("now {} is held", contact), false};
    if (mode != condition.mode)
        return {fmt::format("not now: {} is held", mode.is_free() ? "nothing" : joined_names(model, mode.held())),
                false};
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

    void draw(const TypesetSheet& page) {
        for (const TypesetSheet::SheetLine& line : page.lines)
            if (is_seen(line.y - line.box.ascent, line.y + line.box.descent)) mark(line);
        for (const TypesetSheet::SheetLine& line : page.lines)
            if (is_seen(line.y - line.box.ascent, line.y + line.box.descent))
                paint_formula(list_, line.box, corner_.x + line.x, corner_.y + line.y, ink(line.ink));
    }

    void draw(const TypesetSheet::ConditionPlace& place, EquationsView& view) {
        const float line = ImGui::GetTextLineHeight();
        if (!is_seen(place.y, place.y + 2.0F * line)) return;
        const ConditionValue now = now_of(session_, view, sheet_.conditions[place.condition], place.condition);
        const ImVec2 at{std::round(corner_.x + place.x), std::round(corner_.y + place.y)};
        const float r = units(3.0F), text = units(12.0F);
        if (now.applies) list_->AddCircleFilled({at.x + r, at.y + 0.5F * line}, r, packed(current_theme().accent), 16);
        cell({at.x + text, at.y}, now.text, place.width - text, now.applies ? text_color() : faint_color());
    }

 private:
    bool is_seen(float from, float to) const { return corner_.y + to >= top_ && corner_.y + from <= bottom_; }
    static Color ink(TypesetSheet::Ink ink) { return ink == TypesetSheet::Ink::caption ? faint_color() : text_color(); }

    // Highlights names that are pointed at, here or on a slider, and shows a tooltip.
    void mark(const TypesetSheet::SheetLine& line) {
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
                tooltip(value_description(session_, name));
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

bool derives_equations(const PanelState& state) {
    return state.equations != nullptr && state.equations->is_under_way();
}

void show_equations(const Session& session, PanelState& state, Commands&) {
    if (state.equations == nullptr) state.equations = std::make_shared<EquationsView>();
    EquationsView& view = *state.equations;
    // A picture waits for the equations; a window does not.
    const EquationSheet* sheet = view.sheet(session.model(), session.run(), state.in_window ? Timeout(0.0) : Timeout());
    begin_study("equations");
    const Rectangle room = remaining();
    // Reserve the width of a scroll bar, so that its appearance does not change the layout.
    const float bar = ImGui::GetStyle().ScrollbarSize, size = ImGui::GetFontSize();
    const float width = ImGui::GetWindowWidth() - 2.0F * units(study_padding) - bar;
    const float height = ImGui::GetWindowHeight() - 2.0F * units(6.0F);
    std::erase_if(state.places, [](const auto& place) { return place.first.starts_with("equation "); });
    // The mechanism stands above the equations. It is there at once, while they may take seconds.
    const EquationSheet& mechanism = view.mechanism(session.model(), session.run());
    const TypesetSheet& bodies = view.typeset_mechanism(size, formula_font(), width, 0.5F * height);
    PageDrawing(session, state, mechanism, {room.x, room.y}).draw(bodies);
    const float top = room.y + std::ceil(bodies.height + (bodies.lines.empty() ? 0.0F : before_heading * size));
    ImGui::SetCursorScreenPos({room.x, top});
    if (sheet == nullptr) {
        ImGui::TextDisabled("The equations are being simplified\u2026");
    } else {
        const TypesetSheet& page = view.typeset_sheet(size, formula_font(), width, height);
        PageDrawing drawing(session, state, *sheet, {room.x, top});
        drawing.draw(page);
        for (const TypesetSheet::ConditionPlace& now : page.now) drawing.draw(now, view);
        ImGui::SetCursorScreenPos({room.x, top});
        ImGui::Dummy({std::max(page.width, bodies.width), page.height});
    }
    ImGui::EndChild();
}

}  // namespace achilles
