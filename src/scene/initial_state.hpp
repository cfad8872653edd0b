// Free grains at t = 0 and those poured later, from the scene's populations.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace sandlane::scene {

struct GrainState {
    std::int64_t id = 0;
    Vec position, velocity;      // z: unused in 2D
    double angle = 0, omega = 0; // 2D
    Vec angular_velocity;        // 3D, rad/s in the frame of space
    double radius = 0, mass = 0; // m, kg
    int material = 0;            // index into Scene::materials
    int factory = -1; // its population, where the place is drawn anew at every attempt to insert it
    double insert_at = -std::numeric_limits<double>::infinity(); // pour: time of insertion, s
};

// All grains, ids 0, 1, ... in the order of the populations; poured ones carry insert_at. Deterministic in
// (scene, seed). Throws Error(invalid_input) naming population, ids and overlap for overlapping grains
// (xi > 5 % of the smaller radius), grains outside the domain or with NaN, and populations that do not fit.
[[nodiscard]] std::vector<GrainState> initial_grains(const Scene& scene);

[[nodiscard]] double grain_mass(const Scene& scene, const Grains& population, int material, double radius);

} // namespace sandlane::scene
