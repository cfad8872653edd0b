// Grains that come and go: factories, sinks; and orientations, which follow the spins.
#include "support.hpp"
#include "support/space_system.hpp"

#include <gtest/gtest.h>

using namespace sandlane;

namespace {

scene::Scene box(int dimension) {
    scene::Scene s = test::lattice_scene();
    s.domain.dimension = dimension;
    s.domain.periodic = {};
    s.domain.lower = {0, 0, 0};
    s.domain.upper = {40, 40, dimension == 3 ? 40.0 : 0.0};
    s.domain.gravity = {0, -1, 0};
    s.materials[0].density = 0.1;
    if (dimension == 3) s.md.inertia = scene::Inertia::sphere;
    s.md.neighbours = scene::NeighbourMethod::verlet;
    return s;
}

scene::Scene with_factory(int dimension) {
    scene::Scene s = box(dimension);
    scene::Grains g;
    g.kind = scene::GrainKind::factory;
    g.sizes = {scene::SizeLaw::uniform, 0.8, 1.2};
    g.lower = {5, 30, dimension == 3 ? 5.0 : 0.0};
    g.upper = {20, 38, dimension == 3 ? 20.0 : 0.0};
    g.count = 60;
    g.rate = 100;
    s.grains = {g};
    return s;
}

md::Simulation make(const scene::Scene& s, simd::Isa isa, int threads = 1) {
    return test::make_simulation(s, scene::initial_grains(s), isa, threads);
}

} // namespace

// The region has room for a few dozen grains at a time, so that many places are drawn in vain.
TEST(Factory, FillsItsRegionWithoutOverlaps) {
    for (const int dimension : {2, 3}) {
        const scene::Scene s = with_factory(dimension);
        md::Simulation sim = make(s, simd::available_isas().back());
        for (int part = 0; part < 40; ++part) {
            const std::size_t before = sim.state().size();
            sim.run(10);
            const md::Observables now = sim.observe();
            if (part == 0) {
                EXPECT_EQ(now.contacts, 0);
            }
            EXPECT_GE(sim.state().size(), before);
            EXPECT_LT(now.largest_overlap, 0.05);
        }
        sim.run(14000); // the fall through the region takes 4000 steps
        EXPECT_EQ(static_cast<std::int64_t>(sim.state().size()) + sim.removed(), 60) << dimension;
    }
}

TEST(Factory, IsTheSameForThreadsKernelsAndAfterACheckpoint) {
    const scene::Scene s = with_factory(3);
    md::Simulation straight = make(s, simd::available_isas().back(), 2);
    straight.run(900);
    md::Simulation first = make(s, simd::Isa::scalar);
    first.run(333);
    md::Simulation second = make(s, simd::available_isas().back());
    second.restore(first.serialise());
    second.run(900 - 333);
    EXPECT_EQ(second.state_hash(), straight.state_hash());
}

// Energy and number of what a sink takes are booked.
TEST(Sink, TakesWhatLiesInIt) {
    for (const int dimension : {2, 3}) {
        scene::Scene s = box(dimension);
        s.domain.gravity = {};
        scene::Sink sink;
        sink.lower = {0, 0, dimension == 3 ? 0.0 : -1.0};
        sink.upper = {10, 40, dimension == 3 ? 40.0 : 1.0};
        sink.start = 0.1;
        s.sinks = {sink};
        std::vector<scene::GrainState> grains = {test::grain(0, {5, 20, 1}, {0.1, 0, 0}, 1, 1),
                                                 test::grain(1, {9, 30, 1}, {5, 0, 0}, 1, 1),
                                                 test::grain(2, {30, 20, 1}, {0, 0, 0}, 1, 1)};
        if (dimension == 2)
            for (auto& g : grains) g.position.z = 0;
        md::Simulation sim = test::make_simulation(s, grains, simd::available_isas().back());
        sim.run(256); // at t = 0 the sink is closed
        EXPECT_EQ(sim.state().size(), 3U);
        sim.run(1); // 0.256 s: grain 1 has left it at 10 m
        EXPECT_EQ(sim.state().size(), 2U);
        EXPECT_EQ(sim.removed(), 1);
        const md::Observables now = sim.observe();
        EXPECT_NEAR(sim.added_energy(), -0.5 * 0.01, 1e-15);
        EXPECT_NEAR(sim.dissipated(now), 0, 1e-12);
        md::Simulation resumed = test::make_simulation(s, grains, simd::Isa::scalar);
        resumed.restore(sim.serialise());
        EXPECT_EQ(resumed.removed(), 1);
    }
}

TEST(Orientation, FollowsAConstantSpinExactly) {
    scene::Scene s = test::space_scene(4);
    s.md.orientation = true;
    std::vector<scene::GrainState> grains = {test::grain(0, {2, 2, 2}, {1, 0, 0}, 1, 1)};
    const Vec omega{3, -2, 5};
    grains[0].angular_velocity = omega;
    md::Simulation sim = test::make_simulation(s, grains, simd::available_isas().back());
    sim.run(1234);
    const Quaternion q = sim.snapshot().orientation.at(0), expected = rotation_by(sim.time() * omega);
    // 1234 products, each with a rounding of a few 1e-16.
    const double sign = q.w * expected.w + q.x * expected.x + q.y * expected.y + q.z * expected.z;
    EXPECT_NEAR(std::abs(sign), 1, 1e-14);
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 4e-16);
}

TEST(Orientation, DoesNotDependOnHowARunIsCut) {
    scene::Scene s = test::space_scene(4);
    s.md.orientation = true;
    for (const auto method : {scene::NeighbourMethod::verlet, scene::NeighbourMethod::link_cells}) {
        s.md.neighbours = method;
        md::Simulation straight =
            test::make_simulation(s, test::space_grains(4), simd::available_isas().back(), 2);
        straight.run(300);
        md::Simulation stepped = test::make_simulation(s, test::space_grains(4), simd::Isa::scalar);
        for (int n = 0; n < 150; ++n) stepped.run(1);
        md::Simulation last = test::make_simulation(s, test::space_grains(4), simd::available_isas().back());
        last.restore(stepped.serialise());
        last.run(150);
        EXPECT_EQ(last.state_hash(), straight.state_hash());
    }
}

// Spins change within a contact that lasts: half the step, a quarter of the error.
TEST(Orientation, IsOfSecondOrder) {
    const auto run = [](std::int64_t steps) {
        scene::Scene s = test::space_scene(4);
        s.domain.periodic = {};
        s.materials[0].damping = 0;
        s.materials[0].tangential_damping = 20; // below Coulomb's limit: smooth within the contact
        s.materials[0].friction = 100;
        s.md.orientation = true;
        s.md.integrator = scene::Integrator::gear6;
        s.md.dt = 0.04 / static_cast<double>(steps);
        std::vector<scene::GrainState> grains = {test::grain(0, {3, 3, 3}, {1, 0.5, 0}, 1, 1),
                                                 test::grain(1, {4.9, 3, 3}, {-1, 0, 0.7}, 1, 1)};
        md::Simulation sim = test::make_simulation(s, grains, simd::available_isas().back());
        sim.run(steps);
        EXPECT_GT(norm({sim.snapshot().omega_x[0], sim.snapshot().omega_y[0], sim.snapshot().omega[0]}), 0.2);
        return sim.snapshot().orientation[0];
    };
    const Quaternion coarse = run(64), fine = run(128), finest = run(1024);
    const auto error = [&](const Quaternion& q) {
        return std::hypot(q.x - finest.x, q.y - finest.y, q.z - finest.z);
    };
    EXPECT_NEAR(error(coarse) / error(fine), 4, 0.8);
}
