// Tiles: blocks of cells that one thread works on at a time. Cells are numbered tile by tile, so that those
// of a tile follow each other; the order of tiles is that of the particles, which sorting keeps.
#pragma once

#include "laws/cell_number.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace sandlane::dsmc {

struct Neighbour {
    std::int32_t tile, slot; // slot: place of the particles that go there among those that leave
};

class Tiling {
public:
    Tiling() = default;
    // per_cell: mean number of particles; it decides, with the cells, how large a tile is.
    Tiling(const std::int32_t (&cells)[3], const bool (&periodic)[3], double per_cell);

    [[nodiscard]] std::int32_t tiles() const { return count_[0] * count_[1] * count_[2]; }
    [[nodiscard]] std::int32_t cells_per_tile() const { return edge_[0] * edge_[1] * edge_[2]; }
    [[nodiscard]] std::int32_t first_cell(std::int32_t tile) const { return tile * cells_per_tile(); }
    [[nodiscard]] std::int32_t numbers() const { return tiles() * cells_per_tile(); }

    // Slots of a tile: its neighbours, then one for all others.
    [[nodiscard]] std::int32_t slots() const { return slots_; }
    [[nodiscard]] std::int32_t far_slot() const { return slots_ - 1; }
    [[nodiscard]] std::int32_t slot(std::int32_t from, std::int32_t to) const;
    // Where particles come from, by ascending tile.
    [[nodiscard]] const std::vector<Neighbour>& sources(std::int32_t tile) const {
        return sources_[static_cast<std::size_t>(tile)];
    }
    [[nodiscard]] laws::CellAxis axis(int d, double lower, double upper) const;
    // Column, row and layer of a number; not all numbers have a cell.
    [[nodiscard]] std::array<std::int32_t, 3> cell(std::int32_t number) const;

private:
    [[nodiscard]] const std::array<std::int32_t, 3>& place(std::int32_t tile) const {
        return places_[static_cast<std::size_t>(tile)];
    }

    std::int32_t cells_[3] = {1, 1, 1}, edge_[3] = {1, 1, 1}, count_[3] = {1, 1, 1}, slots_ = 1;
    bool periodic_[3] = {true, true, true};
    std::vector<std::vector<Neighbour>> sources_;
    std::vector<std::array<std::int8_t, 27>> slot_;   // [tile][direction]
    std::vector<std::array<std::int32_t, 3>> places_; // of the tiles, in tiles
};

} // namespace sandlane::dsmc
