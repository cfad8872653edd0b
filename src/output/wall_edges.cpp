#include "output/wall_edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

namespace sandlane::output {

using analysis::WallShape;

namespace {

constexpr double cos_of_bend = 0.8660254037844386; // 30 degrees

// One side of a triangle. Two triangles of the same sense go along a common edge in opposite directions.
struct Side {
    Vec a, b; // ordered
    int wall;
    bool reversed;
    std::size_t number; // three for each triangle
    Vec normal;

    [[nodiscard]] auto key() const { return std::tie(wall, a.x, a.y, a.z, b.x, b.y, b.z); }
};

std::vector<Side> sides_of(const std::vector<WallShape>& walls) {
    std::vector<Side> sides;
    for (const WallShape& wall : walls) {
        if (wall.kind != WallShape::Kind::triangle) continue;
        const Vec normal = cross(wall.b - wall.a, wall.c - wall.a);
        const double length = norm(normal);
        const std::array<Vec, 3> corners{wall.a, wall.b, wall.c};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec from = corners[k], to = corners[(k + 1) % 3];
            const bool reversed = std::tie(to.x, to.y, to.z) < std::tie(from.x, from.y, from.z);
            sides.push_back({reversed ? to : from, reversed ? from : to, wall.wall, reversed, sides.size(),
                             length > 0 ? (1 / length) * normal : Vec{}});
        }
    }
    return sides;
}

} // namespace

bool WallEdge::is_sharp() const {
    return !has_other || dot(normal, other_normal) < cos_of_bend;
}

bool WallEdge::is_outline(Vec towards) const {
    return has_other && dot(normal, towards) * dot(other_normal, towards) < 0;
}

std::vector<WallEdge> wall_edges(const std::vector<WallShape>& walls) {
    std::vector<Side> sides = sides_of(walls);
    std::stable_sort(sides.begin(), sides.end(),
                     [](const Side& s, const Side& t) { return s.key() < t.key(); });
    struct Numbered {
        std::size_t number;
        WallEdge edge;
    };
    std::vector<Numbered> edges;
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
        while (end < sides.size() && sides[end].key() == sides[first].key()) ++end;
        const Side &one = sides[first], &two = sides[std::min(first + 1, end - 1)];
        WallEdge edge{one.a, one.b, one.normal, {}, end - first == 2};
        if (edge.has_other) edge.other_normal = one.reversed == two.reversed ? -1.0 * two.normal : two.normal;
        edges.push_back({one.number, edge});
    }
    std::sort(edges.begin(), edges.end(),
              [](const Numbered& s, const Numbered& t) { return s.number < t.number; });
    std::vector<WallEdge> result;
    result.reserve(edges.size());
    for (const Numbered& e : edges) result.push_back(e.edge);
    return result;
}

} // namespace sandlane::output
