// The scenes of gases, smaller or shorter: what they show must happen.
#include "analysis/gas_samples.hpp"
#include "dsmc/plan.hpp"
#include "dsmc/simulation.hpp"
#include "dsmc/theory.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace sandlane {

namespace {

struct Gas {
    scene::Scene scene;
    dsmc::Plan plan;
    dsmc::Simulation simulation;

    Gas(const std::string& name, const scene::Overrides& overrides)
        : scene(scene::read_scene(std::string(SANDLANE_SOURCE_DIR "/data/scenes/") + name, overrides)),
          plan(dsmc::make_plan(scene, simd::choose_isa("auto"), {1, "test"})),
          simulation(plan.setup,
                     dsmc::maxwellian(plan.setup, static_cast<std::uint32_t>(scene.gas.particles),
                                      scene.gas.temperature, scene.gas.spin_temperature),
                     plan.isa, plan.threads) {}

    void run_to(double time) { simulation.run(std::int64_t{1} << 40, time); }
    [[nodiscard]] double theory() const {
        return dsmc::cooling_curve(plan.setup, simulation.size(), scene.gas.temperature, {simulation.time()})
            .front();
    }
};

// Columns of a table as CSV.
std::vector<std::vector<double>> columns_of(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line, cell;
    std::vector<std::vector<double>> columns;
    std::getline(lines, line); // the header
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        for (std::size_t n = 0; std::getline(cells, cell, ','); ++n) {
            if (columns.size() <= n) columns.emplace_back();
            columns[n].push_back(std::stod(cell));
        }
    }
    return columns;
}

} // namespace

// 1 %: what 20 000 particles scatter by.
TEST(SlowShippedGases, CoolAsTheorySays) {
    const scene::Overrides smaller = {"gas.particles=20000", "gas.weight=1.6875"};
    for (const char* name : {"haff.toml", "viscoelastic-gas.toml"}) {
        Gas gas(name, smaller);
        EXPECT_TRUE(dsmc::is_homogeneous(gas.plan.setup));
        for (const double time : {10.0, 100.0, 500.0}) {
            gas.run_to(time);
            EXPECT_NEAR(gas.simulation.observe().temperature / gas.theory(), 1, 0.012) << name << " " << time;
        }
    }
}

// At c = 3.5 some five times as many as Maxwell's law has; about fifty are counted in a bin, 15 %.
TEST(SlowShippedGases, FastParticlesAreFrequent) {
    Gas gas("velocity-tails.toml", {"gas.particles=50000", "gas.weight=1.3184"});
    analysis::GasSamples samples(dsmc::frame_of(gas.plan.setup), 0, 1);
    gas.run_to(400);
    for (int frame = 0; frame < 60; ++frame) {
        gas.simulation.run(2);
        samples.add(gas.simulation.particles());
    }
    const auto table = columns_of(samples.distribution());
    for (std::size_t n = 0; n < table[0].size(); ++n) {
        const double c = table[0][n];
        const double ratio = table[1][n] / table[2][n];
        if (c > 3.4 && c < 3.7) {
            EXPECT_GT(ratio, 2.5) << c;
        }
        if (c > 0.8 && c < 1.2) {
            EXPECT_NEAR(ratio, 1, 0.1) << c;
        }
    }
}

TEST(SlowShippedGases, RoughSpheresHaveNoEquipartition) {
    Gas gas("rough-gas.toml", {"gas.particles=20000", "gas.weight=1.6875"});
    gas.run_to(800);
    const auto o = gas.simulation.observe();
    EXPECT_GT(o.spin_temperature / o.temperature, 0.35);
    EXPECT_LT(o.spin_temperature / o.temperature, 0.52);
}

TEST(SlowShippedGases, HeatedSlabIsColdInTheMiddle) {
    Gas gas("heated-slab.toml", {"gas.particles=8000", "gas.weight=11.25"});
    analysis::GasSamples samples(dsmc::frame_of(gas.plan.setup), 0, 9);
    gas.run_to(400);
    for (int frame = 0; frame < 60; ++frame) {
        gas.simulation.run(20);
        samples.add(gas.simulation.particles());
    }
    const auto table = columns_of(samples.profile());
    const std::vector<double>&density = table[1], &temperature = table[6];
    EXPECT_GT(density[4], 2.5 * density[0]);
    EXPECT_LT(temperature[4], 0.4 * temperature[0]);
    EXPECT_LT(temperature[0], 1);
    EXPECT_NEAR(density[0] / density[8], 1, 0.2); // both sides alike
    EXPECT_GT(gas.simulation.wall_energy(), 0);
}

TEST(SlowShippedGases, FloorKeepsTheGasUp) {
    Gas gas("vibrated-gas.toml", {"gas.particles=4000", "gas.weight=0.5"});
    analysis::GasSamples samples(dsmc::frame_of(gas.plan.setup), 1, 20);
    gas.run_to(150);
    for (int frame = 0; frame < 60; ++frame) {
        gas.simulation.run(20);
        samples.add(gas.simulation.particles());
    }
    const auto table = columns_of(samples.profile());
    const std::vector<double>& density = table[1];
    EXPECT_GT(table[7][0], 1.1 * table[6][0]); // vertical above horizontal near the floor
    for (std::size_t n = 3; n < 9; ++n) EXPECT_LT(density[n], 0.85 * density[n - 1]) << n;
    const double temperature = gas.simulation.observe().temperature;
    EXPECT_GT(temperature, 8);
    EXPECT_LT(temperature, 40);
}

} // namespace sandlane
