// Positions in a scene of what is given by name.
#pragma once

#include "scene/scene.hpp"

#include <string>

namespace sandlane::scene {

// The first one for an empty name, which means the only one.
[[nodiscard]] inline int material_index(const Scene& scene, const std::string& name) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (scene.materials[m].name == name) return static_cast<int>(m);
    return 0;
}

// -1 if there is none of that name: what stands still.
[[nodiscard]] inline int motion_index(const Scene& scene, const std::string& name) {
    for (std::size_t m = 0; m < scene.motions.size(); ++m)
        if (scene.motions[m].name == name) return static_cast<int>(m);
    return -1;
}

} // namespace sandlane::scene
