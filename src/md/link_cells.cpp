#include "md/link_cells.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace {

// Cells of edge >= diameter; a periodic direction needs three, or one that holds everything.
std::int32_t cell_count(double length, double edge, bool periodic) {
    const double most = 4096; // finer grids than this cost more memory than they save time
    const auto count = static_cast<std::int32_t>(std::clamp(std::floor(length / edge), 1.0, most));
    return periodic && count < 3 ? 1 : count;
}

} // namespace

LinkCells::LinkCells(const scene::Scene& scene, const Plan& plan, double radius_max, bool brute_force,
                     double skin)
    : lower_x_(plan.lower.x), lower_y_(plan.lower.y), periodic_x_(scene.domain.periodic[0]),
      periodic_y_(scene.domain.periodic[1]) {
    const double width = plan.upper.x - plan.lower.x, height = plan.upper.y - plan.lower.y;
    const double edge =
        (2 * radius_max + skin) * (1 + 0x1p-30); // rounding of positions never exceeds the margin
    if (!brute_force && edge > 0) {
        columns_ = cell_count(width, edge, periodic_x_);
        rows_ = cell_count(height, edge, periodic_y_);
    }
    cell_x_ = width / columns_;
    cell_y_ = height / rows_;
    start_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 2, 0);
}

std::size_t LinkCells::bytes() const {
    return x_.bytes() + y_.bytes() + radius_.bytes() + owner_.bytes() + start_.bytes() + cell_.bytes() +
           slot_.bytes();
}

void LinkCells::build(const State& state, simd::BinKernel kernel, int threads) {
    const std::size_t n = state.size();
    if (cell_.size() != n) {
        cell_.resize(n);
        slot_.resize(n);
        owner_.resize(n + block_width, 0);
        for (Column<double>* column : {&x_, &y_, &radius_}) column->resize(n + block_width, 0.0);
    }
    const simd::BinView bin{state.record.data(),
                            cell_.data(),
                            lower_x_,
                            lower_y_,
                            cell_x_,
                            cell_y_,
                            columns_,
                            rows_,
                            columns_,
                            0,
                            nullptr,
                            nullptr,
                            nullptr,
                            0};
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
    most_around_ = std::min(n, 9 * static_cast<std::size_t>(fullest));
    for (std::size_t i = 0; i < n; ++i) {
        const auto slot = static_cast<std::size_t>(start_[static_cast<std::size_t>(cell_[i]) + 1]++);
        const double* record = state.record.data() + i * simd::record_fields;
        x_[slot] = record[0];
        y_[slot] = record[1];
        radius_[slot] = state.radius[i];
        owner_[slot] = static_cast<std::int32_t>(i);
        slot_[i] = static_cast<std::int32_t>(slot);
    }
}

simd::CellView LinkCells::view() const {
    return {x_.data(), y_.data(), radius_.data(), owner_.data(), start_.data(),
            columns_,  rows_,     periodic_x_,    periodic_y_};
}

} // namespace sandlane::md
