// Pictures of spheres: cameras, what hides what, light, walls that are seen through.
#include "output/camera.hpp"
#include "output/colours.hpp"
#include "output/depth_canvas.hpp"
#include "output/image.hpp"
#include "output/picture.hpp"
#include "output/sample.hpp"
#include "output/support.hpp"
#include "output/wall_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;
using namespace sandlane::output;

namespace {

constexpr double slack = 1e-12; // rounding of unit vectors

void expect_near(Vec a, Vec b) {
    EXPECT_NEAR(a.x, b.x, slack);
    EXPECT_NEAR(a.y, b.y, slack);
    EXPECT_NEAR(a.z, b.z, slack);
}

analysis::Snapshot unit_cube() {
    analysis::Snapshot s = sample::empty_space();
    s.lower = {0, 0, 0};
    s.upper = {1, 1, 1};
    return s;
}

// From the front: x to the right, z up; the viewer is at large negative y. The scale ends at 1 m/s.
PictureStyle from_the_front() {
    PictureStyle style;
    style.camera = look_from({0, -1, 0}, {0, 0, 1});
    style.scale_max = 1;
    return style;
}

// A square across y, as two triangles.
std::vector<analysis::WallShape> screen(double y) {
    const Vec a{0.1, y, 0.1}, b{0.9, y, 0.1}, c{0.9, y, 0.9}, d{0.1, y, 0.9};
    return {sample::triangle(a, b, c), sample::triangle(a, c, d)};
}

double brightness(Pixel p) {
    return p[0] + p[1] + p[2];
}

// Largest difference of a channel.
int distance(Pixel a, Pixel b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// Where the highlight does not reach: (0.6, -0.6) of the radius from the centre.
constexpr double dim = 0.6;
const Vec dim_normal{dim, -dim, std::sqrt(1 - 2 * dim * dim)};

Pixel lit_colour(double unit) {
    const Rgb c = map_colour(unit);
    const double light = light_on(dim_normal);
    const auto byte = [&](float value) { return static_cast<int>(std::lround(255 * light * value)); };
    return {byte(c.r), byte(c.g), byte(c.b)};
}

} // namespace

TEST(Camera, AxesAreRightHandedUnitVectors) {
    for (const Vec up : {Vec{0, 0, 9.8}, {0, 3, 0}, {-2, 0, 0}, {1, 2, -3}, {0, 0, 0}})
        for (const Vec direction : {Vec{0, 0, 0}, {0, -1, 0}, {0, 0, 5}, {0, 0, -1}, {1, -2, 1}, {3, 0, 0}}) {
            const Camera camera = look_from(direction, up);
            for (const Vec axis : {camera.right, camera.up, camera.towards})
                EXPECT_NEAR(norm(axis), 1, slack);
            expect_near(cross(camera.right, camera.up), camera.towards);
            EXPECT_NEAR(dot(camera.vertical, camera.right), 0, slack);
            if (norm(direction) > 0) expect_near(norm(direction) * camera.towards, direction);
            EXPECT_GE(dot(camera.up, up), -slack);
        }
}

TEST(Camera, FrontSideAndTopAreThoseOfADrawing) {
    const Vec up{0, 0, 1};
    const Camera front = look_from({0, -1, 0}, up), side = look_from({1, 0, 0}, up),
                 top = look_from({0, 0, 1}, up);
    expect_near(front.right, {1, 0, 0});
    expect_near(front.up, up);
    expect_near(side.right, {0, 1, 0});
    expect_near(side.up, up);
    expect_near(top.right, {1, 0, 0});
    expect_near(top.up, {0, 1, 0});
}

TEST(Camera, UpIsAgainstGravity) {
    scene::Scene scene = sample::space_scene();
    scene.domain.gravity = {0, -9.81, 0};
    scene.output.view = {0, 0, 1};
    expect_near(camera_of(scene).up, {0, 1, 0});
    expect_near(camera_of(scene).right, {1, 0, 0});
    scene.output.view = {}; // from the front, which is z here, and from above
    EXPECT_GT(camera_of(scene).towards.z, 0.5);
    EXPECT_GT(camera_of(scene).towards.y, 0.1);
}

TEST(Camera, ProjectedBoxHoldsTheCorners) {
    const Camera camera = look_from({0, -1, 0}, {0, 0, 1});
    const ProjectedBox box = project_box(camera, {1, 2, 3}, {4, 6, 8});
    expect_near(box.lower, {1, 3, -6});
    expect_near(box.upper, {4, 8, -2});
    const ProjectedBox turned = project_box(look_from({1, -1, 0}, {0, 0, 1}), {0, 0, 0}, {1, 1, 1});
    EXPECT_NEAR(turned.upper.x - turned.lower.x, std::sqrt(2), slack);
}

TEST(SpacePicture, NearerSpheresHideFartherOnes) {
    for (const bool near_first : {true, false}) {
        analysis::Snapshot s = unit_cube();
        const auto add_near = [&] { sample::add_sphere(s, {0.5, 0.2, 0.5}, 0.1, {1, 0, 0}); };
        if (near_first) add_near();
        sample::add_sphere(s, {0.5, 0.6, 0.5}, 0.25, {0, 0, 0});
        if (!near_first) add_near();
        PictureStyle style = from_the_front();
        const double at = 0.1 * dim;
        EXPECT_LE(distance(draw(s, style).in_domain(0.5 + at, 0.5 - at), lit_colour(1)), 6);
        style.camera = look_from({0, 1, 0}, {0, 0, 1}); // from behind: the large one is in front
        const double wide = 0.25 * dim;
        EXPECT_LE(distance(draw(s, style).in_domain(0.5 + wide, 0.5 - wide), lit_colour(0)), 6);
        EXPECT_LE(brightness(draw(s, style).in_domain(0.5 + at, 0.5 - at)),
                  brightness(lit_colour(1)) / 2); // dark, the small bright one is hidden
    }
}

TEST(SpacePicture, SpheresCoverTheirDiscsAndAreLitFromTheLeftAbove) {
    analysis::Snapshot s = unit_cube();
    sample::add_sphere(s, {0.5, 0.5, 0.5}, 0.2, {0.6, 0, 0.5});
    const Image image = draw(s, from_the_front());
    int covered = 0;
    // The edges of the domain take the first and the last pixel.
    const double side = image.right - image.left + 2, r = 0.2 * side;
    for (int y = image.top; y < image.bottom; ++y)
        for (int x = image.left; x < image.right; ++x)
            covered +=
                std::hypot(x + 1 - image.left - 0.5 * side, y + 1 - image.top - 0.5 * side) < 1.5 * r &&
                image.at(x, y) != ground;
    // Pixels cut by the rim count whole: half a pixel more along the circumference, within a quarter.
    EXPECT_NEAR(covered, M_PI * r * r + M_PI * r, M_PI * r / 2);
    EXPECT_GT(brightness(image.in_domain(0.42, 0.58)), brightness(image.in_domain(0.58, 0.42)) + 30);
    // A step of one pixel changes the light by a percent: two bytes of a channel.
    EXPECT_LE(distance(image.in_domain(0.5 + 0.2 * dim, 0.5 - 0.2 * dim), lit_colour(std::hypot(0.6, 0.5))),
              4);
}

TEST(SpacePicture, SpheresAreSeenThroughWalls) {
    analysis::Snapshot s = unit_cube();
    sample::add_sphere(s, {0.4, 0.5, 0.5}, 0.2, {1, 0, 0});
    const Image bare = draw(s, from_the_front());
    s.walls = screen(0.9);
    const Image behind = draw(s, from_the_front());
    s.walls = screen(0.1);
    const Image before = draw(s, from_the_front());
    EXPECT_EQ(behind.in_domain(0.4, 0.5), bare.in_domain(0.4, 0.5));
    EXPECT_NE(before.in_domain(0.4, 0.5), bare.in_domain(0.4, 0.5));
    EXPECT_LE(distance(before.in_domain(0.4, 0.5), bare.in_domain(0.4, 0.5)), 25); // a tenth
    for (const Image* image : {&behind, &before}) {
        EXPECT_NE(image->in_domain(0.8, 0.8), ground);
        EXPECT_EQ(image->in_domain(0.05, 0.5), ground);
    }
}

TEST(SpacePicture, TrianglesWithACommonSideLeaveNoSeam) {
    analysis::Snapshot s = unit_cube();
    s.walls = screen(0.5);
    const Image image = draw(s, from_the_front());
    const Pixel wall = image.in_domain(0.3, 0.7);
    EXPECT_NE(wall, ground);
    const double side = image.right - image.left;
    const auto place = [&](double unit) { return image.left + static_cast<int>(unit * side); };
    for (int y = image.bottom - place(0.85) + image.left; y < image.bottom - place(0.15) + image.left; ++y)
        for (int x = place(0.15); x < place(0.85); ++x) ASSERT_EQ(image.at(x, y), wall) << x << ' ' << y;
}

TEST(SpacePicture, PixelsDoNotDependOnTheOrderOfGrains) {
    analysis::Snapshot forward = unit_cube(), backward = unit_cube();
    const int grains = 40;
    for (int k = 0; k < grains; ++k)
        for (analysis::Snapshot* s : {&forward, &backward}) {
            const double n = s == &forward ? k : grains - 1 - k;
            sample::add_sphere(*s, {std::fmod(0.37 * n, 1), 0.02 * n, std::fmod(0.59 * n, 1)}, 0.08,
                               {0.025 * n, 0, 0});
        }
    const sample::Folder folder("space-picture");
    write_picture(folder / "a.png", forward, from_the_front());
    write_picture(folder / "b.png", backward, from_the_front());
    EXPECT_EQ(read_file(folder / "a.png"), read_file(folder / "b.png"));
}

TEST(SpacePicture, BrokenNumbersDoNotBreakIt) {
    analysis::Snapshot s = unit_cube();
    sample::add_sphere(s, {0.5, NAN, 0.5}, 0.1, {NAN, 0, 0});
    sample::add_sphere(s, {0.5, 0.5, INFINITY}, 0.1, {0, 0, INFINITY});
    sample::add_sphere(s, {1e300, 0.5, 0.5}, 0.1);
    EXPECT_EQ(draw(s, from_the_front()).width, 800);
}

// ---- edges of walls

namespace {

std::vector<analysis::WallShape> cube() {
    std::vector<analysis::WallShape> walls;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 1.0}) {
            const auto corner = [&](double u, double v) {
                Vec p{side, u, v};
                for (int turn = 0; turn < axis; ++turn) p = {p.z, p.x, p.y};
                return p;
            };
            walls.push_back(sample::triangle(corner(0, 0), corner(1, 0), corner(1, 1)));
            walls.push_back(sample::triangle(corner(0, 0), corner(0, 1), corner(1, 1)));
        }
    return walls;
}

// Open, along z. Every other triangle is of the other sense: STL files of all kinds are walls.
std::vector<analysis::WallShape> cylinder(int sides) {
    std::vector<analysis::WallShape> walls;
    const auto point = [&](int k, double z) {
        const double angle = 2 * std::numbers::pi * (k % sides) / sides;
        return Vec{std::cos(angle), std::sin(angle), z};
    };
    for (int k = 0; k < sides; ++k) {
        walls.push_back(sample::triangle(point(k, 0), point(k + 1, 0), point(k + 1, 1)));
        walls.push_back(sample::triangle(point(k, 0), point(k, 1), point(k + 1, 1)));
    }
    return walls;
}

template <class Condition> auto number_of(const std::vector<WallEdge>& edges, const Condition& condition) {
    return std::count_if(edges.begin(), edges.end(), condition);
}
bool sharp(const WallEdge& edge) {
    return edge.is_sharp();
}

} // namespace

TEST(WallEdges, OfACubeTwelveAreSharp) {
    const auto edges = wall_edges(cube());
    EXPECT_EQ(edges.size(), 18U);
    EXPECT_EQ(number_of(edges, sharp), 12);
    for (const WallEdge& edge : edges)
        if (edge.is_sharp()) {
            EXPECT_NEAR(norm(edge.b - edge.a), 1, slack);
        }
}

TEST(WallEdges, ASmoothMantleShowsItsRimsAndItsOutline) {
    const int sides = 64;
    const auto edges = wall_edges(cylinder(sides));
    EXPECT_EQ(edges.size(), 4U * sides);
    EXPECT_EQ(number_of(edges, sharp), 2 * sides);
    // Between two sides: the view is across the middle of one.
    const double angle = std::numbers::pi / sides;
    const Vec towards{std::cos(angle), std::sin(angle), 0.5};
    EXPECT_EQ(number_of(edges, [&](const WallEdge& edge) { return edge.is_outline(towards); }), 2);
}

TEST(WallEdges, WallsDoNotShareThem) {
    std::vector<analysis::WallShape> walls = screen(0.5);
    EXPECT_EQ(number_of(wall_edges(walls), sharp), 4);
    walls[1].wall = 1;
    EXPECT_EQ(number_of(wall_edges(walls), sharp), 6);
    // Three triangles at one side: a border of each.
    walls[1].wall = 0;
    walls.push_back(sample::triangle({0.1, 0.5, 0.1}, {0.9, 0.5, 0.9}, {0.5, 0.9, 0.5}));
    EXPECT_EQ(wall_edges(walls).size(), 7U);
    EXPECT_EQ(number_of(wall_edges(walls), sharp), 7);
}
