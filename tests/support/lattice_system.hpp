// The perturbed triangular packing of values computed independently: 64 discs, no random numbers.
#pragma once

#include "md/simulation.hpp"

#include <cmath>
#include <limits>

namespace sandlane::test {

inline scene::Scene lattice_scene(int columns = 8, int rows = 8) {
    scene::Scene s;
    const double a = 2.02;
    s.domain.lower = {0, 0, 0};
    s.domain.upper = {columns * a, rows * a * std::sqrt(3.0) / 2, 0};
    s.domain.periodic = {true, true};
    scene::Material m;
    m.name = "disc";
    m.stiffness = 1000;
    m.damping = 0.5;
    m.friction = 0.4;
    m.tangential_damping = 0.3;
    s.materials = {m};
    s.md.normal = scene::NormalLaw::linear_dashpot;
    s.md.tangential = scene::TangentialLaw::haff_werner;
    s.md.max_speed = 1;
    s.md.dt = 1e-3;
    s.md.duration = 1;
    return s;
}

inline std::vector<scene::GrainState> lattice_grains(int columns = 8, int rows = 8,
                                                     bool equal_radii = false) {
    std::vector<scene::GrainState> grains;
    const double a = 2.02;
    const scene::Scene s = lattice_scene(columns, rows);
    const Vec size = s.domain.upper;
    for (int n = 0; n < columns * rows; ++n) {
        const double k = n;
        const int ix = n % columns, iy = n / columns;
        scene::GrainState g;
        g.id = n;
        g.position = {(ix + 0.5 * (iy % 2)) * a + 0.06 * std::sin(1.0 + 7.0 * k),
                      iy * a * std::sqrt(3.0) / 2 + 0.06 * std::cos(2.0 + 11.0 * k), 0};
        g.position.x -= size.x * std::floor(g.position.x / size.x);
        g.position.y -= size.y * std::floor(g.position.y / size.y);
        g.radius = equal_radii ? 1.0 : 1 + 0.05 * std::sin(3.0 * k);
        g.velocity = {std::sin(0.5 + 5.0 * k), std::cos(0.25 + 3.0 * k), 0};
        g.omega = 0.5 * std::sin(13.0 * k);
        g.mass = g.radius * g.radius;
        grains.push_back(g);
    }
    return grains;
}

inline md::Simulation make_simulation(const scene::Scene& s, const std::vector<scene::GrainState>& grains,
                                      simd::Isa isa, int threads = 1) {
    const md::Needs needs = md::analyse(s, grains);
    return {s, grains, needs, md::make_plan(s, needs, md::derive(s, needs), isa, {threads, "test"})};
}

} // namespace sandlane::test
