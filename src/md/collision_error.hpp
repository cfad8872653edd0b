// The error of one collision at a time step: the equation of motion of two grains on their line of centres,
// with the laws of src/laws and the integrators of src/motion, against its solution.
#pragma once

#include "laws/contact.hpp"

#include <limits>

namespace sandlane::md {

// Two grains that meet head on; mass and radius are the reduced ones.
struct Impact {
    laws::PairCoefficients<double> coefficients;
    double mass = 0;   // kg
    double radius = 0; // m
    double speed = 0;  // m/s
    double time = 0;   // s, estimate of how long they touch
};
[[nodiscard]] Impact make_impact(int normal, const laws::PairCoefficients<double>& coefficients, double mass,
                                 double radius, double speed);

// How a collision is stepped: scheme of motion/gear.hpp (3: velocity Verlet), and whether begin and end are
// resolved, for laws that can.
struct Stepping {
    int scheme = 5;
    bool resolved = false;

    Stepping(int of, bool resolve = false) : scheme(of), resolved(resolve) {} // NOLINT: a number of values
};

// Restitution coefficient by steps of dt [s], as a run takes them; the gap [m] is that before the first step.
// normal: position in laws.def. Grains that do not part, or get a speed that is no number: 0.
[[nodiscard]] double stepped_restitution(int normal, Stepping stepping, const Impact& impact, double dt,
                                         double gap);
// The same without the error of steps, to about 1e-10.
[[nodiscard]] double exact_restitution(int normal, const Impact& impact);

// Error of a restitution coefficient: the larger one of its relative error and of that of the energy after
// the collision over the energy before.
[[nodiscard]] double collision_error(double restitution, double exact);
// Root mean square of it over `phases` collisions that begin evenly spread within a step. Where it is above
// `enough`, some value above that, sooner.
inline constexpr int phases = 16;
[[nodiscard]] double collision_error(int normal, Stepping stepping, const Impact& impact, double exact,
                                     double dt, double enough = std::numeric_limits<double>::infinity());

} // namespace sandlane::md
