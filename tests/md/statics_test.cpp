// Grains that bounce on, swing on and rest on others: reference numbers of the specification (9.7).
#include "md/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;
using namespace sandlane::test;

namespace {

constexpr double g = 9.81;

scene::Scene under_gravity() {
    scene::Scene s = empty_scene();
    s.domain.gravity = {0, -g, 0};
    s.walls = {floor_plane()};
    return s;
}

// Time at which the vertical velocity of grain 0 next passes zero from above, by a straight line within the
// step.
double time_of_top(md::Simulation& sim) {
    double before = sim.snapshot().vy[0];
    for (;;) {
        sim.run(1);
        const double now = sim.snapshot().vy[0];
        if (before > 0 && now <= 0) return sim.time() - sim.plan().dt * now / (now - before);
        before = now;
    }
}

} // namespace

// Elastic spring, k 1e4, m 1e-3, dropped by 0.1 m: period 0.2865634841, xi_max 4.4392677813e-4.
TEST(Statics, BouncesOnASpring) {
    scene::Scene s = under_gravity();
    s.materials[0].stiffness = 1e4;
    s.md.dt = 2e-6;
    md::Simulation sim = simulate(s, {grain(0, {0, 0.11, 0}, {}, 0.01, 1e-3)});
    double lowest = 1, fastest = 0;
    for (double now = 0; now <= 0 || sim.time() < 0.1;) {
        sim.run(sim.time() < 0.1425 ? 50 : 1);
        now = sim.snapshot().vy[0];
        lowest = std::min(lowest, sim.snapshot().y[0]);
        fastest = std::max(fastest, -now);
    }
    // Touching within a step of w dt = 6e-3 costs (w dt)^2 of the speed and the overlap, at most.
    EXPECT_NEAR(fastest, 1.4007141036, 4e-5);
    EXPECT_NEAR(0.01 - lowest, 4.4392677813e-4, 4e-5 * 4.4e-4);
    EXPECT_NEAR(time_of_top(sim), 0.2865634841, 1e-5);
}

// At rest a Hertzian contact is a spring: w = 819.05724851 for m 1.0471975512e-2, K 1e6.
TEST(Statics, SwingsOnAHertzianContact) {
    scene::Scene s = under_gravity();
    s.md.normal = scene::NormalLaw::viscoelastic;
    const double radius = 0.01, rest = 2.1934702590e-5;
    s.materials[0].young = 1e6 / (2.0 / 3 * std::sqrt(radius)) * (1 - 0.09);
    s.materials[0].poisson = 0.3;
    s.md.max_speed = 0.01;
    s.md.dt = 1e-6;
    md::Simulation sim = simulate(s, {grain(0, {0, radius - 1.001 * rest, 0}, {}, radius, 1.0471975512e-2)});
    sim.run(10);
    const double first = time_of_top(sim);
    for (int n = 0; n < 4; ++n) (void)time_of_top(sim);
    const double fifth = time_of_top(sim);
    // The anharmonic shift is of the square of the amplitude, 1e-6.
    EXPECT_NEAR(2 * std::numbers::pi * 5 / (fifth - first), 819.05724851, 2e-6 * 819);
}

namespace {

// Ten grains on top of each other, m 0.01, R 0.01, k 1e5, at rest: contact n carries the weight of those
// above.
std::vector<scene::GrainState> column(double amplitude) {
    std::vector<scene::GrainState> grains;
    double y = 0;
    for (int n = 0; n < 10; ++n) {
        y += (n == 0 ? 0.01 : 0.02) - (10 - n) * 0.01 * g / 1e5;
        // Lowest mode of a chain with one fixed end: sin(theta (n + 1)), theta = pi/21.
        grains.push_back(
            grain(n, {0, y + amplitude * std::sin(std::numbers::pi / 21 * (n + 1)), 0}, {}, 0.01, 0.01));
    }
    return grains;
}

scene::Scene column_scene() {
    scene::Scene s = under_gravity();
    s.materials[0].stiffness = 1e5;
    s.md.dt = 1e-5;
    return s;
}

} // namespace

TEST(Statics, AColumnComesToRest) { // bottom overlap 9.81e-6, top centre height 0.1899460450
    scene::Scene s = column_scene();
    s.materials[0].damping = 30;
    std::vector<scene::GrainState> grains = column(0);
    for (int n = 0; n < 10; ++n) grains[static_cast<std::size_t>(n)].position.y = 0.01 + 0.02 * n;
    md::Simulation sim = simulate(s, grains);
    sim.run(100000); // the lowest mode decays at gamma w^2/(2 k) = 33/s
    const analysis::Snapshot now = sim.snapshot();
    EXPECT_NEAR(0.01 - now.y[0], 9.81e-6, 1e-14);
    EXPECT_NEAR(now.y[9], 0.1899460450, 5e-11); // the digits that are given
    EXPECT_NEAR(now.vy[9], 0, 1e-11);           // rounding of the overlap, 3e-17 m, times w_max
}

TEST(Statics, AColumnSwingsInItsLowestMode) { // w = 472.63461098
    const double amplitude = 1e-7, w = 472.63461098;
    scene::Scene s = column_scene();
    s.md.dt = 2 * std::numbers::pi / w / 2000;
    md::Simulation sim = simulate(s, column(amplitude));
    const double rest = column(0)[9].position.y, up = sim.snapshot().y[9] - rest;
    sim.run(1500); // three quarters: through the middle, where a shift of the frequency shows most
    // Starting with higher derivatives of zero costs some (w_max dt)^3, w_max = 6e3.
    EXPECT_NEAR((sim.snapshot().y[9] - rest) / up, 0, 2e-5);
    EXPECT_NEAR(sim.snapshot().vy[9] / (up * w), 1, 2e-5);
}

TEST(Statics, ADiscOnTwoDiscs) { // 0.5773502692 m g each
    scene::Scene s = under_gravity();
    s.materials[0].stiffness = 1e7;
    s.materials[0].damping = 200;
    s.walls[0] = scene::Wall();
    s.walls[0].kind = scene::WallKind::grains;
    s.walls[0].radius = 0.01;
    s.walls[0].points = {{-0.01, 0, 0}, {0.01, 0, 0}};
    s.md.dt = 1e-6;
    const double mass = 0.01;
    md::Simulation sim = simulate(s, {grain(0, {0, 0.01 * std::numbers::sqrt3, 0}, {}, 0.01, mass)});
    sim.run(20000);
    const analysis::Contacts contacts = sim.contacts();
    ASSERT_EQ(contacts.size(), 2U);
    for (const analysis::Contact& c : contacts) // the overlap, 6e-7 R, widens the angle as much
        EXPECT_NEAR(norm(c.force), 0.5773502692 * mass * g, 1e-6 * mass * g);
}
