// The walls of a scene at t = 0 as numbered pieces: which of them are near a point, and how near.
#pragma once

#include "scene/wall_geometry.hpp"

#include <cstddef>
#include <vector>

namespace sandlane::scene {

class StandingWalls {
public:
    explicit StandingWalls(const Scene& scene) : pieces_(walls_at_start(scene)) {}

    // Calls body(piece) for those whose surface is closer than `reach` to p, or which p lies behind.
    template <class Body> void for_near(Vec p, double reach, const Body& body) const {
        for (std::size_t n = 0; n < pieces_.size(); ++n)
            if (gap(n, p).distance < reach) body(n);
    }
    [[nodiscard]] Gap gap(std::size_t piece, Vec p) const { return scene::gap(pieces_[piece], p); }
    [[nodiscard]] int wall(std::size_t piece) const { return pieces_[piece].wall; } // index in Scene::walls

private:
    std::vector<WallPiece> pieces_;
};

} // namespace sandlane::scene
