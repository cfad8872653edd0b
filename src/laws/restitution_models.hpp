// Restitution as a function of the normal impact speed, for engines that collide particles in one instant:
// event-driven dynamics and direct simulation Monte Carlo.
#pragma once

#include "laws/elementary.hpp"

namespace sandlane::laws {

// Normal restitution eps(g) of particles that meet with the normal relative speed g >= 0 [m/s].
struct Restitution {
    enum class Model {
        constant,     // eps
        viscoelastic, // beta = dissipation g^{1/5}, eps by the approximant below
        saturating,   // 1 - (1 - eps) min(1, (g/speed)^power), so that slow impacts are elastic
    };
    Model model = Model::constant;
    double eps = 1;         // constant, saturating: in [0, 1]
    double dissipation = 0; // viscoelastic: A rho^{2/5} [(s/m)^{1/5}]
    double speed = 1;       // saturating [m/s]
    double power = 0.2;     // saturating
};

// Viscoelastic spheres without attraction at the end of the contact: [2/5] approximant in w = sqrt(beta),
// beta = A rho^{2/5} g^{1/5} with A as in (2.12); exact through w^4, error below 4.4e-5 for beta <= 30
// (specification of event-driven dynamics, P3).
template <class R> SANDLANE_INLINE R viscoelastic_approximant(const R& w) {
    const R above = R(1.0) + w * (R(1.67527203) + w * R(0.25556583));
    const R below =
        R(1.0) + w * (R(1.67527203) +
                      w * (R(1.40901469) + w * (R(1.93234061) + w * (R(0.82695983) + w * R(0.59649499)))));
    return above / below;
}

// eps(g), g >= 0. The model is the same for all lanes.
template <class R> SANDLANE_INLINE R restitution(const Restitution& law, const R& g) {
    if (law.model == Restitution::Model::constant) return R(law.eps);
    if (law.model == Restitution::Model::viscoelastic)
        return viscoelastic_approximant(sqrt(R(law.dissipation)) * power(g, R(0.1)));
    const R part = min(power(g * R(1.0 / law.speed), R(law.power)), R(1.0));
    return R(1.0) - R(1.0 - law.eps) * part;
}

// The same where each pair of kinds has a coefficient of its own, the model in common: eps, or the root of
// the dissipation of viscoelastic spheres.
template <class R>
SANDLANE_INLINE R restitution_of_pair(const Restitution& law, const R& coefficient, const R& g) {
    if (law.model == Restitution::Model::constant) return coefficient;
    if (law.model == Restitution::Model::viscoelastic)
        return viscoelastic_approximant(coefficient * power(g, R(0.1)));
    const R part = min(power(g * R(1.0 / law.speed), R(law.power)), R(1.0));
    return R(1.0) - (R(1.0) - coefficient) * part;
}

} // namespace sandlane::laws
