// Periodic box of discs or spheres at a given packing fraction, for throughput measurements: a state that
// every pair-finding method accepts. Below jamming an elastic gas that friction cools slowly; beyond it a
// packing at rest. Radii +-10 % unless equal.
#pragma once

#include "core/rng.hpp"
#include "md/simulation.hpp"

#include <cmath>
#include <numbers>

namespace sandlane::bench {

// What a scene does without, computed all the same: spins without friction, memory without springs that pull,
// equal radii and materials looked up, discs as spheres that stay in a plane.
enum class Spare { nothing, rotation, memory, radii, materials, space };

struct Setup {
    std::size_t grains = 10000;
    double packing_fraction = 0.82;
    int dimension = 2;
    scene::NormalLaw normal = scene::NormalLaw::linear_dashpot;
    bool friction = true;
    bool equal_radii = false;
    scene::NeighbourMethod neighbours = scene::NeighbourMethod::lattice;
    scene::Integrator integrator = scene::Integrator::gear5;
    bool springs = false;       // friction of Cundall and Strack
    bool two_materials = false; // of the same coefficients
    Spare spare = Spare::nothing;
    bool half_empty = false; // 2D: the upper half of the box holds nothing
    bool large = false;      // a few grains that are `large_radius` times as large as the others
    bool one_grid = false;   // and link cells that know nothing of it
};

// Of the few large grains, in radii of the others.
inline double large_radius(const Setup& setup) {
    return setup.dimension == 3 ? 20 : 100;
}

// Below the packing fraction of a jammed packing there is no damping, above it strong damping brings the
// start to rest. Discs: 0.01 touching neighbours per grain at 0.2, about one at 0.82, between four and five
// at 0.88. Spheres: between five and six at 0.64.
inline bool at_rest(const Setup& setup) {
    return setup.packing_fraction > (setup.dimension == 3 ? 0.63 : 0.85);
}

// Rows and columns of the start: even, as the triangular lattice needs in a periodic box.
inline std::int64_t side_of(const Setup& setup) {
    const auto n = static_cast<double>(setup.grains);
    return 2 * std::llround(0.5 * (setup.dimension == 3 ? std::cbrt(n) : std::sqrt(n)));
}

inline scene::Scene agitated_scene(const Setup& setup) {
    scene::Scene s;
    const auto side = static_cast<double>(side_of(setup));
    s.title = "agitated grains";
    if (setup.dimension == 3) {
        const double edge = side * std::cbrt(4.0 / 3.0 * std::numbers::pi / setup.packing_fraction);
        s.domain.dimension = 3;
        s.domain.upper = {edge, edge, edge};
        s.md.inertia = scene::Inertia::sphere;
    } else {
        const double spacing = std::sqrt(2 * std::numbers::pi / (std::sqrt(3.0) * setup.packing_fraction));
        const double height = side * spacing * std::sqrt(3.0) / 2;
        s.domain.upper = {side * spacing, setup.half_empty ? 2 * height : height, 0};
        s.md.body = scene::Body::disc;
    }
    s.domain.periodic = {true, true, setup.dimension == 3};
    scene::Material m;
    m.name = "grain";
    m.density = 1 / std::numbers::pi;
    m.stiffness = 1e4;
    m.damping = at_rest(setup) ? 30.0 : 0.0;
    m.young = 1e4;
    m.dissipation = at_rest(setup) ? 5e-3 : 0.0;
    m.friction = setup.friction ? 0.3 : 0.0;
    m.tangential_damping = setup.friction ? 0.1 : 0.0;
    m.tangential_stiffness = 2.0 / 7.0 * m.stiffness;
    s.materials = {m};
    if (setup.two_materials) {
        m.name = "other";
        s.materials.push_back(m);
    }
    s.md.normal = setup.normal;
    s.md.tangential = setup.springs    ? scene::TangentialLaw::cundall_strack
                      : setup.friction ? scene::TangentialLaw::haff_werner
                                       : scene::TangentialLaw::none;
    s.md.neighbours = setup.neighbours;
    s.md.integrator = setup.integrator;
    s.md.max_speed = 2;
    s.md.duration = 1;
    return s;
}

inline Vec lattice_place(const Setup& setup, const scene::Scene& s, std::int64_t n) {
    const std::int64_t side = side_of(setup);
    const double spacing = s.domain.upper.x / static_cast<double>(side);
    const auto column = static_cast<double>(n % side), row = static_cast<double>(n / side % side);
    if (setup.dimension == 2)
        return {(column + 0.25 + 0.5 * static_cast<double>(n / side % 2)) * spacing,
                (row + 0.5) * spacing * std::sqrt(3.0) / 2, 0};
    const Random jitter(1, Stream::position);
    const auto shaken = [&](double cell, std::int64_t direction) {
        return (cell + 0.5 + 0.25 * (jitter.uniform(static_cast<std::uint64_t>(3 * n + direction)) - 0.5)) *
               spacing;
    };
    return {shaken(column, 0), shaken(row, 1), shaken(static_cast<double>(n / (side * side)), 2)};
}

// Two, far from each other, at rest at the start.
inline void add_large_grains(const Setup& setup, const scene::Scene& s,
                             std::vector<scene::GrainState>& grains) {
    if (!setup.large) return;
    for (const double at : {0.25, 0.75}) {
        scene::GrainState g;
        g.id = static_cast<std::int64_t>(grains.size());
        g.radius = large_radius(setup);
        g.mass = g.radius * g.radius;
        g.position = at * (s.domain.upper - s.domain.lower);
        grains.push_back(g);
    }
}
inline bool meets_large_grain(const Setup& setup, const std::vector<scene::GrainState>& grains,
                              const scene::GrainState& g) {
    return setup.large && (norm(g.position - grains[0].position) < grains[0].radius + g.radius ||
                           norm(g.position - grains[1].position) < grains[1].radius + g.radius);
}

inline std::vector<scene::GrainState> agitated_grains(const Setup& setup, const scene::Scene& s) {
    std::vector<scene::GrainState> grains;
    const std::int64_t side = side_of(setup);
    const Random radius(1, Stream::radius), velocity(1, Stream::velocity);
    const std::int64_t layers = setup.dimension == 3 ? side : 1;
    add_large_grains(setup, s, grains);
    for (std::int64_t n = 0; n < side * side * layers; ++n) {
        const auto counter = static_cast<std::uint64_t>(n);
        scene::GrainState g;
        g.id = static_cast<std::int64_t>(grains.size());
        g.radius = setup.equal_radii ? 1.0 : 0.9 + 0.2 * radius.uniform(counter);
        g.mass = g.radius * g.radius;
        g.position = lattice_place(setup, s, n);
        if (meets_large_grain(setup, grains, g)) continue;
        const auto [vx, vy] = velocity.normal2(counter);
        g.velocity = {0.5 * vx, 0.5 * vy, 0};
        g.material = setup.two_materials ? static_cast<int>(n % 2) : 0;
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
        if (now.dimension == 3) {
            g.position.z = now.z[i];
            g.velocity.z = now.vz[i];
            g.angular_velocity = {now.omega_x[i], now.omega_y[i], now.omega[i]};
        }
        g.radius = now.radius[i];
        g.mass = now.mass[i];
        g.material = now.material[i];
    }
    return grains;
}

inline md::Simulation make(const Setup& setup, const std::vector<scene::GrainState>& grains, simd::Isa isa,
                           int threads) {
    scene::Scene s = agitated_scene(setup);
    if (setup.spare == Spare::memory) s.md.tangential = scene::TangentialLaw::cundall_strack;
    if (setup.spare == Spare::space) {
        s.domain.dimension = 3;
        s.domain.lower.z = -3;
        s.domain.upper.z = 3;
    }
    md::Needs needs = md::analyse(s, grains);
    if (setup.one_grid) needs.sizes.clear();
    needs.spinning = needs.spinning || setup.spare == Spare::rotation;
    needs.friction = needs.friction || setup.spare == Spare::memory;
    needs.many_radii = needs.many_radii || setup.spare == Spare::radii;
    needs.many_materials = needs.many_materials || setup.spare == Spare::materials;
    return {s, grains, needs, md::make_plan(s, needs, md::derive(s, needs), isa, {threads, "benchmark"})};
}

} // namespace sandlane::bench
