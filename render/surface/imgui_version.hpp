// What ImGui's versions do in other ways, and the only place that asks for the version: 1.86 numbers keys as the program
// does and looks at an array, 1.87 and later (Debian 13 has 1.90) name keys and are told what happens to them. All of it
// is about ImGui's current context.
#pragma once

#include <vector>

#include "surface/frame.hpp"

struct ImGuiIO;

namespace achilles {

// Once, before the first frame.
void prepare_keys(ImGuiIO& io);
// The keys that are held during the next frame.
void hold_keys(ImGuiIO& io, const std::vector<int>& codes);
// Whether the key went down with this frame or, if `repeat`, is held so long that it does so again.
bool is_pressed(int code, bool repeat = true);
// Seconds for which the key has been held, negative if it is not: a widget sees no key that is set to -1 for a while.
float& time_held(int code);

}  // namespace achilles
