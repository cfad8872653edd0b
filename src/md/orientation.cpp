#include "md/orientation.hpp"

#include "core/parallel.hpp"
#include "core/quaternion.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

void turn_grains(State& state, const Column<double>& before, int threads) {
    for_tiles(state.tiles(), threads, [&](std::size_t tile) {
        for (std::size_t i = tile * tile_size; i < std::min(state.size(), (tile + 1) * tile_size); ++i) {
            const double* old = before.data() + i * simd::spin_fields;
            const Vec mean = 0.5 * (Vec{old[0], old[1], old[2]} + state.turn(i));
            const Quaternion q = rotation_by(mean) * state.orientation_of(i);
            const double scale = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
            state.set_orientation(i, {scale * q.w, scale * q.x, scale * q.y, scale * q.z});
        }
    });
}

} // namespace sandlane::md
