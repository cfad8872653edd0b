// The time step that follows the contacts: it changes when they do, what is integrated does not, and the run
// is the same for all kernels and threads and after a checkpoint.
#include "md/support.hpp"
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

using namespace sandlane;
using namespace sandlane::test;

namespace {

// A cloud of viscoelastic grains that collide, cool, and collide ever more slowly.
struct Cloud {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
};

Cloud cloud(int dimension) {
    Cloud c{dimension == 3 ? space_scene(6) : lattice_scene(12, 12),
            dimension == 3 ? space_grains(6) : lattice_grains(12, 12)};
    c.scene.md.normal = scene::NormalLaw::viscoelastic;
    c.scene.md.tangential = scene::TangentialLaw::cundall_strack;
    c.scene.materials[0].young = 1000;
    c.scene.materials[0].dissipation = 2e-3;
    c.scene.materials[0].tangential_stiffness = 10;
    c.scene.materials[0].tangential_damping = 0.05;
    c.scene.md.adaptive_dt = true;
    c.scene.md.dt = 2e-3;
    return c;
}

} // namespace

// Without forces everything is a polynomial: rescaling the integrator's values for another step changes
// nothing.
TEST(AdaptiveTimeStep, FreeFallIsExactWhateverTheStep) {
    scene::Scene s = empty_scene();
    s.domain.lower = {-100, -100, 0};
    s.domain.upper = {100, 100, 0};
    s.domain.gravity = {0, -2, 0};
    s.materials[0].stiffness = 1e4;
    s.materials[0].friction = 0;
    s.md.adaptive_dt = true;
    s.md.dt = 1e-5;
    s.md.duration = 10;
    md::Simulation sim = simulate(s, {grain(0, {0, 90, 0}, {1, 0, 0}, 0.5, 1, 0)});
    EXPECT_EQ(sim.plan().stride, 12);
    std::set<std::int64_t> strides;
    while (sim.time() < 1) {
        sim.run(3000);
        strides.insert(sim.plan().stride);
        const analysis::Snapshot now = sim.snapshot();
        const double t = sim.time();
        EXPECT_NEAR(now.x[0], t, 1e-12 * 400);
        EXPECT_NEAR(now.y[0], 90 - t * t, 1e-10);
        EXPECT_NEAR(now.vy[0], -2 * t, 1e-10);
    }
    EXPECT_TRUE(strides.contains(48)); // t_c of such a grain is some 0.02 s
    EXPECT_LT(sim.taken(), sim.step());
}

// Grains that are still to come have a say: 0.05 R/v of one that arrives fast in an empty domain.
TEST(AdaptiveTimeStep, ExpectsWhoArrives) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = 100;
    s.materials[0].friction = 0;
    s.md.adaptive_dt = true;
    s.md.dt = 2e-5;
    s.md.duration = 1;
    scene::GrainState late = grain(0, {0.5, 0.5, 0}, {10, 0, 0}, 0.01, 1, 0);
    late.insert_at = 0.1;
    md::Simulation sim = simulate(s, {late});
    double longest = 0;
    while (sim.state().size() == 0) {
        longest = std::max(longest, sim.plan().dt);
        sim.run(48);
    }
    EXPECT_DOUBLE_EQ(longest, 8e-5);
    EXPECT_LE(sim.plan().dt, 5e-5);
}

// By hand: t_c/50 of the overlap at rest of a heavy grain, and of what the light one may do next.
TEST(AdaptiveTimeStep, FollowsTheStiffestContact) {
    scene::Scene s = empty_scene();
    s.md.normal = scene::NormalLaw::viscoelastic;
    s.materials[0].young = 1e7;
    s.materials[0].poisson = 0.3;
    const laws::PairCoefficients<double> c = laws::coefficients_from<double>(md::pair_table(s).data());
    const double mass = 0.5, radius = 0.01, overlap = 1e-4;
    const double k = 2.0 / 3 * 1e7 / (1 - 0.09) * std::sqrt(radius);
    const double frequency = std::sqrt(1.5 * k * std::sqrt(overlap) / mass);
    EXPECT_NEAR(md::contact_time_step(s, c, mass, radius, overlap), std::numbers::pi / frequency / 50,
                1e-12 / frequency);
}

TEST(AdaptiveTimeStep, GrowsWhenACloudCoolsSlow) {
    const Cloud c = cloud(3);
    md::Simulation sim = make_simulation(c.scene, c.grains, simd::available_isas().back());
    sim.run(3072);
    const std::int64_t early = sim.plan().stride;
    sim.run(120000);
    EXPECT_GT(sim.plan().stride, early);
    EXPECT_EQ(sim.step() % sim.plan().stride, 0);
    EXPECT_EQ(sim.plan().dt, static_cast<double>(sim.plan().stride) * sim.plan().tick);
}

// Energy that contacts took by the adaptive step and by a small fixed one: both to the error of collisions.
TEST(SlowAdaptiveTimeStep, TakesAsMuchEnergyAsAFixedStep) {
    Cloud c = cloud(2);
    md::Simulation adaptive = make_simulation(c.scene, c.grains, simd::available_isas().back());
    const double before = adaptive.observe().energy();
    c.scene.md.adaptive_dt = false;
    c.scene.md.dt = 2.5e-4;
    md::Simulation fixed = make_simulation(c.scene, c.grains, simd::available_isas().back());
    adaptive.run(std::llround(8 / adaptive.plan().tick));
    fixed.run(std::llround(8 / fixed.plan().tick));
    EXPECT_LT(adaptive.taken(), fixed.taken());
    const double lost = before - fixed.observe().energy();
    EXPECT_GT(lost, 0.5 * before);
    EXPECT_NEAR(before - adaptive.observe().energy(), lost, 0.05 * before); // another chaotic course
    EXPECT_NEAR(adaptive.dissipated(adaptive.observe()), before - adaptive.observe().energy(), 1e-9 * before);
}

TEST(AdaptiveTimeStep, SameBitsForKernelsThreadsSlicesAndAfterACheckpoint) {
    for (const int dimension : {2, 3}) {
        const Cloud c = cloud(dimension);
        const auto make = [&](simd::Isa isa, int threads) {
            return make_simulation(c.scene, c.grains, isa, threads);
        };
        md::Simulation straight = make(simd::Isa::scalar, 1);
        straight.run(19200);
        for (const simd::Isa isa : simd::available_isas()) {
            md::Simulation first = make(isa, 2);
            while (first.step() < 7500) first.run(37);
            md::Simulation second = make(isa, 3);
            second.restore(first.serialise());
            EXPECT_EQ(second.plan().dt, first.plan().dt);
            while (second.step() < 19200) second.run(std::min<std::int64_t>(3000, 19200 - second.step()));
            EXPECT_EQ(second.state_hash(), straight.state_hash()) << simd::isa_name(isa);
        }
    }
}
