// Simulated user input for an off-screen explorer.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/open.hpp"
#include "surface/imgui_version.hpp"

namespace achilles::test {

// Pictures must not depend on shaders cached by an earlier run.
[[maybe_unused]] inline const int no_cache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);

// An explorer with simulated mouse and keyboard.
struct Hands {
    explicit Hands(const std::string& system, const SurfaceOptions& options = test::surface())
        : session(test::session(system)), surface(options) {
        rest(3);
    }
    // One frame. Its commands are applied, as in the window.
    std::vector<Command> frame() {
        std::vector<Command> commands;
        surface.step([&] { commands = explorer(session, state); }, hand);
        for (const Command& command : commands) session.apply(command);
        all.insert(all.end(), commands.begin(), commands.end());
        return commands;
    }
    void rest(int frames) {
        for (int i = 0; i < frames; ++i) frame();
    }
    // Moves the mouse to a share of a control's width.
    void point(const std::string& place, double share = 0.5) {
        const Rectangle r = state.places.at(place);
        hand.mouse_x = r.x + share * r.width;
        hand.mouse_y = r.y + 0.5 * r.height;
        rest(2);
    }
    void click(const std::string& place, double share = 0.5) {
        point(place, share);
        hand.left = true;
        rest(2);
        hand.left = false;
        rest(2);
        settle();
    }
    // Waits until the last click cannot become a double click.
    void settle() {
        for (int i = 0; i < 60 && waits_for_click(state); ++i) rest(1);
        rest(1);
    }
    void double_click(const std::string& place, double share = 0.5) {
        point(place, share);
        for (int i = 0; i < 2; ++i) {
            hand.left = true;
            rest(1);
            hand.left = false;
            rest(1);
        }
        rest(2);
    }
    void right_click(const std::string& place, double share = 0.5) {
        point(place, share);
        hand.right = true;
        rest(2);
        hand.right = false;
        rest(2);
    }
    // Area of the tooltip after another frame; of height 0 if there is none.
    Rectangle tooltip() {
        Rectangle found;
        std::vector<Command> commands;
        surface.step(
            [&] {
                commands = explorer(session, state);
                const ImGuiWindow* window = ImGui::FindWindowByName("##Tooltip_00");
                if (window == nullptr || !window->Active || window->Hidden) return;
                found = {window->Pos.x, window->Pos.y, window->Size.x, window->Size.y};
            },
            hand);
        for (const Command& command : commands) session.apply(command);
        return found;
    }
    // All letters in a frame, window by window, without spaces. Every textured quad is looked up as a glyph of a font,
    // whatever code drew it.
    std::string letters() {
        std::string text;
        std::vector<Command> commands;
        surface.step(
            [&] {
                commands = explorer(session, state);
                std::map<std::pair<float, float>, ImWchar> glyphs;  // by their upper left corner in the texture
                for (ImFont* font : ImGui::GetIO().Fonts->Fonts)
                    for (const ImFontGlyph& glyph : glyphs_of(font))
                        if (glyph.Visible != 0) glyphs[{glyph.U0, glyph.V0}] = static_cast<ImWchar>(glyph.Codepoint);
                for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
                    if (!window->Active || window->Hidden) continue;
                    for (const ImDrawVert& vertex : window->DrawList->VtxBuffer) {
                        const auto glyph = glyphs.find({vertex.uv.x, vertex.uv.y});
                        if (glyph == glyphs.end()) continue;
                        char letter[5] = {};
                        ImTextCharToUtf8(letter, glyph->second);
                        text += letter;
                    }
                }
            },
            hand);
        for (const Command& command : commands) session.apply(command);
        return text;
    }
    bool says(std::string text) {
        std::erase(text, ' ');
        return letters().find(text) != std::string::npos;
    }
    // The middle of a control.
    Point middle(const std::string& place) const {
        const Rectangle& r = state.places.at(place);
        return {r.x + 0.5 * r.width, r.y + 0.5 * r.height};
    }
    void press(int key) {
        hand.keys = {key};
        rest(2);
        hand.keys.clear();
        rest(2);
    }
    // Presses a key with Ctrl.
    void press_with_control(int key) {
        hand.keys = {key::left_control};
        rest(1);
        hand.keys.push_back(key);
        rest(2);
        hand.keys.clear();
        rest(2);
    }
    void type(const std::string& text) {
        hand.text = text;
        rest(1);
        hand.text.clear();
        rest(1);
    }
    Image picture() {
        return surface.frame([&] { explorer(session, state); }, 3);
    }

    Session session;
    PanelState state = test::panels();
    Offscreen surface;
    Input hand;
    std::vector<Command> all;
};

}  // namespace achilles::test
