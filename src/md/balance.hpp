// What a run keeps in order to know its own error (docs/physics.md 14); nothing of it is touched by scenes
// that watch nothing.
#pragma once

#include "core/vec.hpp"

#include <limits>

namespace sandlane::md {

// Of the forces on the grains of one tile: power [W], sum [N] of those between grains, and of all.
struct TileSums {
    double power = 0;
    Vec between, all;
};

// Sums since the balance began. Doubles only: it goes into checkpoints as it is.
struct Balance {
    double kind = 0;                           // what is summed, see Simulation::balance_kind; 0: nothing yet
    double energy = 0;                         // J, at its begin, less what had been added until then
    Vec momentum;                              // kg m/s, at its begin
    double mass = 0;                           // kg, of all grains
    Vec brought;                               // kg m/s, by gravity and by grains that came or went
    double power = 0, work = 0;                // W, J: of all forces on grains but gravity
    double crossing = 0;                       // J, by crossing the seam of a shear flow
    Vec wall_force, wall_impulse;              // N, kg m/s
    double exchanged = 0;                      // kg m/s: sum of the sizes of both impulses
    double most_energy = 0, most_momentum = 0; // scales: the largest that was seen
    double examined = std::numeric_limits<double>::infinity(); // m: no overlap up to it is looked at again
    double deepest = 0, deepest_time = 0; // largest overlap so far, of the smaller radius, and when [s]
};

} // namespace sandlane::md
