// Periodic box of discs at a given packing fraction, for throughput measurements: a state that every
// pair-finding method accepts. Up to 0.82 an elastic gas that friction cools slowly; beyond jamming a packing
// at rest. Radii +-10 % unless equal.
#pragma once

#include "core/rng.hpp"
#include "md/simulation.hpp"

#include <cmath>
#include <numbers>

namespace sandlane::bench {

struct Setup {
    std::size_t grains = 10000;
    double packing_fraction = 0.82;
    scene::NormalLaw normal = scene::NormalLaw::linear_dashpot;
    bool friction = true;
    bool equal_radii = false;
    scene::NeighbourMethod neighbours = scene::NeighbourMethod::lattice;
    scene::Integrator integrator = scene::Integrator::gear5;
};

// Below the packing fraction of a jammed disc packing there is no damping, above it strong damping brings the
// start to rest: 0.01 touching neighbours per grain at 0.2, about one at 0.82, between four and five at 0.88.
inline constexpr double jammed = 0.85;

// Rows and columns of the start: even, as the triangular lattice needs in a periodic box.
inline std::int64_t side_of(const Setup& setup) {
    return 2 * std::llround(0.5 * std::sqrt(static_cast<double>(setup.grains)));
}

inline scene::Scene agitated_scene(const Setup& setup) {
    scene::Scene s;
    const auto side = static_cast<double>(side_of(setup));
    const double spacing = std::sqrt(2 * std::numbers::pi / (std::sqrt(3.0) * setup.packing_fraction));
    s.title = "agitated discs";
    s.domain.upper = {side * spacing, side * spacing * std::sqrt(3.0) / 2, 0};
    s.domain.periodic = {true, true};
    scene::Material m;
    m.name = "disc";
    m.density = 1 / std::numbers::pi;
    m.stiffness = 1e4;
    m.damping = setup.packing_fraction > jammed ? 30.0 : 0.0;
    m.young = 1e4;
    m.friction = setup.friction ? 0.3 : 0.0;
    m.tangential_damping = setup.friction ? 0.1 : 0.0;
    s.materials = {m};
    s.md.normal = setup.normal;
    s.md.tangential = setup.friction ? scene::TangentialLaw::haff_werner : scene::TangentialLaw::none;
    s.md.neighbours = setup.neighbours;
    s.md.integrator = setup.integrator;
    s.md.body = scene::Body::disc;
    s.md.max_speed = 2;
    s.md.duration = 1;
    return s;
}

inline std::vector<scene::GrainState> agitated_grains(const Setup& setup, const scene::Scene& s) {
    std::vector<scene::GrainState> grains;
    const std::int64_t side = side_of(setup);
    const double spacing = s.domain.upper.x / static_cast<double>(side);
    const Random radius(1, Stream::radius), velocity(1, Stream::velocity);
    for (std::int64_t n = 0; n < side * side; ++n) {
        const auto column = static_cast<double>(n % side), row = static_cast<double>(n / side);
        scene::GrainState g;
        g.id = n;
        g.radius = setup.equal_radii ? 1.0 : 0.9 + 0.2 * radius.uniform(static_cast<std::uint64_t>(n));
        g.mass = g.radius * g.radius;
        g.position = {(column + 0.25 + 0.5 * static_cast<double>(n / side % 2)) * spacing,
                      (row + 0.5) * spacing * std::sqrt(3.0) / 2, 0};
        const auto [vx, vy] = velocity.normal2(static_cast<std::uint64_t>(n));
        g.velocity = {0.5 * vx, 0.5 * vy, 0};
        g.omega = 0;
        grains.push_back(g);
    }
    return grains;
}

// The grains of a simulation as the start of another.
inline std::vector<scene::GrainState> later_grains(const md::Simulation& simulation) {
    const analysis::Snapshot now = simulation.snapshot();
    std::vector<scene::GrainState> grains(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
        scene::GrainState& g = grains[i];
        g.id = now.id[i];
        g.position = {now.x[i], now.y[i], 0};
        g.velocity = {now.vx[i], now.vy[i], 0};
        g.omega = now.omega[i];
        g.radius = now.radius[i];
        g.mass = now.mass[i];
    }
    return grains;
}

inline md::Simulation make(const Setup& setup, const std::vector<scene::GrainState>& grains, simd::Isa isa,
                           int threads) {
    const scene::Scene s = agitated_scene(setup);
    const md::Needs needs = md::analyse(s, grains);
    return {s, grains, needs, md::make_plan(s, needs, md::derive(s, needs), isa, {threads, "benchmark"})};
}

} // namespace sandlane::bench
