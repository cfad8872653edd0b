// Equilibrium of lattice gases with semi-detailed balance: Fermi-Dirac (spec 3.1.6).
#pragma once

#include <array>

namespace sandlane::automata {

// Mean occupation of each bit, 1/(1 + exp(alpha + beta c_i)), with `density` particles and momentum (j_x,
// j_y) per site in units of c. bits: 4 (square lattice), 6, or 7 with the rest particle. Found by Newton's
// method; for momenta that no occupation can carry the result holds NaN.
[[nodiscard]] std::array<double, 7> fermi_dirac(double density, double j_x, double j_y, int bits);

} // namespace sandlane::automata
