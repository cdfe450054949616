// A sheet onto an ImGui draw list, one item after the other.
#pragma once

#include "figure/sheet.hpp"

struct ImDrawList;

namespace achilles {

void paint(const Sheet& sheet, ImDrawList* list);

}  // namespace achilles
