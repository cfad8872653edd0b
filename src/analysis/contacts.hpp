// The contacts of a snapshot, as analyses see them: who touches whom, where, and with which force
// (docs/physics.md 2). The engines make the list; SI units.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::analysis {

struct Contact {
    std::int32_t i = 0;     // index of a grain in the snapshot
    std::int32_t j = -1;    // index of the other grain, above i; -1: a wall
    std::int32_t wall = -1; // index of the wall in the scene; -1: a pair of grains
    Vec point;  // pairs: middle of the overlap, beside i across a periodic side; walls: their surface, m
    Vec normal; // unit vector from i to j or to the wall
    double overlap = 0; // m
    Vec force;          // on i, N; the partner feels the opposite
    // 2D: force along (-n_y, n_x) on i, N; its torque turns i and j the same way. 3D: its magnitude; the
    // torque on a partner is its lever arm times cross(normal, force).
    double tangential = 0;

    [[nodiscard]] bool with_wall() const { return j < 0; }
};

using Contacts = std::vector<Contact>; // ordered by (i, j), walls first

} // namespace sandlane::analysis
