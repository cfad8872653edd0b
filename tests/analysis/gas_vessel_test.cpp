// How much of a vessel lies in each cell; profiles and fluctuations of gases that fill one evenly.
#include "analysis/gas_structure.hpp"
#include "analysis/gas_vessel.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

using namespace sandlane;

namespace {

constexpr double pi = std::numbers::pi;

struct Particle {
    std::array<double, 3> place{}, velocity{}, spin{};
};

analysis::GasVessel cube(int dimension, double half) {
    analysis::GasVessel v;
    v.dimension = dimension;
    for (int d = 0; d < dimension; ++d) v.lower[d] = -half, v.upper[d] = half;
    return v;
}

analysis::CellGrid grid_of(const analysis::GasVessel& v, int axis, std::size_t bins) {
    analysis::CellGrid g;
    for (int d = 0; d < 3; ++d) g.lower[d] = v.lower[d], g.upper[d] = v.upper[d];
    g.cells[axis] = bins;
    return g;
}

double sum(const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0);
}

// n particles by chance where `inside` says.
template <class Inside>
std::vector<Particle> fill(const analysis::GasVessel& v, std::size_t n, const Inside& inside) {
    std::vector<Particle> all;
    for (std::uint32_t i = 0; all.size() < n; ++i) {
        const auto a = philox({i, 0, 0, 0}, {5, 6}), b = philox({i, 1, 0, 0}, {5, 6});
        const double unit[3] = {unit_number(a[0], a[1]), unit_number(a[2], a[3]), unit_number(b[0], b[1])};
        Particle p;
        for (std::size_t d = 0; d < static_cast<std::size_t>(v.dimension); ++d)
            p.place[d] = v.lower[d] + unit[d] * (v.upper[d] - v.lower[d]);
        p.velocity[0] = i % 2 == 0 ? 1 : -1;
        if (inside(p.place)) all.push_back(p);
    }
    return all;
}

} // namespace

// Slices of a ball: pi (R^2 x - x^3/3) between planes. Of a cylinder along, and across.
TEST(GasVessel, SlicesOfRoundWalls) {
    for (const int axis : {0, 1, 2}) {
        analysis::GasVessel v = cube(3, 2);
        v.round = {{{0, 0, 0}, 2, -1, true}};
        const auto ball = contents(v, grid_of(v, axis, 10));
        const auto below = [](double x) { return pi * (4 * x - x * x * x / 3); };
        for (std::size_t n = 0; n < 10; ++n) {
            const double x = -2 + 0.4 * static_cast<double>(n);
            EXPECT_NEAR(ball[n], below(x + 0.4) - below(x), 2e-3 * ball[n]) << axis << n;
        }
        v.round = {{{0, 0, 0}, 2, 2, true}, {{0.5, 0, 0}, 0.5, 2, false}};
        EXPECT_NEAR(sum(contents(v, grid_of(v, axis, 8))), 4 * pi * (4 - 0.25), 1e-3 * 47) << axis;
    }
    analysis::GasVessel flat = cube(2, 3);
    flat.round = {{{1, 0, 0}, 2, -1, true}, {{1, 0, 0}, 1, -1, false}, {{1.5, 0, 0}, 1, -1, false}};
    // Two pins that overlap: 2 acos(d/2) - d/2 sqrt(4 - d^2) of both, d = 0.5.
    const double both = 2 * std::acos(0.25) - 0.25 * std::sqrt(4 - 0.25);
    EXPECT_NEAR(sum(contents(flat, grid_of(flat, 0, 12))), 4 * pi - (2 * pi - both), 1e-3);
    EXPECT_NEAR(sum(contents(flat, grid_of(flat, 1, 12))), 4 * pi - (2 * pi - both), 1e-3);
}

// Cells end where the sides are now, and those at the sides reach to them.
TEST(GasVessel, SidesThatMoved) {
    analysis::GasVessel v = cube(3, 2);
    const analysis::CellGrid grid = grid_of(v, 0, 4);
    v.lower[0] = -0.5;
    v.upper[0] = 2.25;
    EXPECT_EQ(contents(v, grid), (std::vector<double>{0, 8, 16, 20}));
}

// An even gas has the same density in all bins of a round vessel, and of a box that grew; fluctuations in
// cells are those of chance: 4 sigma.
TEST(GasVessel, EvenGasIsEven) {
    for (const int d : {2, 3}) {
        analysis::GasVessel v = cube(d, 1);
        v.round = {{{0, 0, 0}, 1, -1, true}, {{0, 0, 0}, 0.5, -1, false}};
        const std::size_t n = 40000;
        const auto particles = fill(v, n, [&](const auto& x) {
            const double r = std::hypot(x[0], x[1], x[2]);
            return r < 1 && r > 0.5;
        });
        analysis::GasFrame frame;
        frame.dimension = d;
        for (int c = 0; c < d; ++c) frame.lower[c] = -1, frame.upper[c] = 1;
        analysis::GasSamples samples(frame, 1, 8);
        samples.add(particles, v, [](const Particle&) { return analysis::GasRatio{}; });
        const double volume = d == 3 ? 4 * pi / 3 * 0.875 : pi * 0.75, density = n / volume;
        const auto parts = contents(v, grid_of(v, 1, 8));
        for (std::size_t b = 0; b < 8; ++b)
            EXPECT_NEAR(samples.profile_rows()[b].density / density, 1,
                        0.002 + 4 / std::sqrt(density * parts[b]))
                << d << b;
        analysis::StructurePlan plan;
        plan.gas = frame;
        plan.periodic[0] = plan.periodic[1] = plan.periodic[2] = false;
        plan.cell = 0.25;
        analysis::GasStructure structure(plan);
        std::vector<analysis::StructureParticle> seen;
        for (const Particle& p : particles) seen.push_back({p.place, p.velocity, 1, 1e-6});
        structure.add(0, seen, v, true);
        EXPECT_NEAR(structure.rows()[0].fluctuation, 1, 4 * std::sqrt(2 / (volume / std::pow(0.25, d))));
    }
}

// Of two frames the second has twice the room: each bin has the mean of the particles over that of its room.
TEST(GasVessel, RecedingSide) {
    analysis::GasFrame frame;
    frame.dimension = 2;
    frame.upper[0] = 4;
    analysis::GasSamples samples(frame, 0, 4);
    analysis::GasVessel v = frame.box();
    for (const double end : {2.0, 4.0}) {
        v.upper[0] = end;
        std::vector<Particle> particles;
        for (int n = 0; n < 400; ++n) particles.push_back({{(n + 0.5) / 400 * end, 0.5, 0}, {}, {}});
        samples.add(particles, v, [](const Particle&) { return analysis::GasRatio{}; });
    }
    const auto rows = samples.profile_rows();
    const double expected[] = {150, 150, 100, 100};
    for (std::size_t b = 0; b < 4; ++b) EXPECT_NEAR(rows[b].density, expected[b], 1e-9);
}

// Spins of a mixture count with their own moments of inertia: J w^2 is the same for both kinds here.
TEST(GasSamples, SpinTemperatureOfAMixture) {
    analysis::GasFrame frame;
    frame.rough = true;
    frame.moment = 0.1;
    analysis::GasSamples samples(frame, 0, 1);
    std::vector<Particle> particles(2);
    particles[0].spin = {1, 1, 1};
    particles[1].spin = {0.5, 0.5, 0.5}; // four times the moment
    samples.add(particles, frame.box(), [&](const Particle& p) {
        return p.spin[0] == 1 ? analysis::GasRatio{1, 1} : analysis::GasRatio{2, 4};
    });
    const std::string table = samples.profile();
    EXPECT_EQ(table.substr(table.find_last_of(',') + 1), "0.1\n");
}
