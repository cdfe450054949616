#include "panels/focus.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "panels/widgets.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// These controls need a mouse position; rows of a folder are selected from the path field.
constexpr std::array<std::string_view, 9> wants_mouse{"mechanism", "timeline",  "plane",       "plot ", "splitter ",
                                                      "lens ",     "value of ", "expression ", "file "};
constexpr std::array<std::string_view, 4> takes_letters{"text", "path", "command", "take field "};

template <std::size_t count>
bool begins(const std::string& name, const std::array<std::string_view, count>& words) {
    return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return name.starts_with(word); });
}

Point middle(const Rectangle& area) { return {area.x + 0.5 * area.width, area.y + 0.5 * area.height}; }

// Controls of the dialog in front or, without a dialog, all.
std::vector<FocusTarget> reachable(const Focus& focus) {
    const unsigned front = front_dialog();
    std::vector<FocusTarget> stops;
    for (const FocusTarget& stop : focus.stops)
        if (front == 0 || stop.window == front) stops.push_back(stop);
    return stops;
}

int index_of(const std::vector<FocusTarget>& stops, const std::string& name) {
    const auto found =
        std::find_if(stops.begin(), stops.end(), [&](const FocusTarget& stop) { return stop.name == name; });
    return found == stops.end() ? -1 : static_cast<int>(found - stops.begin());
}

void go_to(Focus& focus, const FocusTarget& stop) {
    focus.at = stop.name;
    focus.scrolls = true;
}

void paint_ring(const Rectangle& area) {
    const float out = units(3.0F);
    stroke_rectangle(ImGui::GetForegroundDrawList(), {area.x - out, area.y - out},
                     {area.x + area.width + out, area.y + area.height + out}, packed(current_theme().accent),
                     units(5.0F), units(2.0F));
}

// Tab goes to the next control, Shift+Tab to the previous one; from a text field to the control after it.
void tab(PanelState& state, const std::vector<FocusTarget>& stops) {
    if (stops.empty()) return;
    const int count = static_cast<int>(stops.size()), step = ImGui::GetIO().KeyShift ? -1 : 1;
    int from = index_of(stops, state.focus.at);
    if (ImGui::GetIO().WantTextInput) {
        const unsigned active = active_item();
        const auto field =
            std::find_if(stops.begin(), stops.end(), [&](const FocusTarget& s) { return s.id == active; });
        from = field == stops.end() ? from : static_cast<int>(field - stops.begin());
        let_go_of_item();
    }
    const int next = from < 0 ? (step > 0 ? 0 : count - 1) : (from + step + count) % count;
    go_to(state.focus, stops[static_cast<std::size_t>(next)]);
}

void arrows(Focus& focus, const std::vector<FocusTarget>& stops, const FocusTarget& here) {
    for (const auto& [code, dx, dy] : {std::tuple{key::left, -1, 0}, std::tuple{key::right, 1, 0},
                                       std::tuple{key::up, 0, -1}, std::tuple{key::down, 0, 1}}) {
        if (!is_pressed(code)) continue;
        const int next = neighbor(stops, here, dx, dy);
        if (next >= 0) go_to(focus, stops[static_cast<std::size_t>(next)]);
    }
}

}  // namespace

int neighbor(const std::vector<FocusTarget>& stops, const FocusTarget& from, int dx, int dy) {
    const Point here = middle(from.area);
    constexpr double aside = 3.0;  // cost of a sideways step
    double least = std::numeric_limits<double>::infinity();
    int best = -1;
    for (std::size_t i = 0; i < stops.size(); ++i) {
        if (stops[i].window != from.window) continue;
        const Point there = middle(stops[i].area);
        const double along = dx * (there.x - here.x) + dy * (there.y - here.y);
        const double across = std::abs(dy * (there.x - here.x)) + std::abs(dx * (there.y - here.y));
        // Skip controls that are mostly sideways.
        if (!(along > 1.0) || across > 4.0 * along || along + aside * across >= least) continue;
        least = along + aside * across;
        best = static_cast<int>(i);
    }
    return best;
}

bool has_keys(const PanelState& state) { return !state.focus.at.empty(); }

bool is_in_front(const PanelState& state) { return popup_of_window() == state.focus.front; }

bool takes_key(const PanelState& state, int code, bool repeat) {
    return is_in_front(state) && is_pressed(code, repeat);
}

bool owns_keys(PanelState& state, const std::string& name) {
    if (state.focus.at != name || ImGui::GetIO().WantTextInput || !is_in_front(state)) return false;
    state.focus.is_owned = true;
    return true;
}

void add_stop(PanelState& state, const std::string& name, const Rectangle& area) {
    const unsigned id = item_id();
    if (id == 0 || !item_is_enabled() || begins(name, wants_mouse)) return;
    state.focus.stops.push_back({name, area, id, window_of_item()});
    if (state.focus.at == name && state.focus.scrolls) {
        scroll_to_item();
        state.focus.scrolls = false;
    }
}

void begin_focus(PanelState& state) {
    Focus& focus = state.focus;
    focus.stops.clear();
    focus.is_owned = false;
    const bool in_menu = is_covered() && front_dialog() == 0;
    walk_menus_by_keys(in_menu && !ImGui::GetIO().WantTextInput);
    // Suppress ImGui's own Tab handling, which would focus a text field of its own choice.
    if (is_pressed(key::tab) && !ImGui::GetIO().WantTextInput) ImGui::NavMoveRequestCancel();
    const auto& clicked = ImGui::GetIO().MouseClicked;
    if (clicked[ImGuiMouseButton_Left] || clicked[ImGuiMouseButton_Right]) focus.at.clear();
    if (!focus.at.empty() && take_escape(state)) focus.at.clear();
}

void use_focus(PanelState& state) {
    Focus& focus = state.focus;
    if (is_covered() && front_dialog() == 0) return;  // a menu has the keys
    const std::vector<FocusTarget> stops = reachable(focus);
    const ImGuiIO& io = ImGui::GetIO();
    // A window that opened or closed in this frame was not in front when the keys were pressed.
    const bool is_new = focus.front != front_popup();
    // The palette and the path field use Tab for completion; in the editor it is a character.
    const bool is_taken = is_new || (io.WantTextInput && !state.browser.tab);
    if (is_pressed(key::tab) && !io.KeyCtrl && !io.KeyAlt && !is_taken) tab(state, stops);
    state.browser.tab = false;
    const int at = index_of(stops, focus.at);
    if (at < 0) return focus.at.clear();
    const FocusTarget& here = stops[static_cast<std::size_t>(at)];
    paint_ring(here.area);
    if (is_new || io.WantTextInput || focus.is_owned || io.KeyCtrl || io.KeyAlt) return;
    if (is_pressed(key::enter, false) || is_pressed(key::keypad_enter, false) || is_pressed(' ', false))
        press_item(here.id, begins(here.name, takes_letters));
    arrows(focus, stops, here);
}

}  // namespace achilles
