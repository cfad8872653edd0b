// Orientations of spheres in space (docs/physics.md 7): they follow the angular velocities and change no
// force.
#pragma once

#include "md/state.hpp"

namespace sandlane::md {

// From t to t + dt with the mean of the angular velocities at both ends, exactly as a rotation: of second
// order, exact for a constant angular velocity, and always of length one to rounding. before: spin records at
// t.
void turn_grains(State& state, const Column<double>& before, int threads);

} // namespace sandlane::md
