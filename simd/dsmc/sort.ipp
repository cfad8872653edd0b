// Counting sort of the particles of a tile by cell, stable.
#pragma once

#include "simd/dsmc_tables.hpp"
#include "simd/lanes.hpp"

#include <cstring>

namespace sandlane::simd {

template <class Arch> SANDLANE_INLINE void copy_row(double* to, const double* from) {
    std::memcpy(to, from, gas_row * sizeof(double));
}
// Of a place row: number of its cell, in the upper half of the last word.
template <class Arch> SANDLANE_INLINE std::int32_t cell_of(const double* place) {
    std::int32_t cell;
    std::memcpy(&cell, reinterpret_cast<const char*>(place + 3) + 4, sizeof cell);
    return cell;
}

template <class Arch, bool rough> SANDLANE_INLINE void sort_rows(const SortView& view) {
    std::int32_t* next = view.start + 1; // of each cell: where its next row goes
    const auto cells = static_cast<std::uint32_t>(view.cells);
    for (std::int32_t s = 0; s < view.segment_count; ++s) {
        const GasSegment& from = view.segments[s];
        for (std::int32_t n = 0; n < from.count; ++n) {
            const double* place = from.place + std::ptrdiff_t{n} * gas_row;
            const auto cell = static_cast<std::uint32_t>(cell_of<Arch>(place) - view.first_cell);
            if (from.mixed && cell >= cells) continue;
            const std::ptrdiff_t at = std::ptrdiff_t{next[cell]++} * gas_row;
            copy_row<Arch>(view.to.place + at, place);
            copy_row<Arch>(view.to.velocity + at, from.velocity + std::ptrdiff_t{n} * gas_row);
            if constexpr (rough) copy_row<Arch>(view.to.spin + at, from.spin + std::ptrdiff_t{n} * gas_row);
        }
    }
}

template <class Arch> std::int32_t sort_gas(const SortView& view) {
    std::int32_t* count = view.start + 2;
    const auto cells = static_cast<std::uint32_t>(view.cells);
    std::memset(view.start, 0, static_cast<std::size_t>(view.cells + 2) * sizeof(std::int32_t));
    for (std::int32_t s = 0; s < view.segment_count; ++s) {
        const GasSegment& from = view.segments[s];
        for (std::int32_t n = 0; n < from.count; ++n) {
            const auto cell = static_cast<std::uint32_t>(
                cell_of<Arch>(from.place + std::ptrdiff_t{n} * gas_row) - view.first_cell);
            if (from.mixed && cell >= cells) continue;
            ++count[cell];
        }
    }
    std::int32_t sum = 0;
    for (std::int32_t c = 2; c < view.cells + 2; ++c) {
        sum += view.start[c];
        view.start[c] = sum;
    }
    if (view.to.spin != nullptr)
        sort_rows<Arch, true>(view);
    else
        sort_rows<Arch, false>(view);
    return view.start[view.cells];
}

} // namespace sandlane::simd
