// Small geometric vector shared by scene, walls and analysis. Two-dimensional scenes use x and y, z stays 0.
#pragma once

#include <cmath>

namespace sandlane {

struct Vec {
    double x = 0, y = 0, z = 0;

    friend constexpr Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

[[nodiscard]] constexpr double dot(Vec a, Vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Vec cross(Vec a, Vec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double norm(Vec a) {
    return std::sqrt(dot(a, a));
}

} // namespace sandlane
