// Tangential contact forces (docs/physics.md 4). Formulas only, templates on R.
#pragma once

#include "core/real.hpp"

namespace sandlane::laws {

// f_n >= 0 normal force [N], rate v_t of the surfaces along t [m/s], coefficients of the pair of
// materials, time since the last evaluation [s].
template <class R> struct TangentialInput {
    R normal_force, rate;
    R damping, friction, stiffness; // gamma_t [kg/s], mu, k_t [N/m]
    R elapsed;
};

// What the memory of a contact holds before its first evaluation, where a law must know that it is the first.
inline constexpr double no_contact = 1e300;

// A law returns f_t on grain i along t [N]. `memory` numbers per contact live as long as the contact does;
// they are the same for both partners. Laws without memory do not look at it.
struct Frictionless {
    static constexpr bool needs_spin = false;
    static constexpr int memory = 0;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>&, R*) { return R(0.0); }
    template <class R> static SANDLANE_INLINE R energy(const R&, const R*) { return R(0.0); }
};

// f_t = -sign(v_t) min(gamma_t |v_t|, mu f_n) (2.18), written as a clamp so that v_t = 0 gives zero.
struct HaffWerner {
    static constexpr bool needs_spin = true;
    static constexpr int memory = 0;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>& c, R*) {
        const R limit = c.friction * c.normal_force;
        return max(min(-(c.damping * c.rate), limit), -limit);
    }
    template <class R> static SANDLANE_INLINE R energy(const R&, const R*) { return R(0.0); }
};

// A spring zeta in the tangential direction, held by Coulomb friction (2.20)-(2.21):
// f_t = -k_t zeta - gamma_t v_t, at most mu f_n; while the contact slides zeta is what gives just that force,
// so that it lets go at once when the motion reverses. memory: zeta [m].
struct CundallStrack {
    static constexpr bool needs_spin = true;
    static constexpr int memory = 1;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>& c, R* zeta) {
        const R zero(0.0);
        const auto first = zeta[0] > R(0.5 * no_contact);
        const R spring = select(first, zero, zeta[0] + c.elapsed * c.rate);
        const R damped = c.damping * c.rate;
        const R trial = -(c.stiffness * spring) - damped;
        const R limit = c.friction * c.normal_force;
        const R force = max(min(trial, limit), -limit);
        const R pulled = -(force + damped) / c.stiffness;
        const R held = select(trial > limit, pulled, select(-limit > trial, pulled, spring));
        zeta[0] = select(c.normal_force > zero, held, zero);
        return force;
    }
    // Elastic energy k_t zeta^2/2 [J].
    template <class R> static SANDLANE_INLINE R energy(const R& stiffness, const R* zeta) {
        return R(0.5) * stiffness * zeta[0] * zeta[0];
    }
};

} // namespace sandlane::laws
