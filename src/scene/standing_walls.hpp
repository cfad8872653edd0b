// The walls of a scene at t = 0 as numbered pieces: which of them are near a point, and how near.
#pragma once

#include "scene/surfaces.hpp"
#include "scene/wall_geometry.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace sandlane::scene {

// A motion that has already displaced its walls at t = 0 (planetary, a cosine, a phase) leaves them out.
class StandingWalls {
public:
    // Throws Error(invalid_input) for a mesh whose file cannot be read.
    explicit StandingWalls(const Scene& scene);

    // Calls body(piece) for those whose surface is closer than `reach` to p, or which p lies behind.
    template <class Body> void for_near(Vec p, double reach, const Body& body) const {
        const auto offer = [&](std::size_t n) {
            if (gap(n, p).distance < reach) body(n);
        };
        for (std::size_t n = 0; n < pieces_.size(); ++n) offer(n);
        for (const std::size_t frame : frames_) surfaces_->for_near(frame, p, reach, offer);
    }
    [[nodiscard]] Gap gap(std::size_t piece, Vec p) const;
    [[nodiscard]] int wall(std::size_t piece) const; // index in Scene::walls

private:
    std::vector<WallPiece> pieces_;    // 2D
    std::optional<Surfaces> surfaces_; // 3D
    std::vector<std::size_t> frames_;  // of surfaces_, those that stand as given
};

} // namespace sandlane::scene
