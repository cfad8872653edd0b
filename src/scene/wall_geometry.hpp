// Walls as simple pieces where the scene puts them, for checks and packings of start states.
#pragma once

#include "scene/scene.hpp"
#include "scene/surfaces.hpp"

#include <cstddef>
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

// All walls that stand at t = 0 where the scene puts them; a motion that has already displaced its walls at
// t = 0 (planetary, a cosine, a phase) leaves them out.
[[nodiscard]] std::vector<WallPiece> walls_at_start(const Scene& scene);

// The same walls in 3D, where their pieces are many.
[[nodiscard]] Gap gap(const SurfacePiece& piece, Vec p);
class SurfacesAtStart {
public:
    explicit SurfacesAtStart(const Scene& scene);

    // Calls body(gap, wall) for the pieces closer than `reach` to p; wall: index in Scene::walls.
    template <class Body> void for_near(Vec p, double reach, const Body& body) const {
        for (const std::size_t frame : standing_)
            surfaces_.for_near(frame, p, reach, [&](std::uint32_t n) {
                const Gap g = gap(surfaces_.piece(n), p);
                if (g.distance < reach) body(g, surfaces_.wall(n));
            });
    }

private:
    Surfaces surfaces_;
    std::vector<std::size_t> standing_; // frames
};

} // namespace sandlane::scene
