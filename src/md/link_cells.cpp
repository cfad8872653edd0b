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

LinkCells::LinkCells(const scene::Scene& scene, const Plan& plan, double radius_max, bool brute_force,
                     double skin)
    : dimension_(plan.dimension), periodic_(scene.domain.periodic), sheared_(scene.domain.shear_rate != 0) {
    const Vec size = plan.upper - plan.lower;
    const double lower[] = {plan.lower.x, plan.lower.y, plan.lower.z}, length[] = {size.x, size.y, size.z};
    const double edge =
        (2 * radius_max + skin) * (1 + 0x1p-30); // rounding of positions never exceeds the margin
    const double most = dimension_ == 3 ? 512 : 4096;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d) {
        if (!brute_force && edge > 0) count_[d] = cell_count(length[d], edge, periodic_[d], most);
        lower_[d] = lower[d];
        edge_[d] = length[d] / count_[d];
    }
    start_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(rows()) + 2, 0);
}

std::size_t LinkCells::bytes() const {
    std::size_t total = radius_.bytes() + owner_.bytes() + start_.bytes() + cell_.bytes() + slot_.bytes();
    for (const Column<double>& column : position_) total += column.bytes();
    return total;
}

simd::BinView LinkCells::bin_view(const State& state) {
    simd::BinView bin{};
    bin.records = state.record.data();
    bin.site = cell_.data();
    std::ptrdiff_t stride = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        bin.lower[d] = lower_[d];
        bin.edge[d] = edge_[d];
        bin.count[d] = count_[d];
        bin.stride[d] = stride;
        stride *= count_[d];
    }
    return bin;
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
        kernel(bin, static_cast<std::int64_t>(tile * tile_size),
               static_cast<std::int64_t>(std::min(n, (tile + 1) * tile_size)));
    });
    start_.fill(0);
    // Counts stand two cells further on, their sums one: filling moves each to where the cell starts.
    for (std::size_t i = 0; i < n; ++i) ++start_[static_cast<std::size_t>(cell_[i]) + 2];
    std::int32_t fullest = 0;
    for (std::size_t c = 2; c < start_.size(); ++c) {
        fullest = std::max(fullest, start_[c]);
        start_[c] += start_[c - 1];
    }
    most_around_ =
        std::min(n, (dimension_ == 3 ? std::size_t{27} : std::size_t{9}) * static_cast<std::size_t>(fullest));
    for (std::size_t i = 0; i < n; ++i) {
        const auto slot = static_cast<std::size_t>(start_[static_cast<std::size_t>(cell_[i]) + 1]++);
        const double* record = state.record_of(i);
        for (std::size_t d = 0; d < dimensions; ++d) position_[d][slot] = record[d];
        radius_[slot] = state.radius(i);
        owner_[slot] = static_cast<std::int32_t>(i);
        slot_[i] = static_cast<std::int32_t>(slot);
    }
}

simd::CellView LinkCells::view() const {
    simd::CellView view{};
    for (std::size_t d = 0; d < 3; ++d) {
        view.position[d] = position_[d].data();
        view.count[d] = count_[d];
        view.periodic[d] = periodic_[d];
    }
    view.sheared = sheared_;
    view.radius = radius_.data();
    view.owner = owner_.data();
    view.start = start_.data();
    return view;
}

} // namespace sandlane::md
