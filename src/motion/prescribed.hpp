// Prescribed rigid motions of walls as functions of absolute time (docs/physics.md 6), velocity = exact
// derivative.
#pragma once

#include "core/vec.hpp"
#include "scene/scene.hpp"

namespace sandlane::motion {

// Position and velocity of a material point of the wall at time t, and its rotation since the reference time.
struct RigidState {
    Vec pivot; // reference point that the rotation turns about, in the given positions
    Vec shift; // displacement of the pivot
    Vec shift_velocity;
    double cosine = 1, sine = 0; // rotation angle since the reference time
    double angle = 0, omega = 0;

    [[nodiscard]] Vec position_of(Vec reference) const {
        const Vec d = reference - pivot;
        return pivot + shift + Vec{cosine * d.x - sine * d.y, sine * d.x + cosine * d.y, 0};
    }
    // Velocity of the material point that is at `position` now.
    [[nodiscard]] Vec velocity_at(Vec position) const {
        const Vec arm = position - pivot - shift;
        return shift_velocity + Vec{-omega * arm.y, omega * arm.x, 0};
    }
    [[nodiscard]] Vec rotate(Vec direction) const {
        return {cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y, 0};
    }
};

[[nodiscard]] RigidState rigid_state(const scene::Motion& motion, double time);

// Largest speed over all times of a point within `reach` of the pivot, m/s (for candidate lists and step
// checks).
[[nodiscard]] double largest_speed(const scene::Motion& motion, double reach);

} // namespace sandlane::motion
