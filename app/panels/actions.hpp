// Everything the explorer can do from a menu, a key or the palette: one table. The menus, the bar, the shortcuts, the
// palette, and the keys on the F1 card and in the manual are all made from it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "panels/panels.hpp"

namespace achilles {

// What an action does: a journal line, or a function where it depends on the session or opens a dialog. The lines "show
// X", "present on", "loop on", "link on" and "theme dark" also turn these off, and are ticked while they are on.
struct ActionEffect {
    using Function = void(const Session& session, PanelState& state, Commands& commands);
    std::string_view command;
    Function* run = nullptr;
    constexpr ActionEffect(const char* line) : command(line) {}  // NOLINT: a line of the table
    constexpr ActionEffect(Function* function) : run(function) {}
};

struct Action {
    enum Flags : unsigned {
        group = 1,       // a line above it in the menu
        not_typing = 2,  // its key is for a text field while one has the keyboard
        player = 4,      // its key is for a control while one has the keyboard
        repeats = 8,     // while the key is held
        submenu = 16,
        desktop = 32  // not on a page in a browser
    };
    std::string_view menu;  // "File"
    std::string_view name;  // its words in the menu, "Save as..."
    std::string_view keys;  // "Ctrl+Shift+Z, Ctrl+Y"; empty: none
    std::string_view
        about;  // what it does, in a few words: on the F1 card, in tooltips. Neighbors with the same share a
                // line of the card
    ActionEffect effect;
    unsigned flags = 0;
    bool (*can)(const Session& session) = nullptr;  // whether it is enabled; null: always
};

// In the order of the menus.
std::span<const Action> actions();
// The action of this name; there must be one.
const Action& action(std::string_view name);

// Whether this explorer has it: a page in a browser lacks some.
bool is_offered(const Action& action, const PanelState& state);
bool is_enabled(const Action& action, const Session& session);
bool is_on(const Action& action, const Session& session);
// Adds what the action does to `commands`, or opens its dialog.
void perform(const Action& action, const Session& session, PanelState& state, Commands& commands);
// True if its key was pressed for the current window.
bool takes_key_of(const Action& action, const PanelState& state);
// Performs the actions whose keys were pressed.
void use_action_keys(const Session& session, PanelState& state, Commands& commands);
// The entries of a menu.
void show_menu_entries(std::string_view menu, const Session& session, PanelState& state, Commands& commands);

// Keys and mouse gestures, in groups, for the F1 card and the manual.
struct Shortcut {
    std::string_view group;
    std::string keys;
    std::string_view does;
    bool is_for_desktop = false;  // not on a page in a browser
};
const std::vector<Shortcut>& shortcuts();

}  // namespace achilles
