#include "panels/slider.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "expression/parse.hpp"
#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

bool is_logarithmic(const Slider& slider) { return has_log_scale(slider.low, slider.high); }

double rounded(double value, int digits) { return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr); }

// Conversion of a value in the displayed unit to its share of the track, and back.
double share_of(const Slider& slider, double value) {
    const double low = slider.low * slider.factor, high = slider.high * slider.factor;
    return is_logarithmic(slider) ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}
double value_at_share(const Slider& slider, double share) {
    const double low = slider.low * slider.factor, high = slider.high * slider.factor, at = std::clamp(share, 0.0, 1.0);
    return is_logarithmic(slider) ? low * std::pow(high / low, at) : low + at * (high - low);
}

// The same geometry as ImGui's grab: the usable part of the track.
constexpr float grab_padding = 2.0F;
float usable(float width) { return std::max(1.0F, width - ImGui::GetStyle().GrabMinSize - 2.0F * grab_padding); }
float grab_at(float left, float width, double share) {
    return left + grab_padding + 0.5F * ImGui::GetStyle().GrabMinSize + static_cast<float>(share) * usable(width);
}

// "30°", "2 m", with this many digits.
std::string shown(const Slider& slider, double value, int digits = 6) {
    return number_with_unit(number(rounded(value * slider.factor, std::min(digits, slider.digits + 2))), slider.unit);
}

// With as many digits as fit; without its unit where not even two would, since half a unit is another one.
std::string shown_in(float width, const Slider& slider, double value) {
    for (int digits = 6; digits > 1; --digits)
        if (const std::string text = shown(slider, value, digits); ImGui::CalcTextSize(text.c_str()).x <= width)
            return text;
    return fitted(number(rounded(value * slider.factor, 2)), width);
}

// One line; F1 has the mouse and the keys.
std::string explanation(const Slider& slider) {
    std::string text = slider.about + (slider.about.empty() ? "" : " \u00b7 ");
    text += number(slider.low * slider.factor) + " to " + shown(slider, slider.high);
    if (is_logarithmic(slider)) text += ", logarithmic";
    if (slider.value != slider.original) text += " \u00b7 in the file " + shown(slider, slider.original);
    return text + (slider.bar_about.empty() ? "" : " \u00b7 " + slider.bar_about);
}

// A thin track behind a slider with invisible frame, with a mark at the file's value.
void paint_track(const Slider& slider, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float y = std::floor(at.y + 0.5F * ImGui::GetFrameHeight()), half = units(2.0F);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({at.x, y - half}, {at.x + width, y + half}, packed(current_theme().border), half);
    if (slider.value == slider.original || !(slider.original >= slider.low && slider.original <= slider.high)) return;
    const float x = std::floor(grab_at(at.x, width, share_of(slider, slider.original * slider.factor)));
    list->AddRectFilled({x - units(1.0F), y - units(6.0F)}, {x + units(1.0F), y + units(6.0F)}, packed(faint_color()));
}

// The sensitivity bar below the track: from its middle to the left or right.
void paint_bar(const Slider& slider, const ImVec2& at, float width) {
    if (!slider.bar) return;
    const float middle = std::floor(at.x + 0.5F * width), low = at.y + ImGui::GetFrameHeight() - units(1.0F);
    const float end = middle + std::clamp(*slider.bar, -1.0F, 1.0F) * 0.5F * usable(width);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({std::min(middle, end), low}, {std::max(middle, end), low + units(2.0F)},
                        packed(slider.bar_is_old ? faint_color() : current_theme().accent, 0.8F));
    list->AddRectFilled({middle, low - units(1.0F)}, {middle + units(1.0F), low + units(3.0F)}, packed(faint_color()));
}

// Handles a press with the mouse at value `target`; returns true if the slider takes this value now. A press without
// motion may start a double click, so it waits for the double-click time.
bool takes_effect(const Slider& slider, double target, PressedSlider& pressed) {
    constexpr float slip = 3.0F;  // click tolerance, pixels
    const ImGuiIO& io = ImGui::GetIO();
    const double now = ImGui::GetTime();
    const auto is_late = [&](double since) { return now - since > double{io.MouseDoubleClickTime}; };
    if (ImGui::IsItemActivated()) {
        pressed.id = slider.id;
        pressed.since = now;
        pressed.is_drag = false;
        if (pressed.clicked == slider.id) pressed.clicked.clear();
    }
    if (pressed.id == slider.id && ImGui::IsItemActive()) {
        const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0.0F);
        pressed.is_drag = pressed.is_drag || std::hypot(moved.x, moved.y) > slip || is_late(pressed.since);
        pressed.target = target;
        return pressed.is_drag;
    }
    if (pressed.id == slider.id && ImGui::IsItemDeactivated() && !pressed.is_drag) {
        pressed.clicked = slider.id;
        pressed.clicked_since = pressed.since;
        pressed.clicked_target = pressed.target;
    }
    return false;
}

// True if a click was not followed by a second one.
bool was_clicked(Slider& slider, PressedSlider& pressed) {
    if (pressed.clicked != slider.id) return false;
    const ImGuiIO& io = ImGui::GetIO();
    const bool late = ImGui::GetTime() - pressed.clicked_since > double{io.MouseDoubleClickTime};
    if (!late && !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return false;
    pressed.clicked.clear();
    return std::exchange(slider.value, pressed.clicked_target) != pressed.clicked_target;
}

constexpr double fine_gain = 1.0 / 20.0;

// The share of the track that the mouse selects; after Shift was pressed, relative to that point and slower.
double held_share(const Slider& slider, double absolute, float width, PressedSlider& pressed) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActivated()) {
        pressed.is_fine = pressed.is_relative = false;
        const double there = share_of(slider, slider.value * slider.factor);
        pressed.share = io.KeyShift && std::isfinite(there) ? there : absolute;
    }
    if (io.KeyShift != pressed.is_fine) {
        pressed.is_fine = io.KeyShift;
        pressed.is_relative = true;
        pressed.from_x = io.MousePos.x;
        pressed.from_share = pressed.share;
    }
    const double gone = (io.MousePos.x - pressed.from_x) / usable(width) * (pressed.is_fine ? fine_gain : 1.0);
    pressed.share = std::clamp(pressed.is_relative ? pressed.from_share + gone : absolute, 0.0, 1.0);
    return pressed.share;
}

// The value selected by the mouse, in the file's units: the current value or the file's value if within half a pixel,
// else the roundest number within it.
double value_at_mouse(const Slider& slider, double share, float width, bool is_fine) {
    const double half = 0.5 / usable(width) * (is_fine ? fine_gain : 1.0);
    for (const double sticky : {slider.value, slider.original})
        if (std::abs(share_of(slider, sticky * slider.factor) - share) <= half) return sticky;
    return roundest(value_at_share(slider, share - half), value_at_share(slider, share + half)) / slider.factor;
}

// The slider itself. ImGui's value text is hidden, since it is shown beside the slider. The format has 15 digits, since
// ImGui derives the precision of a logarithmic scale from it.
bool dragged(Slider& slider, float width, PressedSlider& pressed) {
    paint_track(slider, width);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    // ImGui's grab follows the mouse, while ours lags behind with Shift: draw our own.
    const bool is_ours = pressed.id == slider.id && pressed.is_relative && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    for (const ImGuiCol color : {ImGuiCol_FrameBg, ImGuiCol_FrameBgActive, ImGuiCol_FrameBgHovered, ImGuiCol_Text})
        ImGui::PushStyleColor(color, 0U);
    const ImU32 grab = ImGui::GetColorU32(ImGuiCol_SliderGrabActive);
    if (is_ours) ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, 0U);
    ImGui::SetNextItemWidth(width);
    double value = slider.value * slider.factor;
    const double low = slider.low * slider.factor, high = slider.high * slider.factor;
    ImGui::SliderScalar(
        ("##" + slider.id).c_str(), ImGuiDataType_Double, &value, &low, &high, "%.15g",
        ImGuiSliderFlags_NoInput | (is_logarithmic(slider) ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None));
    ImGui::PopStyleColor(is_ours ? 5 : 4);
    double target = slider.value;
    if (ImGui::IsItemActive()) {
        const double share = held_share(slider, share_of(slider, value), width, pressed);
        target = value_at_mouse(slider, share, width, pressed.is_fine);
    }
    if (is_ours) {
        const float x = grab_at(at.x, width, pressed.share), half = 0.5F * ImGui::GetStyle().GrabMinSize;
        ImGui::GetWindowDrawList()->AddRectFilled({x - half, at.y + grab_padding},
                                                  {x + half, at.y + ImGui::GetFrameHeight() - grab_padding}, grab,
                                                  ImGui::GetStyle().GrabRounding);
    }
    if (takes_effect(slider, target, pressed) && target != slider.value) {
        slider.value = target;
        return true;
    }
    return was_clicked(slider, pressed);
}

void begin_typing(const Slider& slider, TypedValue& typed);

// Left and Right move by a hundredth of the track, to a round number; with Shift by a twentieth of that. Enter opens
// the text field, Delete restores the file's value.
bool moved_by_keys(Slider& slider, PanelState& state) {
    if (!owns_keys(state, slider.id)) return false;
    const double before = slider.value;
    const int steps = (is_pressed(key::right) ? 1 : 0) - (is_pressed(key::left) ? 1 : 0);
    if (steps != 0) {
        const bool is_fine = ImGui::GetIO().KeyShift;
        const double step = 0.01 * (is_fine ? fine_gain : 1.0);
        const double here = share_of(slider, slider.value * slider.factor);
        const double share = std::clamp((std::isfinite(here) ? here : 0.0) + steps * step, 0.0, 1.0);
        slider.value =
            roundest(value_at_share(slider, share - 0.5 * step), value_at_share(slider, share + 0.5 * step)) /
            slider.factor;
    }
    if (is_pressed(key::remove, false) || is_pressed(key::backspace, false)) slider.value = slider.original;
    if (is_pressed(key::enter, false)) begin_typing(slider, state.typed);
    // Up and down move the focus.
    if (is_pressed(key::up) || is_pressed(key::down)) state.focus.is_owned = false;
    return slider.value != before;
}

void begin_typing(const Slider& slider, TypedValue& typed) {
    typed.id = slider.id;
    typed.text = fmt::format("{}", slider.factor == 1.0 ? slider.value : rounded(slider.value * slider.factor, 12));
    typed.previous = typed.text;
    typed.wrong.clear();
    typed.is_new = true;
}

// A double click opens the text field, as a click on the number does; a right click restores the file's value.
bool clicked(Slider& slider, PanelState& state) {
    if (!ImGui::IsItemHovered()) return false;
    const double now = slider.value;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        slider.value = slider.original;
    } else if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) ||
               (ImGui::GetIO().KeyCtrl && ImGui::IsMouseClicked(ImGuiMouseButton_Left))) {
        state.pressed.clicked.clear();
        begin_typing(slider, state.typed);
    }
    return slider.value != now;
}

double typed_value(const Slider& slider, const std::string& text) {
    const bool is_angle = slider.factor != 1.0;
    const bool is_rate = is_angle && slider.unit.ends_with("/s");
    return typed_number(text, is_rate ? "rad/s" : is_angle ? "rad" : slider.unit, slider.factor);
}

// The text field in place of the slider; red if the last text was refused.
void show_field(const Slider& slider, PanelState& state, float width) {
    TypedValue& typed = state.typed;
    if (typed.is_new) ImGui::SetKeyboardFocusHere();
    typed.is_new = false;
    const bool is_wrong = !typed.wrong.empty();
    const Theme& theme = current_theme();
    ImGui::PushStyleColor(ImGuiCol_FrameBg, is_wrong ? packed(theme.error_card) : ImGui::GetColorU32(ImGuiCol_FrameBg));
    ImGui::PushStyleColor(ImGuiCol_Text, is_wrong ? packed(theme.error) : ImGui::GetColorU32(ImGuiCol_Text));
    ImGui::SetNextItemWidth(width);
    ImGui::InputText(("##type " + slider.id).c_str(), &typed.text, ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopStyleColor(2);
    remember(state, slider.id);
}

// Handles the text field. A text that is not a valid number changes nothing; it stays with an error message until it is
// corrected or cancelled.
bool typed_over(Slider& slider, PanelState& state, float width) {
    TypedValue& typed = state.typed;
    show_field(slider, state, width);
    const bool is_entered = ImGui::IsItemDeactivated(), is_active = ImGui::IsItemActive();
    if (ImGui::IsItemEdited()) typed.wrong.clear();
    const bool gives_up = !is_active && takes_key(state, key::escape);
    if (gives_up || (is_entered && typed.text == typed.previous)) {
        typed.id.clear();
        return false;
    }
    double value = slider.value;
    if (is_entered) {
        try {
            value = typed_value(slider, typed.text);
            typed.id.clear();
        } catch (const ParseError& problem) {
            typed.wrong = problem.what();
        }
    }
    if (!typed.wrong.empty()) paragraph(typed.wrong, ImGui::GetContentRegionAvail().x, current_theme().error);
    return value != std::exchange(slider.value, value);
}

// Highlights the row if its name is pointed at in the equations, and vice versa.
void point_at(const Slider& slider, PanelState& state) {
    if (!slider.id.starts_with("set ")) return;
    const std::string name = slider.id.substr(4);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 high{low.x + ImGui::GetContentRegionAvail().x, low.y + ImGui::GetFrameHeight()};
    if (ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) && ImGui::IsMouseHoveringRect(low, high))
        state.pointed_slider = name;
    if (name == state.lit)
        ImGui::GetWindowDrawList()->AddRectFilled({low.x - units(4.0F), low.y}, {high.x + units(4.0F), high.y},
                                                  packed(current_theme().accent, 0.22F), units(3.0F));
}

}  // namespace

double typed_number(const std::string& text, const std::string& unit, double factor) {
    const ParsedNumber given = read_number(text, unit);
    return given.has_unit || given.has_pi ? given.value : given.value / factor;
}

double roundest(double low, double high) {
    if (low > high) std::swap(low, high);
    if (low <= 0.0 && high >= 0.0) return 0.0;
    const double middle = 0.5 * (low + high), most = std::max(std::abs(low), std::abs(high));
    for (int power = static_cast<int>(std::ceil(std::log10(most))) + 1; power > -320 && high > low; --power)
        for (const double step : {std::pow(10.0, power), 0.5 * std::pow(10.0, power), 0.2 * std::pow(10.0, power)}) {
            double times = std::round(middle / step);
            for (const double other : {times - 1.0, times + 1.0})
                if (times * step < low || times * step > high) times = other;
            if (times * step >= low && times * step <= high) return rounded(times * step, 15);
        }
    return low;
}

bool waits_for_click(const PanelState& state) { return !state.pressed.clicked.empty() || state.plot_click.plot > 0; }

void mark_changed() {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddCircleFilled({high.x - units(9.0F), 0.5F * (low.y + high.y)}, units(2.5F),
                                                packed(current_theme().accent), 16);
}

bool moved(Slider& slider, PanelState& state) {
    const std::string about = explanation(slider);
    const bool is_changed = slider.value != slider.original;
    point_at(slider, state);
    label(slider.label, units(row_name_width));
    if (!slider.varies.empty() && ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceAllowNullID)) {
        ImGui::SetDragDropPayload(dragged_name, slider.varies.data(), slider.varies.size());
        ImGui::TextUnformatted(("over " + slider.label).c_str());
        ImGui::EndDragDropSource();
    }
    slow_tooltip(slider.id, about, state);
    if (is_changed) mark_changed();
    const bool was_reset = clicked(slider, state);
    ImGui::SameLine(0.0F, 0.0F);
    const float width = ImGui::GetContentRegionAvail().x;
    if (state.typed.id == slider.id) return typed_over(slider, state, width) || was_reset;
    const float track = std::floor(std::max(0.4F * width, width - units(value_width)));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    bool changed = dragged(slider, track, state.pressed) || was_reset;
    remember(state, slider.id);
    paint_bar(slider, corner, track);
    slow_tooltip(slider.id, about, state);
    changed = moved_by_keys(slider, state) || clicked(slider, state) || changed;
    ImGui::SameLine(0.0F, 0.0F);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool is_pressed_value = ImGui::InvisibleButton(
        ("##value of " + slider.id).c_str(), {std::max(1.0F, width - track), ImGui::GetFrameHeight()},
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    remember(state, "value of " + slider.id);
    slow_tooltip(slider.id, about + " \u00b7 click: type", state);
    if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
    if (is_pressed_value && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) begin_typing(slider, state.typed);
    changed = clicked(slider, state) || changed;
    const std::string text = shown_in(width - track - units(4.0F), slider, slider.value);
    ImGui::GetWindowDrawList()->AddText({std::floor(at.x + width - track - ImGui::CalcTextSize(text.c_str()).x),
                                         at.y + ImGui::GetStyle().FramePadding.y},
                                        packed(is_changed ? current_theme().accent : text_color()), text.c_str());
    return changed;
}

}  // namespace achilles
