// Geometry and force of one contact of two discs (docs/physics.md 2), the one text that pair kernels, walls,
// references and analyses share.
#pragma once

#include "laws/normal.hpp"
#include "laws/tangential.hpp"

namespace sandlane::laws {

// Coefficients of one pair of materials: what the normal law and the tangential law read (laws.def).
template <class R> struct PairCoefficients {
    R elastic, dissipative;         // normal law
    R tangential_damping, friction; // gamma_t [kg/s], mu
    R tangential_stiffness;         // k_t [N/m]
};
inline constexpr int pair_coefficients = 5; // doubles of one entry of a material pair table
template <class R> SANDLANE_INLINE PairCoefficients<R> coefficients_from(const double* entry) {
    return {R(entry[0]), R(entry[1]), R(entry[2]), R(entry[3]), R(entry[4])};
}

// Numbers that a contact of these laws remembers, at most.
inline constexpr int most_memory = 4;
template <class Tangential> inline constexpr int memory_of = Tangential::memory;

// Relative state of j seen from i: d = r_j - r_i (minimum image), dv = v_j - v_i, sums over both grains.
template <class R> struct PairState {
    R dx, dy, dvx, dvy;
    R spin;                   // R_i omega_i + R_j omega_j
    R radius_sum;             // R_i + R_j
    R inverse_reduced_radius; // 1/R_i + 1/R_j
};

// Force on i; j gets the opposite force and the same tangential force (equal torque signs, 1.7).
template <class R> struct PairForce {
    R x, y, tangential;
    R overlap; // xi, negative without contact
};

// overlap <= 0 means no contact and gives exact zeros. Coincident centres must have been excluded. `memory`
// of the contact is brought up to the present, `elapsed` [s] after the last time; laws without memory do
// without both.
template <class Normal, class Tangential, class R>
SANDLANE_INLINE PairForce<R> pair_force(const PairState<R>& s, const PairCoefficients<R>& c,
                                        R* memory = nullptr, const R& elapsed = R(0.0)) {
    const R distance = sqrt(s.dx * s.dx + s.dy * s.dy);
    const R overlap = s.radius_sum - distance;
    const R nx = s.dx / distance, ny = s.dy / distance;
    const R rate = -(s.dvx * nx + s.dvy * ny);
    const auto touching = overlap > R(0.0);
    const R safe_overlap = select(touching, overlap, R(0.0));
    const R f_n =
        Normal::force(NormalInput<R>{safe_overlap, rate, c.elastic, c.dissipative, s.inverse_reduced_radius});
    const R v_t = Tangential::needs_spin ? s.dvx * ny - s.dvy * nx + s.spin : R(0.0);
    const R f_t = Tangential::force(
        TangentialInput<R>{f_n, v_t, c.tangential_damping, c.friction, c.tangential_stiffness, elapsed},
        memory);
    const R zero(0.0);
    return {select(touching, -(f_n * nx) - f_t * ny, zero), select(touching, f_t * nx - f_n * ny, zero),
            select(touching, f_t, zero), overlap};
}

} // namespace sandlane::laws
