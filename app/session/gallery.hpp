// The gallery in groups: which of the systems that come with the program are about the same.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace achilles {

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
