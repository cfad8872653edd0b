// Small scenes for tests of whole simulations.
#pragma once

#include "md/simulation.hpp"

namespace sandlane::test {

inline scene::Scene empty_scene() {
    scene::Scene s;
    s.domain.lower = {-1, -1, 0};
    s.domain.upper = {1, 1, 0};
    s.materials = {scene::Material{}};
    s.materials[0].name = std::string("m"); // GCC 12 misreads the assignment of a literal
    s.md.normal = scene::NormalLaw::linear_dashpot;
    s.md.tangential = scene::TangentialLaw::none;
    s.md.duration = 1;
    return s;
}

inline scene::GrainState grain(std::int64_t id, Vec position, Vec velocity, double radius, double mass,
                               double omega = 0) {
    scene::GrainState g;
    g.id = id;
    g.position = position;
    g.velocity = velocity;
    g.radius = radius;
    g.mass = mass;
    g.omega = omega;
    return g;
}

inline md::Simulation simulate(const scene::Scene& s, const std::vector<scene::GrainState>& grains,
                               simd::Isa isa = simd::available_isas().back()) {
    const md::Needs needs = md::analyse(s, grains);
    return {s, grains, needs, md::make_plan(s, needs, md::derive(s, needs), isa, {1, "test"})};
}

inline scene::Wall floor_plane() {
    scene::Wall w;
    w.name = "floor";
    w.kind = scene::WallKind::plane;
    w.points = {{0, 0, 0}};
    w.normal = {0, 1, 0};
    return w;
}

} // namespace sandlane::test
