// Unit quaternions for orientations in 3D: Hamilton product, rotation from the body to space
// (docs/physics.md).
#pragma once

#include "core/vec.hpp"

#include <cmath>

namespace sandlane {

struct Quaternion {
    double w = 1, x = 0, y = 0, z = 0;

    friend constexpr Quaternion operator*(Quaternion a, Quaternion b) {
        return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
    }
    friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

// The rotation by |rotation| rad about its direction.
[[nodiscard]] inline Quaternion rotation_by(Vec rotation) {
    const double angle = norm(rotation);
    const double factor = angle > 0 ? std::sin(0.5 * angle) / angle : 0.5;
    return {std::cos(0.5 * angle), factor * rotation.x, factor * rotation.y, factor * rotation.z};
}

// A vector of the body in space.
[[nodiscard]] constexpr Vec rotate(Quaternion q, Vec v) {
    const Vec axis{q.x, q.y, q.z};
    const Vec t = 2.0 * cross(axis, v);
    return v + q.w * t + cross(axis, t);
}

} // namespace sandlane
