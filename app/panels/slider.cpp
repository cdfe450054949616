#include "panels/slider.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "panels/widgets.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

bool is_logarithmic(const Slider& slider) { return slider.low > 0.0 && slider.high / slider.low >= 100.0; }

double rounded(double value, int digits) { return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr); }

// "30°", "2 m", with so many digits.
std::string shown(const Slider& slider, double value, int digits = 6) {
    const bool joined = slider.unit.empty() || slider.unit[0] == '\xc2';
    return number(rounded(value * slider.factor, std::min(digits, slider.digits + 2))) +
           (joined ? slider.unit : "\u00a0" + slider.unit);
}

// With as many digits as there is room for.
std::string shown_in(float width, const Slider& slider, double value) {
    for (int digits = 6; digits > 2; --digits)
        if (const std::string text = shown(slider, value, digits); ImGui::CalcTextSize(text.c_str()).x <= width)
            return text;
    return fitted(shown(slider, value, 2), width);
}

std::string explanation(const Slider& slider) {
    std::string text = slider.about + (slider.about.empty() ? "" : "\n");
    text += number(slider.low * slider.factor) + " to " + shown(slider, slider.high);
    if (is_logarithmic(slider)) text += ", logarithmic";
    if (slider.value != slider.original) text += "\nthe file has " + shown(slider, slider.original);
    return text + "\ndouble click: type a value; right click: as the file has it";
}

// A thin track behind a slider whose own frame is invisible, with a mark where the file's value is.
void paint_track(const Slider& slider, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float y = std::floor(at.y + 0.5F * ImGui::GetFrameHeight()), half = units(2.0F);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({at.x, y - half}, {at.x + width, y + half}, packed(current_theme().border), half);
    if (slider.value == slider.original || !(slider.original >= slider.low && slider.original <= slider.high)) return;
    const double share = is_logarithmic(slider)
                             ? std::log(slider.original / slider.low) / std::log(slider.high / slider.low)
                             : (slider.original - slider.low) / (slider.high - slider.low);
    const float grab = ImGui::GetStyle().GrabMinSize, padding = 2.0F;  // as ImGui places the grab
    const float x =
        std::floor(at.x + padding + 0.5F * grab + static_cast<float>(share) * (width - grab - 2.0F * padding));
    list->AddRectFilled({x - units(1.0F), y - units(6.0F)}, {x + units(1.0F), y + units(6.0F)}, packed(faint_color()));
}

// ImGui would write the value over the grab; ours stands beside it, so its text is hidden. Fifteen digits: ImGui takes
// the precision of a logarithmic scale from here.
bool dragged(Slider& slider, float width) {
    paint_track(slider, width);
    for (const ImGuiCol color : {ImGuiCol_FrameBg, ImGuiCol_FrameBgActive, ImGuiCol_FrameBgHovered, ImGuiCol_Text})
        ImGui::PushStyleColor(color, 0U);
    ImGui::SetNextItemWidth(width);
    double value = slider.value * slider.factor;
    const double before = value, low = slider.low * slider.factor, high = slider.high * slider.factor;
    ImGui::SliderScalar(
        ("##" + slider.id).c_str(), ImGuiDataType_Double, &value, &low, &high, "%.15g",
        ImGuiSliderFlags_NoInput | (is_logarithmic(slider) ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None));
    ImGui::PopStyleColor(4);
    if (value == before || rounded(value, slider.digits) == before) return false;
    slider.value = rounded(value, slider.digits) / slider.factor;
    return true;
}

void begin_typing(const Slider& slider, TypedValue& typed) {
    typed.id = slider.id;
    typed.text = fmt::format("{}", slider.factor == 1.0 ? slider.value : rounded(slider.value * slider.factor, 12));
    typed.as_it_was = typed.text;
    typed.is_new = true;
}

// A double click types, and takes back what its first click moved; a right click puts the file's value back.
bool clicked(Slider& slider, double before, TypedValue& typed) {
    if (ImGui::IsItemActivated() && !ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
        typed.before = {slider.id, before};
    if (!ImGui::IsItemHovered()) return false;
    const double now = slider.value;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        slider.value = slider.original;
    } else if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) ||
               (ImGui::GetIO().KeyCtrl && ImGui::IsMouseClicked(ImGuiMouseButton_Left))) {
        if (typed.before.first == slider.id) slider.value = typed.before.second;
        begin_typing(slider, typed);
    }
    return slider.value != now;
}

// The field in place of the slider. What is no number changes nothing.
bool typed_over(Slider& slider, PanelState& state, float width) {
    TypedValue& typed = state.typed;
    if (typed.is_new) ImGui::SetKeyboardFocusHere();
    typed.is_new = false;
    ImGui::SetNextItemWidth(width);
    ImGui::InputText(("##type " + slider.id).c_str(), &typed.text, ImGuiInputTextFlags_AutoSelectAll);
    remember(state, slider.id);
    if (!ImGui::IsItemDeactivated()) return false;
    typed.id.clear();
    if (typed.text == typed.as_it_was) return false;
    const std::size_t first = typed.text.find_first_not_of(" +");
    double value = 0.0;
    const char* const end = typed.text.data() + typed.text.size();
    if (first == std::string::npos || std::from_chars(typed.text.data() + first, end, value).ec != std::errc() ||
        !std::isfinite(value))
        return false;
    value /= slider.factor;
    return value != std::exchange(slider.value, value);
}

}  // namespace

void mark_changed() {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddCircleFilled({high.x - units(9.0F), 0.5F * (low.y + high.y)}, units(2.5F),
                                                packed(current_theme().accent), 16);
}

bool moved(Slider& slider, PanelState& state) {
    const std::string about = explanation(slider);
    const bool is_changed = slider.value != slider.original;
    label(slider.label, units(label_width));
    tooltip(about);
    if (is_changed) mark_changed();
    const double before = slider.value;
    const bool was_reset = clicked(slider, before, state.typed);
    ImGui::SameLine(0.0F, 0.0F);
    const float width = ImGui::GetContentRegionAvail().x;
    if (state.typed.id == slider.id) return typed_over(slider, state, width) || was_reset;
    const float track = std::floor(std::max(0.4F * width, width - units(value_width)));
    bool changed = dragged(slider, track) || was_reset;
    remember(state, slider.id);
    tooltip(about);
    changed = clicked(slider, before, state.typed) || changed;
    ImGui::SameLine(0.0F, 0.0F);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(("##value of " + slider.id).c_str(),
                           {std::max(1.0F, width - track), ImGui::GetFrameHeight()},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    remember(state, "value of " + slider.id);
    tooltip(about);
    changed = clicked(slider, before, state.typed) || changed;
    const std::string text = shown_in(width - track - units(4.0F), slider, slider.value);
    ImGui::GetWindowDrawList()->AddText({std::floor(at.x + width - track - ImGui::CalcTextSize(text.c_str()).x),
                                         at.y + ImGui::GetStyle().FramePadding.y},
                                        packed(is_changed ? current_theme().accent : text_color()), text.c_str());
    return changed;
}

}  // namespace achilles
