#include "dsmc/theory.hpp"

#include <limits>

namespace sandlane::dsmc {

analysis::HardGas gas_of(const Setup& setup, std::size_t particles) {
    const Scales s = scales(setup, particles, setup.mass);
    return {setup.dimension, s.density,         s.correlation, setup.mass,
            setup.diameter,  setup.restitution, setup.kicks};
}

bool is_homogeneous(const Setup& setup) {
    if (setup.rough) return false;
    for (int d = 0; d < setup.dimension; ++d)
        if (!setup.walls.periodic[d] || setup.gravity[d] != 0) return false;
    return true;
}

std::vector<double> cooling_curve(const Setup& setup, std::size_t particles, double temperature,
                                  const std::vector<double>& times) {
    if (setup.rough) return std::vector<double>(times.size(), std::numeric_limits<double>::quiet_NaN());
    return analysis::cooling_curve(gas_of(setup, particles), temperature, times);
}

double adaptive_steps(const Setup& setup, std::size_t particles, double temperature, double duration) {
    return analysis::collision_clock(gas_of(setup, particles), temperature, duration) / setup.dt;
}

} // namespace sandlane::dsmc
