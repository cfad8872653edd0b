// Walls in space inside whole simulations: loads, energy, the same bits for everyone, and checkpoints.
#include "support/space_system.hpp"
#include "support/stl_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace sandlane;
using scene::NeighbourMethod;
using scene::TangentialLaw;

namespace {

// A packing that falls to pieces in a tumbling box of triangles.
scene::Scene tumbler(int side, TangentialLaw law) {
    scene::Scene s = test::space_scene(side);
    s.md.tangential = law;
    s.domain.periodic = {false, false, false};
    s.domain.gravity = {0, 0, -5};
    const double upper = s.domain.upper.x - 0.9; // just above the last grains
    scene::Wall box;
    box.name = "box";
    box.kind = scene::WallKind::mesh;
    const Vec low{-1.1, -1.1, -1.1}, high{upper, upper, upper};
    box.file = test::stl_file("tumbler", test::stl_text(test::box_triangles(low, high)));
    box.motion = "tumble";
    s.walls = {box};
    scene::Motion tumble;
    tumble.name = "tumble";
    tumble.kind = scene::MotionKind::rotate;
    tumble.centre = 0.5 * (low + high);
    tumble.axis = {1, 2, 0.5};
    tumble.omega = 0.5;
    s.motions = {tumble};
    s.domain.lower = -1.0 * s.domain.upper;
    s.domain.upper = 2.0 * s.domain.upper;
    return s;
}

// As test::space_grains, not wrapped: all inside of the box.
std::vector<scene::GrainState> packing(int side) {
    std::vector<scene::GrainState> grains = test::space_grains(side);
    const double length = side * 1.98;
    for (scene::GrainState& g : grains)
        for (double Vec::*x : {&Vec::x, &Vec::y, &Vec::z})
            if (g.position.*x > length - 0.9) g.position.*x -= length;
    return grains;
}

} // namespace

TEST(SurfaceSimulation, SameBitsForEveryIsaAndThreadCount) {
    const scene::Scene s = tumbler(11, TangentialLaw::cundall_strack); // two tiles
    std::string reference;
    for (const simd::Isa isa : simd::available_isas())
        for (const int threads : {1, 2, 3}) {
            if (threads > 2 && isa != simd::available_isas().back()) continue;
            md::Simulation sim = test::make_simulation(s, packing(11), isa, threads);
            sim.run(300); // crosses a sort of the storage, at step 256
            EXPECT_GT(sim.observe().wall_contacts, 100);
            const std::string hash = sim.state_hash().hex();
            if (reference.empty()) reference = hash;
            EXPECT_EQ(hash, reference) << simd::isa_name(isa) << " threads " << threads;
        }
}

TEST(SurfaceSimulation, MethodsAgree) {
    scene::Scene s = tumbler(4, TangentialLaw::haff_werner);
    md::Simulation sim = test::make_simulation(s, packing(4), simd::available_isas().back());
    sim.run(300);
    const std::vector<double> expected = sim.forces(simd::Isa::scalar, NeighbourMethod::brute_force);
    for (const auto method : {NeighbourMethod::link_cells, NeighbourMethod::verlet}) {
        const std::vector<double> found = sim.forces(simd::available_isas().back(), method);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-10);
    }
}

TEST(SurfaceSimulation, ResumesWithTheSameBits) {
    const scene::Scene s = tumbler(4, TangentialLaw::cundall_strack);
    md::Simulation straight = test::make_simulation(s, packing(4), simd::available_isas().back(), 2);
    straight.run(600);
    md::Simulation first = test::make_simulation(s, packing(4), simd::Isa::scalar);
    for (const int part : {17, 300, 96}) {
        first.run(part);
        md::Simulation next = test::make_simulation(s, packing(4), simd::Isa::scalar);
        next.restore(first.serialise());
        first = next;
    }
    first.run(600 - 413);
    EXPECT_EQ(first.state_hash(), straight.state_hash());
    EXPECT_EQ(first.wall_work(), straight.wall_work());
    EXPECT_NE(straight.wall_work(), 0);
}

// Elastic, frictionless: what the tumbling box gives is what the grains have.
TEST(SurfaceSimulation, WorkOfTheBoxIsEnergyOfTheGrains) {
    scene::Scene s = tumbler(4, TangentialLaw::none);
    s.materials[0].damping = 0;
    s.md.dt = 2e-4;
    std::vector<scene::GrainState> grains = packing(4);
    for (scene::GrainState& g : grains) g.angular_velocity = {};
    md::Simulation sim = test::make_simulation(s, grains, simd::available_isas().back());
    const double before = sim.observe().kinetic;
    sim.run(5000);
    EXPECT_GT(std::abs(sim.wall_work()), 0.1 * before);
    EXPECT_EQ(sim.removed(), 0);
    EXPECT_NEAR(sim.dissipated(sim.observe()), 0, 1e-4 * before);
}

// A sphere that slides at the bottom of a turning cylinder: friction drags it, and brakes the cylinder.
TEST(SurfaceSimulation, LoadsOnATurningCylinder) {
    const double overlap = 1e-3, drum = 10, radius = 1;
    scene::Scene s = test::space_scene(20);
    s.md.tangential = TangentialLaw::haff_werner;
    s.domain.periodic = {false, false, false};
    s.materials[0].tangential_damping = 1e4;
    s.md.dt = 1e-6;
    const Vec centre{20, 20, 20};
    scene::Wall wall;
    wall.kind = scene::WallKind::cylinder;
    wall.points = {centre - Vec{0, 15, 0}, centre + Vec{0, 15, 0}};
    wall.radius = drum;
    wall.motion = "turn";
    s.walls = {wall};
    s.motions.resize(1);
    s.motions[0].name = "turn";
    s.motions[0].kind = scene::MotionKind::rotate;
    s.motions[0].centre = centre;
    s.motions[0].axis = {0, 1, 0};
    s.motions[0].omega = 2;
    scene::GrainState ball;
    ball.position = centre - Vec{0, 3, drum - radius + overlap};
    ball.radius = radius;
    ball.mass = 1;
    const md::Simulation sim = test::make_simulation(s, {ball}, simd::available_isas().back());
    const md::WallLoad load = sim.observe().walls.at(0);
    const double normal = s.materials[0].stiffness * overlap, friction = s.materials[0].friction * normal;
    const double tolerance = 1e-10 * normal; // the overlap has lost four digits
    // omega x r at the bottom points along -x, and so does the force on the sphere.
    EXPECT_NEAR(load.force.x, friction, tolerance);
    EXPECT_NEAR(load.force.y, 0, tolerance);
    EXPECT_NEAR(load.force.z, -normal, tolerance);
    // r x F with r = (0, -3, -drum)
    EXPECT_NEAR(load.torque.x, 3 * normal, 20 * tolerance);
    EXPECT_NEAR(load.torque.y, -drum * friction, 20 * tolerance);
    EXPECT_NEAR(load.torque.z, 3 * friction, 20 * tolerance);
    EXPECT_NEAR(load.power, 2 * drum * friction, 20 * tolerance);
}
