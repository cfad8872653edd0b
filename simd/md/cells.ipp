// Link cells: lanes are eight candidates of one particle, contiguous in the cell-sorted columns; full list
// (each contact is met from both sides), so tiles of cell rows write only their own particles.
#pragma once

#include "simd/md/pairs.ipp"

namespace sandlane::simd {

// One run of candidates [begin, end) of the particle at sorted position `self`.
template <class Arch>
SANDLANE_INLINE void sweep_run(const CellView& cells, const PairView& view, PairKernel kernel,
                               std::int32_t self, std::int32_t begin, std::int32_t end, PairBuffer& pairs) {
    using R = Block<Arch>;
    const R x(cells.x[self]), y(cells.y[self]), radius(cells.radius[self]);
    for (std::int32_t first = begin; first < end; first += width) {
        const R dx = minimum_image(load<Arch>(cells.x + first) - x, view.half_x, view.period_x);
        const R dy = minimum_image(load<Arch>(cells.y + first) - y, view.half_y, view.period_y);
        const R sum = load<Arch>(cells.radius + first) + radius;
        unsigned hits = bits(dx * dx + dy * dy < sum * sum * R(candidate_margin));
        if (end - first < width) hits &= (1u << (end - first)) - 1u;
        const std::int32_t own = self - first;
        if (own >= 0 && own < width) hits &= ~(1u << own);
        const std::int32_t i = cells.owner[self];
        for (int n = 0; n < width; ++n) pairs.i[pairs.count + n] = i;
        Integers<Arch, width>(cells.owner + first).compress(hits, pairs.j + pairs.count);
        pairs.count += __builtin_popcount(hits);
        if (pairs.count >= pair_chunk) pairs.evaluate_full(view, kernel, Target::first);
    }
}

// The columns next to `column`, as at most two runs of cells (a periodic seam splits them).
struct ColumnRuns {
    std::int32_t first[2], last[2];
    int count;
};
template <class Arch>
SANDLANE_INLINE ColumnRuns neighbour_columns(std::int32_t column, std::int32_t columns, bool periodic) {
    if (columns == 1) return {{0, 0}, {0, 0}, 1};
    if (periodic && column == 0) return {{0, columns - 1}, {1, columns - 1}, 2};
    if (periodic && column == columns - 1) return {{0, column - 1}, {0, column}, 2};
    const std::int32_t first = column > 0 ? column - 1 : 0;
    const std::int32_t last = column < columns - 1 ? column + 1 : column;
    return {{first, 0}, {last, 0}, 1};
}

// As sweep_run, but for gaps below `skin`, and without evaluating anything.
template <class Arch>
std::int32_t cell_candidates(const CellView& cells, const PairView& view, std::int32_t cell,
                             std::int32_t self, double skin, std::int32_t* out) {
    using R = Block<Arch>;
    const R x(cells.x[self]), y(cells.y[self]), reach(cells.radius[self] + skin);
    const ColumnRuns rows = neighbour_columns<Arch>(cell / cells.columns, cells.rows, cells.periodic_y);
    const ColumnRuns runs = neighbour_columns<Arch>(cell % cells.columns, cells.columns, cells.periodic_x);
    std::int32_t count = 0;
    for (int r = 0; r < rows.count; ++r)
        for (std::int32_t other = rows.first[r]; other <= rows.last[r]; ++other)
            for (int c = 0; c < runs.count; ++c) {
                const std::int32_t* start = cells.start + std::ptrdiff_t{other} * cells.columns;
                const std::int32_t end = start[runs.last[c] + 1];
                for (std::int32_t first = start[runs.first[c]]; first < end; first += width) {
                    const R dx = minimum_image(load<Arch>(cells.x + first) - x, view.half_x, view.period_x);
                    const R dy = minimum_image(load<Arch>(cells.y + first) - y, view.half_y, view.period_y);
                    const R sum = load<Arch>(cells.radius + first) + reach;
                    unsigned hits = bits(dx * dx + dy * dy < sum * sum);
                    if (end - first < width) hits &= (1u << (end - first)) - 1u;
                    const std::int32_t own = self - first;
                    if (own >= 0 && own < width) hits &= ~(1u << own);
                    Integers<Arch, width>(cells.owner + first).compress(hits, out + count);
                    count += __builtin_popcount(hits);
                }
            }
    return count;
}

template <class Arch>
std::int32_t near_pairs(const PairView& view, const std::int32_t* i, const std::int32_t* j,
                        std::int32_t count, double skin, std::int32_t* near_i, std::int32_t* near_j,
                        std::int32_t* position) {
    using R = Block<Arch>;
    std::int32_t found = 0;
    for (std::int32_t n = 0; n < count; n += width) {
        const std::int32_t here[width] = {n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, n + 7};
        R field[record_fields];
        CombinePairs<Arch>::apply(view.records, i + n, j + n, field);
        const R dx = minimum_image(field[0], view.half_x, view.period_x);
        const R dy = minimum_image(field[1], view.half_y, view.period_y);
        const R reach = field[5] + R(skin);
        unsigned hits = bits(dx * dx + dy * dy < reach * reach);
        if (count - n < width) hits &= (1u << (count - n)) - 1u;
        Integers<Arch, width>(i + n).compress(hits, near_i + found);
        Integers<Arch, width>(j + n).compress(hits, near_j + found);
        Integers<Arch, width>(here).compress(hits, position + found);
        found += __builtin_popcount(hits);
    }
    return found;
}

template <class Arch>
SweepResult cells_full(const CellView& cells, const PairView& view, PairKernel kernel, std::int32_t row_begin,
                       std::int32_t row_end) {
    PairBuffer pairs;
    SweepResult result;
    for (std::int32_t row = row_begin; row < row_end; ++row) {
        const ColumnRuns rows = neighbour_columns<Arch>(row, cells.rows, cells.periodic_y);
        for (std::int32_t column = 0; column < cells.columns; ++column) {
            const ColumnRuns runs = neighbour_columns<Arch>(column, cells.columns, cells.periodic_x);
            const std::ptrdiff_t cell = std::ptrdiff_t{row} * cells.columns + column;
            for (std::int32_t self = cells.start[cell]; self < cells.start[cell + 1]; ++self)
                for (int r = 0; r < rows.count; ++r)
                    for (std::int32_t other = rows.first[r]; other <= rows.last[r]; ++other)
                        for (int c = 0; c < runs.count; ++c) {
                            const std::int32_t* start = cells.start + std::ptrdiff_t{other} * cells.columns;
                            sweep_run<Arch>(cells, view, kernel, self, start[runs.first[c]],
                                            start[runs.last[c] + 1], pairs);
                        }
            result.occupied += cells.start[cell + 1] - cells.start[cell];
        }
    }
    pairs.evaluate_rest(view, kernel, Target::first);
    result.largest_overlap = pairs.largest_overlap;
    return result;
}

} // namespace sandlane::simd
