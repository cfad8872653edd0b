// Where particles are and how they move at the start of a scene.
#pragma once

#include "edmd/setup.hpp"

#include <vector>

namespace sandlane::edmd {

// How many particles of each class, one after the other by id.
using Amounts = std::vector<std::uint32_t>;

// Places without overlap: random where there is room for that, else on a lattice (triangular in the plane,
// face-centred cubic in space). Throws Error(invalid_input) where not even that fits.
void place(const Setup& setup, std::vector<Particle>& particles);

// A Maxwellian of temperature T [J] for each class, without mean momentum, T exactly; spins of temperature
// T_spin. Stream 5 of the specification of Monte Carlo.
void heat(const Setup& setup, std::vector<Particle>& particles, double temperature, double spin_temperature);

[[nodiscard]] std::vector<Particle> make_particles(const Setup& setup, const Amounts& amounts,
                                                   double temperature, double spin_temperature = 0);

// Part of the volume that particles fill.
[[nodiscard]] double packing_fraction(const Setup& setup, const Amounts& amounts);

} // namespace sandlane::edmd
