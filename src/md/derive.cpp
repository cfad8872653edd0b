// What follows from the contacts of a scene (docs/physics.md 8): collision time, time steps, restitution.
#include "md/law_traits.hpp"
#include "md/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::md {

using scene::Scene;

namespace {

// Largest stable w dt of the scheme at damping ratio z (docs/physics.md 8), interpolated.
double stable_phase(int scheme, double z) {
    static constexpr double at[] = {0.0, 0.3, 1.0, 3.0};
    static constexpr double bound[5][4] = {{2.0, 1.13, 0.47, 0.166},
                                           {1.41, 0.69, 0.26, 0.091},
                                           {0.94, 0.42, 0.148, 0.050},
                                           {0.81, 0.25, 0.081, 0.028},
                                           {1.7, 0.72, 0.245, 0.08}};
    const double* b = bound[scheme - 3];
    for (int n = 1; n < 4; ++n)
        if (z <= at[n]) return b[n - 1] + (b[n] - b[n - 1]) * (z - at[n - 1]) / (at[n] - at[n - 1]);
    return b[3] * at[3] / z;
}

// Largest stable dt gamma/m of a pure damping force.
double stable_damping(int scheme) {
    static constexpr double bound[] = {1.0, 0.54, 0.30, 0.16, 0.5};
    return bound[scheme - 3];
}

} // namespace

Derived derive(const Scene& scene, const Needs& needs) {
    Derived d;
    if (needs.radius_max == 0) {
        d.collision_time = d.critical_dt = d.recommended_dt = std::numeric_limits<double>::infinity();
        d.restitution_min = 1;
        return d;
    }
    d.collision_time = d.critical_dt = d.recommended_dt = std::numeric_limits<double>::infinity();
    d.restitution_max = 0;
    const int scheme = scheme_of(scene.md);
    const std::vector<double> table = pair_table(scene);
    // Two of the lightest grains make the stiffest contact, two of the heaviest (or one on a wall) the
    // deepest.
    const double light = 0.5 * needs.mass_min, heavy = needs.mass_max;
    const double inertia = scene.md.inertia == scene::Inertia::disc ? 0.5 : 0.4;
    const auto scale = [&](const Coefficients& c, double mass, double radius) {
        return with_traits(scene,
                           [&](auto traits) { return traits.scale(c, mass, radius, scene.md.max_speed); });
    };
    const auto bound = [&](double critical, double recommended) {
        d.critical_dt = std::min(d.critical_dt, critical);
        d.recommended_dt = std::min(d.recommended_dt, recommended);
    };
    for (std::size_t p = 0; p < table.size(); p += laws::pair_coefficients) {
        const Coefficients c = laws::coefficients_from<double>(table.data() + p);
        const ContactScale fast = scale(c, light, 0.5 * needs.radius_min);
        const ContactScale deep = scale(c, heavy, needs.radius_max);
        d.known = d.known && fast.collision_time > 0 && std::isfinite(fast.collision_time);
        d.collision_time = std::min(d.collision_time, fast.collision_time);
        bound(stable_phase(scheme, fast.damping_ratio) / fast.frequency, fast.half_swing / 50);
        d.restitution_min = std::min({d.restitution_min, fast.restitution, deep.restitution});
        d.restitution_max = std::max({d.restitution_max, fast.restitution, deep.restitution});
        d.overlap_ratio = std::max(d.overlap_ratio, deep.overlap / needs.radius_min);
        // Of two of the lightest grains.
        const double inertia_of_two = 0.5 * inertia * needs.mass_min * needs.radius_min * needs.radius_min;
        if (c.rolling_friction > 0 && c.rolling_damping > 0)
            bound(stable_damping(scheme) * inertia_of_two / c.rolling_damping,
                  0.15 * inertia_of_two / c.rolling_damping);
        if (c.rolling_friction > 0 && c.rolling_stiffness > 0) {
            const double frequency = std::sqrt(c.rolling_stiffness / inertia_of_two);
            const double ratio = c.rolling_damping / (2 * std::sqrt(c.rolling_stiffness * inertia_of_two));
            bound(stable_phase(scheme, ratio) / frequency, std::numbers::pi / frequency / 50);
        }
        if (!needs.friction || c.friction == 0) continue;
        const double tangential_mass = 1 / (2 / needs.mass_min * (1 + 1 / inertia)); // of two light grains
        if (c.tangential_damping > 0)
            bound(stable_damping(scheme) * tangential_mass / c.tangential_damping,
                  0.15 * tangential_mass / c.tangential_damping);
        if (has_spring(scene.md.tangential)) { // which swings at its own frequency
            const double frequency = std::sqrt(c.tangential_stiffness / tangential_mass);
            const double ratio =
                c.tangential_damping / (2 * std::sqrt(c.tangential_stiffness * tangential_mass));
            bound(stable_phase(scheme, ratio) / frequency, std::numbers::pi / frequency / 50);
        }
    }
    d.recommended_dt = std::min(d.recommended_dt, 0.25 * d.critical_dt);
    return d;
}

double contact_time_step(const Scene& scene, const Coefficients& c, double mass, double radius,
                         double overlap) {
    return with_traits(scene, [&](auto traits) {
        const double frequency = std::sqrt(traits.stiffness(c, radius, overlap) / mass);
        const double ratio = traits.damping(c, radius, overlap) / (2 * mass * frequency);
        return std::min(std::numbers::pi / 50, 0.25 * stable_phase(scheme_of(scene.md), ratio)) / frequency;
    });
}

} // namespace sandlane::md
