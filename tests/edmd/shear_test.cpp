// Uniform shear flow between images that glide (Lees and Edwards): single contacts, both algorithms against
// each other, viscosities and granular temperatures against theory.
#include "analysis/gas_theory.hpp"
#include "edmd/support.hpp"
#include "laws/collision.hpp"
#include "laws/pair_time.hpp"

using namespace sandlane;
using test::widest;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

edmd::Setup sheared(int dimension, double phi, double eps, std::uint32_t n, double rate) {
    edmd::Setup s = test::hard_gas(dimension, phi, eps, n);
    s.shear = rate;
    return s;
}

} // namespace

TEST(EdmdShear, TimeOfTheSpecification) { // (12.17)
    const laws::Flight<double> i{{6, 9.2, 0}, {0.4, 0.5, 0}, 2.3}, j{{5, 0.3, 0}, {0, 0.1, 0}, 2.3};
    const double t = laws::sheared_pair_time<2, double>(i, j, {0, 10, 0}, 1, 1, 0, 0.5, never);
    EXPECT_NEAR(t - 2.3, 0.290395297530, 1e-11);
}

// Two discs that meet across the side: the upper one sees the image of the lower one, which moves faster by
// one box height times the rate, and both come out in the box.
TEST(EdmdShear, CollisionThroughTheSide) {
    edmd::Setup s;
    s.dimension = 2;
    s.upper[0] = s.upper[1] = 10;
    s.shear = 0.1;
    std::vector<edmd::Particle> particles(2);
    particles[1].id = 1;
    particles[0].place = {5, 8.9, 0};
    particles[0].velocity = {0, 1, 0};
    particles[1].place = {4, 1.9, 0}; // the image starts at (4, 11.9) and moves by (1, -1)
    particles[1].velocity = {0, -1, 0};
    for (const bool simple : {true, false}) {
        std::unique_ptr<edmd::Algorithm> run;
        if (simple)
            run = std::make_unique<edmd::SimpleAlgorithm>(s, particles);
        else
            run = std::make_unique<edmd::Simulation>(s, particles, widest(), 1);
        ASSERT_EQ(run->run(1, 3), 1);
        EXPECT_NEAR(run->time(), 1, 1e-12); // straight above each other, the surfaces a unit apart
        const auto after = run->particles();
        EXPECT_NEAR(after[0].velocity[1], -1, 1e-12);
        EXPECT_NEAR(after[1].velocity[1], 1, 1e-12);
        EXPECT_NEAR(after[0].velocity[0], 0, 1e-12); // smooth
        EXPECT_NEAR(after[1].place[1], 0.9, 1e-12);
    }
}

TEST(EdmdShear, BothAlgorithms) {
    for (const int dimension : {2, 3})
        for (const double rate : {0.4, -0.15, 3.0}) {
            SCOPED_TRACE(testing::Message() << dimension << " " << rate);
            const edmd::Setup s = sheared(dimension, 0.25, 0.9, 96, rate);
            test::expect_same_events(s, edmd::make_particles(s, {96}, 1.0), 1500);
        }
}

TEST(EdmdShear, BothAlgorithmsWithAllElse) {
    edmd::Setup s = sheared(2, 0.3, 0.9, 100, 0.5);
    s.classes = {{0.5, 1, 0.5}, {0.2, 0.3, 0.5}};
    s.rough = true;
    s.tangential = 0.1;
    s.friction = 0.4;
    s.contact_time = 1e-3;
    s.kicks = 0.05;
    s.kick_interval = 0.2;
    test::expect_same_events(s, edmd::make_particles(s, {70, 40}, 1.0, 0.5), 2000);
    s = sheared(3, 0.02, 0.7, 64,
                1.0); // so dilute that particles go through many boxes between two collisions
    test::expect_same_events(s, edmd::make_particles(s, {64}, 1.0), 1500);
    s = sheared(2, 0.85, 1, 120, 0.3);
    test::expect_same_events(s, edmd::make_particles(s, {120}, 1.0), 2000);
}

TEST(EdmdShear, CellsThreadsAndDivisionOfTheRun) {
    const edmd::Setup s = sheared(2, 0.2, 0.9, 200, 0.5);
    const auto particles = edmd::make_particles(s, {200}, 1.0);
    edmd::Simulation once(s, particles, widest(), 1);
    once.run(6000);
    edmd::Setup other = s;
    other.cell_edge = 1.9;
    edmd::Simulation same(other, particles, simd::Isa::scalar, 3);
    for (int k = 0; k < 60; ++k) {
        same.run(100);
        (void)same.particles();
    }
    EXPECT_EQ(once.state_hash(), same.state_hash());
    for (const edmd::Particle& p : once.particles()) {
        EXPECT_GE(p.place[1], s.lower[1]);
        EXPECT_LE(p.place[1], s.upper[1]);
    }
    EXPECT_GT(once.tally().smallest_gap, -1e-12);
}

// Momentum stays, and the flow is the one that was imposed.
TEST(EdmdShear, KeepsTheFlow) {
    const std::uint32_t n = 600;
    const edmd::Setup s = sheared(3, 0.1, 0.8, n, 0.3);
    edmd::Simulation gas(s, edmd::make_particles(s, {n}, 1.0), widest(), 1);
    gas.run(60 * n);
    double slope = 0, square = 0;
    for (int f = 0; f < 20; ++f) {
        gas.run(n);
        for (const edmd::Particle& p : gas.particles()) {
            const double y = p.place[1] - 0.5 * (s.lower[1] + s.upper[1]);
            slope += p.velocity[0] * y;
            square += y * y;
        }
    }
    // Particles by which the slope is known: 12000, sqrt(12 T/N)/L = 0.004 of 0.3, and the waves of the flow.
    EXPECT_NEAR(slope / square / s.shear, 1, 0.1);
}

// Enskog's viscosity of discs (Gass 1971) and spheres, of gases under slow shear, which heats them:
// eta/sqrt(T) of 2000 particles for some 600 collisions of each scatters by 2 %.
TEST(SlowEdmdShear, EnskogsViscosity) {
    for (const int d : {2, 3}) {
        const std::uint32_t n = 2000;
        const double phi = d == 2 ? 0.2 : 0.1, pi = std::numbers::pi, g = laws::contact_correlation(d, phi);
        const double y = 2 * phi * g, square = 1 + 1.6 * phi * g;
        const double expected = d == 2 ? 1.022 / (2 * std::sqrt(pi)) * 2 * phi * (1 / y + 1 + 0.8729 * y)
                                       : 1.016 * 5 / (16 * std::sqrt(pi)) *
                                             (square * square / g + 768 / (25 * pi) * phi * phi * g);
        edmd::Setup s = sheared(d, phi, 1, n, 0.1);
        edmd::Simulation gas(s, edmd::make_particles(s, {n}, 1.0), widest(), 1);
        gas.run(5 * n);
        double sum = 0, time = gas.time(), shear = gas.tally().shear, heat = 0, work = 0;
        const double before = edmd::observe(s, gas.particles()).energy;
        auto last = edmd::observe(s, gas.particles());
        const int frames = 1200;
        for (int f = 0; f < frames; ++f) {
            gas.run(n / 4);
            const auto o = edmd::observe(s, gas.particles());
            const double dt = gas.time() - time;
            const double stress =
                -(0.5 * (o.flux + last.flux) + (gas.tally().shear - shear) / dt) / s.volume();
            sum += stress / s.shear / std::sqrt(0.5 * (o.temperature + last.temperature)) / frames;
            work += stress * s.shear * s.volume() * dt;
            time = gas.time(), shear = gas.tally().shear;
            last = o;
        }
        heat = last.energy - before;
        EXPECT_NEAR(sum / expected, 1, 0.06) << d;
        EXPECT_NEAR(heat / work, 1, 0.05) << d; // the stress works what the gas gains
    }
}

// A dilute granular gas comes to the temperature at which collisions take what the shear gives: Grad's
// moments, as for Monte Carlo (tests/dsmc/exact_test.cpp), within 10 %, and the noise of 1000 particles.
TEST(SlowEdmdShear, GranularTemperature) {
    const double eps = 0.8, phi = 0.01;
    const std::uint32_t n = 1000;
    const double g = laws::contact_correlation(3, phi), density = 6 * phi / std::numbers::pi;
    const double zeta = 5.0 / 12 * (1 - eps * eps), beta = (1 + eps) / 2 * (1 - (1 - eps) / 3);
    const double a = (beta + zeta) * std::sqrt(1.5 * zeta / beta);
    const double rate = a * 16.0 / 5 * density * g * std::sqrt(std::numbers::pi); // steady at T = 1
    const edmd::Setup s = sheared(3, phi, eps, n, rate);
    edmd::Simulation gas(s, edmd::make_particles(s, {n}, 1.0), widest(), 1);
    gas.run(30 * n);
    double temperature = 0;
    constexpr int frames = 100;
    for (int f = 0; f < frames; ++f) {
        gas.run(n / 2);
        temperature += edmd::observe(s, gas.particles()).temperature / frames;
    }
    EXPECT_NEAR(temperature, 1, 0.13);
}
