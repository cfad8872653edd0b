// Energy that a shear flow without walls (Lees and Edwards) brings.
#include "md/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

// The image of j across the seam moves by U = rate L_y along x beyond j itself. Kinetic energy of both
// grains, elastic energy and loss of their contact add up to the power of the force on j at U, which nobody
// else accounts for.
void Simulation::add_shear_work() {
    if (scene_.domain.shear_rate == 0) return;
    double power = 0;
    for (std::size_t tile = 0; tile < state_.tiles(); ++tile) power += seam_power(tile);
    shear_work_ += 0.5 * plan_.dt * (shear_power_ + power);
    shear_power_ = power;
}

// W, of the pairs that a tile lists first. There are few of them, along two sides of the cell: each is
// evaluated once more by itself. What it remembers is up to date, so no time passes.
double Simulation::seam_power(std::size_t tile) {
    const simd::TileList all = lists_.tile(tile, state_);
    if (all.images != simd::Images::sheared) return 0;
    const simd::TileKernel kernel = tile_kernel();
    simd::PairView view = pair_view();
    view.dt = 0;
    const double seam_speed = scene_.domain.shear_rate * (plan_.upper.y - plan_.lower.y);
    const std::size_t row = static_cast<std::size_t>(simd::memory_row(plan_.memory));
    Column<double>& force = accumulators_.front(); // zeros between steps
    double power = 0;
    for (std::int32_t n = 0; n < all.count; ++n) {
        std::int32_t i[block_width], j[block_width];
        std::fill_n(i, block_width, all.i[n]);
        std::fill_n(j, block_width, all.j[n]);
        const double dy = state_.record_of(static_cast<std::size_t>(*j))[1] -
                          state_.record_of(static_cast<std::size_t>(*i))[1];
        if (!(std::abs(dy) > view.half[1]) || *j < *i) continue; // the other tile of a pair lists it, too
        double memory[simd::memory_row(laws::most_memory)] = {};
        std::uint8_t touched = 1;
        if (row > 0) {
            if ((all.touched[n / 8] >> (n % 8) & 1) == 0) continue;
            std::copy_n(all.memory + static_cast<std::size_t>(n) * row, row, memory);
        }
        const simd::TileList one{i, j, 1, all.begin, all.end, simd::Images::sheared, memory, &touched};
        (void)kernel(view, one, force.data(), 0.0);
        double* on_i = force.data() + static_cast<std::size_t>(*i - all.begin) * state_.force_stride();
        power -= (dy > 0 ? seam_speed : -seam_speed) * on_i[0];
        // Whatever the kernel wrote is taken back: the rows of both grains, or the one behind the last.
        std::fill_n(on_i, state_.force_stride(), 0.0);
        const std::int32_t partner = *j < all.end ? *j - all.begin : static_cast<std::int32_t>(tile_size);
        std::fill_n(force.data() + static_cast<std::size_t>(partner) * state_.force_stride(),
                    state_.force_stride(), 0.0);
    }
    return power;
}

} // namespace sandlane::md
