// Torques of a contact with lever arms to its plane and rolling friction: against the specification written
// out in long double, for both partners, and the cases without slip (1.6-1.8, 9.1).
#include "laws/contact.hpp"

#include "core/vec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace sandlane;
using Real = long double;

struct Real3 {
    Real x, y, z;
    friend Real3 operator+(Real3 a, Real3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Real3 operator-(Real3 a, Real3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Real3 operator*(Real s, Real3 a) { return {s * a.x, s * a.y, s * a.z}; }
};
Real dot(Real3 a, Real3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Real3 cross(Real3 a, Real3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Real3 real(Vec v) {
    return {v.x, v.y, v.z};
}

struct Pair {
    Vec d, dv, first_spin, second_spin; // r_j - r_i, v_j - v_i, omega
    double first, second;               // radii
};

constexpr double stiffness = 100, damping = 0.2, sliding = 0.3, friction = 0.4, rolling_friction = 0.1,
                 rolling = 0.05;

laws::PairCoefficients<double> coefficients(bool plane) {
    laws::PairCoefficients<double> c{stiffness, damping, sliding, friction};
    c.rolling_friction = rolling_friction;
    c.rolling_damping = rolling;
    c.lever = plane ? 1 : 0;
    return c;
}

struct Torques {
    Real3 force, first, second;
};

Torques expected(const Pair& p, bool plane) {
    const Real3 d = real(p.d), dv = real(p.dv), wi = real(p.first_spin), wj = real(p.second_spin);
    const Real distance = std::sqrt(dot(d, d)), ri = p.first, rj = p.second, xi = ri + rj - distance;
    if (xi <= 0) return {};
    const Real3 n = (1 / distance) * d;
    const Real rate = -dot(dv, n);
    const Real li = plane ? (distance * distance + ri * ri - rj * rj) / (2 * distance) : ri;
    const Real lj = plane ? distance - li : rj;
    const Real fn = std::max(Real{0}, stiffness * xi + damping * rate);
    const Real3 u = cross(li * wi + lj * wj, n) - dv, ut = u - dot(u, n) * n;
    const Real3 ft = -std::min(Real{sliding}, friction * fn / std::sqrt(dot(ut, ut))) * ut;
    const Real3 turn = wi - wj, roll = turn - dot(turn, n) * n;
    const Real limit = rolling_friction * ri * rj / (ri + rj) * fn;
    const Real3 couple = -std::min(Real{rolling}, limit / std::sqrt(dot(roll, roll))) * roll;
    return {ft - fn * n, li * cross(n, ft) + couple, lj * cross(n, ft) - couple};
}

laws::SpatialState<double> in_space(const Pair& p) {
    const auto vector = [](Vec v) { return Vector<double>{v.x, v.y, v.z}; };
    const double ri = p.first, rj = p.second;
    return {vector(p.d),
            vector(p.dv),
            vector(ri * p.first_spin + rj * p.second_spin),
            vector(p.first_spin + p.second_spin),
            ri + rj,
            1 / ri + 1 / rj,
            vector(p.first_spin - p.second_spin),
            ri,
            rj,
            ri * ri - rj * rj};
}
laws::PairState<double> in_plane(const Pair& p) {
    const auto s = in_space(p);
    return {s.d.x,           s.d.y,    s.dv.x,     s.dv.y,   s.spin.z, s.radius_sum,
            s.inverse_radii, s.turn.z, s.differ.z, s.radius, s.other,  s.square_difference};
}

Pair pair(int n, bool flat) {
    const auto s = [n](double phase, double factor) { return std::sin(phase + factor * n); };
    const double first = 1 + 0.3 * s(1, 3), second = 0.8 + 0.2 * s(2, 5);
    const double distance = (first + second) * (0.9 + 0.12 * s(0.3, 7)), angle = 10.0 * n;
    const double z = flat ? 0 : 0.9 * s(0.7, 11), across = std::sqrt(1 - z * z);
    const double in = flat ? 0 : 1;
    return {distance * Vec{across * std::cos(angle), across * std::sin(angle), z},
            {s(0.1, 13), s(0.2, 17), in * s(0.3, 19)},
            {in * s(0.4, 23), in * s(0.5, 29), s(0.6, 31)},
            {in * s(0.7, 37), in * s(0.8, 41), s(0.9, 43)},
            first,
            second};
}

// Overlaps carry the rounding of distances, 4e-16 times the stiffness of 100 and some operations.
constexpr double rounding = 1e-12;

void expect_near(Vec a, Real3 b) {
    EXPECT_NEAR(a.x, static_cast<double>(b.x), rounding);
    EXPECT_NEAR(a.y, static_cast<double>(b.y), rounding);
    EXPECT_NEAR(a.z, static_cast<double>(b.z), rounding);
}

} // namespace

TEST(Couples, MatchOracle) {
    for (const bool plane : {false, true})
        for (int n = 0; n < 1000; ++n) {
            const auto c = coefficients(plane);
            const Pair flat = pair(n, true), deep = pair(n, false);
            const Torques of_flat = expected(flat, plane), of_deep = expected(deep, plane);
            const auto f = laws::pair_force<laws::LinearDashpot, laws::HaffWerner, laws::Couples::damped>(
                in_plane(flat), c);
            expect_near({f.x, f.y, 0}, of_flat.force);
            expect_near({0, 0, flat.first * f.tangential + f.couple}, of_flat.first);
            expect_near({0, 0, flat.second * f.tangential - f.couple}, of_flat.second);
            const auto g = laws::pair_force<laws::LinearDashpot, laws::HaffWerner, laws::Couples::damped>(
                in_space(deep), c);
            const Vec turning{g.turning.x, g.turning.y, g.turning.z},
                couple{g.couple.x, g.couple.y, g.couple.z};
            expect_near({g.force.x, g.force.y, g.force.z}, of_deep.force);
            expect_near(deep.first * turning + couple, of_deep.first);
            expect_near(deep.second * turning - couple, of_deep.second);
        }
}

// Both sides of a contact compute what it remembers, and one of the two is kept: they must agree to the last
// bit.
TEST(Couples, BothPartnersRememberTheSameBits) {
    const auto swapped = [](const Pair& p) {
        return Pair{-1.0 * p.d, -1.0 * p.dv, p.second_spin, p.first_spin, p.second, p.first};
    };
    for (const bool plane : {false, true}) {
        auto c = coefficients(plane);
        c.dissipative = 150; // of unloading
        c.tangential_stiffness = 30;
        c.rolling_stiffness = 2;
        for (int n = 0; n < 1000; ++n) {
            double one[7] = {}, other[7] = {};
            const Pair flat = pair(n, true), deep = pair(n, false);
            for (int visit = 0; visit < 2; ++visit) {
                (void)laws::pair_force<laws::WaltonBraun, laws::WaltonBraunTangential, laws::Couples::sprung>(
                    in_plane(flat), c, one, 0.01);
                (void)laws::pair_force<laws::WaltonBraun, laws::WaltonBraunTangential, laws::Couples::sprung>(
                    in_plane(swapped(flat)), c, other, 0.01);
            }
            ASSERT_EQ(one[0], -other[0]) << n; // the angle of rolling
            for (int m = 1; m < 6; ++m) ASSERT_EQ(one[m], other[m]) << n << ' ' << m;
            double zeta[8] = {}, mirrored[8] = {};
            for (int visit = 0; visit < 2; ++visit) {
                (void)laws::pair_force<laws::WaltonBraun, laws::CundallStrack, laws::Couples::sprung>(
                    in_space(deep), c, zeta, 0.01);
                (void)laws::pair_force<laws::WaltonBraun, laws::CundallStrack, laws::Couples::sprung>(
                    in_space(swapped(deep)), c, mirrored, 0.01);
            }
            for (int m = 0; m < 6; ++m) ASSERT_EQ(zeta[m], -mirrored[m]) << n << ' ' << m;
            ASSERT_EQ(zeta[6], mirrored[6]) << n;
        }
    }
}

// K1 and K2: with lever arms to the plane of the contact the surfaces of a pair that turns like one body, and
// of gears, do not slip, however deep the overlap.
TEST(Couples, RigidRotationAndGearsDoNotSlide) {
    auto c = coefficients(true);
    c.rolling_damping = 0;
    c.tangential_damping = 10;
    c.friction = 10;
    const Vec omega{0.3, -0.5, 0.7};
    Pair rigid = pair(3, false);
    rigid.d = (1.5 / norm(rigid.d)) * rigid.d;
    rigid.dv = cross(omega, rigid.d);
    rigid.first_spin = rigid.second_spin = omega;
    const auto f =
        laws::pair_force<laws::LinearDashpot, laws::HaffWerner, laws::Couples::damped>(in_space(rigid), c);
    EXPECT_NEAR(norm(Vec{f.turning.x, f.turning.y, f.turning.z}), 0, 1e-14);
    Pair gears = pair(3, true);
    gears.d = (1.5 / norm(gears.d)) * gears.d;
    gears.dv = {};
    const double arm = (1.5 * 1.5 + gears.first * gears.first - gears.second * gears.second) / 3;
    gears.first_spin = {0, 0, 0.7 / arm};
    gears.second_spin = {0, 0, -0.7 / (1.5 - arm)};
    const auto plane =
        laws::pair_force<laws::LinearDashpot, laws::HaffWerner, laws::Couples::damped>(in_plane(gears), c);
    EXPECT_NEAR(plane.tangential, 0, 1e-14);
    EXPECT_NEAR(plane.couple, 0, 1e-14);
}

// -k_r theta - gamma_r omega, at most mu_r R_eff f_n, where theta is set back; without stiffness the damper
// is left. Lever arms are the radii: the couple is that of rolling alone.
TEST(Couples, RollingSpringMatchesOracle) {
    int rolls = 0, holds = 0;
    for (const double k : {0.0, 2.0})
        for (int n = 0; n < 1000; ++n) {
            auto c = coefficients(false);
            c.tangential_stiffness = 30;
            c.rolling_stiffness = k;
            const Pair flat = pair(n, true), deep = pair(n, false);
            const double dt = 0.01;
            double memory[2] = {n % 2 == 0 ? 1e-3 : 0.1, 0}, spatial[6] = {};
            Real theta = k > 0 ? memory[0] : 0;
            const auto f = laws::pair_force<laws::LinearDashpot, laws::CundallStrack, laws::Couples::sprung>(
                in_plane(flat), c, memory, dt);
            const auto g = laws::pair_force<laws::LinearDashpot, laws::CundallStrack, laws::Couples::sprung>(
                in_space(deep), c, spatial, dt);
            const auto limit = [&](const Pair& p) {
                const Real3 d = real(p.d), dv = real(p.dv);
                const Real distance = std::sqrt(dot(d, d)), xi = Real{p.first} + p.second - distance;
                if (xi <= 0) return Real{0};
                const Real load = std::max(Real{0}, stiffness * xi - damping * dot(dv, (1 / distance) * d));
                return rolling_friction * load / (1 / Real{p.first} + 1 / Real{p.second});
            };
            const Real omega = Real{flat.first_spin.z} - flat.second_spin.z;
            theta += dt * omega;
            const Real trial = -k * theta - rolling * omega,
                       couple = std::clamp(trial, -limit(flat), limit(flat));
            EXPECT_NEAR(f.couple, static_cast<double>(couple), rounding) << n;
            if (limit(flat) > 0) {
                ++(couple == trial ? holds : rolls);
                const Real held = couple == trial ? theta : -(couple + rolling * omega) / k;
                EXPECT_NEAR(memory[0], k > 0 ? static_cast<double>(held) : 0.0, rounding) << n;
            }
            const Real3 d = real(deep.d), normal = (1 / std::sqrt(dot(d, d))) * d;
            Real3 differ = real(deep.first_spin) - real(deep.second_spin);
            differ = differ - dot(differ, normal) * normal;
            Real3 turned = -(k * dt + rolling) * differ;
            const Real size = std::sqrt(dot(turned, turned)), most = limit(deep);
            if (size > most) turned = (most / size) * turned;
            expect_near({g.couple.x, g.couple.y, g.couple.z}, turned);
        }
    EXPECT_GT(rolls, 50);
    EXPECT_GT(holds, 100);
}
