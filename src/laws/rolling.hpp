// Rolling friction: a couple against the rolling of two grains on each other (docs/physics.md 5). Formula
// only.
#pragma once

#include "core/vector.hpp"

namespace sandlane::laws {

// Couple on i; j gets the opposite one. `rolling`: omega_i - omega_j without the part about the normal
// [rad/s], damping gamma_r [N m s], limit mu_r R_eff f_n [N m].
template <class R>
SANDLANE_INLINE Vector<R> rolling_couple(const Vector<R>& rolling, const R& damping, const R& limit) {
    const R speed = sqrt(dot(rolling, rolling));
    // Zero over zero is no number, and min then takes its second operand.
    return -min(limit / speed, damping) * rolling;
}
template <class R> SANDLANE_INLINE R rolling_couple(const R& rolling, const R& damping, const R& limit) {
    return max(min(-(damping * rolling), limit), -limit);
}

} // namespace sandlane::laws
