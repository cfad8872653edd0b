// Pair finding: lattice, link cells, near pairs of a list.
#include "md/reference/reference.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sandlane::simd::reference {

namespace {

// Evaluates one pair as soon as it is found.
struct Visit {
    const PairView& view;
    PairKernel kernel;
    Target target;
    double largest = 0;

    void operator()(std::int32_t i, std::int32_t j) { largest = kernel(view, &i, &j, 1, target, largest); }
};

// Whether two particles are close enough to be worth the law, in double precision from their records.
bool near(const PairView& view, std::int32_t i, std::int32_t j) {
    const Pair<2> pair(view, i, j);
    return pair.square < pair.sum * pair.sum * candidate_margin;
}

// Sites of one row with mask offsets [k_begin, k_end): full mask, site by site.
std::int64_t visit_row(const LatticeView& lattice, std::int32_t row, int k_begin, int k_end, Visit& visit) {
    std::int64_t occupied = 0;
    const std::ptrdiff_t row_start = lattice.origin + row * lattice.row_stride;
    for (std::ptrdiff_t site = row_start; site < row_start + lattice.columns; ++site) {
        const std::int32_t i = lattice.owner[site];
        if (i < 0) continue;
        ++occupied;
        for (int k = k_begin; k < k_end; ++k) {
            const std::int32_t j = lattice.owner[site + lattice.offsets[k]];
            if (j >= 0 && near(visit.view, i, j)) visit(i, j);
        }
    }
    return occupied;
}

// The half mask adds to both partners, so its order matters: groups of sites, then offsets, then sites.
std::int64_t visit_row_grouped(const LatticeView& lattice, std::int32_t row, int k_begin, int k_end,
                               Visit& visit) {
    std::int64_t occupied = 0;
    const std::ptrdiff_t row_start = lattice.origin + row * lattice.row_stride;
    const std::ptrdiff_t row_end = row_start + lattice.columns;
    for (std::ptrdiff_t first = row_start; first < row_end; first += site_group) {
        const std::ptrdiff_t last = first + site_group < row_end ? first + site_group : row_end;
        for (std::ptrdiff_t site = first; site < last; ++site) occupied += lattice.owner[site] >= 0 ? 1 : 0;
        for (int k = k_begin; k < k_end; ++k)
            for (std::ptrdiff_t site = first; site < last; ++site) {
                const std::int32_t i = lattice.owner[site], j = lattice.owner[site + lattice.offsets[k]];
                if (i >= 0 && j >= 0 && near(visit.view, i, j)) visit(i, j);
            }
    }
    return occupied;
}

SweepResult lattice_full(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                         std::int32_t row_begin, std::int32_t row_end) {
    const int offsets = (2 * lattice.reach + 1) * (2 * lattice.reach + 1) - 1;
    Visit visit{view, kernel, Target::first};
    SweepResult result;
    for (std::int32_t row = row_begin; row < row_end; ++row)
        result.occupied += visit_row(lattice, row, 0, offsets, visit);
    result.largest_overlap = visit.largest;
    return result;
}

SweepResult lattice_half(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                         std::int32_t row_begin, std::int32_t row_end) {
    const int side = 2 * lattice.reach + 1;
    const int begin = (side * side - 1) / 2;
    SweepResult result;
    // Offsets [first, last) of row distances a, by target, in the order rows above, tile, rows below.
    const auto pass = [&](std::int32_t row_first, std::int32_t row_last, Target target) {
        Visit visit{view, kernel, target, result.largest_overlap};
        for (std::int32_t row = row_first; row < row_last; ++row) {
            const int all = begin + lattice.reach + lattice.reach * side;
            const int to_tile = begin + lattice.reach + (row_begin - 1 - row) * side;
            const int to_end = begin + lattice.reach + (row_end - 1 - row) * side;
            const int cut = to_end < all ? to_end : all;
            if (target == Target::second) visit_row_grouped(lattice, row, to_tile, all, visit);
            if (target == Target::both) result.occupied += visit_row_grouped(lattice, row, begin, cut, visit);
            if (target == Target::first) visit_row_grouped(lattice, row, cut, all, visit);
        }
        result.largest_overlap = visit.largest;
    };
    pass(row_begin - lattice.reach, row_begin, Target::second);
    pass(row_begin, row_end, Target::both);
    pass(row_begin, row_end, Target::first);
    return result;
}

// The cells next to `at` in one direction, each once, in the order of the vector kernels.
template <class Body>
void for_neighbours(std::int32_t at, std::int32_t cells, bool periodic, const Body& body) {
    if (cells == 1) return body(0);
    std::int32_t neighbours[3] = {at - 1, at, at + 1};
    if (periodic && at == 0) neighbours[0] = at, neighbours[1] = at + 1, neighbours[2] = cells - 1;
    if (periodic && at == cells - 1) neighbours[0] = 0, neighbours[1] = at - 1, neighbours[2] = at;
    for (const std::int32_t n : neighbours)
        if (n >= 0 && n < cells) body(n);
}

// Calls body(n) for the sorted particles n of the cell and of those around it.
template <class Body> void for_around(const CellView& cells, std::int32_t cell, const Body& body) {
    const std::int32_t row_of_all = cell / cells.count[0];
    const std::int32_t column = cell % cells.count[0], row = row_of_all % cells.count[1],
                       layer = row_of_all / cells.count[1];
    for_neighbours(layer, cells.count[2], cells.periodic[2], [&](std::int32_t l) {
        for_neighbours(row, cells.count[1], cells.periodic[1], [&](std::int32_t r) {
            const auto look_at = [&](std::int32_t c) {
                const std::ptrdiff_t other = (std::ptrdiff_t{l} * cells.count[1] + r) * cells.count[0] + c;
                for (std::int32_t n = cells.start[other]; n < cells.start[other + 1]; ++n) body(n);
            };
            if (cells.sheared && (r > row + 1 || r < row - 1))
                for (std::int32_t c = 0; c < cells.count[0]; ++c) look_at(c);
            else
                for_neighbours(column, cells.count[0], cells.periodic[0], look_at);
        });
    });
}

// Cells of a grid that the interval x +- reach meets, from its lower to its upper end; those beyond a
// periodic side are marked. All cells, once and in order, if the interval is longer than the domain.
struct CellAt {
    std::int32_t index;
    bool beyond;
};
std::vector<CellAt> cells_met(double x, double reach, const CellGrid& grid, int d, bool periodic) {
    const std::int32_t cells = grid.count[d];
    const auto cell_of = [&](double at) {
        const double n = std::floor((at - grid.lower[d]) * grid.inverse_edge[d]);
        return static_cast<std::int32_t>(
            std::clamp(n, periodic ? -1.0 * cells : 0.0, periodic ? 2.0 * cells - 1 : cells - 1.0));
    };
    const std::int32_t low = cell_of(x - reach), high = cell_of(x + reach);
    std::vector<CellAt> met;
    if (high - low + 1 >= cells)
        for (std::int32_t n = 0; n < cells; ++n) met.push_back({n, periodic});
    else
        for (std::int32_t n = low; n <= high; ++n) met.push_back({(n + cells) % cells, n < 0 || n >= cells});
    return met;
}

// Calls body(n) for the sorted particles n of all classes in the cells around the particle.
template <int dimension, class Body>
void for_reached(const CellView& cells, std::int32_t self, double skin, const Body& body) {
    for (std::int32_t c = 0; c < cells.classes; ++c) {
        const CellGrid& grid = cells.grids[c];
        const double reach = (cells.radius[self] + grid.radius + skin) * cell_margin;
        const auto met = [&](int d) {
            if (d >= dimension) return std::vector<CellAt>{{0, false}};
            return cells_met(cells.position[d][self], reach, grid, d, cells.periodic[d]);
        };
        const std::vector<CellAt> columns = met(0), rows = met(1), layers = met(2);
        std::vector<CellAt> whole_row;
        whole_row.reserve(static_cast<std::size_t>(grid.count[0]));
        for (std::int32_t n = 0; n < grid.count[0]; ++n) whole_row.push_back({n, false});
        for (const CellAt layer : layers)
            for (const CellAt row : rows)
                for (const CellAt column : cells.sheared&& row.beyond ? whole_row : columns) {
                    const std::ptrdiff_t cell =
                        (std::ptrdiff_t{layer.index} * grid.count[1] + row.index) * grid.count[0] +
                        column.index;
                    for (std::int32_t n = grid.start[cell]; n < grid.start[cell + 1]; ++n) body(n);
                }
    }
}

template <int dimension>
double square_distance(const CellView& cells, const PairView& view, std::int32_t a, std::int32_t b) {
    double apart[dimension], shift = 0, square = 0;
    for (int d = 0; d < dimension; ++d) apart[d] = cells.position[d][b] - cells.position[d][a];
    if (view.sheared) cross_seam(view, apart[1], apart[0], shift);
    for (int d = 0; d < dimension; ++d) {
        const double x = nearest_image(apart[d], view.half[d], view.period[d]);
        square += x * x;
    }
    return square;
}

template <int dimension>
SweepResult cells_full(const CellView& cells, const PairView& view, PairKernel kernel, std::int32_t row_begin,
                       std::int32_t row_end) {
    Visit visit{view, kernel, Target::first};
    SweepResult result;
    const auto look_from = [&](std::int32_t self) {
        return [&, self](std::int32_t n) {
            const double sum = cells.radius[n] + cells.radius[self];
            if (n != self && square_distance<dimension>(cells, view, self, n) < sum * sum * candidate_margin)
                visit(cells.owner[self], cells.owner[n]);
        };
    };
    for (std::int32_t c = 0; c < cells.classes && cells.classes > 1; ++c) {
        const CellGrid& grid = cells.grids[c];
        for (std::int32_t row = 0; row < grid.count[1] * grid.count[2]; ++row) {
            if (row + grid.first_row < row_begin || row + grid.first_row >= row_end) continue;
            const std::int32_t* start = grid.start + row * grid.count[0];
            for (std::int32_t self = start[0]; self < start[grid.count[0]]; ++self) {
                for_reached<dimension>(cells, self, 0.0, look_from(self));
                ++result.occupied;
            }
        }
    }
    if (cells.classes > 1) row_end = row_begin;
    for (std::int32_t cell = row_begin * cells.count[0]; cell < row_end * cells.count[0]; ++cell) {
        result.occupied += cells.start[cell + 1] - cells.start[cell];
        for (std::int32_t self = cells.start[cell]; self < cells.start[cell + 1]; ++self)
            for_around(cells, cell, look_from(self));
    }
    result.largest_overlap = visit.largest;
    return result;
}

// All grains around the cell, looked at one by one.
template <int dimension>
std::int32_t cell_candidates(const CellView& cells, const PairView& view, std::int32_t cell,
                             std::int32_t self, double skin, std::int32_t* out) {
    std::int32_t count = 0;
    const auto look_at = [&](std::int32_t n) {
        const double reach = cells.radius[n] + (cells.radius[self] + skin);
        if (n != self && square_distance<dimension>(cells, view, self, n) < reach * reach)
            out[count++] = cells.owner[n];
    };
    if (cells.classes > 1)
        for_reached<dimension>(cells, self, skin, look_at);
    else
        for_around(cells, cell, look_at);
    return count;
}

template <int dimension>
std::int32_t near_pairs(const PairView& view, const std::int32_t* i, const std::int32_t* j,
                        std::int32_t count, double skin, std::int32_t* near_i, std::int32_t* near_j,
                        std::int32_t* position) {
    std::int32_t found = 0;
    for (std::int32_t n = 0; n < count; ++n) {
        const Pair<dimension> pair(view, i[n], j[n]);
        const double reach = pair.sum + skin;
        if (!(pair.square < reach * reach)) continue;
        position[found] = n;
        near_i[found] = i[n];
        near_j[found++] = j[n];
    }
    return found;
}

template <int dimension> void fill(DimensionKernels& t) {
    t.cells = cells_full<dimension>;
    t.candidates = cell_candidates<dimension>;
    t.near_pairs = near_pairs<dimension>;
}

} // namespace

void fill_search(MdKernels& kernels) {
    fill<2>(kernels.plane);
    fill<3>(kernels.space);
    kernels.lattice_full[0] = kernels.lattice_full[1] = lattice_full;
    kernels.lattice_half[0] = kernels.lattice_half[1] = lattice_half;
}

} // namespace sandlane::simd::reference
