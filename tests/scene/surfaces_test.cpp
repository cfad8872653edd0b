// Walls in space: distances and directions from geometry, and how many contacts a sphere has.
#include "scene/surfaces.hpp"

#include "scene/box_tree.hpp"
#include "support/stl_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace sandlane;
using namespace sandlane::scene;

namespace {

constexpr double rounding = 1e-14; // coordinates of order one

Scene scene_of(std::vector<Wall> walls) {
    Scene s;
    s.domain.dimension = 3;
    s.walls = std::move(walls);
    return s;
}

Wall mesh_wall(const std::string& name, const test::Triangles& triangles) {
    Wall w;
    w.kind = WallKind::mesh;
    w.file = test::stl_file(name, test::stl_text(triangles));
    return w;
}

Wall tube(WallKind kind, double radius, double radius_to, bool closed) {
    Wall w;
    w.kind = kind;
    w.points = {{0, 0, 0}, {0, 0, 2}};
    w.radius = radius;
    w.radius_to = radius_to;
    w.closed = closed;
    return w;
}

std::vector<Touch> touches(const Surfaces& surfaces, Vec p, double radius) {
    std::vector<Touch> found;
    surfaces.for_near(Surfaces::frame_of(-1), p, radius,
                      [&](std::uint32_t n) { surfaces.add_touch(n, p, radius, found); });
    surfaces.keep_own(radius, found);
    return found;
}

void expect_near(Vec a, Vec b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

// One contact with that distance and direction.
void expect_touch(const Surfaces& surfaces, Vec p, double radius, double distance, Vec direction) {
    const std::vector<Touch> found = touches(surfaces, p, radius);
    ASSERT_EQ(found.size(), 1) << p.x << " " << p.y << " " << p.z;
    EXPECT_NEAR(found[0].foot.distance, distance, rounding);
    expect_near(found[0].foot.direction, direction, 100 * rounding);
    expect_near(found[0].point, p + distance * direction, 100 * rounding);
}

Vec turned(Vec v) { // about (1, 1, 1), by no special angle
    const double a = 0.7, c = std::cos(a), s = std::sin(a);
    const Vec k = (1 / std::sqrt(3.0)) * Vec{1, 1, 1};
    return c * v + s * cross(k, v) + ((1 - c) * dot(k, v)) * k;
}

test::Triangles turned(test::Triangles triangles) {
    for (auto& t : triangles)
        for (Vec& p : t) p = turned(p);
    return triangles;
}

} // namespace

TEST(Surfaces, Plane) {
    Wall w;
    w.kind = WallKind::plane;
    w.points = {{0, 0, 1}};
    w.normal = {0, 3, 4};
    const Surfaces surfaces(scene_of({w}));
    const Vec n{0, 0.6, 0.8}, foot{5, 0.8, 0.4};
    expect_touch(surfaces, foot + 0.9 * n, 1, 0.9, -1.0 * n);
    expect_touch(surfaces, foot - 0.1 * n, 1, -0.1, -1.0 * n);
    EXPECT_TRUE(touches(surfaces, foot + 1.1 * n, 1).empty());
}

TEST(Surfaces, BoxFromInside) {
    Wall w;
    w.kind = WallKind::box;
    w.points = {{1, 0, 3}, {0, 2, 0}}; // any two opposite corners
    const Surfaces surfaces(scene_of({w}));
    expect_touch(surfaces, {0.5, 1, 0.09}, 0.1, 0.09, {0, 0, -1});
    expect_touch(surfaces, {0.92, 1, 1}, 0.1, 0.08, {1, 0, 0});
    EXPECT_EQ(touches(surfaces, {0.92, 1.95, 1}, 0.1).size(), 2);
    EXPECT_EQ(touches(surfaces, {0.92, 1.95, 2.93}, 0.1).size(), 3);
    EXPECT_TRUE(touches(surfaces, {0.5, 1, 1}, 0.1).empty());
}

TEST(Surfaces, CylinderInsideOutsideAndBeyondItsEnds) {
    const Surfaces open(scene_of({tube(WallKind::cylinder, 1, 0, false)}));
    const Vec radial{0.6, 0.8, 0};
    expect_touch(open, 0.85 * radial + Vec{0, 0, 0.7}, 0.2, 0.15, radial);
    expect_touch(open, 1.15 * radial + Vec{0, 0, 0.7}, 0.2, 0.15, -1.0 * radial);
    // Past the end the rim is closest, in the plane of axis and centre.
    expect_touch(open, 0.88 * radial + Vec{0, 0, 2.16}, 0.3, 0.2, 0.6 * radial + Vec{0, 0, -0.8});
    EXPECT_TRUE(touches(open, {0, 0, 2.1}, 0.2).empty());
    EXPECT_TRUE(touches(open, {0, 0, 0.01}, 0.2).empty());

    const Surfaces closed(scene_of({tube(WallKind::cylinder, 1, 0, true)}));
    expect_touch(closed, {0.3, 0.1, 1.85}, 0.2, 0.15, {0, 0, 1});
    expect_touch(closed, {0, 0, -0.15}, 0.2, 0.15, {0, 0, 1});
    expect_touch(closed, 1.12 * radial + Vec{0, 0, 2.16}, 0.3, 0.2, -0.6 * radial + Vec{0, 0, -0.8});
    EXPECT_EQ(touches(closed, 0.85 * radial + Vec{0, 0, 1.9}, 0.2).size(), 2); // in the corner
}

TEST(Surfaces, ConeAsHopper) {
    // Opens upwards from 0.5 to 2 over the height 2: the wall leans by atan(1.5/2), cosine 0.8.
    const Surfaces cone(scene_of({tube(WallKind::cone, 0.5, 2, false)}));
    const Vec radial{0, 1, 0}, outward = 0.8 * radial + Vec{0, 0, -0.6};
    const Vec on_wall = 1.25 * radial + Vec{0, 0, 1};
    expect_touch(cone, on_wall - 0.15 * outward, 0.2, 0.15, outward);
    expect_touch(cone, on_wall + 0.15 * outward, 0.2, 0.15, -1.0 * outward);
    // Wedged: two sides, at equal angles to the axis; off the axis the nearer one is closer.
    const double to_side = 1.25 * 0.8;
    const std::vector<Touch> wedged = touches(cone, {0, 0, 1}, 1.1);
    ASSERT_EQ(wedged.size(), 2);
    for (const Touch& t : wedged) EXPECT_NEAR(t.foot.distance, to_side, rounding);
    expect_near(wedged[0].foot.direction + wedged[1].foot.direction, {0, 0, -1.2}, 100 * rounding);
    const std::vector<Touch> aside = touches(cone, {0, 0.01, 1}, 1.1);
    ASSERT_EQ(aside.size(), 2);
    EXPECT_NEAR(aside[0].foot.distance, to_side - 0.008, rounding);
    EXPECT_NEAR(aside[1].foot.distance, to_side + 0.008, rounding);
    // A sphere on the opening, larger than it, from above and below.
    EXPECT_EQ(touches(cone, {0, 0, -0.4}, 0.7).size(), 2);
}

TEST(Surfaces, TipOfACone) {
    const Surfaces cone(scene_of({tube(WallKind::cone, 1, 0, true)}));
    expect_touch(cone, {0, 0, 2.1}, 0.2, 0.1, {0, 0, -1});
}

// A sphere that touches a flat face of many triangles has one contact, that of the plane: also exactly above
// edges and points, at any slope, where triangles do not share their edges, and with the digits of binary
// files.
TEST(Surfaces, AFlatFaceOfTrianglesIsAPlane) {
    const test::Triangles flat = test::uneven_square(7);
    const Surfaces level(scene_of({mesh_wall("level", flat)}));
    const Surfaces sloping(scene_of({mesh_wall("sloping", turned(flat))}));
    const double height = 0.19, radius = 0.2;
    const auto check = [&](double x, double y) {
        const Vec p{x, y, height};
        expect_touch(level, p, radius, height, {0, 0, -1});
        const std::vector<Touch> found = touches(sloping, turned(p), radius);
        ASSERT_EQ(found.size(), 1) << x << " " << y;
        EXPECT_NEAR(found[0].foot.distance, height, 10 * rounding);
    };
    for (const auto& t : flat)
        for (const Vec a : t)
            for (const Vec b : t) // corners and middles of edges
                if (const Vec m = 0.5 * (a + b); std::max(std::abs(m.x), std::abs(m.y)) < 0.8)
                    check(m.x, m.y);
    for (int k = 0; k < 1000; ++k) check(0.79 * std::sin(7.0 * k), 0.79 * std::cos(11.0 * k));
}

TEST(Surfaces, TrianglesThatDoNotShareTheirEdges) {
    // Two triangles below y = 0, three above: the points on the seam differ.
    const test::Triangles seam{{Vec{-1, -1, 0}, Vec{1, -1, 0}, Vec{1, 0, 0}},
                               {Vec{-1, -1, 0}, Vec{1, 0, 0}, Vec{-1, 0, 0}},
                               {Vec{-1, 0, 0}, Vec{0.1, 0, 0}, Vec{-1, 1, 0}},
                               {Vec{0.1, 0, 0}, Vec{1, 1, 0}, Vec{-1, 1, 0}},
                               {Vec{0.1, 0, 0}, Vec{1, 0, 0}, Vec{1, 1, 0}}};
    const Surfaces surfaces(scene_of({mesh_wall("seam", seam)}));
    for (double x = -0.7; x < 0.7; x += 0.05)
        for (double y = -0.3; y < 0.3; y += 0.003)
            expect_touch(surfaces, {x, y, 0.19}, 0.2, 0.19, {0, 0, -1});
}

TEST(Surfaces, DigitsOfBinaryFilesMakeNoSecondContact) {
    Wall w;
    w.kind = WallKind::mesh;
    w.file = test::stl_file("binary", test::stl_binary(turned(test::uneven_square(30))));
    const Surfaces surfaces(scene_of({w}));
    for (int k = 0; k < 3000; ++k) {
        const Vec p = turned({0.79 * std::sin(7.0 * k), 0.79 * std::cos(11.0 * k), 0.0199});
        const std::vector<Touch> found = touches(surfaces, p, 0.02);
        ASSERT_EQ(found.size(), 1);
        // 2^-24 of a coordinate up to 1.4, tilting triangles that are 0.07 wide
        EXPECT_NEAR(found[0].foot.distance, 0.0199, 2e-7);
    }
}

TEST(Surfaces, EdgesAndCornersOfACube) {
    const Surfaces surfaces(scene_of({mesh_wall("cube", test::box_triangles({0, 0, 0}, {1, 1, 1}))}));
    const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 3);
    expect_touch(surfaces, {1 + 0.1 * half, 1 + 0.1 * half, 0.37}, 0.11, 0.1, {-half, -half, 0});
    expect_touch(surfaces, {1 + 0.1 * third, 1 + 0.1 * third, 1 + 0.1 * third}, 0.11, 0.1,
                 {-third, -third, -third});
    // Inside the edges are concave: one contact for each face.
    EXPECT_EQ(touches(surfaces, {0.92, 0.93, 0.5}, 0.1).size(), 2);
    EXPECT_EQ(touches(surfaces, {0.92, 0.93, 0.94}, 0.1).size(), 3);
    // Across its surface the contact of a rolling sphere jumps nowhere.
    for (int k = 0; k < 4000; ++k) {
        std::mt19937 random(static_cast<unsigned>(k));
        std::uniform_real_distribution<double> any(-0.1, 1.1);
        const Vec p{any(random), any(random), any(random)};
        const Vec q{std::clamp(p.x, 0.0, 1.0), std::clamp(p.y, 0.0, 1.0), std::clamp(p.z, 0.0, 1.0)};
        const double distance = norm(p - q);
        if (distance < 0.01 || distance > 0.1) continue; // inside, or not touching
        expect_touch(surfaces, p, 0.1, distance, (1 / distance) * (q - p));
    }
}

TEST(Surfaces, AMeshIsScaledAndThenMoved) {
    Wall w = mesh_wall("placed", test::box_triangles({0, 0, 0}, {1000, 1000, 1000}));
    w.scale = 0.001;
    w.centre = {5, 6, 7};
    const Surfaces surfaces(scene_of({w}));
    expect_touch(surfaces, {5.5, 6.5, 8.1}, 0.2, 0.1, {0, 0, -1});
    ASSERT_EQ(surfaces.outline().size(), 12);
    for (const OutlineTriangle& t : surfaces.outline()) EXPECT_GE(t.a.z, 7);
}

TEST(Outline, RoundWallsHaveTheirArea) {
    const auto area_of = [](const Wall& wall) {
        const Surfaces surfaces(scene_of({wall}));
        double area = 0;
        for (const OutlineTriangle& t : surfaces.outline()) area += 0.5 * norm(cross(t.b - t.a, t.c - t.a));
        return area;
    };
    // Of 64 sides: pi^2/(6 n^2) of the circumference is lost, four times that of the area of a disc.
    const double pi = std::numbers::pi, lost = 4 * pi * pi / (6 * 64 * 64);
    EXPECT_NEAR(area_of(tube(WallKind::cylinder, 1, 0, false)), 4 * pi, 4 * pi * lost);
    EXPECT_NEAR(area_of(tube(WallKind::cylinder, 1, 0, true)), 6 * pi, 6 * pi * lost);
    EXPECT_NEAR(area_of(tube(WallKind::cone, 0.5, 2, false)), 2.5 * pi * 2.5, 2.5 * pi * 2.5 * lost);
    EXPECT_NEAR(area_of(tube(WallKind::cone, 1, 0, true)), pi * (1 + std::sqrt(5.0)),
                pi * (1 + std::sqrt(5.0)) * lost);
}

TEST(Outline, PlanesEndWhereTheDomainDoes) {
    const Bounds box{{0, 0, 0}, {1, 1, 1}};
    const auto area_of = [&](Vec point, Vec normal) {
        std::vector<OutlineTriangle> outline;
        outline_plane(point, normal, box, 0, outline);
        double area = 0;
        for (const OutlineTriangle& t : outline) area += 0.5 * norm(cross(t.b - t.a, t.c - t.a));
        return area;
    };
    EXPECT_NEAR(area_of({0, 0, 0.3}, {0, 0, 1}), 1, rounding);
    EXPECT_NEAR(area_of({0, 0, 0}, {0, 0, 1}), 1, rounding);
    const double third = std::sqrt(1.0 / 3); // a regular hexagon of side sqrt(1/2)
    EXPECT_NEAR(area_of({0.5, 0.5, 0.5}, {third, third, third}), 0.75 * std::sqrt(3.0), rounding);
    EXPECT_EQ(area_of({0, 0, 2}, {0, 0, 1}), 0);
}

TEST(BoxTree, FindsWhatALookAtAllBoxesFinds) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<Bounds> boxes;
    for (int n = 0; n < 500; ++n) {
        const Vec lower{any(random), any(random), any(random)};
        const double size = n % 50 == 0 ? 0.5 : 0.02;
        boxes.push_back({lower, lower + Vec{size * any(random), size * any(random), size * any(random)}});
    }
    const BoxTree tree(boxes);
    for (int k = 0; k < 200; ++k) {
        const Vec p{any(random), any(random), any(random)};
        std::vector<std::uint32_t> found, expected;
        tree.for_near(p, 0.1, [&](std::uint32_t n) { found.push_back(n); });
        std::sort(found.begin(), found.end());
        for (std::uint32_t n = 0; n < boxes.size(); ++n) {
            const Vec q{std::clamp(p.x, boxes[n].lower.x, boxes[n].upper.x),
                        std::clamp(p.y, boxes[n].lower.y, boxes[n].upper.y),
                        std::clamp(p.z, boxes[n].lower.z, boxes[n].upper.z)};
            if (norm(p - q) < 0.1) expected.push_back(n);
        }
        EXPECT_EQ(found, expected);
    }
    BoxTree().for_near({}, 1, [](std::uint32_t) { FAIL(); });
}
