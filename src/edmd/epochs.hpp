// When an epoch ends: a function of the scene and of the state alone, the same for both algorithms. Then all
// particles are flown to the present, and times count from there.
#pragma once

#include "edmd/setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::edmd {

// Events of one epoch: twenty for each particle.
[[nodiscard]] inline std::int64_t events_of_epoch(std::size_t particles) {
    return std::max<std::int64_t>(1000, 20 * static_cast<std::int64_t>(particles));
}

// Longest epoch: no particle crosses a thousand boxes, unless it becomes far faster than any at its start.
// square: of the largest speed.
[[nodiscard]] inline double longest_epoch(const Setup& setup, double square) {
    double shortest = std::numeric_limits<double>::infinity(), field = 0;
    for (int d = 0; d < setup.dimension; ++d) {
        shortest = std::min(shortest, setup.length(d));
        field += setup.gravity[d] * setup.gravity[d];
    }
    double fastest = std::sqrt(square) + std::sqrt(std::sqrt(field) * shortest);
    for (const auto& axis : setup.side)
        for (const Side& side : axis)
            fastest = std::max({fastest, 7 * side.motion.frequency * side.motion.amplitude,
                                std::sqrt(side.temperature / setup.classes[0].mass)});
    const double straight = fastest > 0 ? 1000 * shortest / fastest : std::numeric_limits<double>::infinity();
    // A field that a periodic direction follows makes them faster all the time.
    return field > 0 ? std::min(straight, std::sqrt(1000 * shortest / std::sqrt(field))) : straight;
}

} // namespace sandlane::edmd
