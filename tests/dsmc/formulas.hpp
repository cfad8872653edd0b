// Kinetic theory of granular gases: the formulas of the specification, for tests (m = s = 1, n s^{d-1} g2 =
// density).
#pragma once

#include <cmath>
#include <numbers>

namespace sandlane::test {

// Collisions per particle and time of a Maxwellian.
inline double collision_rate(int d, double density, double temperature) {
    return (d == 3 ? 4.0 : 2.0) * density * std::sqrt(std::numbers::pi * temperature);
}
// Second Sonine coefficient of free cooling, Montanero and Santos.
inline double a2_of_cooling(int d, double e) {
    return 16 * (1 - e) * (1 - 2 * e * e) / (25 + 24 * d - 57 * e + 8 * d * e - 2 * e * e * (1 - e));
}
// 1/tau of T = T_0 (1 + t/tau)^-2.
inline double haff_rate(int d, double density, double e) {
    return collision_rate(d, density, 1) * (1 - e * e) / (2 * d) * (1 + 3 * a2_of_cooling(d, e) / 16);
}

} // namespace sandlane::test
