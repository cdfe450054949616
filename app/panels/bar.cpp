// The line above everything: menus, and at its right end a switch for every panel and for the theme.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include "panels/widgets.hpp"
#include "session/glossary.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

struct Shown {
    const char *what, *name;
    int key;
};
constexpr std::array<Shown, 6> panels{{{"controls", "Controls", '1'},
                                       {"plots", "Plots", '2'},
                                       {"events", "Events", '3'},
                                       {"sweep", "Sweep", '4'},
                                       {"depend", "Sensitivities", '5'},
                                       {"orbit", "Periodic run", '6'}}};

template <class Content>
void menu(const char* name, PanelState& state, const Content& content) {
    const bool open = ImGui::BeginMenu(name);
    remember(state, std::string("menu ") + name);
    if (!open) return;
    content();
    close_by_escape(state);
    ImGui::EndMenu();
}

// The next size of everything, as browsers have them.
double next_size(double now, int step) {
    constexpr std::array sizes{0.5, 0.67, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0};
    if (step > 0) {
        const auto* const larger = std::upper_bound(sizes.begin(), sizes.end(), now);
        return larger == sizes.end() ? now : *larger;
    }
    const auto* const here = std::lower_bound(sizes.begin(), sizes.end(), now);
    return here == sizes.begin() ? now : *(here - 1);
}

void enlarge(const Session& session, int step, Commands& commands) {
    const double now = session.scene().enlarged(), next = step == 0 ? 1.0 : next_size(now, step);
    if (next != now) commands.emplace_back(command::Enlarge{next});
}

// The files that were open last.
void show_recent(const Session& session, PanelState& state, Commands& commands) {
    if (state.recent.empty()) return;
    ImGui::Separator();
    for (const std::string& path : state.recent) {
        const std::string name = std::filesystem::path(path).filename().string();
        if (ImGui::MenuItem((name + "##" + path).c_str())) request(session, state, command::Open{path}, commands);
        remember(state, "menu " + path);
        tooltip(path);
    }
}

void show_file_menu(const Session& session, PanelState& state, Commands& commands) {
    if (menu_item("New", state)) request(session, state, command::New{}, commands);
    if (menu_item("Open\u2026", state)) ask_to_open(state);
    if (menu_item("Gallery\u2026", state)) commands.emplace_back(command::Show{"gallery", true});
    if (menu_item("Save", state)) save_or_ask(session, state, commands);
    if (menu_item("Save as\u2026", state)) ask_to_save(session, state);
    show_recent(session, state, commands);
    ImGui::Separator();
    show_take_away_items(session, state, commands);
}

void show_edit_menu(const Session& session, PanelState& state, Commands& commands) {
    if (menu_item("Undo", state, false, session.can_undo())) commands.emplace_back(command::Undo{});
    if (menu_item("Redo", state, false, session.can_redo())) commands.emplace_back(command::Redo{});
    ImGui::Separator();
    if (menu_item("Reset all values", state)) commands.emplace_back(command::Reset{});
    ImGui::Separator();
    if (menu_item("Command\u2026", state)) commands.emplace_back(command::Show{"palette", true});
    if (menu_item("Edit System File", state, session.shows_editor())) toggle_editor(session, state, commands);
}

void show_view_menu(const Session& session, PanelState& state, Commands& commands) {
    const Scene& scene = session.scene();
    for (const Shown& panel : panels)
        if (menu_item(panel.name, state, scene.shows(panel.what)))
            commands.emplace_back(command::Show{panel.what, !scene.shows(panel.what)});
    if (menu_item("Automatic panel sizes", state))
        for (const std::string& panel : command::sized_panels)
            if (scene.share(panel) > 0.0) commands.emplace_back(command::Size{panel, 0.0});
    ImGui::Separator();
    for (const auto& [what, name] : {std::pair{"trail", "Trail"}, std::pair{"velocity", "Velocity"},
                                     std::pair{"force", "Contact force"}, std::pair{"strobe", "Poses at events"}})
        if (menu_item(name, state, scene.shows(what))) commands.emplace_back(command::Show{what, !scene.shows(what)});
    const bool plane = scene.shows("plane");
    if (menu_item("Configuration plane", state, plane)) commands.emplace_back(command::Show{"plane", !plane});
    const bool energy = scene.shows("energy");
    if (menu_item("Energy", state, energy)) commands.emplace_back(command::Show{"energy", !energy});
    if (menu_item("Fit whole run", state, false, scene.look().has_value())) commands.emplace_back(command::LookAll{});
    ImGui::Separator();
    const bool loops = scene.loops();
    if (menu_item("Loop playback", state, loops)) commands.emplace_back(command::Loop{!loops});
    if (menu_item("Presentation", state, scene.presents())) commands.emplace_back(command::Present{!scene.presents()});
    ImGui::Separator();
    if (menu_item("Larger", state)) enlarge(session, 1, commands);
    if (menu_item("Smaller", state)) enlarge(session, -1, commands);
    if (menu_item("Reset Zoom", state)) enlarge(session, 0, commands);
    if (menu_item("Dark theme", state, session.theme().dark))
        commands.emplace_back(command::UseTheme{!session.theme().dark});
}

// A picture to press, as wide as it is high. Returns where to draw it.
bool switch_button(const std::string& name, const std::string& about, PanelState& state, Rectangle& area) {
    const float size = ImGui::GetFrameHeight();
    const bool pressed = ImGui::InvisibleButton(name.c_str(), {size, size});
    remember(state, name);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (ImGui::IsItemHovered())
        ImGui::GetWindowDrawList()->AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_ButtonHovered), units(3.0F));
    tooltip(about);
    area = {std::floor(low.x + 0.5F * size - units(8.0F)), std::floor(low.y + 0.5F * size - units(6.5F)), units(16.0F),
            units(13.0F)};
    return pressed;
}

// A little window whose left, right, lower or lower right part is filled where the panel is shown.
void panel_switch(const Session& session, const Shown& panel, PanelState& state, Commands& commands) {
    const bool shown = session.scene().shows(panel.what);
    Rectangle r;
    if (switch_button(std::string("switch ") + panel.what,
                      std::string(shown ? "hide the " : "show the ") + panel.what + " (" +
                          std::string(shortcut_of(panel.name)) + ")",
                      state, r))
        commands.emplace_back(command::Show{panel.what, !shown});
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 ink = packed(shown ? text_color() : faint_color());
    stroke_rectangle(list, {r.x + 0.5F, r.y + 0.5F}, {r.x + r.width - 0.5F, r.y + r.height - 0.5F}, ink, units(2.0F),
                     units(1.2F));
    const float across = 0.38F * r.width, down = 0.4F * r.height, inset = units(2.5F);
    ImVec2 low{r.x + inset, r.y + inset}, high{r.x + r.width - inset, r.y + r.height - inset};
    if (panel.key == '1') high.x = r.x + across;
    if (panel.key == '2' || panel.key == '4') low.x = r.x + r.width - across;
    if (panel.key == '3' || panel.key == '4') low.y = r.y + r.height - down;
    list->AddRectFilled(low, high, packed(shown ? text_color() : faint_color(), shown ? 1.0F : 0.35F));
}

void theme_switch(const Session& session, PanelState& state, Commands& commands) {
    const bool dark = session.theme().dark;
    Rectangle r;
    if (switch_button("switch theme", dark ? "light theme (Ctrl+D)" : "dark theme (Ctrl+D)", state, r))
        commands.emplace_back(command::UseTheme{!dark});
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 c{r.x + 0.5F * r.width, r.y + 0.5F * r.height};
    const float radius = units(6.5F);
    const ImU32 ink = packed(text_color());
    list->AddCircle(c, radius, ink, 32, units(1.2F));
    list->PathArcTo(c, radius - units(0.5F), -1.5707964F, 1.5707964F, 20);
    list->PathFillConvex(ink);
}

}  // namespace

void use_view_keys(const Session& session, PanelState& state, Commands& commands) {
    const ImGuiIO& io = ImGui::GetIO();
    if (takes_key(state, key::f11, false)) commands.emplace_back(command::Present{!session.scene().presents()});
    if (!io.KeyCtrl || io.KeyAlt) return;
    for (const Shown& panel : panels)
        if (takes_key(state, panel.key, false))
            commands.emplace_back(command::Show{panel.what, !session.scene().shows(panel.what)});
    if (takes_key(state, 'D', false)) commands.emplace_back(command::UseTheme{!session.theme().dark});
    if (takes_key(state, '=', false)) enlarge(session, 1, commands);
    if (takes_key(state, '-', false)) enlarge(session, -1, commands);
    if (takes_key(state, '0', false)) enlarge(session, 0, commands);
}

void show_bar(const Session& session, PanelState& state, Commands& commands) {
    if (!ImGui::BeginMenuBar()) return;
    menu("File", state, [&] { show_file_menu(session, state, commands); });
    menu("Edit", state, [&] { show_edit_menu(session, state, commands); });
    menu("View", state, [&] { show_view_menu(session, state, commands); });
    menu("Tours", state, [&] { show_tour_items(session, state, commands); });
    menu("Help", state, [&] { show_help_items(state, commands); });
    const float size = ImGui::GetFrameHeight(), space = units(4.0F), edge = units(10.0F);
    const float width = 5.0F * size + 4.0F * space + edge;
    const float left = ImGui::GetWindowWidth() - width;
    const float title_at = ImGui::GetCursorPosX() + units(16.0F);
    // Where no panel tells what runs, this line does.
    if (!session.scene().shows("controls") && !session.shows_editor() && left - title_at > units(80.0F)) {
        ImGui::SetCursorPosX(title_at);
        label(session.description().title, left - title_at);
        ImGui::SameLine(0.0F, 0.0F);
    }
    if (left < title_at) return ImGui::EndMenuBar();
    ImGui::SetCursorPosX(left);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {space, 0.0F});
    for (const std::size_t i : {0U, 2U, 1U, 3U}) panel_switch(session, panels[i], state, commands);
    theme_switch(session, state, commands);
    ImGui::PopStyleVar();
    ImGui::EndMenuBar();
}

}  // namespace achilles
