// `neighbours = "auto"`: lists of pairs for any number of grains, none and one among them, and for a scene
// that fills and empties.
#include "md/support.hpp"
#include "support/lattice_system.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using namespace sandlane::test;
using scene::NeighbourMethod;

TEST(AutoMethod, TakesListsForAnyNumberOfGrains) {
    scene::Scene s = lattice_scene(6, 6);
    for (const std::size_t n : {0U, 1U, 2U, 36U}) {
        std::vector<scene::GrainState> grains = lattice_grains(6, 6);
        grains.resize(n);
        md::Simulation sim = make_simulation(s, grains, simd::available_isas().back());
        EXPECT_EQ(sim.plan().neighbours, NeighbourMethod::verlet);
        sim.run(300);
        EXPECT_EQ(sim.state().size(), n);
    }
}

// Grains are poured in one by one and fall out of the box: the same course as by looking at all pairs.
TEST(AutoMethod, FillsAndEmpties) {
    scene::Scene s = lattice_scene(6, 6);
    s.domain.lower.y = -20;
    s.domain.periodic = {true, false};
    s.domain.gravity = {0, -10, 0};
    std::vector<scene::GrainState> grains = lattice_grains(6, 6);
    for (std::size_t n = 0; n < grains.size(); ++n) grains[n].insert_at = 0.05 * static_cast<double>(n);
    md::Simulation lists = make_simulation(s, grains, simd::available_isas().back());
    s.md.neighbours = NeighbourMethod::brute_force;
    md::Simulation all_pairs = make_simulation(s, grains, simd::available_isas().back());
    std::size_t most = 0;
    for (int part = 0; part < 80; ++part) {
        lists.run(100);
        all_pairs.run(100);
        ASSERT_EQ(lists.state().size(), all_pairs.state().size()) << part;
        most = std::max(most, lists.state().size());
        EXPECT_NEAR(lists.observe().energy(), all_pairs.observe().energy(), 1e-6 * 36 * 200);
    }
    EXPECT_GT(most, 10U);
    EXPECT_EQ(lists.state().size(), 0U);
}
