// Walls in space for many grains: threads, the list of candidates, and what observers and outputs see.
#include "surface_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace sandlane;
using scene::TangentialLaw;
using test::mesh_wall;
using test::Sphere;
using test::SurfaceRig;

namespace {

// Four tiles of spheres in and around a turning drum of triangles that stands in a box.
scene::Scene crowded(TangentialLaw law) {
    scene::Scene s = test::springs_and_friction();
    s.md.tangential = law;
    s.materials.push_back(s.materials[0]);
    s.materials[1].name = "steel";
    s.materials[1].stiffness = 3e5;
    scene::Wall drum = mesh_wall("drum", test::box_triangles({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}));
    drum.motion = "turn";
    drum.material = "steel";
    scene::Wall box;
    box.kind = scene::WallKind::box;
    box.points = {{-1, -1, -1}, {1, 1, 1}};
    scene::Wall cone;
    cone.kind = scene::WallKind::cone;
    cone.points = {{0, 0, -1}, {0, 0, 1}};
    cone.radius = 0.2;
    cone.radius_to = 0.9;
    cone.closed = true;
    s.walls = {drum, box, cone};
    s.motions.resize(1);
    s.motions[0].name = "turn";
    s.motions[0].kind = scene::MotionKind::rotate;
    s.motions[0].axis = {1, 1, 0.3};
    s.motions[0].omega = 20;
    return s;
}

std::vector<Sphere> crowd() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<Sphere> spheres(4 * md::tile_size - 100);
    for (Sphere& b : spheres) {
        b.position = 0.97 * Vec{any(random), any(random), any(random)};
        b.velocity = {any(random), any(random), any(random)};
        b.angular_velocity = 10.0 * Vec{any(random), any(random), any(random)};
        b.radius = 0.05 + 0.02 * any(random);
    }
    return spheres;
}

} // namespace

TEST(SurfaceList, SameBitsForEveryNumberOfThreads) {
    std::vector<double> reference;
    for (const int threads : {1, 2, 3, 7}) {
        SurfaceRig rig(crowded(TangentialLaw::cundall_strack), crowd(), 1e-4, threads);
        for (int k = 0; k < 10; ++k) {
            for (Sphere& b : rig.spheres) b.position = b.position + rig.dt * b.velocity;
            rig.evaluate(k * rig.dt);
        }
        if (reference.empty()) reference = rig.forces();
        EXPECT_EQ(rig.forces(), reference) << threads;
    }
}

TEST(SurfaceList, LosesNothing) {
    SurfaceRig listed(crowded(TangentialLaw::haff_werner), crowd(), 1e-4);
    SurfaceRig all(crowded(TangentialLaw::haff_werner), crowd(), 1e-4);
    for (int k = 0; k < 40; ++k) {
        for (SurfaceRig* rig : {&listed, &all})
            for (Sphere& b : rig->spheres) b.position = b.position + rig->dt * b.velocity;
        listed.evaluate(k * listed.dt);
        if (k % 13 != 0) continue;
        all.evaluate(k * all.dt, false);
        EXPECT_EQ(listed.forces(), all.forces());
    }
    EXPECT_LT(listed.walls.list_size(), all.spheres.size());
}

TEST(SurfaceList, ContactsForObserversAreThoseOfTheForces) {
    scene::Scene s = crowded(TangentialLaw::none);
    SurfaceRig rig(s, crowd(), 1e-4);
    rig.evaluate(0.02);
    const std::vector<double> coefficients = md::pair_table(s);
    for (const Sphere& b : rig.spheres) {
        Vec force;
        rig.walls.for_touching(b.position, b.radius, [&](std::size_t e, const md::WallContact& c) {
            const double k = coefficients[static_cast<std::size_t>(rig.walls.element(e).material) *
                                          laws::pair_coefficients];
            force = force - (k * (b.radius - c.distance)) * c.direction;
        });
        EXPECT_LT(norm(b.force - force), 1e-9); // N, of up to 1e4
    }
}

TEST(SurfaceList, ShapesStandWhereTheWallsDo) {
    scene::Scene s = crowded(TangentialLaw::none);
    s.walls.push_back(test::plane_wall({0, 0, -1.5}, {0, 0, 1}));
    s.motions[0].axis = {0, 0, 1};
    s.motions[0].omega = std::numbers::pi / 2;
    const SurfaceRig rig(s, {Sphere{}}, 1e-4);
    std::vector<double> area(4);
    for (const analysis::WallShape& shape : rig.walls.shapes(1)) { // a quarter of a turn
        EXPECT_EQ(shape.kind, analysis::WallShape::Kind::triangle);
        area[static_cast<std::size_t>(shape.wall)] += 0.5 * norm(cross(shape.b - shape.a, shape.c - shape.a));
        EXPECT_EQ(shape.material, shape.wall == 0 ? 1 : 0);
        if (shape.wall == 0) {
            EXPECT_NEAR(std::abs(shape.a.x), 0.4, 1e-14);
            EXPECT_NEAR(std::abs(shape.a.y), 0.5, 1e-14);
        }
    }
    EXPECT_NEAR(area[0], 2 * (1.0 * 0.8 + 0.8 * 0.6 + 0.6 * 1.0), 1e-12);
    EXPECT_NEAR(area[1], 24, 1e-12);
    EXPECT_NEAR(area[3], 16, 1e-12); // the cross-section of the domain
}
