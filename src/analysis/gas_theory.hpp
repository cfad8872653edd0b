// What kinetic theory says of a homogeneous gas of hard particles: rates, and the cooling that runs are
// compared with.
#pragma once

#include "laws/restitution_models.hpp"

#include <vector>

namespace sandlane::analysis {

// A gas of equal smooth spheres or discs without mean motion.
struct HardGas {
    int dimension = 3;
    double density = 1;     // 1/m^3, 1/m^2 in the plane
    double correlation = 1; // of pairs at contact
    double mass = 1, diameter = 1;
    laws::Restitution restitution;
    double kicks = 0; // white noise xi^2 of each velocity component, m^2/s^3
};

// Collisions of a particle per second, Gaussian velocities of temperature T [J].
[[nodiscard]] double collision_rate(const HardGas& gas, double temperature);

// Second Sonine coefficient of free cooling with constant restitution, after Montanero and Santos 2000.
[[nodiscard]] double cooling_a2(int dimension, double eps);

// A freely cooling gas stays uniform in a periodic box shorter than both, m: longer waves of transverse
// velocity, and of density, grow relative to the thermal ones. Linear theory of a dilute gas with constant
// restitution below one (specification of event-driven dynamics, 10.4); infinite for an elastic gas.
struct CriticalLengths {
    double shear, cluster;
};
// Infinite where the theory has none.
[[nodiscard]] CriticalLengths critical_lengths(int dimension, double eps, double density, double diameter);

// Temperature of the homogeneous gas [J] at the ascending times [s], from `temperature` at 0, after
// dT/dt = -zeta(T) T + m xi^2. zeta: Gaussian velocities, with the first Sonine correction for constant
// restitution (specification of Monte Carlo, 7.2-7.7).
[[nodiscard]] std::vector<double> cooling_curve(const HardGas& gas, double temperature,
                                                const std::vector<double>& times);
// Integral of sqrt(T/T_0) dt until `end`: what the number of collisions is proportional to [s].
[[nodiscard]] double collision_clock(const HardGas& gas, double temperature, double end);

} // namespace sandlane::analysis
