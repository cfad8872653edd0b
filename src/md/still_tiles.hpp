// Tiles of grains at rest to the last bit (docs/physics.md 9): what one step leaves as it was, the next one
// leaves as well, as long as nothing that acts on it changes. Such tiles are stepped over, exactly.
#pragma once

#include "md/state.hpp"
#include "simd/tables.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandlane::md {

class StillTiles {
public:
    // Nothing is known any more: the records were written elsewhere, or storage order or lists are new.
    void reset(std::size_t tiles);
    // The list of a tile is new.
    void see_list(std::size_t tile, const simd::TileList& list);

    // Whether the step would change nothing in the tile: neither did the last one, nor did it change its
    // partners.
    [[nodiscard]] bool can_skip(std::size_t tile) const;
    // Before and after a step of the tile, which leaves its new records in state.next_record; what walls
    // remember of it is `wall_memory`. Moving walls keep a tile awake.
    void before(std::size_t tile, const State& state, const simd::TileList& list, int memory_row,
                const std::vector<double>& wall_memory);
    void after(std::size_t tile, const State& state, const simd::TileList& list, int memory_row,
               const std::vector<double>& wall_memory, bool moving_walls);
    // Tiles whose records the step before left: those that are worth a look at the rest of their state.
    [[nodiscard]] bool at_rest(std::size_t tile) const { return resting_[tile] != 0; }
    // The step is over.
    void advance();
    [[nodiscard]] std::size_t skipped() const; // by the next step, as things stand

private:
    void see_partners(std::size_t tile, const simd::TileList& list);

    struct Tile {
        std::vector<std::uint32_t> partners; // other tiles
        bool known = false;                  // partners
        std::vector<double> gear, memory, walls;
        std::vector<std::uint8_t> touched;
    };
    // Of the last step, and of this one: records as they were; the whole state as it was.
    std::vector<std::uint8_t> resting_, resting_now_, still_, still_now_;
    std::vector<Tile> tiles_;
};

} // namespace sandlane::md
