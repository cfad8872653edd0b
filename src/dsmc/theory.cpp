#include "dsmc/theory.hpp"

#include <limits>

namespace sandlane::dsmc {

analysis::HardGas gas_of(const Setup& setup, std::size_t particles) {
    const Scales s = scales(setup, particles, setup.mass);
    return {setup.dimension, s.density,         s.correlation, setup.mass,
            setup.diameter,  setup.restitution, setup.kicks};
}

analysis::MixtureGas mixture_gas(const Setup& setup, std::size_t particles) {
    analysis::MixtureGas gas;
    gas.dimension = setup.dimension;
    gas.dense = setup.enskog;
    gas.kicks = setup.kicks;
    const double density = static_cast<double>(particles) * setup.weight / setup.volume();
    for (std::size_t i = 0; i < setup.kinds(); ++i) {
        const Kind k = setup.kind(i);
        gas.kinds.push_back({density * k.fraction, k.mass, k.diameter});
        for (std::size_t j = 0; j < setup.kinds(); ++j) gas.restitution.push_back(setup.restitution_of(i, j));
    }
    return gas;
}

bool is_homogeneous(const Setup& setup) {
    if (setup.rough || setup.shear != 0 || setup.scheme == laws::CollisionScheme::maxwell) return false;
    if (!setup.others.empty() && setup.restitution.model != laws::Restitution::Model::constant) return false;
    for (int d = 0; d < setup.dimension; ++d)
        if (!setup.walls.periodic[d] || setup.gravity[d] != 0) return false;
    return true;
}

std::vector<double> cooling_curve(const Setup& setup, std::size_t particles, double temperature,
                                  const std::vector<double>& times) {
    if (setup.rough) return std::vector<double>(times.size(), std::numeric_limits<double>::quiet_NaN());
    return analysis::cooling_curve(gas_of(setup, particles), temperature, times);
}

std::vector<double> kind_temperatures(const Setup& setup, std::size_t particles, double temperature,
                                      double time) {
    return analysis::cooling_curves(mixture_gas(setup, particles), temperature, {time}).front();
}

double adaptive_steps(const Setup& setup, std::size_t particles, double temperature, double duration) {
    const double clock =
        setup.others.empty()
            ? analysis::collision_clock(gas_of(setup, particles), temperature, duration)
            : analysis::collision_clock(mixture_gas(setup, particles), temperature, duration);
    return clock / setup.dt;
}

} // namespace sandlane::dsmc
