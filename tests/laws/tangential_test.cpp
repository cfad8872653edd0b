// The tangential laws by themselves: Walton and Braun's loop against closed forms and reference numbers of
// the specification (3.3, 9.5), what laws hold as energy, and the cube root.
#include "laws/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace {

using namespace sandlane;

// In units of mu f_n and k_0, at a constant load.
class Loop {
public:
    explicit Loop(double step) : step_(step) { (void)force(0, 0); }

    // Displaces the surfaces by about `distance`, in whole steps; returns the work done on the contact.
    double move(double distance) {
        const auto steps = static_cast<int>(std::lround(std::abs(distance) / step_));
        double work = 0;
        for (int n = 0; n < steps; ++n) work += advance(distance > 0 ? step_ : -step_);
        return work;
    }
    // Until F reaches f; returns the work.
    double move_until(double f) {
        double work = 0;
        const double direction = f > this->f() ? step_ : -step_;
        while (direction > 0 ? this->f() < f : this->f() > f) work += advance(direction);
        return work;
    }
    [[nodiscard]] double f() const { return memory_[0]; }
    [[nodiscard]] double place() const { return place_; }
    [[nodiscard]] double energy() const { return laws::WaltonBraunTangential::energy(1, 0.5, memory_); }

private:
    double advance(double shift) {
        const double before = f();
        place_ += shift;
        (void)force(shift, 1);
        return 0.5 * (before + f()) * shift;
    }
    double force(double rate, double elapsed) {
        return laws::WaltonBraunTangential::force(laws::TangentialInput<double>{2, rate, 0, 0.5, 1, elapsed},
                                                  memory_);
    }

    double step_, place_ = 0;
    double memory_[4] = {0, 0, 0, 0};
};

// The step is explicit, so that its error is of first order, about k' F' d zeta/2 < d zeta.
constexpr double step = 1e-5;

} // namespace

TEST(WaltonBraunTangential, FirstLoading) { // 9.5
    const double table[][2] = {{0.1, 0.0983143358}, {0.5, 0.4556689460}, {1, 0.8075499103}, {1.5, 1}};
    Loop loop(step);
    for (const auto& [zeta, f] : table) {
        (void)loop.move(zeta - loop.place());
        EXPECT_NEAR(loop.f(), f, step) << zeta;
    }
    (void)loop.move(0.3);
    EXPECT_EQ(loop.f(), 1); // slips
}

// From a turning point F* down by s: (1 + F*)(1 - 2 s/(3 (1 + F*)))^{3/2} - 1.
TEST(WaltonBraunTangential, UnloadsFromATurningPoint) {
    for (const double turn : {0.4, 0.8}) {
        Loop loop(step);
        (void)loop.move_until(turn);
        const double f = loop.f(), start = loop.place();
        for (const double s : {0.05, 0.5, 1.2}) {
            (void)loop.move(start - s - loop.place());
            EXPECT_NEAR(loop.f(), (1 + f) * std::pow(1 - 2 * s / (3 * (1 + f)), 1.5) - 1, 3 * step);
        }
    }
}

TEST(WaltonBraunTangential, Cycles) { // 9.5: dissipated energy and width at F = 0 of +-F*
    const double table[][3] = {{0.2, 0.0038263562, 0.4263429089},
                               {0.5, 0.0693005156, 1.1683128223},
                               {0.9, 0.5995003252, 2.4497397527}};
    for (const auto& [f, dissipated, width] : table) {
        Loop loop(0.3 * step);
        (void)loop.move_until(f);
        (void)loop.move_until(-f);
        const double lower = loop.place();
        double work = loop.move_until(f);
        EXPECT_NEAR(loop.place() - lower, width, 20 * step) << f; // stiffness 0.1 near F*: errors grow
        work += loop.move_until(-f);
        EXPECT_NEAR(work, dissipated, 20 * step) << f;
    }
}

// What the contact holds is what unloading gives back, whatever came before.
TEST(WaltonBraunTangential, HoldsWhatUnloadingGivesBack) {
    for (const double sign : {1.0, -1.0}) {
        Loop loop(step);
        (void)loop.move(sign * 0.9);
        double held = loop.energy();
        const double work = loop.move(-sign * 0.2);
        EXPECT_NEAR(loop.energy() - held, work, 3 * step);
        (void)loop.move(sign * 0.1);
        held = loop.energy();
        EXPECT_GT(held, 0.1);
        EXPECT_NEAR(loop.move_until(0), -held, 3 * step);
        EXPECT_NEAR(loop.energy(), 0, step);
        (void)loop.move_until(-sign * 0.5);
        held = loop.energy();
        EXPECT_NEAR(loop.move_until(0), -held, 3 * step);
    }
    const double small[4] = {1e-4, 0, 1, 2}; // like a spring
    EXPECT_NEAR(laws::WaltonBraunTangential::energy(1, 0.5, small), 0.5e-8, 1e-12);
    const double none[4] = {0, 0, 0, 0};
    EXPECT_EQ(laws::WaltonBraunTangential::energy(1, 0.5, none), 0);
}

// F* follows the load, F is held within it; without load all is forgotten, and no lane divides by zero.
TEST(WaltonBraunTangential, FollowsTheLoad) {
    double m[4] = {0, 0, 0, 0};
    const auto force = [&](double load, double shift) {
        return laws::WaltonBraunTangential::force(laws::TangentialInput<double>{load, shift, 0, 0.5, 1, 1},
                                                  m);
    };
    (void)force(2, 0.5);
    (void)force(2, -1e-3); // turns at F* = 0.5
    const double turn = m[1];
    EXPECT_EQ(turn, 0.5);
    (void)force(1, -1e-3);
    EXPECT_NEAR(m[1], 0.25, 1e-15);
    EXPECT_EQ(force(0.2, 0), -0.1); // clamped
    EXPECT_EQ(force(0, 0.3), 0);
    EXPECT_EQ(m[0], 0);
    EXPECT_EQ(m[1], 0);
    EXPECT_EQ(force(2, 0.1), -0.1); // afresh: F* = 0 since f_n was 0
    (void)force(2, 1e3);
    EXPECT_EQ(m[0], 1);
    EXPECT_EQ(force(2, 1e3), -1);
}

// In the direction that decreases F after full slip, F* = mu f_n: no zero over zero in the other one.
TEST(WaltonBraunTangential, FullSlipAndBack) {
    Loop loop(step);
    (void)loop.move(2);
    (void)loop.move(-1);
    EXPECT_NEAR(loop.f(), 2 * std::pow(1 - 1.0 / 3, 1.5) - 1, 3 * step);
    (void)loop.move(-3);
    EXPECT_EQ(loop.f(), -1);
}

TEST(CubeRoot, WithinFewUnitsInTheLastPlace) {
    double worst = 0;
    const auto check = [&](double x) {
        const double exact = std::cbrt(x), got = laws::cube_root(x);
        worst = std::max(worst, std::abs(got - exact) / (std::numeric_limits<double>::epsilon() * exact));
    };
    for (int n = 1; n <= 200000; ++n) check(n / 200000.0);
    // The law asks for 1 - F/(mu f_n) and its like: zero, or no less than the rounding of one.
    for (double x = 1; x > 1e-17; x *= 0.83) check(x);
    EXPECT_LT(worst, 3); // the last step of Halley: two products, a sum and a quotient
    EXPECT_EQ(laws::cube_root(0.0), 0);
    EXPECT_EQ(laws::cube_root(1.0), 1);
}

// What a spring holds, in the plane and in space.
TEST(CundallStrack, HoldsTheEnergyOfItsSpring) {
    const double zeta[3] = {0.3, -0.4, 1.2};
    EXPECT_NEAR(laws::CundallStrack::energy(2, 0.5, zeta), 0.09, 1e-16);
    EXPECT_NEAR(laws::CundallStrack::energy_in_space(2, 0.5, zeta), 1.69, 1e-15);
}

namespace {

// A contact with a spring and a damper that lasts, in space: k_t 100, gamma_t 0.3, mu 0.5.
struct SpatialContact {
    double zeta[3] = {0, 0, 0};
    Vector<double> normal{0, 0, 1};
    double twist = 0;

    Vector<double> force(double load, const Vector<double>& velocity, double elapsed) {
        return laws::CundallStrack::force(
            laws::SpatialInput<double>{load, velocity, normal, twist, 0.3, 0.5, 100, elapsed}, zeta);
    }
    [[nodiscard]] double length() const { return std::hypot(zeta[0], zeta[1], zeta[2]); }
};

constexpr double ulp = std::numeric_limits<double>::epsilon();

} // namespace

// While it slides spring and damper together give just the force; without load nothing is left.
TEST(CundallStrack, SlidesWithItsDamper) {
    double zeta[1] = {0};
    const auto force = [&](double load, double rate) {
        return laws::CundallStrack::force(laws::TangentialInput<double>{load, rate, 0.3, 0.5, 100, 0.01},
                                          zeta);
    };
    for (const double rate : {0.4, -0.4}) {
        for (int n = 0; n < 20; ++n) (void)force(1, rate);
        const double f = force(1, rate);
        EXPECT_DOUBLE_EQ(f, rate > 0 ? -0.5 : 0.5);
        EXPECT_NEAR(100 * zeta[0] + 0.3 * rate, -f, 4 * ulp);
    }
    (void)force(0, 0.4);
    EXPECT_EQ(zeta[0], 0);
}

// Along each axis of space it is the law of the plane, sticking, sliding and let go.
TEST(CundallStrack, InSpaceAlongALine) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto along = [&](int a) { return a == axis ? 1.0 : 0.0; };
        SpatialContact contact;
        contact.normal = {along(2), along(0), along(1)};
        double zeta[1] = {0};
        for (int n = 0; n < 200; ++n) {
            const double rate = std::sin(0.1 * n), load = n == 150 ? 0.0 : 1 + 0.5 * std::cos(0.3 * n);
            const double plane = laws::CundallStrack::force(
                laws::TangentialInput<double>{load, rate, 0.3, 0.5, 100, 0.01}, zeta);
            const auto f = contact.force(load, {rate * along(0), rate * along(1), rate * along(2)}, 0.01);
            // Of a spring that is as long as the limit allows, and rounded at each step.
            EXPECT_NEAR(f.x * along(0) + f.y * along(1) + f.z * along(2), plane, 1e-13);
            EXPECT_NEAR(contact.zeta[axis], zeta[0], 1e-15);
            EXPECT_EQ(contact.zeta[(axis + 1) % 3], 0);
        }
    }
}

// Grains that both spin about the normal take the spring along, without a change of its length.
TEST(CundallStrack, InSpaceTurnsWithTheTwist) {
    SpatialContact contact;
    (void)contact.force(1, {0.1, 0, 0}, 0.01);
    const double before = contact.length();
    contact.twist = 2;
    for (int n = 0; n < 100; ++n) (void)contact.force(1, {0, 0, 0}, 0.001);
    EXPECT_NEAR(std::atan2(contact.zeta[1], contact.zeta[0]), 0.2, 1e-6); // each step by the tangent of 0.002
    EXPECT_NEAR(contact.length(), before, 1e-14 * before);
}

// A contact that rolls around the grain takes the spring into its plane, at its old length: by the series for
// small turns, where e is up to 1e-5, and by roots beyond.
TEST(CundallStrack, InSpaceKeepsItsLengthWhereTheNormalTurns) {
    for (const double angle : {1e-4, 3e-3, 0.3}) {
        SpatialContact contact;
        (void)contact.force(1, {0.1, 0.05, 0}, 0.01);
        const double before = contact.length();
        contact.normal = {std::sin(angle), 0, std::cos(angle)};
        (void)contact.force(1, {0, 0, 0}, 0.01);
        EXPECT_NEAR(contact.length(), before, 4 * ulp * before) << angle;
        EXPECT_NEAR(contact.zeta[0] * contact.normal.x + contact.zeta[2] * contact.normal.z, 0, ulp * before);
    }
}
