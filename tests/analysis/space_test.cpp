// Analyses in three dimensions against closed forms: lattices, a homogeneous gas, single contacts.
#include "analysis/flow.hpp"
#include "analysis/force_chains.hpp"
#include "analysis/stress.hpp"

#include "analysis/support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <random>

using namespace sandlane;
using namespace sandlane::analysis;

namespace {

constexpr double pi = std::numbers::pi;

scene::Scene unit_cube(std::array<bool, 3> periodic = {}) {
    scene::Scene s;
    s.domain.dimension = 3;
    s.domain.upper = {1, 1, 1};
    s.domain.periodic = periodic;
    return s;
}

Region cube() {
    return {{0, 0, 0}, {1, 1, 1}, 3};
}

scene::AnalysisSpec spec_of(scene::AnalysisKind kind, std::int64_t bins = 0) {
    scene::AnalysisSpec spec;
    spec.kind = kind;
    spec.bins = bins;
    return spec;
}

Hand periodic_cube() {
    Hand h({1, 1, 1});
    h.grains.periodic_x = h.grains.periodic_y = h.grains.periodic_z = true;
    return h;
}

// n^3 touching spheres; number (z n + y) n + x.
Hand simple_cubic(int n) {
    Hand h = periodic_cube();
    for (int k = 0; k < n * n * n; ++k)
        h.add({(k % n + 0.5) / n, (k / n % n + 0.5) / n, (k / (n * n) + 0.5) / n}, 0.5 / n);
    return h;
}

Hand fcc(int n) {
    Hand h = periodic_cube();
    const std::array<Vec, 4> basis{{{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}};
    const double a = 1.0 / n;
    for (int k = 0; k < n * n * n; ++k)
        for (const Vec b : basis)
            h.add(a * (Vec{k % n + 0.25, k / n % n + 0.25, k / (n * n) + 0.25} + b), a / std::sqrt(8));
    return h;
}

Vec velocity_at_random(std::mt19937_64& random, Vec deviation) {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return {deviation.x * x, deviation.y * y, deviation.z * z};
}

} // namespace

TEST(Space, TwoOppositeForcesOnASphere) {
    Hand h({10, 10, 10});
    const auto i = h.add({5, 5, 5}, 1);
    h.touch(i, -1, {1, 0, 0});
    h.touch(i, -1, {-1, 0, 0});
    const Tensor t = grain_stress(h.frame()).at(0);
    EXPECT_NEAR(t.xx, 0.4774648293, 1e-10); // the numbers of the specification, 3/(2 pi) and a third of it
    EXPECT_NEAR(t.pressure(), 0.1591549431, 1e-10);
    for (const double other : {t.yy, t.zz, t.xy, t.xz, t.yx, t.yz, t.zx, t.zy}) EXPECT_EQ(other, 0);
}

// Each axis of the lattice carries a force of its own, spread over one cell.
TEST(Space, StressOfASimpleCubicLattice) {
    const int n = 4;
    const double a = 1.0 / n;
    Hand h = simple_cubic(n);
    for (int k = 0; k < n * n * n; ++k) {
        const int x = k % n, y = k / n % n, z = k / (n * n);
        h.touch(k, (z * n + y) * n + (x + 1) % n, {1, 0, 0}, 3);
        h.touch(k, (z * n + (y + 1) % n) * n + x, {0, 1, 0}, 5);
        h.touch(k, ((z + 1) % n * n + y) * n + x, {0, 0, 1}, 7);
    }
    const Tensor t = contact_stress(h.frame(), cube());
    EXPECT_NEAR(t.xx, 3 / (a * a), 1e-11); // sums of 64 terms of size 1
    EXPECT_NEAR(t.yy, 5 / (a * a), 1e-11);
    EXPECT_NEAR(t.zz, 7 / (a * a), 1e-11);
    EXPECT_NEAR(t.xz, 0, 1e-11);
    EXPECT_NEAR(t.pressure(), 5 / (a * a), 1e-11);
    EXPECT_EQ(contact_number(h.frame(), cube()), 6);
    const Region cells{{0.125, 0.125, 0.125}, {0.625, 0.625, 0.625}, 3}; // any window of whole cells
    EXPECT_NEAR(contact_stress(h.frame(), cells).zz, 7 / (a * a), 1e-11);
    const auto series = make_analysis(unit_cube(), spec_of(scene::AnalysisKind::stress));
    series->add(h.frame());
    ASSERT_EQ(series->columns().size(), series->rows().at(0).size());
    EXPECT_EQ(series->columns().at(9).name, "stress_zz");
    EXPECT_EQ(series->columns().at(9).unit, "Pa");
    EXPECT_NEAR(series->rows().at(0).at(9), 7 / (a * a), 1e-11);
}

// A force across the line of centres: l is along x, f along y.
TEST(Space, ShearOfOneContact) {
    Hand h({1, 1, 1});
    const auto i = h.add({0.4, 0.5, 0.5}, 0.1), j = h.add({0.6, 0.5, 0.5}, 0.1);
    h.touch(i, j, {1, 0, 0}, 2, 0.5); // f_t along +y on i
    const Tensor t = contact_stress(h.frame(), cube());
    EXPECT_NEAR(t.xx, 0.2 * 2, 1e-14);
    EXPECT_NEAR(t.xy, -0.2 * 0.5, 1e-14);
    EXPECT_EQ(t.yx, 0);
}

TEST(Space, KineticStressOfAGas) {
    std::mt19937_64 random(11);
    Hand h({1, 1, 1});
    const double mass = 2;
    const int n = 20000;
    const Vec deviation{1, 2, 3};
    for (int k = 0; k < n; ++k)
        h.add({0.5, 0.5, 0.5}, 0.01, mass, Vec{10, 0, -5} + velocity_at_random(random, deviation));
    const Tensor t = kinetic_stress(h.grains, cube());
    const double noise = 5 * std::sqrt(2.0 / n); // five deviations of a variance, relative
    EXPECT_NEAR(t.xx / (n * mass), 1, noise);
    EXPECT_NEAR(t.yy / (n * mass), 4, 4 * noise);
    EXPECT_NEAR(t.zz / (n * mass), 9, 9 * noise);
    EXPECT_NEAR(t.xz / (n * mass), 0, 3 * noise);
    EXPECT_NEAR(t.pressure() / (n * mass), 14.0 / 3, 5 * noise);
}

TEST(Space, PackingFractionsOfLattices) {
    EXPECT_NEAR(packing_fraction(simple_cubic(4).grains, cube()), pi / 6, 1e-12);
    // Spheres of this lattice lie across faces, edges and corners of the box.
    EXPECT_NEAR(
        packing_fraction(fcc(3).grains, {{0.1, 0.2, 0.3}, {0.1 + 1.0 / 3, 0.2 + 1.0 / 3, 0.3 + 1.0 / 3}, 3}),
        pi / std::sqrt(18), 1e-8);
}

TEST(Space, PartsOfASphere) {
    const auto volume = [](Vec lower, Vec upper) {
        return sphere_volume_inside({0, 0, 0}, 2, {lower, upper, 3});
    };
    const double whole = 4.0 / 3 * pi * 8, error = 1e-8 * whole; // what is promised
    EXPECT_DOUBLE_EQ(volume({-3, -3, -3}, {3, 3, 3}), whole);
    EXPECT_NEAR(volume({0, -3, -3}, {3, 3, 3}), whole / 2, error);
    EXPECT_NEAR(volume({-3, 0, -3}, {3, 3, 0}), whole / 4, error);
    EXPECT_NEAR(volume({0, 0, 0}, {3, 3, 3}), whole / 8, error);
    EXPECT_NEAR(volume({-0.5, -0.5, -0.5}, {0.5, 0.5, 1}), 1.5, error); // inside the sphere
    EXPECT_EQ(volume({2, -3, -3}, {3, 3, 3}), 0);
    EXPECT_NEAR(volume({1.5, 1.5, 0}, {3, 3, 3}), 0, error); // meets its box, not the sphere
    // Cap of height h: pi h^2 (3R - h)/3, beyond each side.
    const double cap = pi * 1 * (6 - 1) / 3;
    EXPECT_NEAR(volume({1, -3, -3}, {3, 3, 3}), cap, error);
    EXPECT_NEAR(volume({-3, -3, -3}, {3, -1, 3}), cap, error);
    EXPECT_NEAR(volume({-3, -3, 1}, {3, 3, 3}), cap, error);
    // A square column through the sphere and what is left of it add up; so do the eight corners of any point.
    const Vec at{0.3, -0.7, 1.1};
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
        const Vec low{k & 1 ? at.x : -3, k & 2 ? at.y : -3, k & 4 ? at.z : -3};
        sum += volume(low, {k & 1 ? 3 : at.x, k & 2 ? 3 : at.y, k & 4 ? 3 : at.z});
    }
    EXPECT_NEAR(sum, whole, 8 * error);
}

TEST(Space, ProfileOfAGas) {
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::profile, 4);
    spec.axis = scene::Axis::z;
    const auto profile = make_analysis(unit_cube(), spec);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    Hand h({1, 1, 1});
    const int n = 40000;
    for (int k = 0; k < n; ++k) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        h.add({x, y, z}, 0.001, 2, Vec{7, 0, -1} + velocity_at_random(random, {1, 2, 3}), 12);
    }
    profile->add(h.frame());
    EXPECT_EQ(profile->columns().at(0).name, "z");
    for (const std::vector<double>& row : profile->rows()) {
        const double noise = 5 / std::sqrt(n / 4.0); // relative, five deviations
        EXPECT_NEAR(row[1], n / 4.0, n / 4.0 * noise);
        EXPECT_NEAR(row[2] / (n * 4.0 / 3 * pi * 1e-9), 1, noise);
        EXPECT_NEAR(row[3] / (2 * n), 1, noise);
        EXPECT_NEAR(row[4], 7, 1 * noise);
        EXPECT_NEAR(row[6], -1, 3 * noise);
        EXPECT_NEAR(row[7], 1, std::sqrt(2) * noise);
        EXPECT_NEAR(row[8], 4, 4 * std::sqrt(2) * noise);
        EXPECT_NEAR(row[9], 9, 9 * std::sqrt(2) * noise);
        EXPECT_DOUBLE_EQ(row[10], (row[7] + row[8] + row[9]) / 3);
        EXPECT_DOUBLE_EQ(row[11], 12);
    }
}

// A sphere cut by two layers, across a periodic side or one where its end is lost.
TEST(Space, ProfileSharesVolumes) {
    for (const auto axis : {scene::Axis::x, scene::Axis::y, scene::Axis::z}) {
        scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::profile, 5);
        spec.axis = axis;
        Hand h = periodic_cube();
        h.add({0.1, 0.1, 0.1}, 0.3); // reaches 0.2 beyond the side
        const auto across = make_analysis(unit_cube({true, true, true}), spec);
        const auto open = make_analysis(unit_cube(), spec);
        across->add(h.frame());
        open->add(h.frame());
        const auto cap = [](double height) { return pi * height * height * (0.9 - height) / 3; };
        const double sphere = 4.0 / 3 * pi * 0.027;
        const std::array<double, 5> expected{sphere - 2 * cap(0.2), cap(0.2), 0, 0, cap(0.2)};
        for (std::size_t b = 0; b < 5; ++b) {
            EXPECT_NEAR(across->rows()[b][2], 5 * expected[b], 1e-14);
            EXPECT_NEAR(open->rows()[b][2], b == 4 ? 0 : 5 * expected[b], 1e-14);
            EXPECT_EQ(across->rows()[b][1], b == 0 ? 1 : 0);
        }
    }
}

// For grains at random g = 1 up to noise, whatever the sides are.
TEST(Space, PairCorrelationOfAnIdealGas) {
    for (int sides = 0; sides < 8; ++sides) {
        const std::array<bool, 3> periodic{(sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0};
        scene::Scene scene = unit_cube(periodic);
        scene.domain.upper = {1, 1.2, 1.4};
        scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::pair_correlation, 8);
        spec.range = 1; // as far as is allowed
        for (std::size_t k = 0; k < 3; ++k)
            spec.range =
                std::min(spec.range, (1 + 0.2 * static_cast<double>(k)) * (periodic.at(k) ? 0.5 : 1));
        const auto g = make_analysis(scene, spec);
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> uniform(0, 1);
        const int frames = 20;
        for (int frame = 0; frame < frames; ++frame) {
            Hand h({1, 1.2, 1.4});
            for (int k = 0; k < 200; ++k) {
                const double x = uniform(random), y = uniform(random);
                h.add({x, 1.2 * y, 1.4 * uniform(random)});
            }
            g->add(h.frame());
        }
        for (const std::vector<double>& row : g->rows()) {
            // Five standard deviations of independent pairs; the factor covers pairs that share a grain.
            const double noise = 5 * 1.5 / std::sqrt(std::max(1.0, row[2] * frames));
            EXPECT_NEAR(row[1], 1, noise) << row[0] << " sides " << sides;
        }
    }
}

TEST(Space, PairCorrelationOfAnFccLattice) {
    const int n = 4;
    const auto kind = scene::AnalysisKind::pair_correlation;
    scene::AnalysisSpec spec = spec_of(kind, 8);
    spec.range = 0.28; // shells of 0.035; neighbours at a/sqrt 2 = 0.1768, a = 0.25
    const auto g = make_analysis(unit_cube({true, true, true}), spec);
    g->add(fcc(n).frame());
    const Rows rows = g->rows();
    const double grains = 4.0 * n * n * n;
    for (const std::size_t empty : {0U, 1U, 2U, 3U, 4U, 6U}) EXPECT_EQ(rows[empty][2], 0);
    EXPECT_EQ(rows[5][2], 12 * grains / 2);
    EXPECT_EQ(rows[7][2], 6 * grains / 2);
    const double shell = 4.0 / 3 * pi * (std::pow(6 * 0.035, 3) - std::pow(5 * 0.035, 3));
    EXPECT_NEAR(rows[5][1], 12 / ((grains - 1) * shell), 1e-10); // differences of cubes
}

// Three spheres bent in a plane that no axis lies in.
TEST(Space, ForceChainsNeedAnAngleAbove150Degrees) {
    const Vec along = (1 / std::sqrt(3.0)) * Vec{1, 1, 1}, across = (1 / std::sqrt(2.0)) * Vec{1, -1, 0};
    for (const double degrees : {149.9, 150.1, 180.0, 209.9, 210.1}) {
        const double bend = (180 - degrees) * pi / 180;
        Hand h({10, 10, 10});
        for (int k = 0; k < 3; ++k) h.add({}, 1, 1, {}, 2);
        h.touch(0, 1, along);
        h.touch(1, 2, std::cos(bend) * along + std::sin(bend) * across);
        EXPECT_EQ(find_force_chains(h.frame(), 1).triples, std::abs(degrees - 180) < 30 ? 1 : 0) << degrees;
    }
    const auto series = make_analysis(unit_cube(), spec_of(scene::AnalysisKind::force_chains));
    EXPECT_EQ(series->columns().at(1).unit, "Pa");
}

TEST(Space, MapLooksAlongItsAxis) {
    struct Case {
        scene::Axis axis;
        const char *across, *up;
        std::size_t bin; // of a grain at (0.2, 0.2, 0.8): to the right, up
    };
    for (const Case c : {Case{scene::Axis::x, "y", "z", 2}, Case{scene::Axis::y, "x", "z", 2},
                         Case{scene::Axis::z, "x", "y", 0}}) {
        scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::map, 2);
        spec.axis = c.axis;
        const auto map = make_analysis(unit_cube(), spec);
        Hand h({1, 1, 1});
        h.add({0.2, 0.2, 0.8}, 0.1, 1, {1, 2, 3}, 9);
        h.add({0.2, 0.2, 1.8}, 0.1, 1, {1, 2, 3}, 9); // outside
        map->add(h.frame());
        ASSERT_EQ(map->columns().size(), 9U);
        EXPECT_EQ(map->columns()[0].name, c.across);
        EXPECT_EQ(map->columns()[1].name, c.up);
        EXPECT_EQ(map->columns()[3].unit, "Pa");
        const Rows rows = map->rows();
        ASSERT_EQ(rows.size(), 4U);
        for (std::size_t b = 0; b < 4; ++b) {
            EXPECT_EQ(rows[b][2], b == c.bin ? 1 : 0);
            EXPECT_EQ(rows[b][6], b == c.bin ? 3 : 0);
        }
        EXPECT_EQ(rows[1][0], 0.75);
        EXPECT_EQ(rows[1][1], 0.25);
        EXPECT_EQ(map->grids().at(0).values.at(c.bin), 9);
    }
}

TEST(Space, FlowThroughARectangle) {
    const Vec from{0.2, 0.2, 0.5}, to{0.8, 0.6, 0.5}; // across z
    const auto moved = [&](Vec before, Vec after) {
        Hand h({1, 1, 1});
        h.add(before, 0.1, 3);
        const Places places = places_of(h.grains);
        h.grains.x[0] = after.x;
        h.grains.y[0] = after.y;
        h.grains.z[0] = after.z;
        return crossings(places, h.grains, from, to).mass;
    };
    EXPECT_EQ(moved({0.5, 0.5, 0.4}, {0.5, 0.5, 0.6}), 3);
    EXPECT_EQ(moved({0.5, 0.5, 0.6}, {0.5, 0.5, 0.4}), -3);
    EXPECT_EQ(moved({0.5, 0.7, 0.4}, {0.5, 0.7, 0.6}), 0);  // beside it
    EXPECT_EQ(moved({0.7, 0.5, 0.4}, {0.95, 0.5, 0.6}), 0); // meets the plane at 0.825
    EXPECT_EQ(moved({0.7, 0.5, 0.4}, {0.85, 0.5, 0.6}), 3); // at 0.775
    EXPECT_EQ(moved({0.5, 0.5, 0.4}, {0.5, 0.5, 0.45}), 0);
    // Stopping on the plane and going on is one crossing.
    EXPECT_EQ(moved({0.5, 0.5, 0.4}, {0.5, 0.5, 0.5}), 0);
    EXPECT_EQ(moved({0.5, 0.5, 0.5}, {0.5, 0.5, 0.6}), 3);
}

TEST(Space, FlowThroughPeriodicSides) {
    for (const double plane : {0.05, 0.97}) { // right behind and before the side
        Hand h = periodic_cube();
        h.add({0.5, 0.5, 0.95});
        const Places places = places_of(h.grains);
        h.grains.z[0] = 0.1; // 0.15 up
        h.grains.image_z[0] = 1;
        EXPECT_EQ(crossings(places, h.grains, {0, 0, plane}, {1, 1, plane}).grains, 1) << plane;
        EXPECT_EQ(crossings(places, h.grains, {0, 0, 0.5}, {1, 1, 0.5}).grains, 0);
    }
}

// Every kind: what is saved half way leads to the same rows.
TEST(Space, AnalysesGoOnAfterLoading) {
    using Kind = scene::AnalysisKind;
    for (const Kind kind : {Kind::profile, Kind::pair_correlation, Kind::force_chains, Kind::map, Kind::flow,
                            Kind::stress, Kind::mixing}) {
        SCOPED_TRACE(static_cast<int>(kind));
        scene::AnalysisSpec spec = spec_of(kind);
        if (kind == Kind::flow) {
            spec.from = {0.5, 0, 0};
            spec.to = {0.5, 1, 1};
        }
        const auto straight = make_analysis(unit_cube(), spec), first = make_analysis(unit_cube(), spec),
                   second = make_analysis(unit_cube(), spec);
        const auto frame = [](int n) {
            Hand h({1, 1, 1});
            h.grains.time = n;
            for (int k = 0; k < 3; ++k)
                h.add({0.2 + 0.2 * k + 0.1 * n, 0.5, 0.3}, 0.1, 1 + k, {0.1, 0, 0.2}, 2 + n);
            h.touch(0, 1, {1, 0, 0}, 1 + n);
            h.touch(1, 2, {1, 0, 0}, 2 + n);
            return h;
        };
        for (int n = 0; n < 4; ++n) straight->add(frame(n).frame());
        for (int n = 0; n < 2; ++n) first->add(frame(n).frame());
        ByteWriter saved;
        first->save(saved);
        ByteReader bytes(saved.bytes());
        second->load(bytes);
        EXPECT_TRUE(bytes.at_end());
        for (int n = 2; n < 4; ++n) second->add(frame(n).frame());
        EXPECT_EQ(second->rows(), straight->rows());
        ASSERT_FALSE(straight->rows().empty());
        EXPECT_EQ(straight->rows().at(0).size(), straight->columns().size());
    }
}
