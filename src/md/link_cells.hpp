// Link cells (docs/physics.md 9): particles counting-sorted by cell at every step. One cell per direction is
// brute force.
#pragma once

#include "core/column.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "simd/tables.hpp"

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
    [[nodiscard]] std::int32_t rows() const { return rows_; }
    [[nodiscard]] std::int32_t columns() const { return columns_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    Column<double> x_, y_, radius_;
    Column<std::int32_t> owner_, start_, cell_, slot_;
    std::size_t most_around_ = 0;
    std::int32_t columns_ = 1, rows_ = 1;
    double lower_x_ = 0, lower_y_ = 0, cell_x_ = 1, cell_y_ = 1;
    bool periodic_x_ = false, periodic_y_ = false;
};

} // namespace sandlane::md
