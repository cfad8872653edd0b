// `neighbours = "auto"` is asked again as grains come and go: by their number alone, at steps that do not
// depend on how a run is cut.
#include "md/support.hpp"
#include "support/lattice_system.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using namespace sandlane::test;
using scene::NeighbourMethod;

namespace {

// 36 grains that fall; a sink at the bottom takes them, one row after the other.
struct Emptying {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
};

Emptying emptying() {
    Emptying e{lattice_scene(6, 6), lattice_grains(6, 6)};
    e.scene.domain.lower.y = -60;
    e.scene.domain.periodic = {true, false};
    e.scene.domain.gravity = {0, -10, 0};
    scene::Sink sink;
    sink.lower = {-1, -60, 0};
    sink.upper = {100, -2, 0};
    e.scene.sinks = {sink};
    return e;
}

} // namespace

TEST(AutoMethod, FollowsTheNumberOfGrains) {
    EXPECT_EQ(md::automatic_method(md::few_grains), NeighbourMethod::brute_force);
    EXPECT_EQ(md::automatic_method(md::few_grains + 1), NeighbourMethod::verlet);
    const Emptying e = emptying();
    md::Simulation sim = make_simulation(e.scene, e.grains, simd::available_isas().back());
    EXPECT_EQ(sim.plan().neighbours, NeighbourMethod::verlet);
    while (sim.state().size() > md::few_grains) sim.run(1);
    sim.run(256 - sim.step() % 256 + 1); // the next question
    EXPECT_EQ(sim.plan().neighbours, NeighbourMethod::brute_force);
    EXPECT_GT(sim.state().size(), 0U);
    // Asked for by name it stays.
    scene::Scene fixed = e.scene;
    fixed.md.neighbours = NeighbourMethod::verlet;
    md::Simulation asked = make_simulation(fixed, e.grains, simd::available_isas().back());
    asked.run(sim.step());
    EXPECT_EQ(asked.plan().neighbours, NeighbourMethod::verlet);
    EXPECT_EQ(asked.state().size(), sim.state().size());
}

TEST(AutoMethod, SameBitsForKernelsThreadsAndAfterACheckpoint) {
    const Emptying e = emptying();
    const auto make = [&](simd::Isa isa, int threads) {
        return make_simulation(e.scene, e.grains, isa, threads);
    };
    md::Simulation straight = make(simd::Isa::scalar, 1);
    straight.run(1500);
    EXPECT_EQ(straight.plan().neighbours, NeighbourMethod::brute_force);
    for (const simd::Isa isa : simd::available_isas())
        for (const std::int64_t cut : {300, 1100}) {
            md::Simulation first = make(isa, 2);
            first.run(cut);
            md::Simulation second = make(isa, 3);
            second.restore(first.serialise());
            EXPECT_EQ(second.plan().neighbours, first.plan().neighbours);
            second.run(1500 - cut);
            EXPECT_EQ(second.state_hash(), straight.state_hash()) << simd::isa_name(isa) << ' ' << cut;
        }
}
