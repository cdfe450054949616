// What the mechanism view shows: the visible part of the world, its layers, and the changes that a hand makes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "figure/layout.hpp"
#include "session/session.hpp"

namespace achilles {

// Length of the longest arrow of a run, as a share of the picture's smaller side.
constexpr double longest_arrow = 0.16;

// The visible part of the world in a picture of this size.
Drawing seen_world(const Session& session, const Rectangle& area);
// What the Zeno camera shows, in two lines: how much it enlarges, and the bounce.
std::array<std::string, 2> zeno_words(const Session& session, const Rectangle& world);

// True if the plane replaces the mechanism: by the user's choice, or since the system has no drawing.
bool shows_plane(const Session& session);
// True if two side views of a system in space do.
bool shows_sides(const Session& session);
// The layers that can be shown, from right to left. With the plane: the contours, and the plane itself only if there is
// a mechanism. With side views: the trail.
std::vector<const char*> layers_of(const Session& session, bool can_show_contours);

// The `start` command for coordinates, rates or both.
command::SetStart start_of(const Session& session, const Vector* q, const Vector* v);
// Adds the commands that turn a system in space, seen from `from`, by the way of a hand (pixels at scale 1): half a
// degree per pixel. What is in the middle of the picture stays there.
void turn_by_hand(const Session& session, const ViewAngles& from, double right, double down, Commands& commands);

}  // namespace achilles
