// The ways to look at a mechanism.
//
//     fit     all that the run needs, arrows included
//     fixed   where the user looks
//     follow  a part of the world, so large that the body is seen well; it moves with the body's mean place, and never
//             loses it
//     zeno    fit, but towards a Zeno point the picture shrinks about the place that is touched, by the height that
//             the bounces still reach, so that they look the same all the way; after it the picture grows back
#pragma once

#include <optional>
#include <string_view>

namespace achilles {

enum class CameraMode { fit, fixed, follow, zeno };
std::string_view to_text(CameraMode mode);
std::optional<CameraMode> camera_mode_from(std::string_view text);

}  // namespace achilles
