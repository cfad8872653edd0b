// The errors of a gas that a run watches: what collisions of hard particles must keep.
#pragma once

#include "analysis/watched.hpp"

#include <array>

namespace sandlane::app {

// Sums over all particles.
struct GasTotals {
    double mass = 0;                  // kg
    double energy = 0;                // kinetic, of translation and spin, J
    double given = 0;                 // by walls since the start, J
    std::array<double, 3> velocity{}; // of the centre of mass, m/s
    double overlap = 0;               // largest of surfaces that met, of the smallest radius
};

// Energy residual |E - E_start - given|/(E + |given|) and momentum error M |u - u_start|/sqrt(2 M E), E the
// larger of both energies. Scenes in which something else changes them are refused.
[[nodiscard]] analysis::Watched watch_gas(const GasTotals& start, const GasTotals& now, double time);

} // namespace sandlane::app
