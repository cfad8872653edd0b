#include "scene/outline.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace sandlane::scene {

namespace {

constexpr int sides = 64; // of what is round

void add_fan(const std::vector<Vec>& polygon, int wall, std::vector<OutlineTriangle>& to) {
    for (std::size_t k = 2; k < polygon.size(); ++k)
        to.push_back({polygon[0], polygon[k - 1], polygon[k], wall});
}

// The part of a polygon where dot(p, direction) <= limit.
std::vector<Vec> clipped(const std::vector<Vec>& polygon, Vec direction, double limit) {
    std::vector<Vec> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec a = polygon[k], b = polygon[(k + 1) % polygon.size()];
        const double over_a = dot(a, direction) - limit, over_b = dot(b, direction) - limit;
        if (over_a <= 0) kept.push_back(a);
        if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0))
            kept.push_back(a + (over_a / (over_a - over_b)) * (b - a));
    }
    return kept;
}

} // namespace

void outline_box(Vec lower, Vec upper, int wall, std::vector<OutlineTriangle>& to) {
    const auto corner = [&](int n) { // bits of n: x, y, z
        return Vec{(n & 1) != 0 ? upper.x : lower.x, (n & 2) != 0 ? upper.y : lower.y,
                   (n & 4) != 0 ? upper.z : lower.z};
    };
    constexpr int faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    for (const auto& f : faces) add_fan({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])}, wall, to);
}

void outline_band(const BandPiece& band, int wall, std::vector<OutlineTriangle>& to) {
    const Axis3& axis = band.axis;
    const Vec u = perpendicular(axis.direction), v = cross(axis.direction, u);
    const Vec ends[2] = {band.from, band.from + band.length * band.along};
    const auto point = [&](int end, int k) {
        const double angle = 2 * std::numbers::pi * (k % sides) / sides;
        return axis.origin + ends[end].x * axis.direction +
               ends[end].y * (std::cos(angle) * u + std::sin(angle) * v);
    };
    for (int k = 0; k < sides; ++k) {
        if (ends[0].y > 0) to.push_back({point(0, k), point(0, k + 1), point(1, k), wall});
        if (ends[1].y > 0) to.push_back({point(1, k), point(0, k + 1), point(1, k + 1), wall});
    }
}

void outline_plane(Vec point, Vec normal, const Bounds& box, int wall, std::vector<OutlineTriangle>& to) {
    const Vec centre = box.centre(), middle = centre - dot(centre - point, normal) * normal;
    const double reach = norm(box.upper - box.lower);
    const Vec u = reach * perpendicular(normal), v = cross(normal, u);
    std::vector<Vec> polygon{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    const std::array<Vec, 3> axes{Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}};
    for (const Vec axis : axes) {
        polygon = clipped(polygon, axis, dot(axis, box.upper));
        polygon = clipped(polygon, -1.0 * axis, -dot(axis, box.lower));
    }
    add_fan(polygon, wall, to);
}

} // namespace sandlane::scene
