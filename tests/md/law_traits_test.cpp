// What normal laws mean beyond their formula: mixing rules, overrides, scales of a contact, and the time
// steps that follow (2.1-2.5, 9.2-9.4).
#include "md/law_choice.hpp"
#include "md/law_traits.hpp"

#include "md/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace sandlane;
using namespace sandlane::test;
using md::Coefficients;
using md::ContactScale;
using scene::NormalLaw;

namespace {

constexpr double uncut = -std::numeric_limits<double>::infinity();

Coefficients of(double elastic, double dissipative, double least = 0) {
    Coefficients c{elastic, dissipative, 0, 0};
    c.least = least;
    return c;
}

Coefficients entry(const scene::Scene& s, std::size_t a, std::size_t b) {
    const std::vector<double> table = md::pair_table(s);
    return laws::coefficients_from<double>(table.data() +
                                           (a * s.materials.size() + b) * laws::pair_coefficients);
}

scene::Scene two_materials() {
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::haff_werner;
    scene::Material& a = s.materials[0];
    a.stiffness = 1e5;
    a.unloading_stiffness = 2e5;
    a.damping = 1;
    a.young = 1e9;
    a.poisson = 0.3;
    a.dissipation = 1e-5;
    a.friction = 0.5;
    a.tangential_damping = 3;
    a.tangential_stiffness = 2e4;
    a.cohesion = 1e4;
    a.rolling_friction = 0.1;
    a.rolling_damping = 2e-5;
    a.rolling_stiffness = 0.3;
    s.materials.push_back(a);
    scene::Material& b = s.materials[1];
    b.name.push_back('2');
    b.stiffness = 3e5;
    b.unloading_stiffness = 3e5;
    b.damping = 3;
    b.young = 7e10;
    b.poisson = 0.2;
    b.dissipation = 3e-5;
    b.friction = 0.4;
    b.tangential_damping = 4;
    b.tangential_stiffness = 1e4;
    b.cohesion = 2e4;
    b.rolling_friction = 0.05;
    b.rolling_damping = 3e-5;
    b.rolling_stiffness = 0.2;
    return s;
}

} // namespace

TEST(Mixing, OfUnlikeMaterials) { // 2.5
    scene::Scene s = two_materials();
    Coefficients c = entry(s, 0, 1);
    EXPECT_NEAR(c.elastic, 1.5e5, 1e-9); // 2 k k'/(k + k')
    EXPECT_EQ(c.dissipative, 2);
    EXPECT_EQ(c.friction, 0.4);
    EXPECT_EQ(c.tangential_damping, 3);
    EXPECT_EQ(c.tangential_stiffness, 1e4);
    EXPECT_EQ(c.cohesion, 1e4);
    EXPECT_EQ(c.rolling_friction, 0.05);
    EXPECT_EQ(c.rolling_damping, 2e-5);
    EXPECT_EQ(c.rolling_stiffness, 0.2);
    EXPECT_EQ(c.least, 0);
    EXPECT_EQ(c.lever, 0);
    s.md.normal = NormalLaw::walton_braun;
    c = entry(s, 1, 0);
    EXPECT_NEAR(c.elastic, 1.5e5, 1e-9);
    EXPECT_NEAR(c.dissipative, 2.4e5, 1e-9);
    s.md.normal = NormalLaw::viscoelastic;
    s.md.cut = false;
    s.md.lever_arm = scene::LeverArm::plane;
    c = entry(s, 0, 1);
    // T3: K = 1.1785701756e8 of radii 0.01 and 0.02.
    EXPECT_NEAR(c.elastic * std::sqrt(0.02 / 3), 1.1785701756e8, 1e-2);
    EXPECT_NEAR(c.dissipative, 2e-5, 1e-20);
    EXPECT_EQ(c.least, uncut);
    EXPECT_EQ(c.lever, 1);
}

TEST(Mixing, PairsOverride) {
    scene::Scene s = two_materials();
    scene::MaterialPair pair;
    pair.first = s.materials[1].name;
    pair.second = s.materials[0].name;
    pair.stiffness = 7;
    pair.cohesion = 8;
    pair.rolling_friction = 0;
    s.pairs = {pair};
    for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 0}}) {
        const Coefficients c = entry(s, a, b);
        EXPECT_EQ(c.elastic, 7);
        EXPECT_EQ(c.dissipative, 2);
        EXPECT_EQ(c.cohesion, 8);
        EXPECT_EQ(c.rolling_friction, 0);
        EXPECT_EQ(c.rolling_damping, 2e-5);
    }
    EXPECT_EQ(entry(s, 0, 0).cohesion, 1e4);
}

// A pair with the Young modulus of two equal materials, whose Poisson ratio is zero, is those materials.
TEST(Mixing, YoungModulusOfAPair) {
    scene::Scene s = two_materials();
    s.md.normal = NormalLaw::viscoelastic;
    s.materials[1] = s.materials[0];
    s.materials[1].name.push_back('2');
    for (scene::Material& m : s.materials) m.poisson = 0;
    const double alike = entry(s, 0, 1).elastic;
    scene::MaterialPair pair;
    pair.first = s.materials[0].name;
    pair.second = s.materials[1].name;
    pair.young = s.materials[0].young;
    s.pairs = {pair};
    EXPECT_NEAR(entry(s, 0, 1).elastic, alike, 1e-15 * alike);
}

// T2 and T3 of 9.3, T1 of 9.2, T5 of 9.4: all digits that are given.
TEST(Scale, OfReferenceCollisions) {
    using Hertz = md::LawTraits<laws::Viscoelastic>;
    const ContactScale equal =
        Hertz::scale(of(5.1802694592e7 / std::sqrt(0.005), 0), 0.5 * 1.0471975512e-2, 0.005, 1);
    EXPECT_NEAR(equal.overlap, 1.0980510051e-4, 1e-13);
    EXPECT_NEAR(equal.collision_time, 3.2318662744e-4, 1e-13);
    const ContactScale unequal =
        Hertz::scale(of(1.1785701756e8 / std::sqrt(0.02 / 3), 0), 9.3084226773e-3, 0.02 / 3, 1);
    EXPECT_NEAR(unequal.overlap, 9.9488358355e-5, 1e-13);
    EXPECT_NEAR(unequal.collision_time, 2.9282161628e-4, 1e-13);
    const ContactScale t1 = md::LawTraits<laws::LinearDashpot>::scale(of(1e5, 1), 5e-4, 1, 1);
    EXPECT_NEAR(t1.damping_ratio, 0.0707106781, 1e-10);
    EXPECT_NEAR(t1.restitution, 0.8084243834, 1e-10);
    const ContactScale t5 = md::LawTraits<laws::WaltonBraun>::scale(of(1e5, 1.5625e5), 5e-4, 1, 1);
    EXPECT_NEAR(t5.restitution, 0.8, 1e-15);
    EXPECT_NEAR(t5.collision_time, 1.9992973222e-4, 1e-14);
    EXPECT_NEAR(t5.overlap, 7.0710678119e-5, 1e-15);
    EXPECT_NEAR(t5.half_swing, std::numbers::pi / std::sqrt(1.5625e5 / 5e-4), 1e-15);
}

// Restitution without the cut, by a thousand steps of second order: 1e-6 and the coefficients' size.
TEST(Scale, RestitutionWithoutTheCut) {
    for (const auto& [z, restitution] : {std::pair{0.05, 0.85446789}, {0.3, 0.37232610}, {0.9, 0.00152376}})
        EXPECT_NEAR(md::LawTraits<laws::LinearDashpot>::scale(of(1, 2 * z, uncut), 1, 1, 1).restitution,
                    restitution, 2e-5);
    EXPECT_EQ(md::LawTraits<laws::LinearDashpot>::scale(of(1, 3, uncut), 1, 1, 1).restitution, 0);
    for (const auto& [x, restitution] : {std::pair{0.05, 0.94425997}, {0.3, 0.71404488}, {1.0, 0.33116481}})
        EXPECT_NEAR(md::LawTraits<laws::Viscoelastic>::scale(of(1, x, uncut), 1, 1, 1).restitution,
                    restitution, 2e-5);
}

// The deepest overlap with cohesion: m g^2/2 = (2/5) K xi^{5/2} - 2 pi c R_eff xi^2; the contact is stiffer
// there.
TEST(Scale, CohesionDrawsDeeper) {
    using Cohesive = md::LawTraits<laws::CohesiveViscoelastic>;
    Coefficients c = of(3e6, 0);
    const double mass = 1e-2, radius = 5e-3, k = c.elastic * std::sqrt(radius);
    const ContactScale without = Cohesive::scale(c, mass, radius, 0.1);
    c.cohesion = 1e5;
    const ContactScale with = Cohesive::scale(c, mass, radius, 0.1);
    const double xi = with.overlap, energy = 0.5 * mass * 0.01;
    EXPECT_GT(xi, 2 * without.overlap);
    EXPECT_NEAR(0.4 * k * std::pow(xi, 2.5) - 2 * std::numbers::pi * c.cohesion * radius * xi * xi, energy,
                1e-6 * energy);
    EXPECT_NEAR(with.frequency, std::sqrt(1.5 * k * std::sqrt(xi) / mass), 1e-9 * with.frequency);
    EXPECT_NEAR(with.restitution, 1, 1e-4);
    EXPECT_NEAR(without.overlap, std::pow(5 * mass * 0.01 / (4 * k), 0.4), 1e-12 * without.overlap);
}

// dt <= pi/(50 w_u) of two of the lightest grains (2.4), though the collision itself lasts longer.
// Slopes of the force that a law really gives, by differences over 1e-6 of the overlap; the pull of cohesion
// only makes them smaller. Walton and Braun's law unloads from the overlap.
TEST(Scale, SlopesOfTheForce) {
    scene::Scene s = two_materials();
    for (int normal = 0; normal < laws::normal_laws; ++normal) {
        s.md.normal = static_cast<NormalLaw>(normal);
        const Coefficients c = entry(s, 0, 1);
        md::with_normal_law(normal, [&]<class Law>(md::Type<Law>) {
            const double radius = 0.005, overlap = 1e-5, h = 1e-6 * overlap, v = 1e-6;
            double memory[2] = {};
            const auto force = [&](double xi, double rate) {
                return laws::normal_force<Law>(xi, rate, c, radius, memory).force;
            };
            const double at = force(overlap, 0), slope = (at - force(overlap - h, 0)) / h;
            const double stiffness = md::LawTraits<Law>::stiffness(c, radius, overlap);
            const double damping = md::LawTraits<Law>::damping(c, radius, overlap);
            if (s.md.normal == NormalLaw::cohesive_viscoelastic)
                EXPECT_LT(slope, stiffness);
            else
                EXPECT_NEAR(slope, stiffness, 1e-5 * stiffness) << normal;
            EXPECT_NEAR((force(overlap, v) - force(overlap, 0)) / v, damping, 1e-5 * damping + 1e-6)
                << normal;
        });
    }
}

TEST(TimeStep, ResolvesUnloading) {
    scene::Scene s = empty_scene();
    s.md.normal = NormalLaw::walton_braun;
    s.materials[0].stiffness = 1e4;
    s.materials[0].unloading_stiffness = 1e6;
    const auto grains = {grain(0, {}, {}, 0.01, 1e-3)};
    const md::Derived d = md::derive(s, md::analyse(s, grains));
    EXPECT_NEAR(d.recommended_dt, std::numbers::pi / 50 / std::sqrt(1e6 / 5e-4), 1e-15);
    EXPECT_NEAR(d.collision_time, 0.5 * std::numbers::pi * (1 / std::sqrt(2e7) + 1 / std::sqrt(2e9)), 1e-15);
}

// Largest stable omega_0 dt of each scheme at the damping ratio 1 (docs/physics.md 8).
TEST(TimeStep, IsBoundedByTheSchemeAndTheDamping) {
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::none;
    const double mass = 1e-3, frequency = std::sqrt(1e6 / (0.5 * mass)); // of two equal grains
    s.materials[0].stiffness = 1e6;
    s.materials[0].damping = 2 * frequency * (0.5 * mass);
    const auto grains = {grain(0, {}, {}, 0.01, mass)};
    using scene::Integrator;
    for (const auto& [integrator, phase] :
         {std::pair{Integrator::velocity_verlet, 0.47}, std::pair{Integrator::gear4, 0.26},
          std::pair{Integrator::gear5, 0.148}, std::pair{Integrator::gear6, 0.081}}) {
        s.md.integrator = integrator;
        const md::Derived d = md::derive(s, md::analyse(s, grains));
        EXPECT_NEAR(d.critical_dt * frequency, phase, 1e-12);
    }
}

// dt gamma_r/J_eff < 0.15 for the rolling of two of the lightest grains, J_eff = J/2.
TEST(TimeStep, ResolvesRollingFriction) {
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::haff_werner;
    s.md.inertia = scene::Inertia::sphere;
    s.materials[0].stiffness = 1e4;
    s.materials[0].rolling_friction = 0.1;
    s.materials[0].rolling_damping = 1;
    const auto grains = {grain(0, {}, {}, 0.01, 1e-3)};
    const md::Derived d = md::derive(s, md::analyse(s, grains));
    const double inertia = 0.5 * 0.4 * 1e-3 * 1e-4;
    EXPECT_NEAR(d.critical_dt, 0.30 * inertia, 1e-15 * inertia); // Gear, 5 values
    EXPECT_NEAR(d.recommended_dt, 0.25 * 0.30 * inertia, 1e-15 * inertia);
}

// A fiftieth of pi sqrt(J_eff/k_r).
TEST(TimeStep, ResolvesSpringsAgainstRolling) {
    scene::Scene s = empty_scene();
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    s.md.inertia = scene::Inertia::sphere;
    s.materials[0].stiffness = 1;
    s.materials[0].rolling_friction = 0.1;
    s.materials[0].rolling_stiffness = 1;
    const auto grains = {grain(0, {}, {}, 0.01, 1e-3)};
    const md::Derived d = md::derive(s, md::analyse(s, grains));
    EXPECT_NEAR(d.recommended_dt, std::numbers::pi / 50 * std::sqrt(0.5 * 0.4 * 1e-3 * 1e-4), 1e-15);
}

// Walton and Braun's rule of a spring applies to the tangential one as well: k_0 is its stiffness at F = 0.
TEST(TimeStep, ResolvesTangentialSprings) {
    for (const auto law : {scene::TangentialLaw::cundall_strack, scene::TangentialLaw::walton_braun}) {
        scene::Scene s = empty_scene();
        s.md.tangential = law;
        s.md.inertia = scene::Inertia::disc;
        s.materials[0].stiffness = 1;
        s.materials[0].friction = 0.5;
        s.materials[0].tangential_stiffness = 1e4;
        const auto grains = {grain(0, {}, {}, 0.01, 1e-3)};
        const md::Derived d = md::derive(s, md::analyse(s, grains));
        EXPECT_NEAR(d.recommended_dt, std::numbers::pi / 50 / std::sqrt(1e4 / (1e-3 / 6)),
                    1e-15); // m_t = m/6
    }
}
