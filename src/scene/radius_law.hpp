// Distributions of radii as functions of one uniform number.
#pragma once

#include "scene/scene.hpp"

namespace sandlane::scene {

// uniform: in [0, 1). Monotonic: 0 gives min, 1 gives max.
[[nodiscard]] double radius_of(const Sizes& sizes, double uniform);

} // namespace sandlane::scene
