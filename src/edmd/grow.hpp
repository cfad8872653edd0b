// Dense starts: particles placed at random while they are small, which then grow as they collide (Lubachevsky
// and Stillinger).
#pragma once

#include "edmd/start.hpp"

#include <vector>

namespace sandlane::edmd {

// Places without overlap, at random, at packing fractions that nothing but growth reaches. growth_rate: of
// the radius of the first class in units of the thermal speed; a fast one leaves the particles no time to
// crystallise. The same places for every instruction set and number of threads. Throws Error(invalid_input)
// where they jam before they have their size.
void grow(const Setup& setup, std::vector<Particle>& particles, const Start& start);

} // namespace sandlane::edmd
