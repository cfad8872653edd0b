// Discs and spheres that slide, roll and stand on a plane, in the plane and in space: closed forms and
// reference numbers of the specification (9.6), rolling friction, and the angular momentum that lever arms to
// the plane of the contact conserve (1.8, 9.1).
#include "md/support.hpp"
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

using namespace sandlane;
using namespace sandlane::test;
using scene::Inertia;
using scene::TangentialLaw;

namespace {

constexpr double g = 9.81, radius = 0.01, stiffness = 1e6;

// J = c m R^2.
struct Body {
    const char* name;
    int dimension;
    Inertia inertia;
    double c;

    friend void PrintTo(const Body& body, std::ostream* stream) { *stream << body.name; }
};

class OnAPlane : public testing::TestWithParam<Body> {
protected:
    // A plane whose slope falls towards +x.
    [[nodiscard]] scene::Scene slope(TangentialLaw law, double angle, double friction) const {
        scene::Scene s = empty_scene();
        s.domain.dimension = GetParam().dimension;
        s.domain.lower = {-5, -1, -1};
        s.domain.upper = {5, 1, 1};
        s.domain.gravity = {g * std::sin(angle), -g * std::cos(angle), 0};
        s.md.inertia = GetParam().inertia;
        s.md.tangential = law;
        s.materials[0].stiffness = stiffness;
        s.materials[0].friction = friction;
        s.walls = {floor_plane()};
        return s;
    }
    // Pressed into the plane by its own weight.
    [[nodiscard]] static scene::GrainState body(const scene::Scene& s, double mass, double v, double omega) {
        const double overlap = mass * -s.domain.gravity.y / stiffness;
        scene::GrainState b = grain(0, {0, radius - overlap, 0}, {v, 0, 0}, radius, mass, omega);
        b.angular_velocity = {0, 0, omega};
        return b;
    }
    [[nodiscard]] double c() const { return GetParam().c; }
};

struct Now {
    double v, omega;
};
Now after(md::Simulation& sim, double seconds) {
    sim.run(std::llround(seconds / sim.plan().dt));
    const analysis::Snapshot s = sim.snapshot();
    return {s.vx[0], s.omega[0]};
}

std::string body_name(const testing::TestParamInfo<Body>& info) {
    return info.param.name;
}

constexpr double degree = std::numbers::pi / 180;

} // namespace

// Under a constant force every integrator is exact; what is left is the rounding of the overlap, 1e-11 of it.
constexpr double exact = 1e-9;

TEST_P(OnAPlane, SlidesAndThenRolls) {
    scene::Scene s = slope(TangentialLaw::haff_werner, 0, 0.3);
    const double mass = 0.01, v0 = 1, t_roll = c() * v0 / ((1 + c()) * 0.3 * g);
    EXPECT_NEAR(t_roll, c() == 0.4 ? 0.0970826659 : 0.1132631102, 1e-10);
    s.materials[0].tangential_damping = 50;
    s.md.dt = 8e-6;
    md::Simulation sim = simulate(s, {body(s, mass, v0, 0)});
    const double early = std::floor(0.9 * t_roll / s.md.dt) * s.md.dt;
    const Now sliding = after(sim, early);
    EXPECT_NEAR(sliding.v, v0 - 0.3 * g * early, exact);
    EXPECT_NEAR(sliding.omega * radius, -0.3 * g * early / c(), exact);
    // The rest of the slip decays at the rate gamma_t (1 + 1/c)/m > 1e4/s.
    const Now rolling = after(sim, 0.2 * t_roll + 0.01);
    EXPECT_NEAR(rolling.v, v0 / (1 + c()), exact);
    EXPECT_NEAR(rolling.omega * radius, -v0 / (1 + c()), exact);
}

TEST_P(OnAPlane, SpinsUp) { // v = R omega_0 c/(1 + c)
    scene::Scene s = slope(TangentialLaw::haff_werner, 0, 0.3);
    s.materials[0].tangential_damping = 50;
    s.md.dt = 8e-6;
    md::Simulation sim = simulate(s, {body(s, 0.01, 0, -100)});
    EXPECT_NEAR(after(sim, 0.3).v, c() / (1 + c()), exact);
}

TEST_P(OnAPlane, RollsDownASlope) { // 10 degrees: g sin a/(1 + c)
    const double acceleration = c() == 0.4 ? 1.2167775878 : 1.1356590819;
    scene::Scene s = slope(TangentialLaw::cundall_strack, 10 * degree, 0.3);
    s.materials[0].tangential_stiffness = 1e4;
    s.materials[0].tangential_damping = 5;
    s.md.dt = 1e-5;
    md::Simulation sim = simulate(s, {body(s, 0.01, 0, 0)});
    const Now now = after(sim, 0.2);
    EXPECT_NEAR(now.v, 0.2 * acceleration, exact);
    EXPECT_NEAR(now.omega * radius, -now.v, exact);
}

TEST_P(OnAPlane, SlidesDownASteepSlope) { // 60 degrees, mu 0.3: g (sin a - mu cos a)
    scene::Scene s = slope(TangentialLaw::cundall_strack, 60 * degree, 0.3);
    s.materials[0].tangential_stiffness = 1e6;
    s.md.dt = 4e-6;
    md::Simulation sim = simulate(s, {body(s, 0.01, 0, 0)});
    const Now first = after(sim, 0.01); // the spring is at its limit after k_t zeta = mu f_n: 0.1 ms
    const Now now = after(sim, 0.05);
    EXPECT_NEAR((now.v - first.v) / 0.05, 7.0242092111, 1e-7);
    EXPECT_NEAR((first.omega - now.omega) / 0.05, c() == 0.4 ? 367.875 : 294.3, 1e-4);
}

TEST_P(OnAPlane, RollsWithAnEvenSlipByHaffAndWerner) { // c/(1 + c) m g sin a/gamma_t
    scene::Scene s = slope(TangentialLaw::haff_werner, 10 * degree, 0.5);
    s.materials[0].tangential_damping = 200;
    s.md.dt = 1e-4;
    md::Simulation sim = simulate(s, {body(s, 1, 0, 0)});
    const Now now = after(sim, 0.2); // relaxes at 600/s or more
    EXPECT_NEAR(now.v + radius * now.omega, c() == 0.4 ? 2.43355518e-3 : 2.83914770e-3, 1e-9);
}

// Gross stick of the spring without loss: u_t'/u_t = cos(pi sqrt((k_t/k_n)(m_eff/m_t))), 1/m_t = (1 + 1/c)/m
// (3.4).
TEST_P(OnAPlane, SticksInAnObliqueImpact) {
    for (const double ratio : {2.0 / 7, 1.0}) {
        scene::Scene s = slope(TangentialLaw::cundall_strack, 0, 100);
        s.domain.gravity = {};
        s.materials[0].tangential_stiffness = ratio * stiffness;
        const double mass = 1e-3, expected = std::cos(std::numbers::pi * std::sqrt(ratio * (1 + 1 / c())));
        const double sphere = ratio == 1 ? 0.9187854559 : -1,
                     disc = ratio == 1 ? 0.6661309236 : -0.9729681456;
        EXPECT_NEAR(expected, c() == 0.4 ? sphere : disc, 1e-10);
        s.md.dt = std::numbers::pi * std::sqrt(mass / stiffness) / 5003.7;
        scene::GrainState b = grain(0, {0, radius + 1e-8, 0}, {0.1, -1, 0}, radius, mass);
        md::Simulation sim = simulate(s, {b});
        const Now now = after(sim, 5600 * s.md.dt);
        EXPECT_NEAR((now.v + radius * now.omega) / 0.1, expected, 2e-3); // the spring is of first order in dt
    }
}

// Gross sliding: eps 0.8, g_n = g_t = 1, mu 0.1: -0.18 of the centre's velocity, -0.18 (1 + 1/c) of the
// contact's.
TEST_P(OnAPlane, SlidesInAnObliqueImpact) {
    scene::Scene s = slope(TangentialLaw::haff_werner, 0, 0.1);
    s.domain.gravity = {};
    const double mass = 1e-3;
    s.materials[0].damping = 2 * 0.0743551022 * std::sqrt(stiffness * mass);
    s.materials[0].tangential_damping = 1000;
    s.md.dt = 4e-8;
    md::Simulation sim = simulate(s, {grain(0, {0, radius + 1e-7, 0}, {1, -1, 0}, radius, mass)});
    const Now now = after(sim, 2e-4);
    EXPECT_NEAR(now.v, 1 - 0.18, 5e-4); // t_c/2000, of first order
    EXPECT_NEAR(now.v + radius * now.omega, c() == 0.4 ? 0.37 : 0.46, 2e-3);
}

// ---- rolling friction

// m v' = f_t and c m R v' = -R f_t - mu_r R m g: v' = -mu_r g/(1 + c), R_eff = R on a plane.
TEST_P(OnAPlane, RollingFrictionBrakes) {
    scene::Scene s = slope(TangentialLaw::haff_werner, 0, 0.5);
    s.materials[0].tangential_damping = 50;
    s.materials[0].rolling_friction = 0.05;
    s.materials[0].rolling_damping = 1e-3; // all of mu_r f_n R down to 0.005 rad/s
    s.md.dt = 1e-6;
    const double mass = 0.01;
    md::Simulation sim = simulate(s, {body(s, mass, 1, -1 / radius)});
    const Now first = after(sim, 0.01), now = after(sim, 0.05);
    EXPECT_NEAR((now.v - first.v) / 0.05, -0.05 * g / (1 + c()), 1e-8);
    EXPECT_NEAR((now.omega - first.omega) * radius / 0.05, 0.05 * g / (1 + c()), 1e-8);
}

// Below mu_r a body creeps: R f_t = gamma_r omega, and the surfaces slip by f_t/gamma_t or not at all.
TEST_P(OnAPlane, CreepsWhereRollingFrictionHolds) {
    const double mass = 0.01, angle = 0.02, pull = mass * g * std::sin(angle), rolling = 2e-3, sliding = 5;
    for (const auto law : {TangentialLaw::haff_werner, TangentialLaw::cundall_strack}) {
        scene::Scene s = slope(law, angle, 0.5);
        s.materials[0].tangential_damping = sliding;
        s.materials[0].tangential_stiffness = 1e4;
        s.materials[0].rolling_friction = 0.05;
        s.materials[0].rolling_damping = rolling;
        s.md.dt = 5e-6;
        md::Simulation sim = simulate(s, {body(s, mass, 0, 0)});
        const Now now = after(sim, 0.04); // relaxes at gamma_r/((1 + c) m R^2) > 1e3/s
        const double rolls = radius * radius * pull / rolling;
        const double slips = law == TangentialLaw::haff_werner ? pull / sliding : 0;
        EXPECT_NEAR(now.v, rolls + slips, exact);
        EXPECT_NEAR(now.omega * radius, -rolls, exact);
        EXPECT_NEAR(std::abs(sim.contacts().at(0).tangential), pull, exact);
    }
}

TEST_P(OnAPlane, RollsWhereRollingFrictionDoesNotHold) { // v' = g (sin a - mu_r cos a)/(1 + c)
    const double angle = 0.2;
    scene::Scene s = slope(TangentialLaw::haff_werner, angle, 0.5);
    s.materials[0].tangential_damping = 50;
    s.materials[0].rolling_friction = 0.05;
    s.materials[0].rolling_damping = 1e-3;
    s.md.dt = 1e-6;
    md::Simulation sim = simulate(s, {body(s, 0.01, 0, 0)});
    const Now first = after(sim, 0.02), now = after(sim, 0.05);
    EXPECT_NEAR((now.v - first.v) / 0.05, g * (std::sin(angle) - 0.05 * std::cos(angle)) / (1 + c()), 1e-8);
}

// Two grains that cohesion holds together and that turn against each other like gears: nothing slips, and
// J omega' = -min(2 gamma_r omega, mu_r R_eff f_n), f_n what presses them together.
TEST_P(OnAPlane, RollingFrictionOfTwoGrains) {
    scene::Scene s = slope(TangentialLaw::haff_werner, 0, 0.5);
    s.walls.clear();
    s.domain.gravity = {};
    s.md.normal = scene::NormalLaw::cohesive_viscoelastic;
    scene::Material& m = s.materials[0];
    m.young = 1e7;
    m.dissipation = 1e-4;
    m.cohesion = 3e4;
    m.tangential_damping = 1;
    m.rolling_friction = 0.1;
    m.rolling_damping = 2e-7;
    s.md.max_speed = 0.1;
    s.md.dt = 1e-6;
    const double mass = 0.01, reduced = 0.5 * radius, inertia = c() * mass * radius * radius;
    const double k = 2.0 / 3 * m.young / (1 - m.poisson * m.poisson) * std::sqrt(reduced);
    const double pull = 4 * std::numbers::pi * m.cohesion * reduced, overlap = std::pow(pull / k, 2);
    const double brake = 0.1 * reduced * pull * overlap / inertia; // rad/s^2
    const double omega = 100, twist = GetParam().dimension == 3 ? 7 : 0;
    std::vector<scene::GrainState> grains;
    for (const double side : {-1.0, 1.0}) {
        grains.push_back(grain(grains.empty() ? 0 : 1, {side * (radius - 0.5 * overlap), 0, 0}, {}, radius,
                               mass, side * omega));
        grains.back().angular_velocity = {side * twist, 0, side * omega};
    }
    md::Simulation sim = simulate(s, grains);
    ASSERT_GT(2 * m.rolling_damping * omega, brake * inertia);
    // Two grains know of each other by one division and one root, some 1e-15; times 1e3 rad/s^2 and the like.
    Now now = after(sim, 0.01);
    EXPECT_NEAR(now.omega, -(omega - 0.01 * brake), 1e-8 * omega);
    // On to where the damper takes over, 2 gamma_r omega = brake J, and from there exponentially.
    const double handover = brake * inertia / (2 * m.rolling_damping), at = (omega - handover) / brake;
    if (at < 1) {
        now = after(sim, at + 0.002 - 0.01);
        const double t = static_cast<double>(sim.step()) * s.md.dt - at;
        EXPECT_NEAR(now.omega, -handover * std::exp(-2 * m.rolling_damping * t / inertia), 1e-4 * omega);
    }
    const analysis::Snapshot end = sim.snapshot();
    EXPECT_NEAR(end.omega[0] + end.omega[1], 0, 1e-12 * omega);
    const double about_normal = GetParam().dimension == 3 ? end.omega_x[0] : 0;
    EXPECT_NEAR(about_normal, -twist, 1e-12 * omega); // no rolling
}

INSTANTIATE_TEST_SUITE_P(All, OnAPlane,
                         testing::Values(Body{"disc", 2, Inertia::disc, 0.5},
                                         Body{"sphere_in_the_plane", 2, Inertia::sphere, 0.4},
                                         Body{"sphere", 3, Inertia::sphere, 0.4}),
                         body_name);

// ---- lever arms to the plane of the contact

namespace {

Vec angular_momentum(const md::Simulation& sim) {
    const analysis::Snapshot n = sim.snapshot();
    const bool plane = sim.plan().dimension == 2;
    Vec total;
    for (std::size_t i = 0; i < n.size(); ++i) {
        const Vec r{n.x[i], n.y[i], plane ? 0 : n.z[i]}, v{n.vx[i], n.vy[i], plane ? 0 : n.vz[i]};
        const Vec omega{plane ? 0 : n.omega_x[i], plane ? 0 : n.omega_y[i], n.omega[i]};
        total = total + n.mass[i] * cross(r, v) +
                sim.plan().inertia_factor * n.mass[i] * n.radius[i] * n.radius[i] * omega;
    }
    return total;
}

struct Cluster {
    const char* name;
    int dimension;
    TangentialLaw law;

    friend void PrintTo(const Cluster& cluster, std::ostream* stream) { *stream << cluster.name; }
};

class LeverArms : public testing::TestWithParam<Cluster> {
protected:
    // A few grains of unequal radii in free space, with rolling friction too.
    [[nodiscard]] md::Simulation cluster(scene::LeverArm arm) const {
        const bool plane = GetParam().dimension == 2;
        scene::Scene s = plane ? lattice_scene(4, 4) : space_scene(2);
        std::vector<scene::GrainState> grains = plane ? lattice_grains(4, 4) : space_grains(2);
        s.domain.periodic = {};
        s.domain.lower = {-20, -20, plane ? 0.0 : -20.0};
        s.domain.upper = {20, 20, plane ? 0.0 : 20.0};
        s.materials[0].tangential_stiffness = 200;
        s.materials[0].rolling_friction = 0.1;
        s.materials[0].rolling_damping = 0.05;
        s.md.tangential = GetParam().law;
        s.md.integrator = scene::Integrator::velocity_verlet;
        s.md.lever_arm = arm;
        return make_simulation(s, grains, simd::available_isas().back());
    }
};

} // namespace

// Velocity Verlet takes the mean of the torques before and after the step, whose sum is zero each time: what
// is left is rounding, some 1e-16 of the momentum a step. Measured in that of a grain that passes at its
// radius.
TEST_P(LeverArms, ConserveAngularMomentum) { // 9.1 K4
    for (const auto arm : {scene::LeverArm::plane, scene::LeverArm::undeformed}) {
        md::Simulation sim = cluster(arm);
        const Vec before = angular_momentum(sim);
        EXPECT_GT(sim.observe().contacts, 3);
        sim.run(300);
        const double change = norm(angular_momentum(sim) - before);
        if (arm == scene::LeverArm::plane)
            EXPECT_LT(change, 1e-12 * 16);
        else
            EXPECT_GT(change, 1e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(All, LeverArms,
                         testing::Values(Cluster{"plane_haff_werner", 2, TangentialLaw::haff_werner},
                                         Cluster{"plane_springs", 2, TangentialLaw::cundall_strack},
                                         Cluster{"plane_walton_braun", 2, TangentialLaw::walton_braun},
                                         Cluster{"space_haff_werner", 3, TangentialLaw::haff_werner},
                                         Cluster{"space_springs", 3, TangentialLaw::cundall_strack}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// Seen from a point of a flat wall friction acts along the line through it: only the normal force turns the
// grain about that point.
TEST(LeverArmsOnAWall, FrictionDoesNotTurnAboutAPointOfTheWall) {
    for (const int dimension : {2, 3}) {
        scene::Scene s = empty_scene();
        s.domain.dimension = dimension;
        s.domain.lower.z = -1;
        s.domain.upper.z = 1;
        s.walls = {floor_plane()};
        s.md.inertia = Inertia::sphere;
        s.md.tangential = TangentialLaw::cundall_strack;
        s.md.lever_arm = scene::LeverArm::plane;
        s.md.integrator = scene::Integrator::velocity_verlet;
        s.materials[0].stiffness = 1e4;
        s.materials[0].tangential_stiffness = 5e3;
        s.materials[0].friction = 0.4;
        s.md.dt = 1e-5;
        scene::GrainState ball = grain(0, {0.02, 0.1001, 0}, {0.7, -1, 0}, 0.1, 0.1, 3);
        ball.angular_velocity = {1, 2, 3};
        if (dimension == 3) ball.velocity.z = -0.3;
        md::Simulation sim = simulate(s, {ball});
        const auto turning = [&] { // about the origin, of the normal force alone
            const analysis::Contacts contacts = sim.contacts();
            const analysis::Snapshot n = sim.snapshot();
            if (contacts.empty()) return Vec{};
            return cross(Vec{n.x[0], n.y[0], dimension == 3 ? n.z[0] : 0}, Vec{0, contacts[0].force.y, 0});
        };
        Vec expected = angular_momentum(sim), last = turning();
        int touching = 0;
        for (int step = 0; step < 1200; ++step) {
            sim.run(1);
            const Vec now = turning();
            expected = expected + (0.5 * s.md.dt) * (last + now);
            touching += norm(now) > 0 ? 1 : 0;
            last = now;
        }
        EXPECT_GT(touching, 500);
        EXPECT_TRUE(sim.contacts().empty());
        const Vec error = angular_momentum(sim) - expected;
        EXPECT_NEAR(error.x, 0, 1e-12 * 0.01); // m R v
        EXPECT_NEAR(error.z, 0, 1e-12 * 0.01);
    }
}
