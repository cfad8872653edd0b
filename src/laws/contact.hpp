// Geometry and force of one contact of two grains (docs/physics.md 2), in the plane and in space, the one
// text that pair kernels, walls, references and analyses share.
#pragma once

#include "laws/normal.hpp"
#include "laws/tangential.hpp"

#include <type_traits>

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

// Numbers that a contact of these laws remembers: the tangential law's, then the normal law's. The first
// number of a contact that begins is `no_contact`.
template <class Tangential, int dimension>
inline constexpr int tangential_memory = dimension == 3 ? Tangential::memory_in_space : Tangential::memory;
template <class Normal, class Tangential, int dimension>
inline constexpr int memory_of = tangential_memory<Tangential, dimension> + Normal::memory;
inline constexpr int most_memory = 4;
inline constexpr double no_contact = 1e300;

// A contact that begins remembers zeros, and no time has passed since its last evaluation.
template <int memory, class R> SANDLANE_INLINE R begin_contact(R* held, const R& elapsed) {
    if constexpr (memory == 0) return elapsed;
    const R zero(0.0);
    const auto fresh = held[0] > R(0.5 * no_contact);
    for (int m = 0; m < memory; ++m) held[m] = select(fresh, zero, held[m]);
    return select(fresh, zero, elapsed);
}

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
    const R time = begin_contact<memory_of<Normal, Tangential, 2>>(memory, elapsed);
    const R distance = sqrt(s.dx * s.dx + s.dy * s.dy), inverse = R(1.0) / distance;
    const R overlap = s.radius_sum - distance;
    const R nx = s.dx * inverse, ny = s.dy * inverse;
    const R rate = -(s.dvx * nx + s.dvy * ny);
    const auto touching = overlap > R(0.0);
    const R safe_overlap = select(touching, overlap, R(0.0));
    const R f_n =
        Normal::force(NormalInput<R>{safe_overlap, rate, c.elastic, c.dissipative, s.inverse_reduced_radius},
                      memory + Tangential::memory);
    const R v_t = Tangential::needs_spin ? s.dvx * ny - s.dvy * nx + s.spin : R(0.0);
    const R f_t = Tangential::force(
        TangentialInput<R>{f_n, v_t, c.tangential_damping, c.friction, c.tangential_stiffness, time}, memory);
    const R zero(0.0);
    return {select(touching, -(f_n * nx) - f_t * ny, zero), select(touching, f_t * nx - f_n * ny, zero),
            select(touching, f_t, zero), overlap};
}

// ---- in space

template <class R> struct SpatialState {
    Vector<R> d, dv;
    Vector<R> spin; // R_i omega_i + R_j omega_j
    Vector<R> turn; // omega_i + omega_j; only laws that need the twist look at it
    R radius_sum;   // R_i + R_j
    R inverse_reduced_radius;
};

// Force on i; j gets the opposite force. Torque over the lever arm, n x f_t, is the same for both (1.7).
template <class R> struct SpatialForce {
    Vector<R> force, turning;
    R overlap;
};

template <class Normal, class Tangential, class R>
SANDLANE_INLINE SpatialForce<R> pair_force(const SpatialState<R>& s, const PairCoefficients<R>& c,
                                           R* memory = nullptr, const R& elapsed = R(0.0)) {
    const R time = begin_contact<memory_of<Normal, Tangential, 3>>(memory, elapsed);
    const R zero(0.0), distance = sqrt(dot(s.d, s.d));
    const R overlap = s.radius_sum - distance;
    const Vector<R> n = R(1.0) / distance * s.d;
    const R rate = -dot(s.dv, n);
    const auto touching = overlap > zero;
    const R safe_overlap = select(touching, overlap, zero);
    const R f_n =
        Normal::force(NormalInput<R>{safe_overlap, rate, c.elastic, c.dissipative, s.inverse_reduced_radius},
                      memory + Tangential::memory_in_space);
    const Vector<R> none{zero, zero, zero};
    if constexpr (!Tangential::needs_spin) return {select(touching, -f_n * n, none), none, overlap};
    const Vector<R> u_t = cross(s.spin, n) - s.dv - rate * n;
    const R twist = Tangential::needs_twist ? R(0.5) * dot(s.turn, n) : zero;
    const Vector<R> f_t = Tangential::force(
        SpatialInput<R>{f_n, u_t, n, twist, c.tangential_damping, c.friction, c.tangential_stiffness, time},
        memory);
    return {select(touching, f_t - f_n * n, none), select(touching, cross(n, f_t), none), overlap};
}

// ---- in either

template <int dimension, class R>
using ContactState = std::conditional_t<dimension == 3, SpatialState<R>, PairState<R>>;

// Elastic energy of a contact, J, from its overlap and what it remembers.
template <class Normal, class Tangential, int dimension>
double elastic_energy(const NormalInput<double>& c, double tangential_stiffness, const double* memory) {
    const double normal = Normal::energy(c, memory + tangential_memory<Tangential, dimension>);
    if constexpr (dimension == 3) return normal + Tangential::energy_in_space(tangential_stiffness, memory);
    return normal + Tangential::energy(tangential_stiffness, memory);
}

} // namespace sandlane::laws
