// Whole simulations against closed forms and reference numbers of docs/physics.md 14.
#include "core/error.hpp"
#include "core/rng.hpp"
#include "md/simulation.hpp"

#include "md/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;
using namespace sandlane::test;

namespace {

// Relative normal velocity after a head-on collision over the one before.
double restitution(const scene::Scene& s, double radius, double mass, std::int64_t steps) {
    md::Simulation sim = simulate(s, {grain(0, {-radius * 1.0001, 0, 0}, {0.5, 0, 0}, radius, mass),
                                      grain(1, {radius * 1.0001, 0, 0}, {-0.5, 0, 0}, radius, mass)});
    sim.run(steps);
    const auto now = sim.snapshot();
    EXPECT_GT(now.x[1] - now.x[0], 2 * radius);
    return now.vx[1] - now.vx[0];
}

} // namespace

TEST(Collision, LinearDashpot) { // m_eff 5e-4, k 1e5, gamma 1: eps_cut 0.8084243834
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = 1e5;
    s.materials[0].damping = 1;
    s.md.dt = 2.2270159859e-4 / 5003.7; // first order in dt from the unresolved instants of touch and release
    EXPECT_NEAR(restitution(s, 0.01, 1e-3, 8000), 0.8084243834, 1e-4);
}

TEST(Collision, Viscoelastic) { // A = 1e-5: eps_cut 0.8932824518
    scene::Scene s = empty_scene();
    s.md.normal = scene::NormalLaw::viscoelastic;
    s.materials[0].young = 1e9;
    s.materials[0].poisson = 0.3;
    s.materials[0].dissipation = 1e-5;
    s.md.dt = 3.1710477879e-4 / 1003.7;
    EXPECT_NEAR(restitution(s, 0.01, 1.0471975512e-2, 2000), 0.8932824518, 1e-5);
}

TEST(Derived, CollisionTimesAndMasses) {
    scene::Scene s = empty_scene(); // equal spheres: t_c 3.2318662744e-4, xi_max 1.0980510051e-4
    s.md.normal = scene::NormalLaw::viscoelastic;
    s.materials[0].young = 1e9;
    s.md.max_speed = 1;
    const auto grains = {grain(0, {0, 0, 0}, {}, 0.01, 1.0471975512e-2)};
    const md::Needs needs = md::analyse(s, grains);
    EXPECT_NEAR(md::derive(s, needs).collision_time, 3.2318662744e-4, 1e-12);
}

TEST(SlowWall, BouncesToTheReferenceHeight) { // eps 0.8: height after 5 bounces 0.0107374182 for drop 0.1 m
    scene::Scene s = empty_scene();
    s.domain.gravity = {0, -9.81, 0};
    const double m = 1e-3, k = 1e6, z = 0.0743551;
    s.materials[0].stiffness = k;
    s.materials[0].damping = 2 * z * std::sqrt(k * m);
    s.walls = {floor_plane()};
    s.md.dt = 1e-6;
    md::Simulation sim = simulate(s, {grain(0, {0, 0.11, 0}, {}, 0.01, m)});
    double highest = 0;
    int bounces = 0;
    double before = -1;
    for (int n = 0; n < 12000 && bounces < 6; ++n) {
        sim.run(100);
        const auto now = sim.snapshot();
        if (before < 0 && now.vy[0] > 0) {
            ++bounces;
            highest = 0;
        }
        if (bounces == 5) highest = std::max(highest, now.y[0] - 0.01);
        if (bounces == 5 && now.vy[0] < 0) break;
        before = now.vy[0];
    }
    // The first-order error of the cut contact at t_c/100 is about 1e-3 of eps per bounce, ten times that in
    // the height.
    EXPECT_NEAR(highest, 0.0107374182, 0.02 * 0.0107374182);
}

TEST(Wall, RestingHertzOverlap) { // (m g/K)^{2/3} = 2.1934702590e-5 for K 1e6
    scene::Scene s = empty_scene();
    s.domain.gravity = {0, -9.81, 0};
    s.md.normal = scene::NormalLaw::viscoelastic;
    const double R = 0.01, m = 1.0471975512e-2, nu = 0.3;
    // K = (2/3) Y/(1 - nu^2) sqrt(R) against a plane of the same material
    s.materials[0].young = 1e6 / (2.0 / 3.0 * std::sqrt(R)) * (1 - nu * nu);
    s.materials[0].dissipation = 1e-4;
    s.walls = {floor_plane()};
    s.md.max_speed = 0.01;
    s.md.dt = 1e-6;
    md::Simulation sim = simulate(s, {grain(0, {0, R - 2.1934702590e-5, 0}, {}, R, m)});
    sim.run(2000);
    EXPECT_NEAR(R - sim.snapshot().y[0], 2.1934702590e-5, 1e-14);
}

TEST(Wall, SlidingDiscStartsToRoll) { // v/v0 = 1/(1 + c) = 2/3, Haff-Werner reaches it exponentially
    scene::Scene s = empty_scene();
    s.domain.gravity = {0, -9.81, 0};
    s.md.tangential = scene::TangentialLaw::haff_werner;
    s.materials[0].stiffness = 1e5;
    s.materials[0].damping = 5;
    s.materials[0].friction = 0.3;
    s.materials[0].tangential_damping = 50;
    s.walls = {floor_plane()};
    const double m = 0.01, R = 0.01, rest = m * 9.81 / 1e5;
    s.md.dt = 1e-5;
    md::Simulation sim = simulate(s, {grain(0, {-0.9, R - rest, 0}, {1, 0, 0}, R, m)});
    sim.run(30000);
    const auto now = sim.snapshot();
    EXPECT_NEAR(now.vx[0], 2.0 / 3.0, 1e-6);
    EXPECT_NEAR(now.omega[0], -2.0 / 3.0 / R, 1e-4);
}

TEST(Wall, ObliqueGrossSliding) { // eps 0.8, g_n = g_t = 1, mu 0.1: centre -0.18, contact point after
                                  // 0.46 (disc)
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::haff_werner;
    const double m = 1e-3, k = 1e6, z = 0.0743551022;
    s.materials[0].stiffness = k;
    s.materials[0].damping = 2 * z * std::sqrt(k * m);
    s.materials[0].friction = 0.1;
    s.materials[0].tangential_damping = 1000;
    s.walls = {floor_plane()};
    s.md.dt = 5e-8;
    md::Simulation sim = simulate(s, {grain(0, {0, 0.0100001, 0}, {1, -1, 0}, 0.01, m)});
    sim.run(4000);
    const auto now = sim.snapshot();
    EXPECT_NEAR(now.vy[0], 0.8, 2e-3);
    EXPECT_NEAR(now.vx[0], 1 - 0.18, 5e-4);
    EXPECT_NEAR(now.vx[0] + 0.01 * now.omega[0], 0.46, 2e-3);
}

// gross stick without loss: u_t'/u_t = cos(pi sqrt((k_t/k_n)(m_eff/m_t))), with m_t = m/3 for a disc on
// a wall.
TEST(Wall, ObliqueGrossStickOfTheSpring) {
    const struct {
        double ratio, expected; // k_t/k_n, u_t'/u_t
    } cases[] = {{2.0 / 7.0, -0.9729681456}, {1.0, 0.6661309236}};
    for (const auto& [ratio, expected] : cases) {
        scene::Scene s = empty_scene();
        s.md.tangential = scene::TangentialLaw::cundall_strack;
        const double m = 1e-3, k = 1e6, contact_time = std::numbers::pi / std::sqrt(k / m);
        s.materials[0].stiffness = k;
        s.materials[0].friction = 100; // never slides
        s.materials[0].tangential_stiffness = ratio * k;
        s.walls = {floor_plane()};
        s.md.dt = contact_time / 5003.7;
        md::Simulation sim = simulate(s, {grain(0, {0, 0.01000001, 0}, {0.1, -1, 0}, 0.01, m)});
        sim.run(5600);
        const auto now = sim.snapshot();
        EXPECT_NEAR(now.vy[0], 1, 1e-3);
        // First order in dt: the spring follows the surfaces by steps.
        EXPECT_NEAR((now.vx[0] + 0.01 * now.omega[0]) / 0.1, expected, 2e-3);
    }
}

// Statics: a disc in the corner of a tilted box comes to rest, which friction without a spring only
// approaches.
TEST(Wall, SpringsHoldADiscStill) {
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    const double m = 1e-2, k = 1e5, angle = 0.1;
    s.domain.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle), 0};
    s.materials[0].stiffness = k;
    s.materials[0].damping = 5;
    s.materials[0].friction = 0.5;
    s.materials[0].tangential_damping = 1;
    s.materials[0].tangential_stiffness = 2.0 / 7.0 * k;
    s.walls = {floor_plane(), floor_plane()};
    s.walls[1].name = "side";
    s.walls[1].points = {{0.02, 0, 0}};
    s.walls[1].normal = {-1, 0, 0};
    s.md.dt = 2e-5;
    md::Simulation sim = simulate(s, {grain(0, {0.0099, 0.01, 0}, {0, 0, 0}, 0.01, m)});
    sim.run(40000);
    const auto now = sim.snapshot();
    EXPECT_NEAR(now.vx[0], 0, 1e-12);
    EXPECT_NEAR(now.vy[0], 0, 1e-12);
    EXPECT_NEAR(now.omega[0], 0, 1e-10);
}

TEST(Lists, MemoryNeedsThem) {
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    s.md.neighbours = scene::NeighbourMethod::lattice;
    s.materials[0].stiffness = s.materials[0].tangential_stiffness = 1e5;
    s.materials[0].friction = 0.5;
    EXPECT_THROW(simulate(s, {grain(0, {0, 0, 0}, {}, 0.01, 1e-3)}), Error);
}

TEST(SlowConservation, MomentumAndEnergyOfElasticGas) { // 36 discs R 0.5, box 9, k 1e4, t = 10
    scene::Scene s = empty_scene();
    s.domain.lower = {0, 0, 0};
    s.domain.upper = {9, 9, 0};
    s.domain.periodic = {true, true};
    s.materials[0].stiffness = 1e4;
    s.md.max_speed = 5;
    s.md.neighbours = scene::NeighbourMethod::lattice;
    const double contact_time = std::numbers::pi / std::sqrt(1e4 / 0.5);
    s.md.dt = contact_time / 100;
    std::vector<scene::GrainState> grains;
    const Random random(3, Stream::velocity);
    for (int n = 0; n < 36; ++n) {
        const auto v = random.normal2(static_cast<std::uint64_t>(n));
        grains.push_back(grain(n, {0.75 + 1.5 * (n % 6), 0.75 + 1.5 * (n / 6), 0}, {v[0], v[1], 0}, 0.5, 1));
    }
    md::Simulation sim = simulate(s, grains);
    const md::Observables start = sim.observe();
    double worst = 0;
    for (int n = 0; n < 100; ++n) {
        sim.run(std::llround(10 / s.md.dt / 100));
        const md::Observables now = sim.observe();
        worst = std::max(worst, std::abs(now.kinetic + now.elastic - start.kinetic) / start.kinetic);
        EXPECT_NEAR(now.momentum.x, start.momentum.x, 1e-11);
        EXPECT_NEAR(now.momentum.y, start.momentum.y, 1e-11);
    }
    EXPECT_LT(worst, 5e-4); // the bound that the specification asserts at t_c/100
}

TEST(Start, ConsistentUnderGravity) { // 4.7: free fall is exact from the first step
    scene::Scene s = empty_scene();
    s.domain.gravity = {0, -9.81, 0};
    s.materials[0].stiffness = 1e5;
    s.md.dt = 1e-5;
    md::Simulation sim = simulate(s, {grain(0, {0, 0.5, 0}, {}, 0.01, 1e-3)});
    sim.run(1000);
    EXPECT_NEAR(sim.snapshot().vy[0], -9.81 * 0.01, 1e-13);
    EXPECT_NEAR(sim.snapshot().y[0], 0.5 - 0.5 * 9.81 * 1e-4, 1e-13);
}

TEST(Stress, OppositeForcesOnADisc) { // two opposite unit forces on R = 1: p = 0.3183098862
    scene::Scene s = empty_scene();
    s.domain.lower = {-4, -4, 0};
    s.domain.upper = {4, 4, 0};
    s.materials[0].stiffness = 1e3;
    s.md.dt = 1e-4;
    const double d = 2 - 1e-3; // overlap 1e-3: force 1
    const md::Simulation sim = simulate(
        s, {grain(0, {0, 0, 0}, {}, 1, 1), grain(1, {d, 0, 0}, {}, 1, 1), grain(2, {-d, 0, 0}, {}, 1, 1)});
    EXPECT_NEAR(sim.snapshot().pressure[0], 0.3183098862, 1e-10);
}

TEST(Guards, SharedSiteIsAnAnnouncedSwitch) {
    scene::Scene s = empty_scene(); // 100 x 20 sites of 0.02 m
    s.domain.lower.y = -0.2;
    s.domain.upper.y = 0.2;
    s.materials[0].stiffness = 1;
    s.md.max_speed = 0.1;
    s.md.dt = 1e-3;
    std::vector<scene::GrainState> grains;
    for (int n = 0; n < 40; ++n)
        grains.push_back(grain(n, {-0.9 + 0.04 * n, -0.1, 0}, {0, 0, 0}, 0.015, 1e-3));
    grains[6].position = {0.002, 0.002, 0}; // overlap 0.58 R, both in one site
    grains[7].position = {0.018, 0.016, 0};
    s.md.neighbours = scene::NeighbourMethod::lattice;
    md::Simulation tolerant = simulate(s, grains);
    ASSERT_EQ(tolerant.events().size(), 1U);
    EXPECT_NE(tolerant.events()[0].find("DELTA_EXCEEDED: grains 6 and 7"), std::string::npos);
    EXPECT_NE(tolerant.events()[0].find("link cells from here on"), std::string::npos);
    EXPECT_EQ(tolerant.plan().neighbours, scene::NeighbourMethod::link_cells);
    EXPECT_NEAR(tolerant.observe().largest_overlap, (0.03 - std::hypot(0.016, 0.014)) / 0.015, 1e-12);
}

TEST(Guards, CoincidentCentresNameBothGrains) { // d = 0: never a division that goes on
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = 1e5;
    s.md.dt = 1e-5;
    s.md.neighbours = scene::NeighbourMethod::link_cells;
    try {
        simulate(s, {grain(0, {0.5, 0, 0}, {}, 0.01, 1e-3), grain(1, {0.1, 0.2, 0}, {}, 0.01, 1e-3),
                     grain(2, {0.1, 0.2, 0}, {}, 0.01, 1e-3)});
        FAIL() << "no error";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::unstable);
        EXPECT_NE(std::string(e.what()).find("grains 1 and 2 overlap by 0.02 m"), std::string::npos)
            << e.what();
    }
}

TEST(Domain, LeavingGrainsAreRemovedAndCounted) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = 1e5;
    s.md.dt = 1e-5;
    std::vector<scene::GrainState> grains = {grain(0, {0.99, 0, 0}, {5, 0, 0}, 0.01, 1e-3),
                                             grain(1, {0, 0, 0}, {0, 0, 0}, 0.01, 1e-3)};
    md::Simulation sim = simulate(s, grains);
    sim.run(1000);
    EXPECT_EQ(sim.removed(), 1);
    EXPECT_EQ(sim.snapshot().id, std::vector<std::int64_t>{1});
    s.domain.outside = scene::Outside::error;
    md::Simulation strict = simulate(s, grains);
    EXPECT_THROW(strict.run(1000), Error);
}

TEST(Valid, NoGrainsAndOneGrain) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = 1e5;
    md::Simulation none = simulate(s, {});
    none.run(10);
    EXPECT_EQ(none.step(), 10);
    md::Simulation one = simulate(s, {grain(0, {0, 0, 0}, {1, 0, 0}, 0.01, 1e-3)});
    one.run(10);
    EXPECT_NEAR(one.snapshot().x[0], 10 * one.plan().dt, 1e-15);
}
