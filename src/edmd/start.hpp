// Where particles are and how they move at the start of a scene.
#pragma once

#include "edmd/setup.hpp"
#include "simd/tables.hpp"

#include <vector>

namespace sandlane::edmd {

// How many particles of each class, one after the other by id.
using Amounts = std::vector<std::uint32_t>;

struct Start {
    // automatic: random where there is room for that, else a lattice (triangular in the plane, face-centred
    // cubic in space); within curved walls there is no lattice.
    enum class Kind { automatic, random, lattice, growth } kind = Kind::automatic;
    double growth_rate = 0.05; // see grow()
    int threads = 1;
    simd::Isa isa = simd::Isa::scalar; // that particles grow by: the same places by all
};
// Places without overlap. Throws Error(invalid_input) where they do not fit.
void place(const Setup& setup, std::vector<Particle>& particles, const Start& start = {});
// One after the other, largest first, at the first place that is free. False: there is no room for one of
// them.
bool place_at_random(const Setup& setup, std::vector<Particle>& particles);

// A Maxwellian of temperature T [J] for each class, without mean momentum, T exactly; spins of temperature
// T_spin. Stream 5 of the specification of Monte Carlo.
void heat(const Setup& setup, std::vector<Particle>& particles, double temperature, double spin_temperature);

[[nodiscard]] std::vector<Particle> make_particles(const Setup& setup, const Amounts& amounts,
                                                   double temperature, double spin_temperature = 0,
                                                   const Start& start = {});

// Part of the volume that particles fill.
[[nodiscard]] double packing_fraction(const Setup& setup, const Amounts& amounts);

} // namespace sandlane::edmd
