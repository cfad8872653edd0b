// Gear predictor-corrector in Nordsieck form (docs/physics.md 7): X_k = dt^k/k! d^k y/dt^k, k = 0 .. order-1.
// Coefficients c_k for velocity-dependent forces, which dissipative contacts are. Velocity Verlet in the form
// of docs/physics.md 7 (forces at x(t + dt) and v(t) + dt a(t)) is the member with three values.
#pragma once

#include "core/real.hpp"

namespace sandlane::motion {

// Schemes by number: 3 to 6, Gear's with so many values, and one more.
inline constexpr int verlet_with_slope = 7, last_scheme = 7;
constexpr int values_of(int scheme) {
    return scheme == verlet_with_slope ? 4 : scheme;
}

template <int scheme> struct Gear;
template <> struct Gear<3> { // x += dt v + dt^2/2 a; v += dt/2 (a + a')
    static constexpr double c[3] = {0.0, 1.0, 1.0};
};
template <> struct Gear<4> { // (2.28)
    static constexpr double c[4] = {1.0 / 6.0, 5.0 / 6.0, 1.0, 1.0 / 3.0};
};
template <> struct Gear<5> { // (2.27)
    static constexpr double c[5] = {19.0 / 90.0, 3.0 / 4.0, 1.0, 1.0 / 2.0, 1.0 / 12.0};
};
template <> struct Gear<6> { // (2.26)
    static constexpr double c[6] = {3.0 / 16.0, 251.0 / 360.0, 1.0, 11.0 / 18.0, 1.0 / 6.0, 1.0 / 60.0};
};
// Velocity Verlet that keeps the slope of the acceleration, X_3 = (X_2(t) - X_2(t - dt))/3, for the velocity
// that forces see, v + dt a + dt^2/2 a': the positions of Verlet, and damping without an error of second
// order.
template <> struct Gear<verlet_with_slope> { static constexpr double c[4] = {0.0, 1.0, 1.0, 1.0 / 3.0}; };

// X <- P X with the binomial matrix, as repeated additions (a Pascal triangle).
template <int order, class R> SANDLANE_INLINE void gear_predict(R (&x)[order]) {
    for (int first = 0; first < order - 1; ++first)
        for (int k = order - 2; k >= first; --k) x[k] = x[k] + x[k + 1];
}

// X <- X + c (dt^2/2 a - X_2); `half_dt2` = dt^2/2 [s^2], a [m/s^2 or rad/s^2].
template <int scheme, class R>
SANDLANE_INLINE void correct(R (&x)[values_of(scheme)], const R& acceleration, const R& half_dt2) {
    const R difference = half_dt2 * acceleration - x[2];
    for (int k = Gear<scheme>::c[0] == 0.0 ? 1 : 0; k < values_of(scheme); ++k)
        x[k] = x[k] + R(Gear<scheme>::c[k]) * difference;
}
template <int order, class R>
SANDLANE_INLINE void gear_correct(R (&x)[order], const R& acceleration, const R& half_dt2) {
    correct<order>(x, acceleration, half_dt2);
}

// The prediction of any scheme.
template <int scheme, class R> SANDLANE_INLINE void predict(R (&x)[values_of(scheme)]) {
    if constexpr (scheme == verlet_with_slope) {
        const R bend = x[2] + R(3.0) * x[3];
        x[0] = x[0] + (x[1] + x[2]);
        x[1] = x[1] + (x[2] + bend);
        x[2] = bend;
    } else {
        gear_predict(x);
    }
}

} // namespace sandlane::motion
