// Verlet lists of the tiles of grains (md-spheres 5.3), in two levels: an outer list of all pairs whose gap
// is below the skin, from the link cells, and a near list of those that may touch soon, filtered from it.
#pragma once

#include "core/column.hpp"
#include "md/link_cells.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "simd/tables.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::md {

class PairLists {
public:
    PairLists() = default;
    PairLists(const scene::Scene& scene, const Plan& plan, const Needs& needs);

    // Grains moved by at most `distance` [m] since the last call.
    void account(double distance) { near_budget_ -= distance; }
    // The storage order changed.
    void invalidate() { stale_ = true; }
    // Before forces at the positions of the records: lists hold every pair that touches, afterwards.
    void update(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels, int threads);

    [[nodiscard]] simd::TileList tile(std::size_t index, const State& state) const;
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::int64_t builds() const { return builds_; }
    [[nodiscard]] std::int64_t refreshes() const { return refreshes_; }

private:
    struct Tile {
        // Pairs of gap below the skin, and those of gap below the near skin; each padded by a block.
        std::vector<std::int32_t> i, j, near_i, near_j;
        std::int32_t count = 0, near_count = 0;
        double largest_square = 0; // of the displacements since the last build
    };

    [[nodiscard]] bool outer_valid(const State& state, const simd::PairView& pairs, int threads);
    void build(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels, int threads);
    void build_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                    const simd::MdKernels& kernels);
    void refresh(const simd::PairView& pairs, const simd::MdKernels& kernels, int threads);

    LinkCells cells_;
    std::vector<Tile> tiles_;
    Column<double> built_x_, built_y_; // positions at the last build
    double skin_ = 0, near_skin_ = 0, near_budget_ = 0;
    bool stale_ = true;
    std::int64_t builds_ = 0, refreshes_ = 0;
};

} // namespace sandlane::md
