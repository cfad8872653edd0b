#include "md/link_cells.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace {

// Cells of edge >= diameter; a periodic direction needs three, or one that holds everything. Finer grids than
// `most` cost more memory than they save time.
std::int32_t cell_count(double length, double edge, bool periodic, double most) {
    const auto count = static_cast<std::int32_t>(std::clamp(std::floor(length / edge), 1.0, most));
    return periodic && count < 3 ? 1 : count;
}

} // namespace

LinkCells::LinkCells(const scene::Scene& scene, const Plan& plan, const Needs& needs, bool brute_force,
                     double skin)
    : dimension_(plan.dimension), skin_(skin), periodic_(scene.domain.periodic),
      sheared_(scene.domain.shear_rate != 0) {
    const Vec size = plan.upper - plan.lower;
    lower_ = {plan.lower.x, plan.lower.y, plan.lower.z};
    length_ = {size.x, size.y, size.z};
    std::vector<scene::SizeClass> classes = needs.sizes;
    if (brute_force || classes.size() < 2) classes = {{needs.radius_max, needs.grains + needs.poured}};
    grids_.clear();
    for (const scene::SizeClass& c : classes) {
        Grid& grid = grids_.emplace_back();
        grid.largest = c.largest;
        // Empty cells cost time, too: where there are several grids, each has a few cells per grain of its
        // class at most.
        const double most = classes.size() > 1 ? 64 + 2 * static_cast<double>(c.grains)
                            : dimension_ == 3  ? 0x1p27
                                               : 0x1p24;
        fit(grid, brute_force ? 0.0 : (2 * c.largest + skin) * simd::cell_margin, most);
        if (grids_.size() == 1) continue;
        const Grid& before = grids_[grids_.size() - 2];
        grid.first_cell = before.first_cell + before.cells();
        grid.first_row = before.first_row + before.rows();
    }
    start_.resize(grids_.back().first_cell + grids_.back().cells() + 2, 0);
}

// Cells of at least this edge [m], `most` of them; edge 0: one.
void LinkCells::fit(Grid& grid, double edge, double most) const {
    const double most_across = dimension_ == 3 ? 512 : 4096;
    do {
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d) {
            if (edge > 0) grid.count[d] = cell_count(length_[d], edge, periodic_[d], most_across);
            grid.edge[d] = length_[d] / grid.count[d];
        }
        edge *= 1.25;
    } while (static_cast<double>(grid.cells()) > most);
}

void LinkCells::release() {
    for (Column<double>& column : position_) column = {};
    radius_ = {};
    owner_ = cell_ = slot_ = {};
}

std::size_t LinkCells::bytes() const {
    std::size_t total = radius_.bytes() + owner_.bytes() + start_.bytes() + cell_.bytes() + slot_.bytes();
    for (const Column<double>& column : position_) total += column.bytes();
    return total;
}

// Of the only class.
simd::BinView LinkCells::bin_view(const State& state) {
    simd::BinView bin{};
    bin.records = state.record.data();
    bin.site = cell_.data();
    std::ptrdiff_t stride = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        bin.lower[d] = lower_[d];
        bin.edge[d] = grids_[0].edge[d];
        bin.count[d] = grids_[0].count[d];
        bin.stride[d] = stride;
        stride *= bin.count[d];
    }
    return bin;
}

// Cell of a grain in the grid of its class; one beyond a periodic side, by rounding, is in the cell there.
std::int32_t LinkCells::cell_by_class(const State& state, std::size_t grain) const {
    const double radius = state.radius(grain), *record = state.record_of(grain);
    std::size_t c = 0;
    while (c + 1 < grids_.size() && radius > grids_[c].largest) ++c;
    const Grid& grid = grids_[c];
    std::size_t cell = 0;
    for (std::size_t d = static_cast<std::size_t>(dimension_); d-- > 0;) {
        const double count = grid.count[d];
        double at = std::floor((record[d] - lower_[d]) * (1 / grid.edge[d]));
        if (periodic_[d]) at += at < 0 ? count : at >= count ? -count : 0;
        at = at > 0 ? std::min(at, count - 1) : 0;
        cell = cell * static_cast<std::size_t>(grid.count[d]) + static_cast<std::size_t>(at);
    }
    return static_cast<std::int32_t>(grid.first_cell + cell);
}

void LinkCells::build(const State& state, simd::BinKernel kernel, int threads) {
    const std::size_t n = state.size();
    const auto dimensions = static_cast<std::size_t>(dimension_);
    if (cell_.size() != n) {
        cell_.resize(n);
        slot_.resize(n);
        owner_.resize(n + block_width, 0);
        radius_.resize(n + block_width, 0.0);
        for (std::size_t d = 0; d < dimensions; ++d) position_[d].resize(n + block_width, 0.0);
    }
    const simd::BinView bin = bin_view(state);
    for_tiles(state.tiles(), threads, [&](std::size_t tile) {
        const std::size_t begin = tile * tile_size, end = std::min(n, (tile + 1) * tile_size);
        if (grids_.size() == 1) kernel(bin, static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end));
        for (std::size_t i = begin; i < end && grids_.size() > 1; ++i) cell_[i] = cell_by_class(state, i);
    });
    start_.fill(0);
    // Counts stand two cells further on, their sums one: filling moves each to where the cell starts.
    for (std::size_t i = 0; i < n; ++i) ++start_[static_cast<std::size_t>(cell_[i]) + 2];
    for (Grid& grid : grids_) {
        grid.fullest = 0;
        for (std::size_t c = grid.first_cell + 2; c < grid.first_cell + grid.cells() + 2; ++c) {
            grid.fullest = std::max(grid.fullest, start_[c]);
            start_[c] += start_[c - 1];
        }
    }
    most_around_ = most_around(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto slot = static_cast<std::size_t>(start_[static_cast<std::size_t>(cell_[i]) + 1]++);
        const double* record = state.record_of(i);
        for (std::size_t d = 0; d < dimensions; ++d) position_[d][slot] = record[d];
        radius_[slot] = state.radius(i);
        owner_[slot] = static_cast<std::int32_t>(i);
        slot_[i] = static_cast<std::int32_t>(slot);
    }
    grid_views_.clear();
    for (const Grid& grid : grids_) {
        simd::CellGrid& view = grid_views_.emplace_back();
        view.start = start_.data() + grid.first_cell;
        view.first_row = grid.first_row;
        view.radius = grid.largest;
        for (std::size_t d = 0; d < 3; ++d) {
            view.count[d] = grid.count[d];
            view.lower[d] = lower_[d];
            view.inverse_edge[d] = 1 / grid.edge[d];
        }
    }
}

// The largest grains reach most; a side of their reach may meet two cells that it does not cover.
std::size_t LinkCells::most_around(std::size_t grains) const {
    double most = 0;
    for (const Grid& grid : grids_) {
        const double reach = (grids_.back().largest + grid.largest + skin_) * simd::cell_margin;
        double cells = 1;
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d) {
            const double met = grids_.size() == 1 ? 3 : std::floor(2 * reach / grid.edge[d]) + 2;
            cells *= std::min(met, static_cast<double>(grid.count[d]));
        }
        if (sheared_) cells = static_cast<double>(grid.cells());
        most += cells * grid.fullest;
    }
    return std::min(grains, static_cast<std::size_t>(most));
}

simd::CellView LinkCells::view() const {
    simd::CellView view{};
    for (std::size_t d = 0; d < 3; ++d) {
        view.position[d] = position_[d].data();
        view.count[d] = grids_[0].count[d];
        view.periodic[d] = periodic_[d];
    }
    view.sheared = sheared_;
    view.radius = radius_.data();
    view.owner = owner_.data();
    view.start = start_.data();
    view.classes = static_cast<std::int32_t>(grids_.size());
    view.grids = grid_views_.data();
    return view;
}

} // namespace sandlane::md
