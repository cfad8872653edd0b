// Pistons, curved walls, the thermostat of white noise and growing radii: single events against the numbers
// of the specification (12.16), both algorithms against each other, gases against theory.
#include "analysis/gas_theory.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
#include "edmd/support.hpp"
#include "laws/collision.hpp"
#include "laws/pair_time.hpp"

#include <gtest/gtest.h>

#include <functional>

using namespace sandlane;

namespace {

using test::expect_same_events;
using test::widest;

constexpr double never = std::numeric_limits<double>::infinity();

edmd::Particle at(std::array<double, 3> place, std::array<double, 3> velocity) {
    edmd::Particle p;
    p.place = place;
    p.velocity = velocity;
    return p;
}

double temperature(const edmd::Algorithm& run) {
    return edmd::observe(run.setup(), run.particles()).temperature;
}

// A box with walls all around and a curved one.
edmd::Setup vessel(int dimension, double half, edmd::Curved curved) {
    edmd::Setup s;
    s.dimension = dimension;
    for (int d = 0; d < 3; ++d) s.lower[d] = -half, s.upper[d] = half, s.periodic[d] = false;
    s.curved = {curved};
    return s;
}

} // namespace

TEST(EdmdWalls, Piston) {
    edmd::Setup s = vessel(2, 100, {});
    s.curved.clear();
    s.side[1][0].speed = 0.5;
    s.side[1][0].eps_n = 0.8;
    s.lower[1] = -0.5;
    for (const bool simple : {true, false}) {
        std::unique_ptr<edmd::Algorithm> run;
        const std::vector<edmd::Particle> particles = {at({0, 3, 0}, {0.25, -1, 0})};
        if (simple)
            run = std::make_unique<edmd::SimpleAlgorithm>(s, particles);
        else
            run = std::make_unique<edmd::Simulation>(s, particles, widest(), 1);
        ASSERT_EQ(run->run(1), 1);
        EXPECT_NEAR(run->time(), 2, 1e-14);
        EXPECT_NEAR(run->particles()[0].place[1], 1, 1e-14);
        EXPECT_NEAR(run->particles()[0].velocity[1], 1.7, 1e-14); // -eps v + (1 + eps) V
        EXPECT_EQ(run->particles()[0].velocity[0], 0.25);
        EXPECT_NEAR(run->tally().wall_energy, 0.5 * (1.7 * 1.7 - 1), 1e-14);
    }
}

// It goes on while a disc is away: up to the wall at the far end and back.
TEST(EdmdWalls, PistonMeetsWhoComesBack) {
    edmd::Setup s = vessel(2, 100, {});
    s.curved.clear();
    s.side[1][0].speed = 0.5;
    s.lower[1] = -0.5;
    const double end = s.upper[1] - 0.5, far = 2 + (end - 1) / 2; // thrown back with 2 at t = 2, y = 1
    edmd::Simulation run(s, {at({0, 3, 0}, {0, -1, 0})}, widest(), 1);
    ASSERT_EQ(run.run(3), 3);
    EXPECT_NEAR(run.time(), (end + 2 * far) / 2.5, 1e-12); // end - 2 (t - far) = t/2
    EXPECT_NEAR(run.particles()[0].velocity[1], 3, 1e-14);
}

// A disc that rolls along a rough wall has no slip there, whatever the restitution does with slip.
TEST(EdmdWalls, RollingDiscsDoNotSlip) {
    edmd::Setup s = vessel(2, 100, {});
    s.curved.clear();
    s.rough = true;
    s.side[1][0].eps_t = -0.5;
    edmd::Particle disc = at({0, 0, 0}, {0.3, -1, 0});
    disc.spin = {0, 0, -0.6}; // R 0.5
    edmd::Simulation run(s, {disc}, widest(), 1);
    ASSERT_EQ(run.run(1), 1);
    EXPECT_NEAR(run.particles()[0].velocity[0], 0.3, 1e-15);
    EXPECT_NEAR(run.particles()[0].velocity[1], 1, 1e-15);
    EXPECT_NEAR(run.particles()[0].spin[2], -0.6, 1e-15);
}

// With the same random numbers a disc four times as heavy leaves a hot wall half as fast.
TEST(EdmdWalls, HotWallsGiveHeavyDiscsTheSameEnergy) {
    edmd::Setup s = vessel(2, 100, {});
    s.curved.clear();
    s.side[1][0].kind = edmd::Side::Kind::heated;
    s.side[1][0].temperature = 3;
    const auto leaves = [&](double mass) {
        s.classes[0].mass = mass;
        edmd::Simulation run(s, {at({0, 0, 0}, {0, -1, 0})}, widest(), 1);
        EXPECT_EQ(run.run(1), 1);
        return run.particles()[0].velocity;
    };
    const auto light = leaves(1), heavy = leaves(4);
    EXPECT_GT(light[1], 0);
    for (std::size_t d = 0; d < 2; ++d) EXPECT_NEAR(2 * heavy[d], light[d], 1e-15) << d;
}

// What a slow impact would have lost is booked as kept: m_eff (1 - eps^2) g^2/2.
TEST(EdmdEvents, WhatSlowImpactsKeep) {
    edmd::Setup s = vessel(2, 100, {});
    s.curved.clear();
    s.restitution.eps = 0.6;
    s.elastic_speed = 10;
    edmd::Particle other = at({3, 0, 0}, {-1, 0, 0});
    other.id = 1;
    edmd::Simulation run(s, {at({0, 0, 0}, {1, 0, 0}), other}, widest(), 1);
    ASSERT_EQ(run.run(1), 1);
    EXPECT_NEAR(run.tally().kept, 0.5 * 0.5 * (1 - 0.36) * 4, 1e-14);
}

// A slow piston compresses an elastic gas as T V^(2/d) = const, V of a thin gas.
TEST(EdmdWalls, SlowPistonCompressesAdiabatically) {
    edmd::Setup s = test::hard_gas(2, 0.01, 1, 400);
    const double length = s.length(0);
    s.periodic[0] = false;
    s.side[0][0].speed = 0.01 * length / 10;
    edmd::Simulation gas(s, edmd::make_particles(s, {400}, 1.0), widest(), 1);
    gas.run(std::int64_t{1} << 40, 500); // half of the volume, in steps of the wall that are slow for the gas
    EXPECT_NEAR(gas.time(), 500, 1e-9);
    // The centres lose a diameter to the walls, and their excluded volume: 3 %.
    EXPECT_NEAR(temperature(gas) / 2, 1, 0.05);
    for (const edmd::Particle& p : gas.particles()) EXPECT_GT(p.place[0], 0.5 * length + 0.5 - 1e-9);
    EXPECT_NEAR(gas.tally().wall_energy, 400 * (temperature(gas) - 1), 0.05 * 400);
}

// Times of the specification; particles are points there, here the walls are half a unit further.
TEST(EdmdWalls, TimesAtCurvedWalls) {
    const auto time = [](Vector<double> r, Vector<double> v, Vector<double> g, double distance,
                         bool container) { return laws::curved_wall_time(r, v, g, distance, container); };
    EXPECT_NEAR(time({0.5, 0.25, 0}, {1, 0.5, 0}, {0, 0, 0}, 2, true), 1.288854382000, 1e-11);
    EXPECT_NEAR(time({0, 2, 0}, {0.3, 0, 0}, {0, -1, 0}, 1, false), 1.486575539619, 1e-11);
    EXPECT_EQ(time({0, 2, 0}, {0.75, 0, 0}, {0, -1, 0}, 1, false), never);
    EXPECT_EQ(time({0, 2, 0}, {0, 1, 0}, {0, 0, 0}, 1, false), never);
    EXPECT_EQ(time({0, 2, 0}, {0, -1, 0}, {0, 0, 0}, 1, false), 1);
    // A weak field changes little, of either kind.
    EXPECT_NEAR(time({0.5, 0.25, 0}, {1, 0.5, 0}, {0, -1e-12, 0}, 2, true), 1.288854382000, 1e-10);
    EXPECT_NEAR(time({0, 2, 0.1}, {0, -1, 0}, {0, -1e-12, 0}, 1, false), 2 - std::sqrt(1 - 0.01), 1e-10);
    // Straight up from the bottom of a bowl, and back; and as little as rounding leaves.
    for (const double v : {2.0, 1e-8}) {
        EXPECT_NEAR(time({0, -1, 0}, {0, v, 0}, {0, -10, 0}, 1, true) / (v / 5), 1, 1e-9);
        EXPECT_NEAR(time({0, 1, 0}, {0, v, 0}, {0, -10, 0}, 1, false) / (v / 5), 1, 1e-9);
    }
    EXPECT_EQ(time({0, -1, 0}, {0, -1, 0}, {0, -10, 0}, 1, true), 0);
    // From rest at the wall, straight through the middle, and at rest everywhere.
    EXPECT_NEAR(time({0, 1, 0}, {0, 0, 0}, {0, -4, 0}, 1, true), 1, 1e-12);
    EXPECT_EQ(time({0, 0.5, 0}, {0, 0, 0}, {0, 0, 0}, 1, true), never);
}

// Every flight hits where it should: the root is where the parabola meets the circle, and no earlier.
TEST(EdmdWalls, FirstOfFourRoots) {
    for (std::uint32_t n = 0; n < 2000; ++n) {
        const auto draw = [&](std::uint32_t k) {
            const auto w = philox({n, k, 0, 0}, {3, 4});
            return 2 * unit_number(w[0], w[1]) - 1;
        };
        const bool container = n % 2 == 0;
        Vector<double> r{draw(0), draw(1), draw(2)};
        const double away = std::sqrt(dot(r, r));
        if (container ? away >= 1 : away <= 0.1) continue;
        const double distance = container ? 1 : 0.9 * away;
        const Vector<double> v{draw(3), draw(4), draw(5)}, g{draw(6), draw(7), draw(8)};
        const double t = laws::curved_wall_time(r, v, g, distance, container);
        const auto gap = [&](double s) {
            const Vector<double> x = r + s * v + (0.5 * s * s) * g;
            const double d = std::sqrt(dot(x, x)) - distance;
            return container ? -d : d;
        };
        const double until = t == never ? 20 : t;
        if (t < never) {
            EXPECT_NEAR(gap(t), 0, 1e-9 * std::max(1.0, t * t)) << n;
        }
        for (int k = 0; k < 200; ++k) ASSERT_GT(gap(until * k / 200), -1e-9) << n << " " << k;
    }
}

TEST(EdmdWalls, BothAlgorithmsInVessels) {
    edmd::Curved round;
    round.radius = 5;
    edmd::Setup s = vessel(2, 6, round);
    s.restitution.eps = 0.9;
    edmd::Curved pin;
    pin.radius = 0.7;
    pin.center[0] = 2;
    pin.container = false;
    pin.wall.eps_n = 0.8;
    s.curved.push_back(pin);
    {
        SCOPED_TRACE("circle with a pin");
        expect_same_events(s, edmd::make_particles(s, {25}, 1.0), 1500);
    }
    s.gravity[1] = -0.3;
    s.contact_time = 1e-3;
    {
        SCOPED_TRACE("the same under gravity");
        expect_same_events(s, edmd::make_particles(s, {25}, 1.0), 800);
    }
    round.axis = 2;
    s = vessel(3, 6, round);
    s.periodic[2] = true;
    s.rough = true;
    s.tangential = 0.2;
    s.curved[0].wall.kind = edmd::Side::Kind::heated;
    s.curved[0].wall.temperature = 2;
    s.curved[0].wall.accommodation = 0.8;
    pin = {};
    pin.radius = 1;
    pin.container = false;
    pin.wall.eps_t = -0.3;
    s.curved.push_back(pin);
    s.periodic[2] = false;
    {
        SCOPED_TRACE("heated cylinder with a ball");
        expect_same_events(s, edmd::make_particles(s, {40}, 1.0, 0.5), 1500);
    }
    s = test::hard_gas(3, 0.05, 0.9, 60);
    s.periodic[1] = false;
    s.side[1][0].speed = 0.02;
    s.side[1][1].speed = -0.01;
    s.side[1][1].kind = edmd::Side::Kind::heated;
    s.side[1][1].temperature = 1.5;
    {
        SCOPED_TRACE("two pistons, one of them hot");
        expect_same_events(s, edmd::make_particles(s, {60}, 1.0), 1500);
    }
}

// Nobody leaves a vessel, energy stays, and a heated vessel gives the gas its temperature.
TEST(EdmdWalls, VesselsHoldTheGas) {
    edmd::Curved ball;
    ball.radius = 6;
    edmd::Setup s = vessel(3, 6.5, ball);
    edmd::Simulation gas(s, edmd::make_particles(s, {150}, 1.0), widest(), 1);
    gas.run(20000);
    EXPECT_NEAR(temperature(gas) + 0, 1, 0.2); // drift counts for itself
    EXPECT_NEAR(edmd::observe(s, gas.particles()).energy, 1.5 * 150, 1e-10);
    for (const edmd::Particle& p : gas.particles())
        EXPECT_LT(std::hypot(p.place[0], p.place[1], p.place[2]), 5.5 + 1e-12);
    s.curved[0].wall.kind = edmd::Side::Kind::heated;
    s.curved[0].wall.temperature = 2;
    edmd::Simulation hot(s, edmd::make_particles(s, {150}, 1.0), widest(), 1);
    hot.run(10000);
    double sum = 0;
    for (int k = 0; k < 200; ++k) {
        hot.run(200);
        sum += edmd::observe(s, hot.particles()).energy / (1.5 * 150) / 200;
    }
    EXPECT_NEAR(sum, 2, 0.08); // three standard deviations of the energy of 150 particles, 40 times renewed
}

// White noise and inelastic collisions balance where theory says (specification of Monte Carlo, 10.7): at
// n s^2 g2 = 0.1 in the plane, eps = 0.9, xi^2 = 0.01, T = 0.446. Kicks conserve the momentum.
TEST(SlowEdmdThermostat, WhiteNoiseHoldsATemperature) {
    const std::uint32_t n = 1000;
    const double phi = 0.0695; // n s^2 g2 = 0.1
    edmd::Setup s = test::hard_gas(2, phi, 0.9, n);
    const double density = n / s.volume();
    ASSERT_NEAR(density * laws::contact_correlation(2, phi), 0.1, 2e-3);
    s.kicks = 0.01;
    s.kick_interval = 0.15;
    edmd::Simulation gas(s, edmd::make_particles(s, {n}, 0.45), widest(), 1);
    double sum = 0;
    gas.run(std::int64_t{1} << 40, 60);
    const int frames = 100;
    for (int k = 1; k <= frames; ++k) {
        gas.run(std::int64_t{1} << 40, 60 + 3 * k);
        sum += temperature(gas) / frames;
    }
    EXPECT_NEAR(sum, 0.446203086, 0.03 * 0.446203086); // 1000 particles for ten times of relaxation
    const auto o = edmd::observe(s, gas.particles());
    EXPECT_NEAR(std::hypot(o.drift[0], o.drift[1]), 0, 1e-13);
}

TEST(EdmdThermostat, BothAlgorithms) {
    for (const int dimension : {2, 3}) {
        edmd::Setup s = test::hard_gas(dimension, 0.15, 0.8, 64);
        s.kicks = 0.05;
        s.kick_interval = 0.07;
        expect_same_events(s, edmd::make_particles(s, {64}, 1.0), 1500);
        s.classes = {{0.5, 1, 0.4}, {0.3, 0.5, 0.4}};
        s.gravity[1] = -0.2;
        s.periodic[1] = false;
        s.side[1][0].eps_n = 0.7;
        expect_same_events(s, edmd::make_particles(s, {32, 32}, 1.0), 1000);
    }
}

TEST(EdmdGrowth, TimesOfTheSpecification) {
    const auto time = [](double v) {
        return laws::growing_meeting<2>({3, 0.4, 0}, {v, 0, 0}, 1.0, 0.1, never);
    };
    EXPECT_NEAR(time(-1), 1.881234060250, 1e-11);
    EXPECT_NEAR(time(0.05), 40.318478570997, 1e-10); // recedes more slowly than the radii grow
    EXPECT_EQ(time(1), never);
    EXPECT_NEAR(laws::growing_meeting<3>({3, 0.4, 0}, {-1, 0, 0}, 1.0, 0.1, never), 1.881234060250, 1e-11);
    EXPECT_EQ(laws::growing_meeting<3>({0, 0, 0}, {0, 0, 0}, 1.0, 0.1, never), never);
}

TEST(EdmdGrowth, BothAlgorithms) {
    for (const int dimension : {2, 3}) {
        SCOPED_TRACE(dimension);
        edmd::Setup s = test::hard_gas(dimension, dimension == 2 ? 0.6 : 0.45, 1, 64);
        const auto particles = edmd::make_particles(s, {64}, 1.0);
        s.scale = 0.6;
        s.growth = 0.02;
        s.periodic[0] = false;
        expect_same_events(s, particles, 1500);
    }
}

// Slow growth takes thousands of collisions of each and is not called jammed.
TEST(EdmdGrowth, Slow) {
    const edmd::Setup s = test::hard_gas(3, 0.45, 1, 64);
    const edmd::Start start{edmd::Start::Kind::growth, 2e-4, 1, widest()};
    edmd::Simulation gas(s, edmd::make_particles(s, {64}, 1.0, 0, start), widest(), 1);
    gas.run(5000);
    EXPECT_GT(gas.tally().smallest_gap, -1e-12);
}

// Denser than random insertion can be, without order, and the same by any number of threads and by the
// reference.
TEST(EdmdGrowth, DenseStarts) {
    struct Point {
        int dimension;
        double phi;
        std::uint32_t n;
    };
    for (const Point& p : {Point{2, 0.75, 300}, Point{3, 0.58, 500}}) {
        SCOPED_TRACE(p.dimension);
        const edmd::Setup s = test::hard_gas(p.dimension, p.phi, 1, p.n);
        const edmd::Start start{edmd::Start::Kind::growth, 0.1, 1, widest()};
        const auto particles = edmd::make_particles(s, {p.n}, 1.0, 0, start);
        double closest = 1e9;
        for (std::size_t i = 0; i < particles.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                double square = 0;
                for (std::size_t d = 0; d < static_cast<std::size_t>(p.dimension); ++d) {
                    double apart = particles[i].place[d] - particles[j].place[d];
                    apart -= s.length(0) * std::rint(apart / s.length(0));
                    square += apart * apart;
                }
                closest = std::min(closest, std::sqrt(square));
            }
        EXPECT_GE(closest, 1);
        EXPECT_LT(closest, 1.01);
        const auto again =
            edmd::make_particles(s, {p.n}, 1.0, 0, {edmd::Start::Kind::growth, 0.1, 3, simd::Isa::scalar});
        for (std::size_t i = 0; i < particles.size(); ++i) EXPECT_EQ(particles[i].place, again[i].place);
        edmd::Simulation gas(s, particles, widest(), 1);
        gas.run(20000);
        EXPECT_GT(gas.tally().smallest_gap, -1e-12);
        EXPECT_NEAR(temperature(gas), 1, 1e-12);
    }
    // Between walls, and of two sizes.
    edmd::Setup s = test::hard_gas(2, 0.5, 1, 200);
    s.classes = {{0.5, 1, 0.5}, {0.25, 0.25, 0.5}};
    s.periodic[0] = s.periodic[1] = false;
    const auto particles =
        edmd::make_particles(s, {150, 150}, 1.0, 0, {edmd::Start::Kind::growth, 0.1, 1, widest()});
    edmd::Simulation gas(s, particles, widest(), 1);
    gas.run(20000);
    EXPECT_GT(gas.tally().smallest_gap, -1e-12);
}

// What no order can hold jams, and that is said.
TEST(SlowEdmdGrowth, Jams) {
    const edmd::Setup s = test::hard_gas(3, 0.70, 1, 100);
    try {
        (void)edmd::make_particles(s, {100}, 1.0, 0, {edmd::Start::Kind::growth, 1.0, 1, widest()});
        FAIL() << "it does not fit";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::invalid_input);
        EXPECT_NE(std::string(e.what()).find("jammed"), std::string::npos);
    }
}
