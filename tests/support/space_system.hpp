// A perturbed cubic packing of spheres in a periodic box: no random numbers, contacts in all directions.
#pragma once

#include "support/lattice_system.hpp"

namespace sandlane::test {

inline scene::Scene space_scene(int side) {
    scene::Scene s = lattice_scene();
    const double a = 1.98;
    s.domain.dimension = 3;
    s.domain.upper = {side * a, side * a, side * a};
    s.domain.periodic = {true, true, true};
    s.materials[0].young = 1000;
    s.materials[0].dissipation = 1e-3;
    s.materials[0].tangential_stiffness = 200;
    s.md.inertia = scene::Inertia::sphere;
    return s;
}

inline std::vector<scene::GrainState> space_grains(int side) {
    std::vector<scene::GrainState> grains;
    const double a = 1.98, length = side * a;
    const auto inside = [&](double x) { return x - length * std::floor(x / length); };
    for (int n = 0; n < side * side * side; ++n) {
        const double k = n;
        scene::GrainState g;
        g.id = n;
        g.position = {inside((n % side) * a + 0.06 * std::sin(1.0 + 7.0 * k)),
                      inside((n / side % side) * a + 0.06 * std::cos(2.0 + 11.0 * k)),
                      inside((n / (side * side)) * a + 0.06 * std::sin(3.0 + 5.0 * k))};
        g.radius = 1 + 0.03 * std::sin(3.0 * k);
        g.velocity = {std::sin(0.5 + 5.0 * k), std::cos(0.25 + 3.0 * k), std::sin(1.5 + 2.0 * k)};
        g.angular_velocity = {0.5 * std::sin(13.0 * k), 0.4 * std::cos(17.0 * k),
                              0.3 * std::sin(1 + 19.0 * k)};
        g.mass = g.radius * g.radius * g.radius;
        grains.push_back(g);
    }
    return grains;
}

} // namespace sandlane::test
