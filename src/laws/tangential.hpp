// Tangential contact forces without memory (md-spheres section 3). Formulas only, templates on R.
// f_n >= 0 normal force [N], v_t relative surface velocity along t (1.6) [m/s]; returns f_t on grain i along
// t [N].
#pragma once

#include "core/real.hpp"

namespace sandlane::laws {

struct Frictionless {
    static constexpr bool needs_spin = false;
    template <class R> static SANDLANE_INLINE R force(const R&, const R&, const R&, const R&) {
        return R(0.0);
    }
};

// f_t = -sign(v_t) min(gamma_t |v_t|, mu f_n) (2.18), written as a clamp so that v_t = 0 gives zero.
struct HaffWerner {
    static constexpr bool needs_spin = true;
    template <class R>
    static SANDLANE_INLINE R force(const R& normal_force, const R& tangential_rate, const R& damping,
                                   const R& friction) {
        const R limit = friction * normal_force;
        return max(min(-(damping * tangential_rate), limit), -limit);
    }
};

} // namespace sandlane::laws
