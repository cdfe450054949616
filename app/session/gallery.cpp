#include "session/gallery.hpp"

#include <algorithm>

namespace achilles {

std::span<const GalleryGroup> gallery() {
    static const std::vector<GalleryGroup> groups{
        {"the paper", {"ball_on_sine", "double_pendulum"}},
        {"teaching",
         {"ball_on_floor", "ball_on_incline", "ball_in_bowl", "ball_on_hills", "ball_down_a_wave", "ball_on_cylinder",
          "bead_in_ring", "ball_on_egg_crate", "cart_pendulum", "triple_pendulum", "falling_rod"}},
        {"robots", {"swinging_leg", "kneed_leg", "arm_at_wall"}},
        {"driven",
         {"impact_oscillator", "ball_on_table", "ball_on_vibrating_table", "two_mass_oscillator",
          "driven_double_pendulum", "ball_in_gusts"}},
        {"several contacts",
         {"double_pendulum_two_stops", "ball_in_sloped_box", "ball_round_post", "ball_in_v", "box_dropped_flat",
          "cart_between_walls", "backlash", "newtons_cradle", "table_on_legs"}}};
    return groups;
}

std::string_view group_of(std::string_view system) {
    for (const GalleryGroup& group : gallery())
        if (std::find(group.systems.begin(), group.systems.end(), system) != group.systems.end()) return group.title;
    return "others";
}

std::size_t place_in_gallery(std::string_view system) {
    std::size_t place = 0;
    for (const GalleryGroup& group : gallery())
        for (const std::string_view name : group.systems) {
            if (name == system) return place;
            ++place;
        }
    return place;
}

}  // namespace achilles
