// What kinetic theory says of the gas of a setup: the cooling that a run is compared with.
#pragma once

#include "analysis/gas_mixture.hpp"
#include "analysis/gas_theory.hpp"
#include "dsmc/setup.hpp"

#include <vector>

namespace sandlane::dsmc {

// The gas at its density, dilute or after Enskog.
[[nodiscard]] analysis::HardGas gas_of(const Setup& setup, std::size_t particles);

// Of several kinds.
[[nodiscard]] analysis::MixtureGas mixture_gas(const Setup& setup, std::size_t particles);

// analysis::cooling_curve of this gas; NaN for rough particles.
[[nodiscard]] std::vector<double> cooling_curve(const Setup& setup, std::size_t particles, double temperature,
                                                const std::vector<double>& times);
// Number of steps until `duration` where the time step follows the temperature, about.
[[nodiscard]] double adaptive_steps(const Setup& setup, std::size_t particles, double temperature,
                                    double duration);

// Temperatures of all kinds of a mixture at a time.
[[nodiscard]] std::vector<double> kind_temperatures(const Setup& setup, std::size_t particles,
                                                    double temperature, double time);

// Whether nothing but collisions and noise acts, so that the curve means something.
[[nodiscard]] bool is_homogeneous(const Setup& setup);

} // namespace sandlane::dsmc
