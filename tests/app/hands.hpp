// One hand on one explorer, offscreen.
#pragma once

#include <cstdlib>

#include "app/open.hpp"

namespace achilles::test {

// A picture must not depend on shaders that an earlier run left in a cache.
[[maybe_unused]] inline const int no_cache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);

// One hand on one explorer.
struct Hands {
    explicit Hands(const std::string& system, const SurfaceOptions& options = test::surface())
        : session(test::session(system)), surface(options) {
        rest(3);
    }
    // A frame; what it asks for is done, as the window does it.
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
    // Moves over a share of a control's width.
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
    }
    void press(int key) {
        hand.keys = {key};
        rest(2);
        hand.keys.clear();
        rest(2);
    }
    // A key while Ctrl is held.
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
