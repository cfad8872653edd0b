// Grains and mass that cross a line between two snapshots; in 3D a rectangle across one of the axes.
#pragma once

#include "analysis/snapshot.hpp"

#include <cstdint>
#include <unordered_map>

namespace sandlane::analysis {

struct Crossings {
    // Net. From the left to the right, seen from `from` towards `to`, counts positive; in 3D along the axis.
    double grains = 0, mass = 0; // mass in kg
};

// Where each grain was, by id, m; positions do not jump at periodic sides.
using Places = std::unordered_map<std::int64_t, Vec>;

[[nodiscard]] Places places_of(const Snapshot& snapshot);

// Between `before` and the snapshot, exact for motion along straight lines, through periodic sides too.
// Grains that came or left in between do not count. from, to: ends of the line; in 3D opposite corners of the
// rectangle, with one coordinate in common.
[[nodiscard]] Crossings crossings(const Places& before, const Snapshot& now, Vec from, Vec to);

} // namespace sandlane::analysis
