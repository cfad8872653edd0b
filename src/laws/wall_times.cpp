#include "laws/wall_times.hpp"

#include "laws/elementary.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::laws {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

struct Turn {
    double sine, cosine;
};
Turn turn_at(const Oscillation& wall, double t) {
    const double turns = wall.frequency * t + wall.phase;
    const double part = turns - std::floor(turns);
    Turn r{};
    sine_cosine_of_turn(part < 1 ? part : 0.0, r.sine, r.cosine);
    return r;
}

} // namespace

double flat_wall_time(double h, double v, double g) {
    if (h <= 0) {
        if (v < 0) return 0;
        return g < 0 ? 2 * v / -g : never;
    }
    if (g == 0) return v < 0 ? -h / v : never;
    if (g < 0) {
        const double root = std::sqrt(v * v - 2 * g * h);
        return v >= 0 ? (v + root) / -g : 2 * h / (root - v);
    }
    const double square = v * v - 2 * g * h;
    return v < 0 && square >= 0 ? 2 * h / (std::sqrt(square) - v) : never;
}

double Oscillation::displacement(double t) const {
    return amplitude * turn_at(*this, t).sine;
}

double Oscillation::velocity(double t) const {
    return 2 * std::numbers::pi * frequency * amplitude * turn_at(*this, t).cosine;
}

double oscillating_wall_time(double h, double v, double g, const Oscillation& wall, double now,
                             double limit) {
    const double omega = 2 * std::numbers::pi * wall.frequency;
    const double bound = std::abs(g) + wall.amplitude * omega * omega; // of |h''|
    const double close = 1e-13 * wall.amplitude;
    double t = 0;
    constexpr int most_steps = 10000;
    for (int step = 0; step < most_steps && t <= limit; ++step) {
        const double height = h + v * t + 0.5 * g * t * t;
        if (height > wall.amplitude) { // out of reach: to where it comes back, if it does
            const double back = flat_wall_time(height - wall.amplitude, v + g * t, g);
            if (back == never) return never;
            if (t + back > t) {
                t += back;
                continue;
            }
        }
        const Turn turn = turn_at(wall, now + t);
        const double gap = height - wall.amplitude * turn.sine;
        const double rate = v + g * t - wall.amplitude * omega * turn.cosine;
        if (gap <= close && rate < 0) return t;
        if (!(bound > 0)) return never;
        const double above = gap > close ? gap : 0;
        const double next = (rate + std::sqrt(rate * rate + 2 * bound * above)) / bound;
        if (!(next > 0)) return t; // rides on the wall
        t += next;
    }
    return never;
}

std::array<double, 2> normal_pair(double u, double w) {
    const double radius = std::sqrt(-2.0 * logarithm(1.0 - u));
    double sine = 0, cosine = 0;
    sine_cosine_of_turn(w, sine, cosine);
    return {radius * cosine, radius * sine};
}

double flux_speed(double u) {
    return std::sqrt(-2.0 * logarithm(1.0 - u));
}

} // namespace sandlane::laws
