// Prescribed rigid motions of walls as functions of absolute time (docs/physics.md 6), velocity = exact
// derivative.
#pragma once

#include "core/vec.hpp"
#include "scene/scene.hpp"

namespace sandlane::motion {

// Position and velocity of a material point of the wall at time t, and its rotation since the reference time.
// In 2D the axis is z.
struct RigidState {
    Vec pivot; // reference point that the rotation turns about, in the given positions
    Vec shift; // displacement of the pivot
    Vec shift_velocity;
    Vec row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; // rotation matrix
    double angle = 0, omega = 0;
    Vec angular_velocity; // rad/s: omega along the axis

    [[nodiscard]] Vec position_of(Vec reference) const { return pivot + shift + rotate(reference - pivot); }
    [[nodiscard]] Vec reference_of(Vec position) const {
        const Vec d = position - pivot - shift;
        return pivot + (d.x * row[0] + d.y * row[1] + d.z * row[2]);
    }
    // Velocity of the material point that is at `position` now.
    [[nodiscard]] Vec velocity_at(Vec position) const {
        return shift_velocity + cross(angular_velocity, position - pivot - shift);
    }
    [[nodiscard]] Vec rotate(Vec direction) const {
        return {dot(row[0], direction), dot(row[1], direction), dot(row[2], direction)};
    }
};

[[nodiscard]] RigidState rigid_state(const scene::Motion& motion, double time);

// Largest speed over all times of a point within `reach` of the pivot, m/s (for candidate lists and step
// checks).
[[nodiscard]] double largest_speed(const scene::Motion& motion, double reach);

} // namespace sandlane::motion
