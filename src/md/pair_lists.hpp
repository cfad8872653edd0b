// Verlet lists of the tiles of grains (docs/physics.md 9), in two levels: an outer list of all pairs whose
// gap is below the skin, from the link cells, and a near list of those that may touch soon, filtered from it.
#pragma once

#include "core/column.hpp"
#include "md/contact_memory.hpp"
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
    // Before the storage order changes.
    void invalidate(const State& state);
    // What the contacts of laws that remember hold now, and the way back before the next update.
    [[nodiscard]] ContactMemory memory(const State& state) const;
    void adopt(ContactMemory memory);
    // Before forces at the positions of the records: lists hold every pair that touches, afterwards.
    void update(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels, int threads);

    [[nodiscard]] simd::TileList tile(std::size_t index, const State& state);
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::int64_t builds() const { return builds_; }
    [[nodiscard]] std::int64_t refreshes() const { return refreshes_; }

private:
    struct Tile {
        // Pairs of gap below the skin, and those of gap below the near skin; each padded by a block.
        std::vector<std::int32_t> i, j, near_i, near_j;
        std::vector<std::int32_t> position, last_position; // of near pairs in the outer list, now and before
        std::vector<double> memory, last_memory;           // [field][near pair]
        std::int32_t count = 0, near_count = 0, last_near_count = 0;

        [[nodiscard]] std::size_t stride() const { return near_i.size(); }
        double largest_square = 0; // of the displacements since the last build
    };

    [[nodiscard]] bool outer_valid(const State& state, const simd::PairView& pairs, int threads);
    void build(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels, int threads);
    void build_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                    const simd::MdKernels& kernels);
    void refresh(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels, int threads,
                 bool rebuilt);
    void carry_memory(Tile& tile) const;
    void recall_memory(Tile& tile, const State& state) const;

    LinkCells cells_;
    std::vector<Tile> tiles_;
    Column<double> built_x_, built_y_; // positions at the last build
    double skin_ = 0, near_skin_ = 0, near_budget_ = 0;
    bool stale_ = true;
    int fields_ = 0;           // numbers that a contact remembers
    ContactMemory remembered_; // while there are no lists
    std::int64_t builds_ = 0, refreshes_ = 0;
};

} // namespace sandlane::md
