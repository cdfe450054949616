// What the explorer says, what its keys do and which systems it offers, as tables: the help card (F1), the menus, the gallery and
// the manual show these.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

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

// The gallery in groups: which of the systems that come with the program are about the same.

struct GalleryGroup {
    std::string_view title;
    std::vector<std::string_view> systems;  // by name, in the order in which they are shown
};
std::span<const GalleryGroup> gallery();

// The title of a system's group; "others" for one that is in none.
std::string_view group_of(std::string_view system);
// Where it stands in the gallery, from 0; behind all of them where it does not.
std::size_t place_in_gallery(std::string_view system);

}  // namespace achilles
