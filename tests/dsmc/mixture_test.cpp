// Mixtures: rates of pairs of kinds, conservation, and temperatures that differ, against kinetic theory.
#include "analysis/gas_mixture.hpp"
#include "analysis/gas_theory.hpp"
#include "dsmc/support.hpp"
#include "dsmc/theory.hpp"
#include "laws/collision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;

namespace {

// A kind of half as many particles, heavier and larger.
dsmc::Setup mixture(int dimension, double eps, std::size_t particles, std::int32_t cells) {
    dsmc::Setup s = test::gas(dimension, eps, particles, cells);
    s.weight *= 0.5;
    s.others = {{4, 1.6, 0.5}};
    return s;
}

dsmc::Simulation simulate(const dsmc::Setup& s, std::uint32_t n) {
    return {s, dsmc::maxwellian(s, n, 1), simd::available_isas().back(), 1};
}

} // namespace

// Collisions of each pair of kinds in an elastic gas of one temperature: n_i n_j g_ij S_ij <g_ij>, dilute and
// dense, by every scheme but that of first order in dt. 4 sigma, and 1 % for the fluctuations of the local
// density of the dense gas.
TEST(Mixture, RatesOfPairsSlow) {
    for (const int d : {2, 3})
        for (const bool dense : {false, true})
            for (const auto scheme :
                 {laws::CollisionScheme::no_time_counter, laws::CollisionScheme::direction_first,
                  laws::CollisionScheme::majorant_frequency, laws::CollisionScheme::bernoulli}) {
                const std::uint32_t n = 8000;
                dsmc::Setup s = mixture(d, 1, n, d == 3 ? 6 : 14);
                s.enskog = dense;
                s.scheme = scheme;
                s.dt = 0.05;
                dsmc::Simulation gas = simulate(s, n);
                gas.keep_decisions();
                gas.run(30);
                double counted[2][2] = {};
                for (const auto& decision : gas.take_decisions()) {
                    if (!decision.of.accepted) continue;
                    const int a = decision.of.first >= n / 2 ? 1 : 0, b = decision.of.second >= n / 2 ? 1 : 0;
                    counted[a][b] += 1;
                }
                const analysis::MixtureGas theory = dsmc::mixture_gas(s, n);
                for (std::size_t i = 0; i < 2; ++i)
                    for (std::size_t j = 0; j < 2; ++j) {
                        const double expected =
                            0.25 * n * analysis::collision_rate(theory, i, j, 1, 1) * gas.time();
                        const double found = i == j ? counted[i][i] : 0.5 * (counted[0][1] + counted[1][0]);
                        EXPECT_NEAR(found / expected, 1, 4 / std::sqrt(expected) + (dense ? 0.012 : 0.003))
                            << d << dense << static_cast<int>(scheme) << i << j;
                    }
            }
}

// Equal particles under two names are a gas of one kind.
TEST(Mixture, OfEqualsIsTheGas) {
    for (const int d : {2, 3}) {
        analysis::MixtureGas two;
        two.dimension = d;
        two.dense = true;
        two.kinds = {{0.06, 1, 1}, {0.04, 1, 1}};
        two.restitution.assign(4, {laws::Restitution::Model::constant, 0.8});
        const double packing = std::numbers::pi * 0.1 / (d == 3 ? 6 : 4);
        const analysis::HardGas one{d, 0.1, laws::contact_correlation(d, packing), 1, 1, {}, 0};
        EXPECT_NEAR(analysis::collision_rate(two, 1) / analysis::collision_rate(one, 1), 1, 1e-12);
        const auto rates = analysis::temperature_rates(two, {1, 1});
        EXPECT_NEAR(rates[0] / (-analysis::collision_rate(one, 1) * (1 - 0.64) / d), 1, 1e-12);
        EXPECT_NEAR(rates[1] / rates[0], 1, 1e-12);
    }
}

TEST(Mixture, ElasticKeepsMomentumAndEnergy) {
    const std::uint32_t n = 6000;
    dsmc::Setup s = mixture(3, 1, n, 8);
    s.dt = 0.3;
    dsmc::Simulation gas = simulate(s, n);
    const auto before = gas.observe();
    gas.run(200);
    const auto after = gas.observe();
    EXPECT_GT(gas.counts().collisions, n);
    EXPECT_NEAR(after.energy / before.energy, 1, 1e-12);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(after.drift[c], before.drift[c], 1e-13);
    // Equipartition, sqrt(2/(3 n/2)) of each.
    EXPECT_NEAR(after.of_kind[1] / after.of_kind[0], 1, 0.06);
}

// An inelastic gas has none. Maxwellians, as in the theory, make the ratio 1 % too large in space and 2 % in
// the plane for eps = 0.7 (event-driven dynamics agrees with the Monte Carlo method); the noise of 20 frames
// of 10^4 particles of each kind is 0.3 %.
TEST(Mixture, TemperaturesDifferSlow) {
    for (const double eps : {0.7, 0.9})
        for (const int d : {2, 3}) {
            const std::uint32_t n = 20000;
            dsmc::Setup s = mixture(d, eps, n, 1);
            s.adaptive = true;
            s.dt = 0.2;
            dsmc::Simulation gas = simulate(s, n);
            gas.run(200); // 20 collisions per particle
            double ratio = 0;
            constexpr int frames = 20;
            for (int f = 0; f < frames; ++f) {
                gas.run(20);
                const auto o = gas.observe();
                ratio += o.of_kind[1] / o.of_kind[0] / frames;
            }
            const double expected = analysis::temperature_ratios(dsmc::mixture_gas(s, n))[1];
            EXPECT_GT(expected, eps < 0.8 ? 1.2 : 1.05);
            EXPECT_NEAR(ratio / expected, 1, eps < 0.8 ? 0.03 : 0.02) << d << " " << eps;
            const auto curve = dsmc::kind_temperatures(s, n, 1, gas.time());
            EXPECT_NEAR(gas.observe().of_kind[0] / curve[0], 1, 0.05) << d << " " << eps;
        }
}

// The step follows the temperature of all kinds, by their masses, and the number of steps is foreseen: heavy
// particles that meet elastically lose less than the light ones among themselves.
TEST(Mixture, AdaptiveStep) {
    const std::uint32_t n = 4000;
    dsmc::Setup s = mixture(3, 0.6, n, 1);
    s.pairs = {{1, 1, 1, 0}, {0, 1, 1, 0}};
    s.adaptive = true;
    s.dt = 0.2;
    dsmc::Simulation gas = simulate(s, n);
    const double duration = 60;
    const double steps = dsmc::adaptive_steps(s, n, 1, duration);
    gas.run(1000000, duration);
    EXPECT_NEAR(static_cast<double>(gas.step()) / steps, 1, 0.03);
    const double hot = gas.observe().temperature;
    gas.run(1);
    EXPECT_NEAR(gas.dt() / (s.dt / std::sqrt(hot)), 1, 0.01);
    // Alone, the kind of [gas] would have cooled much further.
    dsmc::Setup one = s;
    one.others.clear();
    EXPECT_LT(dsmc::adaptive_steps(one, n, 1, duration), 0.9 * steps);
}

// Between walls of one temperature all kinds have it.
TEST(Mixture, HeatedWallsSlow) {
    const std::uint32_t n = 8000;
    dsmc::Setup s = mixture(3, 1, n, 8);
    s.walls.periodic[0] = false;
    for (auto& side : s.walls.side[0]) {
        side.kind = simd::GasSide::Kind::heated;
        side.thermal_speed = std::sqrt(2.0);
    }
    s.dt = 0.2;
    dsmc::Simulation gas = simulate(s, n);
    gas.run(600);
    double temperature[2] = {};
    constexpr int frames = 40;
    for (int f = 0; f < frames; ++f) {
        gas.run(20);
        for (std::size_t k = 0; k < 2; ++k) temperature[k] += gas.observe().of_kind[k] / frames;
    }
    for (const double t : temperature) EXPECT_NEAR(t, 2, 0.03);
}
