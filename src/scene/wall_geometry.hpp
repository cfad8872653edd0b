// Walls as simple pieces where the scene puts them, for checks and packings of start states.
#pragma once

#include "scene/scene.hpp"
#include "scene/surface_pieces.hpp"

#include <vector>

namespace sandlane::scene {

// The grains of a wall of kind `grains`: listed ones, a ring, or a row from the first point to the last.
[[nodiscard]] std::vector<GrainItem> wall_grains(const Wall& wall);
// How many they are; a double because the spacing may be as small as it likes.
[[nodiscard]] double wall_grain_count(const Wall& wall);

struct WallPiece {
    enum class Kind { plane, segment, arc, disc };
    Kind kind = Kind::segment;
    Vec a, b;                              // plane: point, unit normal; segment: ends; arc, disc: centre in a
    double radius = 0;                     // arc, disc
    double angle_from = 0, angle_span = 0; // arc, counter-clockwise
    int wall = 0;                          // index in Scene::walls
};

// Distance of p from the surface, and the unit vector that leads away from it. Negative behind a plane and
// inside a wall grain.
struct Gap {
    double distance = 0;
    Vec away;
};
[[nodiscard]] Gap gap(const WallPiece& piece, Vec p);

// Distance of a surface in space; of both sides but for a plane.
[[nodiscard]] Gap gap(const SurfacePiece& piece, Vec p);

// Whether walls with this motion are at t = 0 where the scene puts them.
[[nodiscard]] bool stands_as_given(const Motion& motion);
// The walls of a scene in the plane that are.
[[nodiscard]] std::vector<WallPiece> walls_at_start(const Scene& scene);

} // namespace sandlane::scene
