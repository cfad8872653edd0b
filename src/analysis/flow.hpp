// Grains and mass that cross a line between two snapshots.
#pragma once

#include "analysis/snapshot.hpp"

#include <cstdint>
#include <unordered_map>

namespace sandlane::analysis {

struct Crossings {
    double grains = 0,
           mass = 0; // net: from the left to the right, seen from `from` towards `to`, counts positive; kg
};

// Where a grain was; positions do not jump at periodic sides.
struct Place {
    double x = 0, y = 0; // m
};
using Places = std::unordered_map<std::int64_t, Place>; // by id

[[nodiscard]] Places places_of(const Snapshot& snapshot);

// Between `before` and the snapshot, exact for motion along straight lines, through periodic sides too.
// Grains that came or left in between do not count.
[[nodiscard]] Crossings crossings(const Places& before, const Snapshot& now, Vec from, Vec to);

} // namespace sandlane::analysis
