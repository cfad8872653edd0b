// Sand in the plane that jams, rests, creeps and flows: the scenes of data/scenes at a reduced size.
#include "analysis/analysis.hpp"
#include "scenes/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sandlane {

namespace {

using analysis::Snapshot;

double mean_height(const Snapshot& s) {
    return std::accumulate(s.y.begin(), s.y.end(), 0.0) / static_cast<double>(s.size());
}

// Mean velocity along x of the grains between two heights.
double mean_flow(const Snapshot& s, double low, double high) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const bool inside = s.y[i] >= low && s.y[i] < high;
        sum += inside ? s.vx[i] : 0;
        count += inside ? 1 : 0;
    }
    return sum / count;
}

md::Simulation hopper(const std::string& lips, int seed) {
    return shipped("hopper.toml", {"materials.0.young=75e6", "materials.0.dissipation=35e-6", "md.dt=5e-6",
                                   "grains.0.count=300", "md.duration=1.5", "seed=" + std::to_string(seed),
                                   "walls.0.points=[[0.04, 0.36], [0.04, 0.1388], [" + lips + ", 0.05]]"});
}

// Outlets of 2.2 diameters always jam, those of more than 5 hardly ever (K. To et al., Phys. Rev. Lett. 86,
// 71 (2001)). The right lip is at 0.11 m.
TEST(SlowShippedScenes, NarrowHopperJams) {
    for (const int seed : {1, 2, 3}) {
        md::Simulation sim = hopper("0.099", seed);
        sim.run(sim.plan().steps);
        EXPECT_GT(sim.snapshot().size(), 200U) << seed;
        EXPECT_EQ(static_cast<std::int64_t>(sim.snapshot().size()) + sim.removed(), 300) << seed;
        // The arch carries the rest: its weight would be moving at some 0.1 m/s.
        EXPECT_LT(sim.observe().largest_speed, 1e-3) << seed;
    }
}

TEST(SlowShippedScenes, WideHopperRunsEmpty) {
    for (const int seed : {1, 2, 3}) {
        md::Simulation sim = hopper("0.07", seed); // eight diameters
        sim.run(sim.plan().steps);
        EXPECT_EQ(sim.removed(), 300) << seed;
    }
}

struct Rest {
    double kinetic, sunk; // share of the energy that was poured in; m in the last second
};

Rest heap(const std::string& law) {
    md::Simulation sim = shipped("heap-" + law + ".toml",
                                 {"materials.0.young=150e6", "materials.0.dissipation=35e-6", "md.dt=5e-6",
                                  "grains.0.count=200", "grains.0.rate=300", "md.duration=3.5"});
    sim.run(sim.plan().steps * 5 / 7);
    const double before = mean_height(sim.snapshot());
    sim.run(sim.plan().steps - sim.step());
    return {sim.observe().kinetic / sim.added_energy(), before - mean_height(sim.snapshot())};
}

// Springs hold a heap still; friction without memory lets it creep (md-spheres 8.5).
TEST(SlowShippedScenes, HeapsRestOnSpringsAndCreepWithoutMemory) {
    const Rest springs = heap("cundall-strack"), sliding = heap("haff-werner");
    EXPECT_LT(springs.kinetic, 1e-9);
    EXPECT_GT(sliding.kinetic, 1e-8);
    constexpr double rest = 1e-6; // m
    EXPECT_LT(std::abs(springs.sunk), rest);
    EXPECT_GT(sliding.sunk, 10 * rest); // 5e-5 to 2e-4: how far it creeps depends on every rounding before
}

TEST(SlowShippedScenes, LayerFlowsAboveTheAngleOfReposeAndRestsBelow) {
    const scene::Overrides less{"grains.0.count=250", "md.duration=1.2"};
    md::Simulation steep = shipped("avalanche.toml", less);
    steep.run(steep.plan().steps);
    const Snapshot s = steep.snapshot();
    EXPECT_EQ(s.size(), 250U);
    const double low = mean_flow(s, 0.02, 0.04), high = mean_flow(s, 0.05, 0.07);
    EXPECT_GT(low, 0.02);
    EXPECT_GT(high, 1.5 * low); // sheared, not sliding as a block

    scene::Overrides gentle = less;
    gentle.emplace_back("domain.gravity=[2.04, -9.60]"); // 12 degrees
    md::Simulation flat = shipped("avalanche.toml", gentle);
    flat.run(flat.plan().steps);
    EXPECT_LT(flat.observe().kinetic, 1e-5 * steep.observe().kinetic);
}

// Plane shear of dense grains with friction: shear stress over pressure is 0.25 to 0.45 (GDR MiDi, Eur. Phys.
// J. E 14, 341 (2004), figure 4).
TEST(SlowShippedScenes, ShearedCellHasTheFrictionOfADenseFlow) {
    md::Simulation sim = shipped("sheared-cell.toml", {"md.duration=1.2"});
    const auto stress = analysis::make_analysis(sim.scene(), sim.scene().analyses[0]);
    double shear = 0, pressure = 0, lower = 0, upper = 0;
    run_to_the_end(sim, 60, [&](const md::Simulation& now) {
        if (now.time() < 0.4) return;
        const Snapshot s = now.snapshot();
        const analysis::Contacts contacts = now.contacts();
        stress->add({s, contacts});
        const std::vector<double> row = stress->rows().back(); // time, xx, xy, yx, yy, pressure
        shear += row[2];
        pressure += row[5];
        lower += mean_flow(s, 0.02, 0.06);
        upper += mean_flow(s, 0.16, 0.20);
    });
    EXPECT_GT(-shear / pressure, 0.2);
    EXPECT_LT(-shear / pressure, 0.5);
    EXPECT_LT(lower, 0);
    EXPECT_GT(upper, 0);
}

} // namespace

} // namespace sandlane
