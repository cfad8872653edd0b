// The force laws against a second transcription of the specification in long double, and their closed forms.
#include "laws/contact.hpp"
#include "laws/restitution.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace sandlane;
using Real = long double;

struct Oracle {
    Real fx, fy, ft;
};

// docs/physics.md 2 with equations (2.8) or (2.14), and (2.18), written out for two discs.
Oracle force_on_i(bool viscoelastic, bool friction, Real dx, Real dy, Real dvx, Real dvy, Real ri, Real rj,
                  Real wi, Real wj, Real elastic, Real dissipative, Real gamma_t, Real mu) {
    const Real d = std::sqrt(dx * dx + dy * dy), xi = ri + rj - d;
    if (xi <= 0) return {0, 0, 0};
    const Real nx = dx / d, ny = dy / d, tx = -ny, ty = nx;
    const Real rate = -(dvx * nx + dvy * ny);
    const Real reduced = ri * rj / (ri + rj);
    Real fn = viscoelastic
                  ? elastic * std::sqrt(reduced) * (std::pow(xi, 1.5L) + dissipative * std::sqrt(xi) * rate)
                  : elastic * xi + dissipative * rate;
    fn = std::max(fn, Real{0});
    Real ft = 0;
    if (friction) {
        const Real vt = -(dvx * tx + dvy * ty) + ri * wi + rj * wj;
        const Real sign = vt > 0 ? 1 : vt < 0 ? -1 : 0;
        ft = -sign * std::min(gamma_t * std::abs(vt), mu * fn);
    }
    return {-fn * nx + ft * tx, -fn * ny + ft * ty, ft};
}

template <class Normal, class Tangential> void compare_with_oracle() {
    const bool viscoelastic = std::is_same_v<Normal, laws::Viscoelastic>;
    const bool friction = Tangential::needs_spin;
    for (int n = 0; n < 2000; ++n) {
        const double a = std::sin(1.0 + 3 * n), b = std::cos(2.0 + 5 * n), c = std::sin(0.3 + 7 * n),
                     e = std::cos(0.7 * n);
        const double ri = 1 + 0.3 * a, rj = 0.8 + 0.2 * b, distance = (ri + rj) * (0.9 + 0.12 * c),
                     angle = 10.0 * n;
        const double dx = distance * std::cos(angle), dy = distance * std::sin(angle);
        const laws::PairState<double> s{dx, dy, a, b, ri * c + rj * e, ri + rj, 1 / ri + 1 / rj};
        const auto f = laws::pair_force<Normal, Tangential>(s, {100.0, 0.2, 0.3, 0.4});
        const Oracle o =
            force_on_i(viscoelastic, friction, dx, dy, a, b, ri, rj, c, e, 100, 0.2L, 0.3L, 0.4L);
        // Overlap carries the rounding of distance: eps * distance * stiffness.
        EXPECT_NEAR(f.x, static_cast<double>(o.fx), 1e-12);
        EXPECT_NEAR(f.y, static_cast<double>(o.fy), 1e-12);
        EXPECT_NEAR(f.tangential, static_cast<double>(o.ft), 1e-12);
    }
}

} // namespace

TEST(PairForce, MatchesOracle) {
    compare_with_oracle<laws::LinearDashpot, laws::Frictionless>();
    compare_with_oracle<laws::LinearDashpot, laws::HaffWerner>();
    compare_with_oracle<laws::Viscoelastic, laws::Frictionless>();
    compare_with_oracle<laws::Viscoelastic, laws::HaffWerner>();
}

// No relative surface velocity in rigid rotation of a touching pair and between gears.
TEST(PairForce, RigidRotationAndGearsDoNotSlide) {
    const double w = 0.7, ri = 1.0, rj = 0.5, d = 1.4;
    const laws::PairCoefficients<double> c{100, 0, 1, 10, 0};
    const laws::PairState<double> rigid{
        d, 0, 0, w * d, w * (ri + rj) - w * (ri + rj - d), ri + rj, 1 / ri + 1 / rj};
    EXPECT_NEAR((laws::pair_force<laws::LinearDashpot, laws::HaffWerner>(rigid, c).tangential), 0, 1e-14);
    const laws::PairState<double> gears{d, 0, 0, 0, ri * w - rj * (w * ri / rj), ri + rj, 1 / ri + 1 / rj};
    EXPECT_NEAR((laws::pair_force<laws::LinearDashpot, laws::HaffWerner>(gears, c).tangential), 0, 1e-14);
}

// Single pair of values computed independently; F^t there has the opposite sign.
TEST(PairForce, SinglePairOfTableOne) {
    const laws::PairState<double> s{1.2, -1.5, -0.3, 0.2, 0.1, 1.95, 1 / 1.0 + 1 / 0.95};
    const auto f = laws::pair_force<laws::LinearDashpot, laws::HaffWerner>(s, {1000, 0.5, 0.3, 0.4, 0});
    EXPECT_NEAR(f.x, -18.3116956246788, 1e-11);
    EXPECT_NEAR(f.y, 22.7890960990678, 1e-11);
    EXPECT_NEAR(f.tangential, -0.0627964899966073, 1e-14);
}

TEST(Restitution, LinearDashpotTable) { // 9.2
    const double z[] = {0.05, 0.1, 0.2, 0.3, 0.5, 0.70710678118654752, 0.9, 1, 1.5, 3};
    const double eps[] = {0.85875810, 0.74407940, 0.57174003, 0.45097545, 0.29843606,
                          0.20787958, 0.15528275, 0.13533528, 0.07558831, 0.02376951};
    const double time[] = {3.0453600, 2.9560753, 2.7953544, 2.6544746, 2.4183992,
                           2.2214415, 2.0694529, 2.0000000, 1.7216358, 1.2464505};
    for (int n = 0; n < 10; ++n) {
        EXPECT_NEAR(laws::linear_dashpot_restitution(z[n]), eps[n], 1e-8);
        EXPECT_NEAR(laws::linear_dashpot_contact_time(z[n]), time[n], 1e-7);
    }
}

TEST(Restitution, ViscoelasticFitWithinItsStatedError) { // 2.3 against table 9.3
    EXPECT_NEAR(laws::viscoelastic_restitution(0.05), 0.94439678, 5e-5);
    EXPECT_NEAR(laws::viscoelastic_restitution(0.1), 0.89285888, 5e-5);
    EXPECT_NEAR(laws::viscoelastic_restitution(0.3), 0.72208544, 7e-4);
    EXPECT_NEAR(laws::viscoelastic_restitution(0.5), 0.59525150, 1.8e-3);
}

// Step by step: stick, slip with the spring pulled back, immediate release on reversal, reset without
// load.
TEST(CundallStrack, SpringAndClamp) {
    const double k = 100, mu = 0.5, dt = 0.01;
    double zeta[1] = {0.0};
    double elapsed = 0;
    const auto force = [&](double normal, double rate) {
        return laws::CundallStrack::force(laws::TangentialInput<double>{normal, rate, 0, mu, k, elapsed},
                                          zeta);
    };
    EXPECT_EQ(force(1, 0.3), 0.0); // first evaluation: no increment
    elapsed = dt;
    EXPECT_EQ(zeta[0], 0.0);
    EXPECT_NEAR(force(1, 0.3), -k * 0.003, 1e-14); // sticks
    for (int n = 0; n < 10; ++n) (void)force(1, 0.3);
    EXPECT_NEAR(force(1, 0.3), -mu, 1e-14); // slides at mu f_n
    EXPECT_NEAR(zeta[0], mu / k, 1e-16);
    EXPECT_NEAR(force(1, -0.1), -mu + k * 0.001, 1e-14); // lets go at once
    EXPECT_EQ(force(0, 0.3), 0.0);
    EXPECT_EQ(zeta[0], 0.0);
}

// What begins has no spring yet, however long the step was; what lasts has moved all that time.
TEST(PairForce, ContactsBeginWithoutASpring) {
    const laws::PairState<double> s{1.9, 0, 0, 0.2, 0, 2, 2};
    laws::PairCoefficients<double> c{1000, 0, 0, 10};
    c.tangential_stiffness = 50;
    double memory[2] = {laws::no_contact, 0};
    const auto force = [&](double elapsed) {
        return laws::pair_force<laws::LinearDashpot, laws::CundallStrack>(s, c, memory, elapsed).tangential;
    };
    EXPECT_EQ(force(0.1), 0);
    EXPECT_EQ(memory[0], 0);
    EXPECT_NEAR(force(0.1), 50 * 0.1 * 0.2, 1e-14);
}
