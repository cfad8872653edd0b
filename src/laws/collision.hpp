// The collision of two hard spheres or discs in one instant, for event-driven dynamics and direct simulation
// Monte Carlo. Convention: e points from particle j to particle i, g = v_i - v_j - (R_i w_i + R_j w_j) x e is
// the relative velocity of the surfaces, negative along e for particles that approach.
#pragma once

#include "core/vector.hpp"

namespace sandlane::laws {

// How direct simulation Monte Carlo selects the pairs of a cell that collide (specification of DSMC, section
// 5).
enum class CollisionScheme {
    no_time_counter,
    direction_first,
    nanbu_babovsky,
    majorant_frequency,
    bernoulli,
    maxwell
};

// The impulse that i gets, and j with the other sign, divided by m_eff [m/s]:
// P/m_eff = -(1 + eps_n) g_n e - (1 - eps_t) (m_t/m_eff) g_t. mass_ratio = m_t/m_eff, q/(1 + q) for equal
// J = q m R^2.
template <class R>
SANDLANE_INLINE Vector<R> impulse(const Vector<R>& g, const Vector<R>& e, const R& eps_n, const R& eps_t,
                                  const R& mass_ratio) {
    const R normal = dot(g, e);
    const Vector<R> tangential = g - normal * e;
    return (-((R(1.0) + eps_n) * normal)) * e - ((R(1.0) - eps_t) * mass_ratio) * tangential;
}

// Smooth particles: along e alone.
template <class R>
SANDLANE_INLINE Vector<R> smooth_impulse(const R& normal_speed, const Vector<R>& e, const R& eps_n) {
    return (-((R(1.0) + eps_n) * normal_speed)) * e;
}

// Coulomb's law bounds the tangential impulse by mu times the normal one: eps_t = max(eps_t0, 1 - mu (1 +
// eps_n) (m_eff/m_t) g_n/g_t), speeds without sign; eps_t0 where g_t = 0.
template <class R>
SANDLANE_INLINE R sliding_restitution(const R& eps_t, const R& friction, const R& eps_n, const R& mass_ratio,
                                      const R& normal_speed, const R& tangential_speed) {
    const auto moves = tangential_speed > R(0.0);
    const R divisor = select(moves, mass_ratio * tangential_speed, R(1.0));
    const R sliding = R(1.0) - friction * (R(1.0) + eps_n) * normal_speed / divisor;
    return select(moves, max(sliding, eps_t), eps_t);
}

// The direction e of a collision with relative velocity g, speed = |g| > 0, of density proportional to |g.e|
// over the half sphere that approaches. In space from two numbers of [0, 1): the impact parameter over the
// diameter is sqrt(u), `sine` and `cosine` those of the azimuth. In the plane 2u - 1.
template <class R>
SANDLANE_INLINE Vector<R> direction_in_space(const Vector<R>& g, const R& speed, const R& u, const R& sine,
                                             const R& cosine) {
    const R inverse = R(1.0) / speed;
    const Vector<R> h = inverse * g;
    // t1 = a x h, normalised, of the axis a with the smallest component of h, the first of equal ones.
    const R x2 = h.x * h.x, y2 = h.y * h.y, z2 = h.z * h.z, none(0.0);
    const auto not_x = (x2 > y2), z_below_y = (y2 > z2), z_below_x = (x2 > z2);
    const Vector<R> of_x{none, -h.z, h.y}, of_y{h.z, none, -h.x}, of_z{-h.y, h.x, none};
    const Vector<R> below = select(z_below_y, of_z, of_y); // where y is smaller than x
    const Vector<R> t = select(not_x, below, select(z_below_x, of_z, of_x));
    const R normalise = R(1.0) / sqrt(dot(t, t));
    const Vector<R> t1 = normalise * t, t2 = cross(h, t1);
    const R sine_of_angle = sqrt(u), cosine_of_angle = sqrt(R(1.0) - u);
    const Vector<R> across = cosine * t1 + sine * t2;
    const Vector<R> e = cosine_of_angle * h + sine_of_angle * across;
    return {-e.x, -e.y, -e.z};
}
template <class R>
SANDLANE_INLINE Vector<R> direction_in_plane(const Vector<R>& g, const R& speed, const R& u) {
    const R inverse = R(1.0) / speed;
    const R hx = g.x * inverse, hy = g.y * inverse;
    const R sine = R(2.0) * u - R(1.0), cosine = sqrt(R(1.0) - sine * sine);
    return {-(cosine * hx - sine * hy), -(cosine * hy + sine * hx), R(0.0)};
}

// Pair correlation at contact of a fluid of packing fraction phi: Carnahan and Starling in space, Henderson
// in the plane. There is no fluid beyond freezing: a denser cell, which particles without volume may well
// make, counts as one that freezes.
inline constexpr double freezing_fraction[] = {0.69, 0.49}; // plane, space
template <class R> SANDLANE_INLINE R contact_correlation(int dimension, const R& phi) {
    const R fluid = min(phi, R(freezing_fraction[dimension - 2])), free = R(1.0) - fluid;
    if (dimension == 3) return (R(1.0) - R(0.5) * fluid) / (free * free * free);
    return (R(1.0) - R(7.0 / 16) * fluid) / (free * free);
}

// The same for pairs of a mixture, Mansoori et al. in space, Jenkins and Mancini in the plane: g_ij =
// contact_of_pair(d, S_ij h)/(1 - x_d) with h = x_{d-1}/(1 - x_d), S_ij = s_i s_j/(s_i + s_j) and x_k the sum
// of the k-th powers of the diameters in a volume times pi/6, pi/4 in the plane; x_d is the packing fraction.
template <class R> SANDLANE_INLINE R contact_of_pair(int dimension, const R& y) {
    if (dimension == 3) return R(1.0) + y * (R(3.0) + R(2.0) * y);
    return R(1.0) + R(9.0 / 8) * y;
}

} // namespace sandlane::laws
