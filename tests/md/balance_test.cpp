// Collisions at many phases within a step (4.4), and the balance of energy with a moving wall: without loss,
// with losses counted independently, and monotone for every pair of laws.
#include "support/space_system.hpp"

#include "md/support.hpp"
#include "scene/schema.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace sandlane;
using namespace sandlane::test;
using scene::Integrator;
using scene::NormalLaw;
using scene::TangentialLaw;

// ---- restitution

namespace {

struct Phases {
    const char* name;
    NormalLaw normal;
    Integrator integrator;
    bool cut;
    double restitution;
    double error[3]; // at 25, 50 and 100 steps per collision time: 4.4, and a quarter

    friend void PrintTo(const Phases& p, std::ostream* stream) { *stream << p.name; }
};

class CollisionPhases : public testing::TestWithParam<Phases> {};

constexpr int phases = 20;

// Pairs of unit reduced mass and stiffness that meet at unit speed, each a little later within a step.
std::vector<scene::GrainState> meeting_pairs(double dt) {
    std::vector<scene::GrainState> grains;
    for (int n = 0; n < phases; ++n) {
        const double gap = (3 + (n + 0.5) / phases) * dt, y = 25.0 * n + 10;
        for (const double side : {-1.0, 1.0}) {
            scene::GrainState g = grain(0, {500 + side * (10 + 0.5 * gap), y, 0}, {-0.5 * side, 0, 0}, 10, 2);
            g.id = static_cast<std::int64_t>(grains.size());
            grains.push_back(g);
        }
    }
    return grains;
}

} // namespace

TEST_P(CollisionPhases, RestitutionWithinTheErrorOfTheIntegrator) {
    const Phases& p = GetParam();
    for (int n = 0; n < 3; ++n) {
        scene::Scene s = empty_scene();
        s.domain.lower = {0, 0, 0};
        s.domain.upper = {1000, 600, 0};
        s.md.normal = p.normal;
        s.md.integrator = p.integrator;
        s.md.cut = p.cut;
        const double t_c = p.normal == NormalLaw::viscoelastic ? 3.2180654597 : std::numbers::pi;
        s.md.dt = t_c / (25 << n);
        scene::Material& m = s.materials[0];
        m.stiffness = 1;
        m.unloading_stiffness = 1.5625;
        m.damping = 0.2; // z = 0.1
        m.poisson = 0;   // K = (2/3) Y sqrt(5)
        m.young = 1.5 / std::sqrt(5.0);
        m.dissipation = 0.1; // x = 0.1
        md::Simulation sim = simulate(s, meeting_pairs(s.md.dt));
        sim.run((25 << n) * 2);
        const analysis::Snapshot now = sim.snapshot();
        double worst = 0;
        for (std::size_t i = 0; i < now.size(); i += 2)
            worst = std::max(worst, std::abs(now.vx[i + 1] - now.vx[i] - p.restitution));
        EXPECT_LT(worst, 1.25 * p.error[n]) << (25 << n);
        EXPECT_TRUE(sim.contacts().empty());
    }
}

// Linear spring, cut or uncut, and its like: the first column of 4.4. Walton and Braun's force has no jump,
// and is no worse than that of the dashpot.
INSTANTIATE_TEST_SUITE_P(All, CollisionPhases,
                         testing::Values(Phases{"dashpot_gear",
                                                NormalLaw::linear_dashpot,
                                                Integrator::gear5,
                                                true,
                                                0.74407940,
                                                {1.0e-2, 4.5e-3, 2.3e-3}},
                                         Phases{"dashpot_verlet",
                                                NormalLaw::linear_dashpot,
                                                Integrator::velocity_verlet,
                                                true,
                                                0.74407940,
                                                {9.2e-3, 4.9e-3, 2.3e-3}},
                                         Phases{"uncut_dashpot_gear",
                                                NormalLaw::linear_dashpot,
                                                Integrator::gear5,
                                                false,
                                                0.72924761,
                                                {2e-2, 9e-3, 4.6e-3}},
                                         Phases{"viscoelastic_gear",
                                                NormalLaw::viscoelastic,
                                                Integrator::gear5,
                                                true,
                                                0.89285888,
                                                {1.1e-3, 2.3e-4, 9.1e-5}},
                                         Phases{"viscoelastic_verlet",
                                                NormalLaw::viscoelastic,
                                                Integrator::velocity_verlet,
                                                true,
                                                0.89285888,
                                                {1.5e-3, 3.3e-4, 1.0e-4}},
                                         Phases{"uncut_viscoelastic_gear",
                                                NormalLaw::viscoelastic,
                                                Integrator::gear5,
                                                false,
                                                0.89214759,
                                                {2.2e-3, 4.6e-4, 1.8e-4}},
                                         Phases{"walton_braun_gear",
                                                NormalLaw::walton_braun,
                                                Integrator::gear5,
                                                true,
                                                0.8,
                                                {1.0e-2, 4.5e-3, 2.3e-3}},
                                         Phases{"walton_braun_verlet",
                                                NormalLaw::walton_braun,
                                                Integrator::velocity_verlet,
                                                true,
                                                0.8,
                                                {9.2e-3, 4.9e-3, 2.3e-3}}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// ---- energy

namespace {

// Grains above a floor that comes up at an angle, periodic along it, under gravity.
class Shaken {
public:
    Shaken(int dimension, NormalLaw normal, TangentialLaw tangential) : plane_(dimension == 2) {
        scene = plane_ ? lattice_scene(5, 5) : space_scene(3);
        grains = plane_ ? lattice_grains(5, 5) : space_grains(3);
        const double period = scene.domain.upper.y; // the packing may be cut along y
        for (auto& g : grains)
            if (g.position.y > 0.95 * period) g.position.y -= period;
        scene.domain.lower.y = -10;
        scene.domain.upper.y = 60;
        scene.domain.periodic = {true, false, !plane_};
        scene.domain.gravity = {0, -5, 0};
        scene.md.normal = normal;
        scene.md.tangential = tangential;
        scene.md.dt = 5e-4; // t_c/120 of two grains
        scene::Material& m = scene.materials[0];
        m.young = 1000;
        m.unloading_stiffness = 1500;
        m.dissipation = 2e-3;
        m.tangential_stiffness = 300;
        m.cohesion = 10;
        scene.walls = {floor_plane()};
        scene.walls[0].points = {{0, -1.2, 0}};
        scene.walls[0].motion = "up";
        scene.motions.resize(1);
        scene.motions[0].name = "up";
        scene.motions[0].kind = scene::MotionKind::linear;
        scene.motions[0].velocity = floor_velocity;
        if (tangential == TangentialLaw::none)
            for (auto& g : grains) g.omega = 0, g.angular_velocity = {};
    }
    void add_couples(double rolling_stiffness = 0) {
        scene.materials[0].rolling_friction = 0.1;
        scene.materials[0].rolling_damping = 0.05;
        scene.materials[0].rolling_stiffness = rolling_stiffness;
    }
    [[nodiscard]] md::Simulation make() const {
        return make_simulation(scene, grains, simd::available_isas().back());
    }

    scene::Scene scene;
    std::vector<scene::GrainState> grains;
    Vec floor_velocity{0.7, 0.5, 0};

private:
    bool plane_;
};

constexpr NormalLaw normal_laws[] = {NormalLaw::linear_dashpot, NormalLaw::viscoelastic,
                                     NormalLaw::walton_braun, NormalLaw::cohesive_viscoelastic};

// Energies are some 100 J. The integrator's error of a collision is 1e-4 of its energy, and may have either
// sign.
constexpr double integrator = 0.02;

} // namespace

TEST(Balance, WithoutLoss) {
    for (const int dimension : {2, 3})
        for (const NormalLaw normal : normal_laws) {
            Shaken shaken(dimension, normal, TangentialLaw::none);
            scene::Material& m = shaken.scene.materials[0];
            m.damping = m.dissipation = 0;
            m.unloading_stiffness = m.stiffness;
            md::Simulation sim = shaken.make();
            sim.run(3000);
            EXPECT_GT(sim.wall_work(), 50);
            EXPECT_NEAR(sim.dissipated(sim.observe()), 0, integrator)
                << dimension << scene::normal_choices()[static_cast<std::size_t>(normal)];
        }
}

namespace {

// Power that the dashpots, friction by Haff and Werner and rolling friction of a contact take, W, by the
// formulas of the specification; without the cut, so that no stored energy is lost besides.
struct Partner {
    Vec position, velocity, omega;
    double radius; // 0: flat
};

double loss(const scene::Scene& s, const Partner& a, const Partner& b, Vec d) {
    const scene::Material& m = s.materials[0];
    const double distance = norm(d), xi = a.radius + b.radius - distance;
    if (xi <= 0) return 0;
    const Vec n = (1 / distance) * d, dv = a.velocity - b.velocity, turn = a.omega - b.omega;
    const double rate = dot(dv, n),
                 reduced = b.radius > 0 ? a.radius * b.radius / (a.radius + b.radius) : a.radius;
    const double k = m.young / (1 - m.poisson * m.poisson) * 2 / 3 * std::sqrt(reduced * xi);
    const bool linear = s.md.normal == NormalLaw::linear_dashpot;
    const double damping = linear ? m.damping : k * m.dissipation, spring = linear ? m.stiffness : k;
    const double load = std::max(0.0, spring * xi + damping * rate);
    const Vec u = dv + cross(a.radius * a.omega + b.radius * b.omega, n);
    const double slip = norm(u - dot(u, n) * n), roll = norm(turn - dot(turn, n) * n);
    return damping * rate * rate + std::min(m.tangential_damping * slip, m.friction * load) * slip +
           std::min(m.rolling_damping * roll, m.rolling_friction * reduced * load) * roll;
}

double loss(const scene::Scene& s, const analysis::Snapshot& now,
            const std::vector<scene::GrainState>& grains, double floor, Vec floor_velocity) {
    const bool plane = s.domain.dimension == 2;
    std::vector<Partner> all;
    for (std::size_t i = 0; i < grains.size(); ++i)
        all.push_back({{now.x[i], now.y[i], plane ? 0 : now.z[i]},
                       {now.vx[i], now.vy[i], plane ? 0 : now.vz[i]},
                       {plane ? 0 : now.omega_x[i], plane ? 0 : now.omega_y[i], now.omega[i]},
                       now.radius[i]});
    const double length = s.domain.upper.x;
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            Vec d = all[j].position - all[i].position;
            d.x -= length * std::nearbyint(d.x / length);
            if (!plane) d.z -= length * std::nearbyint(d.z / length);
            sum += loss(s, all[i], all[j], d);
        }
        sum += loss(s, all[i], {{}, floor_velocity, {}, 0}, {0, floor - all[i].position.y, 0});
    }
    return sum;
}

} // namespace

// The sum over steps is of first order: contacts begin within a step, with the dashpot at full power. Some
// 1e-3.
TEST(SlowBalance, LossesCountedIndependently) {
    for (const int dimension : {2, 3})
        for (const NormalLaw normal :
             {NormalLaw::linear_dashpot, NormalLaw::viscoelastic, NormalLaw::cohesive_viscoelastic}) {
            Shaken shaken(dimension, normal, TangentialLaw::haff_werner);
            shaken.scene.md.cut = false;
            shaken.add_couples();
            md::Simulation sim = shaken.make();
            double expected = 0;
            for (int step = 0; step < 2000; ++step) {
                sim.run(1);
                const double floor = -1.2 + sim.time() * shaken.floor_velocity.y;
                expected += shaken.scene.md.dt *
                            loss(shaken.scene, sim.snapshot(), shaken.grains, floor, shaken.floor_velocity);
            }
            EXPECT_GT(expected, 1);
            EXPECT_NEAR(sim.dissipated(sim.observe()), expected, 0.01 * expected)
                << dimension << scene::normal_choices()[static_cast<std::size_t>(normal)];
        }
}

// What contacts hold comes back as motion, and what they took does not, at every moment.
TEST(SlowBalance, ContactsGiveBackNoMoreThanTheyHold) {
    for (const int dimension : {2, 3})
        for (const NormalLaw normal : normal_laws)
            for (const auto tangential : {TangentialLaw::none, TangentialLaw::haff_werner,
                                          TangentialLaw::cundall_strack, TangentialLaw::walton_braun}) {
                if (dimension == 3 && tangential == TangentialLaw::walton_braun) continue;
                Shaken shaken(dimension, normal, tangential);
                shaken.scene.md.lever_arm = scene::LeverArm::plane;
                const bool springs =
                    tangential == TangentialLaw::cundall_strack || tangential == TangentialLaw::walton_braun;
                if (tangential != TangentialLaw::none) shaken.add_couples(springs ? 100 : 0);
                md::Simulation sim = shaken.make();
                double most = 0, back = 0;
                for (int part = 0; part < 150; ++part) {
                    sim.run(20);
                    const double now = sim.dissipated(sim.observe());
                    most = std::max(most, now);
                    back = std::max(back, most - now);
                }
                EXPECT_GT(most, 1);
                EXPECT_LT(back, integrator)
                    << dimension << scene::normal_choices()[static_cast<std::size_t>(normal)]
                    << scene::tangential_choices()[static_cast<std::size_t>(tangential)];
            }
}

// ---- couples on walls

// A wall grain that turns beside a grain at rest: friction over its lever arm, and rolling friction at its
// limit.
TEST(WallLoads, ATurningWallGrainWithCouples) {
    scene::Scene s = empty_scene();
    s.md.tangential = TangentialLaw::haff_werner;
    s.md.lever_arm = scene::LeverArm::plane;
    scene::Material& m = s.materials[0];
    m.stiffness = 1e4;
    m.friction = 0.5;
    m.tangential_damping = 1e3;
    m.rolling_friction = 0.2;
    m.rolling_damping = 1;
    s.md.dt = 1e-9; // the rolling damper is stiff
    scene::Motion turn;
    turn.name = "turn";
    turn.kind = scene::MotionKind::rotate;
    turn.omega = 2;
    s.motions = {turn};
    const double radius = 0.01, wall = 0.1, overlap = 1e-4, d = wall + radius - overlap,
                 normal = 1e4 * overlap;
    s.walls = {scene::Wall()};
    s.walls[0].kind = scene::WallKind::grains;
    s.walls[0].radius = wall;
    s.walls[0].points = {{0, 0, 0}};
    s.walls[0].motion = "turn";
    md::Simulation sim = simulate(s, {grain(0, {0, d, 0}, {}, radius, 0.02)});
    const md::WallLoad load = sim.observe().walls.at(0);
    const double arm = (d * d + wall * wall - radius * radius) / (2 * d);
    const double torque = 0.5 * normal * arm + 0.2 * normal * wall * radius / (wall + radius);
    const double tolerance = 1e-10 * normal; // the overlap has lost four digits
    EXPECT_NEAR(load.force.x, 0.5 * normal, tolerance);
    EXPECT_NEAR(load.torque.z, -torque, tolerance);
    EXPECT_NEAR(load.power, 2 * torque, tolerance);
    EXPECT_NEAR(sim.contacts().at(0).tangential, -0.5 * normal, tolerance); // n points down, t to the right
    sim.run(1);
    EXPECT_NEAR(sim.wall_work(), 2 * torque * s.md.dt, 1e-4 * torque * s.md.dt); // the kernel's own sum
    // The same force moves the grain, by the kernels of a step, with couples and without. The wall turns to
    // the left, below it.
    for (const bool couples : {true, false}) {
        if (!couples) {
            s.md.lever_arm = scene::LeverArm::undeformed;
            s.materials[0].rolling_friction = s.materials[0].rolling_damping = 0;
        }
        md::Simulation dragged = simulate(s, {grain(0, {0, d, 0}, {}, radius, 0.02)});
        dragged.run(10);
        EXPECT_NEAR(dragged.snapshot().vx[0] * 0.02 / dragged.time(), -0.5 * normal, 1e-6 * normal);
    }
}
