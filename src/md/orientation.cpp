#include "md/orientation.hpp"

#include "core/parallel.hpp"
#include "core/quaternion.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace {

// X_0(t + dt) - X_0(t) of the angle, from the other values at t + dt (docs/physics.md 7).
Vec turned(const State& state, std::size_t i) {
    const Vec rate = state.turn(i);
    double angle[] = {rate.x, rate.y, rate.z};
    for (int d = 0; d < 3; ++d)
        for (int k = 2; k < state.order; ++k) angle[d] += (k % 2 == 0 ? -1 : 1) * state.value(i, 3 + d, k);
    return {angle[0], angle[1], angle[2]};
}

} // namespace

void turn_grains(State& state, int threads) {
    for_tiles(state.tiles(), threads, [&](std::size_t tile) {
        for (std::size_t i = tile * tile_size; i < std::min(state.size(), (tile + 1) * tile_size); ++i) {
            const Quaternion q = rotation_by(turned(state, i)) * state.orientation_of(i);
            const double scale = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
            state.set_orientation(i, {scale * q.w, scale * q.x, scale * q.y, scale * q.z});
        }
    });
}

} // namespace sandlane::md
