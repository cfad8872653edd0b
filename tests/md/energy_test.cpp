// The balance of energy, loads on walls and the list of contacts against closed forms.
#include "laws/restitution.hpp"
#include "support/lattice_system.hpp"

#include "md/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

using namespace sandlane;
using namespace sandlane::test;

namespace {

constexpr double radius = 0.01, mass = 0.02, stiffness = 1e4;

scene::Scene springs(double damping = 0) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = stiffness;
    s.materials[0].damping = damping;
    s.walls = {floor_plane()};
    return s;
}

// The balance closes to the error of the integrator: some 1e-4 of the energy of a collision at t_c/50.
constexpr double integrator = 1e-3;

void run_for(md::Simulation& sim, double seconds) {
    sim.run(static_cast<std::int64_t>(seconds / sim.plan().dt));
}

} // namespace

TEST(Energy, AMovingWallWorksOnWhatItHits) {
    scene::Scene s = springs();
    scene::Motion up;
    up.name = "up";
    up.kind = scene::MotionKind::linear;
    up.velocity = {0, 0.1, 0};
    s.motions = {up};
    s.walls[0].motion = "up";
    md::Simulation sim = simulate(s, {grain(0, {0, 0.05, 0}, {0, -1, 0}, radius, mass)});
    run_for(sim, 0.1);
    EXPECT_NEAR(sim.snapshot().vy[0], 1.2, 1.2 * integrator); // 2 V - v
    const double work = 0.5 * mass * (1.2 * 1.2 - 1);
    EXPECT_NEAR(sim.wall_work(), work, 2 * 0.5 * mass * 1.44 * integrator);
    EXPECT_NEAR(sim.dissipated(sim.observe()), 0, 0.5 * mass * 1.44 * integrator);
}

TEST(Energy, WhatADashpotTakes) {
    const double damping = 4, z = damping / (2 * std::sqrt(stiffness * mass));
    md::Simulation sim = simulate(springs(damping), {grain(0, {0, 0.05, 0}, {0, -1, 0}, radius, mass)});
    run_for(sim, 0.1);
    const double e = laws::linear_dashpot_restitution(z), before = 0.5 * mass;
    EXPECT_NEAR(sim.dissipated(sim.observe()), before * (1 - e * e),
                10 * before * integrator); // force starts with a jump
    EXPECT_EQ(sim.wall_work(), 0);
}

TEST(Energy, FallingThroughPeriodicSidesIsNoGain) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = stiffness;
    s.domain.periodic = {true, true};
    s.domain.gravity = {3, -9.81, 0};
    s.md.dt = 1e-4;
    md::Simulation sim = simulate(s, {grain(0, {0.9, -0.9, 0}, {1, 0, 0}, radius, mass)});
    const double before = sim.observe().energy();
    sim.run(8000);
    EXPECT_NE(sim.snapshot().image_y[0], 0);
    EXPECT_NEAR(sim.observe().energy(), before, 1e-9); // rounding of 8000 steps at 1 J
}

TEST(Energy, GrainsThatComeAndGoAreBooked) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = stiffness;
    s.domain.gravity = {0, -10, 0};
    s.md.dt = 1e-4;
    scene::GrainState poured = grain(1, {0.5, 0.8, 0}, {0, -1, 0}, radius, mass);
    poured.insert_at = 0.1;
    md::Simulation sim = simulate(s, {grain(0, {0, 0, 0}, {0, 0, 0}, radius, mass), poured});
    sim.run(3000);
    EXPECT_NEAR(sim.added_energy(), mass * (0.5 + 10 * 1.8), 1e-12); // heights count from the lower side
    EXPECT_NEAR(sim.dissipated(sim.observe()), 0, 1e-9);
    sim.run(7000); // both fall out
    EXPECT_EQ(sim.removed(), 2);
    EXPECT_EQ(sim.observe().energy(), 0);
    EXPECT_NEAR(sim.dissipated(sim.observe()), 0, 1e-9);
}

TEST(WallLoads, AGrainThatSlidesOnATurningDrum) {
    scene::Scene s = springs();
    s.md.tangential = scene::TangentialLaw::haff_werner;
    s.materials[0].friction = 0.5;
    s.materials[0].tangential_damping = 1e3;
    s.md.dt = 1e-6;
    scene::Motion turn;
    turn.name = "turn";
    turn.kind = scene::MotionKind::rotate;
    turn.centre = {0.1, 0.1, 0};
    turn.omega = 2;
    s.motions = {turn};
    const double drum = 0.5, overlap = 1e-4, normal = stiffness * overlap;
    s.walls[0].kind = scene::WallKind::arc;
    s.walls[0].centre = turn.centre;
    s.walls[0].radius = drum;
    s.walls[0].motion = "turn";
    md::Simulation sim =
        simulate(s, {grain(0, {0.1, 0.1 - drum + radius - overlap, 0}, {0, 0, 0}, radius, mass)});
    const md::WallLoad load = sim.observe().walls.at(0);
    const double tolerance = 1e-10 * normal;             // the overlap has lost four digits
    EXPECT_NEAR(load.force.x, -0.5 * normal, tolerance); // the wall's lowest point moves to the right
    EXPECT_NEAR(load.force.y, -normal, tolerance);
    EXPECT_NEAR(load.torque.z, -0.5 * normal * drum, tolerance);
    EXPECT_NEAR(load.power, 0.5 * normal * drum * 2, tolerance);
}

// The same drum as one wall grain: the load acts on the surface of the grain.
TEST(WallLoads, ATurningWallGrain) {
    scene::Scene s = springs();
    s.md.tangential = scene::TangentialLaw::haff_werner;
    s.materials[0].friction = 0.5;
    s.materials[0].tangential_damping = 1e3;
    s.md.dt = 1e-6;
    scene::Motion turn;
    turn.name = "turn";
    turn.kind = scene::MotionKind::rotate;
    turn.omega = 2;
    s.motions = {turn};
    s.walls[0] = scene::Wall();
    s.walls[0].kind = scene::WallKind::grains;
    s.walls[0].radius = 0.1;
    s.walls[0].points = {{0, 0, 0}};
    s.walls[0].motion = "turn";
    const double overlap = 1e-4, normal = stiffness * overlap;
    md::Simulation sim = simulate(s, {grain(0, {0, 0.1 + radius - overlap, 0}, {0, 0, 0}, radius, mass)});
    const md::WallLoad load = sim.observe().walls.at(0);
    const double tolerance = 1e-10 * normal;
    EXPECT_NEAR(load.force.x, 0.5 * normal, tolerance); // its highest point moves to the left
    EXPECT_NEAR(load.force.y, -normal, tolerance);
    EXPECT_NEAR(load.torque.z, -0.5 * normal * 0.1, tolerance);
    EXPECT_NEAR(load.power, 0.5 * normal * 0.1 * 2, tolerance);
}

TEST(Contacts, AddUpToTheForcesOfTheKernels) {
    const md::Simulation sim =
        make_simulation(lattice_scene(), lattice_grains(), simd::available_isas().back());
    const analysis::Snapshot snapshot = sim.snapshot();
    std::vector<Vec> sum(snapshot.size());
    std::int32_t last = -1;
    for (const analysis::Contact& c : sim.contacts()) {
        ASSERT_LT(c.i, c.j);
        ASSERT_GE(c.i, last);
        last = c.i;
        sum[static_cast<std::size_t>(c.i)] = sum[static_cast<std::size_t>(c.i)] + c.force;
        sum[static_cast<std::size_t>(c.j)] = sum[static_cast<std::size_t>(c.j)] - c.force;
        // The force is made of a push along the normal and the tangential force.
        EXPECT_LE(dot(c.force, c.normal), 0);
        EXPECT_NEAR(dot(c.force, {-c.normal.y, c.normal.x, 0}), c.tangential, 1e-12 * norm(c.force));
    }
    const std::vector<double> force = sim.forces(simd::Isa::scalar, scene::NeighbourMethod::brute_force);
    for (std::size_t n = 0; n < snapshot.size(); ++n) {
        const auto id = static_cast<std::size_t>(sim.state().id[n]);
        EXPECT_NEAR(force[n * sim.state().force_stride()], sum[id].x,
                    1e-11); // of 1e2 N, added in another order
        EXPECT_NEAR(force[n * sim.state().force_stride() + 1], sum[id].y, 1e-11);
    }
}
