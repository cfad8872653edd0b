// The six sides of the box of a gas: periodic, reflecting, heated, oscillating.
#pragma once

#include "laws/wall_times.hpp"
#include "simd/dsmc/tables.hpp"

namespace sandlane::simd {

struct GasSide {
    enum class Kind { reflecting, heated };
    Kind kind = Kind::reflecting;
    double eps_n = 1, eps_t = 1;    // reflecting: normal and tangential restitution
    double thermal_speed = 0;       // heated: sqrt(T_w/m), m/s
    double accommodation = 1;       // heated: fraction that leaves with the temperature of the wall
    double velocity[3] = {0, 0, 0}; // along the wall, m/s
    laws::Oscillation motion;       // along the normal, towards the gas where positive

    [[nodiscard]] bool moves() const { return motion.amplitude > 0; }
};

// Of the particles of one kind; speed and mass over those of the first.
struct GasWallKind {
    double mass = 1, speed = 1; // thermal at one temperature
    double radius = 0;          // rough particles; 0: smooth
    double spin_speed = 0;      // heated walls: sqrt(T_w/J) = thermal_speed * spin_speed
};

struct GasWalls {
    GasSide side[3][2]; // lower, upper
    bool periodic[3] = {true, true, true};
    double lower[3], upper[3];
    int dimension = 3;
    double shear = 0;     // Lees-Edwards: d u_x/d y, the boxes above and below move along x
    double inertia = 0.4; // rough particles: J = inertia m radius^2
    GasWallKind kind[most_kinds];
    double time[2] = {0, 0}; // at the start of the first and of the second flight, s
};

// Most hits of one particle in one flight.
inline constexpr int most_hits = 64;

} // namespace sandlane::simd
