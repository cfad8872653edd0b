// Molecular dynamics in space: forces against a second transcription of the specification, the plane inside
// space, invariants, and the same bits for every kernel, method and thread count.
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

using namespace sandlane;
using scene::NeighbourMethod;

namespace {

using Real = long double;
using Real3 = std::array<Real, 3>;

Real3 operator+(Real3 a, Real3 b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Real3 operator-(Real3 a, Real3 b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Real3 operator*(Real s, Real3 a) {
    return {s * a[0], s * a[1], s * a[2]};
}
Real dot(Real3 a, Real3 b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Real3 cross(Real3 a, Real3 b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real3 real(Vec v) {
    return {v.x, v.y, v.z};
}

// 1.5-1.7, (2.8), (2.14) and 3.1 in three dimensions, all pairs; force and torque/R of every grain.
struct Oracle {
    std::vector<Real3> force, turning;

    Oracle(const scene::Scene& s, const std::vector<scene::GrainState>& grains)
        : force(grains.size()), turning(grains.size()) {
        const scene::Material& m = s.materials[0];
        const Real length = s.domain.upper.x;
        const bool hertz = s.md.normal == scene::NormalLaw::viscoelastic;
        for (std::size_t i = 0; i < grains.size(); ++i)
            for (std::size_t j = i + 1; j < grains.size(); ++j) {
                const auto &a = grains[i], &b = grains[j];
                Real3 d = real(b.position) - real(a.position);
                for (Real& x : d) x -= length * std::nearbyint(x / length);
                const Real distance = std::sqrt(dot(d, d)), ri = a.radius, rj = b.radius,
                           xi = ri + rj - distance;
                if (xi <= 0) continue;
                const Real3 n = (1 / distance) * d, dv = real(a.velocity) - real(b.velocity);
                const Real rate = dot(dv, n), reduced = ri * rj / (ri + rj);
                const Real k =
                    (4.0L / 3) * m.young / (2 * (1 - Real{m.poisson} * m.poisson)) * std::sqrt(reduced);
                const Real push = hertz ? k * (std::pow(xi, 1.5L) + m.dissipation * std::sqrt(xi) * rate)
                                        : m.stiffness * xi + m.damping * rate;
                const Real fn = std::max(push, Real{0});
                const Real3 u = dv + cross(ri * real(a.angular_velocity) + rj * real(b.angular_velocity), n);
                const Real3 ut = u - dot(n, u) * n;
                const Real speed = std::sqrt(dot(ut, ut));
                const Real3 ft = -std::min(Real{m.tangential_damping}, m.friction * fn / speed) * ut;
                force[i] = force[i] - fn * n + ft;
                force[j] = force[j] + fn * n - ft;
                turning[i] = turning[i] + cross(n, ft);
                turning[j] = turning[j] + cross(n, ft);
            }
    }
};

constexpr const char* method_names[] = {"auto", "brute", "cells", "lattice", "lattice_half", "verlet"};
constexpr NeighbourMethod methods[] = {NeighbourMethod::brute_force, NeighbourMethod::link_cells,
                                       NeighbourMethod::verlet};

} // namespace

TEST(Space, ForcesMatchOracle) {
    scene::Scene s = test::space_scene(6);
    const auto grains = test::space_grains(6);
    for (const auto normal : {scene::NormalLaw::linear_dashpot, scene::NormalLaw::viscoelastic}) {
        s.md.normal = normal;
        const Oracle expected(s, grains);
        const md::Simulation sim = test::make_simulation(s, grains, simd::Isa::scalar);
        for (const simd::Isa isa : simd::available_isas())
            for (const auto method : methods) {
                const auto f = sim.forces(isa, method);
                ASSERT_EQ(f.size(), 8 * grains.size());
                Real largest = 0, error = 0;
                for (std::size_t n = 0; n < grains.size(); ++n) {
                    const auto id = static_cast<std::size_t>(sim.state().id[n]);
                    const double* row = f.data() + 8 * n;
                    for (std::size_t k = 0; k < 3; ++k) {
                        error = std::max(error, std::abs(row[k] - expected.force[id][k]));
                        error = std::max(error, std::abs(row[4 + k] - expected.turning[id][k]));
                        largest = std::max(largest, std::abs(expected.force[id][k]));
                    }
                }
                // Overlaps carry the rounding of distances, 2 eps 4 m, times up to 1e3 N/m and a few
                // contacts.
                EXPECT_LT(error, 1e-11) << simd::isa_name(isa) << method_names[static_cast<int>(method)];
                EXPECT_GT(largest, 10);
            }
    }
}

// Grains whose centres, velocities and forces lie in a plane do there what they do in two dimensions.
TEST(Space, ThePlaneInsideSpace) {
    for (const auto tangential : {scene::TangentialLaw::none, scene::TangentialLaw::haff_werner,
                                  scene::TangentialLaw::cundall_strack}) {
        scene::Scene plane = test::lattice_scene();
        plane.materials[0].tangential_stiffness = 200;
        plane.md.tangential = tangential;
        plane.md.inertia = scene::Inertia::sphere;
        plane.md.neighbours = NeighbourMethod::verlet;
        scene::Scene space = plane;
        space.domain.dimension = 3;
        space.domain.lower.z = -10;
        space.domain.upper.z = 10;
        auto grains = test::lattice_grains();
        for (auto& g : grains) {
            if (tangential == scene::TangentialLaw::none) g.omega = 0;
            g.angular_velocity = {0, 0, g.omega};
        }
        const simd::Isa isa = simd::available_isas().back();
        md::Simulation flat = test::make_simulation(plane, grains, isa);
        md::Simulation deep = test::make_simulation(space, grains, isa);
        flat.run(300);
        deep.run(300);
        const analysis::Snapshot a = flat.snapshot(), b = deep.snapshot();
        EXPECT_GT(flat.observe().contacts, 20);
        // 300 steps of 1e-3 s: rounding of 1e-16 grows by less than 1e4 in the time of one collision or two.
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_NEAR(a.x[i], b.x[i], 1e-12);
            EXPECT_NEAR(a.vy[i], b.vy[i], 1e-12);
            EXPECT_NEAR(a.omega[i], b.omega[i], 1e-12);
            EXPECT_EQ(b.z[i], 0);
            EXPECT_EQ(b.omega_x[i], 0);
        }
    }
}

// 9.1: momentum stays, and without loss energy too: K5 asserts 1e-3 at t_c/50 for linear springs.
TEST(Space, ConservesMomentumAndElasticEnergy) {
    scene::Scene s = test::space_scene(6);
    s.materials[0].damping = 0;
    s.md.tangential = scene::TangentialLaw::none;
    s.md.dt = 3.14159 * std::sqrt(0.5 * 0.97 * 0.97 * 0.97 / 1000) / 50;
    md::Simulation sim = test::make_simulation(s, test::space_grains(6), simd::available_isas().back());
    const md::Observables start = sim.observe();
    sim.run(2000);
    const md::Observables now = sim.observe();
    EXPECT_LT(norm(now.momentum - start.momentum), 1e-12 * 216);
    EXPECT_NEAR(now.energy(), start.energy(), 1e-3 * start.energy());
    EXPECT_GT(std::abs(now.kinetic - start.kinetic), 1e-2 * start.kinetic); // it went to and fro
}

// With `undeformed` lever arms the angular momentum of a pair changes by the torque xi n x f_t and nothing
// else: without friction's force it stays, here for an oblique, spinning, frictional pair it is what 1.8
// says.
TEST(Space, AngularMomentumOfAPairChangesByTheOverlapAlone) {
    scene::Scene s = test::space_scene(4);
    s.domain.periodic = {};
    s.md.dt = 1e-5;
    std::vector<scene::GrainState> grains = {test::space_grains(2)[0], test::space_grains(2)[1]};
    grains[0].position = {2, 2, 2};
    grains[1].position = {3.2, 3.1, 2.9};
    grains[0].velocity = {0.5, 0.2, 0.1};
    grains[1].velocity = {-0.4, 0.1, -0.3};
    md::Simulation sim = test::make_simulation(s, grains, simd::available_isas().back());
    const auto momentum = [&] {
        const analysis::Snapshot n = sim.snapshot();
        Vec total;
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec r{n.x[i], n.y[i], n.z[i]}, v{n.vx[i], n.vy[i], n.vz[i]};
            const Vec omega{n.omega_x[i], n.omega_y[i], n.omega[i]};
            total = total + n.mass[i] * cross(r, v) + 0.4 * n.mass[i] * n.radius[i] * n.radius[i] * omega;
        }
        return total;
    };
    Vec expected = momentum();
    int touching = 0;
    for (int step = 0; step < 20000; ++step) {
        const analysis::Contacts contacts = sim.contacts();
        for (const analysis::Contact& c : contacts)
            expected = expected + s.md.dt * c.overlap * cross(c.normal, c.force);
        touching += static_cast<int>(contacts.size());
        sim.run(1);
    }
    EXPECT_GT(touching, 1000);
    // The sum is of first order in dt: 1e-5 of the torque's integral.
    EXPECT_LT(norm(momentum() - expected), 1e-4 * norm(expected));
    EXPECT_TRUE(sim.contacts().empty());
}

// 3.2: the spring of a touching pair that turns like one body turns along.
TEST(Space, SpringOfARigidlyTurningPairKeepsItsLength) {
    const double dt = 1e-4, half = 0.95;
    const Vec omega{0.3, -0.5, 0.8};
    laws::PairCoefficients<double> c{1000, 0, 0, 10, 200};
    double zeta[4] = {0.003, 0.001, -0.002, 0};
    const Vec start{1, 0, 0};
    {
        const double along = zeta[0] * start.x;
        zeta[0] -= along; // in the tangential plane
    }
    const Vec first{zeta[0], zeta[1], zeta[2]};
    Quaternion turned;
    for (int step = 0; step < 10000; ++step) {
        turned = rotation_by(dt * omega) * turned;
        const Vec n = rotate(turned, start), d = 2 * half * n, dv = cross(omega, d);
        const Vec spin = 2 * half * omega, turn = 2 * omega; // lever arms up to the contact: no slip
        const laws::SpatialState<double> state{{d.x, d.y, d.z},
                                               {dv.x, dv.y, dv.z},
                                               {spin.x, spin.y, spin.z},
                                               {turn.x, turn.y, turn.z},
                                               2.0,
                                               2.0};
        (void)laws::pair_force<laws::LinearDashpot, laws::CundallStrack>(state, c, zeta, dt);
    }
    const Vec expected = rotate(turned, first), now{zeta[0], zeta[1], zeta[2]};
    EXPECT_NEAR(norm(now), norm(first), 1e-10 * norm(first));
    EXPECT_LT(norm(now - expected), 1e-3 * norm(first)); // O(dt) per radian: |omega| dt = 1e-4
}

namespace {

struct Variant {
    NeighbourMethod method;
    scene::NormalLaw normal;
    scene::TangentialLaw tangential;
    bool two_materials;
};

std::vector<Variant> all_variants() {
    std::vector<Variant> variants;
    for (const bool two : {false, true})
        for (const auto normal : {scene::NormalLaw::linear_dashpot, scene::NormalLaw::viscoelastic})
            for (const auto tangential : {scene::TangentialLaw::none, scene::TangentialLaw::haff_werner})
                for (const auto method : methods) variants.push_back({method, normal, tangential, two});
    for (const bool two : {false, true})
        variants.push_back({NeighbourMethod::verlet, scene::NormalLaw::viscoelastic,
                            scene::TangentialLaw::cundall_strack, two});
    return variants;
}

std::string variant_name(const testing::TestParamInfo<Variant>& info) {
    const Variant& v = info.param;
    return std::string(method_names[static_cast<int>(v.method)]) +
           (v.normal == scene::NormalLaw::viscoelastic ? "_hertz" : "_linear") +
           (v.tangential == scene::TangentialLaw::none          ? ""
            : v.tangential == scene::TangentialLaw::haff_werner ? "_friction"
                                                                : "_springs") +
           (v.two_materials ? "_two" : "");
}

class SpaceDeterminism : public testing::TestWithParam<Variant> {};

} // namespace

TEST_P(SpaceDeterminism, SameBitsForEveryIsaAndThreadCount) {
    const Variant& v = GetParam();
    // Lists: 1331, more than a tile. The others take longer, and a few cells in a row will do.
    const int side = v.method == NeighbourMethod::verlet       ? 11
                     : v.method == NeighbourMethod::link_cells ? 7
                                                               : 5;
    scene::Scene s = test::space_scene(side);
    auto grains = test::space_grains(side);
    s.md.normal = v.normal;
    s.md.tangential = v.tangential;
    s.md.neighbours = v.method;
    if (v.tangential == scene::TangentialLaw::none)
        for (auto& g : grains) g.angular_velocity = {};
    if (v.two_materials) {
        s.materials.push_back(s.materials[0]);
        s.materials[1].name = "other";
        s.materials[1].stiffness = 800;
        for (std::size_t i = 0; i < grains.size(); i += 3) grains[i].material = 1;
    }
    std::string reference;
    for (const simd::Isa isa : simd::available_isas())
        for (const int threads : {1, 3}) {
            md::Simulation sim = test::make_simulation(s, grains, isa, threads);
            sim.run(270); // crosses a sort of the storage, at step 256
            const std::string hash = sim.state_hash().hex();
            if (reference.empty()) reference = hash;
            EXPECT_EQ(hash, reference) << simd::isa_name(isa) << " threads " << threads;
        }
}

INSTANTIATE_TEST_SUITE_P(All, SpaceDeterminism, testing::ValuesIn(all_variants()), variant_name);

// Springs survive checkpoints in the middle of a run, with an odd number of exchanges of partners or an even
// one.
TEST(Space, ResumesWithTheSameBits) {
    scene::Scene s = test::space_scene(5);
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    md::Simulation straight =
        test::make_simulation(s, test::space_grains(5), simd::available_isas().back(), 2);
    straight.run(600);
    md::Simulation first = test::make_simulation(s, test::space_grains(5), simd::Isa::scalar);
    for (const int part : {17, 300, 96}) {
        first.run(part);
        md::Simulation next = test::make_simulation(s, test::space_grains(5), simd::Isa::scalar);
        next.restore(first.serialise());
        first = next;
    }
    first.run(600 - 413);
    EXPECT_EQ(first.state_hash(), straight.state_hash());
}

// Springs do not notice that lists are made anew, or where the box is cut.
TEST(Space, ShiftedByHalfAPeriodNothingChanges) {
    scene::Scene s = test::space_scene(5);
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    const auto grains = test::space_grains(5);
    auto shifted = grains;
    const double length = s.domain.upper.x;
    const auto by_half = [&](double x) { return x < 0.5 * length ? x + 0.5 * length : x - 0.5 * length; };
    for (auto& g : shifted)
        g.position = {by_half(g.position.x), by_half(g.position.y), by_half(g.position.z)};
    md::Simulation a = test::make_simulation(s, grains, simd::available_isas().back());
    md::Simulation b = test::make_simulation(s, shifted, simd::available_isas().back());
    a.run(400);
    b.run(400);
    const analysis::Snapshot p = a.snapshot(), q = b.snapshot();
    // Rounding of positions, 1e-15, grows in a few collision times; a lost spring would show at 1e-3.
    for (std::size_t i = 0; i < p.size(); ++i) {
        EXPECT_NEAR(p.vx[i], q.vx[i], 1e-9);
        EXPECT_NEAR(p.omega_x[i], q.omega_x[i], 1e-9);
    }
}
