#include "scene/standing_walls.hpp"

namespace sandlane::scene {

StandingWalls::StandingWalls(const Scene& scene) {
    if (scene.domain.dimension == 2) {
        pieces_ = walls_at_start(scene);
        return;
    }
    surfaces_.emplace(scene);
    frames_.push_back(Surfaces::frame_of(-1));
    for (std::size_t m = 0; m < scene.motions.size(); ++m)
        if (stands_as_given(scene.motions[m])) frames_.push_back(Surfaces::frame_of(static_cast<int>(m)));
}

Gap StandingWalls::gap(std::size_t piece, Vec p) const {
    return surfaces_ ? scene::gap(surfaces_->piece(piece), p) : scene::gap(pieces_[piece], p);
}

int StandingWalls::wall(std::size_t piece) const {
    return surfaces_ ? surfaces_->wall(piece) : pieces_[piece].wall;
}

} // namespace sandlane::scene
