// Normal contact forces (docs/physics.md 3). Formulas only, templates on R = double or a block of lanes.
// overlap xi [m], rate d xi/dt [m/s] > 0 while approaching; every law returns f_n >= 0 [N], cut at zero
// (2.16). `memory` numbers per contact live as long as it does; they are zero when it begins, and the same
// seen from both partners.
#pragma once

#include "core/real.hpp"

namespace sandlane::laws {

// Two coefficients of a law for one pair of materials, and the inverse of R_eff = R_i R_j/(R_i + R_j) [1/m].
template <class R> struct NormalInput {
    R overlap, rate;
    R elastic, dissipative;
    R inverse_reduced_radius;
};

// f_n = k xi + gamma d xi/dt (2.8). elastic = k [N/m], dissipative = gamma [kg/s].
struct LinearDashpot {
    static constexpr bool needs_radius = false;
    static constexpr int memory = 0;
    template <class R> static SANDLANE_INLINE R force(const NormalInput<R>& c, R*) {
        return max(c.elastic * c.overlap + c.dissipative * c.rate, R(0.0));
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
    template <class R> static SANDLANE_INLINE R force(const NormalInput<R>& c, R*) {
        const R root = sqrt(c.overlap / c.inverse_reduced_radius);
        return max(c.elastic * root * (c.overlap + c.dissipative * c.rate), R(0.0));
    }
    // Elastic energy (2/5) K xi^{5/2} [J].
    template <class R> static SANDLANE_INLINE R energy(const NormalInput<R>& c, const R*) {
        const R root = sqrt(c.overlap / c.inverse_reduced_radius);
        return R(0.4) * c.elastic * root * c.overlap * c.overlap;
    }
};

} // namespace sandlane::laws
