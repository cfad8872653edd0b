// What a system of hard particles is made of: box, classes of particles, collisions, walls, field.
#pragma once

#include "laws/restitution_models.hpp"
#include "laws/wall_times.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::edmd {

// Particles of one radius, mass and moment of inertia.
struct Class {
    double radius = 0.5, mass = 1; // m, kg
    double inertia = 0.4;          // J = inertia m R^2

    [[nodiscard]] double moment() const { return inertia * mass * radius * radius; } // kg m^2
};

// A side of the box that is not periodic.
struct Side {
    enum class Kind { reflecting, heated };
    Kind kind = Kind::reflecting;
    double eps_n = 1, eps_t = 1;    // reflecting: normal and tangential restitution
    double temperature = 0;         // heated, J
    double accommodation = 1;       // heated: fraction that leaves with the temperature of the wall
    double velocity[3] = {0, 0, 0}; // along the wall, m/s
    laws::Oscillation motion;       // along the normal, into the box where positive
    double speed = 0;               // of a piston, along the normal into the box, from t = 0 on, m/s

    [[nodiscard]] bool oscillates() const { return motion.amplitude > 0; }
};

// A sphere (a circle in the plane), or a cylinder along an axis, at rest: a container or an obstacle.
struct Curved {
    double center[3] = {0, 0, 0}, radius = 1; // m
    int axis = -1;                            // of a cylinder; -1: a sphere
    bool container = true;                    // the gas is inside
    Side wall;                                // what it does to particles; does not move
};

struct Setup {
    int dimension = 3;
    double lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1}; // m
    bool periodic[3] = {true, true, true};
    Side side[3][2]; // lower, upper
    double gravity[3] = {0, 0, 0};
    std::vector<Class> classes = std::vector<Class>(1);
    laws::Restitution restitution;        // of particles with each other
    std::vector<laws::Restitution> pairs; // of two classes, [classes first + second]; empty: all as above
    bool rough = false;
    double tangential = 1, friction = 0; // rough: eps_t, mu
    double contact_time = 0;             // collisions sooner after the last one are elastic, s
    double elastic_speed = 0;            // slower impacts are elastic, m/s
    std::uint64_t seed = 1;
    double cell_edge = 0; // m, at least; 0: chosen. Results do not depend on it
    std::vector<Curved> curved;
    double kicks = 0;         // white noise xi^2 of each component of velocity, m^2/s^3
    double kick_interval = 0; // between the kicks that make it up, s
    double scale = 1;         // of all radii at the start of the epoch
    double growth = 0;        // of this scale, 1/s
    // Lees and Edwards: the box above is `offset` further along x at the start of the epoch, and glides.
    double shear = 0;  // d u_x/d y of a flow without ends, 1/s; all directions are periodic then
    double offset = 0; // m

    [[nodiscard]] double image_speed() const { return shear * length(1); }                    // m/s
    [[nodiscard]] double offset_at(double now) const { return offset + image_speed() * now; } // of the epoch
    // Of the flow at a height, m/s.
    [[nodiscard]] double flow(double y) const { return shear * (y - 0.5 * (lower[1] + upper[1])); }
    // Numbers of walls: sides 2 axis + upper, then curved ones.
    [[nodiscard]] int walls() const { return 6 + static_cast<int>(curved.size()); }

    [[nodiscard]] double length(int d) const { return upper[d] - lower[d]; }
    // That particles may be in: m^3, m^2 in the plane.
    [[nodiscard]] double volume() const;
    [[nodiscard]] double largest_radius() const;
    [[nodiscard]] double smallest_radius() const;
    [[nodiscard]] bool falls() const { return gravity[0] != 0 || gravity[1] != 0 || gravity[2] != 0; }
    [[nodiscard]] bool has_walls() const;
    // For three cells in every periodic direction.
    [[nodiscard]] bool has_room_for_cells() const;
    [[nodiscard]] const laws::Restitution& restitution_of(std::size_t i, std::size_t j) const {
        return pairs.empty() ? restitution : pairs[classes.size() * i + j];
    }
    // Whether collisions of some of them take energy.
    [[nodiscard]] bool dissipates() const;
    // One class of smooth particles, constant restitution, nothing else.
    [[nodiscard]] bool is_plain() const;
};

struct Particle {
    std::uint32_t id = 0, kind = 0; // kind: number of the class
    std::array<double, 3> place{}, velocity{}, spin{};
    std::array<std::int64_t, 3> image{}; // boxes crossed
};

} // namespace sandlane::edmd
