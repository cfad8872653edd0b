// When a particle that flies freely meets a flat wall, and what a heated wall sends back; for event-driven
// dynamics and direct simulation Monte Carlo.
#pragma once

#include "core/vector.hpp"

#include <array>
#include <cstdint>

namespace sandlane::laws {

// First time t >= 0 at which the gap h + v t + g t^2/2 to a wall at rest closes (h: distance of the surfaces,
// v and g: along the normal into the gas) [m, m/s, m/s^2 -> s]; infinity if never. A gap h <= 0 counts as 0.
[[nodiscard]] double flat_wall_time(double h, double v, double g);

// First time at which a particle that flies freely comes to the distance D from a centre, from outside, or
// from inside (container): r its place from the centre, v, and the field g. A distance that rounding has
// passed already counts as D: now if it goes on, else when it comes back. Without a field in closed form
// (specification of event-driven dynamics, 7.7), in a field the first root of the quartic.
[[nodiscard]] double curved_wall_time(const Vector<double>& r, const Vector<double>& v,
                                      const Vector<double>& g, double distance, bool container);

// A wall that moves along its normal: displacement B sin(2 pi (frequency t + phase)).
struct Oscillation {
    double amplitude = 0; // B >= 0, m
    double frequency = 0; // 1/s
    double phase = 0;     // turns

    [[nodiscard]] double displacement(double t) const;
    [[nodiscard]] double velocity(double t) const;
};
// The same for a wall that oscillates about h = 0: first root within `limit` after the time `now`, by steps
// that a bound of the second derivative makes safe; infinity if there is none.
[[nodiscard]] double oscillating_wall_time(double h, double v, double g, const Oscillation& wall, double now,
                                           double limit);

// Two independent normal deviates of two numbers of [0, 1): sqrt(-2 ln(1 - u)) (cos, sin)(2 pi w).
[[nodiscard]] std::array<double, 2> normal_pair(double u, double w);
// Normal speed that a wall sends particles back with, in units of sqrt(T/m): density x exp(-x^2/2).
[[nodiscard]] double flux_speed(double u);

} // namespace sandlane::laws
