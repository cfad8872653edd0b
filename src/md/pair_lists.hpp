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
    void write_memory(const State& state, ByteWriter& bytes) const; // memory(), a tile at a time
    // Before forces at the positions of the records, of time `time` [s]: lists hold every pair that touches,
    // afterwards.
    void update(const State& state, const simd::PairView& pairs, const simd::DimensionKernels& kernels,
                int threads, double time);

    [[nodiscard]] simd::TileList tile(std::size_t index, const State& state);
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::int64_t builds() const { return builds_; }
    [[nodiscard]] std::int64_t refreshes() const { return refreshes_; }

private:
    // What contacts remember, beside a list: rows of numbers, and a bit for each pair that touches.
    struct Memory {
        std::vector<double> rows;
        std::vector<std::uint8_t> touched;

        void clear(std::size_t pairs, std::size_t row);
        [[nodiscard]] bool touches(std::size_t pair) const {
            return (touched[pair / 8] >> (pair % 8) & 1) != 0;
        }
        void set(std::size_t pair, const double* values, std::size_t count, std::size_t row);
    };
    struct Tile {
        // Pairs of gap below the skin, and those of gap below the near skin; each padded by a block.
        std::vector<std::int32_t> i, j, near_i, near_j;
        std::vector<std::int32_t> position; // of near pairs in the outer list
        Memory memory;
        std::int32_t count = 0, near_count = 0;
        simd::Images images = simd::Images::none;
        double largest_square = 0; // of the displacements since the last build
    };

    [[nodiscard]] bool outer_valid(const State& state, const simd::PairView& pairs, int threads);
    void build(const State& state, const simd::PairView& pairs, const simd::DimensionKernels& kernels,
               int threads);
    void build_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                    const simd::DimensionKernels& kernels);
    [[nodiscard]] bool may_cross(const Tile& tile, const State& state, const simd::PairView& pairs) const;
    void refresh(const State& state, const simd::PairView& pairs, const simd::DimensionKernels& kernels,
                 int threads, bool rebuilt);
    void refresh_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                      const simd::DimensionKernels& kernels, bool rebuilt);
    void recall_memory(Tile& tile, const State& state) const;
    [[nodiscard]] std::size_t touching() const; // pairs whose contacts remember something
    void add_memory(const Tile& tile, const State& state, ContactMemory& to) const;
    [[nodiscard]] std::size_t row() const { return static_cast<std::size_t>(simd::memory_row(fields_)); }

    LinkCells cells_;
    std::vector<Tile> tiles_;
    Column<double> built_;             // positions at the last build, [grain][dimension]
    Column<std::int32_t> built_image_; // and images along y, with a seam
    Vec lower_, upper_;
    template <int dimension>
    [[nodiscard]] double largest_square(const State& state, const simd::PairView& pairs,
                                        std::size_t tile) const;
    [[nodiscard]] Vec displacement(const State& state, const simd::PairView& pairs, std::size_t i) const;

    double skin_ = 0, near_skin_ = 0, near_budget_ = 0;
    double shear_rate_ = 0, radius_max_ = 0, time_ = 0, built_time_ = 0;
    bool stale_ = true;
    int fields_ = 0;           // numbers that a contact remembers
    ContactMemory remembered_; // while there are no lists
    std::int64_t builds_ = 0, refreshes_ = 0;
};

} // namespace sandlane::md
