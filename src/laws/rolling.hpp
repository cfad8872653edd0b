// Rolling friction: a couple against the rolling of two grains on each other (docs/physics.md 5). Formula
// only.
#pragma once

#include "laws/tangential.hpp"

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

// What a couple with a spring takes besides: k_r [N m], the unit normal and the mean spin about it [rad/s]
// (space), time since the last evaluation [s].
template <class R> struct RollingSpring {
    R stiffness, elapsed;
    Vector<R> normal{};
    R twist{};
};

// A spring in the angle theta of rolling [rad] holds grains that do not roll yet (Ai, Chen, Rotter and Ooi,
// Powder Technol. 206 (2011) 269, model C): the couple is -k_r theta - gamma_r omega, at most mu_r R_eff f_n,
// where the grains roll and theta is pulled along. That is the tangential spring once more, of angles; the
// damper counts towards the limit, as it does there. Without stiffness the damper is left.
template <class R>
SANDLANE_INLINE R rolling_couple(const R& rolling, const R& damping, const R& limit,
                                 const RollingSpring<R>& spring, R* theta) {
    const R couple = CundallStrack::force(
        TangentialInput<R>{limit, rolling, damping, R(1.0), spring.stiffness, spring.elapsed}, theta);
    theta[0] = select(spring.stiffness > R(0.0), theta[0], R(0.0));
    return couple;
}
template <class R>
SANDLANE_INLINE Vector<R> rolling_couple(const Vector<R>& rolling, const R& damping, const R& limit,
                                         const RollingSpring<R>& spring, R* theta) {
    const Vector<R> couple =
        CundallStrack::force(SpatialInput<R>{limit, rolling, spring.normal, spring.twist, damping, R(1.0),
                                             spring.stiffness, spring.elapsed},
                             theta);
    for (int m = 0; m < 3; ++m) theta[m] = select(spring.stiffness > R(0.0), theta[m], R(0.0));
    return couple;
}

} // namespace sandlane::laws
