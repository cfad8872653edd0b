// Rolling friction with a spring: a body on a slope stands still below mu_r, rolls as it must above, and
// swings without loss where nothing slips.
#include "md/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace sandlane;
using namespace sandlane::test;
using scene::Inertia;

namespace {

constexpr double g = 9.81, radius = 0.01, mass = 0.01, stiffness = 1e6;

struct Body {
    const char* name;
    int dimension;
    Inertia inertia;
    double c; // J = c m R^2

    friend void PrintTo(const Body& body, std::ostream* stream) { *stream << body.name; }
};

class RollingSpring : public testing::TestWithParam<Body> {
protected:
    // A plane whose slope falls towards +x, and a body pressed into it by its own weight.
    [[nodiscard]] scene::Scene slope(double angle, double rolling_friction) const {
        scene::Scene s = empty_scene();
        s.domain.dimension = GetParam().dimension;
        s.domain.lower = {-5, -1, -1};
        s.domain.upper = {5, 1, 1};
        s.domain.gravity = {g * std::sin(angle), -g * std::cos(angle), 0};
        s.md.inertia = GetParam().inertia;
        s.md.tangential = scene::TangentialLaw::cundall_strack;
        s.md.dt = 5e-6;
        scene::Material& m = s.materials[0];
        m.stiffness = stiffness;
        m.friction = 0.5;
        m.tangential_stiffness = 1e5;
        m.tangential_damping = 5;
        m.rolling_friction = rolling_friction;
        m.rolling_stiffness = 0.1;
        s.walls = {floor_plane()};
        return s;
    }
    [[nodiscard]] md::Simulation make(const scene::Scene& s, double v = 0, double omega = 0) const {
        const double overlap = mass * -s.domain.gravity.y / stiffness;
        scene::GrainState b = grain(0, {0, radius - overlap, 0}, {v, 0, 0}, radius, mass, omega);
        b.angular_velocity = {0, 0, omega};
        return simulate(s, {b});
    }
    [[nodiscard]] double c() const { return GetParam().c; }
};

struct Now {
    double x, v, omega;
};
Now after(md::Simulation& sim, double seconds) {
    sim.run(std::llround(seconds / sim.plan().dt));
    const analysis::Snapshot s = sim.snapshot();
    return {s.x[0], s.vx[0], s.omega[0]};
}

std::string body_name(const testing::TestParamInfo<Body>& info) {
    return info.param.name;
}

} // namespace

// At rest the couple is what gravity asks for, R m g sin a, of a spring turned by as much over k_r: the body
// stands R times that farther down, and what the spring of friction gives way, m g sin a/k_t.
TEST_P(RollingSpring, StandsStillBelow) {
    const double angle = std::atan(0.08), pull = mass * g * std::sin(angle);
    scene::Scene s = slope(angle, 0.1);
    s.materials[0].rolling_damping = 7e-4; // near critical
    md::Simulation sim = make(s);
    const Now soon = after(sim, 0.12), later = after(sim, 0.03);
    const double turned = radius * pull / s.materials[0].rolling_stiffness;
    const double place = radius * turned + pull / s.materials[0].tangential_stiffness;
    EXPECT_NEAR(later.x, place, 1e-6 * place);
    EXPECT_NEAR(later.x - soon.x, 0, 1e-9 * place); // creep by viscous couples alone would be 1e5 times that
    EXPECT_NEAR(later.v, 0, 1e-12);
    EXPECT_NEAR(later.omega, 0, 1e-10);
}

// Above, the spring is at its limit: v' = g (sin a - mu_r cos a)/(1 + c).
TEST_P(RollingSpring, RollsAbove) {
    const double angle = 0.2;
    md::Simulation sim = make(slope(angle, 0.1));
    const Now first = after(sim, 0.05), now = after(sim, 0.05);
    const double expected = g * (std::sin(angle) - 0.1 * std::cos(angle)) / (1 + c());
    EXPECT_NEAR((now.v - first.v) / 0.05, expected, 1e-6 * expected);
    EXPECT_NEAR((first.omega - now.omega) * radius / 0.05, expected, 1e-4 * expected);
}

// A body that rolls without slip on a spring: w^2 = k_r/((1 + c) m R^2). The spring of friction is stiffer
// than the one against rolling, k_t R^2 = 100 k_r: a per cent of w^2 at most. Without dampers the energy
// stays.
TEST_P(RollingSpring, SwingsAtItsOwnFrequencyWithoutLoss) {
    scene::Scene s = slope(0, 10);
    s.materials[0].tangential_damping = 0;
    s.md.dt = 2e-6;
    const double v = 1e-3;
    md::Simulation sim = make(s, v, -v / radius);
    const double before = sim.observe().energy();
    const double frequency = std::sqrt(s.materials[0].rolling_stiffness / ((1 + c()) * mass)) / radius;
    double crossed = 0, last = v;
    int crossings = 0;
    for (int part = 0; part < 10000 && crossings < 6; ++part) {
        sim.run(5);
        const double now = sim.snapshot().vx[0];
        if (now * last < 0 && (sim.time() - crossed) * frequency > 1) { // not those of the other spring
            crossed = sim.time();
            ++crossings;
        }
        last = now;
    }
    ASSERT_EQ(crossings, 6);
    EXPECT_NEAR(crossed * frequency, 5.5 * std::numbers::pi, 0.02 * 5.5 * std::numbers::pi);
    // Springs are sums of steps, of first order: some w dt per swing.
    EXPECT_NEAR(sim.dissipated(sim.observe()), 0, 0.02 * mass * v * v);
    EXPECT_NEAR(sim.observe().energy(), before, 0.02 * mass * v * v);
}

// Rolling on, the spring takes mu_r m g R per angle, and what it held when the body stops comes back.
TEST_P(RollingSpring, TakesWhatItsLimitTakes) {
    md::Simulation sim = make(slope(0, 0.05), 0.5, -0.5 / radius);
    const Now first = after(sim, 0.02);
    const double before = sim.dissipated(sim.observe());
    const Now now = after(sim, 0.05);
    const double expected = 0.05 * mass * g * (now.x - first.x);
    EXPECT_NEAR(sim.dissipated(sim.observe()) - before, expected, 1e-3 * expected);
}

INSTANTIATE_TEST_SUITE_P(All, RollingSpring,
                         testing::Values(Body{"disc", 2, Inertia::disc, 0.5},
                                         Body{"sphere_in_the_plane", 2, Inertia::sphere, 0.4},
                                         Body{"sphere", 3, Inertia::sphere, 0.4}),
                         body_name);
