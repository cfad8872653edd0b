// Number of the cell at a place, with cells numbered tile by tile: those of a tile, a block of cells, follow
// each other.
#pragma once

#include "laws/elementary.hpp"

namespace sandlane::laws {

// One direction. Its part of the number of cell c in tile t = floor(c/edge) is c step + t jump.
struct CellAxis {
    double lower = 0, inverse_edge = 0; // m, 1/m
    double last = 0;                    // cells - 1
    double inverse_tile = 1;            // 1/(cells of a tile), rounded up
    double step = 0, jump = 0;
};

// place: at `lower` or above; beyond the upper side it is the last cell.
template <class R> SANDLANE_INLINE R cell_number(const CellAxis& axis, const R& place) {
    const R cell = min(whole((place - R(axis.lower)) * R(axis.inverse_edge)), R(axis.last));
    const R tile = whole(cell * R(axis.inverse_tile));
    return cell * R(axis.step) + tile * R(axis.jump);
}

// Anywhere: walls that oscillate go beyond the sides.
template <class R> SANDLANE_INLINE R nearest_cell_number(const CellAxis& axis, const R& place) {
    return cell_number(axis, max(place, R(axis.lower)));
}

} // namespace sandlane::laws
