// Integrator and time step from an error asked for: the error of a collision by itself, what a run of
// collisions makes of the choice, and that nothing cheaper was passed over.
#include "laws/restitution.hpp"
#include "md/accuracy.hpp"
#include "md/collision_error.hpp"
#include "support/says.hpp"

#include "md/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

using namespace sandlane;
using namespace sandlane::test;
using scene::Integrator;
using scene::NormalLaw;

namespace {

constexpr int dashpot = static_cast<int>(NormalLaw::linear_dashpot),
              hertz = static_cast<int>(NormalLaw::viscoelastic),
              hysteresis = static_cast<int>(NormalLaw::walton_braun);

md::Impact impact(int normal, double elastic, double dissipative, double speed = 1,
                  laws::PairCoefficients<double> others = {}) {
    others.elastic = elastic;
    others.dissipative = dissipative;
    return md::make_impact(normal, others, 0.5, 0.5, speed);
}

} // namespace

TEST(CollisionError, SolutionsAreThoseOfClosedForms) {
    for (const double z : {0.0, 0.04, 0.3, 1.5}) {
        const md::Impact k = impact(dashpot, 1e4, 2 * z * std::sqrt(1e4 * 0.5));
        EXPECT_NEAR(md::exact_restitution(dashpot, k), laws::linear_dashpot_restitution(z), 1e-10) << z;
    }
    laws::PairCoefficients<double> uncut{};
    uncut.least = -std::numeric_limits<double>::infinity();
    const md::Impact pulls = impact(dashpot, 1e4, 0.08 * std::sqrt(1e4 * 0.5), 1, uncut);
    EXPECT_NEAR(md::exact_restitution(dashpot, pulls),
                std::exp(-0.04 * std::numbers::pi / std::sqrt(1 - 0.04 * 0.04)), 1e-10);
    EXPECT_NEAR(md::exact_restitution(hysteresis, impact(hysteresis, 1e4, 1.5625e4)), 0.8, 1e-10);
    EXPECT_NEAR(md::exact_restitution(hertz, impact(hertz, 1e4, 0)), 1, 1e-10);
    // x = 0.1, of the table in normal_test.cpp
    const double a = 0.1 * std::pow(1e4 * std::sqrt(0.5) / 0.5, -0.4);
    EXPECT_NEAR(md::exact_restitution(hertz, impact(hertz, 1e4, a)), 0.89285888, 1e-8);
}

// Orders as in docs/accuracy.md: the first for a force that jumps at the touch, the second for a spring.
TEST(CollisionError, ConvergesWithTheOrderOfTheForce) {
    for (const int order : {3, 4, 5, 6})
        for (const double damping : {0.0, 5.656854}) {
            const md::Impact k = impact(dashpot, 1e4, damping);
            const double exact = md::exact_restitution(dashpot, k), time = k.time;
            const double ratio = md::collision_error(dashpot, order, k, exact, time / 100.37) /
                                 md::collision_error(dashpot, order, k, exact, time / 400.37);
            EXPECT_NEAR(std::log(ratio) / std::log(400.37 / 100.37), damping > 0 ? 1 : 2, 0.1) << order;
        }
}

TEST(CollisionError, GrainsThatStickHaveNoRestitution) {
    const int cohesive = static_cast<int>(NormalLaw::cohesive_viscoelastic);
    laws::PairCoefficients<double> sticky{};
    sticky.cohesion = 1e6;
    const md::Impact k = impact(cohesive, 1e6, 1e-3, 1e-6, sticky);
    EXPECT_EQ(md::exact_restitution(cohesive, k), 0);
    EXPECT_EQ(md::stepped_restitution(cohesive, 3, k, k.time / 50, 0), 0);
    EXPECT_EQ(md::collision_error(0, 0), 0);
}

namespace {

struct Asked {
    const char* name;
    NormalLaw normal;
    double dissipative; // gamma, A or Y_u
    bool cut;
    double accuracy;

    friend void PrintTo(const Asked& a, std::ostream* stream) { *stream << a.name << " " << a.accuracy; }
};

// Discs of mass and radius 1.
scene::Scene asked_scene(const Asked& a) {
    scene::Scene s = empty_scene();
    s.domain.upper = {10, 4.0 * (md::phases + 1), 0};
    s.domain.lower = {0, 0, 0};
    s.md.normal = a.normal;
    s.md.cut = a.cut;
    s.md.accuracy = a.accuracy;
    scene::Material& m = s.materials[0];
    m.stiffness = 1e4;
    m.young = 1.5e4;
    m.poisson = 0;
    (a.normal == NormalLaw::linear_dashpot ? m.damping
     : a.normal == NormalLaw::walton_braun ? m.unloading_stiffness
                                           : m.dissipation) = a.dissipative;
    return s;
}

// Pairs that meet with speed 1, each a little later within a step.
std::vector<scene::GrainState> meeting(double dt) {
    std::vector<scene::GrainState> grains;
    for (int n = 0; n < md::phases; ++n)
        for (const double side : {-1.0, 1.0}) {
            const double gap = (2 + (n + 0.5) / md::phases) * dt;
            grains.push_back(grain(static_cast<std::int64_t>(grains.size()),
                                   {5 + side * (1 + 0.5 * gap), 4.0 * (n + 1), 0}, {-0.5 * side, 0, 0}, 1,
                                   1));
        }
    return grains;
}

class AccuracyAsked : public testing::TestWithParam<Asked> {};

} // namespace

TEST_P(AccuracyAsked, IsMetByARunOfCollisions) {
    const scene::Scene s = asked_scene(GetParam());
    const md::AccuracyChoice choice = md::choose_by_accuracy(s, md::analyse(s, meeting(1e-3)));
    const double dt = choice.best.dt;
    md::Simulation sim = simulate(md::with_choice(s, choice), meeting(dt));
    ASSERT_EQ(sim.plan().dt, dt);
    sim.run(static_cast<std::int64_t>(2 * choice.contact_time / dt) + 40);
    ASSERT_TRUE(sim.contacts().empty());
    const auto coefficients = laws::coefficients_from<double>(md::pair_table(s).data());
    const double exact =
        md::exact_restitution(static_cast<int>(s.md.normal),
                              md::make_impact(static_cast<int>(s.md.normal), coefficients, 0.5, 0.5, 1));
    const analysis::Snapshot end = sim.snapshot();
    double sum = 0;
    for (std::size_t i = 0; i < end.size(); i += 2) {
        const double error = md::collision_error(end.vx[i + 1] - end.vx[i], exact);
        sum += error * error;
    }
    // The same numbers as those of the choice, to rounding: some 1e-12.
    EXPECT_LE(std::sqrt(sum / md::phases), s.md.accuracy + 1e-9);
    EXPECT_LE(choice.best.error, s.md.accuracy);
}

// For every integrator the longest step that meets the error, and so do all down to half of it, by a walk in
// small steps.
using AccuracyWalked = AccuracyAsked;
TEST_P(AccuracyWalked, CostsNoMoreThanTheCheapestThatMeetsIt) {
    const scene::Scene s = asked_scene(GetParam());
    const md::Needs needs = md::analyse(s, meeting(1e-3));
    const md::AccuracyChoice choice = md::choose_by_accuracy(s, needs);
    double fastest = std::numeric_limits<double>::infinity();
    for (const md::Candidate& c : choice.all) {
        scene::Scene with = s;
        with.md.integrator = c.integrator;
        with.md.contact_onset = c.onset;
        double good = 0;
        for (double dt = 0.25 * md::derive(with, needs).critical_dt; dt > 0.5 * good; dt *= 0.97)
            if (!(md::scene_error(s, needs, c.integrator, c.onset, dt, s.md.accuracy) <= s.md.accuracy))
                good = 0;
            else if (good == 0)
                good = dt;
        fastest = std::min(fastest, c.step_cost * choice.contact_time / good);
    }
    EXPECT_LE(choice.best.cost, 1.15 * fastest);
}

const auto coarse = testing::Values(Asked{"dashpot", NormalLaw::linear_dashpot, 5.66, true, 1e-2},
                                    Asked{"dashpot", NormalLaw::linear_dashpot, 5.66, true, 1e-3},
                                    Asked{"pulling dashpot", NormalLaw::linear_dashpot, 20, false, 1e-3},
                                    Asked{"elastic", NormalLaw::linear_dashpot, 0, true, 1e-4},
                                    Asked{"viscoelastic", NormalLaw::viscoelastic, 0.004, true, 1e-2},
                                    Asked{"viscoelastic", NormalLaw::viscoelastic, 0.004, true, 1e-4},
                                    Asked{"hysteresis", NormalLaw::walton_braun, 2e4, true, 1e-3});
// Walks through steps so short take seconds.
const auto fine = testing::Values(Asked{"dashpot", NormalLaw::linear_dashpot, 5.66, true, 3e-5},
                                  Asked{"viscoelastic", NormalLaw::viscoelastic, 0.02, true, 1e-5});
INSTANTIATE_TEST_SUITE_P(All, AccuracyAsked, coarse);
INSTANTIATE_TEST_SUITE_P(Fine, AccuracyAsked, fine);
INSTANTIATE_TEST_SUITE_P(All, AccuracyWalked, coarse);
INSTANTIATE_TEST_SUITE_P(Slow, AccuracyWalked, fine);

TEST(Accuracy, GivesTheStepThatTheWorstContactNeeds) {
    scene::Scene s = asked_scene({"", NormalLaw::linear_dashpot, 2, true, 1e-3});
    s.md.contact_onset = scene::ContactOnset::step; // first order: the error goes with the loss
    const std::vector<scene::GrainState> alike = meeting(1e-3);
    const double alone = md::choose_by_accuracy(s, md::analyse(s, alike)).best.dt;
    std::vector<scene::GrainState> lighter = alike;
    lighter[0].mass = 0.01;
    EXPECT_LT(md::choose_by_accuracy(s, md::analyse(s, lighter)).best.dt, 0.2 * alone);
    s.materials.push_back(s.materials[0]);
    s.materials[1].name = "lossy";
    s.materials[1].damping = 40;
    EXPECT_LT(md::choose_by_accuracy(s, md::analyse(s, alike)).best.dt, 0.2 * alone);
}

// What a scene says of the onset of contacts, and what it has, limit the choice.
TEST(Accuracy, TakesResolvedContactsWhereItMay) {
    using scene::ContactOnset;
    scene::Scene s = asked_scene({"", NormalLaw::linear_dashpot, 5.66, true, 1e-4});
    const auto best = [&] { return md::choose_by_accuracy(s, md::analyse(s, meeting(1e-3))).best; };
    const md::Candidate free = best();
    EXPECT_EQ(free.onset, ContactOnset::resolved);
    s.md.contact_onset = ContactOnset::step;
    EXPECT_EQ(best().onset, ContactOnset::step);
    EXPECT_GT(best().cost, 10 * free.cost); // first order against second
    s.md.contact_onset = ContactOnset::automatic;
    s.md.neighbours = scene::NeighbourMethod::link_cells; // has no such kernels
    EXPECT_EQ(best().onset, ContactOnset::step);
}

TEST(Accuracy, NeedsContactsAndStepsThatCanBeTaken) {
    scene::Scene s = asked_scene({"", NormalLaw::linear_dashpot, 5.66, true, 1e-8});
    s.md.contact_onset = scene::ContactOnset::step; // of first order
    const auto refusal = [](const scene::Scene& scene, const std::vector<scene::GrainState>& grains) {
        try {
            (void)md::choose_by_accuracy(scene, md::analyse(scene, grains));
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Exit::invalid_input);
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_SAYS(refusal(s, meeting(1e-3)), "no integrator meets it with up to 30000 steps");
    EXPECT_SAYS(refusal(s, {grain(0, {1, 1, 0}, {}, 1, 1)}), "there are no contacts with one grain");
    EXPECT_SAYS(refusal(s, {}), "there are no contacts with no grain");
}
