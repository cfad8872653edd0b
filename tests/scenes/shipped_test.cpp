// The scenes in data/scenes are run to their end: what they show must happen. Grains are softer, so that time
// steps are longer; contacts dissipate what they did.
#include "scenes/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sandlane {

namespace {

using analysis::Snapshot;

Vec centre_of_mass(const Snapshot& s) {
    Vec sum;
    double mass = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        sum = sum + s.mass[i] * Vec{s.x[i], s.y[i], 0};
        mass += s.mass[i];
    }
    return (1 / mass) * sum;
}

TEST(SlowShippedScenes, HourglassRunsThroughAtASteadyRate) {
    md::Simulation sim = shipped("hourglass.toml",
                                 {"materials.0.young=80e6", "materials.0.dissipation=32e-6", "md.dt=7.5e-6"});
    std::vector<double> through; // grains below the neck, every tenth of a second
    double most_energy = 0;
    run_to_the_end(sim, 22, [&](const md::Simulation& now) {
        const Snapshot s = now.snapshot();
        through.push_back(
            static_cast<double>(std::count_if(s.y.begin(), s.y.end(), [](double y) { return y < 0.4; })));
        most_energy = std::max(most_energy, now.observe().kinetic);
    });
    const Snapshot end = sim.snapshot();
    ASSERT_EQ(end.size(), 1320U);
    EXPECT_EQ(sim.removed(), 0);
    EXPECT_GE(through.back(), 0.99 * 1320);
    for (std::size_t i = 0; i < end.size(); ++i) { // inside the glass
        EXPECT_TRUE(end.x[i] > 0.03 && end.x[i] < 0.33 && end.y[i] > 0.02 && end.y[i] < 0.54) << end.id[i];
    }
    EXPECT_LT(sim.observe().kinetic, 0.01 * most_energy);
    // Sand flows at a rate that does not depend on the height above the neck (Beverloo); some seventy grains
    // pass in a tenth of a second, so that counting alone scatters by 12 %: three times that.
    const int first = 4, last = 16;
    const double mean = (through[last] - through[first]) / (last - first);
    for (int n = first; n < last; ++n)
        EXPECT_NEAR(through[static_cast<std::size_t>(n) + 1] - through[static_cast<std::size_t>(n)], mean,
                    0.36 * mean)
            << n;
}

TEST(SlowShippedScenes, DrumLiftsItsFillingInTheDirectionOfRotation) {
    md::Simulation sim =
        shipped("drum.toml", {"materials.0.young=150e6", "materials.0.dissipation=28e-6", "md.dt=1.2e-5"});
    std::vector<double>
        angles; // of the surface: it is perpendicular to the line from the axis to the centre of mass
    run_to_the_end(sim, 40, [&](const md::Simulation& now) {
        const Vec c = centre_of_mass(now.snapshot());
        angles.push_back(std::atan2(c.x - 0.5, 0.5 - c.y) * 180 / std::numbers::pi);
    });
    const Snapshot end = sim.snapshot();
    ASSERT_EQ(end.size(), 800U);
    // Counter-clockwise rotation moves the lowest wall to the right. The first second is the filling falling
    // into place.
    const double mean =
        std::accumulate(angles.begin() + 20, angles.end(), 0.0) / static_cast<double>(angles.size() - 20);
    EXPECT_GT(mean, 15);
    EXPECT_LT(mean, 45);
    for (std::size_t i = 0; i < end.size(); ++i)
        EXPECT_LT(std::hypot(end.x[i] - 0.5, end.y[i] - 0.5), 0.4) << end.id[i];
}

TEST(SlowShippedScenes, LargeGrainRisesInTheVibratedBox) {
    md::Simulation sim =
        shipped("brazil-nut.toml", {"materials.0.young=100e6", "materials.0.dissipation=15e-6"});
    std::vector<double> below; // fraction of the small grains that are lower than the large one
    run_to_the_end(sim, 40, [&](const md::Simulation& now) {
        const Snapshot s = now.snapshot();
        const auto lower = std::count_if(s.y.begin() + 1, s.y.end(), [&](double y) { return y < s.y[0]; });
        below.push_back(static_cast<double>(lower) / static_cast<double>(s.size() - 1));
    });
    EXPECT_EQ(sim.snapshot().size(), 211U);
    EXPECT_LT(below.front(), 0.2);
    EXPECT_GT(std::accumulate(below.end() - 10, below.end(), 0.0) / 10, 0.5);
}

// Haff's law with the rate of Enskog's theory: T = T0/(1 + t/tau)^2, 1/tau = (1 - eps^2) omega/4 with the
// collision frequency of a disc omega = 2 n sigma chi sqrt(pi T0/m) and Henderson's contact value chi.
struct Gas {
    double temperature, mass, sigma, density, restitution;

    explicit Gas(const md::Simulation& sim) {
        const Snapshot s = sim.snapshot();
        const Vec size = s.upper - s.lower;
        temperature = sim.observe().kinetic / static_cast<double>(s.size());
        mass = s.mass[0];
        sigma = 2 * s.radius[0];
        density = static_cast<double>(s.size()) / (size.x * size.y);
        const scene::Material& m = sim.scene().materials[0];
        // Linear dashpot, force cut at zero (md-spheres 2.1), reduced mass m/2.
        const double w0 = std::sqrt(m.stiffness / (0.5 * mass)), beta = m.damping / mass, z = beta / w0;
        restitution = std::exp(-beta * 2 * std::acos(z) / (w0 * std::sqrt(1 - z * z)));
    }
    [[nodiscard]] double collision_frequency() const {
        const double phi = std::numbers::pi / 4 * sigma * sigma * density;
        const double chi = (1 - 7 * phi / 16) / ((1 - phi) * (1 - phi));
        return 2 * density * sigma * chi * std::sqrt(std::numbers::pi * temperature / mass);
    }
    [[nodiscard]] double cooling(double time) const {
        const double x = 1 + time * (1 - restitution * restitution) * collision_frequency() / 4;
        return temperature / (x * x);
    }
};

TEST(SlowShippedScenes, GranularGasCoolsSlowerThanHaffOnceItClusters) {
    md::Simulation sim = shipped("granular-gas.toml",
                                 {"materials.0.stiffness=71e3", "materials.0.damping=0.665", "md.dt=8e-6"});
    const Gas gas(sim);
    const double n = static_cast<double>(sim.snapshot().size());
    const double momentum_scale = n * gas.mass * std::sqrt(gas.temperature / gas.mass);
    double before = 2 * sim.observe().kinetic;
    run_to_the_end(sim, 30, [&](const md::Simulation& now) {
        const md::Observables o = now.observe();
        EXPECT_LT(o.kinetic, before); // no energy comes in
        before = o.kinetic;
        // Rounding of 700000 steps, each of less than 1e-16 of what a grain carries, added up at worst.
        EXPECT_LT(norm(o.momentum), 7e-11 * momentum_scale);
    });
    const double end = sim.observe().kinetic / n;
    EXPECT_LT(end, 0.01 * gas.temperature);
    EXPECT_GT(end, 2 * gas.cooling(sim.time()));
}

// Dilute, hard and nearly elastic, so that the theory holds: few collisions, none of them of three grains.
TEST(SlowShippedScenes, DiluteGasFollowsHaff) {
    md::Simulation sim =
        shipped("granular-gas.toml", {"grains.0.packing_fraction=0.1", "materials.0.stiffness=3e5",
                                      "materials.0.damping=0.35", "md.duration=0.25"});
    const Gas gas(sim);
    EXPECT_NEAR(gas.restitution, 0.95, 0.01);
    const double collisions = gas.collision_frequency() * 0.25; // per grain, without cooling
    EXPECT_GT(collisions, 10);
    run_to_the_end(sim, 5, [&](const md::Simulation& now) {
        const double t = now.observe().kinetic / static_cast<double>(now.snapshot().size());
        // The loss is the sum over some 15000 collisions with a spread of their own size: 1 %. Contacts last
        // 1 % of the time between collisions, and the velocities are not quite Maxwellian: 1 % each.
        EXPECT_NEAR(t, gas.cooling(now.time()), 0.03 * t) << now.time();
    });
    EXPECT_LT(sim.observe().kinetic / static_cast<double>(sim.snapshot().size()), 0.7 * gas.temperature);
}

} // namespace

} // namespace sandlane
