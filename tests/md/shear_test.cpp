// Lees-Edwards shear: nothing tells where the seam is.
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace sandlane;

namespace {

struct Cell {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
};

Cell cell(int dimension, scene::TangentialLaw tangential, double shear_rate) {
    Cell c{dimension == 3 ? test::space_scene(6) : test::lattice_scene(12, 12),
           dimension == 3 ? test::space_grains(6) : test::lattice_grains(12, 12)};
    c.scene.domain.shear_rate = shear_rate;
    c.scene.materials[0].tangential_stiffness = 200;
    c.scene.md.tangential = tangential;
    c.scene.md.neighbours = scene::NeighbourMethod::verlet;
    return c;
}

double into(double x, double length) {
    return x - length * std::floor(x / length);
}

} // namespace

// Grains that do not touch follow the flow for ever: x = x_0 + rate (y - y_c) t, whatever they cross.
TEST(Shear, FreeGrainsFollowTheFlow) {
    for (const double rate : {0.3, -0.3}) {
        Cell c = cell(2, scene::TangentialLaw::none, rate);
        c.grains.resize(3);
        for (auto& g : c.grains) {
            g.radius = 0.1;
            g.velocity = {0, 0.5, 0};
        }
        md::Simulation sim = test::make_simulation(c.scene, c.grains, simd::available_isas().back());
        sim.run(50000); // 50 s: they cross the seam
        const analysis::Snapshot s = sim.snapshot();
        const Vec size = c.scene.domain.upper;
        for (std::size_t i = 0; i < 3; ++i) {
            const double y = c.grains[i].position.y + 0.5 * sim.time();
            // In the frame of the unwrapped place the velocity stays what it was at the start.
            const double vx = rate * (c.grains[i].position.y - 0.5 * size.y);
            const double crossed = std::floor(y / size.y);
            EXPECT_GT(crossed, 0);
            EXPECT_NEAR(s.y[i], into(y, size.y), 1e-9);
            EXPECT_NEAR(s.vx[i], vx - crossed * rate * size.y, 1e-9);
            double x = c.grains[i].position.x + vx * sim.time();
            x -= crossed * rate * size.y * sim.time(); // where the image stands now
            EXPECT_NEAR(std::remainder(s.x[i] - x, size.x), 0, 1e-7);
        }
    }
}

// The same cell with its seam through the middle of the other: peculiar velocities and spins are the same.
TEST(Shear, NothingTellsWhereTheSeamIs) {
    for (const int dimension : {2, 3})
        for (const auto tangential : {scene::TangentialLaw::none, scene::TangentialLaw::cundall_strack}) {
            const Cell a = cell(dimension, tangential, 0.8);
            Cell b = a;
            const Vec size = a.scene.domain.upper;
            for (auto& g : b.grains) g.position.y = into(g.position.y + 0.5 * size.y, size.y);
            md::Simulation first = test::make_simulation(a.scene, a.grains, simd::available_isas().back());
            md::Simulation second = test::make_simulation(b.scene, b.grains, simd::available_isas().back());
            first.run(300);
            second.run(300);
            const analysis::Snapshot p = first.snapshot(), q = second.snapshot();
            EXPECT_GT(first.observe().contacts, 20);
            // Rounding of positions, 1e-15, grows in a few collision times; a wrong image shows at 1e-2.
            for (std::size_t i = 0; i < p.size(); ++i) {
                const auto peculiar = [&](const analysis::Snapshot& s) {
                    return s.vx[i] - 0.8 * (s.y[i] - 0.5 * size.y);
                };
                EXPECT_NEAR(peculiar(p), peculiar(q), 1e-9) << i;
                EXPECT_NEAR(p.vy[i], q.vy[i], 1e-9);
                EXPECT_NEAR(p.omega[i], q.omega[i], 1e-9);
            }
            EXPECT_NEAR(first.observe().elastic, second.observe().elastic, 1e-9);
            EXPECT_EQ(first.observe().contacts, second.observe().contacts);
        }
}

TEST(Shear, SameBitsForKernelsThreadsAndAfterACheckpoint) {
    const Cell c = cell(3, scene::TangentialLaw::cundall_strack, 2.0);
    const auto make = [&](simd::Isa isa, int threads) {
        return test::make_simulation(c.scene, c.grains, isa, threads);
    };
    md::Simulation straight = make(simd::Isa::scalar, 1);
    straight.run(600);
    for (const simd::Isa isa : simd::available_isas()) {
        md::Simulation first = make(isa, 2);
        first.run(277);
        md::Simulation second = make(isa, 3);
        second.restore(first.serialise());
        second.run(600 - 277);
        EXPECT_EQ(second.state_hash(), straight.state_hash()) << simd::isa_name(isa);
    }
}

// Momentum of the peculiar velocities stays, and shear makes a stress against it: it heats a cell without
// loss.
TEST(Shear, DrivesTheCellSlow) {
    Cell c = cell(3, scene::TangentialLaw::none, 1.0);
    c.scene.materials[0].damping = 0;
    md::Simulation sim = test::make_simulation(c.scene, c.grains, simd::available_isas().back());
    const auto peculiar = [&] {
        const analysis::Snapshot s = sim.snapshot();
        const double middle = 0.5 * c.scene.domain.upper.y;
        double energy = 0;
        Vec momentum;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec v{s.vx[i] - 1.0 * (s.y[i] - middle), s.vy[i], s.vz[i]};
            energy += 0.5 * s.mass[i] * dot(v, v);
            momentum = momentum + s.mass[i] * v;
        }
        return std::pair{energy, momentum};
    };
    const auto [before, start] = peculiar();
    sim.run(2000);
    const auto [after, end] = peculiar();
    EXPECT_GT(after, 1.5 * before);
    EXPECT_NEAR(end.y, start.y, 1e-10);
    EXPECT_NEAR(end.z, start.z, 1e-10);
}

// Without loss all work of the shear is there as energy; what is missing is the error of the integrator, some
// 1e-4 of what collisions exchange, and that of a sum over steps, both of the second order or better.
// Both ways of shearing.
TEST(SlowShear, WorkIsBooked) {
    for (const int dimension : {2, 3, -2}) {
        Cell c = cell(std::abs(dimension), scene::TangentialLaw::none, dimension > 0 ? 1.0 : -1.0);
        c.scene.materials[0].damping = 0;
        double missing[2];
        for (const int finer : {1, 4}) {
            c.scene.md.dt = 1e-3 / finer;
            md::Simulation sim = test::make_simulation(c.scene, c.grains, simd::available_isas().back());
            const double before = sim.observe().energy();
            sim.run(2000 * finer);
            const md::Observables now = sim.observe();
            EXPECT_GT(std::abs(sim.shear_work()), 100);
            EXPECT_NEAR(now.energy() - before, sim.shear_work(), 1e-3 * std::abs(sim.shear_work()));
            missing[finer / 4] = std::abs(sim.dissipated(now));
        }
        EXPECT_LT(missing[1], 0.25 * missing[0]);
    }
}

// Contacts take and never give; springs hold some of it, and give it back.
TEST(Shear, DissipationGrowsSlow) {
    for (const int dimension : {2, 3}) {
        Cell c = cell(dimension, scene::TangentialLaw::cundall_strack, 1.0);
        md::Simulation sim = test::make_simulation(c.scene, c.grains, simd::available_isas().back());
        double most = 0;
        for (int part = 0; part < 20; ++part) {
            sim.run(100);
            const double now = sim.dissipated(sim.observe());
            EXPECT_GT(now, most - 0.01 * std::abs(sim.shear_work()));
            most = std::max(most, now);
        }
        EXPECT_GT(most, 100);
    }
}

TEST(Shear, WorkIsTheSameAfterACheckpoint) {
    const Cell c = cell(3, scene::TangentialLaw::cundall_strack, 2.0);
    md::Simulation straight = test::make_simulation(c.scene, c.grains, simd::available_isas().back());
    straight.run(500);
    for (const simd::Isa isa : simd::available_isas()) {
        md::Simulation first = test::make_simulation(c.scene, c.grains, isa, 2);
        first.run(277);
        md::Simulation second = test::make_simulation(c.scene, c.grains, isa, 3);
        second.restore(first.serialise());
        second.run(500 - 277);
        EXPECT_EQ(second.shear_work(), straight.shear_work()) << simd::isa_name(isa);
    }
}
