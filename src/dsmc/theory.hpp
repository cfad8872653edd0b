// What kinetic theory says of a homogeneous gas: the cooling that a run is compared with.
#pragma once

#include "dsmc/setup.hpp"

#include <vector>

namespace sandlane::dsmc {

// Second Sonine coefficient of free cooling with constant restitution, after Montanero and Santos 2000.
[[nodiscard]] double cooling_a2(int dimension, double eps);

// Temperature of the homogeneous gas [J] at the ascending times [s], from `temperature` at 0, after
// dT/dt = -zeta(T) T + m xi^2. zeta: Gaussian velocities, with the first Sonine correction for constant
// restitution (specification of Monte Carlo, 7.2-7.7). Smooth particles; NaN for rough ones.
[[nodiscard]] std::vector<double> cooling_curve(const Setup& setup, std::size_t particles, double temperature,
                                                const std::vector<double>& times);
// Number of steps until `duration` where the time step follows the temperature, about.
[[nodiscard]] double adaptive_steps(const Setup& setup, std::size_t particles, double temperature,
                                    double duration);

// Whether nothing but collisions and noise acts, so that the curve means something.
[[nodiscard]] bool is_homogeneous(const Setup& setup);

} // namespace sandlane::dsmc
