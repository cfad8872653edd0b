// A restored simulation goes on bit for bit, with another instruction set and thread count too.
#include "core/error.hpp"
#include "support/lattice_system.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using scene::NeighbourMethod;

namespace {

// Discs that fall into an open box with a floor, some of them poured while the run goes on, some leaving.
scene::Scene falling_scene(NeighbourMethod method,
                           scene::TangentialLaw tangential = scene::TangentialLaw::haff_werner) {
    scene::Scene s = test::lattice_scene(12, 12);
    s.domain.lower = {-6, -4, 0};
    s.domain.upper = {30, 40, 0};
    s.domain.periodic = {true, false};
    s.domain.gravity = {0.5, -1, 0};
    s.md.neighbours = method;
    s.md.tangential = tangential;
    s.materials[0].tangential_stiffness = 300;
    scene::Motion motion;
    motion.name = "shake";
    motion.kind = scene::MotionKind::oscillate;
    motion.amplitude = {0, 0.2, 0};
    motion.omega = 3;
    s.motions = {motion};
    scene::Wall floor;
    floor.name = "floor";
    floor.kind = scene::WallKind::segment;
    floor.points = {{-5, -1.2, 0}, {20, -1.2, 0}};
    floor.motion = "shake";
    s.walls = {floor};
    return s;
}

std::vector<scene::GrainState> falling_grains() {
    auto grains = test::lattice_grains(12, 12);
    for (auto& g : grains) g.position = {1.05 * g.position.x, 1.05 * g.position.y, 0};
    for (int n = 0; n < 20; ++n) {
        scene::GrainState g = grains[static_cast<std::size_t>(n)];
        g.id = static_cast<std::int64_t>(grains.size());
        g.position = {2.0 + n % 5, 35, 0};
        g.velocity = {0, -1, 0};
        g.insert_at = 0.02 * n;
        grains.push_back(g);
    }
    return grains;
}

} // namespace

TEST(Resume, SameBitsAsUndisturbed) {
    for (const auto method : {NeighbourMethod::lattice, NeighbourMethod::lattice_half,
                              NeighbourMethod::link_cells, NeighbourMethod::verlet}) {
        const scene::Scene s = falling_scene(method);
        const auto grains = falling_grains();
        md::Simulation straight = test::make_simulation(s, grains, simd::available_isas().back());
        straight.run(1500);
        EXPECT_GT(straight.delayed(), 0); // some poured grains had to wait
        md::Simulation first = test::make_simulation(s, grains, simd::available_isas().front());
        first.run(613);
        const std::string saved = first.serialise();
        md::Simulation second = test::make_simulation(s, grains, simd::available_isas().back(), 2);
        second.restore(saved);
        EXPECT_EQ(second.state_hash(), first.state_hash());
        second.run(1500 - 613);
        EXPECT_EQ(second.state_hash(), straight.state_hash());
        EXPECT_EQ(second.wall_work(), straight.wall_work());
        EXPECT_NE(straight.wall_work(), 0);
        EXPECT_EQ(second.removed(), straight.removed());
    }
}

// Springs of contacts, also with walls, survive checkpoints, sorts, insertions and removals.
TEST(Resume, MemoryOfContactsGoesAlong) {
    const scene::Scene s = falling_scene(NeighbourMethod::verlet, scene::TangentialLaw::cundall_strack);
    md::Simulation straight = test::make_simulation(s, falling_grains(), simd::available_isas().back(), 2);
    straight.run(1500);
    md::Simulation first = test::make_simulation(s, falling_grains(), simd::Isa::scalar);
    for (const int part : {17, 300, 96, 500}) {
        first.run(part);
        md::Simulation next = test::make_simulation(s, falling_grains(), simd::Isa::scalar);
        next.restore(first.serialise());
        EXPECT_TRUE(next.serialise() == first.serialise()); // too long to print
        first = next;
    }
    first.run(1500 - 913);
    EXPECT_EQ(first.state_hash(), straight.state_hash());
}

TEST(Resume, OneStepAtATimeIsTheSameRun) {
    for (const auto method : {NeighbourMethod::lattice_half, NeighbourMethod::verlet}) {
        const scene::Scene s = falling_scene(method);
        md::Simulation straight = test::make_simulation(s, falling_grains(), simd::available_isas().back());
        md::Simulation stepped = test::make_simulation(s, falling_grains(), simd::available_isas().back());
        straight.run(400);
        for (int n = 0; n < 400; ++n) stepped.run(1);
        EXPECT_EQ(stepped.state_hash(), straight.state_hash());
    }
}

TEST(Resume, StateOfAnotherSceneIsRefused) {
    const scene::Scene s = falling_scene(NeighbourMethod::lattice_half);
    md::Simulation a = test::make_simulation(s, falling_grains(), simd::Isa::scalar);
    scene::Scene other = s;
    other.md.integrator = scene::Integrator::gear4;
    md::Simulation b = test::make_simulation(other, falling_grains(), simd::Isa::scalar);
    EXPECT_THROW(b.restore(a.serialise()), Error);
    const std::string bytes = a.serialise();
    EXPECT_THROW(a.restore(bytes.substr(0, bytes.size() / 2)), Error);
}
