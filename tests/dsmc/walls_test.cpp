// Walls: times of hits, heated, moving and reflecting sides (specifications 6, 10.11; event-driven 5.3,
// 7, 12.7).
#include "dsmc/support.hpp"
#include "laws/wall_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;

TEST(Walls, TimesOfTheSpecification) {
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_NEAR(laws::flat_wall_time(1, 0, -9.81), 0.451523640986, 1e-12);
    EXPECT_NEAR(laws::flat_wall_time(1, 3, -9.81), 0.851148455661, 1e-12);
    EXPECT_NEAR(laws::flat_wall_time(1, -3, -9.81), 0.239527660554, 1e-12);
    EXPECT_NEAR(laws::flat_wall_time(1, -5, 9.81), 0.273243353624, 1e-12);
    EXPECT_EQ(laws::flat_wall_time(1, -4, 9.81), inf);
    EXPECT_NEAR(laws::flat_wall_time(0, 2, -9.81), 0.407747196738, 1e-12);
    EXPECT_EQ(laws::flat_wall_time(-1e-9, -1, 0), 0);
    EXPECT_EQ(laws::flat_wall_time(1, 1, 0), inf);
}

// Specification of event-driven dynamics 12.16: z_w = B sin(Omega t).
TEST(Walls, OscillatingWall) {
    struct Case {
        double z, v, g, b, omega, time, after;
    };
    for (const Case& c : {Case{1, 0, -1, .1, 10, 1.354338788432, 2.281949617564},
                          Case{.3, 0, -1, .1, 10, 0.692739044945, 2.142662165644},
                          Case{.2, -.2, -1, .15, 4, 0.240409821490, 1.048649851938}}) {
        const laws::Oscillation wall{c.b, c.omega / (2 * std::numbers::pi), 0};
        const double t = laws::oscillating_wall_time(c.z, c.v, c.g, wall, 0, 10);
        EXPECT_NEAR(t, c.time, 1e-10);
        const double speed = wall.velocity(t);
        EXPECT_NEAR(speed - 0.9 * (c.v + c.g * t - speed), c.after, 1e-9);
    }
    const laws::Oscillation wall{.1, 10 / (2 * std::numbers::pi), 0};
    EXPECT_NEAR(laws::oscillating_wall_time(0, 2, -1, wall, 0, 10), 3.950806240323, 1e-9); // starts on it
    EXPECT_GT(laws::oscillating_wall_time(10, 0, -1, wall, 0, 1), 1);                      // none in time
}

// Speeds of what a wall at T_w = m = 1 sends back (12.14): mean, square, fourth power, 5 sigma of 2e5 draws.
TEST(Walls, FluxOfAHeatedWall) {
    double sum[4] = {};
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
        const double v = laws::flux_speed((i + 0.5) / n); // a lattice of numbers: no noise
        sum[0] += v / n, sum[1] += v * v / n, sum[2] += v * v * v / n, sum[3] += v * v * v * v / n;
    }
    EXPECT_NEAR(sum[0], 1.253314137, 1e-4);
    EXPECT_NEAR(sum[1], 2, 1e-4);
    EXPECT_NEAR(sum[2], 3.759942412, 1e-3);
    EXPECT_NEAR(sum[3], 8, 5e-3);
}

namespace {

// A slab between heated walls along x.
dsmc::Setup slab(double lower, double upper, double weight, std::int32_t cells) {
    dsmc::Setup s;
    s.upper[0] = s.upper[1] = s.upper[2] = 10;
    s.cells[0] = cells;
    s.walls.periodic[0] = false;
    for (auto& side : s.walls.side[0]) side.kind = simd::GasSide::Kind::heated;
    s.walls.side[0][0].thermal_speed = std::sqrt(lower);
    s.walls.side[0][1].thermal_speed = std::sqrt(upper);
    s.weight = weight;
    s.dt = 0.3;
    return s;
}

} // namespace

// Without collisions, between T = 1 and 4: uniform density, T = 2 in every component, energy flux 3.1915 n
// (specification 10.11). Averages over many crossings, a few standard errors.
TEST(Walls, FreeMolecularSlabSlow) {
    const std::uint32_t n = 20000;
    const dsmc::Setup s = slab(1, 4, 1e-12, 10);
    dsmc::Simulation gas(s, dsmc::maxwellian(s, n, 2), simd::available_isas().back(), 1);
    gas.run(300);
    std::array<double, 3> temperature{};
    double lower_half = 0, flux = 0;
    constexpr int frames = 60;
    for (int f = 0; f < frames; ++f) {
        gas.run(10);
        const auto o = gas.observe();
        for (std::size_t d = 0; d < 3; ++d) temperature[d] += o.directions[d] / frames;
        for (const auto& p : gas.particles()) {
            lower_half += p.place[0] < 5 ? 1.0 / n / frames : 0;
            flux += 0.5 * p.velocity[0] *
                    (p.velocity[0] * p.velocity[0] + p.velocity[1] * p.velocity[1] +
                     p.velocity[2] * p.velocity[2]) /
                    n / frames;
        }
    }
    for (const double t : temperature) EXPECT_NEAR(t, 2, 0.02);
    EXPECT_NEAR(lower_half, 0.5, 0.004);
    EXPECT_NEAR(flux, -3.191538, 0.1);
}

// Elastic gas between equal walls: it keeps their temperature, is uniform and Maxwellian.
TEST(Walls, EquilibriumWithEqualWallsSlow) {
    const std::uint32_t n = 20000;
    const dsmc::Setup s = slab(1.5, 1.5, 0.005, 10);
    dsmc::Simulation gas(s, dsmc::maxwellian(s, n, 1), simd::available_isas().back(), 1);
    gas.run(400);
    double temperature = 0, a2 = 0;
    constexpr int frames = 40;
    for (int f = 0; f < frames; ++f) {
        gas.run(10);
        temperature += gas.observe().temperature / frames;
        a2 += gas.observe().fourth / frames;
    }
    EXPECT_NEAR(temperature, 1.5,
                0.015); // the walls exchange energy: it fluctuates as sqrt(2/(3 n)) and slowly
    EXPECT_NEAR(a2, 0, 0.004);
    EXPECT_GT(gas.counts().collisions, 100000);
}

// Elastic walls at rest keep the energy, with gravity that of the sum; the box keeps its particles.
TEST(Walls, ElasticBoxUnderGravityKeepsTheEnergy) {
    dsmc::Setup s = test::gas(3, 1, 4000, 8);
    s.walls.periodic[0] = s.walls.periodic[1] = s.walls.periodic[2] = false;
    s.gravity[2] = -0.5;
    s.dt = 0.2;
    dsmc::Simulation gas(s, dsmc::maxwellian(s, 4000, 1), simd::available_isas().back(), 1);
    const auto energy = [&] {
        double sum = 0;
        for (const auto& p : gas.particles()) {
            for (std::size_t d = 0; d < 3; ++d) {
                EXPECT_GE(p.place[d], s.lower[d]);
                EXPECT_LE(p.place[d], s.upper[d]);
                sum += 0.5 * p.velocity[d] * p.velocity[d];
            }
            sum += 0.5 * p.place[2];
        }
        return sum;
    };
    const double before = energy();
    gas.run(300);
    EXPECT_EQ(gas.particles().size(), 4000U);
    EXPECT_EQ(gas.counts().stuck, 0);
    EXPECT_NEAR(energy() / before, 1, 1e-11); // 300 steps of rounding
}

// What a wall gives is what the gas gains (no collisions that lose energy, no gravity).
TEST(Walls, WallEnergyIsBooked) {
    dsmc::Setup s = test::gas(2, 1, 3000, 10);
    s.walls.periodic[1] = false;
    s.walls.side[1][0].motion = {0.4, 0.5, 0.2};
    s.walls.side[1][1].kind = simd::GasSide::Kind::heated;
    s.walls.side[1][1].thermal_speed = 2;
    dsmc::Simulation gas(s, dsmc::maxwellian(s, 3000, 1), simd::available_isas().back(), 1);
    const double before = gas.observe().energy;
    gas.run(200);
    EXPECT_GT(gas.wall_energy(), 0);
    EXPECT_NEAR(gas.observe().energy - before, gas.wall_energy(), 1e-9 * before);
}

// Particles on faces of cells and at the upper edge of the box, and one that crosses a periodic box often.
TEST(Walls, FacesAndImages) {
    dsmc::Setup s = test::gas(3, 1, 27, 3);
    s.weight = 1e-15;
    s.dt = 0.25;
    std::vector<dsmc::Particle> start(3);
    start[1].id = 1;
    start[2].id = 2;
    start[0].place = {s.upper[0], s.upper[1], s.upper[2]};
    start[1].place = {s.edge(0), 2 * s.edge(1), 0};
    start[2].place = {1, 1, 1};
    start[2].velocity = {2, 0, -1};
    dsmc::Simulation gas(s, start, simd::available_isas().back(), 1);
    gas.run(4000);
    const auto end = gas.particles();
    ASSERT_EQ(end.size(), 3U);
    const double x = 1 + 2 * gas.time(), z = 1 - gas.time();
    EXPECT_NEAR(end[2].place[0] + end[2].image[0] * s.upper[0], x, 1e-9 * x);
    EXPECT_NEAR(end[2].place[2] + end[2].image[2] * s.upper[2], z, 1e-9 * x);
    EXPECT_LT(end[2].image[2], -100);
}
