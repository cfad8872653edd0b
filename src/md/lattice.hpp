// Site arrays of the vectorised lattice algorithm (docs/physics.md 10): geometry, occupation, halo
// images.
#pragma once

#include "core/column.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "simd/tables.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::md {

class Lattice {
public:
    Lattice() = default;
    Lattice(const scene::Scene& scene, const Plan& plan, double radius_max);

    // Forgets all particles (after sorting, insertion, deletion).
    void clear(const State& state);
    // First half of binning, tile by tile: new sites from the records; sites that are left become empty.
    void leave(const State& state, simd::BinKernel kernel, std::size_t begin, std::size_t end);
    // Second half, after every tile has left: occupies the new sites and their images.
    void enter(const State& state, std::size_t begin, std::size_t end);

    [[nodiscard]] simd::LatticeView view() const;
    [[nodiscard]] std::int32_t row_tiles() const { return (rows_ + tile_rows_ - 1) / tile_rows_; }
    [[nodiscard]] std::int32_t tile_rows() const { return tile_rows_; }
    [[nodiscard]] std::int32_t rows() const { return rows_; }
    [[nodiscard]] std::size_t bytes() const;
    // Two particles whose predicted centres share a site, by storage index; first < 0 if there are none.
    struct Clash {
        std::int64_t first = -1, second = -1;
    };
    [[nodiscard]] Clash find_clash(const State& state) const;

private:
    template <class Body> void for_images(std::int32_t site, const Body& body) const;

    Column<float> x_, y_, radius_; // per site, see simd::LatticeView
    Column<std::int32_t> owner_;
    Column<std::int32_t> site_, next_site_; // per particle; -1: none
    Column<float> relative_x_, relative_y_; // per particle, from the centre of its site
    Column<std::uint8_t> edge_;             // per particle: its site has an image in the halo
    std::vector<std::int32_t> offsets_;
    std::vector<float> offset_x_, offset_y_;
    std::ptrdiff_t row_stride_ = 0, origin_ = 0;
    std::int32_t columns_ = 0, rows_ = 0, reach_ = 2, tile_rows_ = 16;
    double lower_x_ = 0, lower_y_ = 0, site_x_ = 1, site_y_ = 1;
    double period_x_ = 0, period_y_ = 0; // 0: open
    float uniform_square_ = 0;
    bool many_radii_ = true;
};

} // namespace sandlane::md
