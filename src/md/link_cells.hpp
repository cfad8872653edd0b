// Link cells (docs/physics.md 9): particles counting-sorted by class of radii and cell at every step. One
// cell per direction is brute force.
#pragma once

#include "core/column.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "simd/tables.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace sandlane::md {

class LinkCells {
public:
    LinkCells() = default;
    // Finds pairs of gap below `skin` [m]. brute_force: one cell.
    LinkCells(const scene::Scene& scene, const Plan& plan, const Needs& needs, bool brute_force,
              double skin = 0);

    void build(const State& state, simd::BinKernel kernel, int threads);
    void release(); // the memory of what was built
    // Cell and position in the order of the cells of a grain.
    [[nodiscard]] std::int32_t cell_of(std::size_t grain) const { return cell_[grain]; }
    [[nodiscard]] std::int32_t slot_of(std::size_t grain) const { return slot_[grain]; }
    // Grains in the cells around a grain, at most.
    [[nodiscard]] std::size_t most_around() const { return most_around_; }
    [[nodiscard]] simd::CellView view() const;
    // Rows of all layers and classes.
    [[nodiscard]] std::int32_t rows() const { return grids_.back().first_row + grids_.back().rows(); }
    [[nodiscard]] std::size_t bytes() const;

private:
    // Of one class of radii.
    struct Grid {
        double largest = 0;                         // m, radius
        std::array<std::int32_t, 3> count{1, 1, 1}; // columns, rows, layers
        std::array<double, 3> edge{1, 1, 1};        // m
        std::int32_t first_row = 0;
        std::size_t first_cell = 0;
        std::int32_t fullest = 0; // grains in a cell, at most

        [[nodiscard]] std::int32_t rows() const { return count[1] * count[2]; }
        [[nodiscard]] std::size_t cells() const {
            return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(rows());
        }
    };
    void fit(Grid& grid, double edge, double most) const;
    [[nodiscard]] simd::BinView bin_view(const State& state);
    [[nodiscard]] std::int32_t cell_by_class(const State& state, std::size_t grain) const;
    [[nodiscard]] std::size_t most_around(std::size_t grains) const;

    std::array<Column<double>, 3> position_;
    Column<double> radius_;
    Column<std::int32_t> owner_, start_, cell_, slot_;
    std::vector<Grid> grids_ = std::vector<Grid>(1); // from the smallest radii up
    std::vector<simd::CellGrid> grid_views_;
    std::size_t most_around_ = 0;
    int dimension_ = 2;
    double skin_ = 0;
    std::array<double, 3> lower_{}, length_{};
    std::array<bool, 3> periodic_{};
    bool sheared_ = false;
};

} // namespace sandlane::md
