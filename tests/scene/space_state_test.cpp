// Start states in three dimensions.
#include "scene/initial_state.hpp"

#include "scene/population.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sandlane::scene {

namespace {

// A cube of edge 1 m without grains.
Scene cube(bool periodic = false) {
    Scene s;
    s.domain.dimension = 3;
    s.domain.upper = {1, 1, 1};
    s.domain.periodic = {periodic, periodic, periodic};
    s.materials.emplace_back().young = 1e8;
    s.md.inertia = Inertia::sphere;
    return s;
}

// n^2 m sites that fill a periodic cube, in spheres of diameter d.
Scene lattice(std::int64_t n, std::int64_t m, double diameter) {
    Scene s = cube(true);
    Grains& g = s.grains.emplace_back();
    g.counts = {n, n, m};
    g.spacing = {1.0 / static_cast<double>(n), 1.0 / static_cast<double>(n), 1.0 / static_cast<double>(m)};
    g.sizes = {SizeLaw::constant, 0.5 * diameter, 0.5 * diameter};
    return s;
}

double distance_in_unit_cube(Vec a, Vec b) {
    const auto shortest = [](double d) { return d - std::nearbyint(d); };
    return norm({shortest(a.x - b.x), shortest(a.y - b.y), shortest(a.z - b.z)});
}

// Neighbours of the first grain at a distance of 1 to 1.01 diameters, and nothing closer.
int touching_neighbours(const std::vector<GrainState>& grains) {
    int count = 0;
    const double diameter = 2 * grains[0].radius;
    for (std::size_t n = 1; n < grains.size(); ++n) {
        const double d = distance_in_unit_cube(grains[0].position, grains[n].position);
        EXPECT_GT(d, (1 - 1e-9) * diameter);
        count += d < 1.01 * diameter ? 1 : 0;
    }
    return count;
}

double filled(const std::vector<GrainState>& grains) {
    return std::accumulate(grains.begin(), grains.end(), 0.0, [](double sum, const GrainState& g) {
        return sum + 4.0 / 3 * std::numbers::pi * g.radius * g.radius * g.radius;
    });
}

struct Crystal {
    const char* name;
    std::int64_t layers; // of 4 x 4 sites
    bool staggered;
    double diameter; // in units of the edge of a layer's square
    int neighbours;
    double fraction;
};

class Crystals : public testing::TestWithParam<Crystal> {};

// Contacts and packing fractions of the cubic lattices: Ashcroft, Mermin, Solid State Physics, chapter 4.
TEST_P(Crystals, HaveTheirContactsAndDensity) {
    const Crystal& c = GetParam();
    Scene s = lattice(4, c.layers, 0.25 * c.diameter);
    s.grains[0].staggered = c.staggered;
    const std::vector<GrainState> grains = initial_grains(s);
    ASSERT_EQ(grains.size(), static_cast<std::size_t>(16 * c.layers));
    EXPECT_EQ(touching_neighbours(grains), c.neighbours);
    EXPECT_NEAR(filled(grains), c.fraction, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Cubic, Crystals,
                         testing::Values(Crystal{"Simple", 4, false, 1, 6, std::numbers::pi / 6},
                                         Crystal{"BodyCentred", 8, true, std::sqrt(0.75), 8,
                                                 std::sqrt(3.0) * std::numbers::pi / 8}),
                         [](const auto& instance) { return instance.param.name; });

TEST(SpaceState, FaceCentredCubicLatticeTouchesTwelve) {
    // 12 layers at 1/sqrt(2) edges are no period of a cube, so the box is lower.
    Scene s = lattice(4, 12, 0.25);
    s.grains[0].staggered = true;
    s.grains[0].spacing.z = 0.25 / std::numbers::sqrt2;
    s.domain.upper.z = 12 * s.grains[0].spacing.z;
    const std::vector<GrainState> grains = initial_grains(s);
    EXPECT_NEAR(filled(grains) / s.domain.upper.z, std::numbers::pi / std::sqrt(18.0), 1e-12);
    const GrainState& middle = grains[16 * 6 + 5]; // with its neighbours inside the box
    int touching = 0;
    for (const GrainState& g : grains) {
        const double d = norm(g.position - middle.position);
        touching += d > 0 && d < 0.2501 ? 1 : 0;
    }
    EXPECT_EQ(touching, 12);
}

TEST(SpaceState, LatticeRunsAlongXThenYThenZ) {
    Scene s = cube();
    Grains& g = s.grains.emplace_back();
    g.counts = {2, 3, 2};
    g.lower = {0.1, 0.1, 0.1};
    g.spacing = {0.2, 0.25, 0.3};
    g.sizes = {SizeLaw::constant, 0.05, 0.05};
    g.angular_velocity = {1, 2, 3};
    const std::vector<GrainState> grains = initial_grains(s);
    ASSERT_EQ(grains.size(), 12U);
    EXPECT_EQ(grains[1].position, (Vec{0.1 + 0.2, 0.1, 0.1}));
    EXPECT_EQ(grains[2].position, (Vec{0.1, 0.1 + 0.25, 0.1}));
    EXPECT_EQ(grains[6].position, (Vec{0.1, 0.1, 0.1 + 0.3}));
    EXPECT_EQ(grains[11].angular_velocity, (Vec{1, 2, 3}));
    EXPECT_DOUBLE_EQ(grains[0].mass, 4.0 / 3 * std::numbers::pi * 0.05 * 0.05 * 0.05 * 2500);
}

TEST(SpaceState, JitterIsBoundedInEveryDirection) {
    Scene s = lattice(10, 10, 0.05);
    s.grains[0].jitter = 0.2;
    std::array<double, 3> largest{};
    const std::vector<GrainState> grains = initial_grains(s);
    for (std::size_t n = 0; n < grains.size(); ++n) {
        const auto site = [&](std::size_t divisor) { return 0.1 * static_cast<double>(n / divisor % 10); };
        const Vec d = grains[n].position - Vec{site(1), site(10), site(100)};
        const std::array<double, 3> shift{d.x, d.y, d.z};
        for (std::size_t k = 0; k < 3; ++k)
            largest.at(k) = std::max(largest.at(k), std::abs(shift.at(k) - std::nearbyint(shift.at(k))));
    }
    for (const double d : largest) {
        EXPECT_LE(d, 0.02 * (1 + 1e-9));
        EXPECT_GT(d, 0.0198); // of 1000 uniform numbers; probability of failing: 0.99^1000 = 4e-5, seed fixed
    }
}

TEST(SpaceState, ThermalVelocitiesAreIsotropicWithoutMomentum) {
    Scene s = lattice(20, 20, 0.01);
    s.grains[0].thermal_speed = 2;
    s.grains[0].velocity = {1, -1, 3};
    const std::vector<GrainState> grains = initial_grains(s);
    Vec mean, square;
    const double n = static_cast<double>(grains.size());
    for (const GrainState& g : grains) mean = mean + (1 / n) * g.velocity;
    for (const GrainState& g : grains) {
        const Vec d = g.velocity - mean;
        square = square + (1 / n) * Vec{d.x * d.x, d.y * d.y, d.z * d.z};
    }
    EXPECT_LT(norm(mean - s.grains[0].velocity), 1e-12);
    // Five standard deviations of the variance of n normal deviates.
    for (const double variance : {square.x, square.y, square.z})
        EXPECT_NEAR(variance, 4, 5 * 4 * std::sqrt(2 / n));
}

TEST(SpaceState, PouredGrainsFillTheirRegion) {
    Scene s = cube();
    Grains& g = s.grains.emplace_back();
    g.kind = GrainKind::pour;
    g.count = 2000;
    g.rate = 100;
    g.lower = {0.2, 0.3, 0.7};
    g.upper = {0.4, 0.6, 0.9};
    g.sizes = {SizeLaw::constant, 0.01, 0.01};
    Vec mean, low{1, 1, 1}, high;
    for (const GrainState& p : initial_grains(s)) {
        mean = mean + 1.0 / 2000 * p.position;
        low = {std::min(low.x, p.position.x), std::min(low.y, p.position.y), std::min(low.z, p.position.z)};
        high = {std::max(high.x, p.position.x), std::max(high.y, p.position.y),
                std::max(high.z, p.position.z)};
    }
    // Within 1 % of the sides: probability of failing 0.99^2000 = 2e-9 each; five standard deviations of the
    // mean.
    const Vec size = g.upper - g.lower, middle = 0.5 * (g.upper + g.lower);
    const auto check = [](double least, double most, double average, double from, double length,
                          double centre) {
        EXPECT_GE(least, from);
        EXPECT_LT(least, from + 0.01 * length);
        EXPECT_LT(most, from + length);
        EXPECT_GT(most, from + 0.99 * length);
        EXPECT_NEAR(average, centre, 5 * length / std::sqrt(12.0 * 2000));
    };
    check(low.x, high.x, mean.x, g.lower.x, size.x, middle.x);
    check(low.y, high.y, mean.y, g.lower.y, size.y, middle.y);
    check(low.z, high.z, mean.z, g.lower.z, size.z, middle.z);
}

TEST(SpaceState, RandomGrainsKeepClearOfPlanesAndOfEachOther) {
    Scene s = cube();
    Wall& plane = s.walls.emplace_back();
    plane.kind = WallKind::plane;
    plane.points = {{0.5, 0.5, 0.5}};
    plane.normal = {1, 1, 1};
    for (int population = 0; population < 2; ++population) {
        Grains& g = s.grains.emplace_back();
        g.kind = GrainKind::random;
        g.sizes = {SizeLaw::constant, 0.03, 0.03};
        g.count = 300;
    }
    const std::vector<GrainState> grains = initial_grains(s);
    ASSERT_EQ(grains.size(), 600U);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const Vec p = grains[i].position;
        EXPECT_GE((p.x + p.y + p.z - 1.5) / std::sqrt(3.0), 0.03 * (1 - 1e-12));
        for (std::size_t j = 0; j < i; ++j) EXPECT_GE(norm(p - grains[j].position), 0.06 * (1 - 1e-12));
    }
}

TEST(SpaceState, WhatCannotStartIsRefused) {
    const auto start = [](const Scene& s) { return refusal([&] { (void)initial_grains(s); }); };
    Scene s = cube();
    Grains& g = s.grains.emplace_back();
    g.kind = GrainKind::list;
    g.items = {{{0.5, 0.5, 0.1}, {}, 0.1}, {{0.5, 0.5, 0.28}, {}, 0.1}};
    EXPECT_SAYS(start(s), "overlap by 0.02 m, 20 % of the smaller radius");
    g.items[1].position = {0.5, 0.5, 1.2};
    EXPECT_SAYS(
        start(s),
        "grain 1 (grains[0]): its centre (0.5, 0.5, 1.2) m lies outside the domain; allowed: [0, 1) x "
        "[0, 1) x [0, 1) m");
    g.items[1].position = g.items[0].position;
    EXPECT_SAYS(start(s), "have the same centre (0.5, 0.5, 0.1) m");
    g.items.pop_back();
    g.items[0].radius = 0.3;
    s.domain.periodic = {false, false, true};
    EXPECT_SAYS(start(s), "the period of 1 m along z is too short for the largest radius 0.3 m");
    g.items[0].angular_velocity.y = INFINITY;
    EXPECT_SAYS(start(s), "spin (0, inf, 0) rad/s");
    g = {};
    g.kind = GrainKind::random;
    g.sizes = {SizeLaw::constant, 0.1, 0.1};
    g.upper = {1, 1, 0.1};
    g.count = 1;
    EXPECT_SAYS(start(s), "the region of 1 x 1 x 0.1 m does not hold a grain of diameter 0.2 m");
}

// Across a periodic side grains are neighbours.
TEST(SpaceState, OverlapIsSeenAcrossThePeriodAlongZ) {
    Scene s = cube();
    Grains& g = s.grains.emplace_back();
    g.kind = GrainKind::list;
    g.items = {{{0.5, 0.5, 0.02}, {}, 0.05}, {{0.5, 0.5, 0.98}, {}, 0.05}};
    EXPECT_EQ(initial_grains(s).size(), 2U);
    s.domain.periodic = {false, false, true};
    EXPECT_SAYS(refusal([&] { (void)initial_grains(s); }), "overlap by 0.06 m");
}

TEST(SpaceState, GrainFilesHaveTheColumnsOfSpace) {
    Scene s = cube();
    Grains& g = s.grains.emplace_back();
    g.kind = GrainKind::file;
    const auto parse = [&](const std::string& text) { return parse_grains(text, "grains.csv", s, g, {}); };
    const std::vector<GrainState> grains =
        parse("x,y,z,vx,vy,vz,omega_x,omega_y,omega_z,radius,mass\n1,2,3,4,5,6,7,8,9,10,11\n");
    ASSERT_EQ(grains.size(), 1U);
    EXPECT_EQ(grains[0].position, (Vec{1, 2, 3}));
    EXPECT_EQ(grains[0].velocity, (Vec{4, 5, 6}));
    EXPECT_EQ(grains[0].angular_velocity, (Vec{7, 8, 9}));
    EXPECT_EQ(grains[0].radius, 10);
    EXPECT_EQ(grains[0].mass, 11);
    const auto mistake = [&](const std::string& text) { return refusal([&] { (void)parse(text); }); };
    EXPECT_SAYS(mistake("x,y,radius\n0,0,1\n"), "grains.csv:1: column \"z\" is missing");
    EXPECT_SAYS(mistake("x,y,z,omega,radius\n"),
                "\"omega\" is not a column of a three-dimensional scene; known: x, y, z, "
                "vx, vy, vz, omega_x, omega_y, omega_z, radius, mass, material");
    EXPECT_SAYS(mistake(""), "x,y,z,vx,vy,vz,radius");
    EXPECT_SAYS(mistake("0 0 0\n"), "has no header line of column names");
    s.domain.dimension = 2;
    EXPECT_SAYS(mistake("x,y,z,radius\n"),
                "\"z\" is not a column; known: x, y, vx, vy, angle, omega, radius, mass, "
                "material");
}

} // namespace

} // namespace sandlane::scene
