// Link cells: lanes are eight candidates of one particle, contiguous in the cell-sorted columns; full list
// (each contact is met from both sides), so tiles of cell rows write only their own particles. Classes of
// radii have a grid each; what a particle may reach is looked at in all of them.
#pragma once

#include "simd/md/pairs.ipp"

namespace sandlane::simd {

// The cells next to `at` in one direction, as at most two runs (a periodic seam splits them).
struct Runs {
    std::int32_t first[2], last[2];
    int count;
};
SANDLANE_INLINE Runs neighbours(std::int32_t at, std::int32_t cells, bool periodic) {
    if (cells == 1) return {{0, 0}, {0, 0}, 1};
    if (periodic && at == 0) return {{0, cells - 1}, {1, cells - 1}, 2};
    if (periodic && at == cells - 1) return {{0, at - 1}, {0, at}, 2};
    const std::int32_t first = at > 0 ? at - 1 : 0;
    const std::int32_t last = at < cells - 1 ? at + 1 : at;
    return {{first, 0}, {last, 0}, 1};
}

// Calls body(begin, end) for the runs of sorted particles in the cells around (column, row, layer).
template <class Body>
SANDLANE_INLINE void for_runs(const CellView& cells, const std::int32_t (&at)[3], const Body& body) {
    Runs runs[3];
    for (int d = 0; d < 3; ++d) runs[d] = neighbours(at[d], cells.count[d], cells.periodic[d]);
    for (int l = 0; l < runs[2].count; ++l)
        for (std::int32_t layer = runs[2].first[l]; layer <= runs[2].last[l]; ++layer)
            for (int r = 0; r < runs[1].count; ++r)
                for (std::int32_t row = runs[1].first[r]; row <= runs[1].last[r]; ++row) {
                    const std::int32_t* start =
                        cells.start + (std::ptrdiff_t{layer} * cells.count[1] + row) * cells.count[0];
                    if (cells.sheared && (row > at[1] + 1 || row < at[1] - 1)) {
                        body(start[0], start[cells.count[0]]);
                        continue;
                    }
                    for (int c = 0; c < runs[0].count; ++c)
                        body(start[runs[0].first[c]], start[runs[0].last[c] + 1]);
                }
}

// The cells of a grid within reach of a place in one direction, of which those below 0 and from `cells` on
// stand beyond a periodic side.
struct Reach {
    std::int32_t first, last;
    bool all; // every cell, once
};
SANDLANE_INLINE Reach cells_within(double x, double reach, const CellGrid& grid, int d, bool periodic) {
    const double cells = grid.count[d];
    double low = __builtin_floor((x - reach - grid.lower[d]) * grid.inverse_edge[d]);
    double high = __builtin_floor((x + reach - grid.lower[d]) * grid.inverse_edge[d]);
    const double least = periodic ? -cells : 0.0, most = periodic ? 2 * cells - 1 : cells - 1;
    low = sandlane::max(sandlane::min(low, most), least);
    high = sandlane::max(sandlane::min(high, most), least);
    if (high - low + 1 >= cells) return {0, grid.count[d] - 1, true};
    return {static_cast<std::int32_t>(low), static_cast<std::int32_t>(high), false};
}
SANDLANE_INLINE std::int32_t wrapped(std::int32_t at, std::int32_t cells) {
    return at < 0 ? at + cells : at >= cells ? at - cells : at;
}
// Distance of x to the cells number `at` of direction d.
SANDLANE_INLINE double distance_to_cell(double x, const CellGrid& grid, int d, std::int32_t at) {
    const double edge = 1.0 / grid.inverse_edge[d], low = grid.lower[d] + at * edge - x;
    return sandlane::max(sandlane::max(low, -(low + edge)), 0.0);
}

// Calls body(begin, end) for the runs of sorted particles in the cells of all classes that a particle may
// reach, by class, layer, row and column from the lower to the upper end of its reach.
template <int dimension, class Body>
SANDLANE_INLINE void for_runs_of_classes(const CellView& cells, std::int32_t self, double skin,
                                         const Body& body) {
    double x[3] = {};
    for (int d = 0; d < dimension; ++d) x[d] = cells.position[d][self];
    for (std::int32_t c = 0; c < cells.classes; ++c) {
        const CellGrid& grid = cells.grids[c];
        const double reach = (cells.radius[self] + grid.radius + skin) * cell_margin;
        Reach within[3] = {};
        for (int d = 0; d < dimension; ++d) within[d] = cells_within(x[d], reach, grid, d, cells.periodic[d]);
        // Of cells smaller than the particle those in the corners of the box around it are left out.
        const bool round =
            within[1].last - within[1].first > 3 && !within[0].all && !within[1].all && !within[2].all;
        for (std::int32_t layer = within[2].first; layer <= within[2].last; ++layer)
            for (std::int32_t row = within[1].first; row <= within[1].last; ++row) {
                const std::ptrdiff_t line = std::ptrdiff_t{wrapped(layer, grid.count[2])} * grid.count[1] +
                                            wrapped(row, grid.count[1]);
                const std::int32_t* start = grid.start + line * grid.count[0];
                Reach columns = within[0];
                if (cells.sheared && (within[1].all || row < 0 || row >= grid.count[1])) {
                    columns.all = true;
                } else if (round) {
                    const double y = distance_to_cell(x[1], grid, 1, row);
                    const double z = dimension == 3 ? distance_to_cell(x[2], grid, 2, layer) : 0.0;
                    const double square = reach * reach - y * y - z * z;
                    if (square < 0) continue;
                    columns = cells_within(x[0], sandlane::sqrt(square), grid, 0, cells.periodic[0]);
                }
                const std::int32_t n = grid.count[0], first = columns.first, last = columns.last;
                if (columns.all) {
                    body(start[0], start[n]);
                } else if (first < 0 && last >= 0) {
                    body(start[first + n], start[n]);
                    body(start[0], start[last + 1]);
                } else if (first < n && last >= n) {
                    body(start[first], start[n]);
                    body(start[0], start[last - n + 1]);
                } else {
                    body(start[wrapped(first, n)], start[wrapped(last, n) + 1]);
                }
            }
    }
}

// Bits of the eight sorted particles from `first` on, before `end` and not `self`, that are closer to it than
// the sum of their radius and `reach`, whose square is widened by `margin`.
template <class Arch, int dimension> struct Near {
    using R = Block<Arch>;
    const CellView& cells;
    const PairView& view;
    std::int32_t self;
    R position[dimension], reach, margin;

    SANDLANE_INLINE Near(const CellView& c, const PairView& v, std::int32_t s, double skin, double widening)
        : cells(c), view(v), self(s), reach(c.radius[s] + skin), margin(widening) {
        for (int d = 0; d < dimension; ++d) position[d] = R(c.position[d][s]);
    }
    SANDLANE_INLINE unsigned operator()(std::int32_t first, std::int32_t end) const {
        R x[dimension], shift(0.0);
        for (int d = 0; d < dimension; ++d) x[d] = load<Arch>(cells.position[d] + first) - position[d];
        if (view.sheared) cross_seam(view, x[1], x[0], shift);
        R square(0.0);
        for (int d = 0; d < dimension; ++d) {
            x[d] = minimum_image(x[d], view.half[d], view.period[d]);
            square = d == 0 ? x[d] * x[d] : square + x[d] * x[d];
        }
        const R sum = load<Arch>(cells.radius + first) + reach;
        unsigned hits = bits(square < sum * sum * margin);
        if (end - first < width) hits &= (1u << (end - first)) - 1u;
        const std::int32_t own = self - first;
        if (own >= 0 && own < width) hits &= ~(1u << own);
        return hits;
    }
};

template <class Arch, int dimension>
std::int32_t cell_candidates(const CellView& cells, const PairView& view, std::int32_t cell,
                             std::int32_t self, double skin, std::int32_t* out) {
    const std::int32_t row = cell / cells.count[0];
    const std::int32_t at[3] = {cell % cells.count[0], row % cells.count[1], row / cells.count[1]};
    const Near<Arch, dimension> near(cells, view, self, skin, 1.0);
    std::int32_t count = 0;
    const auto look_at = [&](std::int32_t begin, std::int32_t end) {
        for (std::int32_t first = begin; first < end; first += width) {
            const unsigned hits = near(first, end);
            Integers<Arch, width>(cells.owner + first).compress(hits, out + count);
            count += __builtin_popcount(hits);
        }
    };
    if (cells.classes > 1)
        for_runs_of_classes<dimension>(cells, self, skin, look_at);
    else
        for_runs(cells, at, look_at);
    return count;
}

// Collects the candidates of one particle in runs, and evaluates them when there are enough.
template <class Arch, int dimension> struct Collect {
    const CellView& cells;
    const PairView& view;
    PairKernel kernel;
    PairBuffer& pairs;
    Near<Arch, dimension> near;
    std::int32_t i;

    SANDLANE_INLINE Collect(const CellView& c, const PairView& v, PairKernel k, PairBuffer& p,
                            std::int32_t self)
        : cells(c), view(v), kernel(k), pairs(p), near(c, v, self, 0.0, candidate_margin), i(c.owner[self]) {}
    SANDLANE_INLINE void operator()(std::int32_t begin, std::int32_t end) const {
        for (std::int32_t first = begin; first < end; first += width) {
            const unsigned hits = near(first, end);
            for (int n = 0; n < width; ++n) pairs.i[pairs.count + n] = i;
            Integers<Arch, width>(cells.owner + first).compress(hits, pairs.j + pairs.count);
            pairs.count += __builtin_popcount(hits);
            if (pairs.count >= pair_chunk) pairs.evaluate_full(view, kernel, Target::first);
        }
    }
};

template <class Arch, int dimension>
SweepResult cells_of_classes(const CellView& cells, const PairView& view, PairKernel kernel,
                             std::int32_t row_begin, std::int32_t row_end) {
    PairBuffer pairs;
    SweepResult result;
    for (std::int32_t c = 0; c < cells.classes; ++c) {
        const CellGrid& grid = cells.grids[c];
        const std::int32_t rows = grid.count[1] * grid.count[2];
        const std::int32_t from = row_begin - grid.first_row, to = row_end - grid.first_row;
        for (std::int32_t row = from > 0 ? from : 0; row < (to < rows ? to : rows); ++row) {
            const std::int32_t* start = grid.start + std::ptrdiff_t{row} * grid.count[0];
            for (std::int32_t self = start[0]; self < start[grid.count[0]]; ++self)
                for_runs_of_classes<dimension>(cells, self, 0.0,
                                               Collect<Arch, dimension>(cells, view, kernel, pairs, self));
            result.occupied += start[grid.count[0]] - start[0];
        }
    }
    pairs.evaluate_rest(view, kernel, Target::first);
    result.largest_overlap = pairs.largest_overlap;
    return result;
}

template <class Arch, int dimension>
SweepResult cells_full(const CellView& cells, const PairView& view, PairKernel kernel, std::int32_t row_begin,
                       std::int32_t row_end) {
    if (cells.classes > 1) return cells_of_classes<Arch, dimension>(cells, view, kernel, row_begin, row_end);
    PairBuffer pairs;
    SweepResult result;
    for (std::int32_t row = row_begin; row < row_end; ++row)
        for (std::int32_t column = 0; column < cells.count[0]; ++column) {
            const std::ptrdiff_t cell = std::ptrdiff_t{row} * cells.count[0] + column;
            const std::int32_t at[3] = {column, row % cells.count[1], row / cells.count[1]};
            for (std::int32_t self = cells.start[cell]; self < cells.start[cell + 1]; ++self)
                for_runs(cells, at, Collect<Arch, dimension>(cells, view, kernel, pairs, self));
            result.occupied += cells.start[cell + 1] - cells.start[cell];
        }
    pairs.evaluate_rest(view, kernel, Target::first);
    result.largest_overlap = pairs.largest_overlap;
    return result;
}

template <class Arch, int dimension, Images images>
std::int32_t near_pairs_of(const PairView& view, const std::int32_t* i, const std::int32_t* j,
                           std::int32_t count, double skin, std::int32_t* near_i, std::int32_t* near_j,
                           std::int32_t* position) {
    using R = Block<Arch>;
    std::int32_t found = 0;
    for (std::int32_t n = 0; n < count; n += width) {
        const std::int32_t here[width] = {n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, n + 7};
        R field[record_fields];
        CombinePairs<Arch, dimension>::apply(view.records, i + n, j + n, field);
        const R square = separate<Arch, dimension, images>(view, field);
        const R reach = field[Record<dimension>::radius] + R(skin);
        unsigned hits = bits(square < reach * reach);
        if (count - n < width) hits &= (1u << (count - n)) - 1u;
        Integers<Arch, width>(i + n).compress(hits, near_i + found);
        Integers<Arch, width>(j + n).compress(hits, near_j + found);
        Integers<Arch, width>(here).compress(hits, position + found);
        found += __builtin_popcount(hits);
    }
    return found;
}

template <class Arch, int dimension>
std::int32_t near_pairs(const PairView& view, const std::int32_t* i, const std::int32_t* j,
                        std::int32_t count, double skin, std::int32_t* near_i, std::int32_t* near_j,
                        std::int32_t* position) {
    if (view.sheared)
        return near_pairs_of<Arch, dimension, Images::sheared>(view, i, j, count, skin, near_i, near_j,
                                                               position);
    return near_pairs_of<Arch, dimension, Images::periodic>(view, i, j, count, skin, near_i, near_j,
                                                            position);
}

} // namespace sandlane::simd
