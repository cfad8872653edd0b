// Contacts that begin and end inside a step in whole simulations (docs/physics.md 7): collisions of grains
// and with walls, friction and springs, a dense bed at long steps.
#include "core/error.hpp"
#include "md/support.hpp"
#include "support/lattice_system.hpp"
#include "support/says.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace sandlane;
using namespace sandlane::test;
using scene::NormalLaw;
using scene::TangentialLaw;

namespace {

constexpr int phases = 16;
constexpr double damping_ratio = 0.0424; // e = 0.88, with the cut
const double contact_time = 2 * std::acos(damping_ratio) / std::sqrt(1 - damping_ratio * damping_ratio);
const double restitution = std::exp(-damping_ratio * contact_time);

// Contacts of unit mass and stiffness.
scene::Scene resolved_scene(double steps, int dimension = 2) {
    scene::Scene s = empty_scene();
    s.domain.dimension = dimension;
    s.domain.lower = {0, -100, -100};
    s.domain.upper = {1000, 1000, 100};
    s.md.integrator = scene::Integrator::velocity_verlet;
    s.md.contact_onset = scene::ContactOnset::resolved;
    s.md.dt = contact_time / steps;
    s.materials[0].stiffness = 1;
    s.materials[0].damping = 2 * damping_ratio;
    return s;
}

// Root mean square over the grains that hit the floor, of what `of` says about one of them.
template <class Value> double rms(const analysis::Snapshot& now, const Value& of) {
    double square = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
        square += std::pow(of(i), 2) / static_cast<double>(now.size());
    return std::sqrt(square);
}

// Grains that meet a floor, each a little later within a step; the floor may come towards them.
std::vector<scene::GrainState> falling(const scene::Scene& s, double speed, double sideways = 0) {
    std::vector<scene::GrainState> grains;
    for (int n = 0; n < phases; ++n)
        grains.push_back(grain(n, {30.0 * (n + 1), 10 + (2 + (n + 0.5) / phases) * s.md.dt, 0},
                               {sideways, -speed, 0}, 10, 1));
    return grains;
}

double error_on_a_floor(double steps, int dimension, double floor_speed) {
    scene::Scene s = resolved_scene(steps, dimension);
    s.walls = {floor_plane()};
    if (floor_speed > 0) {
        s.walls[0].motion = "up";
        s.motions.resize(1);
        s.motions[0].name = "up";
        s.motions[0].kind = scene::MotionKind::linear;
        s.motions[0].velocity = {0, floor_speed, 0};
    }
    md::Simulation sim = simulate(s, falling(s, 1 - floor_speed));
    sim.run(static_cast<std::int64_t>(1.3 * steps) + 8);
    const analysis::Snapshot now = sim.snapshot();
    return rms(now, [&](std::size_t i) { return now.vy[i] - floor_speed - restitution; });
}

} // namespace

// Measured: 7e-4 and 1.6e-5, a quarter more; a step scheme has 9e-3 and 1.4e-3.
TEST(ResolvedOnset, RestitutionOnFloorsAtRestAndMoving) {
    for (const int dimension : {2, 3})
        for (const double floor_speed : {0.0, 0.6}) {
            EXPECT_LT(error_on_a_floor(10.37, dimension, floor_speed), 9e-4);
            EXPECT_LT(error_on_a_floor(50.37, dimension, floor_speed), 2e-5);
        }
}

TEST(ResolvedOnset, RestitutionOfPairs) {
    for (const int dimension : {2, 3})
        for (const double steps : {10.37, 50.37}) {
            scene::Scene s = resolved_scene(steps, dimension);
            std::vector<scene::GrainState> grains;
            for (int n = 0; n < phases; ++n)
                for (const double side : {-1.0, 1.0})
                    grains.push_back(
                        grain(static_cast<std::int64_t>(grains.size()),
                              {500 + side * (10 + 0.5 * (2 + (n + 0.5) / phases) * s.md.dt), 30.0 * n, 0},
                              {-0.5 * side, 0, 0}, 10, 2));
            md::Simulation sim = simulate(s, grains);
            sim.run(static_cast<std::int64_t>(1.3 * steps) + 8);
            const analysis::Snapshot now = sim.snapshot();
            const double error = rms(now, [&](std::size_t i) {
                return now.vx[i | 1] - now.vx[i & ~std::size_t{1}] - restitution;
            });
            EXPECT_LT(error, steps < 20 ? 9e-4 : 2e-5);
        }
}

// While it slides, friction takes mu times the momentum that the floor gives, to rounding; a spring, which
// counts as one that grows in the step of the touch, a little less there.
TEST(ResolvedOnset, SlidingFrictionGoesWithTheNormalImpulse) {
    for (const auto tangential : {TangentialLaw::haff_werner, TangentialLaw::cundall_strack}) {
        scene::Scene s = resolved_scene(9.37);
        s.walls = {floor_plane()};
        s.md.tangential = tangential;
        s.materials[0].friction = 0.1;
        s.materials[0].tangential_damping = tangential == TangentialLaw::haff_werner ? 0.2 : 0;
        s.materials[0].tangential_stiffness = 0.8;
        const double fast = 2;
        md::Simulation sim = simulate(s, falling(s, 1, fast));
        sim.run(30);
        const analysis::Snapshot now = sim.snapshot();
        const bool spring = tangential == TangentialLaw::cundall_strack;
        for (std::size_t i = 0; i < now.size(); ++i)
            EXPECT_NEAR(fast - now.vx[i], 0.1 * (now.vy[i] + 1), spring ? 2e-3 : 1e-12);
    }
}

// A spring that sticks is a sum of steps, of first order (section 4), whose error remains.
TEST(ResolvedOnset, SpringsThatStick) {
    const auto end = [](double steps) {
        scene::Scene s = resolved_scene(steps);
        s.walls = {floor_plane()};
        s.md.tangential = TangentialLaw::cundall_strack;
        s.materials[0].friction = 10;
        s.materials[0].tangential_stiffness = 0.2;
        std::vector<scene::GrainState> grains = falling(s, 1, 0.3);
        md::Simulation sim = simulate(s, grains);
        sim.run(static_cast<std::int64_t>(1.3 * steps) + 8);
        const analysis::Snapshot now = sim.snapshot();
        return std::vector<double>(now.vx.begin(), now.vx.end());
    };
    const double right = end(3000.37)[0];
    const auto error = [&](double steps) {
        double worst = 0;
        for (const double vx : end(steps)) worst = std::max(worst, std::abs(vx - right));
        return worst;
    };
    const double coarse = error(20.37), fine = error(80.37);
    EXPECT_LT(coarse, 1.3e-2);
    EXPECT_LT(fine, coarse / 3.5);
}

namespace {

scene::Scene dense_scene(double steps) {
    scene::Scene s = lattice_scene(12, 12);
    s.md.integrator = scene::Integrator::velocity_verlet;
    s.md.contact_onset = scene::ContactOnset::resolved;
    s.materials[0].damping = 2; // z = 0.045 of two grains of unit mass
    s.md.dt = std::numbers::pi / std::sqrt(1000 / 0.5) / steps;
    return s;
}

} // namespace

// A bed at t_c/10 goes on losing its energy.
TEST(ResolvedOnset, ABedSettles) {
    for (const bool cut : {true, false}) {
        scene::Scene s = dense_scene(10.37);
        s.domain.periodic = {true, false};
        s.domain.lower.y = -2;
        s.domain.upper.y = 60;
        s.domain.gravity = {0, -2, 0};
        s.md.cut = cut;
        s.md.tangential = TangentialLaw::cundall_strack;
        s.materials[0].tangential_stiffness = 300;
        s.materials[0].tangential_damping = 2;
        s.walls = {floor_plane()};
        s.walls[0].points = {{0, -1.2, 0}};
        md::Simulation sim = simulate(s, lattice_grains(12, 12));
        const auto kinetic = [&] {
            const analysis::Snapshot now = sim.snapshot();
            double sum = 0;
            for (std::size_t i = 0; i < now.size(); ++i)
                sum += 0.5 * now.mass[i] * (now.vx[i] * now.vx[i] + now.vy[i] * now.vy[i]);
            return sum;
        };
        sim.run(4000);
        const double early = kinetic();
        sim.run(4000);
        EXPECT_LT(kinetic(), 0.2 * early);
    }
}

TEST(ResolvedOnset, RefusesWhatHasNoKernels) {
    const auto refused = [](const auto& change, const char* words) {
        scene::Scene s = resolved_scene(20);
        change(s);
        try {
            (void)simulate(s, {grain(0, {5, 0, 0}, {}, 1, 1)});
            ADD_FAILURE() << words;
        } catch (const Error& e) {
            EXPECT_SAYS(std::string(e.what()), words);
        }
    };
    refused(
        [](scene::Scene& s) {
            s.md.normal = NormalLaw::walton_braun;
            s.materials[0].unloading_stiffness = 2 * s.materials[0].stiffness;
        },
        "linear-dashpot, viscoelastic");
    refused([](scene::Scene& s) { s.md.neighbours = scene::NeighbourMethod::lattice; }, "verlet");
    refused(
        [](scene::Scene& s) {
            s.md.tangential = TangentialLaw::haff_werner;
            s.materials[0].friction = s.materials[0].rolling_friction = 0.3;
            s.materials[0].tangential_damping = s.materials[0].rolling_damping = 0.1;
        },
        "rolling");
}
