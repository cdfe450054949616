// What the explorer says and what its keys do, as two tables: the help card (F1), the menus and the manual show these.
#pragma once

#include <span>
#include <string_view>

namespace achilles {

// A word of the field.
struct Term {
    std::string_view word;
    std::string_view
        formula;  // in the notation of a system file, for typeset(); v is the velocity, n the impulse's direction
    std::string_view meaning;  // one sentence
    std::string_view source;   // in the paper, or in the theory of core for what goes beyond it
};
// In the order in which a run meets them.
std::span<const Term> glossary();

// What a key, or the mouse, does.
struct Shortcut {
    std::string_view keys;
    std::string_view does;
    std::string_view menu = {};  // the line of a menu that does the same; empty: none
};
// By what they are about: files, changes, the view, time; then the mouse.
std::span<const Shortcut> shortcuts();
// Of a line of a menu; empty where it has none.
std::string_view shortcut_of(std::string_view menu);

}  // namespace achilles
