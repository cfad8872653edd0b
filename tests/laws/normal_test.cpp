// The normal laws by themselves: head-on collisions integrated to the accuracy of the laws, against the
// reference numbers of the specification (9.2-9.4) and closed forms.
#include "laws/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace {

using namespace sandlane;

using Coefficients = laws::PairCoefficients<double>;
constexpr double uncut = -std::numeric_limits<double>::infinity();

struct Impact {
    double restitution = 0, time = 0, largest_overlap = 0, last_overlap = 0;
};

// A collision of reduced mass m and reduced radius 1 by Runge and Kutta's fourth-order method, from the first
// touch until the force is gone, or with `until_apart` the overlap.
template <class Law>
Impact collide(const Coefficients& c, double m, double speed, double dt, bool until_apart) {
    double xi = 0, rate = speed, memory[1] = {0};
    Coefficients free = c;
    if (!until_apart) free.least = uncut; // its zero is the instant of the cut
    const auto force = [&](double overlap, double v) {
        return laws::normal_force<Law>(std::max(overlap, 0.0), v, free, 1.0, memory).force;
    };
    const auto left = [&] { return until_apart ? xi : force(xi, rate); };
    Impact impact;
    double before = 1;
    for (double t = 0;; t += dt) {
        const double x0 = xi, v0 = rate;
        const double a1 = -force(xi, rate) / m;
        const double v2 = rate + 0.5 * dt * a1, a2 = -force(xi + 0.5 * dt * rate, v2) / m;
        const double v3 = rate + 0.5 * dt * a2, a3 = -force(xi + 0.5 * dt * v2, v3) / m;
        const double v4 = rate + dt * a3, a4 = -force(xi + dt * v3, v4) / m;
        xi += dt / 6 * (rate + 2 * v2 + 2 * v3 + v4);
        rate += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        impact.largest_overlap = std::max(impact.largest_overlap, xi);
        const double now = left();
        if (rate < 0 && now <= 0) {
            const double part = before / (before - now);
            impact.restitution = -(v0 + part * (rate - v0)) / speed;
            impact.time = t + part * dt;
            impact.last_overlap = x0 + part * (xi - x0);
            return impact;
        }
        if (t > 100 * std::sqrt(m)) return impact; // no rebound
        before = now;
    }
}

// Units of m_eff, k and g.
Coefficients dashpot(double z, double least) {
    Coefficients c{1, 2 * z, 0, 0};
    c.least = least;
    return c;
}

} // namespace

// 9.2. Steps of 1e-4: the instant within a step, by a straight line, costs some dt^2 = 1e-8.
TEST(LinearDashpot, CollisionsOfTheTable) {
    const struct {
        double z, restitution, time, cut_restitution, cut_time;
    } table[] = {{0, 1, 3.1415927, 1, 3.1415927},
                 {0.05, 0.85446789, 3.1455270, 0.85875810, 3.0453600},
                 {0.1, 0.72924761, 3.1574194, 0.74407940, 2.9560753},
                 {0.2, 0.52662060, 3.2063746, 0.57174003, 2.7953544},
                 {0.3, 0.37232610, 3.2932839, 0.45097545, 2.6544746},
                 {0.5, 0.16303353, 3.6275987, 0.29843606, 2.4183992},
                 {1 / std::numbers::sqrt2, 0.04321392, 4.4428829, 0.20787958, 2.2214415},
                 {0.9, 0.00152376, 7.2073078, 0.15528275, 2.0694529}};
    for (const auto& row : table) {
        const Impact free = collide<laws::LinearDashpot>(dashpot(row.z, uncut), 1, 1, 1e-4, true);
        EXPECT_NEAR(free.restitution, row.restitution, 2e-8) << row.z;
        EXPECT_NEAR(free.time, row.time, 1e-7) << row.z;
        if (row.z == 0) continue; // nothing to cut
        const Impact cut = collide<laws::LinearDashpot>(dashpot(row.z, 0), 1, 1, 1e-4, false);
        EXPECT_NEAR(cut.restitution, row.cut_restitution, 2e-8) << row.z;
        EXPECT_NEAR(cut.time, row.cut_time, 1e-7) << row.z;
    }
    const double strong[][3] = {
        {1, 0.13533528, 2.0000000}, {1.5, 0.07558831, 1.7216358}, {3, 0.02376951, 1.2464505}};
    for (const auto& [z, restitution, time] : strong) {
        const Impact cut = collide<laws::LinearDashpot>(dashpot(z, 0), 1, 1, 1e-4, false);
        EXPECT_NEAR(cut.restitution, restitution, 2e-8) << z;
        EXPECT_NEAR(cut.time, time, 1e-7) << z;
        EXPECT_EQ(collide<laws::LinearDashpot>(dashpot(z, uncut), 1, 1, 1e-4, true).restitution, 0) << z;
    }
}

// The law's own cut: with it grains fly on at the speed at which the force ended.
TEST(LinearDashpot, EndsAtZeroForce) {
    const Impact impact = collide<laws::LinearDashpot>(dashpot(0.3, 0), 1, 1, 1e-4, true);
    EXPECT_NEAR(impact.restitution, 0.45097545, 2e-8);
    const auto pulled = [](double least) {
        return laws::LinearDashpot::force<double>({1, -5, 1, 1, 1, 0, least}, nullptr);
    };
    EXPECT_EQ(pulled(0).force, 0);
    EXPECT_EQ(pulled(uncut).force, -4);
    EXPECT_EQ(pulled(uncut).load, 0); // a pull presses nothing together
}

// 9.3, units of K, m_eff and g: A = x. The dissipative force begins like sqrt(t); a first step of Runge and
// Kutta misses 0.03 x dt^1.5.
TEST(Viscoelastic, CollisionsOfTheTable) {
    const struct {
        double x, restitution, time, cut_restitution, cut_time;
    } table[] = {{0, 1, 3.2180654597, 1, 3.2180654597},
                 {0.01, 0.98854482, 3.221798, 0.98854744, 3.211798},
                 {0.05, 0.94425997, 3.237150, 0.94439678, 3.187147},
                 {0.1, 0.89214759, 3.257290, 0.89285888, 3.157256},
                 {0.2, 0.79755006, 3.300779, 0.80096547, 3.100413},
                 {0.3, 0.71404488, 3.348658, 0.72208544, 3.047215},
                 {0.5, 0.57382463, 3.458346, 0.59525150, 2.950445},
                 {1, 0.33116481, 3.828455, 0.39393060, 2.752027},
                 {2, 0.09533037, 5.245266, 0.21164605, 2.470628}};
    for (const auto& row : table) {
        Coefficients c{1, row.x, 0, 0};
        const double dt = 5e-5, rounding = 1e-8, start = 0.06 * row.x * std::pow(dt, 1.5);
        c.least = uncut;
        const Impact free = collide<laws::Viscoelastic>(c, 1, 1, dt, true);
        EXPECT_NEAR(free.restitution, row.restitution, rounding + start) << row.x;
        EXPECT_NEAR(free.time, row.time, 1e-6) << row.x;
        if (row.x == 0) continue; // nothing to cut
        c.least = 0;
        const Impact cut = collide<laws::Viscoelastic>(c, 1, 1, dt, false);
        EXPECT_NEAR(cut.restitution, row.cut_restitution, rounding + start) << row.x;
        EXPECT_NEAR(cut.time, row.cut_time, 1e-6) << row.x;
    }
}

// 9.4, T5. The law stays at zero from xi_0 on, so that the end is found to a whole step.
TEST(WaltonBraun, CollisionOfTheTable) {
    const double dt = 2e-10;
    const Impact impact = collide<laws::WaltonBraun>(Coefficients{1e5, 1.5625e5, 0, 0}, 5e-4, 1, dt, false);
    EXPECT_NEAR(impact.restitution, 0.8, 1e-8);
    EXPECT_NEAR(impact.time, 1.9992973222e-4, dt);
    EXPECT_NEAR(impact.largest_overlap, 7.0710678119e-5, 1e-13); // of the last whole step: g dt (w dt)
    EXPECT_NEAR(impact.last_overlap, 2.5455844123e-5, dt);
}

// Its restitution does not depend on the speed; and the energy it says it holds is what it gives back.
TEST(WaltonBraun, GivesBackWhatItHolds) {
    const double loading = 1e5, unloading = 4e5;
    const Coefficients c{loading, unloading, 0, 0};
    for (const double speed : {0.01, 3.0})
        EXPECT_NEAR(collide<laws::WaltonBraun>(c, 5e-4, speed, 1e-8, false).restitution, 0.5, 1e-6);
    double memory[1] = {0};
    const auto force = [&](double xi) {
        return laws::normal_force<laws::WaltonBraun>(xi, 0.0, c, 1.0, memory).force;
    };
    const auto held = [&](double xi) {
        return laws::elastic_energy<laws::WaltonBraun, laws::Frictionless, laws::Couples::none, 2>(xi, 1, c,
                                                                                                   memory);
    };
    (void)force(1e-3);
    const double work = 0.5 * loading * 1e-6, peak = held(1e-3);
    EXPECT_NEAR(peak, work * loading / unloading, 1e-15 * work); // eps^2 of it
    double back = 0;
    const int steps = 1000;
    const double dx = 0.25e-3 / steps; // xi_0 = 0.75 xi_m, and f_n is zero from there on
    for (int n = 0; n < steps; ++n) back += dx * force(1e-3 - (n + 0.5) * dx);
    EXPECT_NEAR(back, peak, 1e-12 * work);
    EXPECT_EQ(force(0.5e-3), 0);
    EXPECT_EQ(held(0.5e-3), 0);
}

// Inside the loop the contact goes up and down the same steep line, up to the old maximum, and on along Y_l.
TEST(WaltonBraun, ReloadsWithinTheLoop) {
    const double l = 1e5, u = 2e5;
    const Coefficients c{l, u, 0, 0};
    double memory[1] = {0};
    const auto force = [&](double xi) {
        return laws::normal_force<laws::WaltonBraun>(xi, 0.0, c, 1.0, memory).force;
    };
    const double tolerance = 1e-12; // of 1e2 N
    EXPECT_NEAR(force(0.5e-3), l * 0.5e-3, tolerance);
    EXPECT_NEAR(force(1e-3), l * 1e-3, tolerance);
    EXPECT_NEAR(force(0.8e-3), u * 0.3e-3, tolerance); // xi_0 = 0.5e-3
    EXPECT_NEAR(force(0.9e-3), u * 0.4e-3, tolerance);
    EXPECT_NEAR(force(0.4e-3), 0, tolerance);
    EXPECT_NEAR(force(0.6e-3), u * 0.1e-3, tolerance);
    EXPECT_NEAR(force(1e-3), l * 1e-3, tolerance);
    EXPECT_NEAR(force(1.2e-3), l * 1.2e-3, tolerance); // a new maximum: xi_0 = 0.6e-3
    EXPECT_NEAR(force(1e-3), u * 0.4e-3, tolerance);
    EXPECT_EQ(memory[0], 1.2e-3);
}

// f = K xi^{3/2} - 4 pi c R_eff xi: zero at xi_eq = (4 pi c R_eff/K)^2, the strongest pull at 4/9 of it.
TEST(CohesiveViscoelastic, PullOffAndEquilibrium) {
    Coefficients c{3e6, 1e-5, 0, 0};
    c.cohesion = 2e4;
    const double reduced = 0.005, k = c.elastic * std::sqrt(reduced);
    const double pull = 4 * std::numbers::pi * c.cohesion * reduced, balance = std::pow(pull / k, 2);
    const auto force = [&](double xi) {
        return laws::normal_force<laws::CohesiveViscoelastic, double>(xi, 0.0, c, reduced, nullptr);
    };
    const double scale = pull * balance;
    EXPECT_NEAR(force(balance).force, 0, 1e-14 * scale);
    EXPECT_NEAR(force(balance).load, k * std::pow(balance, 1.5), 1e-14 * scale); // friction feels the push
    EXPECT_EQ(force(0).force, 0);
    double strongest = 0, at = 0;
    for (int n = 1; n < 9000; ++n) {
        const double f = force(n / 9000.0 * balance).force;
        if (f < strongest) strongest = f, at = n / 9000.0;
    }
    EXPECT_NEAR(at, 4.0 / 9, 1e-15);
    EXPECT_NEAR(strongest, -4.0 / 27 * scale, 1e-14 * scale);
    // The energy is the integral of the force.
    for (const double xi : {0.3 * balance, balance, 2.5 * balance}) {
        double work = 0;
        const int steps = 20000;
        for (int n = 0; n < steps; ++n) work += xi / steps * force((n + 0.5) * xi / steps).force;
        const double energy =
            laws::elastic_energy<laws::CohesiveViscoelastic, laws::Frictionless, laws::Couples::none, 2>(
                xi, 1 / reduced, c, nullptr);
        EXPECT_NEAR(energy, work, 1e-8 * scale * balance); // midpoint rule at the kink of xi^1.5 at zero
    }
}

// Without loss what came in at g leaves at g; with loss, a slow collision sticks.
TEST(CohesiveViscoelastic, ReboundsOrSticks) {
    Coefficients c{1, 0, 0, 0};
    c.cohesion = 0.3 / (4 * std::numbers::pi);
    EXPECT_NEAR(collide<laws::CohesiveViscoelastic>(c, 1, 1, 1e-4, true).restitution, 1, 1e-7);
    c.dissipative = 0.1;
    EXPECT_GT(collide<laws::CohesiveViscoelastic>(c, 1, 1, 1e-3, true).restitution, 0.5);
    EXPECT_EQ(collide<laws::CohesiveViscoelastic>(c, 1, 1e-3, 1e-3, true).restitution, 0);
}
