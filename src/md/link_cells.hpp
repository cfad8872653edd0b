// Link cells (docs/physics.md 9): particles counting-sorted by cell at every step. One cell per direction is
// brute force.
#pragma once

#include "core/column.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "simd/tables.hpp"

#include <array>
#include <cstdint>

namespace sandlane::md {

class LinkCells {
public:
    LinkCells() = default;
    // Finds pairs of gap below `skin` [m]. brute_force: one cell.
    LinkCells(const scene::Scene& scene, const Plan& plan, double radius_max, bool brute_force,
              double skin = 0);

    void build(const State& state, simd::BinKernel kernel, int threads);
    // Cell and position in the order of the cells of a grain.
    [[nodiscard]] std::int32_t cell_of(std::size_t grain) const { return cell_[grain]; }
    [[nodiscard]] std::int32_t slot_of(std::size_t grain) const { return slot_[grain]; }
    // Grains in the cells around a cell, at most.
    [[nodiscard]] std::size_t most_around() const { return most_around_; }
    [[nodiscard]] simd::CellView view() const;
    // Rows of all layers.
    [[nodiscard]] std::int32_t rows() const { return count_[1] * count_[2]; }
    [[nodiscard]] std::size_t bytes() const;

private:
    [[nodiscard]] simd::BinView bin_view(const State& state);

    std::array<Column<double>, 3> position_;
    Column<double> radius_;
    Column<std::int32_t> owner_, start_, cell_, slot_;
    std::size_t most_around_ = 0;
    int dimension_ = 2;
    std::array<std::int32_t, 3> count_{1, 1, 1}; // columns, rows, layers
    std::array<double, 3> lower_{}, edge_{1, 1, 1};
    std::array<bool, 3> periodic_{};
    bool sheared_ = false;
};

} // namespace sandlane::md
