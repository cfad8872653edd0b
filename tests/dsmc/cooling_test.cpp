// A homogeneous gas without forces: rates, Haff's law, velocity distribution, thermostat (specification 7,
// 10).
#include "dsmc/support.hpp"
#include "dsmc/theory.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace sandlane;

namespace {

dsmc::Simulation simulate(const dsmc::Setup& s, std::uint32_t n, double temperature = 1) {
    return {s, dsmc::maxwellian(s, n, temperature), simd::available_isas().back(), 1};
}

} // namespace

// An elastic gas in equilibrium: n F omega/2 collisions, g2 times as many after Enskog. Statistical error
// 1/sqrt(collisions), cells of 20 particles lose no collisions because N (N - 1) is unbiased.
TEST(Cooling, CollisionRate) {
    for (const int d : {2, 3}) {
        for (const bool enskog : {false, true}) {
            const std::uint32_t n = 20000;
            dsmc::Setup s = test::gas(d, 1, n, d == 3 ? 10 : 32);
            s.enskog = enskog;
            dsmc::Simulation gas = simulate(s, n);
            gas.run(100);
            const auto scales = dsmc::scales(s, n, 1);
            const double expected = 0.5 * n * scales.collision_rate * gas.time();
            // With Enskog the factor of the local density is averaged over its fluctuations, here about 1 %
            // of it.
            const double tolerance = 4 / std::sqrt(expected) + (enskog ? 0.02 : 0);
            EXPECT_NEAR(static_cast<double>(gas.counts().collisions) / expected, 1, tolerance) << d << enskog;
            EXPECT_NEAR(scales.collision_rate, scales.correlation * test::collision_rate(d, 0.1, 1), 1e-12);
            EXPECT_LT(static_cast<double>(gas.counts().violations),
                      1e-4 * static_cast<double>(gas.counts().candidates));
        }
    }
}

// Mean occupancy 3 gives the same rate: N (N - 1) of Poisson occupancy is its squared mean.
TEST(Cooling, FewParticlesPerCell) {
    const std::uint32_t n = 3 * 14 * 14 * 14;
    const dsmc::Setup s = test::gas(3, 1, n, 14);
    dsmc::Simulation gas = simulate(s, n);
    gas.run(200);
    const double expected = 0.5 * n * test::collision_rate(3, 0.1, 1) * gas.time();
    EXPECT_NEAR(static_cast<double>(gas.counts().collisions) / expected, 1, 4 / std::sqrt(expected) + 0.002);
}

// T^{-1/2} is a straight line of slope 1/tau; 0.5 % (specification 10.4), after a2 has relaxed.
TEST(Cooling, HaffSlow) {
    for (const int d : {2, 3})
        for (const double eps : {0.8, 0.9}) {
            const std::uint32_t n = 60000;
            dsmc::Setup s = test::gas(d, eps, n, 1);
            for (int c = 0; c < d; ++c) s.cells[c] = d == 3 ? 13 : 50;
            s.adaptive = true;
            s.dt = 0.1;
            dsmc::Simulation gas = simulate(s, n);
            gas.run(150);
            const double t0 = gas.time(), y0 = 1 / std::sqrt(gas.observe().temperature);
            gas.run(250);
            const double slope = (1 / std::sqrt(gas.observe().temperature) - y0) / (gas.time() - t0);
            EXPECT_NEAR(slope / test::haff_rate(d, 0.1, eps), 1, 0.006) << d << " " << eps;
        }
}
