// Normal contact forces (docs/physics.md 3). Formulas only, templates on R = double or a block of lanes.
// overlap xi [m], rate d xi/dt [m/s] > 0 while approaching. `memory` numbers per contact live as long as it
// does; they are zero when it begins, and the same seen from both partners.
#pragma once

#include "core/real.hpp"

namespace sandlane::laws {

// Two coefficients of a law for one pair of materials, and R_eff = R_i R_j/(R_i + R_j) [m]. `least` is the
// force that the sum of elastic and dissipative part is cut at: 0 (2.16), or minus infinity.
template <class R> struct NormalInput {
    R overlap, rate;
    R elastic, dissipative;
    R reduced_radius;
    R cohesion; // Pa
    R least;    // N
};

// force: on the line of centres, repulsive if positive [N]; load: what friction is in proportion to, >= 0.
template <class R> struct NormalForce { R force, load; };

template <class R> SANDLANE_INLINE NormalForce<R> cut(const R& force, const R& least) {
    return {max(force, least), max(force, R(0.0))};
}

// f_n = k xi + gamma d xi/dt (2.8). elastic = k [N/m], dissipative = gamma [kg/s].
struct LinearDashpot {
    static constexpr bool needs_radius = false;
    static constexpr int memory = 0;
    template <class R> static SANDLANE_INLINE NormalForce<R> force(const NormalInput<R>& c, R*) {
        return cut(c.elastic * c.overlap + c.dissipative * c.rate, c.least);
    }
    // Elastic energy k xi^2/2 [J].
    template <class R> static SANDLANE_INLINE R energy(const NormalInput<R>& c, const R*) {
        return R(0.5) * c.elastic * c.overlap * c.overlap;
    }
};

// f_n = K (xi^{3/2} + A sqrt(xi) d xi/dt), K = elastic sqrt(R_eff) (2.10), (2.12)-(2.14).
// elastic = (4/3)/[(1-nu_i^2)/Y_i + (1-nu_j^2)/Y_j] [Pa], dissipative = A [s].
struct Viscoelastic {
    static constexpr bool needs_radius = true;
    static constexpr int memory = 0;
    template <class R> static SANDLANE_INLINE NormalForce<R> force(const NormalInput<R>& c, R*) {
        const R root = sqrt(c.overlap * c.reduced_radius);
        return cut(c.elastic * root * (c.overlap + c.dissipative * c.rate), c.least);
    }
    // Elastic energy (2/5) K xi^{5/2} [J].
    template <class R> static SANDLANE_INLINE R energy(const NormalInput<R>& c, const R*) {
        const R root = sqrt(c.overlap * c.reduced_radius);
        return R(0.4) * c.elastic * root * c.overlap * c.overlap;
    }
};

// Loading along Y_l xi, unloading and reloading along Y_u (xi - xi_0), xi_0 = xi_m (1 - Y_l/Y_u), with the
// largest overlap xi_m of the contact so far (2.15). elastic = Y_l, dissipative = Y_u >= Y_l [N/m]. memory:
// xi_m [m].
struct WaltonBraun {
    static constexpr bool needs_radius = false;
    static constexpr int memory = 1;
    template <class R> static SANDLANE_INLINE NormalForce<R> force(const NormalInput<R>& c, R* largest) {
        largest[0] = max(largest[0], c.overlap);
        const R rest = largest[0] * (R(1.0) - c.elastic / c.dissipative);
        return cut(min(c.elastic * c.overlap, c.dissipative * (c.overlap - rest)), R(0.0));
    }
    // What unloading gives back, f_n^2/(2 Y_u) [J].
    template <class R> static SANDLANE_INLINE R energy(const NormalInput<R>& c, const R* largest) {
        R held[1] = {largest[0]};
        const R f = force(c, held).force;
        return R(0.5) * f * f / c.dissipative;
    }
};

// A viscoelastic contact that is drawn together by a force in proportion to its area 2 pi xi 2 R_eff, the
// simplified law of Johnson, Kendall and Roberts that LIGGGHTS names SJKR2. The pull goes with the contact,
// so that there is no neck beyond it. Friction feels the push alone.
struct CohesiveViscoelastic {
    static constexpr bool needs_radius = true;
    static constexpr int memory = 0;
    template <class R> static SANDLANE_INLINE R area(const NormalInput<R>& c) {
        return R(12.566370614359172) * c.overlap * c.reduced_radius;
    }
    template <class R> static SANDLANE_INLINE NormalForce<R> force(const NormalInput<R>& c, R* none) {
        const NormalForce<R> push = Viscoelastic::force(c, none);
        return {push.force - c.cohesion * area(c), push.load};
    }
    // The pull's potential is the negative of half its product with the overlap.
    template <class R> static SANDLANE_INLINE R energy(const NormalInput<R>& c, const R* none) {
        return Viscoelastic::energy(c, none) - R(0.5) * c.cohesion * area(c) * c.overlap;
    }
};

} // namespace sandlane::laws
