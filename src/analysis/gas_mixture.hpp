// Kinetic theory of a homogeneous mixture of smooth hard particles: each kind cools at its own rate until, at
// constant restitution, the ratios of the temperatures no longer change. They differ: there is no
// equipartition.
#pragma once

#include "laws/restitution_models.hpp"

#include <cstddef>
#include <vector>

namespace sandlane::analysis {

struct MixtureKind {
    double density = 1;            // 1/m^3, 1/m^2 in the plane
    double mass = 1, diameter = 1; // kg, m
};

struct MixtureGas {
    int dimension = 3;
    bool dense =
        false;        // pair correlations at contact of Mansoori et al., in the plane of Jenkins and Mancini
    double kicks = 0; // white noise xi^2 of each velocity component, m^2/s^3
    std::vector<MixtureKind> kinds;
    // [kinds^2]; those that depend on the speed count as at its mean square along the line of centres.
    std::vector<laws::Restitution> restitution;

    [[nodiscard]] std::size_t size() const { return kinds.size(); }
};

// Collisions of a particle of kind i with those of kind j per second, Maxwellians of these temperatures [J]
// (specification of Monte Carlo, 3.4).
[[nodiscard]] double collision_rate(const MixtureGas& gas, std::size_t i, std::size_t j, double t_i,
                                    double t_j);
// Of a particle of any kind with those of all, at one temperature.
[[nodiscard]] double collision_rate(const MixtureGas& gas, double temperature);

// dT_i/dt of all kinds [J/s], Maxwellians: the leading order of Garzo and Dufty 1999.
[[nodiscard]] std::vector<double> temperature_rates(const MixtureGas& gas,
                                                    const std::vector<double>& temperatures);

// Temperatures of all kinds at the ascending times [s], from one temperature at 0.
[[nodiscard]] std::vector<std::vector<double>> cooling_curves(const MixtureGas& gas, double temperature,
                                                              const std::vector<double>& times);
// Integral of sqrt(T/T_0) dt until `end` [s], T the mean of the kinds.
[[nodiscard]] double collision_clock(const MixtureGas& gas, double temperature, double end);
// T_i/T_0 that a gas of constant restitution without noise comes to.
[[nodiscard]] std::vector<double> temperature_ratios(const MixtureGas& gas);

} // namespace sandlane::analysis
