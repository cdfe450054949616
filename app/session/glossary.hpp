// Tables of terms and example systems, shown by the help card (F1), the gallery and the manual.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace achilles {

// A technical term.
struct GlossaryTerm {
    std::string_view word;
    // In the notation of a system file, for typeset(). v is the velocity, n the direction of the impulse.
    std::string_view formula;
    std::string_view meaning;  // one sentence
    std::string_view source;   // where it is defined: the paper, or the theory files of core for extensions
};
// In the order in which they occur in a run.
std::span<const GlossaryTerm> glossary();

// Groups of example systems in the gallery.

struct GalleryGroup {
    std::string_view title;
    std::vector<std::string_view> systems;  // names, in display order
};
std::span<const GalleryGroup> gallery();

// Title of the group of a system; "others" if it is in no group.
std::string_view group_of(std::string_view system);
// Index in the gallery, from 0; the total count if the system is not in it.
std::size_t place_in_gallery(std::string_view system);

}  // namespace achilles
