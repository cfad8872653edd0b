// Counting sort of the particles of a tile by cell, stable. Particles that follow each other are mostly in
// the same cell, so a counter waits for its own last value; the rows are taken from two ends of the order at
// once, each with counters of its own.
#pragma once

#include "simd/dsmc/rows_of_four.hpp"
#include "simd/dsmc/tables.hpp"

#include <cstring>

namespace sandlane::simd {

// Of a place row: number of its cell, in the upper half of the last word.
template <class Arch> SANDLANE_INLINE std::int32_t cell_of(const double* place) {
    std::int32_t cell;
    std::memcpy(&cell, reinterpret_cast<const char*>(place + 3) + 4, sizeof cell);
    return cell;
}

// Rows [begin, end) of a segment.
struct SortRange {
    const GasSegment* segment;
    std::int32_t begin, end;
};

template <class Arch, bool rough> class SortRows {
public:
    SANDLANE_INLINE explicit SortRows(const SortView& view)
        : to_(view.to), first_(view.first_cell), cells_(static_cast<std::uint32_t>(view.cells)) {}

    SANDLANE_INLINE void count(const SortRange& range, std::int32_t* counts) const {
        const double* place = range.segment->place;
        const bool mixed = range.segment->mixed;
        for (std::int32_t n = range.begin; n < range.end; ++n) {
            const std::uint32_t cell = cell_at(place, n);
            if (mixed && cell >= cells_) continue;
            ++counts[cell];
        }
    }
    SANDLANE_INLINE void move(const SortRange& range, std::int32_t* next) const {
        const GasSegment from = *range.segment;
        for (std::int32_t n = range.begin; n < range.end; ++n) move_row(from, n, next);
    }
    // Two ranges of one segment at once.
    SANDLANE_INLINE void count(const SortRange& a, std::int32_t* counts_a, const SortRange& b,
                               std::int32_t* counts_b) const {
        const double* place = a.segment->place;
        const std::int32_t n = a.end - a.begin < b.end - b.begin ? a.end - a.begin : b.end - b.begin;
        for (std::int32_t k = 0; k < n; ++k) {
            ++counts_a[cell_at(place, a.begin + k)];
            ++counts_b[cell_at(place, b.begin + k)];
        }
        count({a.segment, a.begin + n, a.end}, counts_a);
        count({b.segment, b.begin + n, b.end}, counts_b);
    }
    SANDLANE_INLINE void move(const SortRange& a, std::int32_t* next_a, const SortRange& b,
                              std::int32_t* next_b) const {
        const GasSegment from = *a.segment;
        const std::int32_t n = a.end - a.begin < b.end - b.begin ? a.end - a.begin : b.end - b.begin;
        for (std::int32_t k = 0; k < n; ++k) {
            put_row(from, a.begin + k, next_a[cell_at(from.place, a.begin + k)]++);
            put_row(from, b.begin + k, next_b[cell_at(from.place, b.begin + k)]++);
        }
        move({a.segment, a.begin + n, a.end}, next_a);
        move({b.segment, b.begin + n, b.end}, next_b);
    }

private:
    [[nodiscard]] SANDLANE_INLINE std::uint32_t cell_at(const double* place, std::int32_t n) const {
        return static_cast<std::uint32_t>(cell_of<Arch>(place + std::ptrdiff_t{n} * gas_row) - first_);
    }
    SANDLANE_INLINE void put_row(const GasSegment& from, std::int32_t n, std::int32_t at) const {
        const std::ptrdiff_t source = std::ptrdiff_t{n} * gas_row, target = std::ptrdiff_t{at} * gas_row;
        copy_row<Arch>(to_.place + target, from.place + source);
        copy_row<Arch>(to_.velocity + target, from.velocity + source);
        if constexpr (rough) copy_row<Arch>(to_.spin + target, from.spin + source);
    }
    SANDLANE_INLINE void move_row(const GasSegment& from, std::int32_t n, std::int32_t* next) const {
        const std::uint32_t cell = cell_at(from.place, n);
        if (from.mixed && cell >= cells_) return;
        put_row(from, n, next[cell]++);
    }

    const GasRows to_;
    const std::int32_t first_;
    const std::uint32_t cells_;
};

template <class Arch, bool rough> SANDLANE_INLINE std::int32_t sort_rows(const SortView& view) {
    const SortRows<Arch, rough> rows(view);
    std::int32_t *a = view.next[0], *b = view.next[1];
    std::memset(a, 0, static_cast<std::size_t>(view.cells) * sizeof(std::int32_t));
    std::memset(b, 0, static_cast<std::size_t>(view.cells) * sizeof(std::int32_t));
    // Segments before the longest one and its first half, its second half and those after it.
    std::int32_t longest = 0;
    for (std::int32_t s = 1; s < view.segment_count; ++s)
        if (view.segments[s].count > view.segments[longest].count) longest = s;
    const GasSegment* middle = view.segment_count > 0 ? view.segments + longest : nullptr;
    const std::int32_t total = middle != nullptr ? middle->count : 0, half = total / 2;
    const auto all = [&](std::int32_t s) { return SortRange{view.segments + s, 0, view.segments[s].count}; };
    const SortRange first{middle, 0, half}, second{middle, half, total};
    const bool together = middle != nullptr && !middle->mixed;
    for (std::int32_t s = 0; s < longest; ++s) rows.count(all(s), a);
    if (together)
        rows.count(first, a, second, b);
    else if (middle != nullptr)
        rows.count(all(longest), b);
    for (std::int32_t s = longest + 1; s < view.segment_count; ++s) rows.count(all(s), b);
    std::int32_t sum = 0;
    for (std::int32_t c = 0; c < view.cells; ++c) {
        const std::int32_t of_a = a[c], of_b = b[c];
        view.start[c] = sum;
        a[c] = sum;
        b[c] = sum + of_a;
        sum += of_a + of_b;
    }
    view.start[view.cells] = sum;
    for (std::int32_t s = 0; s < longest; ++s) rows.move(all(s), a);
    if (together)
        rows.move(first, a, second, b);
    else if (middle != nullptr)
        rows.move(all(longest), b);
    for (std::int32_t s = longest + 1; s < view.segment_count; ++s) rows.move(all(s), b);
    return sum;
}

template <class Arch> std::int32_t sort_gas(const SortView& view) {
    return view.to.spin != nullptr ? sort_rows<Arch, true>(view) : sort_rows<Arch, false>(view);
}

} // namespace sandlane::simd
