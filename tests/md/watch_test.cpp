// What a run tells of its own error: the balances close where they must, open with the time step, and limits
// stop it.
#include "support/says.hpp"

#include "md/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace sandlane;
using namespace sandlane::test;
using scene::TangentialLaw;

namespace {

constexpr double radius = 0.01, mass = 0.02, stiffness = 1e4;

scene::Scene watching(double damping) {
    scene::Scene s = empty_scene();
    s.materials[0].stiffness = stiffness;
    s.materials[0].damping = damping;
    s.walls = {floor_plane()};
    s.domain.gravity = {0, -9.81, 0};
    for (scene::WatchLimit* limit : {&s.watch.overlap, &s.watch.energy, &s.watch.momentum, &s.watch.step})
        limit->asked = true;
    return s;
}

// Grains that fall on the floor and on each other.
std::vector<scene::GrainState> heap(int columns = 10, int rows = 10) {
    std::vector<scene::GrainState> grains;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            grains.push_back(grain(static_cast<std::int64_t>(grains.size()),
                                   {0.021 * column + 0.003 * (row % 3) - 0.1, 0.011 + 0.021 * row, 0},
                                   {0.1 * (column % 2 == 0 ? 1 : -1), -0.5, 0}, radius, mass, 0.0));
    return grains;
}

// Errors after 0.05 s, and the largest until then.
namespace watched = analysis::watched;
struct Errors {
    analysis::Watched now;
    md::Balance balance;
    double peak[watched::count] = {};
};
Errors after(const scene::Scene& s, const std::vector<scene::GrainState>& grains) {
    md::Simulation sim = simulate(s, grains);
    Errors e;
    for (int look = 0; look <= 20; ++look) {
        if (look > 0) sim.run(static_cast<std::int64_t>(0.0025 / sim.plan().dt));
        e.now = sim.watch(sim.observe());
        for (std::size_t n = 0; n < watched::count; ++n) e.peak[n] = std::max(e.peak[n], e.now.value[n]);
    }
    e.balance = sim.balance();
    return e;
}

} // namespace

TEST(Watch, FallingGrainsKeepBothBalances) {
    const Errors e = after(watching(0), {grain(0, {0, 0.9, 0}, {1, 2, 0}, radius, mass),
                                         grain(1, {0.5, 0.9, 0}, {1, 2, 0}, radius, mass)});
    EXPECT_LT(e.peak[watched::energy], 1e-12);
    EXPECT_LT(e.peak[watched::momentum], 1e-12);
    EXPECT_EQ(e.peak[watched::step], 0); // no contacts
}

// Rounding only: a Verlet step is the trapezoidal sum of its forces.
TEST(Watch, VerletKeepsTheMomentumThatWallsGive) {
    scene::Scene s = watching(2);
    s.md.integrator = scene::Integrator::velocity_verlet;
    const Errors e = after(s, heap());
    EXPECT_GT(norm(e.balance.wall_impulse), 0.1 * e.balance.most_momentum);
    EXPECT_LT(e.peak[watched::momentum], 1e-12);
}

// Friction, damping, spins, a moving wall, every method of finding pairs: a smaller step, a smaller residual.
TEST(Watch, TheResidualFollowsTheStep) {
    scene::Scene s = watching(2);
    s.md.integrator = scene::Integrator::velocity_verlet;
    s.md.tangential = TangentialLaw::haff_werner;
    s.materials[0].friction = 0.5;
    s.materials[0].tangential_damping = 4;
    scene::Motion shaken;
    shaken.name = "shaken";
    shaken.kind = scene::MotionKind::oscillate;
    shaken.amplitude = {0, 0.002, 0};
    shaken.omega = 200;
    s.motions = {shaken};
    s.walls[0].motion = "shaken";
    double residual[2] = {};
    for (const int part : {0, 1}) {
        s.md.dt = 4e-5 / (part == 0 ? 1 : 8);
        residual[part] = after(s, heap()).peak[watched::energy];
    }
    EXPECT_LT(residual[0], 1e-2);
    EXPECT_LT(residual[1], 0.2 * residual[0]);
    s.md.dt = 4e-5;
    s.md.neighbours = scene::NeighbourMethod::link_cells;
    const double cells = after(s, heap()).peak[watched::energy];
    EXPECT_NEAR(cells, residual[0], 0.5 * residual[0]); // another order of additions, a chaotic system
}

// Without loss all energy is compared, and the error of a step shows as it is.
TEST(Watch, WithoutLossTheResidualIsTheDrift) {
    scene::Scene s = watching(0);
    s.domain.gravity = {};
    s.walls.clear();
    const auto pair = [](double dt) {
        return std::vector{grain(0, {-radius - 0.3 * dt, 0, 0}, {0.5, 0, 0}, radius, mass),
                           grain(1, {radius + 0.3 * dt, 0, 0}, {-0.5, 0, 0}, radius, mass)};
    };
    s.md.dt = 1e-4; // t_c/31
    md::Simulation sim = simulate(s, pair(s.md.dt));
    const double before = sim.observe().energy();
    (void)sim.watch(sim.observe());
    sim.run(100);
    const md::Observables end = sim.observe();
    const double drift = std::abs(end.energy() - before) / before;
    EXPECT_GT(drift, 1e-5);
    // The scale: the energy, and what seems to be dissipated.
    EXPECT_NEAR(sim.watch(end).value[watched::energy], drift, 0.01 * drift);
}

TEST(Watch, TheSampleIsThatOfItsContacts) {
    scene::Scene s = watching(2);
    md::Simulation sim = simulate(s, heap());
    sim.run(static_cast<std::int64_t>(0.02 / sim.plan().dt));
    const md::Observables now = sim.observe();
    ASSERT_GT(now.contacts + now.wall_contacts, 20);
    const double all = sim.watch(now).value[watched::step];
    EXPECT_GT(all, 1e-4); // e of a dashpot at t_c/50: 2e-3 and less
    EXPECT_LT(all, 2e-2);
    EXPECT_EQ(sim.watch(now).value[watched::step], all);
    EXPECT_SAYS(sim.watch(now).where[watched::step], "grain");
    s.md.dt = 0.1 * sim.plan().dt;
    md::Simulation finer = simulate(s, heap());
    finer.run(static_cast<std::int64_t>(0.02 / finer.plan().dt));
    EXPECT_LT(finer.watch(finer.observe()).value[watched::step], 0.3 * all);
    s.watch.sample = 3;
    md::Simulation few = simulate(s, heap());
    few.run(static_cast<std::int64_t>(0.02 / few.plan().dt));
    EXPECT_GT(few.watch(few.observe()).value[watched::step], 0);
}

TEST(Watch, AnOverlapBetweenTwoRowsStopsTheRun) {
    const std::vector<scene::GrainState> pair = {grain(7, {-0.02, 0.5, 0}, {1, 0, 0}, radius, mass),
                                                 grain(9, {0.02, 0.5, 0}, {-1, 0, 0}, 2 * radius, mass)};
    const auto outcome = [](const scene::Scene& s, const std::vector<scene::GrainState>& grains) {
        md::Simulation sim = simulate(s, grains);
        try {
            sim.run(static_cast<std::int64_t>(0.05 / sim.plan().dt));
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Exit::unstable);
            return std::string(e.what());
        }
        return std::string();
    };
    scene::Scene s = watching(0);
    s.domain.gravity = {};
    // xi_max = g sqrt(m_eff/k) = 2e-3 m, a fifth of the smaller radius
    s.watch.overlap.stop = 0.21;
    EXPECT_EQ(outcome(s, pair), "");
    s.watch.overlap.stop = 0.1;
    const std::string said = outcome(s, pair);
    EXPECT_SAYS(said, "grains 7 and 9 at (");
    EXPECT_SAYS(said, "watch.largest_overlap allows (0.1)");
    EXPECT_SAYS(outcome(s, {grain(3, {0, 0.02, 0}, {0, -2, 0}, radius, mass)}), "grain 3 and wall \"floor\"");
}

// Nothing of the state, and the same numbers after a checkpoint.
TEST(Watch, ChangesNothingAndGoesAlong) {
    scene::Scene s = watching(2);
    md::Simulation watched = simulate(s, heap());
    s.watch = {};
    md::Simulation alone = simulate(s, heap());
    watched.run(300);
    alone.run(300);
    EXPECT_EQ(watched.state_hash(), alone.state_hash());
    EXPECT_EQ(alone.balance().kind, 0);
    (void)watched.watch(watched.observe());
    md::Simulation resumed = simulate(watched.scene(), heap());
    resumed.restore(watched.serialise());
    for (md::Simulation* sim : {&watched, &resumed}) sim->run(400);
    const analysis::Watched a = watched.watch(watched.observe()), b = resumed.watch(resumed.observe());
    for (std::size_t n = 0; n < watched::count; ++n) EXPECT_EQ(a.value[n], b.value[n]) << n;
    // Watched from the checkpoint on.
    md::Simulation later = simulate(watched.scene(), heap());
    later.restore(alone.serialise());
    EXPECT_GT(later.balance().kind, 0);
    later.run(400);
    EXPECT_LT(later.watch(later.observe()).value[watched::momentum], 1e-2);
}
