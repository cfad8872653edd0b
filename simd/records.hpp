// Layout of what pair kernels read of a particle and write for it.
#pragma once

namespace sandlane::simd {

// Record of a particle at the predicted time: eight doubles, 64 bytes. Everything a law needs of a pair is a
// difference of fields before `sums` or a sum of fields from there on.
//   2D: 0 x  1 y  2 vx  3 vy  |  4 R omega  5 R  6 1/R  7 unused
//   3D: 0 x  1 y  2 z  3 vx  4 vy  5 vz  |  6 R  7 1/R
inline constexpr int record_fields = 8;
template <int dimension> struct Record {
    static constexpr int velocity = dimension;
    static constexpr int sums = 2 * dimension;
    static constexpr int spin = 4; // 2D only
    static constexpr int radius = dimension == 3 ? 6 : 5;
    static constexpr int inverse_radius = radius + 1;
};
[[nodiscard]] constexpr int radius_field(int dimension) {
    return dimension == 3 ? 6 : 5;
}

// Beside it in 3D, with friction: omega_x, omega_y, omega_z, R.
inline constexpr int spin_fields = 4;

// Force accumulator of a particle. 2D: Fx, Fy, sum of f_t (torque = R sum f_t), unused. 3D: Fx, Fy, Fz,
// unused, and with friction the sum of n x f_t (torque = R times it), unused.
inline constexpr int force_fields = 4;
[[nodiscard]] constexpr int force_stride(int dimension, bool spin) {
    return dimension == 3 && spin ? 8 : 4;
}

} // namespace sandlane::simd
