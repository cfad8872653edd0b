// When an epoch ends: a function of the scene and of the state alone, the same for both algorithms. Then all
// particles are flown to the present, and times count from there.
#pragma once

#include "core/vector.hpp"
#include "edmd/setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::edmd {

// Events of one epoch: twenty for each particle.
[[nodiscard]] inline std::int64_t events_of_epoch(std::size_t particles) {
    return 20 * std::max<std::int64_t>(2, static_cast<std::int64_t>(particles));
}

// How fast all particles move together, in units of their thermal speed. Rounding leaves the centre of mass a
// velocity of 1e-16 of that of the start; a gas that cools far enough moves with it, and then velocities
// relative to each other, which alone decide about collisions, keep no digits.
class Drift {
public:
    // Ten thousand: collisions know their velocities to twelve digits.
    static constexpr double most = 1e4;

    void add(double mass, const Vector<double>& velocity) {
        ++count_;
        mass_ += mass;
        momentum_ = momentum_ + mass * velocity;
        twice_energy_ += mass * dot(velocity, velocity);
    }
    [[nodiscard]] bool is_too_fast() const {
        if (count_ < 2) return false;
        const double together = dot(momentum_, momentum_) / mass_;
        return together > most * most * std::max(twice_energy_ - together, 0.0);
    }

private:
    std::size_t count_ = 0;
    double mass_ = 0, twice_energy_ = 0;
    Vector<double> momentum_{0, 0, 0};
};

// Longest epoch: no particle crosses a thousand boxes, unless it becomes far faster than any at its start;
// nor thirty of a sheared gas, each of which may be thirty boxes further along x. square: of the largest
// speed.
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
                                std::abs(side.speed), std::sqrt(side.temperature / setup.classes[0].mass)});
    for (const Curved& c : setup.curved)
        fastest = std::max(fastest, std::sqrt(c.wall.temperature / setup.classes[0].mass));
    if (setup.kicks > 0) fastest = std::max(fastest, std::sqrt(setup.kicks * setup.kick_interval));
    fastest += std::abs(setup.image_speed());
    const double boxes = setup.shear != 0 ? 30 : 1000;
    const double straight =
        fastest > 0 ? boxes * shortest / fastest : std::numeric_limits<double>::infinity();
    // A field that a periodic direction follows makes them faster all the time.
    return field > 0 ? std::min(straight, std::sqrt(1000 * shortest / std::sqrt(field))) : straight;
}

} // namespace sandlane::edmd
