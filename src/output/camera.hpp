// Where pictures of space are seen from: parallel lines of sight.
#pragma once

#include "core/vec.hpp"
#include "scene/scene.hpp"

namespace sandlane::output {

struct Camera {
    // Unit vectors; towards: to the viewer; vertical: up in the world, across `right`.
    Vec right{1, 0, 0}, up{0, 1, 0}, towards{0, 0, 1}, vertical{0, 1, 0};

    // To the right, up and towards the viewer, m.
    [[nodiscard]] Vec project(Vec p) const { return {dot(right, p), dot(up, p), dot(towards, p)}; }
};

// direction: to the viewer; none: to the front, a little to the right and from above. up: of the world; none:
// z. Seen along it, the front is at the bottom of the picture.
[[nodiscard]] Camera look_from(Vec direction, Vec up);

// As output.view of a scene says; up is against gravity.
[[nodiscard]] Camera camera_of(const scene::Scene& scene);

// The smallest box along the camera's axes around a box along those of the world, m.
struct ProjectedBox {
    Vec lower, upper;
};
[[nodiscard]] ProjectedBox project_box(const Camera& camera, Vec lower, Vec upper);

} // namespace sandlane::output
