// Walls at the start: which are near, and that grains in space keep clear of all kinds of them.
#include "scene/standing_walls.hpp"

#include "core/file.hpp"
#include "scene/initial_state.hpp"
#include "scene/support.hpp"
#include "support/stl_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

namespace sandlane::scene {

namespace {

constexpr double rounding = 1e-14; // coordinates of order one

Scene space_of(std::vector<Wall> walls) {
    Scene s;
    s.domain.dimension = 3;
    s.domain.upper = {1, 1, 1};
    s.materials.emplace_back().young = 1e8;
    s.md.inertia = Inertia::sphere;
    s.walls = std::move(walls);
    return s;
}

Wall wall_of(WallKind kind, std::vector<Vec> points, double radius = 0, double radius_to = 0) {
    Wall w;
    w.kind = kind;
    w.points = std::move(points);
    w.radius = radius;
    w.radius_to = radius_to;
    return w;
}

Wall cube_of_triangles(const std::string& name, Vec low, Vec high) {
    Wall w;
    w.kind = WallKind::mesh;
    w.file = test::stl_file(name, test::stl_text(test::box_triangles(low, high)));
    return w;
}

TEST(StandingWalls, GapsToSurfacesThatStandAsGiven) {
    Wall floor = wall_of(WallKind::plane, {{0, 0, 0}});
    floor.normal = {0, 0, 1};
    Wall cube = cube_of_triangles("start", {0, 0, 1}, {1, 1, 2});
    Wall elsewhere = floor;
    elsewhere.motion = "away";
    cube.motion = "turn";
    Scene s = space_of({floor, cube, elsewhere});
    s.motions.resize(2);
    s.motions[0].name = "away";
    s.motions[0].kind = MotionKind::oscillate;
    s.motions[0].wave = Wave::cosine; // stands aside at t = 0
    s.motions[1].name = "turn";
    s.motions[1].kind = MotionKind::rotate;
    const StandingWalls walls(s);
    double to_floor = 1, to_cube = 1;
    int planes = 0;
    const Vec between{0.5, 0.25, 0.6};
    walls.for_near(between, 1, [&](std::size_t piece) {
        ASSERT_NE(walls.wall(piece), 2);
        double& nearest = walls.wall(piece) == 0 ? to_floor : to_cube;
        nearest = std::min(nearest, walls.gap(piece, between).distance);
        planes += walls.wall(piece) == 0 ? 1 : 0;
    });
    EXPECT_NEAR(to_floor, 0.6, rounding);
    EXPECT_NEAR(to_cube, 0.4, rounding);
    EXPECT_EQ(planes, 1);
    const Vec behind{0.5, 0.5, -0.2};
    walls.for_near(behind, 0.5, [&](std::size_t piece) {
        EXPECT_NEAR(walls.gap(piece, behind).distance, -0.2, rounding);
        EXPECT_EQ(walls.gap(piece, behind).away, (Vec{0, 0, 1}));
    });
}

struct Vessel {
    const char* name;
    Wall wall;
    std::function<double(Vec)> clearance; // distance of the surface from geometry
};

double from_axis(Vec p) {
    return std::hypot(p.x - 0.5, p.y - 0.5);
}

// Distance from the segment between two points of the half plane (distance from the axis, height).
double from_profile(Vec p, double r0, double z0, double r1, double z1) {
    const double u = r1 - r0, v = z1 - z0, a = from_axis(p) - r0, b = p.z - z0;
    const double s = std::clamp((a * u + b * v) / (u * u + v * v), 0.0, 1.0);
    return std::hypot(a - s * u, b - s * v);
}

double from_cube(Vec p, double low, double high) {
    const double outside =
        std::hypot(std::max({low - p.x, p.x - high, 0.0}), std::max({low - p.y, p.y - high, 0.0}),
                   std::max({low - p.z, p.z - high, 0.0}));
    const double inside = std::min({p.x - low, high - p.x, p.y - low, high - p.y, p.z - low, high - p.z});
    return std::max(outside, inside);
}

std::vector<Vessel> vessels() {
    return {{"box", wall_of(WallKind::box, {{0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}}),
             [](Vec p) {
                 return std::min({p.x - 0.2, 0.8 - p.x, p.y - 0.2, 0.8 - p.y, p.z - 0.2, 0.8 - p.z});
             }},
            {"cylinder", wall_of(WallKind::cylinder, {{0.5, 0.5, 0.1}, {0.5, 0.5, 0.9}}, 0.3),
             [](Vec p) { return from_profile(p, 0.3, 0.1, 0.3, 0.9); }},
            {"cone", wall_of(WallKind::cone, {{0.5, 0.5, 0.1}, {0.5, 0.5, 0.9}}, 0.1, 0.4),
             [](Vec p) { return from_profile(p, 0.1, 0.1, 0.4, 0.9); }},
            {"mesh", cube_of_triangles("vessel", {0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}),
             [](Vec p) { return from_cube(p, 0.2, 0.8); }}};
}

double least_clearance(const Vessel& vessel, const std::vector<GrainState>& grains) {
    double least = 1;
    for (const GrainState& g : grains) least = std::min(least, vessel.clearance(g.position) / g.radius);
    return least;
}

Grains& random_grains(Scene& s, double fraction) {
    Grains& g = s.grains.emplace_back();
    g.kind = GrainKind::random;
    g.sizes = {SizeLaw::constant, 0.02, 0.02};
    g.packing_fraction = fraction;
    return g;
}

TEST(StandingWalls, InsertedSpheresKeepClearOfThem) {
    for (const Vessel& vessel : vessels()) {
        Scene s = space_of({vessel.wall});
        random_grains(s, 0.05); // of the domain, which is 0.23 of the box
        EXPECT_GE(least_clearance(vessel, initial_grains(s)), 1 - 1e-12) << vessel.name;
    }
}

// Inside the largest cuboid of each vessel, up to its walls, so that the relaxation has to push away from
// them.
TEST(StandingWalls, PackedSpheresKeepClearOfThemSlow) {
    for (const Vessel& vessel : vessels()) {
        Scene s = space_of({vessel.wall});
        Grains& g = random_grains(s, 0.37);
        g.lower = {0.19, 0.19, 0.21};
        g.upper = {0.81, 0.81, 0.79};
        const std::vector<GrainState> grains = initial_grains(s);
        EXPECT_GT(grains.size(), 2000U);
        EXPECT_GE(least_clearance(vessel, grains), 0.99) << vessel.name; // what the relaxation accepts
    }
}

TEST(StandingWalls, AGrainInAWallIsRefused) {
    const auto start = [](const Vessel& vessel, Vec at) {
        Scene s = space_of({vessel.wall});
        s.walls[0].name = vessel.name;
        Grains& g = s.grains.emplace_back();
        g.kind = GrainKind::list;
        g.items = {{at, {}, 0.1}};
        return s;
    };
    for (const Vessel& vessel : vessels()) {
        EXPECT_EQ(initial_grains(start(vessel, {0.5, 0.5, 0.5})).size(), 1U) << vessel.name;
        const Vec at{0.72, 0.5, 0.6};
        EXPECT_SAYS(
            refusal([&] { (void)initial_grains(start(vessel, at)); }),
            fmt::format("its centre (0.72, 0.5, 0.6) m is {:.4g} m from the surface of walls[0] \"{}\"; "
                        "allowed: 0.095 m or more",
                        vessel.clearance(at), vessel.name));
    }
    EXPECT_SAYS(refusal([&] {
                    (void)initial_grains(start(vessels()[0], {0.1, 0.5, 0.5}));
                }),
                "is -0.1 m from the surface of walls[0] \"box\"");
}

TEST(StandingWalls, AMeshWithoutItsFileIsRefusedWithItsKey) {
    const std::string folder = testing::TempDir(), scene = folder + "sandlane_mesh_scene.toml";
    write_file_atomically(scene, "[domain]\ndimension = 3\nupper = [1, 1, 1]\n" + material_text +
                                     "[[walls]]\nkind = \"mesh\"\nfile = \"nowhere.stl\"\n");
    EXPECT_SAYS(
        refusal([&] { (void)read_scene(scene); }),
        "sandlane_mesh_scene.toml: walls[0].file: \"nowhere.stl\" does not exist; a name is relative to "
        "the folder of the scene file, so this is ");
    std::filesystem::remove(scene);
}

} // namespace

} // namespace sandlane::scene
