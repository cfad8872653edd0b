// STL files: what is read, and what is refused in which words.
#include "scene/stl.hpp"

#include "support.hpp"
#include "support/stl_file.hpp"

#include <limits>

using namespace sandlane;
using scene::parse_stl;
using scene::TriangleMesh;

namespace {

std::string refusal_of_stl(const std::string& content) {
    return scene::refusal([&] { (void)parse_stl(content, "funnel.stl"); });
}

const test::Triangles cube = test::box_triangles({0, 0, 0}, {1, 2, 3});

} // namespace

TEST(Stl, TextAndBinaryOfACube) {
    const TriangleMesh text = parse_stl(test::stl_text(cube), "a.stl");
    EXPECT_EQ(text.points.size(), 8);
    EXPECT_EQ(text.triangles.size(), 12);
    for (std::size_t t = 0; t < cube.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(text.points[text.triangles[t][k]], cube[t][k]);
    for (const char* header : {"test", "solid binary files may begin so"}) {
        const TriangleMesh binary = parse_stl(test::stl_binary(cube, header), "b.stl");
        EXPECT_EQ(binary.points, text.points);
        EXPECT_EQ(binary.triangles, text.triangles);
    }
}

TEST(Stl, WhatExportersWrite) {
    const TriangleMesh mesh =
        parse_stl("  solid\r\n FACET NORMAL nan nan nan\r\n OUTER LOOP VERTEX 0 0 0 \r\n"
                  "vertex +1.0e0 0 -0\r\nvertex 0 1E0 0 endloop endfacet\r\nendsolid\r\n",
                  "a.stl");
    ASSERT_EQ(mesh.triangles.size(), 1);
    EXPECT_EQ(mesh.points.size(), 3);
}

TEST(Stl, TrianglesWithoutAreaAreLeftOut) {
    test::Triangles triangles = cube;
    triangles.push_back({Vec{0, 0, 0}, Vec{1, 0, 0}, Vec{1, 0, 0}});
    triangles.push_back({Vec{0, 0, 0}, Vec{1, 0, 0}, Vec{0.5, 1e-9, 0}});
    EXPECT_EQ(parse_stl(test::stl_text(triangles), "a.stl").triangles.size(), 12);
    triangles.erase(triangles.begin(), triangles.begin() + 12);
    EXPECT_SAYS(refusal_of_stl(test::stl_text(triangles)), "funnel.stl: has no triangle with an area");
    EXPECT_SAYS(refusal_of_stl("solid nothing\nendsolid\n"), "funnel.stl: has no triangle with an area");
}

TEST(Stl, ErrorsInTextNameTheLine) {
    const std::string start = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n";
    EXPECT_SAYS(refusal_of_stl(start + "vertx 1 0 0\n"),
                "funnel.stl:5: it reads \"vertx\" where an STL file has \"vertex\"");
    EXPECT_SAYS(refusal_of_stl(start + "vertex 1 zero 0\n"),
                "funnel.stl:5: it reads \"zero\" where an STL file has a finite number");
    EXPECT_SAYS(refusal_of_stl(start + "vertex 1 inf 0\n"), "funnel.stl:5: it reads \"inf\"");
    EXPECT_SAYS(refusal_of_stl(start + "vertex 1 0 0 vertex 0 1 0\nvertex 1 1 0\n"),
                "funnel.stl:6: it reads \"vertex\" where an STL file has \"endloop\"");
    EXPECT_SAYS(refusal_of_stl(start), "the file ends where an STL file has \"vertex\"");
    EXPECT_SAYS(refusal_of_stl("solid a\ntriangle\n"), "\"facet\" or \"endsolid\"");
}

TEST(Stl, DamagedBinaryFiles) {
    const std::string whole = test::stl_binary(cube);
    const std::string cut = refusal_of_stl(whole.substr(0, whole.size() - 10));
    EXPECT_SAYS(cut, "as a binary file of 12 triangles it would have 684 bytes, not 674");
    EXPECT_SAYS(refusal_of_stl(""), "it has 0 bytes");
    test::Triangles broken = cube;
    broken[4][1].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_SAYS(refusal_of_stl(test::stl_binary(broken)), "triangle 5 of 12 has a corner (1, nan, 0)");
}
