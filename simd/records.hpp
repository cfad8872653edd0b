// Layout of the state that pair kernels and the integrator share, and of the forces between them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

// Record of a particle: eight doubles, 64 bytes, at the time that forces are wanted for. Everything a law
// needs of a pair is a difference of fields before `sums` or a sum of fields from there on. Velocities are
// displacements per step, the second value of the integrator (docs/physics.md 7).
//   2D: 0 x  1 y  2 vx dt  3 vy dt  |  4 R omega dt  5 R  6 1/R  7 R phi
//   3D: 0 x  1 y  2 z  3 vx dt  4 vy dt  5 vz dt  |  6 R  7 1/R
inline constexpr int record_fields = 8;
template <int dimension> struct Record {
    static constexpr int velocity = dimension;
    static constexpr int sums = 2 * dimension;
    static constexpr int spin = 4, angle = 7; // 2D only
    static constexpr int radius = dimension == 3 ? 6 : 5;
    static constexpr int inverse_radius = radius + 1;
};
[[nodiscard]] constexpr int radius_field(int dimension) {
    return dimension == 3 ? Record<3>::radius : Record<2>::radius;
}

// Beside it in 3D, with rotation: omega_x dt, omega_y dt, omega_z dt, R.
inline constexpr int spin_fields = 4;

// omega dt of a particle, component c; in the plane there is one.
template <int dimension>
[[nodiscard]] inline double turn_of(const double* record, const double* spins, std::int32_t particle, int c) {
    if constexpr (dimension == 3) return spins[std::ptrdiff_t{particle} * spin_fields + c];
    return record[Record<2>::spin] * record[Record<2>::inverse_radius];
}

// How grains turn: not at all, by friction at their surface, or by couples besides (rolling friction, lever
// arms other than the radius).
enum class Rotation { none, friction, couples };
inline constexpr int rotations = 3;

// Force accumulator of a particle. 2D: Fx, Fy, sum of f_t, sum of couples; torque = R sum f_t + couples. 3D:
// Fx, Fy, Fz, unused; with rotation the sum of n x f_t, unused; with couples their sum, unused.
[[nodiscard]] constexpr int force_stride(int dimension, Rotation rotation) {
    return dimension == 3 ? 4 + 4 * static_cast<int>(rotation) : 4;
}
// Whether a field is opposite for the partner of a contact; else it is the same (docs/physics.md 2).
[[nodiscard]] constexpr bool is_mirrored(int dimension, int field) {
    return dimension == 3 ? field / 4 != 1 : field != 2;
}

// Degrees of freedom that the integrator carries: translation, and an arc R phi in 2D or a vector in 3D.
[[nodiscard]] constexpr int degrees_of_freedom(int dimension, bool spin) {
    return dimension + (spin ? 2 * dimension - 3 : 0);
}

// Doubles per contact of the memory of laws with so many numbers.
[[nodiscard]] constexpr int memory_row(int numbers) {
    return numbers <= 2 ? numbers : (numbers + 3) / 4 * 4;
}

} // namespace sandlane::simd
