// Spectra, clusters and fluctuations of particles whose places are known; critical lengths.
#include "analysis/gas_structure.hpp"
#include "analysis/gas_theory.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;

namespace {

analysis::StructurePlan box(int dimension, double edge) {
    analysis::StructurePlan plan;
    plan.gas.dimension = dimension;
    for (int d = 0; d < 3; ++d) plan.gas.upper[d] = d < dimension ? edge : 1;
    plan.cell = edge / 8;
    return plan;
}

std::vector<analysis::StructureParticle> at_random(int dimension, double edge, std::uint32_t n) {
    std::vector<analysis::StructureParticle> all(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto a = philox({i, 0, 0, 0}, {1, 2}), b = philox({i, 1, 0, 0}, {1, 2}),
                   c = philox({i, 2, 0, 0}, {1, 2});
        all[i].place = {edge * unit_number(a[0], a[1]), edge * unit_number(a[2], a[3]),
                        dimension == 3 ? edge * unit_number(b[0], b[1]) : 0};
        all[i].velocity = {unit_number(b[2], b[3]) - 0.5, unit_number(c[0], c[1]) - 0.5,
                           dimension == 3 ? unit_number(c[2], c[3]) - 0.5 : 0};
    }
    return all;
}

} // namespace

// Particles by chance: every spectrum is one, and numbers in cells have the variance of chance. Shells of m
// waves scatter by 1/sqrt(m), the variance of 8^d cells by sqrt(2/8^d): 4 sigma.
TEST(GasStructure, OfChance) {
    for (const int d : {2, 3}) {
        const double edge = 100;
        auto plan = box(d, edge);
        analysis::GasStructure structure(plan);
        auto particles = at_random(d, edge, 20000);
        for (auto& p : particles) p.radius = 1e-6;
        structure.add(1, particles, plan.gas.box(), true);
        const auto shells = structure.shells();
        EXPECT_NEAR(shells.front().k, 2 * std::numbers::pi / edge, 1e-12);
        double waves = 0, density = 0, shear = 0;
        for (std::size_t s = 4; s < shells.size(); ++s) {
            const double n =
                shells[s].k * edge / (2 * std::numbers::pi); // waves: half of a shell of thickness 1/2
            const double m = std::numbers::pi * (d == 3 ? n * n : 0.5 * n);
            waves += m;
            density += m * shells[s].density;
            shear += m * shells[s].shear;
        }
        EXPECT_NEAR(density / waves, 1, 4 / std::sqrt(waves));
        EXPECT_NEAR(shear / waves, 1, 4 / std::sqrt(waves));
        EXPECT_NEAR(structure.rows().front().fluctuation, 1, 4 * std::sqrt(2 / std::pow(8, d)));
        EXPECT_EQ(structure.rows().front().largest, 1.0 / 20000);
        EXPECT_EQ(structure.sizes().front(), 20000);
    }
}

// A wave of density 1 + a cos(k x) and a shear flow u_y = b sin(k x): S = N a^2/4, and b^2/2 over T/m.
TEST(GasStructure, OfWaves) {
    const double edge = 10, a = 0.4, b = 0.3;
    const std::uint32_t n = 40000;
    auto particles = at_random(2, edge, n);
    for (std::uint32_t i = 0; i < n; ++i) {
        double& x = particles[i].place[0];
        const double u = (i + 0.5) / n, k = 2 * std::numbers::pi / edge;
        for (int newton = 0; newton < 20; ++newton) // x + (a/k) sin(k x) = u L
            x -= (x + a / k * std::sin(k * x) - u * edge) / (1 + a * std::cos(k * x));
        particles[i].velocity[1] += b * std::sin(k * x);
        particles[i].radius = 1e-3;
    }
    analysis::GasStructure structure(box(2, edge));
    structure.add(0, particles, box(2, edge).gas.box(), true);
    // The first shell has this wave, and one along y.
    EXPECT_NEAR(structure.shells().front().density / (n * a * a / 4 / 2), 1, 0.01);
    const double temperature = 1.0 / 12 + 0.25 * b * b; // mean of both directions
    // The momentum of the wave, N/2 b, times its part that waves of density do not take (the second
    // harmonic).
    EXPECT_NEAR(structure.shells().front().shear / (n * b * b / 4 / temperature / 2), 1, 0.05);
}

// Chains of known length, one of them across the sides of the box.
TEST(GasStructure, Clusters) {
    for (const int d : {2, 3}) {
        auto plan = box(d, 40);
        std::vector<analysis::StructureParticle> particles;
        const auto chain = [&](double x, double y, int length) {
            for (int n = 0; n < length; ++n) {
                analysis::StructureParticle p;
                p.place = {std::fmod(x + 1.15 * n, 40), y, d == 3 ? 3.0 : 0.0};
                particles.push_back(p);
            }
        };
        chain(35, 39.9, 9); // across the side in x, and next to one in y
        chain(4.4, 0.9, 3); // 1.02 from the end of it
        chain(20, 20, 5);
        chain(20, 22, 1);
        analysis::GasStructure structure(plan);
        structure.add(0, particles, plan.gas.box(), false);
        EXPECT_NEAR(structure.rows()[0].largest, 12.0 / 18, 1e-12) << d;
        EXPECT_NEAR(structure.rows()[0].mean_size, (144 + 25 + 1) / 18.0, 1e-12);
        EXPECT_EQ(structure.sizes(), (std::vector<double>{1, 0, 1, 1}));
        plan.periodic[0] = plan.periodic[1] = false; // the chain is cut in two
        analysis::GasStructure cut(plan);
        cut.add(0, particles, plan.gas.box(), false);
        EXPECT_NEAR(cut.rows()[0].largest, 5.0 / 18, 1e-12);

        analysis::GasStructure again(box(d, 40));
        again.restore(structure.serialise());
        EXPECT_EQ(again.clusters_csv(), structure.clusters_csv());
        EXPECT_EQ(again.structure_csv(), structure.structure_csv());
        EXPECT_EQ(again.sizes_csv(), structure.sizes_csv());
        EXPECT_THROW(again.restore("x"), Error);
    }
}

// Specification of event-driven dynamics, 12.13.
TEST(GasTheory, CriticalLengths) {
    const double table[][5] = {{0.6, 4.723605, 6.477270, 3.336725, 4.318305},
                               {0.9, 8.241465, 15.247330, 5.688987, 8.651581},
                               {0.99, 25.160813, 49.944356, 17.240768, 27.160221}};
    for (const auto& row : table) {
        const auto plane = analysis::critical_lengths(2, row[0], 0.5, 2),
                   space = analysis::critical_lengths(3, row[0], 0.25, 2);
        EXPECT_NEAR(plane.shear, row[1], 1e-5);
        EXPECT_NEAR(plane.cluster, row[2], 1e-5);
        EXPECT_NEAR(space.shear, row[3], 1e-5);
        EXPECT_NEAR(space.cluster, row[4], 1e-5);
    }
}
