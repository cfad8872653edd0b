// Three dimensions in scene files: what is read and written back, and what is refused in either dimension.
#include "scene/support.hpp"

#include "scene/initial_state.hpp"

#include <gtest/gtest.h>

namespace sandlane::scene {

namespace {

const std::string space_domain = "[domain]\ndimension = 3\nupper = [1, 2, 3]\n";

std::string space_text(const std::string& rest) {
    return space_domain + material_text + rest;
}

std::string refusal_in_space(const std::string& rest) {
    return refusal_of(space_text(rest));
}
std::string refusal_in_plane(const std::string& rest) {
    return refusal_of(scene_text(rest));
}

TEST(SpaceScene, VectorsHaveThreeComponents) {
    const Scene s =
        parse_scene("[[grains]]\nkind = \"list\"\nitems = [{ position = [0.1, 0.2, \"30 cm\"], radius = "
                    "0.01, angular_velocity = [0, 0, \"60 rpm\"] }]\n"
                    "[[grains]]\nradius = 0.1\ncounts = [2, 3, 4]\nspacing = [0.3, 0.4, 0.5]\n"
                    "angular_velocity = [1, 2, 3]\nvelocity = [4, 5, 6]\n"
                    // The dimension may come last.
                    "[domain]\nlower = [-1, -2, -3]\nupper = [1, 2, 3]\ngravity = [0, 0, -9.81]\n"
                    "periodic = [\"z\", \"x\"]\ndimension = 3\n" +
                        material_text,
                    "test.toml");
    EXPECT_EQ(s.domain.dimension, 3);
    EXPECT_EQ(s.domain.lower, (Vec{-1, -2, -3}));
    EXPECT_EQ(s.domain.gravity, (Vec{0, 0, -9.81}));
    EXPECT_EQ(s.domain.periodic, (std::array{true, false, true}));
    EXPECT_EQ(s.grains[0].items[0].position, (Vec{0.1, 0.2, 0.3}));
    EXPECT_DOUBLE_EQ(s.grains[0].items[0].angular_velocity.z, 6.283185307179586);
    EXPECT_EQ(s.grains[1].counts, (std::vector<std::int64_t>{2, 3, 4}));
    EXPECT_EQ(s.grains[1].spacing, (Vec{0.3, 0.4, 0.5}));
    EXPECT_EQ(s.grains[1].angular_velocity, (Vec{1, 2, 3}));
    EXPECT_EQ(s.grains[1].velocity, (Vec{4, 5, 6}));
}

TEST(SpaceScene, WallsAndMotionsAreReadAndWritten) {
    const Scene s = parse_scene(
        space_text(
            "[[walls]]\nkind = \"box\"\npoints = [[0, 0, 0], [1, 2, 3]]\n"
            "[[walls]]\nkind = \"cylinder\"\npoints = [[0, 0, 0], [0, 0, 1]]\nradius = 0.2\nclosed = true\n"
            "motion = \"drum\"\n"
            "[[walls]]\nkind = \"cone\"\npoints = [[0, 0, 0], [0, 0, 1]]\nradius = 0.2\nradius_to = 0\n"
            "[[walls]]\nkind = \"mesh\"\nfile = \"a.stl\"\nscale = 0.001\ncentre = [1, 2, 3]\n"
            "[[walls]]\nkind = \"plane\"\npoints = [[0, 0, 0]]\nnormal = [0, 0, 1]\n"
            "[[motions]]\nname = \"drum\"\nkind = \"rotate\"\nomega = 1\naxis = [0, 1, 0]\n"),
        "test.toml");
    EXPECT_EQ(s.walls[0].points[1], (Vec{1, 2, 3}));
    EXPECT_TRUE(s.walls[1].closed);
    EXPECT_EQ(s.walls[2].kind, WallKind::cone);
    EXPECT_EQ(s.walls[3].scale, 0.001);
    EXPECT_EQ(s.walls[3].file, "a.stl");
    EXPECT_EQ(s.walls[4].normal, (Vec{0, 0, 1}));
    EXPECT_EQ(s.motions[0].axis, (Vec{0, 1, 0}));
    const std::string written = write_scene(s);
    EXPECT_EQ(write_scene(parse_scene(written, "again")), written);
}

TEST(SpaceScene, GrainsAreSpheres) {
    const Scene s = parse_scene(space_text(""), "test.toml");
    EXPECT_EQ(s.md.inertia, Inertia::sphere);
    EXPECT_EQ(s.md.body, Body::sphere);
    EXPECT_EQ(scene_with("").md.inertia, Inertia::disc); // the default of the plane stays
    EXPECT_SAYS(refusal_in_space("[md]\ninertia = \"disc\"\n"),
                "md.inertia: \"disc\" belongs to two-dimensional scenes; use \"sphere\"");
    EXPECT_SAYS(refusal_in_space("[md]\nbody = \"disc\"\n"), "md.body: \"disc\" is no body");
}

TEST(SpaceScene, NumberOfComponentsIsThatOfTheDimension) {
    EXPECT_SAYS(refusal_of("[domain]\ndimension = 3\nupper = [1, 2]\n" + material_text),
                "test.toml:3: domain.upper: has 2 components; a three-dimensional scene needs [x, y, z]");
    EXPECT_SAYS(refusal_of("[domain]\nupper = [1, 2, 3]\n" + material_text),
                "test.toml:2: domain.upper: has 3 components; a two-dimensional scene needs [x, y]. Write "
                "domain.dimension = 3 for space.");
    EXPECT_SAYS(refusal_of("[domain]\ndimension = 4\nupper = [1, 2]\n" + material_text),
                "test.toml:2: domain.dimension: 4 is out of range; allowed: 2 to 3");
    EXPECT_SAYS(refusal_of("[domain]\nupper = [1, 1]\n" + material_text, {"domain.dimension=3"}),
                "domain.upper: has 2 components");
    EXPECT_SAYS(refusal_in_space("[[grains]]\nradius = 1\ncounts = [1, 2]\n"),
                "grains[0].counts: must be [columns, rows, layers]");
    EXPECT_SAYS(refusal_in_plane("[[grains]]\nradius = 1\ncounts = [1, 2, 3]\n"),
                "grains[0].counts: must be [columns, rows]");
    EXPECT_SAYS(refusal_in_plane("[[grains]]\nvelocity = 3\n"),
                "grains[0].velocity: 3 is not a vector; write [x, y]");
    EXPECT_SAYS(refusal_in_space("[[grains]]\nvelocity = 3\n"), "is not a vector; write [x, y, z]");
    EXPECT_SAYS(refusal_of("[domain]\nupper = [1, 1]\nperiodic = [\"z\"]\n" + material_text),
                "domain.periodic: \"z\" is not one of");
}

TEST(SpaceScene, KeysOfTheOtherDimensionAreRefused) {
    EXPECT_SAYS(refusal_in_space("[[grains]]\nomega = 1\n"),
                "test.toml:8: grains[0].omega: is no key of a three-dimensional scene; use angular_velocity "
                "= [x, y, z]");
    EXPECT_SAYS(refusal_in_plane("[[grains]]\nangular_velocity = [0, 0, 1]\n"),
                "grains[0].angular_velocity: is no key of a two-dimensional scene; use omega");
    EXPECT_SAYS(
        refusal_in_space("[[grains]]\nkind = \"list\"\nitems = [{ position = [0, 0, 0], radius = 1, angle = "
                         "1 }]\n"),
        "grains[0].items[0].angle: is no key of a three-dimensional scene");
    EXPECT_SAYS(refusal_in_space("[[grains]]\ntriangular = true\n"), "use staggered");
    EXPECT_SAYS(refusal_in_plane("[[grains]]\nstaggered = true\n"), "use triangular");
    EXPECT_SAYS(refusal_in_space("[[walls]]\nring_radius = 1\n"),
                "walls[0].ring_radius: is no key of a three-");
    EXPECT_SAYS(refusal_in_plane("[[walls]]\nradius_to = 1\n"), "walls[0].radius_to: is no key of a two-");
    EXPECT_SAYS(refusal_in_plane("[[motions]]\nname = \"m\"\naxis = [0, 0]\n"),
                "motions[0].axis: is no key of a two-");
    EXPECT_SAYS(refusal_in_space("[md]\ndelta = 0.1\n"), "md.delta: is no key of a three-");
    // Nor are they proposed.
    const std::string guess = refusal_in_plane("[[grains]]\nangular_velocit = [0, 0]\n");
    EXPECT_SAYS(guess, "unknown key");
    EXPECT_EQ(guess.find("angular_velocity\""), std::string::npos) << guess;
}

TEST(SpaceScene, ChoicesOfTheOtherDimensionAreRefused) {
    EXPECT_SAYS(refusal_in_space("[[walls]]\nkind = \"arc\"\n"),
                "walls[0].kind: \"arc\" is for two-dimensional scenes; allowed here: \"plane\", \"box\", "
                "\"cylinder\", \"cone\", \"mesh\"");
    EXPECT_SAYS(refusal_in_space("[[walls]]\npoints = [[0, 0, 0], [1, 1, 1]]\n"), "\"segment\" is for two-");
    EXPECT_SAYS(
        refusal_in_plane("[[walls]]\nkind = \"mesh\"\n"),
        "walls[0].kind: \"mesh\" is for three-dimensional scenes; allowed here: \"plane\", \"segment\", "
        "\"polyline\", \"arc\", \"grains\"");
    EXPECT_SAYS(refusal_in_space("[md]\nneighbours = \"lattice-half\"\n"),
                "md.neighbours: \"lattice-half\" is for two-dimensional scenes; use \"auto\", \"verlet\" or");
    EXPECT_SAYS(refusal_in_space("[output]\ntrajectory = [\"dump\", \"book\"]\n"),
                "output.trajectory: \"book\" is a format of two-dimensional scenes");
    EXPECT_SAYS(refusal_in_plane("[[analysis]]\nname = \"p\"\nkind = \"profile\"\naxis = \"z\"\n"),
                "analysis[0].axis: \"z\" is for three-dimensional scenes");
}

TEST(SpaceScene, ShapesNeedTheirKeys) {
    const auto wall = [](const std::string& keys) { return refusal_in_space("[[walls]]\nkind = " + keys); };
    EXPECT_SAYS(wall("\"box\"\npoints = [[0, 0, 0], [1, 1, 0]]\n"),
                "walls[0].points: [0, 0, 0] and [1, 1, 0] span no volume");
    EXPECT_SAYS(wall("\"box\"\npoints = [[0, 0, 0]]\n"), "has 1 points; a box has 2");
    EXPECT_SAYS(wall("\"cylinder\"\npoints = [[0, 0, 0], [0, 0, 1]]\n"),
                "walls[0].radius: 0 must be above 0 m");
    EXPECT_SAYS(wall("\"cylinder\"\nradius = 1\npoints = [[0, 0, 0], [0, 0, 0]]\n"),
                "points 0 and 1 coincide");
    EXPECT_SAYS(wall("\"cone\"\npoints = [[0, 0, 0], [0, 0, 1]]\n"), "one of them must be above 0");
    EXPECT_SAYS(wall("\"mesh\"\n"), "walls[0].file: is missing; a mesh needs an STL file");
    EXPECT_SAYS(wall("\"mesh\"\nfile = \"a.stl\"\nscale = 0\n"), "walls[0].scale: 0 is out of range");
    EXPECT_SAYS(wall("\"cone\"\nradius = 1\npoints = [[0, 0, 1], [0, 0, 1]]\n"), "points 0 and 1 coincide");
    EXPECT_SAYS(wall("\"plane\"\npoints = [[0, 0, 0]]\n"), "walls[0].normal: is missing");
    EXPECT_SAYS(refusal_in_space("[[motions]]\nname = \"m\"\nkind = \"rotate\"\naxis = [0, 0, 0]\n"),
                "motions[0].axis: [0, 0, 0] is no direction");
    EXPECT_SAYS(refusal_in_space("[[grains]]\nradius = 0.1\ncounts = [1, 1, 2]\nspacing = [1, 1, 0]\n"),
                "grains[0].spacing: [1, 1, 0] must be above 0 in all directions");
    EXPECT_SAYS(refusal_of("[domain]\ndimension = 3\nupper = [1, 1, 0]\n" + material_text),
                "domain: upper = [1, 1, 0] must lie above lower = [0, 0, 0] in all directions");
}

TEST(SpaceScene, AnalysesHaveBoxesAndRectangles) {
    const auto analysis = [](const std::string& keys) {
        return "[[analysis]]\nname = \"a\"\nkind = " + keys;
    };
    EXPECT_SAYS(refusal_in_space(analysis("\"stress\"\nto = [1, 1, 0]\n")), "span no volume");
    EXPECT_SAYS(refusal_in_space(analysis("\"flow\"\nto = [1, 1, 1]\n")),
                "exactly one coordinate must be the same");
    EXPECT_SAYS(refusal_in_space(analysis("\"flow\"\nto = [1, 0, 0]\n")),
                "exactly one coordinate must be the same");
    EXPECT_SAYS(refusal_in_space(analysis("\"pair-correlation\"\nrange = 1.5\n")),
                "up to 1 m, the shortest side");
    const Scene s = parse_scene(space_text(analysis("\"flow\"\nto = [1, 1, 0]\n") +
                                           "[[analysis]]\nname = \"b\"\nkind = \"profile\"\naxis = \"z\"\n"),
                                "test.toml");
    EXPECT_EQ(s.analyses[1].axis, Axis::z);
}

} // namespace

} // namespace sandlane::scene
