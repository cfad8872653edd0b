// Stress of grains and of regions (md-spheres 8.1; Christoffersen, Mehrabadi, Nemat-Nasser 1981), compression
// positive, N/m in 2D and Pa in 3D.
#pragma once

#include "analysis/analysis.hpp"
#include "analysis/region.hpp"

namespace sandlane::analysis {

struct Tensor {
    double xx = 0, xy = 0, xz = 0, yx = 0, yy = 0, yz = 0, zx = 0, zy = 0, zz = 0;
    int dimension = 2;

    [[nodiscard]] double pressure() const { return (xx + yy + zz) / dimension; }
    // What is not symmetric: (yz - zy, zx - xz, xy - yx), -torque/V.
    [[nodiscard]] Vec rotation() const { return {yz - zy, zx - xz, xy - yx}; }
};

// sigma_ab = -(1/V) sum over the contacts of a grain of l_a f_b, l = R n from its centre, f the force on it,
// V = pi R^2, or 4/3 pi R^3. Walls included.
[[nodiscard]] std::vector<Tensor> grain_stress(const Frame& frame);

// sigma_ab = (1/V) sum of l_a f_b over the contacts whose point lies in the region of area or volume V, l
// from centre to centre (or to the wall), f the force on the partner.
[[nodiscard]] Tensor contact_stress(const Frame& frame, const Region& region);

// Transport of momentum by the motion relative to the mean flow of the grains in the region:
// sum m u_a u_b/V.
[[nodiscard]] Tensor kinetic_stress(const Snapshot& snapshot, const Region& region);

// Mean number of contacts, walls included, of the grains whose centres lie in the region; 0 without grains.
[[nodiscard]] double contact_number(const Frame& frame, const Region& region);

} // namespace sandlane::analysis
