// What [gas] and [[sides]] of a scene say to every engine of gases.
#pragma once

#include "core/vec.hpp"
#include "laws/restitution_models.hpp"
#include "laws/wall_times.hpp"
#include "scene/scene.hpp"

#include <cmath>
#include <numbers>

namespace sandlane::analysis {

inline void copy(const Vec& from, double (&to)[3]) {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

// q of J = q m R^2.
[[nodiscard]] constexpr double inertia_of(scene::GasBody body) {
    constexpr double inertia[] = {0.4, 0.5, 2.0 / 3, 1};
    return inertia[static_cast<std::size_t>(body)];
}

[[nodiscard]] inline laws::Restitution restitution_of(const scene::Gas& gas) {
    return {static_cast<laws::Restitution::Model>(gas.model), gas.restitution, gas.dissipation,
            gas.critical_speed, gas.exponent};
}

[[nodiscard]] inline laws::Oscillation oscillation_of(const scene::GasSide& side) {
    const double turns = side.phase / (2 * std::numbers::pi);
    return {side.amplitude, side.frequency, turns - std::floor(turns)};
}

} // namespace sandlane::analysis
