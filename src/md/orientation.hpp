// Orientations of spheres in space (docs/physics.md 7): they follow the angular velocities and change no
// force.
#pragma once

#include "md/state.hpp"

namespace sandlane::md {

// After a prediction: from t to t + dt by the integral of the angular velocity, which the integrator's
// polynomial knows, as one rotation. Of second order, exact for a constant angular velocity, and always of
// length one to rounding.
void turn_grains(State& state, int threads);

} // namespace sandlane::md
