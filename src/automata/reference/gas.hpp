// Lattice gases as the specification says them: a state per site, tables of collisions, one site after the
// other.
#pragma once

#include "automata/gas.hpp"

#include <array>
#include <cstdint>

namespace sandlane::automata::reference {

// What walls and gravity gave to the particles in a step, in units of (2 c_x, 2 c_y/sqrt 3).
struct GasBalance {
    std::int64_t gravity_x = 0, wall_x = 0;
};

// Result of a collision: bits of directions and, bit 6, the rest particle.
[[nodiscard]] int collide(GasModel model, int state, bool xi, bool dissipative);
// The state after at most one particle was turned towards +x.
[[nodiscard]] int turn_towards_x(int state, bool has_rest);
// Integer momentum of a state.
[[nodiscard]] std::array<int, 2> momentum(int state);

// Bit x of the word of probability P/2^16.
[[nodiscard]] bool chance(std::uint32_t probability, std::int32_t x, std::int32_t y, std::uint32_t t,
                          std::uint32_t stream, const PhiloxKey& seed);

GasBalance step(GasLattice& lattice, const GasRules& rules, std::uint32_t t);

} // namespace sandlane::automata::reference
