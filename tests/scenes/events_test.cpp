// The scenes of event-driven dynamics, some of them smaller: what they show must happen.
#include "analysis/gas_mixture.hpp"
#include "core/error.hpp"
#include "edmd/plan.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sandlane {

namespace {

struct Events {
    scene::Scene scene;
    edmd::Plan plan;
    std::unique_ptr<edmd::Algorithm> run;

    explicit Events(const std::string& name, const scene::Overrides& overrides = {})
        : scene(scene::read_scene(std::string(SANDLANE_SOURCE_DIR "/data/scenes/") + name, overrides)),
          plan(edmd::make_plan(scene, simd::choose_isa("auto"), {1, "test"})),
          run(edmd::start(scene, plan, plan.isa)) {}

    void to(double time) const { run->run(std::int64_t{1} << 40, time); }
    [[nodiscard]] double temperature() const {
        return edmd::observe(plan.setup, run->particles()).temperature;
    }
    // Measured over that of a uniform gas.
    [[nodiscard]] double over_theory() const {
        return temperature() /
               analysis::cooling_curve(edmd::gas_of(plan), scene.gas.temperature, {run->time()}).front();
    }
};

} // namespace

// 5 %: what 2000 particles scatter by.
TEST(SlowShippedEvents, CoolAsHaffSays) {
    const Events gas("haff-edmd.toml");
    EXPECT_TRUE(gas.plan.homogeneous);
    for (const double t : {10.0, 100.0, 500.0}) {
        gas.to(t);
        EXPECT_NEAR(gas.over_theory(), 1, 0.05) << t;
    }
}

TEST(SlowShippedEvents, HardSpheresFollowCarnahanAndStarling) {
    const Events gas("hard-spheres.toml");
    gas.to(10);
    const edmd::Tally before = gas.run->tally();
    gas.to(40);
    const double n = 2000, t = 30;
    EXPECT_NEAR(1 + (gas.run->tally().virial - before.virial) / (3 * n * t), 3.974, 0.01 * 3.974);
    EXPECT_NEAR(2 * static_cast<double>(gas.run->tally().collisions - before.collisions) / (n * t), 10.067,
                0.012 * 10.067);
}

// A quarter of the box is longer than the critical length still.
TEST(SlowShippedEvents, ClustersForm) {
    const Events gas("clusters.toml", {"gas.particles=25000", "domain.upper=[280.25, 280.25]"});
    gas.to(10);
    EXPECT_NEAR(gas.over_theory(), 1, 0.15);
    gas.to(500);
    EXPECT_GT(gas.over_theory(), 4);
    EXPECT_GT(gas.run->tally().smallest_gap, -1e-10);
}

TEST(SlowShippedEvents, CollapseWithoutAContactTime) {
    const Events guarded("collapse-plane.toml");
    EXPECT_EQ(guarded.run->run(1000000), 1000000);
    EXPECT_GT(guarded.run->tally().elastic, 1000);
    const Events bare("collapse-plane.toml", {"edmd.contact_time=0"});
    EXPECT_THROW(bare.run->run(1000000), Error);
}

// dT/T = -Z dV/V, with Henderson's Z, from packing fraction 0.0785 to 0.157: 2.42; 5 %: the walls take a
// diameter of the volume, and 2000 particles.
TEST(SlowShippedEvents, APistonHeatsTheGas) {
    const Events gas("piston.toml");
    gas.to(2000);
    EXPECT_NEAR(gas.temperature(), 2.42, 0.05 * 2.42);
    EXPECT_NEAR(gas.run->tally().wall_energy, 2000 * (gas.temperature() - 1), 1e-3 * 2000);
}

// The gas is held between the circles, and is between their temperatures.
TEST(ShippedEvents, ARoundVessel) {
    const Events gas("round-vessel.toml");
    gas.to(200);
    for (const edmd::Particle& p : gas.run->particles()) {
        const double distance = std::hypot(p.place[0], p.place[1]);
        EXPECT_LT(distance, 29.5 + 1e-9);
        EXPECT_GT(distance, 5.5 - 1e-9);
    }
    EXPECT_GT(gas.temperature(), 0.2);
    EXPECT_LT(gas.temperature(), 1);
}

// Averages of 1000 discs over 200 s, a few times the relaxation: 4 %.
TEST(SlowShippedEvents, WhiteNoiseHoldsTheTemperature) {
    const Events gas("driven-discs.toml");
    double sum = 0;
    for (int k = 1; k <= 100; ++k) {
        gas.to(100 + 2 * k);
        sum += gas.over_theory() / 100;
    }
    EXPECT_NEAR(sum, 1, 0.04);
}

// Collisions take what the stress works: of 500 s, with the fluctuations of the stress of 1000 spheres. The
// temperature is that of Grad's moments for a dilute gas but for terms of the packing fraction, chi - 1 =
// 0.14.
TEST(SlowShippedEvents, ShearHeatsWhatCollisionsCool) {
    const Events gas("sheared-spheres.toml");
    gas.to(100);
    const edmd::Setup& s = gas.plan.setup;
    const double lost = gas.run->tally().lost, shear = gas.run->tally().shear;
    double temperature = 0, flux = 0;
    constexpr int frames = 500;
    for (int k = 1; k <= frames; ++k) {
        gas.to(100 + k);
        const auto o = edmd::observe(s, gas.run->particles());
        temperature += o.temperature / frames;
        flux += o.flux / frames;
    }
    const double stress = -(flux + (gas.run->tally().shear - shear) / frames) / s.volume();
    EXPECT_NEAR(temperature, 1, 0.2);
    EXPECT_NEAR(stress * s.shear * s.volume() * frames / (gas.run->tally().lost - lost), 1, 0.05);
}

// Heat and losses are all that changes the energy, and theory knows the temperatures of both kinds: 400 discs
// of each for five times of relaxation, and 3 % for its Maxwellians.
TEST(SlowShippedEvents, TwoMaterials) {
    const Events gas("two-materials.toml");
    const double start = edmd::observe(gas.plan.setup, gas.run->particles()).energy;
    double ratio = 0;
    for (int k = 1; k <= 100; ++k) {
        gas.to(50 + k);
        const auto t = edmd::observe(gas.plan.setup, gas.run->particles()).of_class;
        ratio += t[1] / t[0] / 100;
    }
    const edmd::Tally& t = gas.run->tally();
    EXPECT_NEAR(edmd::observe(gas.plan.setup, gas.run->particles()).energy, start + t.heat - t.lost,
                1e-9 * start);
    analysis::MixtureGas theory;
    theory.dimension = 2;
    theory.dense = true;
    theory.kicks = gas.plan.setup.kicks;
    theory.kinds = {{400 / gas.plan.setup.volume(), 1, 1}, {400 / gas.plan.setup.volume(), 3, 1.2}};
    theory.restitution = gas.plan.setup.pairs;
    const auto expected = analysis::cooling_curves(theory, 1, {1000}).front();
    EXPECT_NEAR(ratio / (expected[1] / expected[0]), 1, 0.07);
}

// Grown and aged, spheres beyond freezing still follow the fluid of Carnahan and Starling, who say 19.9; a
// crystal of this density has 12.
TEST(SlowShippedEvents, DenseSpheresHaveNoOrder) {
    const Events gas("dense-spheres.toml");
    gas.to(10);
    const double before = gas.run->tally().virial;
    gas.to(20);
    EXPECT_NEAR(1 + (gas.run->tally().virial - before) / (3 * 2000.0 * 10), 19.9, 1.5);
}

// The floor keeps the discs up, densest above it.
TEST(SlowShippedEvents, AFloorKeepsDiscsUp) {
    const Events gas("vibrated-discs.toml");
    gas.to(100);
    double height = 0;
    for (int k = 1; k <= 20; ++k) {
        gas.to(100 + 5 * k);
        for (const edmd::Particle& p : gas.run->particles()) {
            EXPECT_GT(p.place[1], -0.6);
            height += p.place[1] / 400 / 20;
        }
    }
    EXPECT_GT(height, 10);
    EXPECT_LT(height, 40);
    EXPECT_GT(gas.run->tally().wall_energy, 0);
}

} // namespace sandlane
