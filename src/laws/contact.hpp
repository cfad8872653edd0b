// Geometry and force of one contact of two grains (docs/physics.md 2), in the plane and in space, the one
// text that pair kernels, walls, references and analyses share.
#pragma once

#include "laws/count.hpp"
#include "laws/normal.hpp"
#include "laws/resolved.hpp"
#include "laws/rolling.hpp"
#include "laws/tangential.hpp"

#include <type_traits>

namespace sandlane::laws {

// Coefficients of one pair of materials, and two of the scene; a law reads only its own (laws.def).
template <class R> struct PairCoefficients {
    R elastic, dissipative;         // normal law
    R tangential_damping, friction; // gamma_t [kg/s], mu
    R tangential_stiffness{};       // k_t [N/m]
    R cohesion{};                   // Pa
    R rolling_friction{};           // mu_r
    R rolling_damping{};            // gamma_r [N m s]
    R rolling_stiffness{};          // k_r [N m]
    R least{};                      // N, see NormalInput
    R lever{};                      // 0: lever arms R_i; 1: distances to the plane of the contact (1.8)
};
inline constexpr int pair_coefficients = 11; // doubles of one entry of a material pair table
inline constexpr int scene_coefficients = 2; // the last of them, equal for all pairs
template <class R> SANDLANE_INLINE PairCoefficients<R> coefficients_from(const double* e) {
    return {R(e[0]), R(e[1]), R(e[2]), R(e[3]), R(e[4]), R(e[5]),
            R(e[6]), R(e[7]), R(e[8]), R(e[9]), R(e[10])};
}

// Numbers that a contact of these laws remembers: the rolling spring's, then the tangential law's, then the
// normal law's. The first number of a contact that begins is `no_contact`.
template <Couples couples, int dimension>
inline constexpr int rolling_memory = couples != Couples::sprung ? 0
                                      : dimension == 3           ? 3
                                                                 : 1;
template <class Tangential, int dimension>
inline constexpr int tangential_memory = dimension == 3 ? Tangential::memory_in_space : Tangential::memory;
template <class Normal, class Tangential, Couples couples, int dimension>
inline constexpr int memory_of =
    rolling_memory<couples, dimension> + tangential_memory<Tangential, dimension> + Normal::memory;
inline constexpr int most_memory = 7;
inline constexpr double no_contact = 1e300;

template <class Tangential, int dimension>
inline constexpr bool exists_in = dimension == 2 || Tangential::in_space;
// Couples act on spins; a grain that rolling friction is to hold must not creep either.
template <class Tangential, Couples couples>
inline constexpr bool exists_with = couples == Couples::none ||
                                    (Tangential::needs_spin &&
                                     (couples == Couples::damped || Tangential::memory > 0));

// A contact that begins remembers zeros, and no time has passed since its last evaluation, but `begun` if its
// begin is resolved.
template <int memory, class R> SANDLANE_INLINE R begin_contact(R* held, const R& elapsed, const R& begun) {
    if constexpr (memory == 0) return elapsed;
    const R zero(0.0);
    const auto fresh = held[0] > R(0.5 * no_contact);
    for (int m = 0; m < memory; ++m) held[m] = select(fresh, zero, held[m]);
    return select(fresh, begun, elapsed);
}

// Lever arms l_i, l_j of a contact at distance d (1.8). Each partner gets the same bits whichever comes
// first: both sides of a contact must remember the same.
template <class R> struct Levers { R first, second; };
template <class R>
SANDLANE_INLINE Levers<R> levers(const R& distance, const R& radius, const R& other,
                                 const R& square_difference, const R& plane) {
    const R half(0.5), shift = square_difference / distance;
    const R first = half * (distance + shift), second = half * (distance - shift);
    return {radius + plane * (first - radius), other + plane * (second - other)};
}

// Relative state of j seen from i: d = r_j - r_i (minimum image), dv = v_j - v_i, sums over both grains. The
// members behind the reduced radius are read where couples are asked for, and `spin` is not.
template <class R> struct PairState {
    R dx, dy, dvx, dvy;
    R spin;                // R_i omega_i + R_j omega_j
    R radius_sum;          // R_i + R_j
    R inverse_radii;       // 1/R_i + 1/R_j
    R turn{}, differ{};    // omega_i + omega_j, omega_i - omega_j
    R radius{}, other{};   // R_i, R_j
    R square_difference{}; // R_i^2 - R_j^2; of a flat wall, whose R_j counts as 0: d^2
};

// Force on i; j gets the opposite force and the same tangential force (equal torque signs, 1.7). The torque
// on i is R_i tangential + couple, that on j R_j tangential - couple.
template <class R> struct PairForce {
    R x, y, tangential;
    R overlap; // xi, negative without contact
    R couple{};
};

// A NormalForce, or a StepForce of a law that resolves.
template <class Normal, class R>
SANDLANE_INLINE auto normal_force(const R& overlap, const R& rate, const PairCoefficients<R>& c,
                                  const R& reduced_radius, R* memory, const R& step = R(0.0)) {
    const NormalInput<R> input{overlap, rate, c.elastic, c.dissipative, reduced_radius, c.cohesion, c.least};
    if constexpr (resolves<Normal>)
        return Normal::force(input, step);
    else
        return Normal::force(input, memory);
}

// Time since the touch of a contact that has just begun, where the law resolves it.
template <class Normal, class R>
SANDLANE_INLINE R time_begun(const R& overlap, const R& rate, const R& step) {
    if constexpr (resolves<Normal>) return since_touch(overlap, rate, step);
    return R(0.0);
}

// d, 1/d, and R_eff if the laws want it, from d^2: one division for both, which does not wait for the root.
template <bool reduced, class R> struct Distance {
    R d, inverse, reduced_radius;
    SANDLANE_INLINE Distance(const R& square, const R& inverse_radii) : d(sqrt(square)) {
        if constexpr (reduced) {
            const R both = R(1.0) / (square * inverse_radii);
            inverse = d * (both * inverse_radii);
            reduced_radius = both * square;
        } else {
            inverse = d * (R(1.0) / square);
            reduced_radius = R(1.0);
        }
    }
};

// overlap <= 0 means no contact and gives exact zeros. Coincident centres must have been excluded. `memory`
// of the contact is brought up to the present, `elapsed` [s] after the last time; laws without memory do
// without both. `step` [s]: the time step, of laws that resolve begin and end of a contact.
template <class Normal, class Tangential, Couples couples = Couples::none, class R>
SANDLANE_INLINE PairForce<R> pair_force(const PairState<R>& s, const PairCoefficients<R>& c,
                                        R* memory = nullptr, const R& elapsed = R(0.0),
                                        const R& step = R(0.0)) {
    constexpr bool has_couples = couples != Couples::none;
    static_assert(!(resolves<Normal> && has_couples));
    R* const tangential = memory + rolling_memory<couples, 2>;
    const R zero(0.0);
    const Distance<Normal::needs_radius || has_couples, R> distance(s.dx * s.dx + s.dy * s.dy,
                                                                    s.inverse_radii);
    const R overlap = s.radius_sum - distance.d;
    const R nx = s.dx * distance.inverse, ny = s.dy * distance.inverse;
    const R rate = -(s.dvx * nx + s.dvy * ny);
    const R time = begin_contact<memory_of<Normal, Tangential, couples, 2>>(
        memory, elapsed, time_begun<Normal>(overlap, rate, step));
    const auto touching = overlap > zero;
    const auto f_n = normal_force<Normal>(select(touching, overlap, zero), rate, c, distance.reduced_radius,
                                          tangential + Tangential::memory, step);
    R spin = s.spin, share(1.0);
    Levers<R> arm{s.radius, zero};
    if constexpr (has_couples) {
        arm = levers(distance.d, s.radius, s.other, s.square_difference, c.lever);
        spin = R(0.5) * ((arm.first + arm.second) * s.turn + (arm.first - arm.second) * s.differ);
        share = (arm.first + arm.second) / s.radius_sum;
    }
    const R v_t = Tangential::needs_spin ? s.dvx * ny - s.dvy * nx + spin : zero;
    R f_t = Tangential::force(
        TangentialInput<R>{f_n.load, v_t, c.tangential_damping, c.friction, c.tangential_stiffness, time},
        tangential);
    if constexpr (resolves<Normal> && Tangential::needs_spin)
        f_t = friction_of_step(f_n, f_t, Tangential::damped ? c.tangential_damping * v_t : zero, c.friction);
    PairForce<R> f{select(touching, -(f_n.force * nx) - f_t * ny, zero),
                   select(touching, f_t * nx - f_n.force * ny, zero), select(touching, f_t, zero), overlap};
    if constexpr (has_couples) {
        const R limit = c.rolling_friction * distance.reduced_radius * f_n.load;
        R rolling;
        if constexpr (couples == Couples::sprung)
            rolling = rolling_couple(s.differ, c.rolling_damping, limit,
                                     RollingSpring<R>{c.rolling_stiffness, time}, memory);
        else
            rolling = rolling_couple(s.differ, c.rolling_damping, limit);
        const R couple = (arm.first - s.radius * share) * f_t + rolling;
        f.tangential = share * f.tangential;
        f.couple = select(touching, couple, zero);
    }
    return f;
}

// ---- in space

template <class R> struct SpatialState {
    Vector<R> d, dv;
    Vector<R> spin; // R_i omega_i + R_j omega_j
    Vector<R> turn; // omega_i + omega_j; only laws that need the twist look at it
    R radius_sum;   // R_i + R_j
    R inverse_radii;
    Vector<R> differ{};                       // omega_i - omega_j
    R radius{}, other{}, square_difference{}; // as in the plane
};

// Force on i; j gets the opposite force. Torque over the lever arm, n x f_t, is the same for both (1.7).
template <class R> struct SpatialForce {
    Vector<R> force, turning;
    R overlap;
    Vector<R> couple{};
};

template <class Normal, class Tangential, Couples couples = Couples::none, class R>
SANDLANE_INLINE SpatialForce<R> pair_force(const SpatialState<R>& s, const PairCoefficients<R>& c,
                                           R* memory = nullptr, const R& elapsed = R(0.0),
                                           const R& step = R(0.0)) {
    constexpr bool has_couples = couples != Couples::none;
    static_assert(!(resolves<Normal> && has_couples));
    R* const tangential = memory + rolling_memory<couples, 3>;
    const R zero(0.0);
    const Distance<Normal::needs_radius || has_couples, R> distance(dot(s.d, s.d), s.inverse_radii);
    const R overlap = s.radius_sum - distance.d;
    const Vector<R> n = distance.inverse * s.d, none{zero, zero, zero};
    const R rate = -dot(s.dv, n);
    const R time = begin_contact<memory_of<Normal, Tangential, couples, 3>>(
        memory, elapsed, time_begun<Normal>(overlap, rate, step));
    const auto touching = overlap > zero;
    const auto f_n = normal_force<Normal>(select(touching, overlap, zero), rate, c, distance.reduced_radius,
                                          tangential + Tangential::memory_in_space, step);
    if constexpr (!Tangential::needs_spin) return {select(touching, -f_n.force * n, none), none, overlap};
    Vector<R> spin = s.spin;
    R share(1.0);
    Levers<R> arm{s.radius, zero};
    if constexpr (has_couples) {
        arm = levers(distance.d, s.radius, s.other, s.square_difference, c.lever);
        spin = R(0.5) * ((arm.first + arm.second) * s.turn + (arm.first - arm.second) * s.differ);
        share = (arm.first + arm.second) / s.radius_sum;
    }
    const Vector<R> u_t = cross(spin, n) - s.dv - rate * n;
    const R twist = Tangential::needs_twist ? R(0.5) * dot(s.turn, n) : zero;
    Vector<R> f_t = Tangential::force(SpatialInput<R>{f_n.load, u_t, n, twist, c.tangential_damping,
                                                      c.friction, c.tangential_stiffness, time},
                                      tangential);
    if constexpr (resolves<Normal>) f_t = friction_of_step(f_n, f_t, c.tangential_damping * u_t, c.friction);
    const Vector<R> turning = cross(n, f_t);
    SpatialForce<R> f{select(touching, f_t - f_n.force * n, none), select(touching, turning, none), overlap};
    if constexpr (has_couples) {
        const R limit = c.rolling_friction * distance.reduced_radius * f_n.load;
        const Vector<R> differ = s.differ - dot(s.differ, n) * n;
        Vector<R> rolling;
        if constexpr (couples == Couples::sprung)
            rolling = rolling_couple(differ, c.rolling_damping, limit,
                                     RollingSpring<R>{c.rolling_stiffness, time, n, R(0.5) * dot(s.turn, n)},
                                     memory);
        else
            rolling = rolling_couple(differ, c.rolling_damping, limit);
        const Vector<R> couple = (arm.first - s.radius * share) * turning + rolling;
        f.turning = share * f.turning;
        f.couple = select(touching, couple, none);
    }
    return f;
}

// ---- in either

template <int dimension, class R>
using ContactState = std::conditional_t<dimension == 3, SpatialState<R>, PairState<R>>;

// Elastic energy of a contact, J, from its overlap and what it remembers.
template <class Normal, class Tangential, Couples couples, int dimension>
double elastic_energy(double overlap, double inverse_radii, const PairCoefficients<double>& c,
                      const double* memory) {
    const NormalInput<double> input{overlap,           0,          c.elastic, c.dissipative,
                                    1 / inverse_radii, c.cohesion, c.least};
    const double* tangential = memory + rolling_memory<couples, dimension>;
    double energy = Normal::energy(input, tangential + tangential_memory<Tangential, dimension>);
    for (int m = 0; m < rolling_memory<couples, dimension>; ++m)
        energy += 0.5 * c.rolling_stiffness * memory[m] * memory[m];
    if constexpr (dimension == 3)
        return energy + Tangential::energy_in_space(c.tangential_stiffness, c.friction, tangential);
    return energy + Tangential::energy(c.tangential_stiffness, c.friction, tangential);
}

} // namespace sandlane::laws
