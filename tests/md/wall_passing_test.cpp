// Contacts that pass from one piece of a polyline to the next: a grain led along walls at a given speed,
// whose springs are known in closed form, and whole simulations.
#include "md/walls.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

using namespace sandlane;

namespace {

constexpr double radius = 0.01, overlap = 1e-5, speed = 0.1, dt = 1e-4;
constexpr double stiffness = 1e5, spring = 3e4, damping = 0.3;

// No friction that matters: springs never slip.
scene::Scene with_walls(std::vector<scene::Wall> walls) {
    scene::Scene s = test::empty_scene();
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    s.materials[0].stiffness = stiffness;
    s.materials[0].friction = 1e6;
    s.materials[0].tangential_stiffness = spring;
    s.materials[0].tangential_damping = damping;
    s.walls = std::move(walls);
    return s;
}

scene::Wall polyline(std::vector<Vec> points) {
    scene::Wall w;
    w.name = "line";
    w.kind = scene::WallKind::polyline;
    w.points = std::move(points);
    return w;
}

Vec turned(Vec p, double angle) {
    return {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, 0};
}

struct Place {
    Vec position, velocity;
};

// One grain that does not turn, wherever it is put, and the walls.
class Led {
public:
    explicit Led(const scene::Scene& scene) : coefficients_(md::pair_table(scene)) {
        md::Plan plan;
        plan.normal = static_cast<int>(scene.md.normal);
        plan.tangential = static_cast<int>(scene.md.tangential);
        plan.memory = laws::CundallStrack::memory;
        plan.lower = scene.domain.lower;
        plan.upper = scene.domain.upper;
        md::Needs needs;
        needs.radius_min = needs.radius_max = radius;
        walls_ = md::Walls(scene, plan, needs);
        state_.mass.resize(1);
        state_.id.resize(1);
    }

    Vec force_at(Place p) {
        const Vec v = dt * p.velocity;
        const double records[] = {p.position.x, p.position.y, v.x, v.y, 0, radius, 1 / radius, 0};
        walls_.account(norm(p.position - last_));
        last_ = p.position;
        walls_.update(state_, records);
        double force[4] = {};
        const std::int32_t material = 0;
        md::WallInput in{records, &material, coefficients_.data(), 1, force, 0};
        in.dt = dt;
        in.inverse_dt = 1 / dt;
        (void)walls_.add_forces(in, 0, 1, true);
        return {force[0], force[1], force[2]};
    }
    void forget_list() { walls_.invalidate(state_); }

private:
    std::vector<double> coefficients_;
    md::Walls walls_;
    md::State state_;
    Vec last_;
};

// Along the x axis, pressed against it from above, from x0 on.
Place above_axis(double x0, int visit) {
    return {{x0 + speed * dt * visit, radius - overlap, 0}, {speed, 0, 0}};
}

void expect_near(Vec a, Vec b, double tolerance, int visit) {
    ASSERT_NEAR(a.x, b.x, tolerance) << visit;
    ASSERT_NEAR(a.y, b.y, tolerance) << visit;
    ASSERT_NEAR(a.z, b.z, tolerance) << visit;
}

} // namespace

// A straight line in pieces is one line; also where the foot of the perpendicular is the joint, bit for bit.
TEST(WallPassing, CollinearSegmentsAreOne) {
    const double joint = speed * dt * 200 - 0.004; // the place of a visit
    for (const double angle : {0.0, 0.3, 2.0}) {
        std::vector<Vec> ends{{-0.5, 0, 0}, {0.5, 0, 0}};
        std::vector<Vec> pieces{{-0.5, 0, 0}, {joint, 0, 0}, {0.0001, 0, 0}, {0.00013, 0, 0}, {0.5, 0, 0}};
        for (auto* points : {&ends, &pieces})
            for (Vec& p : *points) p = turned(p, angle);
        Led on_one(with_walls({polyline(ends)})), on_pieces(with_walls({polyline(pieces)}));
        for (int visit = 0; visit < 900; ++visit) {
            Place p = above_axis(-0.004, visit);
            p = {turned(p.position, angle), turned(p.velocity, angle)};
            const Vec force = on_one.force_at(p);
            const double f_t = -spring * speed * dt * visit - damping * speed;
            // Overlaps are differences of lengths up to 1: rounding of 1e-16 times the stiffness.
            expect_near(force, Vec{0, 0, f_t} + turned({f_t, stiffness * overlap, 0}, angle), 1e-10, visit);
            expect_near(on_pieces.force_at(p), force, 1e-10, visit);
        }
    }
}

// Around a convex corner the contact goes on, from segment to corner to segment; its spring turns along.
TEST(WallPassing, GoesAroundAConvexCorner) {
    const double slope = -0.5, reach = radius - overlap, before = 100, around = reach * 0.5 / (speed * dt);
    const auto wall = polyline({{-0.5, 0, 0}, {0, 0, 0}, 0.5 * turned({1, 0, 0}, slope)});
    Led kept(with_walls({wall})), renewed(with_walls({wall}));
    for (int visit = 0; visit < 800; ++visit) {
        const double angle = slope * std::clamp((visit - before) / around, 0.0, 1.0);
        const double along =
            speed * dt * (std::min(visit - before, 0.0) + std::max(visit - before - around, 0.0));
        const Place p{turned({along, reach, 0}, angle), turned({speed, 0, 0}, angle)};
        const double f_t = -spring * speed * dt * visit - damping * speed;
        const Vec force = kept.force_at(p);
        expect_near(force, Vec{0, 0, f_t} + turned({f_t, stiffness * overlap, 0}, angle), 1e-10, visit);
        renewed.forget_list(); // as after a checkpoint
        EXPECT_EQ(renewed.force_at(p), force);
    }
}

// In a concave corner there are two contacts, each with a spring of its own: the second begins unloaded, and
// the first is forgotten where the grain leaves it.
TEST(WallPassing, ConcaveCornersHaveTwoContacts) {
    const double rise = 0.6;
    const Vec up = turned({1, 0, 0}, rise), away = turned({0, 1, 0}, rise);
    Led grain(with_walls({polyline({{-0.5, 0, 0}, {0, 0, 0}, 0.5 * up})}));
    const double reach = radius - overlap;
    // Where it is pressed against both: reach above the axis and from the slope.
    const double corner = -reach * std::tan(0.5 * rise);
    const int before = 300;
    double zeta[2] = {};
    bool touched[2] = {};
    int both = 0;
    for (int visit = 0; visit < 600; ++visit) {
        const double way = speed * dt * (visit - before);
        const bool flat = way < 0;
        const Place p{Vec{corner, reach, 0} + way * (flat ? Vec{1, 0, 0} : up),
                      speed * (flat ? Vec{1, 0, 0} : up)};
        Vec expected;
        const Vec tangents[] = {{1, 0, 0}, up}, normals[] = {{0, 1, 0}, away};
        for (int n = 0; n < 2; ++n) {
            const double xi = radius - dot(p.position, normals[n]);
            const bool now = xi > 0;
            const double v_t = dot(p.velocity, tangents[n]);
            zeta[n] = !now ? 0 : touched[n] ? zeta[n] + dt * v_t : 0;
            touched[n] = now;
            if (!now) continue;
            const double f_t = -spring * zeta[n] - damping * v_t;
            expected = expected + f_t * tangents[n] + (stiffness * xi) * normals[n] + Vec{0, 0, f_t};
        }
        both += touched[0] && touched[1] ? 1 : 0;
        expect_near(grain.force_at(p), expected, 1e-10, visit);
    }
    EXPECT_GT(both, 2);
    EXPECT_FALSE(touched[0]);
}

// A curve of chords that turn by half a degree each: one contact at a time, whose spring goes along.
TEST(WallPassing, OneContactAcrossJointsThatAreNearlyStraight) {
    const double chord = 0.002, turn = 0.008;
    for (const double side : {1.0, -1.0}) { // the curve rises in front of the grain, or falls away
        std::vector<Vec> points{{-0.5, 0, 0}, {0, 0, 0}};
        for (int n = 1; n < 10; ++n)
            points.push_back(points.back() + chord * turned({1, 0, 0}, side * turn * n));
        Led grain(with_walls({polyline(points)}));
        for (int visit = 0; visit < 400; ++visit) {
            const Place p = above_axis(-0.001, visit);
            // Nearest point of the curve.
            double nearest = 1;
            for (std::size_t s = 0; s + 1 < points.size(); ++s) {
                const Vec along = points[s + 1] - points[s];
                const double at =
                    std::clamp(dot(p.position - points[s], along) / dot(along, along), 0.0, 1.0);
                nearest = std::min(nearest, norm(p.position - points[s] - at * along));
            }
            const Vec force = grain.force_at(p);
            if (nearest > radius) break; // on the falling side
            const double f_t = force.z, f_n = std::sqrt(force.x * force.x + force.y * force.y - f_t * f_t);
            // The damper adds little: the normal leans by less than 0.03.
            ASSERT_NEAR(f_n, stiffness * (radius - nearest), 1e-8) << visit;
            ASSERT_NEAR(f_t, -spring * speed * dt * visit - damping * speed, 0.01 + 1e-3 * 0.3 * visit)
                << visit;
        }
    }
}

// Grains of a wall are grains: what touches the next one touches it anew.
TEST(WallPassing, NotBetweenGrainsOfAWall) {
    scene::Wall rough;
    rough.name = "rough";
    rough.kind = scene::WallKind::grains;
    rough.radius = radius;
    rough.spacing = 0.002;
    rough.points = {{0, 0, 0}, {0.002, 0, 0}};
    Led grain(with_walls({rough}));
    const double reach = 2 * radius - overlap;
    const Place on_first{turned({0, reach, 0}, 0.1), turned({speed, 0, 0}, 0.1)};
    const Place on_second{Vec{0.002, 0, 0} + turned({0, reach, 0}, -0.1), turned({speed, 0, 0}, -0.1)};
    for (int visit = 0; visit < 10; ++visit) {
        const double f_t = -spring * speed * dt * visit - damping * speed;
        ASSERT_NEAR(grain.force_at(on_first).z, f_t, 1e-10);
    }
    EXPECT_NEAR(grain.force_at(on_second).z, -damping * speed, 1e-10);
}

// A disc rolls down a slope in pieces as down one: the same on every instruction set, and after a checkpoint.
TEST(WallPassing, RollsOverJointsAsOverNone) {
    const double angle = 0.2;
    const auto rolling = [&](std::vector<Vec> points) {
        scene::Scene s = with_walls({polyline(std::move(points))});
        s.materials[0].friction = 0.5;
        s.materials[0].damping = 30;
        s.domain.gravity = turned({0, -9.81, 0}, angle);
        s.md.dt = 2e-5;
        return s;
    };
    const scene::Scene smooth = rolling({{-0.9, 0, 0}, {0.9, 0, 0}});
    std::vector<Vec> joints;
    for (int n = -90; n <= 90; ++n) joints.push_back({0.01 * n, 0, 0});
    const scene::Scene jointed = rolling(joints);
    const std::vector<scene::GrainState> disc{test::grain(0, {-0.2, radius - 1e-6, 0}, {}, radius, 0.01)};
    md::Simulation a = test::simulate(smooth, disc), b = test::simulate(jointed, disc);
    a.run(30000);
    b.run(15000);
    md::Simulation c = test::simulate(jointed, disc, simd::Isa::scalar);
    c.restore(b.serialise());
    for (md::Simulation* sim : {&b, &c}) sim->run(15000);
    EXPECT_EQ(b.state_hash(), c.state_hash());
    const auto on_one = a.snapshot(), on_pieces = b.snapshot();
    EXPECT_GT(on_one.x[0], -0.15); // over joints
    EXPECT_NEAR(on_pieces.x[0], on_one.x[0], 1e-12);
    EXPECT_NEAR(on_pieces.vx[0], on_one.vx[0], 1e-12);
    EXPECT_NEAR(on_pieces.omega[0], on_one.omega[0], 1e-10);
}
