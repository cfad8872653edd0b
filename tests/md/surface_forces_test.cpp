// Forces of walls in space: closed forms of the laws, meshes against what they stand for, motions, and
// balances of energy.
#include "surface_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace sandlane;
using scene::MotionKind;
using scene::NormalLaw;
using scene::TangentialLaw;
using scene::WallKind;
using test::mesh_wall;
using test::Sphere;
using test::springs_and_friction;
using test::SurfaceRig;

namespace {

void expect_near(Vec a, Vec b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

} // namespace

// ---- laws

namespace {

struct Law {
    NormalLaw normal;
    TangentialLaw tangential;
    double friction;
};

class SurfaceLaw : public testing::TestWithParam<Law> {};

} // namespace

// F = -f_n n + f_t and R n x f_t (md-spheres 1.6, 1.7, 1.10) with the laws written out for a sphere on a
// plane.
TEST_P(SurfaceLaw, SphereOnAMovingPlane) {
    const Law law = GetParam();
    scene::Scene s = springs_and_friction();
    s.md.normal = law.normal;
    s.md.tangential = law.tangential;
    scene::Material& m = s.materials[0];
    m.damping = 2;
    m.young = 1e7;
    m.dissipation = 1e-4;
    m.friction = law.friction;
    const Vec n = (1.0 / 3) * Vec{2, -2, 1}, wall_velocity{0.1, 0.3, -0.2}; // n from the sphere to the plane
    scene::Wall wall = test::plane_wall({0, 0, 0}, -1.0 * n);
    wall.motion = "glide";
    s.walls = {wall};
    s.motions.resize(1);
    s.motions[0].name = "glide";
    s.motions[0].kind = MotionKind::linear;
    s.motions[0].velocity = wall_velocity;
    const double radius = 0.01, overlap = 2e-4, dt = 1e-4;
    Sphere ball{Vec{0, 0, 0} - (radius - overlap) * n, {0.2, 0.1, 0.4}, {3, -5, 7}};
    SurfaceRig rig(s, {ball}, dt);

    const double approach = dot(ball.velocity - wall_velocity, n);
    const double modulus = 4.0 / 3 * m.young / (2 * (1 - m.poisson * m.poisson));
    const double f_n = law.normal == NormalLaw::linear_dashpot
                           ? m.stiffness * overlap + m.damping * approach
                           : modulus * std::sqrt(radius) *
                                 (std::pow(overlap, 1.5) + m.dissipation * std::sqrt(overlap) * approach);
    const Vec u = ball.velocity - wall_velocity + radius * cross(ball.angular_velocity, n);
    const Vec u_t = u - dot(u, n) * n;
    const double limit = m.friction * f_n, twist = 0.5 * dt * dot(ball.angular_velocity, n);
    Vec zeta;
    for (int visit = 0; visit < 3; ++visit) {
        Vec f_t;
        if (law.tangential == TangentialLaw::haff_werner)
            f_t = -std::min(m.tangential_damping, limit / norm(u_t)) * u_t;
        if (law.tangential == TangentialLaw::cundall_strack) {
            if (visit > 0) {
                const Vec rotated = zeta + twist * cross(n, zeta);
                if (norm(zeta) > 0) zeta = (norm(zeta) / norm(rotated)) * rotated;
                zeta = zeta + dt * u_t;
            }
            f_t = -m.tangential_stiffness * zeta - m.tangential_damping * u_t;
            if (norm(f_t) > limit) {
                f_t = (limit / norm(f_t)) * f_t;
                zeta = (-1 / m.tangential_stiffness) * (f_t + m.tangential_damping * u_t);
            }
        }
        rig.evaluate(0);
        const Sphere& now = rig.spheres[0];
        const double tolerance = 1e-12 * f_n; // the overlap carries the rounding of R, 5e-15 of it
        expect_near(now.force, f_t - f_n * n, tolerance * 5);
        expect_near(now.torque, radius * cross(n, f_t), tolerance * radius);
        EXPECT_NEAR(rig.power, dot(f_t - f_n * n, wall_velocity), tolerance * 5);
    }
}

INSTANTIATE_TEST_SUITE_P(All, SurfaceLaw,
                         testing::Values(Law{NormalLaw::linear_dashpot, TangentialLaw::none, 0.5},
                                         Law{NormalLaw::viscoelastic, TangentialLaw::none, 0.5},
                                         Law{NormalLaw::linear_dashpot, TangentialLaw::haff_werner, 0.001},
                                         Law{NormalLaw::viscoelastic, TangentialLaw::haff_werner, 0.5},
                                         Law{NormalLaw::linear_dashpot, TangentialLaw::cundall_strack, 0.5},
                                         Law{NormalLaw::viscoelastic, TangentialLaw::cundall_strack, 0.01}));

// ---- meshes

namespace {

// The same spheres, led over two walls that should be the same: same forces and torques, springs included.
void expect_same_along(SurfaceRig& a, SurfaceRig& b, const std::vector<Vec>& path) {
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        for (SurfaceRig* rig : {&a, &b}) {
            Sphere& s = rig->spheres[0];
            s.position = path[k];
            s.velocity = (1 / rig->dt) * (path[k + 1] - path[k]);
            rig->evaluate(0);
        }
        const Sphere &on_a = a.spheres[0], &on_b = b.spheres[0];
        const double scale = norm(on_a.force);
        ASSERT_GT(scale, 1) << k;
        ASSERT_LT(norm(on_a.force - on_b.force), 1e-12 * scale) << k;
        ASSERT_LT(norm(on_a.torque - on_b.torque), 1e-12 * scale) << k;
    }
}

std::vector<Vec> line(Vec from, Vec to, int steps) {
    std::vector<Vec> path;
    for (int k = 0; k <= steps; ++k) path.push_back(from + (static_cast<double>(k) / steps) * (to - from));
    return path;
}

} // namespace

TEST(SurfaceForces, AcrossTrianglesAsAcrossAPlane) {
    scene::Scene on_plane = springs_and_friction();
    on_plane.materials[0].friction = 5; // springs, most of the time
    scene::Scene on_mesh = on_plane;
    const test::Triangles flat = test::uneven_square(7);
    on_plane.walls = {test::plane_wall({0, 0, 0}, {0, 0, 1})};
    on_mesh.walls = {mesh_wall("flat", flat)};
    const Vec height{0, 0, 0.05 - 1e-4};
    const Sphere ball{height, {}, {0.3, 2, 0.5}, 0.05};
    // Straight across, along a row of points and edges, and from corner to corner.
    std::vector<std::vector<Vec>> paths{line(Vec{-0.8, -0.5, 0} + height, Vec{0.8, 0.6, 0} + height, 1000)};
    for (const auto& t : flat)
        for (std::size_t k = 0; k < 3; ++k)
            if (std::max(norm(t[k]), norm(t[(k + 1) % 3])) < 0.8)
                paths.push_back(line(t[k] + height, t[(k + 1) % 3] + height, 50));
    for (const auto& path : paths) {
        SurfaceRig a(on_plane, {ball}, 1e-4), b(on_mesh, {ball}, 1e-4);
        expect_same_along(a, b, path);
    }
}

// Two contacts, both of which pass from triangle to triangle in the same step.
TEST(SurfaceForces, AlongTheInnerEdgeOfAMeshedBox) {
    scene::Scene in_box = springs_and_friction();
    in_box.materials[0].friction = 5;
    scene::Scene in_mesh = in_box;
    scene::Wall box;
    box.kind = WallKind::box;
    box.points = {{0, 0, 0}, {1, 3, 1}};
    in_box.walls = {box};
    in_mesh.walls = {mesh_wall("box", test::box_triangles({0, 0, 0}, {1, 3, 1}))};
    const double a = 0.05 - 1e-4;
    const Sphere ball{{a, 0.5, a}, {}, {0.3, 2, 0.5}, 0.05};
    SurfaceRig first(in_box, {ball}, 1e-4), second(in_mesh, {ball}, 1e-4);
    expect_same_along(first, second, line({a, 0.1, a}, {a, 2.9, a}, 1000));
    SurfaceRig third(in_box, {ball}, 1e-4), fourth(in_mesh, {ball}, 1e-4);
    expect_same_along(third, fourth, line({1 - a, 2.9, a}, {1 - a, 0.1, a}, 1000));
}

TEST(SurfaceForces, SpringsOutliveTheList) {
    scene::Scene s = springs_and_friction();
    s.walls = {mesh_wall("list", test::uneven_square(5))};
    const double z = 0.05 - 1e-4;
    const Sphere ball{{0, 0, z}, {}, {0.3, 2, 0.5}, 0.05};
    SurfaceRig kept(s, {ball}, 1e-4), renewed(s, {ball}, 1e-4);
    for (const Vec p : line({-0.3, -0.1, z}, {0.3, 0.2, z}, 200)) {
        renewed.forget_list();
        for (SurfaceRig* rig : {&kept, &renewed}) {
            rig->spheres[0].position = p;
            rig->evaluate(0);
        }
        ASSERT_EQ(kept.forces(), renewed.forces());
    }
}

// ---- motions

// A sphere on a turning slope: the wall's velocity, and the power it gives, are those of the point below.
TEST(SurfaceForces, PowerOfATurningPlane) {
    scene::Scene s = springs_and_friction();
    s.md.tangential = TangentialLaw::haff_werner;
    const Vec axis = (1.0 / 3) * Vec{1, 2, 2};
    scene::Wall wall = test::plane_wall({0.1, 0, 0}, axis);
    wall.motion = "turn";
    s.walls = {wall};
    s.motions.resize(1);
    s.motions[0].name = "turn";
    s.motions[0].kind = MotionKind::rotate;
    s.motions[0].centre = {0.1, 0, 0};
    s.motions[0].axis = 5.0 * axis;
    s.motions[0].omega = 3;
    const Vec aside = 0.4 * (std::sqrt(0.5) * Vec{0, 1, -1});
    const Vec centre = Vec{0.1, 0, 0} + aside + (0.01 - 1e-5) * axis;
    SurfaceRig rig(s, {Sphere{centre, {}, {}}}, 1e-4);
    rig.evaluate(1.7);                             // a plane turned about its normal is the same plane
    const Vec velocity = cross(3.0 * axis, aside); // 1.2 m/s: slides
    const double f_n = 1e5 * 1e-5, f_t = 0.3 * norm(velocity);
    ASSERT_LT(f_t, 0.5 * f_n);
    // The position along the axis is a difference of numbers of order 0.1, times the stiffness.
    expect_near(rig.spheres[0].force, f_n * axis + (f_t / norm(velocity)) * velocity, 1e-10);
    EXPECT_NEAR(rig.power, f_t * norm(velocity), 1e-10);
    const md::WallElement& element = rig.walls.element(0);
    expect_near(rig.walls.pivot(element), {0.1, 0, 0}, 1e-15);
    // Torque on the wall about its centre along the axis takes all the power.
    const Vec arm = centre - (0.01 - 1e-5) * axis - rig.walls.pivot(element);
    const Vec torque = cross(arm, -1.0 * rig.spheres[0].force);
    EXPECT_NEAR(rig.power, -3 * dot(torque, axis), 1e-10);
}

// Work of an oscillating floor on an elastic sphere: all of it is found in the energy of the sphere.
TEST(SurfaceForces, WorkOfAnOscillatingFloor) {
    for (const bool mesh : {false, true}) {
        scene::Scene s = test::space();
        s.materials[0].stiffness = 1e4;
        s.domain.gravity = {0, 0, -9.81};
        scene::Wall floor =
            mesh ? mesh_wall("floor", test::uneven_square(6)) : test::plane_wall({0, 0, 0}, {0, 0, 1});
        floor.motion = "shake";
        s.walls = {floor};
        s.motions.resize(1);
        s.motions[0].name = "shake";
        s.motions[0].kind = MotionKind::oscillate;
        s.motions[0].amplitude = {0.001, 0, 0.003};
        s.motions[0].omega = 120;
        SurfaceRig rig(s, {Sphere{{0.1, 0.2, 0.03}, {}, {}}}, 1e-6);
        Sphere& ball = rig.spheres[0];
        const auto mechanical = [&](double time) {
            const double overlap = 0.01 - (ball.position.z - 0.003 * std::sin(120 * time));
            const double elastic = overlap > 0 ? 0.5 * 1e4 * overlap * overlap : 0;
            return 0.5 * 0.01 * dot(ball.velocity, ball.velocity) + 0.01 * 9.81 * ball.position.z + elastic;
        };
        const double start = mechanical(0);
        double impulse = 0;
        for (int k = 0; k < 300000; ++k) {
            const double before = ball.force.z;
            rig.step();
            impulse += 0.5 * rig.dt * (before + ball.force.z);
        }
        EXPECT_GT(std::abs(rig.work), 0.1 * start);
        // Second order in w dt = 1e-3, some contacts.
        EXPECT_NEAR(mechanical(0.3), start + rig.work, 1e-4 * start);
        EXPECT_NEAR(0.01 * ball.velocity.z, impulse - 0.01 * 9.81 * 0.3, 1e-9);
        EXPECT_EQ(ball.velocity.x, 0);
    }
}

// A sphere that rolls down a slope without sliding: a = 5/7 g sin (J = 2/5 m R^2).
TEST(SurfaceForces, RollingDownASlope) {
    const double angle = 0.3, g = 9.81, radius = 0.01;
    const Vec down{std::cos(angle), 0, -std::sin(angle)}, up{std::sin(angle), 0, std::cos(angle)};
    const auto on_slope = [&](Vec p) { return p.x * down + p.y * Vec{0, 1, 0} + p.z * up; };
    test::Triangles slope = test::uneven_square(10);
    for (auto& t : slope)
        for (Vec& p : t) p = on_slope(p);
    for (const bool mesh : {false, true}) {
        scene::Scene s = springs_and_friction();
        s.domain.gravity = {0, 0, -g};
        s.materials[0].damping = 30; // settles at once
        s.materials[0].tangential_damping = 10;
        s.walls = {mesh ? mesh_wall("slope", slope) : test::plane_wall({0, 0, 0}, up)};
        const double pressed = 0.01 * g * std::cos(angle) / 1e5;
        SurfaceRig rig(s, {Sphere{on_slope({-0.5, 0.03, radius - pressed}), {}, {}}}, 2e-5);
        const Sphere& ball = rig.spheres[0];
        for (int k = 0; k < 20000; ++k) rig.step();
        const double speed = 5.0 / 7 * g * std::sin(angle) * 0.4;
        // The springs of the contact ring once, at the start: for 1e-3 of the time.
        EXPECT_NEAR(dot(ball.velocity, down), speed, 2e-3 * speed) << mesh;
        EXPECT_NEAR(ball.angular_velocity.y * radius, speed, 2e-3 * speed);
        EXPECT_NEAR(norm(ball.velocity - dot(ball.velocity, down) * down), 0, 1e-6);
        EXPECT_NEAR(ball.position.y, 0.03, 1e-9);
    }
}

// In a turning cylinder a sphere that rolls at its bottom turns with Omega R_c/R; disturbed, it swings with
// w^2 = 5 g/(7 (R_c - R)) whatever Omega is.
TEST(SurfaceForces, SwingingInATurningCylinder) {
    const double drum = 0.1, radius = 0.01, g = 9.81, omega = 4, tilt = 0.05;
    scene::Scene s = springs_and_friction();
    s.domain.gravity = {0, 0, -g};
    s.materials[0].damping = 30;
    s.materials[0].tangential_damping = 10;
    scene::Wall wall;
    wall.kind = WallKind::cylinder;
    wall.points = {{0, -0.5, 0}, {0, 0.5, 0}};
    wall.radius = drum;
    wall.motion = "turn";
    s.walls = {wall};
    s.motions.resize(1);
    s.motions[0].name = "turn";
    s.motions[0].kind = MotionKind::rotate;
    s.motions[0].axis = {0, 1, 0};
    s.motions[0].omega = omega;
    const double pressed = 0.01 * g / 1e5, arm = drum - radius + pressed;
    const Vec start = arm * Vec{std::sin(tilt), 0, -std::cos(tilt)};
    SurfaceRig rig(s, {Sphere{start, {}, {0, omega * drum / radius, 0}}}, 2e-5);
    Sphere& ball = rig.spheres[0];
    const double period = 2 * std::numbers::pi / std::sqrt(5 * g / (7 * arm));
    double passage = 0; // the second time through the bottom, a quarter and a half of a period later
    int passages = 0;
    for (int k = 1; passages < 2 && k < 60000; ++k) {
        const double before = ball.position.x;
        rig.step();
        if (before * ball.position.x > 0) continue;
        passage = rig.dt * (k - before / (before - ball.position.x));
        ++passages;
    }
    // The amplitude adds tilt^2/16 = 2e-4; the spring of the contact gives way by mu_t f_t/k_t of the arm.
    EXPECT_NEAR(passage, 0.75 * period, 2e-3 * period);
    EXPECT_NEAR(ball.angular_velocity.y * radius, omega * drum + ball.velocity.x, 1e-3 * omega * drum);
    EXPECT_NEAR(ball.position.y, 0, 1e-12);
}
