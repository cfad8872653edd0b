// Collisions in single cells: the numbers of the specification, conservation, limits.
#include "dsmc/reference/pair.hpp"
#include "dsmc/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace sandlane;

namespace {

// A tile of equal cells with rows that a test fills.
struct Tile {
    std::vector<double> place, velocity, spin, lists[simd::gas_lists];
    std::vector<std::int32_t> start;
    simd::GasCollisionView view{};

    Tile(std::int32_t cells, std::int32_t per_cell)
        : place(rows(cells * per_cell)), velocity(rows(cells * per_cell)), spin(rows(cells * per_cell)),
          start(static_cast<std::size_t>(cells) + 2) {
        for (std::int32_t c = 0; c <= cells; ++c) start[static_cast<std::size_t>(c)] = c * per_cell;
        for (auto& list : lists) list.resize(static_cast<std::size_t>(cells) + 16);
        view.rows = {place.data(), velocity.data(), spin.data()};
        view.start = start.data();
        view.cells = cells;
        for (int n = 0; n < simd::gas_lists; ++n) view.list[n] = lists[n].data();
        view.margin = 1.1;
        view.restitution.eps = 1;
        view.tangential = 1;
        view.inertia = 0.4;
        view.mass_ratio = 2.0 / 7;
        view.radius = 0.5;
        view.random = {{12345, 0}, 3, 0};
    }
    static std::size_t rows(std::int32_t n) { return static_cast<std::size_t>(n + 8) * simd::gas_row; }
    void set(std::int32_t i, double x, double y, double z) {
        double* v = velocity.data() + std::ptrdiff_t{i} * simd::gas_row;
        v[0] = x, v[1] = y, v[2] = z;
    }
    [[nodiscard]] std::array<double, 3> momentum() const {
        std::array<double, 3> p{};
        for (std::size_t i = 0; i < velocity.size(); ++i)
            if (i % 4 < 3) p[i % 4] += velocity[i];
        return p;
    }
    [[nodiscard]] double energy() const {
        double e = 0;
        for (std::size_t i = 0; i < velocity.size(); ++i) e += 0.5 * velocity[i] * velocity[i];
        for (const double w : spin) e += 0.5 * 0.4 * 0.25 * w * w;
        return e;
    }
    void fill(double spins) {
        const auto key = dsmc::Setup{};
        const auto gas =
            dsmc::maxwellian(key, static_cast<std::uint32_t>(start[static_cast<std::size_t>(view.cells)]), 1);
        for (const auto& p : gas) {
            set(static_cast<std::int32_t>(p.id), p.velocity[0], p.velocity[1], p.velocity[2]);
            for (std::size_t d = 0; d < 3; ++d) spin[4 * p.id + d] = spins * p.velocity[2 - d];
        }
    }
};

} // namespace

// Specification 10.13: mean 5.7 candidates, majorant 4, eps 0.8, seed 12345, cell 7, step 3.
TEST(Cell, CandidatesOfTheSpecification) {
    Tile tile(1, 5);
    const double v[5][3] = {{1, 0, 0}, {-1, .5, 0}, {0, -1, .25}, {.5, .5, -1}, {-.5, 0, .75}};
    for (int i = 0; i < 5; ++i) tile.set(i, v[i][0], v[i][1], v[i][2]);
    tile.view.restitution.eps = 0.8;
    const double majorant = 4, mean = 5.7;
    const PhiloxCounter rounding = simd::reference::draw(tile.view.random, 0, 7, simd::GasStream::rounding);
    ASSERT_EQ(std::floor(mean + unit_number(rounding[0], rounding[1])), 6);
    const int pairs[6][2] = {{3, 2}, {1, 4}, {1, 4}, {4, 2}, {3, 1}, {1, 2}};
    const double numbers[6] = {0.314607593697, 0.684716063188, 0.451733417067,
                               0.340579208376, 0.522980287987, 0.196483014899};
    const bool accepts[6] = {true, false, false, true, false, true};
    for (std::uint32_t k = 0; k < 6; ++k) {
        const PhiloxCounter w = simd::reference::draw(tile.view.random, k, 7, simd::GasStream::candidate);
        const auto [i, j] = simd::reference::pair_of(w, 5);
        EXPECT_EQ(i, pairs[k][0]);
        EXPECT_EQ(j, pairs[k][1]);
        const double u = unit_number(w[2], w[3]);
        EXPECT_NEAR(u, numbers[k], 1e-12);
        const auto g = simd::reference::velocity_of(tile.velocity.data(), i) -
                       simd::reference::velocity_of(tile.velocity.data(), j);
        const double speed = std::sqrt(dot(g, g));
        EXPECT_EQ(u * majorant < speed, accepts[k]);
        if (accepts[k])
            simd::reference::collide<false>(tile.view, i, j,
                                            simd::reference::direction<3>(tile.view, k, 7, g, speed));
    }
    const double after[5][3] = {{1, 0, 0},
                                {-0.051162027992, -0.536676960641, -0.323036992216},
                                {-1.421034766228, -0.122044511670, 0.044351110450},
                                {0.155612931089, 0.012388838064, 0.441868182928},
                                {0.316583863132, 0.646332634247, -0.163182301162}};
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(tile.velocity[4 * i + d], after[i][d], 1e-11);
}

// Momentum always, energy of elastic spheres that are smooth or perfectly rough; a vector that is added and
// taken away is rounded twice: a few units of the last place per collision.
TEST(Cell, MomentumAndEnergy) {
    for (const bool rough : {false, true})
        for (const simd::Isa isa : simd::available_isas()) {
            Tile tile(64, 12);
            tile.fill(rough ? 0.7 : 0);
            tile.view.rate = 0.01;
            tile.view.tangential = rough ? -1 : 1;
            const double energy = tile.energy();
            simd::GasCollisions sum;
            for (std::uint32_t step = 0; step < 50; ++step) {
                tile.view.random.step = step;
                const auto r = simd::dsmc_kernels(isa).collide[1][rough ? 1 : 0][0](tile.view);
                sum.collisions += r.collisions;
            }
            EXPECT_GT(sum.collisions, 5000);
            EXPECT_NEAR(tile.energy(), energy, 1e-13 * energy);
            for (const double p : tile.momentum()) EXPECT_NEAR(p, 0, 1e-11);
        }
}

// Two particles that always collide: the mean number is F S g dt/V, exact for constant g (elastic).
TEST(Cell, RateOfAPair) {
    constexpr std::int32_t cells = 400;
    Tile tile(cells, 2);
    for (std::int32_t c = 0; c < cells; ++c) {
        tile.set(2 * c, 0.3, 0.4, 0);
        tile.set(2 * c + 1, -0.3, -0.4, 0);
    }
    tile.view.rate = 0.05; // F S dt/(2V)
    std::int64_t collisions = 0;
    constexpr int steps = 500;
    for (std::uint32_t step = 0; step < steps; ++step) {
        tile.view.random.step = step;
        collisions +=
            simd::dsmc_kernels(simd::available_isas().back()).collide[1][0][0](tile.view).collisions;
    }
    const double expected = 2 * 0.05 * 1.0 * cells * steps;
    EXPECT_NEAR(static_cast<double>(collisions), expected, 5 * std::sqrt(expected));
}

TEST(Cell, EqualVelocitiesDoNotCollide) {
    for (const simd::Isa isa : simd::available_isas()) {
        Tile tile(16, 7);
        for (std::int32_t i = 0; i < 16 * 7; ++i) tile.set(i, 1, 2, 3);
        tile.view.rate = 1;
        const auto before = tile.velocity;
        const auto r = simd::dsmc_kernels(isa).collide[1][0][0](tile.view);
        EXPECT_EQ(r.candidates, 0);
        EXPECT_EQ(tile.velocity, before);
    }
}

// eps = 0 takes the whole normal relative velocity, and nothing becomes NaN.
TEST(Cell, NoRestitution) {
    Tile tile(64, 10);
    tile.fill(0);
    tile.view.rate = 0.02;
    tile.view.restitution.eps = 0;
    double energy = tile.energy();
    for (std::uint32_t step = 0; step < 300; ++step) {
        tile.view.random.step = step;
        (void)simd::dsmc_kernels(simd::available_isas().back()).collide[1][0][0](tile.view);
        EXPECT_LE(tile.energy(), energy);
        energy = tile.energy();
    }
    EXPECT_GT(energy, 0);
}

TEST(Cell, OneVeryFastParticle) {
    Tile tile(8, 10);
    tile.fill(0);
    tile.set(3, 1e6, 0, 0);
    tile.view.rate = 1e-9;
    const double energy = tile.energy();
    std::int64_t violations = 0, candidates = 0;
    for (std::uint32_t step = 0; step < 2000; ++step) {
        tile.view.random.step = step;
        const auto r = simd::dsmc_kernels(simd::available_isas().back()).collide[1][0][0](tile.view);
        violations += r.violations;
        candidates += r.candidates;
    }
    EXPECT_GT(candidates, 100);
    EXPECT_EQ(violations, 0);
    EXPECT_NEAR(tile.energy(), energy, 1e-13 * energy);
}

// More candidates than a cell can take are told, not taken.
TEST(Cell, TooManyCandidates) {
    for (const simd::Isa isa : simd::available_isas()) {
        Tile tile(8, 10);
        tile.fill(0);
        tile.view.rate = 1e9;
        EXPECT_EQ(simd::dsmc_kernels(isa).collide[1][0][0](tile.view).overflows, 8);
        tile.set(0, std::nan(""), 0, 0);
        tile.view.rate = 0.01;
        (void)simd::dsmc_kernels(isa).collide[1][0][0](tile.view); // ends
    }
}
